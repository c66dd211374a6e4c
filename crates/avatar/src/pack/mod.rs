//! The avatar pack (`MMAV`): what the stage loads of an avatar, small enough to send to a browser.
//!
//! Positions are integers in steps of two micrometres, displacements in steps that each vertex has of
//! its own (`steps`). What is stored is how far each lies from a guess, at the length that its frequency
//! deserves (`entropy`): the guess of its neighbours (`predict`), or that of its mirror image on the
//! other side of the face (`mirror`). Normals are not stored: they follow from the surface. The
//! pictures of surfaces lie behind all this as they are, so that a browser can decode them.
//!
//! | field | form |
//! |---|---|
//! | `MMAV`, version 4, length of the body | 4 bytes, u32, u32 |
//! | body | as it is: integers are at their length already |
//! | avatar's name, shape names | texts |
//! | error bound in metres | f32 |
//! | number of meshes, mirror?, twice its x in steps | varint, u8, varint |
//! | meshes: name, part, base colour, unit of displacements, colours?, pictures' triangles, V, T, integers | see `mesh_to` |
//! | eyeballs: mesh, centre, looks (shape, axis, radians) | |
//! | after the body: JPEG file and JPEG mask of each texture | bytes |
//! | their lengths, the number of textures | u32 each |

mod bytes;
mod connectivity;
mod entropy;
mod envelope;
mod mirror;
mod predict;
mod shapes;
mod steps;
mod surface;
mod values;

pub use bytes::{PackError, PackReader, PackWriter};
pub use entropy::{IntegerReader, IntegerWriter, Integers, Model};
use envelope::check_header;
pub use envelope::{open_pack, open_plain, pack_kind, seal_pack, seal_plain};

use crate::{Avatar, Eyeball, Look, Mesh, Texture};

const KIND: &str = "MMAV";
const VERSION: u32 = 4;
/// Least bytes of a mesh, an eyeball and a look, for [`PackReader::count`].
const LEAST: [usize; 3] = [20, 14, 17];

/// What [`encode_pack`] makes.
#[derive(Debug, Clone)]
pub struct EncodedPack {
    /// The pack.
    pub bytes: Vec<u8>,
    /// Largest distance in metres between a vertex of the avatar and of the decoded pack, for
    /// every pose with weights from 0 to 1.
    pub error_bound: f64,
}

/// Packs an avatar. The same avatar gives the same bytes.
pub fn encode_pack(avatar: &Avatar) -> EncodedPack {
    let mut meshes = PackWriter::new();
    let mut error_bound = 0f64;
    meshes.varint(avatar.meshes.len() as u32);
    let plane = mirror::plane(avatar.meshes.iter().map(surface::neutral));
    meshes.u8(u8::from(plane.is_some()));
    plane.iter().for_each(|&plane| meshes.varint(plane as u32));
    let mut places = mirror::Places::new(plane);
    for mesh in &avatar.meshes {
        error_bound = error_bound.max(surface::mesh_to(&mut meshes, mesh, &mut places));
    }
    let mut body = PackWriter::new();
    body.text(&avatar.name);
    body.texts(&avatar.shape_names);
    body.f32(error_bound as f32);
    body.raw(&meshes.into_bytes());
    body.varint(avatar.eyeballs.len() as u32);
    for eye in &avatar.eyeballs {
        body.varint(eye.mesh as u32);
        eye.centre.iter().for_each(|&x| body.f32(x));
        body.varint(eye.looks.len() as u32);
        for look in &eye.looks {
            body.varint(look.shape as u32);
            look.axis.iter().for_each(|&x| body.f32(x));
            body.f32(look.radians);
        }
    }
    let mut bytes = seal_plain(KIND, VERSION, &body.into_bytes());
    let files = || avatar.textures.iter().flat_map(|t| [&t.jpeg, &t.mask_jpeg]);
    files().for_each(|file| bytes.extend(file));
    files().for_each(|file| bytes.extend((file.len() as u32).to_le_bytes()));
    bytes.extend((avatar.textures.len() as u32).to_le_bytes());
    EncodedPack { bytes, error_bound }
}

