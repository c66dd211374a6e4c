//! Avatars, captures, segments, methods, clips: sources, files, references, factors.

use std::collections::BTreeSet;

use mimique_solver::Method;

use super::exertion::SLOWEST_HZ;
use super::issue::{Issues, below};
use super::problem::Problem;
use super::values::Counted;
use super::{FileLookup, Subject, avatars, exertion};
use crate::columns::is_reserved_column;
use crate::question::KindOfQuestion as _;
use crate::study_file::{
    Capture, CaptureSource, ClipSelection, Component, GazeSource, PairsComponent, PanelComponent,
    Sequence, SequenceItem,
};

/// Frames a second that a clip can be shown at.
const RATES_HZ: std::ops::RangeInclusive<f64> = 15.0..=1000.0;

pub(super) fn examine(subject: &Subject<'_>, lookup: &FileLookup<'_>, issues: &mut Issues) {
    let stimuli = &subject.study.stimuli;
    for (name, avatar) in &stimuli.avatars {
        let pointer = below("/stimuli/avatars", name);
        identifier(name, &pointer, issues);
        avatars::examine(avatar, &pointer, lookup, issues);
    }
    avatars::videos(subject, issues);
    let only_played = only_played(subject);
    for (name, capture) in &stimuli.captures {
        let pointer = below("/stimuli/captures", name);
        identifier(name, &pointer, issues);
        one_source(capture, &pointer, issues);
        file(capture.file.as_deref(), &below(&pointer, "file"), lookup, issues);
        file(capture.markers.as_deref(), &below(&pointer, "markers"), lookup, issues);
        recorded(capture, only_played.contains(name.as_str()), &pointer, issues);
        head_motion(capture, &below(&pointer, "headMotion"), issues);
        gaze(capture, &below(&pointer, "gaze"), lookup, issues);
        if let Some(own) = &capture.exertion {
            exertion::examine(capture, own, &pointer, lookup, issues);
        }
    }
    exertion::methods(subject, issues);
    exertion::segments(subject, issues);
    segments(subject, issues);
    for name in stimuli.methods.keys() {
        identifier(name, &below("/stimuli/methods", name), issues);
    }
    methods(subject, issues);
    training(subject, lookup, issues);
    references(subject, issues);
    factors(subject, issues);
    look(subject, issues);
    unused(subject, issues);
}

pub(super) fn identifier(name: &str, pointer: &str, issues: &mut Issues) {
    let plain = |letter: char| letter.is_ascii_alphanumeric() || letter == '_' || letter == '-';
    if name.is_empty() || !name.chars().all(plain) {
        issues.error(pointer, Problem::PartOfClipId { name: name.to_owned() });
    }
}

fn one_source(capture: &Capture, pointer: &str, issues: &mut Issues) {
    if capture.source().is_none() {
        let none =
            capture.builtin.is_none() && capture.file.is_none() && capture.exertion.is_none();
        issues.error(pointer, if none { Problem::NoSource } else { Problem::SeveralSources });
    }
}

pub(super) fn file(
    path: Option<&str>,
    pointer: &str,
    lookup: &FileLookup<'_>,
    issues: &mut Issues,
) {
    if let Some(Err(problem)) = path.map(lookup) {
        issues.error(pointer, problem);
    }
}

/// The captures that clips play as they were recorded, and no method solves or learns from.
fn only_played<'s>(subject: &Subject<'s>) -> BTreeSet<&'s str> {
    let stimuli = &subject.study.stimuli;
    let (mut played, mut solved) = (BTreeSet::new(), BTreeSet::new());
    for clip in subject.study.clips() {
        let method = stimuli.methods.get(&clip.method);
        let capture = stimuli.segments.iter().find(|segment| segment.id == clip.segment);
        if let (Some(method), Some(segment)) = (method, capture) {
            let recorded = method.spec.method == Method::Recorded;
            let of = if recorded { &mut played } else { &mut solved };
            of.insert(segment.capture.as_str());
        }
    }
    solved.extend(
        stimuli.methods.values().filter_map(|m| Some(m.training.as_ref()?.capture.as_str())),
    );
    played.into_iter().filter(|capture| !solved.contains(capture)).collect()
}

