//! NumPy's archives, `.npz`, of weights: an array frames x shapes, and perhaps the shapes' names and the rate.
//!
//! Weights are the array called `weights`, `blendshapes` or `coefficients`, or the only one of two dimensions.
//! Names are an array of strings, `shape_names`, `blendshape_names` or `names`; the rate is a number, `rate_hz`,
//! `fps` or `mocap_frame_rate`. Vertices are the array called `vertices`, `verts` or `positions`, or the only
//! one of three dimensions.

use std::io::{Cursor, Read as _};

use super::header::{Header, MAGIC, description, header, held_against};
use super::{BESIDE, check_names, checked_rate, numbers};
use crate::formats::format::{Format, Read, Recognise};
use crate::formats::source::{self, Source};
use crate::{ReadError, WeightOptions, WeightsTable};

const REMEDY: &str =
    "save it with numpy.savez(file, weights=..., shape_names=..., fps=...), frames x shapes";
const COPY: &str = "copy the file again";
/// How many times larger an archive may become: weights and positions are measured, and hardly shrink.
const MOST_GROWTH: u64 = 32;
/// What an archive of any size may become, bytes.
const SPARE: u64 = 16 << 10;

pub(in crate::formats) static FORMAT: Format = Format {
    id: "npz",
    name: "NumPy archive (weights)",
    extensions: &["npz"],
    recognised_by: "a zip archive whose first file ends in `.npy`",
    reads: "`weights` (or the only array of two dimensions), `shape_names`, `fps` or `rate_hz`; else the avatar's shapes and the rate that is asked for",
    recognise: Recognise::Beginning(is_archive),
    read: Read::BinaryWeights(|file, _, options| read(file, options)),
    write: None,
};

/// Whether a file is a zip archive whose first member is an array.
pub(super) fn is_archive(bytes: &[u8]) -> bool {
    let length = bytes.get(26..28).map_or(0, |b| usize::from(u16::from_le_bytes([b[0], b[1]])));
    bytes.starts_with(b"PK\x03\x04")
        && bytes.get(30..30 + length).is_some_and(|name| name.ends_with(b".npy"))
}

/// The arrays of an archive: names without ending, and bytes.
fn arrays(file: &mut dyn Source, length: u64) -> Result<Vec<(String, Vec<u8>)>, ReadError> {
    let damaged = |e: String| ReadError::at_byte(0, "archive", e, COPY);
    let bytes = source::beginning(file, length)?;
    let mut archive =
        zip::ZipArchive::new(Cursor::new(bytes)).map_err(|e| damaged(e.to_string()))?;
    let mut left = MOST_GROWTH * length + SPARE;
    let mut found = Vec::new();
    for index in 0..archive.len() {
        let member = archive.by_index(index).map_err(|e| damaged(e.to_string()))?;
        let name = member.name().map_err(|e| damaged(e.to_string()))?.into_owned();
        let Some(name) = name.strip_suffix(".npy") else { continue };
        let mut array = Vec::new();
        member
            .take(left + 1)
            .read_to_end(&mut array)
            .map_err(|e| damaged(format!("{name}: {e}")))?;
        left = left.checked_sub(array.len() as u64).ok_or_else(|| {
            let what = format!("{name}: more than {MOST_GROWTH} times the size of the archive");
            ReadError::at_byte(0, "archive", what, "save it with numpy.savez, not compressed")
        })?;
        found.push((name.to_owned(), array));
    }
    Ok(found)
}

/// The shape of an array; nothing for what is none.
fn shape(array: &[u8]) -> Option<Vec<usize>> {
    if !array.starts_with(MAGIC) {
        return None;
    }
    let read = description(&mut Cursor::new(array), array.len() as u64, COPY);
    read.ok().map(|description| description.keys.shape)
}

