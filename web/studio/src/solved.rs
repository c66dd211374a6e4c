//! The take by one method: weights, what the markers asked for, residuals; its exports.

use mimique_avatar::Avatar;
use mimique_clip::weights_hash;
use mimique_geometry::{DVec3, Point};
use mimique_mocap::WeightsTable;
use mimique_solver::{MarkerSite, Method, MethodSpec, Needs, SurfaceResponse};
use mimique_stimulus::{
    RecordedWeights, SolvedCapture, TakeOptions, TakeWarning, lock_shapes, solve_take,
    surface_avatar,
};
use serde_json::{Value, json};

use crate::problem::{Problem, Trouble};
use crate::workspace::{Face, Take, Workspace};

/// The take solved by one method.
#[derive(Debug)]
pub(crate) struct Solved {
    pub table: WeightsTable,
    pub surface: Option<SurfaceResponse>,
    /// The surface's own avatar, of `thin-shell-surface`.
    pub avatar: Option<Avatar>,
    pub rate_hz: f64,
    pub sites: Vec<MarkerSite>,
    /// Where the markers asked the skin to go: frames x 3P, metres.
    pub displacements: Vec<f64>,
    pub residual_mm: Vec<f32>,
    pub kkt_error: Vec<f32>,
    pub iterations: Vec<f32>,
}

impl Workspace {
    /// Solves the take by a method (a `MethodSpec` as JSON) and keeps it under `slot`; answers facts
    /// and the report's summary. `settings` of the facts are the method as it was asked for: what
    /// `mimique solve --settings` takes.
    ///
    /// # Errors
    /// [`Problem`]: avatar, take or map are missing or do not fit, or the method does not solve.
    pub fn solve(&mut self, slot: &str, method: &str) -> Result<Value, Problem> {
        let given: Value = serde_json::from_str(method).map_err(|e| Problem::of("method", e))?;
        let mut spec = match MethodSpec::checked(&given) {
            Ok(spec) => spec,
            Err(problems) => {
                let words: Vec<String> = problems.iter().map(ToString::to_string).collect();
                return Err(Problem::of("method", words.join("\n")));
            }
        };
        let face = self.face()?;
        lock_shapes(&mut spec, &face.read.locked);
        let (solved, mut facts) = match (&self.take, spec.method.needs()) {
            (Some(Take::Weights { name, table, .. }), Needs::Weights) => {
                recorded(face, name, table)?
            }
            (Some(Take::Weights { name, .. }), _) => {
                return Err(Problem::at(name, Trouble::HoldsWeights));
            }
            (_, Needs::Weights) => {
                return Err(Problem::at("method", Trouble::NeedsWeights));
            }
            _ => self.fitted(face, &spec)?,
        };
        facts["settings"] = json!(spec);
        self.solved.insert(slot.to_owned(), solved);
        Ok(facts)
    }

    /// The method of a file with its patterns (`"eyeLook*"`) replaced by the names that they match here.
    ///
    /// # Errors
    /// [`Problem`]: no avatar yet, or text that is no method.
    pub fn named_method(&self, method: &str) -> Result<Value, Problem> {
        let spec: MethodSpec =
            serde_json::from_str(method).map_err(|e| Problem::of("method", e))?;
        let markers: Vec<String> = self.map.face.iter().map(|m| m.label.clone()).collect();
        Ok(json!(spec.with_names_of(&self.face()?.skin.shape_names, &markers)))
    }

    /// Lays weights of something else under the avatar's names into a slot; answers facts.
    pub(crate) fn put_recorded(
        &mut self,
        slot: &str,
        table: &WeightsTable,
    ) -> Result<Value, Problem> {
        let (solved, facts) = recorded(self.face()?, slot, table)?;
        self.solved.insert(slot.to_owned(), solved);
        Ok(facts)
    }