/// What a file of markers needs beside it; recorded weights that are only played need none of it.
fn recorded(capture: &Capture, only_played: bool, pointer: &str, issues: &mut Issues) {
    if let Some(unit) = capture.unit.as_deref().filter(|unit| !["m", "cm", "mm"].contains(unit)) {
        issues.error(below(pointer, "unit"), Problem::Unit { unit: unit.to_owned() });
    }
    if let Some([first, end]) = capture.neutral.filter(|[first, end]| first >= end) {
        issues.error(below(pointer, "neutral"), Problem::NeutralFrames { first, end });
    }
    if let Some(hertz) = capture.head_lowpass_hz.filter(|hertz| *hertz <= 0.0) {
        issues.error(below(pointer, "headLowpassHz"), Problem::NothingPasses { hertz });
    }
    let recorded_hz = capture.file_rate_hz;
    if let Some(hertz) = recorded_hz.filter(|hertz| !(*hertz >= SLOWEST_HZ && hertz.is_finite())) {
        issues.error(below(pointer, "fileRateHz"), Problem::FrameRate { hertz });
    }
    if let Some(hertz) = capture.rate_hz.filter(|hertz| !RATES_HZ.contains(hertz)) {
        issues.error(below(pointer, "rateHz"), Problem::FrameRate { hertz });
    }
    if let Some(CaptureSource::File(_)) = capture.source().filter(|_| !only_played) {
        if capture.markers.is_none() {
            issues.error(pointer, Problem::NoMarkers);
        }
        if capture.neutral.is_none() {
            issues.warning(pointer, Problem::NoNeutral);
        }
        match capture.head.len() {
            0 => {
                issues.warning(pointer, Problem::NoHead);
            }
            count @ 1..3 => {
                issues.error(
                    below(pointer, "head"),
                    Problem::FewHeadMarkers { markers: Counted(count, "head marker") },
                );
            }
            _ => {}
        }
    } else if capture.builtin.is_some()
        && (capture.markers.is_some() || capture.unit.is_some() || !capture.head.is_empty())
    {
        issues.error(pointer, Problem::BuiltinMarkers);
    }
}

/// The head's motion: a share of it, from a capture that tells it.
fn head_motion(capture: &Capture, pointer: &str, issues: &mut Issues) {
    let Some(share) = capture.head_motion else { return };
    if !(0.0..=1.0).contains(&share) {
        issues.error(pointer, Problem::HeadMotionShare { share });
    } else if share > 0.0 && capture.builtin.is_none() && capture.head.is_empty() {
        issues.warning(pointer, Problem::HeadMotionUnknown);
    }
}

/// The gaze: from one source, of angles that eyes have, from a capture that can give it.
fn gaze(capture: &Capture, pointer: &str, lookup: &FileLookup<'_>, issues: &mut Issues) {
    let Some(gaze) = &capture.gaze else { return };
    match gaze.source() {
        None => issues.error(pointer, Problem::GazeSources),
        Some(GazeSource::Held(held)) => {
            let angles = [
                ("azimuth", held.azimuth, -45.0..=45.0),
                ("elevation", held.elevation, -45.0..=45.0),
                ("vergence", held.vergence, 0.0..=45.0),
            ];
            for (key, degrees, range) in angles {
                if !range.contains(&degrees) {
                    let (least, most) = (*range.start(), *range.end());
                    let place = below(&below(pointer, "held"), key);
                    issues.error(place, Problem::GazeAngle { degrees, least, most });
                }
            }
        }
        Some(GazeSource::File(path, _)) => {
            file(Some(path), &below(pointer, "file"), lookup, issues);
        }
        Some(GazeSource::Target(_))
            if !matches!(capture.source(), Some(CaptureSource::File(_))) =>
        {
            issues.error(below(pointer, "target"), Problem::GazeTarget);
        }
        Some(GazeSource::Performed) if capture.builtin.is_none() => {
            issues.error(below(pointer, "performed"), Problem::GazePerformed);
        }
        Some(_) => {}
    }
}

