//! Avatars: one source each, files that are there, videos of every segment they are shown in.

use super::issue::{Issues, below};
use super::problem::Problem;
use super::{FileLookup, Subject};
use crate::study_file::{Avatar, AvatarLook, AvatarSource, Clip, video_type};

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
        let problem = match given.as_slice() {
            [] => Problem::NoAvatarSource,
            several => Problem::AvatarSources { given: several.join(" and ") },
        };
        issues.error(pointer, problem);
    }
    if let Some(path) = &avatar.file {
        missing(path, &below(pointer, "file"), lookup, issues);
    }
    for (segment, path) in &avatar.videos {
        let place = below(&below(pointer, "videos"), segment);
        if video_type(path).is_none() {
            issues.error(&place, Problem::BadVideo { path: path.clone() });
        }
        missing(path, &place, lookup, issues);
    }
    if !avatar.videos.is_empty() && avatar.look == AvatarLook::Reference {
        issues.error(below(pointer, "look"), Problem::VideoHasNoLook);
    }
    if let Some(builtin) = &avatar.builtin
        && builtin.actor.is_some()
        && builtin.seed != 0
    {
        issues.error(below(pointer, "builtin"), Problem::SeedAndActor);
    }
}

/// Videos are not solved, and every segment that is shown as a video needs one.
pub(super) fn videos(subject: &Subject<'_>, issues: &mut Issues) {
    let stimuli = &subject.study.stimuli;
    let segments: Vec<&str> = stimuli.segments.iter().map(|each| each.id.as_str()).collect();
    for (name, avatar) in &stimuli.avatars {
        let Some(AvatarSource::Videos(videos)) = avatar.source() else { continue };
        let pointer = below(&below("/stimuli/avatars", name), "videos");
        for segment in videos.keys().filter(|segment| !segments.contains(&segment.as_str())) {
            issues.error(below(&pointer, segment), Problem::unknown("segment", segment, &segments));
        }
        let shown = || subject.clips.iter().filter(|clip| clip.avatar == *name);
        for clip in shown().filter(|clip| !videos.contains_key(&clip.segment)) {
            issues.error(&pointer, Problem::MissingVideo { segment: clip.segment.clone() });
        }
        let solved = |clip: &&Clip| {
            stimuli.methods.get(&clip.method).is_some_and(|method| method.word() != "recorded")
        };
        if let Some(clip) = shown().find(solved) {
            issues.error(&pointer, Problem::MethodOnVideo { method: clip.method.clone() });
        }
    }
}

fn missing(path: &str, pointer: &str, lookup: &FileLookup<'_>, issues: &mut Issues) {
    if let Err(problem) = lookup(path) {
        issues.error(pointer, problem);
    }
}