    fn fitted(&self, face: &Face, spec: &MethodSpec) -> Result<(Solved, Value), Problem> {
        let capture = self.capture()?;
        if self.map.face.is_empty() {
            return Err(Problem::at("marker map", Trouble::EmptyMap));
        }
        let training = match spec.method.needs() {
            Needs::Training => Some(Box::new(self.training()?)),
            _ => None,
        };
        let options = TakeOptions { training, gaze: self.gaze.clone(), ..TakeOptions::default() };
        let done = solve_take(&face.skin, capture, &self.map, spec, &options, &mut || 0.0)
            .map_err(|e| Problem::of("solve", e))?;
        let SolvedCapture { table, surface, report, sites, displacements } = done;
        let avatar = match &surface {
            None => None,
            Some(surface) => Some(self.surface_avatar(face, surface, &sites)?),
        };
        let series = |of: fn(&mimique_stimulus::FrameRow) -> f64| {
            report.frames.iter().map(|row| of(row) as f32).collect::<Vec<f32>>()
        };
        let facts = json!({
            "method": report.method,
            "frames": table.frames.len(),
            "rate_hz": report.rate_hz,
            "head_lowpass_hz": report.head_lowpass_hz,
            "gaze_at_rest": report.gaze_at_rest,
            "gaze": report.gaze,
            "shapes_told": report.shapes_told,
            "shapes": table.shape_names,
            "neutral": report.neutral,
            "markers": report.markers,
            "head": report.head,
            "summary": report.summary,
            "warnings": report.warnings.iter().map(told).collect::<Vec<_>>(),
            "weights_hash": report.weights_hash,
            "provenance": report.provenance,
            "own_avatar": avatar.is_some(),
        });
        let solved = Solved {
            residual_mm: series(|row| row.residual_mm),
            kkt_error: series(|row| row.kkt_error),
            iterations: series(|row| f64::from(row.iterations)),
            rate_hz: report.rate_hz,
            table,
            surface,
            avatar,
            sites,
            displacements,
        };
        Ok((solved, facts))
    }

    fn surface_avatar(
        &self,
        face: &Face,
        surface: &SurfaceResponse,
        sites: &[MarkerSite],
    ) -> Result<Avatar, Problem> {
        let options = mimique_solver::OperatorOptions::of(&MethodSpec::new(Method::ThinShellOnly));
        let bank = mimique_solver::Operators::build_at(
            &face.skin.mesh,
            &face.skin.shape_names,
            sites,
            &options,
        )
        .map_err(|e| Problem::of("avatar", e))?;
        surface_avatar(&face.read.avatar, &face.skin, surface, &bank)
            .map_err(|e| Problem::of("avatar", e))
    }

    /// Forgets what was solved under `slot`.
    pub fn forget(&mut self, slot: &str) {
        self.solved.remove(slot);
    }

    pub(crate) fn slot(&self, slot: &str) -> Result<&Solved, Problem> {
        self.solved.get(slot).ok_or_else(|| Problem::at(slot, Trouble::NothingSolved))
    }

    /// The weights as they are drawn, frames x shapes.
    ///
    /// # Errors
    /// [`Problem`]: nothing is solved under `slot`.
    pub fn weights(&self, slot: &str) -> Result<Vec<f32>, Problem> {
        Ok(self.slot(slot)?.table.weights.iter().map(|&w| w as f32).collect())
    }

    /// A value per frame: `residual` (mm), `kkt`, `iterations`; empty for recorded weights.
    ///
    /// # Errors
    /// [`Problem`]: nothing is solved under `slot`, no such series.
    pub fn series(&self, slot: &str, name: &str) -> Result<Vec<f32>, Problem> {
        let solved = self.slot(slot)?;
        match name {
            "residual" => Ok(solved.residual_mm.clone()),
            "kkt" => Ok(solved.kkt_error.clone()),
            "iterations" => Ok(solved.iterations.clone()),
            _ => Err(Problem::of(name, "no such series; use residual, kkt or iterations")),
        }
    }

    /// The pack that the slot's weights move: of `thin-shell-surface` its own.
    ///
    /// # Errors
    /// [`Problem`]: nothing is solved under `slot`.
    pub fn slot_pack(&self, slot: &str) -> Result<Vec<u8>, Problem> {
        match &self.slot(slot)?.avatar {
            Some(own) => Ok(mimique_avatar::pack::encode_pack(own).bytes),
            None => self.avatar_pack(),
        }
    }

    /// Where the markers ask the skin to be in a frame, and where it is: 6 numbers per marker, metres,
    /// NaN where the marker is lost.
    ///
    /// # Errors
    /// [`Problem`]: nothing is solved under `slot`, no such frame.
    pub fn marker_frame(&self, slot: &str, frame: usize) -> Result<Vec<f32>, Problem> {
        let solved = self.slot(slot)?;
        let moved = self.moved_skin(slot, frame)?;
        let rest = &self.face()?.skin.mesh.positions;
        let width = 3 * solved.sites.len();
        let mut out = Vec::with_capacity(2 * width);
        for (m, site) in solved.sites.iter().enumerate() {
            let at = |points: &[Point]| {
                site.parts().fold(DVec3::ZERO, |sum, (v, share)| sum + share * points[v].0)
            };
            let (from, is) = (at(rest), at(&moved));
            let asked = &solved.displacements[frame * width + 3 * m..][..3];
            out.extend((0..3).map(|a| (from[a] + asked[a]) as f32));
            out.extend(is.as_vec3().to_array());
        }
        Ok(out)
    }

