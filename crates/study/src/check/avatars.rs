//! Avatars: one source each, files that are there, films of every segment they are shown in.

use super::issue::{Issues, below};
use super::nearest::suggestion;
use super::{FileLookup, Subject};
use crate::study_file::{Avatar, AvatarLook, AvatarSource, Clip, film_type};

/// Where an avatar comes from.
pub(super) fn examine(
    avatar: &Avatar,
    pointer: &str,
    lookup: &FileLookup<'_>,
    issues: &mut Issues,
) {
    let given = [
        ("builtin", avatar.builtin.is_some()),
        ("file", avatar.file.is_some()),
        ("videos", !avatar.videos.is_empty()),
    ];
    let given: Vec<&str> = given.iter().filter(|(_, is)| *is).map(|(word, _)| *word).collect();
    if given.len() != 1 {
        let message = match given.as_slice() {
            [] => "neither builtin, file nor videos".to_owned(),
            several => format!("several sources: {}", several.join(" and ")),
        };
        let hint =
            "give one: \"builtin\": {}, \"file\": \"...\" or \"videos\": {\"segment\": \"...\"}";
        issues.error(pointer, "one-source", message, hint);
    }
    if let Some(path) = &avatar.file {
        missing(path, &below(pointer, "file"), lookup, issues);
    }
    for (segment, path) in &avatar.videos {
        let place = below(&below(pointer, "videos"), segment);
        if film_type(path).is_none() {
            let message = format!("\"{path}\" is no film that every browser plays");
            issues.error(&place, "bad-film", message, "take an MP4 (H.264) or a WebM file");
        }
        missing(path, &place, lookup, issues);
    }
    if !avatar.videos.is_empty() && avatar.look == AvatarLook::Reference {
        let message = "a film is shown as it is";
        issues.error(below(pointer, "look"), "not-needed", message, "remove look");
    }
    if let Some(builtin) = &avatar.builtin
        && builtin.actor.is_some()
        && builtin.seed != 0
    {
        let message = "both seed and actor say who it is";
        issues.error(below(pointer, "builtin"), "one-source", message, "remove one of them");
    }
}

/// Films are not solved, and every segment that is shown as a film needs one.
pub(super) fn films(subject: &Subject<'_>, issues: &mut Issues) {
    let stimuli = &subject.study.stimuli;
    let segments: Vec<&str> = stimuli.segments.iter().map(|each| each.id.as_str()).collect();
    for (name, avatar) in &stimuli.avatars {
        let Some(AvatarSource::Videos(videos)) = avatar.source() else { continue };
        let pointer = below(&below("/stimuli/avatars", name), "videos");
        for segment in videos.keys().filter(|segment| !segments.contains(&segment.as_str())) {
            let message = format!("there is no segment \"{segment}\"");
            let hint = suggestion(segment, &segments);
            issues.error(below(&pointer, segment), "unknown-reference", message, hint);
        }
        let shown = || subject.clips.iter().filter(|clip| clip.avatar == *name);
        for clip in shown().filter(|clip| !videos.contains_key(&clip.segment)) {
            let message = format!("no film of segment \"{}\", which a clip shows", clip.segment);
            let hint = "name its file, or leave the clip out in /stimuli/clips";
            issues.error(&pointer, "missing-film", message, hint);
        }
        let solved = |clip: &&Clip| {
            stimuli.methods.get(&clip.method).is_some_and(|method| method.word() != "recorded")
        };
        if let Some(clip) = shown().find(solved) {
            let message = format!("method \"{}\" cannot animate films", clip.method);
            let hint =
                "show them with a method {\"method\": \"recorded\"}: choose in /stimuli/clips";
            issues.error(&pointer, "bad-film", message, hint);
        }
    }
}

fn missing(path: &str, pointer: &str, lookup: &FileLookup<'_>, issues: &mut Issues) {
    if let Err((message, hint)) = lookup(path) {
        issues.error(pointer, "missing-file", message, hint);
    }
}