/// The array under one of some names, else the only one of so many dimensions.
fn chosen<'a>(
    arrays: &'a [(String, Vec<u8>)],
    names: &[&str],
    dimensions: usize,
    remedy: &'static str,
) -> Result<&'a [u8], ReadError> {
    let fits = |array: &[u8]| shape(array).is_some_and(|shape| shape.len() == dimensions);
    let named = names.iter().find_map(|name| arrays.iter().find(|(own, _)| own == name));
    if let Some((_, array)) = named {
        return Ok(array);
    }
    let mut fitting = arrays.iter().filter(|(_, array)| fits(array));
    match (fitting.next(), fitting.next()) {
        (Some((_, array)), None) => Ok(array),
        (first, _) => {
            let all: Vec<&str> = arrays.iter().map(|(name, _)| &name[..]).collect();
            let count = if first.is_none() { "no array" } else { "several arrays" };
            let what = format!("{count} of {dimensions} dimensions among {}", all.join(", "));
            Err(ReadError::at_byte(0, "archive", what, remedy))
        }
    }
}

/// The array of vertices, as a file of its own.
pub(super) fn vertices(file: &mut dyn Source, length: u64) -> Result<Vec<u8>, ReadError> {
    let arrays = arrays(file, length)?;
    let remedy = "save it with numpy.savez(file, vertices=...), frames x vertices x 3";
    chosen(&arrays, &["vertices", "verts", "positions"], 3, remedy).map(<[u8]>::to_vec)
}

/// Read the document.
fn read(file: &mut dyn Source, options: &WeightOptions<'_>) -> Result<WeightsTable, ReadError> {
    let length = source::length(file)?;
    let arrays = arrays(file, length)?;
    let array = chosen(&arrays, &["weights", "blendshapes", "coefficients"], 2, REMEDY)?;
    let member =
        |names: &[&str]| names.iter().find_map(|name| arrays.iter().find(|(own, _)| own == name));
    let own_names = member(&["shape_names", "blendshape_names", "names"]);
    let own_names = own_names.map(|(name, array)| strings(name, array)).transpose()?;
    let rate_hz = member(&["rate_hz", "fps", "mocap_frame_rate"]);
    let rate_hz = rate_hz.map(|(name, array)| number(name, array)).transpose()?;
    let mut source = Cursor::new(array);
    let header: Header<2> = header(&mut source, array.len() as u64, REMEDY)?;
    let names = own_names.as_deref().unwrap_or(options.shape_names);
    if let Some(own) = own_names.as_ref().filter(|own| own.len() != header.shape[1]) {
        let what = format!("{} columns, shape_names has {} names", header.shape[1], own.len());
        return Err(ReadError::at_byte(0, "archive", what, REMEDY));
    }
    check_names(names, header.shape[1], false)?;
    let rate_hz = checked_rate(options.rate_hz.or(rate_hz))?;
    let weights = numbers(&mut source, &header, names)?;
    if weights.is_empty() {
        return Err(ReadError::at_byte(0, "archive", "no frame", REMEDY));
    }
    Ok(WeightsTable::at_rate(names.to_vec(), weights, 0, rate_hz))
}

/// What is wrong with a member.
fn in_member(name: &str, what: String) -> ReadError {
    ReadError::at_byte(0, "archive", format!("{name}: {what}"), BESIDE)
}

/// The strings of an array `<U..` or `|S..` of one dimension.
fn strings(name: &str, array: &[u8]) -> Result<Vec<String>, ReadError> {
    let length = array.len() as u64;
    let found = description(&mut Cursor::new(array), length, REMEDY)?;
    let descr = &found.keys.descr[..];
    let size = |digits: &str| digits.parse::<usize>().ok().filter(|n| (1..=1024).contains(n));
    let unicode = descr.strip_prefix("<U").and_then(size);
    let bytes = descr.strip_prefix("|S").and_then(size);
    let wrong = || in_member(name, format!("type {descr:?} of shape {:?}", found.keys.shape));
    let (&[_], Some(width)) = (&found.keys.shape[..], unicode.map(|n| 4 * n).or(bytes)) else {
        return Err(wrong());
    };
    held_against(&found.keys.shape, width, length - found.data, found.data)?;
    let data = array.get(found.data as usize..).unwrap_or_default();
    let text = |item: &[u8]| -> Option<String> {
        let letters: Option<String> = match unicode {
            Some(_) => item
                .as_chunks::<4>()
                .0
                .iter()
                .map(|b| u32::from_le_bytes(*b))
                .take_while(|code| *code != 0)
                .map(char::from_u32)
                .collect(),
            None => String::from_utf8(item.split(|b| *b == 0).next()?.to_vec()).ok(),
        };
        letters
    };
    data.chunks_exact(width).map(|item| text(item).ok_or_else(wrong)).collect()
}

