//! Latent values: what clips, people and effects add up to before noise and thresholds.

use std::collections::BTreeMap;

use mimique_study::{Answers, Clip};

use super::parameters::{ByLevel, Interaction, Rating, Recognition};
use super::random::Draws;

/// A latent value, without noise: the parts that are the same in every simulation.
#[derive(Debug, Clone)]
pub(crate) struct Latent {
    /// Names its streams.
    response: String,
    /// A clip each: mean and effects of the clip's factors.
    base: Vec<f64>,
    person_sd: f64,
    segment_sd: f64,
    clip_sd: f64,
    /// Standard deviation and level of each clip, a factor each.
    by: Vec<(f64, Vec<Option<usize>>, usize)>,
    /// Answers about the participant, and the assigned condition, that shift the value: question,
    /// answer -> shift.
    traits: Vec<(String, ByLevel)>,
    /// Shifts that depend on the participant too: what must be answered, for which clips, by how much.
    combined: Vec<(BTreeMap<String, String>, Vec<bool>, f64)>,
}

/// What clips add in one simulated study, by latent value and clip.
pub(crate) type ClipEffects = Vec<Vec<f64>>;

/// The parts that ratings and recognition share.
pub(crate) struct Spread<'p> {
    pub mean: f64,
    pub person_sd: f64,
    pub person_by_sd: &'p ByLevel,
    pub segment_sd: f64,
    pub clip_sd: f64,
    pub effects: &'p BTreeMap<String, ByLevel>,
    pub interactions: &'p [Interaction],
}

/// No level and no factor.
static NO_LEVELS: ByLevel = BTreeMap::new();
static NO_EFFECTS: BTreeMap<String, ByLevel> = BTreeMap::new();

impl Spread<'_> {
    /// Nothing that differs.
    pub(crate) fn none() -> Self {
        Self {
            mean: 0.0,
            person_sd: 0.0,
            person_by_sd: &NO_LEVELS,
            segment_sd: 0.0,
            clip_sd: 0.0,
            effects: &NO_EFFECTS,
            interactions: &[],
        }
    }
}

impl<'p> From<&'p Rating> for Spread<'p> {
    fn from(rating: &'p Rating) -> Self {
        Self {
            mean: rating.mean,
            person_sd: rating.person_sd,
            person_by_sd: &rating.person_by_sd,
            segment_sd: rating.segment_sd,
            clip_sd: rating.clip_sd,
            effects: &rating.effects,
            interactions: &rating.interactions,
        }
    }
}

impl<'p> From<&'p Recognition> for Spread<'p> {
    fn from(recognition: &'p Recognition) -> Self {
        Self {
            mean: 0.0,
            person_sd: recognition.person_sd,
            person_by_sd: &recognition.person_by_sd,
            segment_sd: recognition.segment_sd,
            clip_sd: recognition.clip_sd,
            effects: &recognition.effects,
            interactions: &recognition.interactions,
        }
    }
}

/// The level of each clip as a number, and how many levels there are.
fn codes_by_level(clips: &[Clip], factor: &str) -> (Vec<Option<usize>>, usize) {
    let mut names: Vec<String> = Vec::new();
    let codes = clips
        .iter()
        .map(|clip| {
            let name = clip.factor_text(factor)?;
            Some(names.iter().position(|known| *known == name).unwrap_or_else(|| {
                names.push(name);
                names.len() - 1
            }))
        })
        .collect();
    (codes, names.len())
}

