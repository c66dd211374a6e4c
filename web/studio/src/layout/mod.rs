//! A marker layout on the head: made by a method or taken from a marker map, dragged, thinned, judged with every
//! drag, saved as a marker map.

mod bindings;
mod ground;
mod made;
mod state;

use mimique_geometry::Point;
use mimique_layout::{Conditions, DISTANCE_M, head_places};
use mimique_solver::MarkerSite;
use mimique_stimulus::{MarkerMap, MarkerPlace};
use serde_json::{Value, json};

use crate::problem::Problem;
use crate::workspace::Workspace;
use ground::Ground;

/// What errors of layouts are about.
const WHAT: &str = "layout";
/// Fewer markers tell no face.
const LEAST: usize = 4;
/// Steps that can be taken back.
const STEPS: usize = 200;

/// The layout, and what was done to it.
#[derive(Debug, Default)]
pub(crate) struct LayoutDesk {
    ground: Option<Ground>,
    now: Option<OnHead>,
    before: Vec<OnHead>,
    /// The markers as they were made or opened: what the curve is held against.
    first: Vec<usize>,
    /// What a rehearsal of the markers as they are has said.
    rehearsed: Option<Rehearsed>,
}

/// Markers on the head.
#[derive(Debug, Clone)]
struct OnHead {
    /// The map: a marker that was not moved keeps its place to the last digit.
    map: MarkerMap,
    /// The vertex of each face marker.
    vertices: Vec<usize>,
    /// Places of head markers, where they are known.
    heads: Vec<(String, Point)>,
    /// What is written of it: the method with its numbers, or the map's name.
    origin: Value,
}

/// Errors in simulated takes, millimetres.
#[derive(Debug, Clone)]
struct Rehearsed {
    all_mm: Option<f64>,
    missed_mm: Vec<Option<f64>>,
}

impl LayoutDesk {
    /// Another avatar: nothing stays.
    pub(crate) fn avatar_changed(&mut self) {
        *self = Self::default();
    }

    /// Other motion: the markers stay.
    pub(crate) fn motion_changed(&mut self) {
        self.ground = None;
        self.rehearsed = None;
    }

    /// Another layout; what was before is gone.
    fn put(&mut self, layout: OnHead) {
        self.first.clone_from(&layout.vertices);
        self.before.clear();
        self.rehearsed = None;
        self.now = Some(layout);
    }

    /// The layout that is about to be changed; with `step` it can be had back as it is now.
    fn change(&mut self, step: bool) -> Result<&mut OnHead, Problem> {
        let now = self.now.as_mut().ok_or_else(none)?;
        if step {
            self.before.push(now.clone());
            let over = self.before.len().saturating_sub(STEPS);
            self.before.drain(..over);
        }
        self.rehearsed = None;
        Ok(now)
    }
}

fn none() -> Problem {
    Problem::of(WHAT, "none yet; make one, or open a marker map")
}

impl Workspace {
    /// Takes the markers of a map's file: JSON, or CSV with `marker,role,vertex`.
    ///
    /// # Errors
    /// [`Problem`] with the file's name.
    pub fn layout_file(&mut self, file: &str, text: &str) -> Result<Value, Problem> {
        let map = MarkerMap::from_text(text).map_err(|e| Problem::of(file, e))?;
        self.put_map(file, map, text)
    }

    /// Takes the markers of the marker map that lies on the workspace.
    ///
    /// # Errors
    /// [`Problem`]: it has no marker on the face, or does not fit the avatar.
    pub fn layout_from_map(&mut self) -> Result<Value, Problem> {
        self.put_map("marker map", self.map.clone(), "")
    }

    fn put_map(&mut self, name: &str, map: MarkerMap, text: &str) -> Result<Value, Problem> {
        self.prepare_ground()?;
        let mesh = &self.face()?.skin.mesh;
        let sites = map.resolve(&self.face()?.skin).map_err(|e| Problem::of(name, e))?;
        if sites.len() < LEAST {
            let what =
                format!("{} markers on the face; a face needs at least {LEAST}", sites.len());
            return Err(Problem::of(name, what));
        }
        let heads = head_places(&map.head, &sites, mesh, text);
        let vertices = sites.iter().map(MarkerSite::vertex).collect();
        let origin = json!({"map": name});
        self.layout.put(OnHead { map, vertices, heads, origin });
        self.layout_state()
    }