/// The number of an array of one number.
fn number(name: &str, array: &[u8]) -> Result<f64, ReadError> {
    let length = array.len() as u64;
    let found = description(&mut Cursor::new(array), length, REMEDY)?;
    let data = array.get(found.data as usize..).unwrap_or_default();
    let value = match (&found.keys.descr[..], data) {
        ("<f4", &[a, b, c, d]) => Some(f64::from(f32::from_le_bytes([a, b, c, d]))),
        ("<i4", &[a, b, c, d]) => Some(f64::from(i32::from_le_bytes([a, b, c, d]))),
        ("<f8", data) => data.try_into().ok().map(f64::from_le_bytes),
        ("<i8", data) => data.try_into().ok().map(|b| i64::from_le_bytes(b) as f64),
        _ => None,
    };
    value.filter(|rate| *rate > 0.0 && rate.is_finite()).ok_or_else(|| {
        let said = format!("type {:?} of shape {:?}", found.keys.descr, found.keys.shape);
        in_member(name, value.map_or(said, |rate| format!("{rate} frames per second")))
    })
}

#[cfg(test)]
mod tests {
    use crate::{
        ReadError, WeightOptions, WeightsTable, read_vertex_array, read_weights, recognise,
    };

    fn read(bytes: &[u8]) -> Result<WeightsTable, ReadError> {
        read_weights(bytes, &WeightOptions::default())
    }

    /// Archives as NumPy itself writes them.
    #[test]
    fn archives_of_numpy_are_read() {
        let Some(python) = mimique_test_support::python("archives_of_numpy_are_read") else {
            return;
        };
        let folder = tempfile::tempdir().unwrap();
        let script = "
import numpy as n, sys
d = sys.argv[1] + '/'
w = n.array([[0, .5], [.25, 1], [1, 0]], dtype='<f4')
n.savez(d + 'a.npz', weights=w, shape_names=['jawOpen', 'cheekPuff'], fps=50)
n.savez_compressed(d + 'b.npz', w.astype('<f8'), names=n.array([b'jawOpen', b'cheekPuff']), rate_hz=50.0)
n.savez(d + 'c.npz', w, w, fps=50)
n.savez(d + 'd.npz', w, names=['a'], fps=50)
n.savez(d + 'e.npz', w, names=['a', 'b'], fps=0)
n.savez_compressed(d + 'f.npz', n.zeros((4000, 500)), fps=50)
n.savez(d + 'v.npz', vertices=n.arange(18.).reshape(3, 2, 3), faces=n.zeros((1, 3), int))
";
        let out =
            std::process::Command::new(python).args(["-c", script]).arg(folder.path()).output();
        let out = out.unwrap();
        assert!(out.status.success(), "{}", String::from_utf8_lossy(&out.stderr));
        let bytes = |name: &str| std::fs::read(folder.path().join(name)).unwrap();
        for name in ["a.npz", "b.npz"] {
            assert_eq!(recognise(&bytes(name)).map(|f| f.id), Some("npz"));
            let table = read(&bytes(name)).unwrap();
            assert_eq!(table.shape_names, ["jawOpen", "cheekPuff"]);
            assert_eq!(table.weights, [0.0, 0.5, 0.25, 1.0, 1.0, 0.0]);
            assert!((table.rate_hz().unwrap() - 50.0).abs() < 1e-9);
        }
        for (name, said) in [
            ("c.npz", "several arrays of 2 dimensions among fps, arr_0, arr_1; "),
            ("d.npz", "2 columns, shape_names has 1 names; "),
            ("e.npz", "fps: 0 frames per second; "),
            ("f.npz", "arr_0: more than 32 times the size of the archive; "),
        ] {
            let error = read(&bytes(name)).unwrap_err().to_string();
            assert!(error.starts_with("byte 0, archive: ") && error.contains(said), "{error}");
        }
        let array = read_vertex_array(&folder.path().join("v.npz")).unwrap();
        assert_eq!((array.vertices, array.positions[17]), (2, 17.0));
    }
}
