//! What a person measures to find the place of a marker: millimetres from landmarks.

use mimique_geometry::Point;
use mimique_solver::SkinMesh;
use serde::Serialize;

use super::along_skin::AlongSkin;
use crate::face::Face;
use crate::layout::Layout;

/// A distance to a landmark.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ToLandmark {
    /// The landmark.
    pub landmark: &'static str,
    /// Along the skin, millimetres.
    pub mm: f64,
}

/// How a marker is found on a face.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct Measures {
    /// Its number on the sheet.
    pub number: usize,
    /// Its label.
    pub label: String,
    /// To the person's left of the middle plane, millimetres; below 0 to the right.
    pub left_mm: f64,
    /// Above the nasion, millimetres; below 0 below it.
    pub above_nasion_mm: f64,
    /// From the nasion in a straight line, millimetres.
    pub from_nasion_mm: f64,
    /// Along the skin to the two nearest landmarks.
    pub along_skin: [ToLandmark; 2],
}

impl Measures {
    /// Of every marker of a layout, the head's after the face's, on a skin that is the avatar's or scaled from it
    /// by `scaled`.
    pub fn of(
        face: &Face<'_>,
        layout: &Layout,
        mesh: &SkinMesh,
        scaled: &dyn Fn(Point) -> Point,
    ) -> Vec<Self> {
        let skin = AlongSkin::new(mesh);
        let landmarks: Vec<(&'static str, Vec<f64>)> = (face.landmarks.measured().into_iter())
            .map(|(name, p)| (name, skin.from_point(scaled(p))))
            .collect();
        let nasion = scaled(face.landmarks.nasion);
        let markers = layout.markers.iter().chain(&layout.head).enumerate();
        markers
            .map(|(number, marker)| {
                let v = marker.vertex;
                let p = mesh.positions[v];
                let mut near: Vec<ToLandmark> = (landmarks.iter())
                    .map(|(landmark, distances)| ToLandmark { landmark, mm: 1e3 * distances[v] })
                    .collect();
                near.sort_by(|a, b| a.mm.total_cmp(&b.mm));
                near.truncate(2);
                let along_skin = near.try_into().unwrap_or_else(|_| {
                    [0, 1].map(|_| ToLandmark { landmark: "nasion", mm: f64::INFINITY })
                });
                let aside = face.mirror.plane.distance(face.place(v));
                let widened = (scaled(Point::new(1.0, 0.0, 0.0)) - scaled(Point::ORIGIN)).x;
                Self {
                    number: number + 1,
                    label: marker.label.clone(),
                    left_mm: 1e3 * aside * widened,
                    above_nasion_mm: 1e3 * (p.y - nasion.y),
                    from_nasion_mm: 1e3 * (p - nasion).length(),
                    along_skin,
                }
            })
            .collect()
    }

    /// The row of a table: number, label, side, height, straight, and skin and landmark twice.
    pub fn cells(&self) -> [String; 9] {
        let side = match self.left_mm {
            x if x.abs() < 0.5 => "middle".to_owned(),
            x if x > 0.0 => format!("{x:.0} left"),
            x => format!("{:.0} right", -x),
        };
        let [first, second] = &self.along_skin;
        [
            self.number.to_string(),
            self.label.clone(),
            side,
            format!("{:+.0}", self.above_nasion_mm),
            format!("{:.0}", self.from_nasion_mm),
            format!("{:.0}", first.mm),
            first.landmark.to_owned(),
            format!("{:.0}", second.mm),
            second.landmark.to_owned(),
        ]
    }
}
