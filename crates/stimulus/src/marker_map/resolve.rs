//! From places to vertices of a skin.

use super::{MarkerMap, MarkerPlace};
use crate::AvatarSkin;

/// How far a marker's position may be from its vertex, metres.
pub const TOLERANCE_M: f64 = 1e-4;

/// A marker map that does not fit the avatar.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum MapError {
    /// Positions that are not on the skin.
    #[error("{}; give positions on the neutral skin of {avatar}, within 0.1 mm of a vertex", list(.markers))]
    OffTheSkin {
        /// The avatar.
        avatar: String,
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
    /// The welded vertex of each face marker: label and vertex, in the map's order.
    ///
    /// # Errors
    /// [`MapError`] with labels and distances.
    pub fn resolve(&self, skin: &AvatarSkin) -> Result<Vec<(String, usize)>, MapError> {
        let mut found: Vec<(String, usize)> = Vec::new();
        let mut off = Vec::new();
        for marker in &self.face {
            let label = marker.label.clone();
            let vertex = match marker.place {
                MarkerPlace::Position(p) => match skin.nearest(p) {
                    Some((vertex, distance)) if distance <= TOLERANCE_M => vertex,
                    other => {
                        off.push((label, other.map_or(f64::INFINITY, |(_, distance)| distance)));
                        continue;
                    }
                },
                MarkerPlace::Vertex(vertex) => {
                    let count = skin.welded_from_file.len();
                    match skin.welded_from_file.get(vertex as usize) {
                        Some(&welded) => welded as usize,
                        None => return Err(MapError::NoVertex { label, vertex, count }),
                    }
                }
            };
            if let Some((first, _)) = found.iter().find(|(_, v)| *v == vertex) {
                return Err(MapError::SameVertex { first: first.clone(), second: label, vertex });
            }
            found.push((label, vertex));
        }
        if off.is_empty() {
            Ok(found)
        } else {
            Err(MapError::OffTheSkin { avatar: skin.name.clone(), markers: off })
        }
    }
}
