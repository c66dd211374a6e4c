//! The sound of clips: files that are there, times, captions, which sound is played with which clip, and the page
//! on which the volume is set. What a file holds is known to those who open it.

use std::collections::BTreeSet;

use super::issue::{Issues, below};
use super::problem::Problem;
use super::{FileLookup, Subject};
use crate::study_file::{Caption, CaptionRule, SegmentSound, SoundRule};

/// Delays of a sound, milliseconds: twice what any study of asynchrony asks for.
const DELAYS_MS: std::ops::RangeInclusive<f64> = -2000.0..=2000.0;

pub(super) fn examine(subject: &Subject<'_>, lookup: &FileLookup<'_>, issues: &mut Issues) {
    captures(subject, lookup, issues);
    segments(subject, lookup, issues);
    rules(subject, issues);
    section(subject, issues);
}

fn time(seconds: Option<f64>, pointer: &str, issues: &mut Issues) {
    if let Some(seconds) = seconds.filter(|seconds| !(0.0..=86_400.0).contains(seconds)) {
        issues.error(below(pointer, "fromS"), Problem::SoundTime { seconds });
    }
}

fn file(path: &str, pointer: &str, lookup: &FileLookup<'_>, issues: &mut Issues) {
    if let Err(problem) = lookup(path) {
        issues.error(below(pointer, "file"), problem);
    }
}

fn captures(subject: &Subject<'_>, lookup: &FileLookup<'_>, issues: &mut Issues) {
    for (name, capture) in &subject.study.stimuli.captures {
        let Some(sound) = &capture.sound else { continue };
        let pointer = below(&below("/stimuli/captures", name), "sound");
        if capture.builtin.is_some() {
            issues.error(&pointer, Problem::SoundOfActor);
        }
        file(&sound.file, &pointer, lookup, issues);
        time(sound.from_s, &pointer, issues);
    }
}

fn segments(subject: &Subject<'_>, lookup: &FileLookup<'_>, issues: &mut Issues) {
    let stimuli = &subject.study.stimuli;
    for (index, segment) in stimuli.segments.iter().enumerate() {
        let Some(SegmentSound { file: own, from_s, captions: texts }) = &segment.sound else {
            continue;
        };
        let pointer = below(&below("/stimuli/segments", index), "sound");
        let of_capture =
            stimuli.captures.get(&segment.capture).and_then(|capture| capture.sound.as_ref());
        match own {
            Some(path) => file(path, &pointer, lookup, issues),
            None if from_s.is_some() => {
                issues.error(below(&pointer, "fromS"), Problem::SoundFromOfCapture);
            }
            None if of_capture.is_none() => issues.error(&pointer, Problem::NoSoundFile),
            None => {}
        }
        time(*from_s, &pointer, issues);
        captions(texts, &below(&pointer, "captions"), issues);
    }
}

fn captions(texts: &[Caption], pointer: &str, issues: &mut Issues) {
    let mut before_s = 0.0;
    for (index, caption) in texts.iter().enumerate() {
        let Caption { from_s, to_s, .. } = *caption;
        let place = below(pointer, index);
        if !(from_s >= 0.0 && to_s > from_s) {
            issues.error(place, Problem::CaptionTimes { from_s, to_s });
        } else if from_s < before_s {
            issues.error(place, Problem::CaptionOverlaps { from_s, before_s });
        } else {
            before_s = to_s;
        }
    }
}

