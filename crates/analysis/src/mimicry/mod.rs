//! Mimicry in the report: how people's own faces follow the faces that they see.

mod figure;
mod section;
pub(crate) mod tables;

use std::collections::{BTreeMap, BTreeSet};

use mimique_stats::{
    CoupledPlay, Couplings, Courses, LagWindow, LaggedCorrelation, LaggedCorrelationOptions,
    Surrogates, lagged_correlation, resampled_course,
};
use serde::Serialize;

use crate::trials::export::Export;
use tables::{FaceTables, Samples, shapes};

/// Rate of all courses, Hz.
pub(crate) const RATE_HZ: f64 = 30.0;
/// Lags, seconds.
pub(crate) const LAGS_S: [f64; 2] = [-0.5, 1.5];
/// Seconds that must be there on both sides of a lag.
pub(crate) const LEAST_S: f64 = 1.0;
/// Two pictures of the camera that are farther apart, seconds, have a gap between them.
pub(crate) const LONGEST_GAP_S: f64 = 0.25;
/// Standard deviation of a weight over a clip from which the clip moves that shape.
pub(crate) const MOVED: f64 = 0.02;
/// Surrogates of the whole study and of each level.
pub(crate) const SURROGATES: usize = 999;
/// Different clips that a person must have seen for the other clips to be surrogates.
pub(crate) const OTHER_CLIPS: usize = 3;

/// What was found of mimicry.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct MimicryResult {
    /// Over all plays.
    pub all: LaggedCorrelation,
    /// At each level of each factor with several.
    pub levels: Vec<LevelMimicry>,
    /// Of each clip, at the lag of all.
    pub clips: Vec<ClipMimicry>,
    /// Plays that were left out.
    pub left_out: LeftOut,
}

/// At one level of a factor.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct LevelMimicry {
    pub factor: String,
    pub level: String,
    pub found: LaggedCorrelation,
}

/// Of one clip.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct ClipMimicry {
    pub clip: String,
    pub people: usize,
    /// Mean correlation at the lag of all plays.
    pub r: f64,
    /// Its 95 % interval by t over people; none of one person.
    pub interval_95: Option<[f64; 2]>,
}

/// Whole plays that were measured and are not used, by why.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize)]
pub(crate) struct LeftOut {
    /// The person or the trial is left out of the analysis.
    pub excluded: usize,
    /// Nothing is known of how the clip moves: a video, or another preparation of it.
    pub unknown_clip: usize,
    /// The clip moves no shape with one of ARKit's names.
    pub moves_nothing: usize,
    /// A face was seen for too short a time, or it did not move.
    pub too_little: usize,
}

/// What can be told, or why nothing.
pub(crate) enum FoundMimicry {
    Found(Box<MimicryResult>),
    Nothing(LeftOut),
}

/// The plays that are used, with their stimuli.
struct UsedPlays {
    given: Couplings,
    /// Name of each clip.
    clips: Vec<String>,
    left_out: LeftOut,
}

/// Mimicry over all plays, by the levels of these factors and by clip.
pub(crate) fn mimicry(
    tables: &FaceTables,
    export: &Export,
    factors: &[String],
    seed: u64,
    level_of: &dyn Fn(&str, &str) -> Option<String>,
) -> FoundMimicry {
    let UsedPlays { given, clips, mut left_out } = used_plays(tables, export);
    let Some(all) = tested(&given, SURROGATES, seed) else {
        left_out.too_little += given.plays.len();
        return FoundMimicry::Nothing(left_out);
    };
    left_out.too_little += all.dropped;
    let mut levels = Vec::new();
    for factor in factors {
        let own: Vec<Option<String>> = clips.iter().map(|clip| level_of(clip, factor)).collect();
        let names: BTreeSet<&String> = own.iter().flatten().collect();
        for level in names.iter().filter(|_| names.len() > 1) {
            let part = only(&given, |clip| own[clip].as_ref() == Some(*level));
            if let Some(found) = tested(&part, SURROGATES, seed) {
                let (factor, level) = (factor.clone(), (*level).clone());
                levels.push(LevelMimicry { factor, level, found });
            }
        }
    }
    let place = all.lags_s.iter().position(|lag| *lag == all.lag_s).unwrap_or_default();
    let of_clip = |(index, clip): (usize, &String)| {
        // Its curve is what is wanted: the fewest surrogates that there can be.
        let options = options(Surrogates::Shifted, mimique_stats::FEWEST_PERMUTATIONS, seed);
        let found = lagged_correlation(&only(&given, |own| own == index), options).ok()??;
        Some(ClipMimicry {
            clip: clip.clone(),
            people: found.participants,
            r: found.r[place],
            interval_95: found.interval_95.map(|ends| ends[place]),
        })
    };
    let clips = clips.iter().enumerate().filter_map(of_clip).filter(|own| own.r.is_finite());
    let clips = clips.collect();
    FoundMimicry::Found(Box::new(MimicryResult { all, levels, clips, left_out }))
}

