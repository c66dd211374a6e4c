//! Captures that are computed from a body's motion: one motion, its length, files, methods.

use super::issue::{Issues, below};
use super::problem::Problem;
use super::stimuli::file;
use super::{FileLookup, Subject};
use crate::study_file::{Capture, ExertionCapture};

/// The longest exertion, seconds: a day.
const LONGEST_S: f64 = 86_400.0;

pub(super) fn examine(
    capture: &Capture,
    exertion: &ExertionCapture,
    pointer: &str,
    lookup: &FileLookup<'_>,
    issues: &mut Issues,
) {
    let place = below(pointer, "exertion");
    if exertion.source().is_none() {
        let none = exertion.builtin.is_none();
        issues.error(&place, if none { Problem::NoMotion } else { Problem::TwoMotions });
    }
    file(exertion.motion.as_deref(), &below(&place, "motion"), lookup, issues);
    file(exertion.model_file(), &below(&place, "model"), lookup, issues);
    let seconds = exertion.seconds;
    if !(seconds > 0.0 && seconds <= LONGEST_S) {
        issues.error(below(&place, "for"), Problem::LengthOfExertion { seconds });
    }
    if capture.markers.is_some()
        || capture.unit.is_some()
        || capture.neutral.is_some()
        || capture.head_lowpass_hz.is_some()
        || !capture.head.is_empty()
    {
        issues.error(pointer, Problem::ExertionMarkers);
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
