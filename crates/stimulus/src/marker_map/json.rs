//! The JSON form: `{"unit": "m", "markers": {LABEL: {"position": [x, y, z], "vertex": i}}, ...}`.

use std::fmt;

use mimique_mocap::LengthUnit;
use serde::Deserialize;
use serde::de::{Deserializer, Error as _, MapAccess, Visitor};

use crate::Lid;

use super::{MapFileError, MappedMarker, MarkerMap, MarkerPlace};

#[derive(Deserialize)]
struct File {
    avatar: Option<String>,
    unit: Option<String>,
    markers: Markers,
    #[serde(default)]
    head: Vec<String>,
    neutral: Option<[usize; 2]>,
    #[serde(default)]
    lids: Vec<Lid>,
}

#[derive(Deserialize)]
struct Marker {
    vertex: Option<u32>,
    position: Option<[f64; 3]>,
}

/// The markers in the file's order; a label that stands twice is an error, not a loss.
struct Markers(Vec<(String, Marker)>);

impl<'de> Deserialize<'de> for Markers {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct InOrder;
        impl<'de> Visitor<'de> for InOrder {
            type Value = Markers;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("an object of markers")
            }

            fn visit_map<A: MapAccess<'de>>(self, mut access: A) -> Result<Markers, A::Error> {
                let mut markers: Vec<(String, Marker)> = Vec::new();
                while let Some((label, marker)) = access.next_entry::<String, Marker>()? {
                    if markers.iter().any(|(l, _)| *l == label) {
                        return Err(A::Error::custom(format!("markers: {label:?} twice")));
                    }
                    markers.push((label, marker));
                }
                Ok(Markers(markers))
            }
        }
        deserializer.deserialize_map(InOrder)
    }
}

pub(super) fn read(text: &str) -> Result<MarkerMap, MapFileError> {
    let wrong = |place: &str, what: String, remedy: &'static str| MapFileError {
        place: place.to_owned(),
        what,
        remedy,
    };
    let file: File = serde_json::from_str(text).map_err(|e| {
        let what = e.to_string();
        let place = if what.starts_with("markers: ") { "markers" } else { "JSON" };
        wrong(
            place,
            what,
            "write {\"unit\": \"m\", \"markers\": {LABEL: {\"position\": [x, y, z]}}}",
        )
    })?;
    let metres = match file.unit.as_deref() {
        None | Some("m") => LengthUnit::Metre,
        Some("cm") => LengthUnit::Centimetre,
        Some("mm") => LengthUnit::Millimetre,
        Some(other) => {
            return Err(wrong("unit", format!("{other:?} is no unit"), "write m, cm or mm"));
        }
    }
    .metres();
    let mut face = Vec::new();
    for (label, marker) in file.markers.0 {
        let place = match (marker.position, marker.vertex) {
            (Some(p), _) if p.iter().all(|x| x.is_finite()) => {
                // Dividing keeps "1 mm" the nearest number to 0.001.
                MarkerPlace::Position(p.map(|x| x / (1.0 / metres).round()))
            }
            (None, Some(vertex)) => MarkerPlace::Vertex(vertex),
            _ => {
                return Err(wrong(
                    &format!("markers.{label}"),
                    "neither position nor vertex".to_owned(),
                    "give its position on the neutral skin",
                ));
            }
        };
        face.push(MappedMarker { label, place });
    }
    let neutral = match file.neutral {
        None => None,
        Some([first, end]) if first < end => Some(first..end),
        Some([first, end]) => {
            return Err(wrong(
                "neutral",
                format!("frames {first}:{end} are none"),
                "give the first frame and the one after the last",
            ));
        }
    };
    if let Some(lid) = file.lids.iter().find(|lid| face.iter().all(|m| m.label != lid.marker)) {
        return Err(wrong(
            "lids",
            format!("marker {:?} is not among the markers", lid.marker),
            "give its place there",
        ));
    }
    Ok(MarkerMap { avatar: file.avatar, face, head: file.head, neutral, lids: file.lids })
}
