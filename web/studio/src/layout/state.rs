//! A layout as the page shows it.

use mimique_layout::{DISTANCE_M, MotionSource};
use serde_json::{Value, json};

use super::{LayoutDesk, OnHead, none};
use crate::problem::Problem;
use crate::workspace::Workspace;

impl LayoutDesk {
    /// The expected error of some markers in their order, before the first, after it, and so on, and without
    /// each of them, millimetres.
    pub(super) fn curve(&mut self, vertices: &[usize]) -> Result<(Vec<f64>, Vec<f64>), Problem> {
        let ground = self.ground.as_mut().ok_or_else(none)?;
        let curve = ground.curve.of(&ground.gradients, &ground.motion, vertices);
        let mm = |metres: Vec<f64>| metres.into_iter().map(|m| 1e3 * m).collect();
        Ok((mm(curve), mm(ground.curve.without_each())))
    }

    /// The curve of the markers as they were made or opened, millimetres.
    fn first_curve(&mut self) -> Result<Vec<f64>, Problem> {
        let ground = self.ground.as_mut().ok_or_else(none)?;
        let curve = ground.first_curve.of(&ground.gradients, &ground.motion, &self.first);
        Ok(curve.into_iter().map(|m| 1e3 * m).collect())
    }
}

impl Workspace {
    /// The motion that the layout is judged by: its source, and the take's name.
    pub(super) fn layout_motion(&self) -> Value {
        let motion = self.layout.ground.as_ref().map(|ground| &ground.motion);
        json!({
            "source": motion.map_or(MotionSource::IndependentShapes, |motion| motion.source),
            "name": motion.and_then(|motion| motion.people.first()).map(|person| &person.name),
        })
    }

    /// The layout: markers in their order, each with what is expected without it, head markers, curves, what
    /// looks wrong. `{"markers": []}` where there is none.
    ///
    /// # Errors
    /// [`Problem`]: the avatar has no face that could be measured.
    pub fn layout_state(&mut self) -> Result<Value, Problem> {
        let Some(OnHead { map, vertices, heads, origin }) = self.layout.now.clone() else {
            return Ok(json!({"markers": []}));
        };
        self.prepare_ground()?;
        let first = self.layout.first_curve()?;
        let (curve, without) = self.layout.curve(&vertices)?;
        let all = curve[vertices.len()];
        let ground = self.layout.ground.as_ref().ok_or_else(none)?;
        let mesh = &self.face()?.skin.mesh;
        let rehearsed = self.layout.rehearsed.as_ref();
        let marker = |(index, own): (usize, &mimique_stimulus::MappedMarker)| {
            let vertex = vertices[index];
            json!({
                "label": own.label,
                "vertex": vertex,
                "position": mesh.positions[vertex],
                "normal": ground.gradients.normal(vertex).map(|n| [n.x, n.y, n.z]),
                "allowed": ground.allows(vertex),
                "expectedMm": without[index] - all,
                "rehearsedMm": rehearsed.and_then(|rehearsed| rehearsed.missed_mm[index]),
            })
        };
        let apart = |a: usize, b: usize| {
            (mesh.positions[vertices[a]] - mesh.positions[vertices[b]]).length()
        };
        let near: Vec<Value> = (0..vertices.len())
            .flat_map(|a| (0..a).map(move |b| (b, a)))
            .filter(|&(b, a)| apart(a, b) < DISTANCE_M)
            .map(|(b, a)| {
                json!({"labels": [map.face[b].label, map.face[a].label], "mm": 1e3 * apart(a, b)})
            })
            .collect();
        Ok(json!({
            "origin": origin,
            "motion": self.layout_motion(),
            "markers": map.face.iter().enumerate().map(marker).collect::<Vec<_>>(),
            "head": heads.iter().map(|(label, place)| json!({"label": label, "position": place}))
                .collect::<Vec<_>>(),
            "headMarkers": map.head.len(),
            "curveMm": curve,
            "firstCurveMm": first,
            "near": near,
            "distanceMm": 1e3 * DISTANCE_M,
            "isRehearsed": rehearsed.is_some(),
            "rehearsedMm": rehearsed.and_then(|rehearsed| rehearsed.all_mm),
            "steps": self.layout.before.len(),
        }))
    }
}
