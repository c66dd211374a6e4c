//! Weights as JSON documents: what they share. A document is read whole; what is not asked for (landmarks)
//! is passed over while it is read.

pub(super) mod arkit;
pub(super) mod audio2face;
pub(super) mod mediapipe;

use serde::de::DeserializeOwned;

use super::source::{self, Source};
use super::weight_rows::{Place, WeightRow, WeightRows};
use crate::{ReadError, WeightOptions, WeightsTable};

/// The whole document, without a byte order mark.
fn whole(file: &mut dyn Source) -> Result<Vec<u8>, ReadError> {
    let length = source::length(file)?;
    let mut bytes = source::beginning(file, length)?;
    if bytes.starts_with(b"\xef\xbb\xbf") {
        bytes.drain(..3);
    }
    Ok(bytes)
}

/// A document of one value.
fn parse<T: DeserializeOwned>(bytes: &[u8], remedy: &'static str) -> Result<T, ReadError> {
    serde_json::from_slice(bytes).map_err(|e| damaged(&e, remedy))
}

/// What serde says, with its place in front.
fn damaged(error: &serde_json::Error, remedy: &'static str) -> ReadError {
    let text = error.to_string();
    let what = text.rsplit_once(" at line ").map_or(&text[..], |(what, _)| what).to_owned();
    ReadError::at_line(error.line().max(1), format!("column {}", error.column()), what, remedy)
}

/// The first bytes of a document without blanks and mark before it.
fn opening(bytes: &[u8]) -> &[u8] {
    bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes).trim_ascii_start()
}

/// Whether one of some words stands in bytes.
fn holds(bytes: &[u8], words: &[&str]) -> bool {
    words.iter().any(|word| bytes.windows(word.len()).any(|window| window == word.as_bytes()))
}

/// A frame of named weights.
struct NamedFrame {
    time_s: Option<f64>,
    /// Names and weights; nothing where no face was found.
    weights: Option<Vec<(String, f64)>>,
}

/// Frames whose weights carry their names: every one with the names of the first.
fn of_named_frames(
    frames: Vec<NamedFrame>,
    notes: fn(&[String]) -> Vec<String>,
    options: &WeightOptions<'_>,
) -> Result<WeightsTable, ReadError> {
    let first = frames.iter().enumerate().find_map(|(k, f)| Some((k, f.weights.as_ref()?)));
    let Some((item, first)) = first else {
        let what = "no face in any frame";
        return Err(ReadError::in_json("frames", what, "record the take again"));
    };
    let names = first.iter().map(|(name, _)| name.clone()).collect();
    let mut rows = WeightRows::new(names, Place::Item(item))?;
    for note in notes(rows.names()) {
        rows.note(note);
    }
    for (item, frame) in frames.into_iter().enumerate() {
        let place = Place::Item(item);
        let weights = match frame.weights {
            None => None,
            Some(pairs) => Some(in_order(rows.names(), pairs, place)?),
        };
        let time_s = frame.time_s;
        rows.push(WeightRow { place, number: None, time_s, weights: weights.as_deref() })?;
    }
    rows.finish(options)
}

/// The weights in the order of the names.
fn in_order(
    names: &[String],
    mut pairs: Vec<(String, f64)>,
    place: Place,
) -> Result<Vec<f64>, ReadError> {
    let same = |pairs: &[(String, f64)]| {
        pairs.len() == names.len() && pairs.iter().zip(names).all(|((name, _), n)| name == n)
    };
    if !same(&pairs) {
        let order = |name: &String| names.iter().position(|n| n == name);
        pairs.sort_by_key(|(name, _)| order(name));
    }
    if same(&pairs) {
        return Ok(pairs.into_iter().map(|(_, weight)| weight).collect());
    }
    let missing = names.iter().find(|name| pairs.iter().all(|(n, _)| n != *name));
    let what = match missing {
        Some(name) => format!("no weight of {name:?}"),
        None => format!("{} weights, the first frame has {}", pairs.len(), names.len()),
    };
    Err(place.error("weights", what, "write the same shapes in every frame, each once"))
}
