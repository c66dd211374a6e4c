//! Buffer views compressed with EXT_meshopt_compression: unpacked when the file is opened.

use std::collections::HashMap;

use gltf_json::Buffer;
use gltf_json::buffer::View;
use serde_json::Value;

use super::container::{Container, Unpacked};
use crate::ReadError;

/// The extension under its first name and under Khronos's.
const NAMES: [&str; 2] = ["EXT_meshopt_compression", "KHR_meshopt_compression"];
/// More than this, unpacked, is taken for damage.
const MOST_BYTES: usize = 1 << 30;

/// Whether a buffer only keeps the place of what compressed views unpack to.
pub(super) fn is_fallback(buffer: &Buffer) -> bool {
    let extensions = buffer.extensions.as_ref();
    let flag = |name| extensions?.others.get(name)?.get("fallback")?.as_bool();
    NAMES.into_iter().any(|name| flag(name) == Some(true))
}

/// Every compressed view of the file, by its index.
pub(super) fn unpack(container: &Container) -> Result<HashMap<usize, Unpacked>, ReadError> {
    let mut out = HashMap::new();
    let mut budget = MOST_BYTES;
    for (index, view) in container.root.buffer_views.iter().enumerate() {
        if let Some((name, extension)) = extension(view) {
            let place = format!("bufferViews[{index}].extensions.{name}");
            out.insert(index, unpacked(container, extension, &mut budget, &place)?);
        }
    }
    Ok(out)
}

fn extension(view: &View) -> Option<(&'static str, &Value)> {
    let others = &view.extensions.as_ref()?.others;
    NAMES.into_iter().find_map(|name| Some((name, others.get(name)?)))
}

fn unpacked(
    container: &Container,
    extension: &Value,
    budget: &mut usize,
    place: &str,
) -> Result<Unpacked, ReadError> {
    let refuse = |what: String| ReadError::damaged(place, what);
    let number = |key: &str| extension.get(key).and_then(Value::as_u64);
    let needed = |key: &str| number(key).ok_or_else(|| refuse(format!("{key} is missing")));
    let (count, stride) = (needed("count")? as usize, needed("byteStride")? as usize);
    let bytes = container
        .buffer_bytes(
            needed("buffer")? as usize,
            number("byteOffset").unwrap_or(0),
            needed("byteLength")?,
            place,
        )
        .map_err(refuse)?;
    // A block of 256 elements takes a fourth of their stride at least: one byte for a thousand.
    let most = (*budget).min(4096 + 1024 * bytes.len());
    let total = count.checked_mul(stride).filter(|total| *total <= most && stride <= 256);
    let Some(total) = total else {
        return Err(refuse(format!("{count} elements of {stride} bytes, {most} bytes fit")));
    };
    *budget -= total;
    let word = |key: &str| extension.get(key).and_then(Value::as_str);
    let mode = word("mode").unwrap_or_default();
    let bytes = decode::view(bytes, mode, word("filter").unwrap_or("NONE"), count, stride);
    bytes.map(|bytes| Unpacked { bytes, stride }).map_err(|what| match what {
        decode::Failure::Damaged(what) => refuse(what),
        #[cfg_attr(not(target_arch = "wasm32"), allow(dead_code))]
        decode::Failure::NotHere => ReadError::broken(
            place,
            "compressed geometry, which is not read in the browser",
            "prepare the avatar on the server, or export without compression",
        ),
    })
}

#[cfg(target_arch = "wasm32")]
mod decode {
    pub enum Failure {
        #[allow(dead_code)]
        Damaged(String),
        NotHere,
    }

    pub fn view(_: &[u8], _: &str, _: &str, _: usize, _: usize) -> Result<Vec<u8>, Failure> {
        Err(Failure::NotHere)
    }
}

#[cfg(not(target_arch = "wasm32"))]
mod decode {
    pub enum Failure {
        Damaged(String),
        #[allow(dead_code)]
        NotHere,
    }

    pub fn view(
        bytes: &[u8],
        mode: &str,
        filter: &str,
        count: usize,
        stride: usize,
    ) -> Result<Vec<u8>, Failure> {
        let damaged = |what: String| Err(Failure::Damaged(what));
        let out = match (mode, stride) {
            ("ATTRIBUTES", 4..=256) if stride.is_multiple_of(4) => {
                attributes(bytes, filter, count, stride)
            }
            // Whole triangles only: the decoder asserts it.
            ("TRIANGLES", 2) if count.is_multiple_of(3) => {
                meshopt::decode_index_buffer::<u16>(bytes, count).ok().map(|v| little(&v))
            }
            ("TRIANGLES", 4) if count.is_multiple_of(3) => {
                meshopt::decode_index_buffer::<u32>(bytes, count).ok().map(|v| little(&v))
            }
            ("INDICES", 2) => {
                meshopt::decode_index_sequence::<u16>(bytes, count).ok().map(|v| little(&v))
            }
            ("INDICES", 4) => {
                meshopt::decode_index_sequence::<u32>(bytes, count).ok().map(|v| little(&v))
            }
            _ => return damaged(format!("mode {mode:?}, {count} elements of {stride} bytes")),
        };
        match out {
            Some(bytes) => Ok(bytes),
            None => damaged(format!("{mode} with filter {filter} cannot be unpacked")),
        }
    }

    /// An element of `N` words of four bytes.
    #[derive(Clone, Copy)]
    struct Words<const N: usize>([u32; N]);

    impl<const N: usize> Default for Words<N> {
        fn default() -> Self {
            Self([0; N])
        }
    }

    fn attributes(bytes: &[u8], filter: &str, count: usize, stride: usize) -> Option<Vec<u8>> {
        macro_rules! of_words {
            ($($n:literal)*) => {
                match stride / 4 {
                    $($n => words::<$n>(bytes, filter, count),)*
                    _ => None,
                }
            };
        }
        of_words!(1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20 21 22 23 24 25 26 27 28 29 30 31
            32 33 34 35 36 37 38 39 40 41 42 43 44 45 46 47 48 49 50 51 52 53 54 55 56 57 58 59 60 61
            62 63 64)
    }

    fn words<const N: usize>(bytes: &[u8], filter: &str, count: usize) -> Option<Vec<u8>> {
        let decoded = meshopt::decode_vertex_buffer::<Words<N>>(bytes, count).ok()?;
        let mut elements: Vec<[u32; N]> = decoded.into_iter().map(|w| w.0).collect();
        match (filter, N) {
            ("NONE", _) => {}
            ("EXPONENTIAL", _) => meshopt::decode_filter_exp(&mut elements),
            // Directions, turns and colours: no face's shape or picture place is made of them.
            ("OCTAHEDRAL" | "QUATERNION" | "COLOR", _) => {}
            _ => return None,
        }
        let flat: Vec<u32> = elements.into_iter().flatten().collect();
        Some(little(&flat))
    }

    /// The numbers' bytes, lowest first.
    fn little<T: bytemuck::Pod>(numbers: &[T]) -> Vec<u8> {
        const { assert!(cfg!(target_endian = "little"), "packs are prepared on little-endian machines") };
        bytemuck::cast_slice(numbers).to_vec()
    }
}
