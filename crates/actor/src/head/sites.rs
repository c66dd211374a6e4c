//! Where markers are put on any built-in head: names of places on the cage, the same for everyone.

use super::topology::{Feature, Site, Topology};
use super::{HeadSpec, Subdivided};

/// Marker labels and the skin vertices they are stuck to.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct MarkerSites {
    /// The face's markers, then the head's.
    pub labels: Vec<String>,
    /// Vertex of [`mimique_avatar::Avatar::skin`] of each label.
    pub vertices: Vec<u32>,
    /// How many of them are the face's; the rest sit on the skull and move rigidly.
    pub face_count: usize,
}

impl MarkerSites {
    /// Labels of the face's markers.
    pub fn face_labels(&self) -> &[String] {
        &self.labels[..self.face_count]
    }

    /// Labels of the head's markers.
    pub fn head_labels(&self) -> &[String] {
        &self.labels[self.face_count..]
    }
}

/// On the midline.
const MIDDLE: [(&str, Site); 6] = [
    ("forehead", Site::Grid(2, 0)),
    ("glabella", Site::Grid(4, 0)),
    ("nose_tip", Site::Grid(11, 0)),
    ("lip_upper", Site::Ring(Feature::Mouth, 2, 5)),
    ("lip_lower", Site::Ring(Feature::Mouth, 2, 19)),
    ("chin", Site::Grid(21, 0)),
];

/// On the left; each has a twin on the right.
const PAIRS: [(&str, Site); 17] = [
    ("brow_inner", Site::Grid(4, 3)),
    ("brow_middle", Site::Grid(4, 6)),
    ("brow_outer", Site::Grid(4, 9)),
    ("forehead", Site::Grid(2, 5)),
    ("lid_upper", Site::Ring(Feature::EyeLeft, 3, 3)),
    ("lid_lower", Site::Ring(Feature::EyeLeft, 2, 13)),
    ("eye_outer", Site::Grid(6, 9)),
    ("cheek_upper", Site::Grid(8, 7)),
    ("cheek", Site::Grid(11, 8)),
    ("nose_wing", Site::Grid(11, 3)),
    ("nasolabial", Site::Grid(13, 5)),
    ("lip_upper", Site::Ring(Feature::Mouth, 2, 8)),
    ("mouth_corner", Site::Ring(Feature::Mouth, 2, 12)),
    ("lip_lower", Site::Ring(Feature::Mouth, 2, 16)),
    ("chin", Site::Grid(20, 4)),
    ("jaw", Site::Grid(20, 9)),
    ("cheek_lower", Site::Grid(16, 8)),
];

/// On the skull: these do not move with the face.
const HEAD: [(&str, Site); 6] = [
    ("head_front", Site::Cap(6, 2)),
    ("head_top", Site::Cap(6, 6)),
    ("head_left", Site::Grid(1, 14)),
    ("head_right", Site::Grid(1, -14)),
    ("head_back_left", Site::Grid(4, 20)),
    ("head_back_right", Site::Grid(4, -20)),
];

/// Forty face markers and six head markers on the head that `spec` builds. Labels and places are the
/// same for every identity; vertex numbers depend on the density alone.
pub fn marker_sites(spec: &HeadSpec) -> MarkerSites {
    let topology = Topology::new();
    let own = Subdivided::new(&topology, spec.density).skin_vertex_of_cage();
    let mut sites = MarkerSites { labels: Vec::new(), vertices: Vec::new(), face_count: 0 };
    let mut add = |label: String, cage_vertex: usize| {
        sites.labels.push(label);
        sites.vertices.push(own[cage_vertex]);
    };
    for (name, site) in MIDDLE {
        add(name.to_string(), topology.at(site));
    }
    for (name, site) in PAIRS {
        let v = topology.at(site);
        add(format!("{name}_left"), v);
        add(format!("{name}_right"), topology.mirror[v] as usize);
    }
    for (name, site) in HEAD {
        add(name.to_string(), topology.at(site));
    }
    sites.face_count = sites.labels.len() - HEAD.len();
    sites
}
