//! The outer layer of a glTF file: GLB chunks or plain JSON in, document and buffers out.

use std::collections::HashMap;
use std::path::{Component, Path};

use base64::Engine as _;
use gltf_json::Root;

use super::meshopt;
use crate::ReadError;

/// The document, and the bytes of each of its buffers.
pub(super) struct Container {
    /// The JSON part. Its indices are unchecked: follow them with `get`.
    pub root: Root,
    /// Bytes of buffer 0, 1...; each at least as long as it declares.
    pub buffers: Vec<Vec<u8>>,
    /// Channels of animations that KHR_animation_pointer aims at weights: where they stand, and at what. They
    /// are not in `root`.
    pub weight_pointers: Vec<(String, String)>,
    /// Buffer views that were compressed, by their index.
    pub unpacked: HashMap<usize, Unpacked>,
}

/// What a compressed buffer view holds.
pub(super) struct Unpacked {
    pub bytes: Vec<u8>,
    /// Bytes an element.
    pub stride: usize,
}

/// Extensions that a file may require: those that are read, and those without which the face has the same
/// shape (pictures in other formats, whose surfaces keep their plain colour; lights; words about the file).
const KNOWN_EXTENSIONS: [&str; 15] = [
    "KHR_mesh_quantization",
    "KHR_texture_transform",
    "EXT_meshopt_compression",
    "KHR_meshopt_compression",
    "EXT_texture_webp",
    "EXT_texture_avif",
    "KHR_texture_basisu",
    "MSFT_texture_dds",
    "KHR_lights_punctual",
    "EXT_lights_image_based",
    "EXT_lights_ies",
    "KHR_animation_pointer",
    "KHR_node_visibility",
    "KHR_xmp",
    "KHR_xmp_json_ld",
];

/// Splits a file into document and buffers.
///
/// `folder` is where buffers in files of their own are looked for; without it they are refused.
pub(super) fn open(bytes: &[u8], folder: Option<&Path>) -> Result<Container, ReadError> {
    let (json, binary) = if bytes.starts_with(b"glTF") {
        split_chunks(bytes)?
    } else if bytes.iter().find(|b| !b.is_ascii_whitespace()) == Some(&b'{') {
        (bytes, None)
    } else {
        return Err(ReadError::broken(
            "byte 0",
            "neither the letters glTF of a GLB file nor the { of a glTF file",
            "give a .glb or .gltf file",
        ));
    };
    let (root, weight_pointers) = parse(json)?;
    let buffers = root
        .buffers
        .iter()
        .enumerate()
        .map(|(i, buffer)| {
            let place = format!("buffers[{i}]");
            let data = match (&buffer.uri, binary) {
                (Some(uri), _) => load_uri(uri, folder, &place)?,
                // A place that compressed views would fill: nothing is there to be read.
                (None, _) if meshopt::is_fallback(buffer) => return Ok(Vec::new()),
                (None, Some(chunk)) if i == 0 => chunk.to_vec(),
                (None, _) => {
                    return Err(ReadError::damaged(place, "no uri and no binary chunk to take"));
                }
            };
            let declared = buffer.byte_length.0;
            if (data.len() as u64) < declared {
                return Err(ReadError::damaged(
                    place,
                    format!("{declared} bytes declared, {} there", data.len()),
                ));
            }
            Ok(data)
        })
        .collect::<Result<_, _>>()?;
    let mut container = Container { root, buffers, weight_pointers, unpacked: HashMap::new() };
    container.unpacked = meshopt::unpack(&container)?;
    Ok(container)
}

/// GLB: a 12-byte header, the JSON chunk, then perhaps the binary chunk.
fn split_chunks(bytes: &[u8]) -> Result<(&[u8], Option<&[u8]>), ReadError> {
    let word = |at: usize| -> Option<u32> {
        bytes.get(at..at + 4).map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]]))
    };
    let truncated = |place: &str| {
        ReadError::damaged(place, format!("the file ends there, after {} bytes", bytes.len()))
    };
    let version = word(4).ok_or_else(|| truncated("GLB header"))?;
    if version != 2 {
        return Err(ReadError::broken(
            "GLB header",
            format!("version {version}"),
            "export the file as glTF 2.0",
        ));
    }
    let declared = word(8).ok_or_else(|| truncated("GLB header"))? as usize;
    if declared > bytes.len() {
        return Err(ReadError::damaged(
            "GLB header",
            format!("{declared} bytes declared, {} there", bytes.len()),
        ));
    }
    let chunk = |at: usize, kind: &[u8; 4], name: &str| -> Result<&[u8], ReadError> {
        let length = word(at).ok_or_else(|| truncated(name))? as usize;
        let found = bytes.get(at + 4..at + 8).ok_or_else(|| truncated(name))?;
        if found != kind {
            return Err(ReadError::damaged(
                format!("byte {at}, {name}"),
                format!("chunk type {:?}", String::from_utf8_lossy(found)),
            ));
        }
        let end = (at + 8).checked_add(length).filter(|end| *end <= bytes.len());
        let end = end.ok_or_else(|| {
            ReadError::damaged(
                format!("byte {at}, {name}"),
                format!("{length} bytes declared, {} there", bytes.len() - at - 8),
            )
        })?;
        Ok(&bytes[at + 8..end])
    };
    let json = chunk(12, b"JSON", "JSON chunk")?;
    let next = 20 + json.len().next_multiple_of(4);
    let binary =
        if next + 8 <= bytes.len() { Some(chunk(next, b"BIN\0", "binary chunk")?) } else { None };
    Ok((json, binary))
}

