//! The lid markers of a take: columns of the capture, and the shapes that they drive.

use std::ops::Range;

use mimique_avatar::turns_eyes;
use mimique_clip::with_gaze_at_rest;
use mimique_geometry::{Point, RigidMotion};
use mimique_mocap::Capture;
use mimique_solver::{FrontEnd, Gaze, Group, MarkerSite, MethodSpec, Untold};

use super::joined::{JoinedTake, metres};
use super::lid_opening::{LidEdge, LidRange, actor_range, lid_weights};
use crate::{AvatarSkin, MarkerMap, TakeWarning};

/// A lid marker of the capture and the shapes of the avatar that it drives.
#[derive(Debug, Clone)]
pub(crate) struct JoinedLid {
    pub(crate) label: String,
    column: usize,
    pub(crate) edge: LidEdge,
    pub(crate) closed: String,
    pub(crate) wide: Option<String>,
    /// Vertical travel of the marker's vertex from closed to wide, metres.
    travel: LidRange,
}

impl JoinedTake<'_> {
    /// The method with the shapes held at 0 that its markers do not tell: those of the lids that lid
    /// markers drive, those that turn the eyes, and those that noise of 1 mm would move over their whole range
    /// ([`Untold`]).
    pub fn with_shapes_held(&self, spec: &MethodSpec) -> MethodSpec {
        let mut spec = with_gaze_at_rest(spec, &self.skin.shape_names);
        if !spec.method.uses(Group::Shapes) {
            return spec;
        }
        // A gaze that is given turns the eyes, and nothing else does.
        for name in self.gaze.iter().flat_map(|gaze| &gaze.names) {
            spec.bounds.remove(name);
            if !spec.locked.contains(name) {
                spec.locked.push(name.clone());
            }
        }
        for name in self.lids.iter().flat_map(|l| [Some(&l.closed), l.wide.as_ref()]).flatten() {
            let bounded = spec.bounds.contains_key(name);
            if !bounded && !spec.locked.contains(name) {
                spec.locked.push(name.clone());
            }
        }
        if spec.untold() == Untold::Hold {
            // Eyes that markers are asked to turn are asked for by name.
            let asked = |name: &str| spec.gaze() != Gaze::Rest && turns_eyes(name);
            let untold: Vec<&String> = self.untold().filter(|name| !asked(name)).collect();
            for name in untold {
                if !spec.bounds.contains_key(name) && !spec.locked.contains(name) {
                    spec.locked.push(name.clone());
                }
            }
        }
        spec
    }

    /// Names of the shapes that lid markers and a given gaze drive.
    pub(crate) fn driven_shapes(&self) -> impl Iterator<Item = &String> {
        let lids =
            self.lids.iter().flat_map(|lid| [Some(&lid.closed), lid.wide.as_ref()]).flatten();
        lids.chain(self.gaze.iter().flat_map(|gaze| &gaze.names))
    }

    /// The lid markers as columns after the others.
    pub(crate) fn add_lids(
        &mut self,
        capture: &Capture,
        map: &MarkerMap,
        lid_places: &[MarkerSite],
    ) {
        for lid in &map.lids {
            let place = lid_places.iter().find(|site| site.label == lid.marker);
            let (Some(place), true) = (place, capture.marker_index(&lid.marker).is_some()) else {
                self.warnings.push(TakeWarning::LidMarkerAbsent { marker: lid.marker.clone() });
                continue;
            };
            let vertex = place.vertex();
            let Some(closed) = travel_of(self.skin, &lid.closed, vertex) else {
                let (marker, shape) = (lid.marker.clone(), lid.closed.clone());
                self.warnings.push(TakeWarning::LidShapeAbsent { marker, shape });
                continue;
            };
            let wide = lid.wide.as_ref().and_then(|name| travel_of(self.skin, name, vertex));
            let ends = [closed, wide.unwrap_or(0.0), 0.0];
            let travel = [ends[0].min(ends[1]).min(0.0), ends[0].max(ends[1]).max(0.0)];
            let labels = &mut self.labels;
            let column = labels.iter().position(|l| *l == lid.marker).unwrap_or_else(|| {
                labels.push(lid.marker.clone());
                labels.len() - 1
            });
            self.lids.push(JoinedLid {
                label: lid.marker.clone(),
                column,
                edge: lid.edge,
                closed: lid.closed.clone(),
                wide: lid.wide.clone().filter(|_| wide.is_some()),
                travel,
            });
        }
        if !self.lids.is_empty() {
            self.positions = metres(capture, &self.labels);
        }
    }

    /// The shapes that lid markers drive and their weights in some frames. The lids' travel and
    /// neutral are those of the whole take.
    pub(crate) fn lid_tracks(
        &self,
        front_end: &FrontEnd,
        poses: &[RigidMotion],
        frames: Range<usize>,
    ) -> (Vec<String>, Vec<f64>) {
        let mut tracks: Vec<(String, Vec<f64>)> = Vec::new();
        for lid in &self.lids {
            // How high the marker stands, along the avatar's vertical.
            let places: Vec<f64> = (poses.iter().enumerate())
                .map(|(frame, pose)| {
                    let at = 3 * (frame * self.labels.len() + lid.column);
                    let p = &self.positions[at..at + 3];
                    let held = pose.apply(Point::new(p[0], p[1], p[2]));
                    front_end.avatar_from_actor().rotate(held - Point::ORIGIN).y
                })
                .collect();
            let rest: Vec<f64> =
                places[self.neutral.clone()].iter().copied().filter(|y| !y.is_nan()).collect();
            let rest = rest.iter().sum::<f64>() / rest.len() as f64;
            let heights: Vec<f64> = places.iter().map(|y| y - rest).collect();
            let actor = actor_range(&heights, lid.travel, lid.edge);
            // A lid that is not seen stays where it was last.
            let mut last = 0.0;
            let weights: Vec<(f64, f64)> = heights
                .into_iter()
                .map(|y| {
                    last = if y.is_finite() { y } else { last };
                    lid_weights(last, actor, lid.travel, lid.edge)
                })
                .collect();
            let shapes = [Some((&lid.closed, true)), lid.wide.as_ref().map(|w| (w, false))];
            for (name, closes) in shapes.into_iter().flatten() {
                let own = weights[frames.clone()].iter().map(|w| if closes { w.0 } else { w.1 });
                match tracks.iter_mut().find(|(n, _)| n == name) {
                    // Of two markers that drive one shape the stronger counts.
                    Some((_, track)) => {
                        track.iter_mut().zip(own).for_each(|(a, b)| *a = a.max(b));
                    }
                    None => tracks.push((name.clone(), own.collect())),
                }
            }
        }
        let (names, tracks): (Vec<String>, Vec<Vec<f64>>) = tracks.into_iter().unzip();
        let rows = (0..frames.len()).flat_map(|f| tracks.iter().map(move |t| t[f]));
        let weights = rows.collect();
        (names, weights)
    }
}

/// Vertical displacement of a vertex by a shape at weight 1, metres; `None` without such a shape.
fn travel_of(skin: &AvatarSkin, shape: &str, vertex: usize) -> Option<f64> {
    let shape = skin.shape_names.iter().position(|n| n == shape)?;
    let moved = &skin.mesh.shapes[shape];
    let place = moved.vertices.iter().position(|v| *v as usize == vertex);
    Some(place.map_or(0.0, |p| moved.deltas[p][1]))
}