fn segments(subject: &Subject<'_>, issues: &mut Issues) {
    let stimuli = &subject.study.stimuli;
    let captures: Vec<&str> = stimuli.captures.keys().map(String::as_str).collect();
    for (index, segment) in stimuli.segments.iter().enumerate() {
        let pointer = below("/stimuli/segments", index);
        identifier(&segment.id, &below(&pointer, "id"), issues);
        if stimuli.segments[..index].iter().any(|each| each.id == segment.id) {
            issues.error(below(&pointer, "id"), Problem::SegmentTwice { id: segment.id.clone() });
        }
        let Some(capture) = stimuli.captures.get(&segment.capture) else {
            issues.error(
                below(&pointer, "capture"),
                Problem::unknown("capture", &segment.capture, &captures),
            );
            continue;
        };
        match (capture.source(), segment.performance, segment.first, segment.end) {
            (Some(CaptureSource::Builtin(_)), Some(performance), None, None) => {
                if !(1..=3).contains(&performance.intensity) {
                    let place = format!("{pointer}/performance/intensity");
                    issues.error(place, Problem::Intensity { intensity: performance.intensity });
                }
            }
            (Some(CaptureSource::Builtin(_)), ..) => {
                issues.error(pointer, Problem::CutOfActor);
            }
            (
                Some(CaptureSource::File(_) | CaptureSource::Exertion(_)),
                None,
                Some(first),
                Some(end),
            ) => {
                if first >= end {
                    issues.error(pointer, Problem::SegmentFrames { first, end });
                }
            }
            (Some(CaptureSource::File(_) | CaptureSource::Exertion(_)), ..) => {
                issues.error(pointer, Problem::CutOfFile);
            }
            (None, ..) => {}
        }
    }
}

/// What the solver itself finds wrong in the parameters.
fn methods(subject: &Subject<'_>, issues: &mut Issues) {
    for (name, method) in &subject.study.stimuli.methods {
        for problem in method.spec.problems() {
            let pointer = below("/stimuli/methods", name) + &problem.pointer();
            let (message, remedy) = (problem.message(), problem.remedy());
            issues.error(pointer, Problem::Parameter { message, remedy });
        }
    }
}

/// What a regression learns from.
fn training(subject: &Subject<'_>, lookup: &FileLookup<'_>, issues: &mut Issues) {
    let stimuli = &subject.study.stimuli;
    let captures: Vec<&str> = stimuli.captures.keys().map(String::as_str).collect();
    for (name, method) in &stimuli.methods {
        let learns = method.spec.method.needs() == mimique_solver::Needs::Training;
        let pointer = below("/stimuli/methods", name);
        let Some(training) = &method.training else {
            if learns {
                issues.error(pointer, Problem::NoTraining);
            }
            continue;
        };
        let place = below(&pointer, "training");
        if !learns {
            issues.error(place, Problem::LearnsNothing { method: method.word() });
            continue;
        }
        file(training.weights.as_deref(), &below(&place, "weights"), lookup, issues);
        let Some(capture) = stimuli.captures.get(&training.capture) else {
            issues.error(
                below(&place, "capture"),
                Problem::unknown("capture", &training.capture, &captures),
            );
            continue;
        };
        match (capture.source(), &training.weights) {
            (Some(CaptureSource::File(_)), None) => {
                issues.error(place, Problem::NoWeights);
            }
            (Some(CaptureSource::Exertion(_)), _) => {
                let (method, capture) = (method.word().to_owned(), training.capture.clone());
                issues.error(place, Problem::MethodOnExertion { method, capture });
            }
            (Some(CaptureSource::Builtin(_)), Some(_)) => {
                issues.error(below(&place, "weights"), Problem::BuiltinWeights);
            }
            _ => {}
        }
    }
}