/// Unpacks an avatar.
///
/// # Errors
/// [`PackError`] for anything that [`encode_pack`] does not write.
pub fn decode_pack(bytes: &[u8]) -> Result<Avatar, PackError> {
    // Another kind or version is said before its end is misread.
    check_header(KIND, VERSION, bytes)?;
    let (sealed, textures) = pictures_of(bytes)?;
    let body = open_plain(KIND, VERSION, sealed)?;
    let mut r = PackReader::new(KIND, body);
    let name = r.text()?;
    let shape_names = r.texts()?;
    r.f32()?;
    let count = r.count(LEAST[0])?;
    let plane = match r.u8()? {
        0 => None,
        1 => Some(r.varint()? as i32),
        other => return r.refuse(format!("mirror flag {other}")),
    };
    let mut places = mirror::Places::new(plane);
    let meshes = (0..count)
        .map(|_| surface::mesh_from(&mut r, shape_names.len(), &mut places))
        .collect::<Result<Vec<_>, _>>()?;
    let vector = |r: &mut PackReader<'_>| Ok([r.f32()?, r.f32()?, r.f32()?]);
    let mut eyeballs = Vec::new();
    for _ in 0..r.count(LEAST[1])? {
        let mesh = r.varint()? as usize;
        if mesh >= meshes.len() {
            return r.refuse(format!("eyeball of mesh {mesh} of {}", meshes.len()));
        }
        let centre = vector(&mut r)?;
        let mut looks = Vec::new();
        for _ in 0..r.count(LEAST[2])? {
            let shape = r.varint()? as usize;
            if shape >= shape_names.len() {
                return r.refuse(format!("look of shape {shape} of {}", shape_names.len()));
            }
            looks.push(Look { shape, axis: vector(&mut r)?, radians: r.f32()? });
        }
        eyeballs.push(Eyeball { mesh, centre, looks });
    }
    if let Some(used) = meshes.iter().flat_map(|m: &Mesh| &m.textured).map(|t| t.texture).max()
        && used >= textures.len()
    {
        return r.refuse(format!("texture {used} of {}", textures.len()));
    }
    r.finish()?;
    Ok(Avatar { name, shape_names, meshes, eyeballs, textures, expressions: Vec::new() })
}

/// What is before the pictures, and the pictures.
fn pictures_of(bytes: &[u8]) -> Result<(&[u8], Vec<Texture>), PackError> {
    let mut front = PackReader::new(KIND, bytes);
    let refuse = |what: &str| PackReader::new(KIND, bytes).refuse(what);
    let word = |at: usize| {
        let four = bytes.get(at..at + 4)?;
        Some(u32::from_le_bytes([four[0], four[1], four[2], four[3]]) as usize)
    };
    let Some(count) = bytes.len().checked_sub(4).and_then(word) else {
        return refuse("no number of pictures at its end");
    };
    let Some(table) = count.checked_mul(8).and_then(|size| bytes.len().checked_sub(4 + size))
    else {
        return refuse("more pictures than it has bytes");
    };
    let lengths: Vec<usize> = (0..2 * count).filter_map(|k| word(table + 4 * k)).collect();
    let total = lengths.iter().fold(0usize, |sum, length| sum.saturating_add(*length));
    let Some(start) = table.checked_sub(total) else {
        return refuse("pictures longer than the pack");
    };
    let sealed = front.raw(start)?;
    let mut textures = Vec::new();
    for pair in lengths.chunks_exact(2) {
        let (jpeg, mask_jpeg) = (front.raw(pair[0])?.to_vec(), front.raw(pair[1])?.to_vec());
        textures.push(Texture { jpeg, mask_jpeg });
    }
    Ok((sealed, textures))
}
