//! Where each marker of a capture sits on the avatar, and which markers move with the head.
//!
//! Two forms are read: JSON with positions on the neutral skin (or vertices of the file), and CSV
//! `marker,role,vertex` with role `face` or `head`.

mod csv;
mod json;
mod resolve;
mod write;

use std::collections::BTreeMap;
use std::ops::Range;

use crate::Lid;
use mimique_geometry::Point;

pub use resolve::{MapError, REACH_M, TOLERANCE_M};

/// A marker map as read; [`MarkerMap::resolve`] finds its vertices on a skin.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct MarkerMap {
    /// The avatar that it is for, where it says so.
    pub avatar: Option<String>,
    /// The face markers, in the file's order.
    pub face: Vec<MappedMarker>,
    /// The markers that move rigidly with the head; they may be face markers too.
    pub head: Vec<String>,
    /// Frames of the neutral face, counted from 0, the end not included.
    pub neutral: Option<Range<usize>>,
    /// How positions are tied to the skin.
    pub association: MarkerAssociation,
    /// Scale factors of the displacements.
    pub scale: ScaleRule,
    /// Where the third coordinate comes from.
    pub depth: Depth,
    /// Lid markers and the shapes that they drive; they take no part in the solve.
    pub lids: Vec<Lid>,
    /// Who made it.
    pub origin: MapOrigin,
}

/// Who made a marker map: whether its places are where markers are, or where they should be.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum MapOrigin {
    /// Somebody.
    #[default]
    Unknown,
    /// The program suggested it from a capture (`"suggested": true`).
    Suggested,
    /// It is a layout (`"layout": {...}`), by which markers are put on by hand.
    Layout,
}

/// How a marker's position is tied to the skin (Kouadio 4.3.1).
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum MarkerAssociation {
    /// To the vertex there, within [`TOLERANCE_M`].
    #[default]
    Vertex,
    /// Point to point: to the nearest vertex that no marker before it has, within [`REACH_M`].
    Nearest,
    /// To the nearest point of the surface, inside a triangle by its barycentric coordinates
    /// (eq. 4.8-4.11), within [`REACH_M`].
    Triangle,
}

/// Factors of the markers' displacements (Kouadio 5.3, eq. 5.1); none given = as measured.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ScaleRule {
    /// Frames of the range of motion, counted from 0, that the automatic factors come from.
    pub automatic: Option<Range<usize>>,
    /// Factors of x, y, z for all markers, in the avatar's axes.
    pub global: Option<[f64; 3]>,
    /// Factors by hand, by label.
    pub markers: BTreeMap<String, [f64; 3]>,
}

/// Where the third coordinate of the displacements comes from.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Depth {
    /// From the capture.
    #[default]
    Measured,
    /// The capture is two-dimensional (x, y): from the skin's surface (Kouadio, eq. 4.12).
    Surface,
}

impl ScaleRule {
    /// Whether nothing is scaled.
    pub fn is_none(&self) -> bool {
        self.automatic.is_none() && self.global.is_none() && self.markers.is_empty()
    }
}

impl std::str::FromStr for Depth {
    type Err = String;

    fn from_str(word: &str) -> Result<Self, String> {
        match word {
            "measured" => Ok(Self::Measured),
            "surface" => Ok(Self::Surface),
            _ => Err(format!("{word:?}; write measured or surface")),
        }
    }
}

/// A face marker and its place on the skin.
#[derive(Debug, Clone, PartialEq)]
pub struct MappedMarker {
    /// The capture's label.
    pub label: String,
    /// Where it sits.
    pub place: MarkerPlace,
}

/// A place on the neutral skin.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum MarkerPlace {
    /// Metres; decides within [`TOLERANCE_M`].
    Position(Point),
    /// Index in the avatar file's own order.
    Vertex(u32),
}

/// A marker map that cannot be read.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{place}: {what}; {remedy}")]
pub struct MapFileError {
    /// Line, or JSON path.
    pub place: String,
    /// What is wrong, with the value.
    pub what: String,
    /// What to do.
    pub remedy: &'static str,
}

impl MarkerMap {
    /// Reads either form, told apart by the first character.
    ///
    /// # Errors
    /// [`MapFileError`] with line or path: not the form, a label twice, a number that is none.
    pub fn from_text(text: &str) -> Result<Self, MapFileError> {
        let text = text.trim_start_matches('\u{feff}');
        let map =
            if text.trim_start().starts_with('{') { json::read(text) } else { csv::read(text) }?;
        if map.face.is_empty() {
            return Err(MapFileError {
                place: "marker map".to_owned(),
                what: "no face marker".to_owned(),
                remedy: "name at least four markers on the face",
            });
        }
        Ok(map)
    }

