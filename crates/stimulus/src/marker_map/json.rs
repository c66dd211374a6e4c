//! The JSON form: `{"unit": "m", "markers": {LABEL: {"position": [x, y, z], "vertex": i}}, ...}`.

use std::fmt;
use std::ops::Range;

use mimique_mocap::LengthUnit;
use serde::Deserialize;
use serde::de::{Deserializer, Error as _, MapAccess, Visitor};

use crate::Lid;

use super::{
    Depth, MapFileError, MapOrigin, MappedMarker, MarkerAssociation, MarkerMap, MarkerPlace,
    ScaleRule,
};

#[derive(Deserialize)]
struct File {
    avatar: Option<String>,
    unit: Option<String>,
    markers: Markers,
    #[serde(default)]
    head: Vec<String>,
    neutral: Option<[usize; 2]>,
    association: Option<String>,
    #[serde(default)]
    scale: Scale,
    depth: Option<String>,
    #[serde(default)]
    lids: Vec<Lid>,
    #[serde(default)]
    suggested: bool,
    layout: Option<serde::de::IgnoredAny>,
}

#[derive(Deserialize, Default)]
#[serde(deny_unknown_fields)]
struct Scale {
    automatic: Option<[usize; 2]>,
    global: Option<Factors>,
}

/// A factor for x, y and z alike, or one for each.
#[derive(Deserialize, Clone, Copy)]
#[serde(untagged)]
enum Factors {
    One(f64),
    Each([f64; 3]),
}

#[derive(Deserialize)]
struct Marker {
    vertex: Option<u32>,
    position: Option<[f64; 3]>,
    scale: Option<Factors>,
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

fn wrong(place: &str, what: String, remedy: &'static str) -> MapFileError {
    MapFileError { place: place.to_owned(), what, remedy }
}

/// The markers' places, given in units of some metres, and the factors of single markers.
fn markers(given: Markers, metres: f64) -> Result<(Vec<MappedMarker>, ScaleRule), MapFileError> {
    let mut face = Vec::new();
    let mut scale = ScaleRule::default();
    for (label, marker) in given.0 {
        if let Some(given) = marker.scale {
            let factors = factors(given, &format!("markers.{label}.scale"))?;
            scale.markers.insert(label.clone(), factors);
        }
        let place = match (marker.position, marker.vertex) {
            (Some(p), _) if p.iter().all(|x| x.is_finite()) => {
                // Dividing keeps "1 mm" the nearest number to 0.001.
                MarkerPlace::Position(p.map(|x| x / (1.0 / metres).round()).into())
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
    Ok((face, scale))
}

pub(super) fn read(text: &str) -> Result<MarkerMap, MapFileError> {
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
    let (face, mut scale) = markers(file.markers, metres)?;
    let neutral = span(file.neutral, "neutral")?;
    scale.automatic = span(file.scale.automatic, "scale.automatic")?;
    scale.global = file.scale.global.map(|given| factors(given, "scale.global")).transpose()?;
    let association = match file.association.as_deref() {
        None | Some("vertex") => MarkerAssociation::Vertex,
        Some("nearest") => MarkerAssociation::Nearest,
        Some("triangle") => MarkerAssociation::Triangle,
        Some(other) => {
            let remedy = "write vertex, nearest or triangle";
            return Err(wrong("association", format!("{other:?} is none"), remedy));
        }
    };
    let depth = match file.depth.as_deref().map(str::parse::<Depth>) {
        None => Depth::Measured,
        Some(Ok(depth)) => depth,
        Some(Err(_)) => {
            let what = format!("{:?} is none", file.depth.unwrap_or_default());
            return Err(wrong("depth", what, "write measured or surface"));
        }
    };
    if let Some(lid) = file.lids.iter().find(|lid| face.iter().all(|m| m.label != lid.marker)) {
        return Err(wrong(
            "lids",
            format!("marker {:?} is not among the markers", lid.marker),
            "give its place there",
        ));
    }
    let origin = match (file.suggested, file.layout) {
        (true, _) => MapOrigin::Suggested,
        (false, Some(_)) => MapOrigin::Layout,
        (false, None) => MapOrigin::Unknown,
    };
    let (avatar, head, lids) = (file.avatar, file.head, file.lids);
    Ok(MarkerMap { avatar, face, head, neutral, association, scale, depth, lids, origin })
}

/// A range of frames.
fn span(given: Option<[usize; 2]>, place: &str) -> Result<Option<Range<usize>>, MapFileError> {
    match given {
        None => Ok(None),
        Some([first, end]) if first < end => Ok(Some(first..end)),
        Some([first, end]) => Err(MapFileError {
            place: place.to_owned(),
            what: format!("frames {first}:{end} are none"),
            remedy: "give the first frame and the one after the last",
        }),
    }
}

/// Scale factors, which are positive: a negative one would mirror the motion.
fn factors(given: Factors, place: &str) -> Result<[f64; 3], MapFileError> {
    let factors = match given {
        Factors::One(x) => [x; 3],
        Factors::Each(each) => each,
    };
    match factors.iter().find(|x| !(x.is_finite() && **x >= 0.0)) {
        None => Ok(factors),
        Some(x) => Err(MapFileError {
            place: place.to_owned(),
            what: format!("is {x}"),
            remedy: "give a number of 0 or more, or three for x, y and z",
        }),
    }
}