fn references(subject: &Subject<'_>, issues: &mut Issues) {
    let stimuli = &subject.study.stimuli;
    let avatars: Vec<&str> = stimuli.avatars.keys().map(String::as_str).collect();
    let segments: Vec<&str> = stimuli.segments.iter().map(|each| each.id.as_str()).collect();
    let methods: Vec<&str> = stimuli.methods.keys().map(String::as_str).collect();
    let mut refer = |name: &str, known: &[&str], what: &'static str, pointer: String| {
        if !known.contains(&name) {
            issues.error(pointer, Problem::unknown(what, name, known));
        }
    };
    if let Some(cross) = &stimuli.clips.cross {
        let parts = [
            ("avatars", &cross.avatars, &avatars, "avatar"),
            ("segments", &cross.segments, &segments, "segment"),
            ("methods", &cross.methods, &methods, "method"),
        ];
        for (key, given, known, what) in parts {
            for (index, name) in given.iter().enumerate() {
                refer(name, known, what, format!("/stimuli/clips/cross/{key}/{index}"));
            }
        }
    }
    for (index, entry) in stimuli.clips.list.iter().enumerate() {
        let pointer = below("/stimuli/clips/list", index);
        refer(&entry.avatar, &avatars, "avatar", below(&pointer, "avatar"));
        refer(&entry.segment, &segments, "segment", below(&pointer, "segment"));
        refer(&entry.method, &methods, "method", below(&pointer, "method"));
    }
}

/// Factors: no name twice over, none in vain.
fn factors(subject: &Subject<'_>, issues: &mut Issues) {
    let stimuli = &subject.study.stimuli;
    let pairs: Vec<PairsComponent> = subject.study.pair_blocks().map(|(_, block)| block).collect();
    let panels: Vec<PanelComponent> =
        subject.study.panel_blocks().map(|(_, block)| block).collect();
    let pairs = pairs.iter().map(|block| (&block.compare, &block.within, &block.clips));
    let panels = panels.iter().map(|block| (&block.compare, &block.within, &block.clips));
    let used = factors_used(subject, pairs.chain(panels));
    let avatars = stimuli.avatars.iter();
    let methods = stimuli.methods.iter();
    let sounds = stimuli.sounds.iter();
    let groups = [
        ("avatar", avatars.map(|(k, v)| (below("/stimuli/avatars", k), &v.factors)).collect()),
        (
            "segment",
            stimuli
                .segments
                .iter()
                .enumerate()
                .map(|(index, each)| (below("/stimuli/segments", index), &each.factors))
                .collect::<Vec<_>>(),
        ),
        ("method", methods.map(|(k, v)| (below("/stimuli/methods", k), &v.factors)).collect()),
        ("sound", sounds.map(|(k, v)| (below("/stimuli/sounds", k), &v.factors)).collect()),
    ];
    let mut complained: BTreeSet<&str> = BTreeSet::new();
    for (number, (what, group)) in groups.iter().enumerate() {
        for (pointer, factors) in group {
            for factor in factors.keys() {
                let place = below(&below(pointer, "factors"), factor);
                let elsewhere = groups.iter().enumerate().find(|(other, (_, group))| {
                    *other != number && group.iter().any(|(_, each)| each.contains_key(factor))
                });
                let taken = is_reserved_column(factor)
                    || ["clip", "segment", "avatar", "truth"].contains(&factor.as_str())
                    || (factor == "sound" && !stimuli.sounds.is_empty());
                if taken {
                    issues.error(place, Problem::FactorIsColumn { factor: factor.clone() });
                } else if let Some((_, (other, _))) = elsewhere {
                    issues.error(
                        place,
                        Problem::FactorTwice { factor: factor.clone(), here: what, there: other },
                    );
                } else if !used.contains(factor.as_str()) && complained.insert(factor) {
                    issues.warning(place, Problem::UnusedFactor { factor: factor.clone() });
                }
            }
        }
    }
}

