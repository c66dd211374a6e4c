//! What a take is known by: hashes of its markers, and of everything that its weights follow from.

use mimique_solver::MethodSpec;

use crate::joined_take::JoinedTake;
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
            shapes.extend(shape.deltas.iter().flatten());
        }
        let lids: Vec<String> = (self.lids.iter())
            .map(|l| format!("{} {:?} {} {:?}", l.label, l.edge, l.closed, l.wide))
            .collect();
        let provenance = match &self.repair {
            Some(repair) => Provenance::new().text("capture.repair", repair),
            None => Provenance::new(),
        };
        let provenance = match lids.len() {
            0 => provenance,
            _ => provenance.text("map.lids", &lids.join("\n")),
        };
        let provenance = provenance
            .numbers("avatar.positions", mesh.positions.as_flattened())
            .numbers("avatar.triangles", &corners)
            .numbers("avatar.shapes", &shapes)
            .text("avatar.shapeNames", &self.skin.shape_names.join("\n"))
            .numbers("capture.positions", &self.positions)
            .numbers("capture.rate", &[self.rate_hz])
            .text("capture.labels", &self.labels.join("\n"))
            .numbers("map.vertices", &self.site_numbers())
            .text("map.head", &self.head_labels().join("\n"))
            .numbers("map.neutral", &[self.neutral.start as f64, self.neutral.end as f64])
            .method(spec);
        self.adjustments(provenance)
    }

    /// A hash of the face markers and their vertices.
    pub(crate) fn marker_key(&self) -> String {
        let labels: Vec<&str> = self.markers.iter().map(|site| site.label.as_str()).collect();
        Provenance::default()
            .text("labels", &labels.join("\n"))
            .numbers("vertices", &self.site_numbers())
            .hash()
    }

    /// The places of the markers as numbers: the vertex, or corners and coordinates.
    fn site_numbers(&self) -> Vec<f64> {
        let mut numbers = Vec::new();
        for site in &self.markers {
            let parts: Vec<(usize, f64)> = site.parts().collect();
            match parts[..] {
                [(vertex, _)] => numbers.push(vertex as f64),
                _ => numbers.extend(parts.iter().flat_map(|&(v, w)| [v as f64, w])),
            }
        }
        numbers
    }
}
