//! The study with more or fewer clips: its segments repeated or left out, whatever else a clip is made
//! of kept.

use std::collections::BTreeMap;

use mimique_study::{Clip, Study};

/// The study's segments in an order such that the first few of them have the levels of every factor as
/// evenly as they can.
pub(crate) fn balanced_segments(clips: &[Clip]) -> Vec<String> {
    let mut left: Vec<(String, Vec<(String, String)>)> = Vec::new();
    for clip in clips {
        if !left.iter().any(|(segment, _)| *segment == clip.segment) {
            // What all clips of a segment share is the segment's own.
            let shared = clip.factors.iter().filter(|(factor, value)| {
                clips
                    .iter()
                    .filter(|other| other.segment == clip.segment)
                    .all(|other| other.factors.get(*factor) == Some(*value))
            });
            let shared = shared.map(|(factor, value)| (factor.clone(), value.to_string()));
            left.push((clip.segment.clone(), shared.collect()));
        }
    }
    let mut taken: BTreeMap<(String, String), usize> = BTreeMap::new();
    let mut order = Vec::new();
    while !left.is_empty() {
        let often = |levels: &[(String, String)]| -> usize {
            levels.iter().map(|level| taken.get(level).copied().unwrap_or(0)).sum()
        };
        let next = (0..left.len()).min_by_key(|&place| often(&left[place].1)).unwrap_or(0);
        let (segment, levels) = left.remove(next);
        for level in levels {
            *taken.entry(level).or_insert(0) += 1;
        }
        order.push(segment);
    }
    order
}

/// Clips of a study with another number of segments, and for each clip of the study the places of those
/// that stand for it.
pub(crate) struct ScaledClips {
    pub clips: Vec<Clip>,
    /// The clip of the study that each of them stands for.
    pub originals: Vec<String>,
    pub stand_ins: BTreeMap<String, Vec<usize>>,
}

/// About `wanted` clips: whole segments are repeated or left out, so the number is rounded up to the
/// next that has all methods and avatars of each segment.
pub(crate) fn scaled(study: &Study, wanted: usize) -> ScaledClips {
    let own = study.clips();
    let order = balanced_segments(&own);
    let (clips, originals) = (Vec::new(), Vec::new());
    let mut result = ScaledClips { clips, originals, stand_ins: BTreeMap::new() };
    let mut round = 1;
    while !own.is_empty() && result.clips.len() < wanted {
        for segment in &order {
            if result.clips.len() >= wanted {
                break;
            }
            for clip in own.iter().filter(|clip| clip.segment == *segment) {
                let places = result.stand_ins.entry(clip.id.clone()).or_default();
                places.push(result.clips.len());
                let mut copy = clip.clone();
                if round > 1 {
                    copy.id = format!("{}+{round}", clip.id);
                    copy.segment = format!("{}+{round}", clip.segment);
                }
                result.clips.push(copy);
                result.originals.push(clip.id.clone());
            }
        }
        round += 1;
    }
    result
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;

    #[test]
    fn more_and_fewer_clips_keep_methods_and_balance_emotions() {
        let path =
            concat!(env!("CARGO_MANIFEST_DIR"), "/../../study-config/power/independence.json");
        let study = Study::from_text(&std::fs::read_to_string(path).unwrap()).unwrap();
        let levels = |clips: &[Clip], factor: &str| {
            let mut counts: BTreeMap<String, usize> = BTreeMap::new();
            for clip in clips {
                *counts.entry(clip.factor_text(factor).unwrap()).or_insert(0) += 1;
            }
            counts
        };
        for (wanted, expected) in [(18, 18), (19, 21), (54, 54), (108, 108)] {
            let clips = scaled(&study, wanted).clips;
            assert_eq!(clips.len(), expected);
            let methods = levels(&clips, "method");
            assert!(methods.values().all(|count| *count == expected / 3), "{methods:?}");
            let emotions = levels(&clips, "expression");
            assert_eq!(emotions.len(), 6);
            let (least, most) =
                (emotions.values().min().unwrap(), emotions.values().max().unwrap());
            assert!(most - least <= 3, "{emotions:?}");
            let ids: std::collections::BTreeSet<&str> =
                clips.iter().map(|clip| clip.id.as_str()).collect();
            assert_eq!(ids.len(), clips.len());
        }
    }
}
