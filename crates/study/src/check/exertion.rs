//! Captures that are computed from what a body did: one source, its length, files, methods, segments.

use super::issue::{Issues, below};
use super::problem::Problem;
use super::stimuli::file;
use super::{FileLookup, Subject};
use crate::study_file::{Capture, ExertionCapture, ExertionSource};

/// The longest exertion, seconds: a day.
const LONGEST_S: f64 = 86_400.0;
/// Frames per second with which a gait can be followed.
pub(super) const SLOWEST_HZ: f64 = 10.0;
/// The most work that a body does in a second, J/kg.
const MOST_WORK: f64 = 120.0;

pub(super) fn examine(
    capture: &Capture,
    exertion: &ExertionCapture,
    pointer: &str,
    lookup: &FileLookup<'_>,
    issues: &mut Issues,
) {
    let place = below(pointer, "exertion");
    match exertion.source_count() {
        1 => parts(exertion, &place, lookup, issues),
        0 => issues.error(&place, Problem::NoMotion),
        _ => issues.error(&place, Problem::TwoMotions),
    }
    file(exertion.joints.as_deref(), &below(&place, "joints"), lookup, issues);
    file(exertion.model_file(), &below(&place, "model"), lookup, issues);
    if let Some(unit) =
        exertion.motion_unit.as_ref().filter(|u| !["m", "cm", "mm"].contains(&&u[..]))
    {
        issues.error(below(&place, "motionUnit"), Problem::Unit { unit: unit.clone() });
    }
    if let Some(hertz) =
        exertion.motion_rate_hz.filter(|rate| !(*rate >= SLOWEST_HZ && rate.is_finite()))
    {
        issues.error(below(&place, "motionRateHz"), Problem::FrameRate { hertz });
    }
    if capture.markers.is_some()
        || capture.unit.is_some()
        || capture.neutral.is_some()
        || capture.head_lowpass_hz.is_some()
        || capture.head_motion.is_some()
        || !capture.head.is_empty()
    {
        issues.error(pointer, Problem::ExertionMarkers);
    }
}

/// The parts of an exertion.
fn parts(exertion: &ExertionCapture, place: &str, lookup: &FileLookup<'_>, issues: &mut Issues) {
    if !exertion.plan.is_empty() && exertion.seconds.is_some() {
        issues.error(below(place, "for"), Problem::PlanHasLength);
    }
    for part in exertion.parts() {
        let at = format!("{place}{}", part.place);
        match part.source {
            None => issues.error(&at, Problem::SeveralMotions),
            Some(ExertionSource::Motion(path) | ExertionSource::Activity(path)) => {
                let key = part.source.map_or("", ExertionSource::key);
                file(Some(path), &below(&at, key), lookup, issues);
            }
            Some(ExertionSource::Work(work)) if !(0.0..=MOST_WORK).contains(&work) => {
                issues.error(below(&at, "work"), Problem::ConstantWork { work });
            }
            Some(ExertionSource::Rest | ExertionSource::Work(_)) if part.seconds.is_none() => {
                issues.error(&at, Problem::PartWithoutLength);
            }
            Some(_) => {}
        }
        if let Some(seconds) = part.seconds.filter(|s| !(*s > 0.0 && *s <= LONGEST_S)) {
            issues.error(below(&at, "for"), Problem::LengthOfExertion { seconds });
        }
    }
}

/// Segments that end after their exertion, where the study file tells how long it is.
pub(super) fn segments(subject: &Subject<'_>, issues: &mut Issues) {
    let stimuli = &subject.study.stimuli;
    for (i, segment) in stimuli.segments.iter().enumerate() {
        let exertion = stimuli.captures.get(&segment.capture).and_then(|own| own.exertion.as_ref());
        let frames = exertion.and_then(ExertionCapture::frames);
        if let (Some(end), Some(frames)) = (segment.end, frames)
            && end > frames
        {
            let at = below(&below("/stimuli/segments", i), "end");
            issues.error(at, Problem::PastExertion { end, frames });
        }
    }
}

/// The face of an exertion is weights already: nothing can solve it.
pub(super) fn methods(subject: &Subject<'_>, issues: &mut Issues) {
    let stimuli = &subject.study.stimuli;
    for (name, capture) in &stimuli.captures {
        if capture.exertion.is_none() {
            continue;
        }
        let shown = |segment: &str| {
            stimuli.segments.iter().any(|own| own.id == segment && own.capture == *name)
        };
        let solved = subject.clips.iter().find(|clip| {
            let method = stimuli.methods.get(&clip.method);
            shown(&clip.segment) && method.is_some_and(|method| method.word() != "recorded")
        });
        if let Some(clip) = solved {
            let (method, capture) = (clip.method.clone(), name.clone());
            let place = below("/stimuli/captures", name);
            issues.error(place, Problem::MethodOnExertion { method, capture });
        }
    }
}
