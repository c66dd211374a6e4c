//! What a take is known by: hashes of its markers, and of everything that its weights follow from.

use mimique_geometry::coordinates;
use mimique_solver::{MarkerSite, MethodSpec};
use serde_json::{Value, json};

use super::JoinedTake;
use crate::provenance::Provenance;

impl JoinedTake<'_> {
    /// Avatar, capture, map and method: everything that the weights follow from.
    pub fn provenance(&self, spec: &MethodSpec) -> Provenance {
        let mesh = &self.skin.mesh;
        let corners: Vec<f64> = mesh.triangles.iter().flatten().map(|&v| f64::from(v)).collect();
        let mut shapes = Vec::new();
        for shape in &mesh.shapes {
            shapes.push(shape.vertices.len() as f64);
            shapes.extend(shape.vertices.iter().map(|&v| f64::from(v)));
            shapes.extend(coordinates(&shape.deltas));
        }
        let mut made = Provenance::new()
            .numbers("avatar.positions", coordinates(&mesh.positions))
            .numbers("avatar.triangles", &corners)
            .numbers("avatar.shapes", &shapes)
            .json("avatar.shapeNames", self.skin.shape_names.clone())
            .numbers("capture.positions", &self.positions)
            .json("capture.rateHz", self.rate_hz)
            .json("capture.labels", self.labels.clone())
            .json("map.markers", self.places())
            .json("map.head", self.head_labels())
            .json("map.neutral", json!([self.neutral.start, self.neutral.end]))
            .method(spec);
        if let Some(repair) = &self.repair {
            made = made.json("capture.repair", repair.as_str());
        }
        if !self.lids.is_empty() {
            let lids = self.lids.iter().map(|l| json!([l.label, l.edge, l.closed, l.wide]));
            made = made.json("map.lids", lids.collect::<Vec<_>>());
        }
        if let Some(gaze) = &self.gaze {
            made = made.json("gaze", gaze.given().key());
        }
        if self.head_motion != 0.0 {
            made = made.json("headMotion", self.head_motion);
        }
        self.adjustments(made)
    }

    /// A hash of the face markers and their places on the skin.
    pub(crate) fn marker_key(&self) -> String {
        Provenance::default().json("markers", self.places()).hash()
    }

    /// The markers, each with its vertex, or corners and barycentric coordinates.
    fn places(&self) -> Value {
        let place = |site: &MarkerSite| -> Value {
            match site.parts().collect::<Vec<_>>()[..] {
                [(vertex, _)] => json!(vertex),
                ref parts => json!(parts),
            }
        };
        self.markers.iter().map(|site| json!([site.label, place(site)])).collect()
    }
}