/// JSON to a document that asks for no extension, and the channels of weights behind pointers. References
/// are checked where they are followed.
fn parse(json: &[u8]) -> Result<(Root, Vec<(String, String)>), ReadError> {
    let damaged = |e: serde_json::Error| ReadError::damaged("JSON chunk", e.to_string());
    let has_pointers = json.windows(POINTER.len()).any(|window| window == POINTER.as_bytes());
    let (root, pointers): (Root, _) = if has_pointers {
        let mut value: serde_json::Value = serde_json::from_slice(json).map_err(damaged)?;
        let pointers = take_pointers_off(&mut value);
        (serde_json::from_value(value).map_err(damaged)?, pointers)
    } else {
        (serde_json::from_slice(json).map_err(damaged)?, Vec::new())
    };
    let known = |e: &str| KNOWN_EXTENSIONS.contains(&e) || e.starts_with("KHR_materials_");
    if let Some(extension) = root.extensions_required.iter().find(|e| !known(e)) {
        return Err(ReadError::broken(
            "extensionsRequired",
            format!("the file needs the extension {extension}, which is not read"),
            "export without that compression or extension",
        ));
    }
    Ok((root, pointers))
}

/// Animations of anything that a JSON pointer reaches.
const POINTER: &str = "KHR_animation_pointer";

/// Takes the channels off whose target is a pointer: they have no node, without which no channel can be
/// read. Answers those that aim at weights.
fn take_pointers_off(root: &mut serde_json::Value) -> Vec<(String, String)> {
    let mut found = Vec::new();
    let animations = root.get_mut("animations").and_then(|list| list.as_array_mut());
    for (a, animation) in animations.into_iter().flatten().enumerate() {
        let channels = animation.get_mut("channels").and_then(|list| list.as_array_mut());
        let Some(channels) = channels else { continue };
        let mut c = 0;
        channels.retain(|channel| {
            let place = format!("animations[{a}].channels[{c}]");
            c += 1;
            let target = &channel["target"];
            if target["path"] != "pointer" {
                return true;
            }
            let pointer = target["extensions"][POINTER]["pointer"].as_str().unwrap_or_default();
            if pointer.split('/').any(|word| word == "weights") {
                found.push((place, pointer.to_owned()));
            }
            false
        });
    }
    found
}

pub(super) fn load_uri(
    uri: &str,
    folder: Option<&Path>,
    place: &str,
) -> Result<Vec<u8>, ReadError> {
    if let Some(data) = uri.strip_prefix("data:") {
        let encoded = data.split_once(";base64,").map(|(_, encoded)| encoded);
        let encoded =
            encoded.ok_or_else(|| ReadError::damaged(place, "a data URI that is not base64"))?;
        return base64::engine::general_purpose::STANDARD
            .decode(encoded)
            .map_err(|e| ReadError::damaged(place, format!("data URI: {e}")));
    }
    let name = percent_decoded(uri);
    let relative = Path::new(&name);
    let inside =
        relative.components().all(|c| matches!(c, Component::Normal(_) | Component::CurDir));
    let folder = folder.filter(|_| inside).ok_or_else(|| {
        ReadError::broken(
            place,
            format!("file {name:?} is not in the folder of the avatar"),
            "export as one .glb file",
        )
    })?;
    std::fs::read(folder.join(relative)).map_err(|source| ReadError::Io { place: name, source })
}

/// `%20` and its like; anything malformed stays as it is.
fn percent_decoded(uri: &str) -> String {
    let bytes = uri.as_bytes();
    let mut out = Vec::with_capacity(bytes.len());
    let mut i = 0;
    while i < bytes.len() {
        let code = bytes
            .get(i + 1..i + 3)
            .filter(|_| bytes[i] == b'%')
            .and_then(|hex| std::str::from_utf8(hex).ok())
            .and_then(|hex| u8::from_str_radix(hex, 16).ok());
        out.push(code.unwrap_or(bytes[i]));
        i += if code.is_some() { 3 } else { 1 };
    }
    String::from_utf8_lossy(&out).into_owned()
}
