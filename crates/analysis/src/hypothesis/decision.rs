//! What a hypothesis comes to: whether something was shown after the correction over all hypotheses, and how large it
//! is.

use mimique_stats::{EquivalenceVerdict, normal_quantile_upper, t_quantile_upper};
use mimique_study::TestName;
use serde::Serialize;

use crate::choices::preference::Preference;
use crate::hypothesis::is_two_way;
use crate::hypothesis::other_clips::{DecidingTest, LinearClipModel, OtherClips};
use crate::hypothesis::reading::LEVEL;
use crate::hypothesis::{ClipScope, HypothesisResult};
use crate::trials::measure::MeasureKind;

/// More pairs of levels than this have no place in a row.
const MOST_PAIRS: usize = 3;

/// What is shown or not.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Sought {
    /// That levels differ.
    Difference,
    /// That the effect of one factor depends on another.
    Interaction,
    /// That one number goes with another.
    Relation,
}

/// What the deciding test says, after the correction over all hypotheses of the study.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Decision {
    /// It was shown.
    Shown(Sought),
    /// It was not shown, which is no proof that it is not so.
    NotShown(Sought),
    /// Of a test of equivalence.
    Equivalence(EquivalenceVerdict),
    /// No test decides.
    NotTested,
    /// Nothing can be said of other clips.
    NotForOtherClips,
}

/// In which unit an effect is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum EffectUnit {
    /// Points of a scale.
    Points,
    /// Shares of right answers.
    Shares,
    /// Seconds.
    Seconds,
    /// Shares of choices between two levels.
    Chosen,
    /// Shares of choices between a level and the average of the others.
    ChosenOverOthers,
    /// Just noticeable differences from the mean of all levels.
    Worth,
}

impl EffectUnit {
    /// How far a value lies from no difference, on the scale on which intervals are drawn.
    pub(crate) fn drawn(self, value: f64) -> f64 {
        match self {
            Self::Chosen | Self::ChosenOverOthers => value - 0.5,
            Self::Points | Self::Shares | Self::Seconds | Self::Worth => value,
        }
    }
}

/// What an effect is of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum EffectOf<'r> {
    /// The first less the second; of choices, the first against the second.
    Difference([&'r str; 2]),
    /// One level against the mean of all.
    Level(&'r str),
}

/// The difference between two levels, or the worth of one, with its interval.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Effect<'r> {
    pub of: EffectOf<'r>,
    pub estimate: f64,
    pub interval: [f64; 2],
    /// Percent that the interval covers.
    pub covers: u8,
    pub unit: EffectUnit,
    /// Differences of less than this do not matter.
    pub smallest: Option<f64>,
}

/// What a hypothesis comes to.
pub(crate) fn decision(result: &HypothesisResult) -> Decision {
    let Some(p) = result.p_holm_over_hypotheses.or(result.p) else {
        return match result.scope {
            ClipScope::Others => Decision::NotForOtherClips,
            _ => Decision::NotTested,
        };
    };
    decision_by(result, p, p_difference(result))
}

/// The decision of a hypothesis by another p, and by another p of any difference where equivalence is tested.
pub(crate) fn decision_by(
    result: &HypothesisResult,
    p: f64,
    p_difference: Option<f64>,
) -> Decision {
    if result.equivalence.is_some() {
        let p_difference = p_difference.unwrap_or(1.0);
        return Decision::Equivalence(EquivalenceVerdict::of(p, p_difference, LEVEL));
    }
    let sought = match result.test {
        test if is_two_way(test) => Sought::Interaction,
        TestName::Spearman => Sought::Relation,
        _ => Sought::Difference,
    };
    if p < LEVEL { Decision::Shown(sought) } else { Decision::NotShown(sought) }
}

/// p of any difference of a hypothesis of equivalence, corrected where several hypotheses are tested.
fn p_difference(result: &HypothesisResult) -> Option<f64> {
    result.p_difference_holm_over_hypotheses.or(result.p_difference())
}

/// What a p next to a decision is a p of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Supports {
    /// The only test of the hypothesis.
    TheDecision,
    /// That levels are equivalent.
    Equivalence,
    /// That levels differ.
    Difference,
}

/// The p values on which a decision rests, after the correction over all hypotheses: of "equivalent" that of equivalence,
/// of "different" that of the difference, of a small difference and of no decision both.
pub(crate) fn deciding_p_values(result: &HypothesisResult) -> Vec<(Supports, f64)> {
    let Some(p) = result.p_holm_over_hypotheses.or(result.p) else { return Vec::new() };
    let equivalence = Some((Supports::Equivalence, p));
    let difference = p_difference(result).map(|p| (Supports::Difference, p));
    match decision(result) {
        Decision::Equivalence(EquivalenceVerdict::Equivalent) => equivalence.into_iter().collect(),
        Decision::Equivalence(EquivalenceVerdict::Different) => difference.into_iter().collect(),
        Decision::Equivalence(_) => equivalence.into_iter().chain(difference).collect(),
        _ => vec![(Supports::TheDecision, p)],
    }
}

/// The unit of differences of a measure.
pub(crate) fn unit_of(kind: MeasureKind) -> EffectUnit {
    match kind {
        MeasureKind::Rating | MeasureKind::Choice => EffectUnit::Points,
        MeasureKind::Recognition => EffectUnit::Shares,
        MeasureKind::ResponseTime => EffectUnit::Seconds,
    }
}

