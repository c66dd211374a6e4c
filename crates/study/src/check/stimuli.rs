//! Avatars, captures, segments, methods, clips: sources, files, references, factors.

use std::collections::BTreeSet;

use super::issue::{Issues, below};
use super::nearest::suggestion;
use super::{FileLookup, Subject, avatars};
use crate::responses::is_reserved_column;
use crate::study_file::{Capture, CaptureSource, Component, QuestionKind, Sequence, SequenceItem};

/// Frames a second that a clip can be shown at.
const RATES_HZ: std::ops::RangeInclusive<f64> = 15.0..=1000.0;

pub(super) fn examine(subject: &Subject<'_>, lookup: &FileLookup<'_>, issues: &mut Issues) {
    let stimuli = &subject.study.stimuli;
    for (name, avatar) in &stimuli.avatars {
        let pointer = below("/stimuli/avatars", name);
        identifier(name, &pointer, issues);
        avatars::examine(avatar, &pointer, lookup, issues);
    }
    avatars::films(subject, issues);
    for (name, capture) in &stimuli.captures {
        let pointer = below("/stimuli/captures", name);
        identifier(name, &pointer, issues);
        one_source(capture.builtin.is_some(), capture.file.is_some(), &pointer, issues);
        file(capture.file.as_deref(), &below(&pointer, "file"), lookup, issues);
        file(capture.markers.as_deref(), &below(&pointer, "markers"), lookup, issues);
        recorded(capture, &pointer, issues);
    }
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

fn identifier(name: &str, pointer: &str, issues: &mut Issues) {
    let plain = |letter: char| letter.is_ascii_alphanumeric() || letter == '_' || letter == '-';
    if name.is_empty() || !name.chars().all(plain) {
        let message = format!("\"{name}\" cannot be part of a clip's identifier");
        issues.error(pointer, "bad-id", message, "use letters, digits, _ and -");
    }
}

fn one_source(builtin: bool, file: bool, pointer: &str, issues: &mut Issues) {
    if builtin == file {
        let message = if file { "both builtin and file" } else { "neither builtin nor file" };
        let hint = "give one: \"builtin\": {} or \"file\": \"...\"";
        issues.error(pointer, "one-source", message, hint);
    }
}

fn file(path: Option<&str>, pointer: &str, lookup: &FileLookup<'_>, issues: &mut Issues) {
    if let Some(Err((message, hint))) = path.map(lookup) {
        issues.error(pointer, "missing-file", message, hint);
    }
}

fn recorded(capture: &Capture, pointer: &str, issues: &mut Issues) {
    if let Some(unit) = capture.unit.as_deref().filter(|unit| !["m", "cm", "mm"].contains(unit)) {
        let message = format!("\"{unit}\" is not a unit");
        issues.error(below(pointer, "unit"), "unknown-word", message, "write m, cm or mm");
    }
    if let Some([first, end]) = capture.neutral.filter(|[first, end]| first >= end) {
        let message = format!("frames {first} to {end} are none");
        let hint = "write the first frame and the one after the last";
        issues.error(below(pointer, "neutral"), "bad-range", message, hint);
    }
    if let Some(hertz) = capture.head_lowpass_hz.filter(|hertz| *hertz <= 0.0) {
        let message = format!("{hertz} Hz lets nothing pass");
        let hint = "take a frequency above 0, or leave it out";
        issues.error(below(pointer, "headLowpassHz"), "out-of-range", message, hint);
    }
    if let Some(hertz) = capture.rate_hz.filter(|hertz| !RATES_HZ.contains(hertz)) {
        let message = format!("{hertz} frames a second show no face as it moves");
        let hint =
            "take 60 (what most displays show), another rate from 15 to 1000, or leave it out";
        issues.error(below(pointer, "rateHz"), "out-of-range", message, hint);
    }
    if let Some(CaptureSource::File(_)) = capture.source() {
        if capture.markers.is_none() {
            let message = "no marker map: nothing says where the markers sit on the avatar";
            issues.error(pointer, "no-markers", message, "add \"markers\": \"map.json\"");
        }
        if capture.neutral.is_none() {
            let message = "no frames of the neutral face";
            let hint =
                "add \"neutral\": [first, end], or make sure that the capture begins with it";
            issues.warning(pointer, "no-neutral", message, hint);
        }
        match capture.head.len() {
            0 => {
                let message = "no head markers: the head's own motion stays in the face's";
                issues.warning(pointer, "no-head", message, "add \"head\": [three labels or more]");
            }
            count @ 1..3 => {
                let message = format!("{count} head markers do not fix the head");
                issues.error(below(pointer, "head"), "too-few", message, "name three or more");
            }
            _ => {}
        }
    } else if capture.builtin.is_some()
        && (capture.markers.is_some() || capture.unit.is_some() || !capture.head.is_empty())
    {
        let message = "a built-in actor brings its markers along";
        issues.error(pointer, "not-needed", message, "remove markers, head and unit");
    }
}

fn segments(subject: &Subject<'_>, issues: &mut Issues) {
    let stimuli = &subject.study.stimuli;
    let captures: Vec<&str> = stimuli.captures.keys().map(String::as_str).collect();
    for (index, segment) in stimuli.segments.iter().enumerate() {
        let pointer = below("/stimuli/segments", index);
        identifier(&segment.id, &below(&pointer, "id"), issues);
        if stimuli.segments[..index].iter().any(|each| each.id == segment.id) {
            let message = format!("two segments \"{}\"", segment.id);
            issues.error(below(&pointer, "id"), "duplicate", message, "give it another one");
        }
        let Some(capture) = stimuli.captures.get(&segment.capture) else {
            let message = format!("there is no capture \"{}\"", segment.capture);
            let hint = suggestion(&segment.capture, &captures);
            issues.error(below(&pointer, "capture"), "unknown-reference", message, hint);
            continue;
        };
        match (capture.source(), segment.performance, segment.first, segment.end) {
            (Some(CaptureSource::Builtin(_)), Some(performance), None, None) => {
                if !(1..=3).contains(&performance.intensity) {
                    let message = format!("intensity {}", performance.intensity);
                    let place = format!("{pointer}/performance/intensity");
                    issues.error(place, "out-of-range", message, "write 1, 2 or 3");
                }
            }
            (Some(CaptureSource::Builtin(_)), ..) => {
                let message = "a cut of a built-in actor is a performance, not frames";
                let hint =
                    "write \"performance\": {\"expression\": \"joy\", \"intensity\": 2} alone";
                issues.error(pointer, "bad-segment", message, hint);
            }
            (Some(CaptureSource::File(_)), None, Some(first), Some(end)) => {
                if first >= end {
                    let message = format!("frames {first} to {end} are none");
                    let hint = "end is the frame after the last one";
                    issues.error(pointer, "bad-range", message, hint);
                }
            }
            (Some(CaptureSource::File(_)), ..) => {
                let message = "a cut of a file is its frames";
                let hint = "write \"first\" and \"end\", and no performance";
                issues.error(pointer, "bad-segment", message, hint);
            }
            (None, ..) => {}
        }
    }
}

/// What the solver itself finds wrong in the parameters.
fn methods(subject: &Subject<'_>, issues: &mut Issues) {
    for (name, method) in &subject.study.stimuli.methods {
        for problem in method.spec.problems() {
            let pointer = below(&below("/stimuli/methods", name), problem.field.replace('.', "/"));
            let (message, hint) = match problem.message.split_once("; ") {
                Some((message, hint)) => (message.to_owned(), hint.to_owned()),
                None => (problem.message, "mend the value".to_owned()),
            };
            issues.error(pointer.replace("~1", "/"), "bad-parameter", message, hint);
        }
    }
}

/// What a regression learns from.
fn training(subject: &Subject<'_>, lookup: &FileLookup<'_>, issues: &mut Issues) {
    let stimuli = &subject.study.stimuli;
    let captures: Vec<&str> = stimuli.captures.keys().map(String::as_str).collect();
    for (name, method) in &stimuli.methods {
        let learns = method.spec.method == mimique_solver::Method::Regression;
        let pointer = below("/stimuli/methods", name);
        let Some(training) = &method.training else {
            if learns {
                let message = "no training: a regression learns from a range of motion";
                let hint = "add \"training\": {\"capture\": \"...\", \"weights\": \"weights.csv\"}";
                issues.error(pointer, "no-training", message, hint);
            }
            continue;
        };
        let place = below(&pointer, "training");
        if !learns {
            let message = format!("\"{}\" learns nothing", method.word());
            issues.error(place, "not-needed", message, "remove training, or take regression");
            continue;
        }
        file(training.weights.as_deref(), &below(&place, "weights"), lookup, issues);
        let Some(capture) = stimuli.captures.get(&training.capture) else {
            let message = format!("there is no capture \"{}\"", training.capture);
            let hint = suggestion(&training.capture, &captures);
            issues.error(below(&place, "capture"), "unknown-reference", message, hint);
            continue;
        };
        match (capture.source(), &training.weights) {
            (Some(CaptureSource::File(_)), None) => {
                let message = "no weights: nothing says what the take's frames are";
                issues.error(place, "no-weights", message, "add \"weights\": \"weights.csv\"");
            }
            (Some(CaptureSource::Builtin(_)), Some(_)) => {
                let message = "a built-in actor brings the weights along";
                issues.error(below(&place, "weights"), "not-needed", message, "remove weights");
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
    let mut refer = |name: &str, known: &[&str], what: &str, pointer: String| {
        if !known.contains(&name) {
            let message = format!("there is no {what} \"{name}\"");
            issues.error(pointer, "unknown-reference", message, suggestion(name, known));
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
    let used = factors_used(subject);
    let avatars = stimuli.avatars.iter();
    let methods = stimuli.methods.iter();
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
                    || ["clip", "segment", "avatar", "truth"].contains(&factor.as_str());
                if taken {
                    let message = format!("\"{factor}\" is the name of a column of every export");
                    issues.error(place, "name-taken", message, "give the factor another name");
                } else if let Some((_, (other, _))) = elsewhere {
                    let message = format!("\"{factor}\" is a factor of {what} and of {other}");
                    let hint = "keep it in one place, so that a clip has one value";
                    issues.error(place, "factor-twice", message, hint);
                } else if !used.contains(factor.as_str()) && complained.insert(factor) {
                    let message = format!("factor \"{factor}\" is never used");
                    let hint = "name it in a hypothesis, a constraint, a selection of clips or a truth; or remove it";
                    issues.warning(place, "unused-factor", message, hint);
                }
            }
        }
    }
}

/// The factors that something of the study reads. `method` and `alpha` need no use.
fn factors_used<'a>(subject: &Subject<'a>) -> BTreeSet<&'a str> {
    fn of_sequence<'a>(sequence: &'a Sequence, used: &mut BTreeSet<&'a str>) {
        used.extend(sequence.constraints.iter().map(|each| each.factor.as_str()));
        for item in &sequence.components {
            if let SequenceItem::Sequence(nested) = item {
                of_sequence(nested, used);
            }
        }
    }
    let study = subject.study;
    let mut used = BTreeSet::from(["method", "alpha", "expression", "intensity"]);
    for hypothesis in &study.hypotheses {
        used.extend(hypothesis.factors.iter().map(String::as_str));
    }
    for table in &study.tables {
        let crossed = table.crossings.iter().flatten();
        used.extend(table.factors.iter().chain(crossed).map(String::as_str));
    }
    for question in &study.questions {
        if let QuestionKind::SingleChoice(choice) = &question.kind {
            used.extend(choice.truth.as_deref());
        }
    }
    for component in study.components.values() {
        if let Component::Trials(block) = component {
            used.extend(block.clips.factors.keys().map(String::as_str));
        }
    }
    of_sequence(&study.sequence, &mut used);
    used
}

