//! A clip that is solved from markers: its operators, its take, and what is to be said of them.

use std::cell::OnceCell;
use std::collections::{BTreeMap, BTreeSet};

use mimique_avatar::pack::encode_pack;
use mimique_clip::{decode_operators, encode_operators, encode_take};
use mimique_solver::{
    Method, MethodSpec, OperatorOptions, Operators, SurfaceResponse, VertexAssociation,
};
use serde_json::{Value, json};

use super::cache::{Cache, StoredPack};
use super::source_files::{AvatarFile, Performance};
use super::{PrepareError, Remarks};
use crate::checks::is_fitted;
use crate::provenance::Provenance;
use crate::take::{held_shapes, untold_shapes};
use crate::{JoinedTake, SetUp, SolveError, TakeWarning, Training, surface_avatar};

/// Blendshapes that the stage's shader holds.
const MOST_STAGE_SHAPES: usize = 256;

/// A clip that is solved from markers.
pub(super) struct Wanted<'a> {
    /// The method as the study has it.
    pub(super) written: &'a MethodSpec,
    /// The same with the shapes that are held.
    pub(super) spec: &'a MethodSpec,
    pub(super) training: Option<&'a Training>,
    pub(super) method_pointer: &'a str,
    pub(super) performance: &'a Performance,
    pub(super) avatar: &'a AvatarFile,
}

impl Wanted<'_> {
    /// An error of the set-up, at the part of the study file that it comes from.
    fn error(&self, error: SolveError) -> PrepareError {
        match error {
            SolveError::Training(_)
            | SolveError::TrainingMarkers { .. }
            | SolveError::TrainingShapes { .. } => {
                PrepareError::new(format!("{}/training", self.method_pointer), error)
            }
            SolveError::Surface(_) | SolveError::Fit(_) => {
                PrepareError::new(self.method_pointer, error)
            }
            other => self.performance.error(other),
        }
    }
}

/// Operators and take of a clip that is solved from markers; with a surface the avatar that shows it.
pub(super) fn to_solve(
    wanted: &Wanted<'_>,
    cache: &Cache,
    remarks: &mut Remarks,
) -> Result<(Option<StoredPack>, StoredPack, StoredPack), PrepareError> {
    let Wanted { spec, training, performance, .. } = *wanted;
    let joined = performance.joined()?;
    look_at_joined(wanted, &joined, remarks)?;
    let markers = joined.marker_key();
    let key = operators_key(wanted, &markers);
    // Both packs of a surface need it; made once, and only where one of them is not there.
    let set_up = OnceCell::new();
    let ready = || -> Result<&SetUp, PrepareError> {
        if set_up.get().is_none() {
            let made = joined.set_up(spec, training).map_err(|e| wanted.error(e))?;
            let _ = set_up.set(made);
        }
        set_up.get().ok_or_else(|| PrepareError::new(wanted.method_pointer, "not set up"))
    };
    let operators = cache.pack(&key.clone().json("pack", "operators"), || {
        Ok(encode_operators(&ready()?.operators))
    })?;
    let opened = decode_operators(&operators.bytes)
        .map_err(|e| PrepareError::new(&performance.capture_pointer, e))?;
    look_at_labels(wanted, &joined, &opened, remarks)?;
    let moved = if spec.method == Method::ThinShellSurface {
        Some(cache.pack(&key.json("pack", "surface avatar"), || {
            let surface = ready()?.surface.as_ref().ok_or_else(|| {
                PrepareError::new(wanted.method_pointer, "the method moves no surface")
            })?;
            surface_pack(wanted, &joined, surface)
        })?)
    } else {
        None
    };
    let told = joined.shape_rows(wanted.written, spec, &opened);
    let said = held_shapes(&told).into_iter().chain(untold_shapes(&opened, spec));
    remarks.warnings.extend(said.map(|w| (performance.capture_pointer.clone(), w.to_string())));
    let key = take_key(wanted, &markers, joined.scales_by_bank());
    let take = cache.pack(&key.json("pack", "take"), || {
        let take = joined
            .segment(&opened, spec, performance.frames.clone())
            .map_err(|e| performance.error(e))?;
        Ok(encode_take(&take))
    })?;
    Ok((moved, operators, take))
}