impl Latent {
    /// `segments` is the segment of each clip. `is_trait` tells questions about the participant from
    /// factors of clips.
    pub(crate) fn new(
        response: &str,
        spread: &Spread<'_>,
        clips: &[Clip],
        is_trait: impl Fn(&str) -> bool,
    ) -> Self {
        let level = |clip: &Clip, factor: &str| clip.factor_text(factor);
        let mut base: Vec<f64> = vec![spread.mean; clips.len()];
        let mut traits = Vec::new();
        for (factor, shifts) in spread.effects {
            if is_trait(factor) {
                traits.push((factor.clone(), shifts.clone()));
                continue;
            }
            for (value, clip) in base.iter_mut().zip(clips) {
                *value += level(clip, factor).and_then(|l| shifts.get(&l)).copied().unwrap_or(0.0);
            }
        }
        let mut combined = Vec::new();
        for interaction in spread.interactions {
            let (of_people, of_clips): (BTreeMap<_, _>, BTreeMap<_, _>) =
                interaction.levels.clone().into_iter().partition(|(factor, _)| is_trait(factor));
            let here: Vec<bool> = clips
                .iter()
                .map(|clip| {
                    of_clips.iter().all(|(f, wanted)| level(clip, f).as_ref() == Some(wanted))
                })
                .collect();
            if of_people.is_empty() {
                for (value, here) in base.iter_mut().zip(&here) {
                    *value += if *here { interaction.shift } else { 0.0 };
                }
            } else {
                combined.push((of_people, here, interaction.shift));
            }
        }
        let by = spread
            .person_by_sd
            .iter()
            .filter(|(_, sd)| **sd > 0.0)
            .map(|(factor, sd)| {
                let (codes, count) = codes_by_level(clips, factor);
                (*sd, codes, count)
            })
            .collect();
        Self {
            response: response.to_owned(),
            base,
            person_sd: spread.person_sd,
            segment_sd: spread.segment_sd,
            clip_sd: spread.clip_sd,
            by,
            traits,
            combined,
        }
    }

    /// Standard deviation of everything random but the noise.
    pub(crate) fn spread_sd(&self) -> f64 {
        let by: f64 = self.by.iter().map(|(sd, ..)| sd * sd).sum();
        (self.person_sd.powi(2) + self.segment_sd.powi(2) + self.clip_sd.powi(2) + by).sqrt()
    }

    /// What each clip adds in the study of this seed; `segments` is the segment of each clip.
    pub(crate) fn clip_effects(&self, seed: u64, segments: &[usize]) -> Vec<f64> {
        if self.segment_sd == 0.0 && self.clip_sd == 0.0 {
            return vec![0.0; segments.len()];
        }
        let mut draws = Draws::new(seed, None, &format!("clips of {}", self.response));
        let count = segments.iter().max().map_or(0, |last| last + 1);
        let of_segments: Vec<f64> = (0..count).map(|_| self.segment_sd * draws.normal()).collect();
        segments
            .iter()
            .map(|&segment| of_segments[segment] + self.clip_sd * draws.normal())
            .collect()
    }

    /// The value of one person at each clip; `about` has the answers about the participant and the
    /// assigned condition.
    pub(crate) fn of_person(&self, draws: &mut Draws, clips: &[f64], about: &Answers) -> Vec<f64> {
        let told = |question: &str| told(about, question);
        let mut person = self.person_sd * draws.normal();
        for (question, shifts) in &self.traits {
            person += told(question).and_then(|a| shifts.get(&a)).copied().unwrap_or(0.0);
        }
        let mut values: Vec<f64> =
            self.base.iter().zip(clips).map(|(base, clip)| base + clip + person).collect();
        for (sd, codes, levels) in &self.by {
            let taste: Vec<f64> = (0..*levels).map(|_| sd * draws.normal()).collect();
            for (value, code) in values.iter_mut().zip(codes) {
                *value += code.map_or(0.0, |code| taste[code]);
            }
        }
        for (wanted, here, shift) in &self.combined {
            if wanted.iter().all(|(question, answer)| told(question).as_ref() == Some(answer)) {
                for (value, here) in values.iter_mut().zip(here) {
                    *value += if *here { *shift } else { 0.0 };
                }
            }
        }
        values
    }
}

/// What is told of a participant, as the export has it.
pub(super) fn told(about: &Answers, question: &str) -> Option<String> {
    let answer = about.get(question)?;
    Some(answer.as_str().map_or_else(|| answer.to_string(), str::to_owned))
}