fn look(subject: &Subject<'_>, issues: &mut Issues) {
    let look = &subject.study.stimuli.look;
    let digits = look.background.strip_prefix('#').unwrap_or_default();
    if digits.len() != 6 || !digits.chars().all(|digit| digit.is_ascii_hexdigit()) {
        let message = format!("\"{}\" is not a colour", look.background);
        issues.error("/stimuli/look/background", "bad-colour", message, "write #rrggbb");
    }
    for (key, size) in [("width", look.width), ("height", look.height)] {
        if !(64..=4096).contains(&size) {
            let message = format!("{size} pixels");
            let place = below("/stimuli/look", key);
            issues.error(place, "out-of-range", message, "take 64 to 4096");
        }
    }
}

fn unused(subject: &Subject<'_>, issues: &mut Issues) {
    let stimuli = &subject.study.stimuli;
    let mut complain = |name: &str, what: &str, used: bool, pointer: String| {
        if !used {
            let message = format!("no clip uses {what} \"{name}\"");
            issues.warning(pointer, "unused", message, "name it in /stimuli/clips, or remove it");
        }
    };
    for name in stimuli.avatars.keys() {
        let used = subject.clips.iter().any(|clip| clip.avatar == *name);
        complain(name, "avatar", used, below("/stimuli/avatars", name));
    }
    for name in stimuli.methods.keys() {
        let used = subject.clips.iter().any(|clip| clip.method == *name);
        complain(name, "method", used, below("/stimuli/methods", name));
    }
    for (index, segment) in stimuli.segments.iter().enumerate() {
        let used = subject.clips.iter().any(|clip| clip.segment == segment.id);
        complain(&segment.id, "segment", used, below("/stimuli/segments", index));
    }
    for name in stimuli.captures.keys() {
        let mut training = stimuli.methods.values().filter_map(|each| each.training.as_ref());
        let used = stimuli.segments.iter().any(|segment| segment.capture == *name)
            || training.any(|training| training.capture == *name);
        complain(name, "capture", used, below("/stimuli/captures", name));
    }
}