/// What is to be said of capture, map and training before anything is solved.
fn look_at_joined(
    wanted: &Wanted<'_>,
    joined: &JoinedTake<'_>,
    remarks: &mut Remarks,
) -> Result<(), PrepareError> {
    let Wanted { spec, training, performance, avatar, .. } = *wanted;
    let said = joined.warnings().iter().map(TakeWarning::in_a_study);
    remarks.warnings.extend(said.map(|w| (performance.capture_pointer.clone(), w)));
    if let Some(training) = training {
        let pointer = format!("{}/training", wanted.method_pointer);
        let said = training.warnings(&avatar.avatar.shape_names);
        remarks.warnings.extend(said.iter().map(|w| (pointer.clone(), w.to_string())));
    }
    let unfiltered = joined.unfiltered_head(spec);
    remarks
        .warnings
        .extend(unfiltered.map(|w| (performance.capture_pointer.clone(), w.to_string())));
    let moving = joined.head_warning().map_err(|e| performance.error(e.into()))?;
    remarks.warnings.extend(moving.map(|w| (performance.capture_pointer.clone(), w.to_string())));
    Ok(())
}

/// The pack of the avatar whose surface the markers move.
fn surface_pack(
    wanted: &Wanted<'_>,
    joined: &JoinedTake<'_>,
    surface: &SurfaceResponse,
) -> Result<Vec<u8>, PrepareError> {
    let Wanted { spec, performance, avatar, .. } = *wanted;
    let bank = joined.operators(spec).map_err(|e| performance.error(e.into()))?;
    let most = MOST_STAGE_SHAPES / 3;
    if bank.marker_count() > most {
        let message = format!(
            "{} markers: the stage moves a surface by {most} at most; leave some out of the map",
            bank.marker_count()
        );
        return Err(PrepareError::new(wanted.method_pointer, message));
    }
    let moved = surface_avatar(&avatar.avatar, avatar.skin()?, surface, &bank)
        .map_err(|e| PrepareError::new(wanted.method_pointer, e))?;
    Ok(encode_pack(&moved).bytes)
}

/// What the operators follow from.
fn operators_key(wanted: &Wanted<'_>, markers: &str) -> Provenance {
    let Wanted { spec, training, avatar, .. } = *wanted;
    let options = OperatorOptions::of(spec);
    let association = match options.association {
        None => Value::Null,
        Some(VertexAssociation::Points) => json!("points"),
        Some(VertexAssociation::Zones { sigma }) => json!({ "zones": sigma }),
        Some(VertexAssociation::Triangles) => json!("triangles"),
    };
    let key = Provenance::default()
        .json("avatar", avatar.key.as_str())
        .json("markers", markers)
        .json("laplacian", json!(options.laplacian))
        .json("kS", options.k_s)
        .json("kB", options.k_b)
        .json("association", association);
    match spec.method {
        Method::ThinShellSurface => key.json("hold", json!(spec.hold())),
        Method::Regression => key
            .json("training", json!(training.map(Training::key)))
            .json("inference", json!(spec.inference()))
            .json("basisVectors", spec.basis_vectors())
            .json("kernel", json!([spec.length_scale, spec.signal, spec.noise]))
            .json("headLowpassHz", json!(spec.head_lowpass_hz)),
        _ => key,
    }
}

/// What the take pack follows from. Automatic scale factors follow from the bank between its bounds.
fn take_key(wanted: &Wanted<'_>, markers: &str, scaled_by_bank: bool) -> Provenance {
    let Wanted { spec, performance, avatar, .. } = *wanted;
    let key = Provenance::default()
        .json("markers", markers)
        .json("performance", performance.key.as_str())
        .json("headLowpassHz", json!(spec.head_lowpass_hz(performance.rate_hz())));
    if !scaled_by_bank {
        return key;
    }
    let bounds: BTreeMap<&String, &[f64; 2]> = spec.bounds.iter().collect();
    let locked: BTreeSet<&String> = spec.locked.iter().collect();
    key.json("avatar", avatar.key.as_str())
        .json("bounds", json!(bounds))
        .json("locked", json!(locked))
}

/// Labels of a recorded capture that are swapped or stand at one place, and what a smoothed adaptation of shape
/// gains, looked for once for all its segments and methods. What the built-in actors do is labelled here.
fn look_at_labels(
    wanted: &Wanted<'_>,
    joined: &JoinedTake<'_>,
    operators: &Operators,
    remarks: &mut Remarks,
) -> Result<(), PrepareError> {
    let Wanted { spec, performance, avatar, .. } = *wanted;
    if !performance.is_recorded() || !is_fitted(spec) {
        return Ok(());
    }
    if remarks.looked_over.insert([avatar.key.clone(), performance.take_key.clone()]) {
        let mut said = joined.label_warnings(operators, spec).map_err(|e| wanted.error(e))?;
        let advice = joined.smoothing_advice(operators, spec, None).map_err(|e| wanted.error(e))?;
        said.extend(advice.map(TakeWarning::Smoothing));
        let pointer = &performance.capture_pointer;
        remarks.warnings.extend(said.iter().map(|w| (pointer.clone(), w.in_a_study())));
    }
    Ok(())
}