    /// Moves a marker to a vertex of the skin; with `partner` the marker that mirrors it, if one does, goes to
    /// the mirror image. A vertex that has a marker already gets no other. With `step` that is a step that can
    /// be taken back: the first movement of a drag.
    ///
    /// # Errors
    /// [`Problem`]: no such marker or vertex.
    pub fn move_layout_marker(
        &mut self,
        index: usize,
        vertex: usize,
        partner: bool,
        step: bool,
    ) -> Result<Value, Problem> {
        self.prepare_ground()?;
        let positions = &self.face.as_ref().ok_or_else(none)?.skin.mesh.positions;
        let ground = self.layout.ground.as_ref().ok_or_else(none)?;
        let vertices = &self.layout.now.as_ref().ok_or_else(none)?.vertices;
        let (markers, count) = (vertices.len(), positions.len());
        let Some(&from) = vertices.get(index) else {
            return Err(Problem::of(WHAT, format!("marker {index} of {markers}; choose another")));
        };
        if vertex >= count {
            let what = format!("vertex {vertex} of {count}; drop the marker on the face");
            return Err(Problem::of(WHAT, what));
        }
        let mut moves = vec![(index, vertex)];
        let mirrored = ground.partner(from).and_then(|v| vertices.iter().position(|&own| own == v));
        if let (true, Some(other), Some(image)) = (partner, mirrored, ground.partner(vertex)) {
            moves.push((other, image));
        }
        let free = |&(marker, to): &(usize, usize)| {
            vertices.iter().enumerate().all(|(own, &vertex)| vertex != to || own == marker)
        };
        if moves.iter().all(free) {
            let places: Vec<Point> = moves.iter().map(|&(_, to)| positions[to]).collect();
            let now = self.layout.change(step)?;
            for (&(marker, to), place) in moves.iter().zip(places) {
                now.vertices[marker] = to;
                now.map.face[marker].place = MarkerPlace::Position(place);
            }
        }
        self.layout_state()
    }

    /// Takes a marker away; a head marker stays one.
    ///
    /// # Errors
    /// [`Problem`]: no such marker, or too few would be left.
    pub fn drop_layout_marker(&mut self, index: usize) -> Result<Value, Problem> {
        let markers = self.layout.now.as_ref().ok_or_else(none)?.vertices.len();
        if index >= markers {
            return Err(Problem::of(WHAT, format!("marker {index} of {markers}; choose another")));
        }
        if markers <= LEAST {
            let what = format!("{markers} markers are left; a face needs at least {LEAST}");
            return Err(Problem::of(WHAT, what));
        }
        let now = self.layout.change(true)?;
        now.vertices.remove(index);
        let gone = now.map.face.remove(index).label;
        now.map.scale.markers.remove(&gone);
        self.layout_state()
    }

    /// Takes the last step back.
    ///
    /// # Errors
    /// [`Problem`]: nothing was done.
    pub fn undo_layout(&mut self) -> Result<Value, Problem> {
        let before = self.layout.before.pop();
        let before = before.ok_or_else(|| Problem::of(WHAT, "nothing was done to it yet"))?;
        self.layout.rehearsed = None;
        self.layout.now = Some(before);
        self.layout_state()
    }

    /// The layout as the JSON of a marker map, which `mimique solve --markers` takes.
    ///
    /// # Errors
    /// [`Problem`]: there is none.
    pub fn layout_json(&mut self) -> Result<String, Problem> {
        self.prepare_ground()?;
        let OnHead { map, vertices, heads, origin } = self.layout.now.clone().ok_or_else(none)?;
        let (curve, _) = self.layout.curve(&vertices)?;
        let Conditions { noise, slip, .. } = Conditions::BY_HAND;
        let mut about = origin;
        about["changed"] = json!(vertices != self.layout.first);
        about["motion"] = self.layout_motion();
        about["noiseMm"] = json!(1e3 * noise);
        about["slipMm"] = json!(1e3 * slip);
        about["minimumDistanceMm"] = json!(1e3 * DISTANCE_M);
        about["expectedErrorMm"] = json!(curve.last());
        let head: serde_json::Map<String, Value> =
            (heads.into_iter()).map(|(label, place)| (label, json!({"position": place}))).collect();
        if !head.is_empty() {
            about["head"] = Value::Object(head);
        }
        Ok(map.to_json_with(&[("layout", about)]))
    }
}