    /// The welded skin in a frame, metres.
    pub(crate) fn moved_skin(&self, slot: &str, frame: usize) -> Result<Vec<Point>, Problem> {
        let solved = self.slot(slot)?;
        let frames = solved.table.frames.len();
        if frame >= frames {
            return Err(Problem::of(
                slot,
                format!("frame {frame} of {frames}; choose one of them"),
            ));
        }
        let weights = solved.table.row(frame);
        let mesh = &self.face()?.skin.mesh;
        if let Some(surface) = &solved.surface {
            let moved = surface.displacements(weights).into_iter().zip(&mesh.positions);
            return Ok(moved.map(|(d, p)| *p + d).collect());
        }
        let mut out = mesh.positions.clone();
        for (shape, w) in mesh.shapes.iter().zip(weights).filter(|(_, w)| **w != 0.0) {
            for (&v, d) in shape.vertices.iter().zip(&shape.deltas) {
                out[v as usize] += *w * *d;
            }
        }
        Ok(out)
    }

    /// The weights as the CSV that `mimique solve` writes.
    ///
    /// # Errors
    /// [`Problem`]: nothing is solved under `slot`.
    pub fn weights_csv(&self, slot: &str) -> Result<String, Problem> {
        Ok(self.slot(slot)?.table.to_csv())
    }

    /// The avatar with frames `first..end` of the slot as a morph animation: a binary glTF file.
    ///
    /// # Errors
    /// [`Problem`]: nothing is solved under `slot`, no such frames.
    pub fn animated_glb(&self, slot: &str, first: usize, end: usize) -> Result<Vec<u8>, Problem> {
        let solved = self.slot(slot)?;
        let frames = solved.table.frames.len();
        if first >= end || end > frames {
            let what = format!("frames {first}:{end} of {frames}; give a range inside the take");
            return Err(Problem::of(slot, what));
        }
        let avatar = solved.avatar.as_ref().unwrap_or(&self.face()?.read.avatar);
        let count = solved.table.shape_names.len();
        let mut weights = Vec::new();
        for row in solved.table.weights[first * count..end * count].chunks_exact(count) {
            weights.extend(row.iter().map(|&w| w as f32));
            // The shapes of the body rest.
            weights.resize(weights.len() + avatar.shape_names.len() - count, 0.0);
        }
        mimique_avatar_files::write_glb(avatar, &weights, solved.rate_hz)
            .map_err(|e| Problem::of("animation", e))
    }
}

/// Recorded weights under the avatar's own names.
fn recorded(face: &Face, name: &str, table: &WeightsTable) -> Result<(Solved, Value), Problem> {
    let avatar = &face.read.avatar;
    let RecordedWeights { table, names } =
        RecordedWeights::with_expressions(table, &avatar.shape_names, &avatar.expressions)
            .map_err(|e| Problem::of(name, e))?;
    let rate_hz = table
        .rate_hz()
        .ok_or_else(|| Problem::of(name, "column time: no rate; write the time of each row"))?;
    let facts = json!({
        "method": {"method": "recorded"},
        "frames": table.frames.len(),
        "rate_hz": rate_hz,
        "shapes": table.shape_names,
        "markers": [],
        "head": [],
        "summary": null,
        "warnings": names.warnings(true).iter().map(told).collect::<Vec<_>>(),
        "weights_hash": weights_hash(&table.weights),
        "own_avatar": false,
    });
    let solved = Solved {
        table,
        surface: None,
        avatar: None,
        rate_hz,
        sites: Vec::new(),
        displacements: Vec::new(),
        residual_mm: Vec::new(),
        kkt_error: Vec::new(),
        iterations: Vec::new(),
    };
    Ok((solved, facts))
}

/// A warning for the page: its code and values, and its sentence in English as `text`.
fn told(warning: &TakeWarning) -> Value {
    let mut told = json!(warning);
    told["text"] = json!(warning.to_string());
    told
}
