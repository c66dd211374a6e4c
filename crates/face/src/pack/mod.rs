//! The avatar pack (`MMAV`): what the stage loads of an avatar, small enough to send to a browser.
//!
//! Positions and displacements are integers in steps of about a micrometre; what is stored is how
//! far each lies from the guess of its neighbours (`predict`), and the whole is deflated. Normals
//! are not stored: they follow from the surface.
//!
//! | field | form |
//! |---|---|
//! | `MMAV`, version 2, length of the body | 4 bytes, u32, u32 |
//! | body | raw deflate |
//! | avatar's name, shape names | texts |
//! | error bound in metres | f32 |
//! | meshes: name, part, base colour, V, T, colours?, triangles, positions, shapes | see `mesh_to` |
//! | eyeballs: mesh, centre, looks (shape, axis, radians) | |
//! | textures: JPEG file and JPEG mask | length and bytes each |

mod bytes;
mod envelope;
mod predict;
mod surface;

pub use bytes::{PackError, PackReader, PackWriter};
pub use envelope::{open_pack, pack_kind, seal_pack};

use crate::{Avatar, Eyeball, Look, Mesh, Texture};

const KIND: &str = "MMAV";
const VERSION: u32 = 2;
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
    for mesh in &avatar.meshes {
        error_bound = error_bound.max(surface::mesh_to(&mut meshes, mesh));
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
    body.varint(avatar.textures.len() as u32);
    for file in avatar.textures.iter().flat_map(|t| [&t.jpeg, &t.mask_jpeg]) {
        body.varint(file.len() as u32);
        body.raw(file);
    }
    EncodedPack { bytes: seal_pack(KIND, VERSION, &body.into_bytes()), error_bound }
}

/// Unpacks an avatar.
///
/// # Errors
/// [`PackError`] for anything that [`encode_pack`] does not write.
pub fn decode_pack(bytes: &[u8]) -> Result<Avatar, PackError> {
    let body = open_pack(KIND, VERSION, bytes)?;
    let mut r = PackReader::new(KIND, &body);
    let name = r.text()?;
    let shape_names = r.texts()?;
    r.f32()?;
    let count = r.count(LEAST[0])?;
    let meshes = (0..count)
        .map(|_| surface::mesh_from(&mut r, shape_names.len()))
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
    let file = |r: &mut PackReader<'_>| -> Result<Vec<u8>, PackError> {
        let length = r.count(1)?;
        Ok(r.raw(length)?.to_vec())
    };
    let mut textures = Vec::new();
    for _ in 0..r.count(2)? {
        textures.push(Texture { jpeg: file(&mut r)?, mask_jpeg: file(&mut r)? });
    }
    if let Some(used) = meshes.iter().flat_map(|m: &Mesh| &m.textured).map(|t| t.texture).max()
        && used >= textures.len()
    {
        return r.refuse(format!("texture {used} of {}", textures.len()));
    }
    r.finish()?;
    Ok(Avatar { name, shape_names, meshes, eyeballs, textures })
}