/// The differences that a row has room for: those of few pairs, by the test that decides.
pub(crate) fn effects(result: &HypothesisResult) -> Vec<Effect<'_>> {
    let unit = unit_of(result.kind);
    if let Some(found) = &result.equivalence {
        let [a, b] = &found.levels;
        let effect = found.difference(result.scope).map(|own| Effect {
            of: EffectOf::Difference([a, b]),
            estimate: own.estimate,
            interval: own.interval_90,
            covers: 90,
            unit,
            smallest: Some(found.smallest_effect),
        });
        return effect.into_iter().collect();
    }
    let decides = result.other_clips.as_ref().filter(|found| found.decides);
    if let Some(found) = decides {
        let Some(DecidingTest::LinearModel(model)) = found.deciding_test() else {
            return Vec::new();
        };
        if result.kind == MeasureKind::Choice {
            return of_chosen(model);
        }
        let few = model.pairs.iter().filter(|_| model.pairs.len() <= MOST_PAIRS);
        return few
            .map(|pair| Effect {
                of: EffectOf::Difference([&pair.a, &pair.b]),
                estimate: pair.difference,
                interval: pair.interval_95,
                covers: 95,
                unit,
                smallest: None,
            })
            .collect();
    }
    if let Some(preferred) = &result.preference {
        return of_choices(preferred);
    }
    let pairs = &result.recommended.pairs;
    let few = pairs.iter().filter(|_| pairs.len() <= MOST_PAIRS);
    few.filter_map(|pair| {
        let found = pair.difference?;
        Some(Effect {
            of: EffectOf::Difference([&pair.a, &pair.b]),
            estimate: found.estimate,
            interval: [found.ci_low, found.ci_high],
            covers: 95,
            unit,
            smallest: None,
        })
    })
    .collect()
}

/// The difference between two levels that the deciding test detects at a level `alpha` with a power, from the standard error
/// of the answers' differences: that times t's quantiles for both, on average over the pairs of levels, before Holm's
/// correction over them. None where the test compares no two levels.
pub(crate) fn detected(
    result: &HypothesisResult,
    alpha: f64,
    power: f64,
) -> Option<(f64, EffectUnit)> {
    if result.equivalence.is_some() || is_two_way(result.test) {
        return None;
    }
    let unit = match result.kind {
        MeasureKind::Rating => EffectUnit::Points,
        MeasureKind::Choice => EffectUnit::Chosen,
        MeasureKind::Recognition => EffectUnit::Shares,
        MeasureKind::ResponseTime => EffectUnit::Seconds,
    };
    let quantiles = |df: f64| t_quantile_upper(alpha / 2.0, df) + t_quantile_upper(1.0 - power, df);
    let decides = result.other_clips.as_ref().filter(|found| found.decides);
    let all: Vec<f64> = match (decides.map(OtherClips::deciding_test), &result.preference) {
        (Some(Some(DecidingTest::LinearModel(model))), _) => {
            model.pairs.iter().map(|pair| pair.se * quantiles(pair.df)).collect()
        }
        (Some(_), _) => Vec::new(),
        (None, preference) => {
            let of_choices = match preference {
                Some(Preference::OneOfTwo(own)) => own.interval,
                _ => None,
            };
            let of_pairs = result.recommended.pairs.iter().filter_map(|pair| {
                let own = pair.difference?;
                Some([own.ci_low, own.ci_high])
            });
            let se = |[low, high]: [f64; 2]| (high - low) / 2.0 / normal_quantile_upper(0.025);
            let quantiles = normal_quantile_upper(alpha / 2.0) + normal_quantile_upper(1.0 - power);
            of_choices.into_iter().chain(of_pairs).map(|ends| se(ends) * quantiles).collect()
        }
    };
    let mean = all.iter().sum::<f64>() / all.len() as f64;
    mean.is_finite().then_some((mean, unit))
}

/// By the linear model of choices: how often each level is chosen over the others, the most chosen first, or how often the
/// more chosen of two levels is.
fn of_chosen(model: &LinearClipModel) -> Vec<Effect<'_>> {
    if let [pair] = model.pairs.as_slice() {
        let [low, high] = pair.interval_95;
        let (of, estimate, interval) = match pair.difference >= 0.0 {
            true => ([&*pair.a, &*pair.b], pair.difference, [low, high]),
            false => ([&*pair.b, &*pair.a], -pair.difference, [-high, -low]),
        };
        return vec![Effect {
            of: EffectOf::Difference(of),
            estimate: 0.5 + estimate,
            interval: interval.map(|end| 0.5 + end),
            covers: 95,
            unit: EffectUnit::Chosen,
            smallest: None,
        }];
    }
    let mut effects: Vec<Effect<'_>> = (model.means.iter())
        .map(|(level, own)| Effect {
            of: EffectOf::Level(level),
            estimate: own.mean,
            interval: own.interval_95,
            covers: 95,
            unit: EffectUnit::ChosenOverOthers,
            smallest: None,
        })
        .collect();
    effects.sort_by(|a, b| b.estimate.total_cmp(&a.estimate));
    effects
}

/// The ranking, or how often the more chosen of two levels is chosen.
fn of_choices(preferred: &Preference) -> Vec<Effect<'_>> {
    let effect = |of, estimate, interval: Option<[f64; 2]>, unit| {
        Some(Effect { of, estimate, interval: interval?, covers: 95, unit, smallest: None })
    };
    match preferred {
        Preference::Ranking(levels) => (levels.iter())
            .filter_map(|own| {
                let of = EffectOf::Level(&own.level);
                effect(of, own.worth_jnd, own.interval, EffectUnit::Worth)
            })
            .collect(),
        Preference::OneOfTwo(own) => {
            let [a, b] = &own.levels;
            let of = EffectOf::Difference([a, b]);
            effect(of, own.share, own.interval, EffectUnit::Chosen).into_iter().collect()
        }
    }
}
