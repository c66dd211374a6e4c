//! What the captures that a study names would gain by a smoothed adaptation of shape, before anything is
//! prepared.

use std::collections::BTreeSet;

use mimique_study::{CaptureSource, Clip, Study};

use super::sources::Sources;
use super::{Places, method_pointer, with_lowpass};
use crate::SmoothingAdvice;
use crate::checks::is_fitted;

/// What a capture gains with a method.
#[derive(Debug, Clone, PartialEq)]
pub struct AdvisedMethod {
    /// JSON pointer of the method in the study file.
    pub pointer: String,
    /// The capture's identifier.
    pub capture: String,
    /// What was measured.
    pub advice: SmoothingAdvice,
}

/// The methods of a study that would gain by `rbfSmoothing`, with each capture that is solved by them and each
/// avatar. Files that cannot be read say nothing here: [`super::prepare`] names what is wrong with them.
pub fn advised_methods(study: &Study, places: &Places) -> Vec<AdvisedMethod> {
    let sources = Sources::new(study, places);
    let mut looked_at = BTreeSet::new();
    let mut found = Vec::new();
    for clip in study.clips() {
        let segment = study.stimuli.segments.iter().find(|segment| segment.id == clip.segment);
        let Some(capture) = segment.map(|segment| segment.capture.clone()) else { continue };
        let recorded = study.stimuli.captures.get(&capture).and_then(|entry| entry.source());
        let is_file = matches!(recorded, Some(CaptureSource::File(_)));
        let key = [clip.avatar.clone(), capture.clone(), clip.method.clone()];
        if !is_file || !looked_at.insert(key) {
            continue;
        }
        if let Some(advice) = advice(study, &clip, &sources) {
            found.push(AdvisedMethod { pointer: method_pointer(&clip), capture, advice });
        }
    }
    found
}

/// What the take of a clip gains; none where it cannot be solved.
fn advice(study: &Study, clip: &Clip, sources: &Sources<'_>) -> Option<SmoothingAdvice> {
    let spec = &study.stimuli.methods.get(&clip.method)?.spec;
    if spec.rbf_smoothing.is_some() || !is_fitted(spec) {
        return None;
    }
    let avatar = sources.avatar(&clip.avatar).ok()?;
    let performance = sources.performance(&clip.segment, &avatar).ok()?;
    let joined = performance.joined().ok()?;
    let mut spec = joined.with_shapes_held(&with_lowpass(spec, &performance));
    crate::lock_shapes(&mut spec, &avatar.locked);
    spec.validate().ok()?;
    let operators = joined.set_up(&spec, None).ok()?.operators;
    joined.smoothing_advice(&operators, &spec, None).ok()?
}
