//! What blocks of levels have in common: the method and its parameter, segments and avatar.

use mimique_solver::{Kind, MethodSpec, PARAMETERS};

use super::Subject;
use super::issue::{Issues, below};
use super::problem::Problem;

/// The methods (by their keys in the block), the avatar and the segments are there, and the parameter is a number.
pub(super) fn names(
    subject: &Subject<'_>,
    methods: &[(&str, &String)],
    (avatar, segments): (&Option<String>, &[String]),
    (parameter, key): (&str, &str),
    pointer: &str,
    issues: &mut Issues,
) {
    let stimuli = &subject.study.stimuli;
    for (key, name) in methods {
        if !stimuli.methods.contains_key(*name) {
            let problem = Problem::unknown("method", name, stimuli.methods.keys());
            issues.error(below(pointer, key), problem);
        }
    }
    for (index, segment) in segments.iter().enumerate() {
        let place = below(&below(pointer, "segments"), index);
        if !stimuli.segments.iter().any(|each| each.id == *segment) {
            let known = stimuli.segments.iter().map(|each| &each.id);
            issues.error(place, Problem::unknown("segment", segment, known));
        } else if segments[..index].contains(segment) {
            issues.error(place, Problem::NamedTwice { name: segment.clone() });
        }
    }
    match avatar {
        Some(avatar) if !stimuli.avatars.contains_key(avatar) => {
            let problem = Problem::unknown("avatar", avatar, stimuli.avatars.keys());
            issues.error(below(pointer, "avatar"), problem);
        }
        None if stimuli.avatars.len() > 1 => {
            issues.error(pointer, Problem::MissingKey { key: "avatar".to_owned() });
        }
        given => {
            let avatar = given.as_ref().or_else(|| stimuli.avatars.keys().next());
            let videos = avatar.and_then(|avatar| stimuli.avatars.get(avatar));
            if videos.is_some_and(|avatar| !avatar.videos.is_empty()) {
                issues.error(pointer, Problem::LevelsOfVideos);
            }
        }
    }
    if !stimuli.sounds.is_empty() {
        issues.error(pointer, Problem::LevelsWithSound);
    }
    let numbers = || PARAMETERS.iter().filter(|each| each.kind == Kind::Number);
    if !numbers().any(|each| each.key == parameter) {
        let known = numbers().map(|each| each.key);
        let place = format!("{pointer}/{key}");
        issues.error(place, Problem::unknown("parameter", parameter, known));
    }
}

/// Whether a method takes its parameter at all of these levels; what it does not take is reported at `place`.
pub(super) fn are_solved(
    subject: &Subject<'_>,
    (method, parameter): (&str, &str),
    levels: &[f64],
    place: &str,
    issues: &mut Issues,
) -> bool {
    let Some(entry) = subject.study.stimuli.methods.get(method) else { return false };
    for &level in levels {
        let mut spec = serde_json::to_value(&entry.spec).unwrap_or_default();
        spec[parameter] = level.into();
        if let Err(faults) = MethodSpec::checked(&spec) {
            let what = faults.first().map_or_else(String::new, |fault| {
                format!("\"{}\" {}", fault.field, fault.message())
            });
            let remedy = faults.first().map_or_else(String::new, |fault| fault.remedy());
            issues.error(place, Problem::LevelNotSolved { what, remedy });
            return false;
        }
    }
    true
}
