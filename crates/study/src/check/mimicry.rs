//! The measuring of participants' faces: files that are there, a rate that cameras have, clips whose motion is known.

use super::issue::{Issues, below};
use super::problem::Problem;
use super::{FileLookup, Subject};
use crate::study_file::MIMICRY_FILES;

/// Pictures per second: fewer show no course, more no camera gives.
const RATES_HZ: std::ops::RangeInclusive<f64> = 5.0..=60.0;

pub(super) fn examine(subject: &Subject<'_>, lookup: &FileLookup<'_>, issues: &mut Issues) {
    let study = subject.study;
    let Some(mimicry) = &study.mimicry else { return };
    for file in MIMICRY_FILES {
        let key = if file.below.is_some() { "runtime" } else { "model" };
        if let Err(problem) = lookup(&file.path(mimicry)) {
            issues.error(below("/mimicry", key), problem);
        }
    }
    if !RATES_HZ.contains(&mimicry.rate_hz) {
        let (least, most) = (*RATES_HZ.start(), *RATES_HZ.end());
        let (value, unit) = (mimicry.rate_hz, "pictures per second");
        issues.error("/mimicry/rateHz", Problem::OutOfRange { value, unit, least, most });
    }
    let is_drawn = |avatar: &String| {
        study.stimuli.avatars.get(avatar).is_some_and(|avatar| avatar.videos.is_empty())
    };
    if !subject.clips.iter().any(|clip| is_drawn(&clip.avatar)) {
        issues.warning("/mimicry", Problem::NoKnownMotion);
    }
    if study.static_hosting.is_some() {
        issues.warning("/staticHosting", Problem::MimicryNeedsServer);
    }
}