/// The factors that something of the study reads. `method` and `alpha` need no use.
fn factors_used<'a>(
    subject: &Subject<'a>,
    compared: impl Iterator<Item = (&'a String, &'a Vec<String>, &'a ClipSelection)>,
) -> BTreeSet<&'a str> {
    fn of_sequence<'a>(sequence: &'a Sequence, used: &mut BTreeSet<&'a str>) {
        used.extend(sequence.constraints.iter().map(|each| each.factor.as_str()));
        for item in &sequence.components {
            if let SequenceItem::Sequence(nested) = item {
                of_sequence(nested, used);
            }
        }
    }
    let study = subject.study;
    let mut used = BTreeSet::from(["method", "alpha", "expression", "intensity", "sound"]);
    for hypothesis in &study.hypotheses {
        used.extend(hypothesis.factors.iter().map(String::as_str));
    }
    for table in &study.tables {
        let crossed = table.crossings.iter().flatten();
        used.extend(table.factors.iter().chain(crossed).map(String::as_str));
    }
    for question in &study.questions {
        used.extend(question.kind.truth());
    }
    for component in study.components.values() {
        if let Component::Trials(block) = component {
            used.extend(block.clips.factors.keys().map(String::as_str));
        }
    }
    for (compare, within, clips) in compared {
        let named = within.iter().chain(clips.factors.keys());
        used.extend(named.chain([compare]).map(String::as_str));
    }
    of_sequence(&study.sequence, &mut used);
    used
}

fn look(subject: &Subject<'_>, issues: &mut Issues) {
    let look = &subject.study.stimuli.look;
    let digits = look.background.strip_prefix('#').unwrap_or_default();
    if digits.len() != 6 || !digits.chars().all(|digit| digit.is_ascii_hexdigit()) {
        issues
            .error("/stimuli/look/background", Problem::Colour { colour: look.background.clone() });
    }
    for (key, size) in [("width", look.width), ("height", look.height)] {
        if !(64..=4096).contains(&size) {
            let place = below("/stimuli/look", key);
            issues.error(
                place,
                Problem::OutOfRange {
                    value: f64::from(size),
                    unit: "pixels",
                    least: 64.0,
                    most: 4096.0,
                },
            );
        }
    }
}

fn unused(subject: &Subject<'_>, issues: &mut Issues) {
    let stimuli = &subject.study.stimuli;
    let mut complain = |name: &str, what: &'static str, used: bool, pointer: String| {
        if !used {
            issues.warning(pointer, Problem::UnusedByClips { what, name: name.to_owned() });
        }
    };
    for name in stimuli.avatars.keys() {
        let at_rest = || subject.study.clips_at_rest().iter().any(|(clip, _)| clip.avatar == *name);
        let used = subject.clips.iter().any(|clip| clip.avatar == *name) || at_rest();
        complain(name, "avatar", used, below("/stimuli/avatars", name));
    }
    for name in stimuli.methods.keys() {
        let varied = || {
            subject.study.adaptive().any(|(_, block)| block.method == *name)
                || subject.study.scalings().any(|(_, block)| block.method == *name)
        };
        let used = subject.clips.iter().any(|clip| clip.method == *name) || varied();
        complain(name, "method", used, below("/stimuli/methods", name));
    }
    for (index, segment) in stimuli.segments.iter().enumerate() {
        let heard =
            stimuli.sounds.values().any(|rule| rule.from.values().any(|id| *id == segment.id));
        let used = heard || subject.clips.iter().any(|clip| clip.segment == segment.id);
        complain(&segment.id, "segment", used, below("/stimuli/segments", index));
    }
    for name in stimuli.captures.keys() {
        let mut training = stimuli.methods.values().filter_map(|each| each.training.as_ref());
        let used = stimuli.segments.iter().any(|segment| segment.capture == *name)
            || training.any(|training| training.capture == *name);
        complain(name, "capture", used, below("/stimuli/captures", name));
    }
}