fn options(kind: Surrogates, surrogates: usize, seed: u64) -> LaggedCorrelationOptions {
    let window = LagWindow::of_seconds(RATE_HZ, LAGS_S, LEAST_S);
    LaggedCorrelationOptions { window, surrogates, kind, seed }
}

/// The test, by other clips where at least half of the people have seen several.
fn tested(given: &Couplings, surrogates: usize, seed: u64) -> Option<LaggedCorrelation> {
    let mut seen: BTreeMap<usize, BTreeSet<usize>> = BTreeMap::new();
    for play in &given.plays {
        seen.entry(play.person).or_default().insert(play.clip);
    }
    let enough = seen.values().filter(|clips| clips.len() >= OTHER_CLIPS).count();
    let by_clips = 2 * enough >= seen.len();
    let kind = if by_clips { Surrogates::OtherClips } else { Surrogates::Shifted };
    lagged_correlation(given, options(kind, surrogates, seed)).ok().flatten()
}

/// The plays of some clips.
fn only(given: &Couplings, is_meant: impl Fn(usize) -> bool) -> Couplings {
    let plays = given.plays.iter().filter(|play| is_meant(play.clip)).cloned().collect();
    Couplings { people: given.people.clone(), clips: given.clips.clone(), plays }
}

fn used_plays(tables: &FaceTables, export: &Export) -> UsedPlays {
    let mut used: BTreeSet<(&str, &str)> = BTreeSet::new();
    for answers in export.all_answers() {
        used.extend(answers.iter().map(|answer| {
            let person = &export.people[answer.person].id;
            (person.as_str(), &*export.trials[answer.trial].stimulus)
        }));
    }
    let mut found =
        UsedPlays { given: Couplings::default(), clips: Vec::new(), left_out: LeftOut::default() };
    let (mut people, mut clips) = (BTreeMap::new(), BTreeMap::new());
    for play in &tables.plays {
        if !used.contains(&(play.participant.as_str(), play.stimulus.as_str())) {
            found.left_out.excluded += 1;
            continue;
        }
        let key = (play.stimulus.clone(), play.provenance.clone());
        let Some(samples) = tables.clips.get(&key) else {
            found.left_out.unknown_clip += 1;
            continue;
        };
        let given = &mut found.given;
        let clip = *clips.entry(key).or_insert_with(|| {
            given.clips.push(clip_courses(samples));
            found.clips.push(play.stimulus.clone());
            given.clips.len() - 1
        });
        if given.clips[clip].iter().all(Vec::is_empty) {
            found.left_out.moves_nothing += 1;
            continue;
        }
        let person = *people.entry(&play.participant).or_insert_with(|| {
            given.people.push(play.participant.clone());
            given.people.len() - 1
        });
        let instants = instants(samples);
        let course =
            |shape| resampled_course(&play.samples.of(shape), RATE_HZ, instants, LONGEST_GAP_S);
        let track = (0..shapes().count()).map(course).collect();
        given.plays.push(CoupledPlay { person, clip, track });
    }
    found
}

/// Instants of a clip.
fn instants(clip: &Samples) -> usize {
    let last_s = clip.times_s.last().copied().unwrap_or_default();
    (last_s * RATE_HZ + 1e-6).floor().max(0.0) as usize + 1
}

/// A clip's courses: those that move, without gaze and blinks, which everybody has by themselves.
fn clip_courses(clip: &Samples) -> Courses {
    let instants = instants(clip);
    let course = |(shape, name): (usize, &str)| {
        if name.starts_with("eyeLook") || name.starts_with("eyeBlink") {
            return Vec::new();
        }
        let course = resampled_course(&clip.of(shape), RATE_HZ, instants, f64::INFINITY);
        let known: Vec<f64> = course.iter().copied().filter(|own| own.is_finite()).collect();
        let n = known.len() as f64;
        let mean = known.iter().sum::<f64>() / n;
        let variance = known.iter().map(|own| (own - mean).powi(2)).sum::<f64>() / n;
        if variance.sqrt() >= MOVED { course } else { Vec::new() }
    };
    shapes().enumerate().map(course).collect()
}