/// Which sound is played with which clip.
fn rules(subject: &Subject<'_>, issues: &mut Issues) {
    let study = subject.study;
    let stimuli = &study.stimuli;
    let names: Vec<&str> = stimuli.sounds.keys().map(String::as_str).collect();
    for (name, rule) in &stimuli.sounds {
        let pointer = below("/stimuli/sounds", name);
        super::stimuli::identifier(name, &pointer, issues);
        one_rule(subject, rule, &pointer, issues);
        if !subject.clips.iter().any(|clip| clip.sound.as_ref() == Some(name)) {
            let problem = Problem::UnusedByClips { what: "sound", name: name.clone() };
            issues.warning(&pointer, problem);
        }
    }
    if let Some(cross) = &stimuli.clips.cross {
        for (index, name) in cross.sounds.iter().enumerate() {
            if !stimuli.sounds.contains_key(name) {
                let place = below("/stimuli/clips/cross/sounds", index);
                issues.error(place, Problem::unknown("sound", name, &names));
            }
        }
    }
    for (index, entry) in stimuli.clips.list.iter().enumerate() {
        let place = below("/stimuli/clips/list", index);
        match &entry.sound {
            Some(name) if !stimuli.sounds.contains_key(name) => {
                let problem = Problem::unknown("sound", name, &names);
                issues.error(below(&place, "sound"), problem);
            }
            None if !names.is_empty() => issues.error(place, Problem::SoundNotNamed),
            _ => {}
        }
    }
    let mut told = BTreeSet::new();
    for clip in subject.clips {
        let Some(name) = &clip.sound else { continue };
        let Some(rule) = stimuli.sounds.get(name).filter(|rule| !rule.silent) else { continue };
        let other = rule.from.get(&clip.segment).unwrap_or(&clip.segment);
        if study.sound_of(other).is_none() && told.insert((name, other)) {
            let problem = Problem::HeardAsSilent { segment: other.clone(), sound: name.clone() };
            issues.warning(below("/stimuli/sounds", name), problem);
        }
    }
}

fn one_rule(subject: &Subject<'_>, rule: &SoundRule, pointer: &str, issues: &mut Issues) {
    let study = subject.study;
    if rule.silent && (!rule.from.is_empty() || rule.delay_ms.is_some()) {
        issues.error(pointer, Problem::SilentAndMore);
    }
    if let Some(value) = rule.delay_ms.filter(|delay| !DELAYS_MS.contains(delay)) {
        let (least, most) = (*DELAYS_MS.start(), *DELAYS_MS.end());
        let problem = Problem::OutOfRange { value, unit: "ms", least, most };
        issues.error(below(pointer, "delayMs"), problem);
    }
    let known: Vec<&str> = study.stimuli.segments.iter().map(|each| each.id.as_str()).collect();
    for (segment, other) in &rule.from {
        let place = below(&below(pointer, "from"), segment);
        for name in [segment, other].into_iter().filter(|name| !known.contains(&name.as_str())) {
            issues.error(&place, Problem::unknown("segment", name, &known));
        }
        if known.contains(&other.as_str()) && study.sound_of(other).is_none() {
            issues.error(place, Problem::SoundWithoutFile { segment: other.clone() });
        }
    }
}

/// Captions and the page on which the volume is set.
fn section(subject: &Subject<'_>, issues: &mut Issues) {
    let study = subject.study;
    let has_captions =
        |sound: &Option<SegmentSound>| sound.as_ref().is_some_and(|own| !own.captions.is_empty());
    let captioned = study.stimuli.segments.iter().position(|each| has_captions(&each.sound));
    let rule = study.sound.as_ref().map_or(CaptionRule::Off, |section| section.captions);
    if let Some(index) = captioned.filter(|_| rule == CaptionRule::Off) {
        let place = format!("/stimuli/segments/{index}/sound/captions");
        issues.warning(place, Problem::CaptionsNotShown);
    }
    let Some(section) = &study.sound else { return };
    if !study.has_sound() {
        issues.error("/sound", Problem::NoSound);
    } else if captioned.is_none() && rule != CaptionRule::Off {
        issues.error("/sound/captions", Problem::NoCaptions);
    }
    let check = &section.check;
    let ranges = [
        ("rounds", check.rounds, "rounds", 1, 20),
        ("correct", check.correct, "rounds", 1, check.rounds.max(1)),
        ("mostTones", check.most_tones, "tones", 2, 9),
        ("attempts", check.attempts, "attempts", 1, 10),
    ];
    for (key, value, unit, least, most) in ranges {
        if !(least..=most).contains(&value) {
            let [value, least, most] = [value, least, most].map(f64::from);
            let place = below("/sound/check", key);
            issues.error(place, Problem::OutOfRange { value, unit, least, most });
        }
    }
}
