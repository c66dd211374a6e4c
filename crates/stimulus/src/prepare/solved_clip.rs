//! A clip that is solved from markers: its operators, its take, and what is to be said of them.

use std::cell::OnceCell;

use mimique_face::pack::encode_pack;
use mimique_solver::{Method, MethodSpec, OperatorOptions, Operators};

use super::cache::{Cache, StoredPack};
use super::source_files::{AvatarFile, Performance};
use super::{PrepareError, Remarks};
use crate::report::unseen_shapes;
use crate::take_checks::is_fitted;
use crate::{
    JoinedTake, SetUp, SolveError, Training, encode_operators, encode_take, surface_avatar,
};

/// Blendshapes that the stage's shader holds.
const MOST_STAGE_SHAPES: usize = 256;

/// A clip that is solved from markers.
pub(super) struct Wanted<'a> {
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
    let Wanted { spec, training, performance, avatar, .. } = *wanted;
    let joined = performance.joined()?;
    let said = joined.warnings().iter().cloned();
    remarks.warnings.extend(said.map(|w| (performance.capture_pointer.clone(), w)));
    if let Some(training) = training {
        let pointer = format!("{}/training", wanted.method_pointer);
        let said = training.warnings(&avatar.avatar.shape_names);
        remarks.warnings.extend(said.into_iter().map(|w| (pointer.clone(), w)));
    }
    let moving = joined.head_warning().map_err(|e| performance.error(e.into()))?;
    remarks.warnings.extend(moving.map(|w| (performance.capture_pointer.clone(), w)));
    let options = format!("{:?}", OperatorOptions::of(spec));
    let markers = joined.marker_key();
    let more = match spec.method {
        Method::ThinShellSurface => format!("surface {:?}", spec.hold()),
        Method::Regression => {
            let numbers = (spec.basis_vectors(), spec.length_scale, spec.signal, spec.noise);
            let key = training.map(Training::key).unwrap_or_default();
            format!("{key} {:?} {numbers:?} {:?}", spec.inference(), spec.head_lowpass_hz)
        }
        _ => String::new(),
    };
    let mut key = vec!["operators", &avatar.key, &markers, &options];
    key.extend((!more.is_empty()).then_some(more.as_str()));
    // Both packs of a surface need it; made once, and only where one of them is not there.
    let set_up = OnceCell::new();
    let ready = || -> Result<&SetUp, PrepareError> {
        if set_up.get().is_none() {
            let made = joined.set_up(spec, training).map_err(|e| wanted.error(e))?;
            let _ = set_up.set(made);
        }
        set_up.get().ok_or_else(|| PrepareError::new(wanted.method_pointer, "not set up"))
    };
    let operators = cache.pack(&key, || Ok(encode_operators(&ready()?.operators)))?;
    let opened = crate::decode_operators(&operators.bytes)
        .map_err(|e| PrepareError::new(&performance.capture_pointer, e))?;
    look_at_labels(wanted, &joined, &opened, remarks)?;
    let moved = if spec.method == Method::ThinShellSurface {
        key[0] = "surface avatar";
        Some(cache.pack(&key, || {
            let surface = ready()?.surface.as_ref().ok_or_else(|| {
                PrepareError::new(wanted.method_pointer, "the method moves no surface")
            })?;
            let bank = joined.operators(spec).map_err(|e| performance.error(e.into()))?;
            let most = MOST_STAGE_SHAPES / 3;
            if bank.marker_count() > most {
                let message = format!(
                    "{} markers: the stage moves a surface by {most} at most; leave some out of \
                     the map",
                    bank.marker_count()
                );
                return Err(PrepareError::new(wanted.method_pointer, message));
            }
            let moved = surface_avatar(&avatar.avatar, avatar.skin()?, surface, &bank)
                .map_err(|e| PrepareError::new(wanted.method_pointer, e))?;
            Ok(encode_pack(&moved).bytes)
        })?)
    } else {
        None
    };
    let unseen = unseen_shapes(&opened, spec);
    remarks.warnings.extend(unseen.map(|w| (performance.capture_pointer.clone(), w)));
    // Automatic scale factors follow from the bank between its bounds.
    let range = if joined.scales_by_bank() {
        format!("{:?} {:?} {}", spec.bounds, spec.locked, avatar.key)
    } else {
        String::new()
    };
    let lowpass = format!("{:?}", spec.head_lowpass_hz);
    let take = cache.pack(&["take", &markers, &performance.key, &lowpass, &range], || {
        let take = joined
            .segment(&opened, spec, performance.frames.clone())
            .map_err(|e| performance.error(e))?;
        Ok(encode_take(&take))
    })?;
    Ok((moved, operators, take))
}

/// Labels of a recorded capture that are swapped or stand at one place, looked for once for all its
/// segments and methods. What the built-in actors do is labelled here.
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
        let said = joined.label_warnings(operators, spec).map_err(|e| wanted.error(e))?;
        let pointer = &performance.capture_pointer;
        remarks.warnings.extend(said.into_iter().map(|w| (pointer.clone(), w)));
    }
    Ok(())
}
