//! What must hold of any bytes that are read as an avatar; shared by the tests and the fuzz targets.

use mimique_avatar::pack::{decode_pack, encode_pack, seal_plain};
use mimique_avatar::{Avatar, Image};
use mimique_avatar_files::{
    AvatarSettings, read_avatar_bytes, read_template_bytes, read_weight_animation,
};

/// Poses with settings of their own, to which other settings are applied.
const BANK: &[u8] = include_bytes!("../../../../../fuzz/corpus/avatar_file/seed-tar");

/// A kind of file and how it is read.
#[derive(Clone, Copy, PartialEq)]
pub enum Kind {
    Gltf,
    Bank,
    Settings,
    Pack,
    Template,
}

/// Reads a file and everything in it.
pub fn consume(kind: Kind, bytes: &[u8]) {
    match kind {
        Kind::Gltf => {
            read(bytes, AvatarSettings::default());
            template(bytes);
            match read_weight_animation(bytes, None, None) {
                Ok(None) => {}
                Ok(Some(read)) => {
                    assert!(read.rate_hz.is_finite() && read.rate_hz > 0.0);
                    assert!(read.weights.len().is_multiple_of(read.shape_names.len().max(1)));
                    assert!(read.weights.iter().all(|weight| weight.is_finite()));
                }
                Err(error) => explained(&error.to_string()),
            }
        }
        Kind::Template => template(bytes),
        Kind::Bank => read(bytes, AvatarSettings::default()),
        Kind::Settings => match AvatarSettings::from_json("avatar.json", bytes) {
            Ok(settings) => read(BANK, settings),
            Err(error) => explained(&error.to_string()),
        },
        Kind::Pack => {
            // A body as it is, in a pack without pictures.
            let sealed = [seal_plain("MMAV", 4, bytes), vec![0; 4]].concat();
            for bytes in [bytes.to_vec(), sealed] {
                if let Ok(avatar) = decode_pack(&bytes) {
                    sound(&avatar);
                }
            }
        }
    }
}

fn read(bytes: &[u8], settings: AvatarSettings) {
    match read_avatar_bytes(bytes.to_vec(), "fuzz", None, Some(settings)) {
        Ok(read) => sound(&read.avatar),
        Err(error) => explained(&error.to_string()),
    }
}

fn template(bytes: &[u8]) {
    match read_template_bytes("fuzz", bytes, None) {
        Ok(read) => {
            let count = read.positions.len();
            assert!(read.triangles.iter().flatten().all(|v| (*v as usize) < count));
            assert!(read.positions.iter().flatten().all(|x| x.is_finite()));
        }
        Err(error) => explained(&error.to_string()),
    }
}

fn explained(text: &str) {
    assert!(text.contains(": ") && text.contains("; "), "no place or remedy: {text}");
}

/// No index leads outside, every number is finite, and the pack takes it.
fn sound(avatar: &Avatar) {
    for mesh in &avatar.meshes {
        let count = mesh.positions.len();
        assert!(mesh.triangles.iter().flatten().all(|v| (*v as usize) < count));
        assert!(mesh.positions.iter().flatten().all(|x| x.is_finite()));
        assert_eq!(mesh.shapes.len(), avatar.shape_names.len());
        for shape in &mesh.shapes {
            assert_eq!(shape.vertices.len(), shape.deltas.len());
            assert!(shape.vertices.iter().all(|v| (*v as usize) < count));
        }
        assert!(mesh.uvs.is_empty() || mesh.uvs.len() == count);
        for run in &mesh.textured {
            assert!(
                run.triangles.end <= mesh.triangles.len() && run.texture < avatar.textures.len()
            );
        }
    }
    for texture in &avatar.textures {
        let _ = Image::decode(texture);
    }
    decode_pack(&encode_pack(avatar).bytes).expect("what is read can be packed");
}
