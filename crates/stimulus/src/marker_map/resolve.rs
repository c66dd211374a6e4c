//! From places to vertices and triangles of a skin.

use mimique_geometry::Point;
use mimique_solver::MarkerSite;

use super::{MarkerAssociation, MarkerMap, MarkerPlace};
use crate::AvatarSkin;

/// How far a marker's position may be from its vertex, metres.
pub const TOLERANCE_M: f64 = 1e-4;

/// How far a position may be from the skin where it is tied to the nearest vertex or point, metres:
/// markers stand off the skin by some millimetres.
pub const REACH_M: f64 = 1e-2;

/// A marker map that does not fit the avatar.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum MapError {
    /// Positions that are not on the skin.
    #[error(
        "{}; give positions on the neutral skin of {avatar}, within {tolerance_mm} mm of {}",
        list(.markers), target(*.tolerance_mm)
    )]
    OffTheSkin {
        /// The avatar.
        avatar: String,
        /// How near they should be, millimetres.
        tolerance_mm: f64,
        /// Labels and distances in metres.
        markers: Vec<(String, f64)>,
    },
    /// A vertex that does not exist.
    #[error("marker {label}: vertex {vertex} of {count}; count from 0 in the avatar file's order")]
    NoVertex {
        /// The marker.
        label: String,
        /// The vertex named.
        vertex: u32,
        /// How many the skin has.
        count: usize,
    },
    /// Two markers at one vertex.
    #[error("markers {first} and {second}: both at vertex {vertex}; give each a place of its own")]
    SameVertex {
        /// The marker that has it.
        first: String,
        /// The one that comes after.
        second: String,
        /// Their welded vertex.
        vertex: usize,
    },
}

fn target(tolerance_mm: f64) -> &'static str {
    if tolerance_mm < 1.0 {
        "a vertex, or \"association\": \"triangle\" for places between vertices"
    } else {
        "it"
    }
}

fn list(markers: &[(String, f64)]) -> String {
    let named: Vec<String> = markers
        .iter()
        .take(5)
        .map(|(label, metres)| format!("marker {label}: {:.2} mm off the skin", metres * 1e3))
        .collect();
    let more = markers.len() - named.len();
    match more {
        0 => named.join(", "),
        more => format!("{} and {more} more", named.join(", ")),
    }
}

impl MarkerMap {
    /// The place of each face marker on the welded skin, in the map's order.
    ///
    /// # Errors
    /// [`MapError`] with labels and distances.
    pub fn resolve(&self, skin: &AvatarSkin) -> Result<Vec<MarkerSite>, MapError> {
        let mut found: Vec<MarkerSite> = Vec::new();
        let mut off = Vec::new();
        let tolerance = match self.association {
            MarkerAssociation::Vertex => TOLERANCE_M,
            MarkerAssociation::Nearest | MarkerAssociation::Triangle => REACH_M,
        };
        for marker in &self.face {
            let label = marker.label.clone();
            let site = match marker.place {
                MarkerPlace::Position(p) => match self.tied(skin, &label, p, &found) {
                    Some((site, distance)) if distance <= tolerance => site,
                    other => {
                        off.push((label, other.map_or(f64::INFINITY, |(_, distance)| distance)));
                        continue;
                    }
                },
                MarkerPlace::Vertex(vertex) => {
                    let count = skin.welded_from_file.len();
                    match skin.welded_from_file.get(vertex as usize) {
                        Some(&welded) => MarkerSite::at_vertex(label, welded as usize),
                        None => return Err(MapError::NoVertex { label, vertex, count }),
                    }
                }
            };
            let same = |s: &&MarkerSite| (s.corners, s.weights) == (site.corners, site.weights);
            if let Some(first) = found.iter().find(same) {
                return Err(MapError::SameVertex {
                    first: first.label.clone(),
                    second: site.label.clone(),
                    vertex: site.vertex(),
                });
            }
            found.push(site);
        }
        if off.is_empty() {
            Ok(found)
        } else {
            let tolerance_mm = 1e3 * tolerance;
            Err(MapError::OffTheSkin { avatar: skin.name.clone(), tolerance_mm, markers: off })
        }
    }

    /// The place of a position and how far it is from it, metres.
    fn tied(
        &self,
        skin: &AvatarSkin,
        label: &str,
        position: Point,
        before: &[MarkerSite],
    ) -> Option<(MarkerSite, f64)> {
        match self.association {
            MarkerAssociation::Vertex => {
                let (vertex, distance) = skin.nearest(position)?;
                Some((MarkerSite::at_vertex(label, vertex), distance))
            }
            MarkerAssociation::Nearest => {
                let taken = |v: usize| before.iter().any(|s| s.vertex() == v);
                let (vertex, distance) = skin.nearest_where(position, |v| !taken(v))?;
                Some((MarkerSite::at_vertex(label, vertex), distance))
            }
            MarkerAssociation::Triangle => {
                let at = skin.mesh.nearest_on_surface(position)?;
                let site = match at.weights.iter().position(|w| *w == 1.0) {
                    Some(corner) => MarkerSite::at_vertex(label, at.corners[corner]),
                    None => MarkerSite {
                        label: label.to_owned(),
                        corners: at.corners,
                        weights: at.weights,
                    },
                };
                Some((site, at.distance))
            }
        }
    }
}