    /// The same of a file's bytes, which may be something else altogether.
    ///
    /// # Errors
    /// As [`MarkerMap::from_text`]; a capture, an avatar or a text that is not UTF-8 is named as what it is.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, MapFileError> {
        let is_another = |what: String, remedy| {
            Err(MapFileError { place: "marker map".to_owned(), what, remedy })
        };
        if bytes.starts_with(b"glTF") {
            return is_another(
                "the file is an avatar (GLB), no marker map".to_owned(),
                "name the file that says where each marker sits on the avatar",
            );
        }
        match std::str::from_utf8(bytes) {
            Ok(text) if is_map(text) => Self::from_text(text),
            text => match (mimique_mocap::recognise(bytes), text) {
                (Some(format), _) => is_another(
                    format!("the file is a capture ({}), no marker map", format.name),
                    "name the file that says where each marker sits on the avatar; `mimique preview` writes one",
                ),
                (None, Ok(text)) => Self::from_text(text),
                (None, Err(error)) => is_another(
                    format!("byte {}: not UTF-8", error.valid_up_to()),
                    "save the map as UTF-8 text, JSON or CSV",
                ),
            },
        }
    }

    /// The label of every face marker, in order.
    pub fn face_labels(&self) -> impl Iterator<Item = &str> {
        self.face.iter().map(|m| m.label.as_str())
    }
}

/// Whether a text opens as a map does, in either form.
fn is_map(text: &str) -> bool {
    let text = text.trim_start_matches('\u{feff}').trim_start();
    text.starts_with('{') || text.starts_with("marker,")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn json_keeps_its_order_and_converts_its_unit() {
        let map = MarkerMap::from_text(
            r#"{"avatar": "Ada", "unit": "mm", "note": "anything",
               "markers": {"Z": {"position": [1, 2, 3]}, "A": {"vertex": 7}},
               "head": ["Z"], "neutral": [0, 60]}"#,
        )
        .unwrap();
        assert_eq!(map.avatar.as_deref(), Some("Ada"));
        assert_eq!(map.face_labels().collect::<Vec<_>>(), ["Z", "A"]);
        assert_eq!(map.face[0].place, MarkerPlace::Position(Point::new(0.001, 0.002, 0.003)));
        assert_eq!(map.face[1].place, MarkerPlace::Vertex(7));
        assert_eq!(map.head, ["Z"]);
        assert_eq!(map.neutral, Some(0..60));
    }

    #[test]
    fn json_says_how_markers_are_tied_and_scaled() {
        let map = MarkerMap::from_text(
            r#"{"markers": {"A": {"vertex": 1, "scale": 1.5}, "B": {"vertex": 2}},
               "association": "triangle", "depth": "surface",
               "scale": {"automatic": [0, 600], "global": [1, 1.2, 0.8]}}"#,
        )
        .unwrap();
        assert_eq!((map.association, map.depth), (MarkerAssociation::Triangle, Depth::Surface));
        assert_eq!(map.scale.automatic, Some(0..600));
        assert_eq!(map.scale.global, Some([1.0, 1.2, 0.8]));
        assert_eq!(map.scale.markers, BTreeMap::from([("A".to_owned(), [1.5; 3])]));
        assert!(
            MarkerMap::from_text(r#"{"markers": {"A": {"vertex": 1}}}"#).unwrap().scale.is_none()
        );
    }

    #[test]
    fn csv_knows_face_and_head() {
        let map =
            MarkerMap::from_text("marker,role,vertex\r\nA,face,3\r\nH0,head,9\r\n\r\n").unwrap();
        assert_eq!(map.face, [MappedMarker { label: "A".into(), place: MarkerPlace::Vertex(3) }]);
        assert_eq!(map.head, ["H0"]);
    }

    #[test]
    fn what_is_wrong_is_named_with_its_place() {
        for (text, place, what) in [
            ("marker,role,vertex\nA,nose,3\n", "line 2", "role \"nose\""),
            ("marker,role,vertex\nA,face,x\n", "line 2", "vertex \"x\""),
            ("marker,role,vertex\nA,face,1\nA,face,2\n", "line 3", "marker \"A\" twice"),
            ("marker;role\n", "line 1", "marker;role"),
            (r#"{"markers": {"A": {"vertex": 1}, "A": {"vertex": 2}}}"#, "markers", "\"A\" twice"),
            (r#"{"markers": {"A": {}}}"#, "markers.A", "neither position nor vertex"),
            (r#"{"markers": {"A": {"vertex": 1}}, "unit": "inch"}"#, "unit", "inch"),
            (r#"{"markers": {"A": {"vertex": 1}}, "neutral": [60, 0]}"#, "neutral", "60:0"),
            (r#"{"markers": {"A": {"vertex": 1}}, "association": "glue"}"#, "association", "glue"),
            (r#"{"markers": {"A": {"vertex": 1}}, "depth": "guess"}"#, "depth", "guess"),
            (
                r#"{"markers": {"A": {"vertex": 1}}, "scale": {"automatic": [9, 9]}}"#,
                "scale",
                "9:9",
            ),
            (r#"{"markers": {"A": {"vertex": 1, "scale": -1}}}"#, "markers.A.scale", "-1"),
            (r#"{"markers": {}}"#, "marker map", "no face marker"),
            (r#"{"markers": "#, "JSON", ""),
            ("", "line 1", ""),
        ] {
            let error = MarkerMap::from_text(text).unwrap_err();
            assert!(error.place.contains(place), "{text}: {error}");
            assert!(error.what.contains(what), "{text}: {error}");
        }
    }
}
