//! How the answers are distributed at each level of a factor: whether many are at an end of the scale, and whether
//! participants spread more at one level than at another.

use std::collections::BTreeMap;

use mimique_stats::{Factor, Labelled, moments};
use serde::Serialize;

use crate::trials::measure::{Measure, MeasureKind};

/// A floor or ceiling effect: more than this share of the answers is at one end of the scale (McHorney and Tarlov 1995;
/// Terwee et al. 2007).
const MOST_AT_AN_END: f64 = 0.15;

/// With fewer answers at a level nothing is said of it.
const FEWEST_ANSWERS: usize = 20;

/// Spreads are unequal if the largest standard deviation of participants' means is more than this many times the smallest
/// (a ratio of variances of 4: Howell 2013, chapter 11). Two groups of ten with equal spreads exceed it in 5 % of studies.
const MOST_SPREAD_RATIO: f64 = 2.0;

/// With fewer people at a level its spread is not compared.
const FEWEST_PEOPLE: usize = 10;

/// The distribution of a measure's answers at each level of a factor.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct AnswerDistribution {
    pub factor: String,
    /// Lowest and highest point of the scale; `None` where answers have no scale.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub scale: Option<(i64, i64)>,
    pub levels: Labelled<LevelDistribution>,
}

/// The answers at one level.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct LevelDistribution {
    pub answers: usize,
    /// Share of the answers at the lowest point, from 0 to 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub at_lowest: Option<f64>,
    /// Share of the answers at the highest point, from 0 to 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub at_highest: Option<f64>,
    /// People with an answer.
    pub people: usize,
    /// Standard deviation of their means, in the unit of the answers; `None` of fewer than two people.
    pub sd_of_person_means: Option<f64>,
}

impl AnswerDistribution {
    /// Of all answers that have a level of the factor.
    pub(crate) fn of(measure: &Measure, factor: &Factor) -> Self {
        let scale = measure.scale.filter(|_| measure.kind == MeasureKind::Rating);
        let level = |code: usize| {
            let mut by_person: BTreeMap<usize, (f64, usize)> = BTreeMap::new();
            let (mut answers, mut lowest, mut highest) = (0, 0, 0);
            for (row, value) in measure.values.iter().enumerate() {
                if factor.codes[row] as usize != code {
                    continue;
                }
                answers += 1;
                if let Some((first, last)) = scale {
                    lowest += usize::from(*value <= first as f64);
                    highest += usize::from(*value >= last as f64);
                }
                let own = by_person.entry(measure.person[row]).or_default();
                *own = (own.0 + value, own.1 + 1);
            }
            let means: Vec<f64> = by_person.values().map(|(sum, n)| sum / *n as f64).collect();
            let share = |count: usize| {
                (scale.is_some() && answers > 0).then(|| count as f64 / answers as f64)
            };
            LevelDistribution {
                answers,
                at_lowest: share(lowest),
                at_highest: share(highest),
                people: means.len(),
                sd_of_person_means: moments(&means).1.map(f64::sqrt),
            }
        };
        Self {
            factor: factor.name.clone(),
            scale,
            levels: Labelled::zip(&factor.levels, (0..factor.levels.len()).map(level)),
        }
    }

    /// Levels with a floor effect, each with its share of answers at the lowest point.
    pub(crate) fn floor(&self) -> Vec<(&str, f64)> {
        self.at_an_end(|level| level.at_lowest)
    }

    /// Levels with a ceiling effect, each with its share of answers at the highest point.
    pub(crate) fn ceiling(&self) -> Vec<(&str, f64)> {
        self.at_an_end(|level| level.at_highest)
    }

    fn at_an_end(&self, share: impl Fn(&LevelDistribution) -> Option<f64>) -> Vec<(&str, f64)> {
        let enough = self.levels.iter().filter(|(_, level)| level.answers >= FEWEST_ANSWERS);
        let shares = enough.filter_map(|(name, level)| Some((name, share(level)?)));
        shares.filter(|(_, share)| *share > MOST_AT_AN_END).collect()
    }

    /// The levels with the largest and the smallest standard deviation of participants' means, where these are unequal.
    pub(crate) fn unequal_spreads(&self) -> Option<[(&str, f64); 2]> {
        let enough = self.levels.iter().filter(|(_, level)| level.people >= FEWEST_PEOPLE);
        let spreads: Vec<(&str, f64)> =
            enough.filter_map(|(name, level)| Some((name, level.sd_of_person_means?))).collect();
        let largest = spreads.iter().copied().max_by(|a, b| a.1.total_cmp(&b.1))?;
        let smallest = spreads.iter().copied().min_by(|a, b| a.1.total_cmp(&b.1))?;
        (largest.1 > MOST_SPREAD_RATIO * smallest.1).then_some([largest, smallest])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Answers of `people`, each once at both levels.
    fn measure(low: &[f64], high: &[f64]) -> (Measure, Factor) {
        let people = low.len();
        let measure = Measure {
            id: "q".to_owned(),
            question: "q".to_owned(),
            label: "q".to_owned(),
            kind: MeasureKind::Rating,
            scale: Some((1, 7)),
            values: low.iter().chain(high).copied().collect(),
            person: (0..people).chain(0..people).collect(),
            trial: (0..2 * people).collect(),
        };
        let cells = (0..2 * people).map(|row| Some(if row < people { "a" } else { "b" }));
        (measure, Factor::from_cells("method", cells, |_| None))
    }

    #[test]
    fn a_planted_floor_and_ceiling_are_found_at_their_levels() {
        // 12 of 20 at the lowest point of "a", 4 of 20 at the highest of "b"; 3 of 20 are exactly 15 %.
        let low: Vec<f64> = (0..20).map(|i| if i < 12 { 1.0 } else { 3.0 }).collect();
        let high: Vec<f64> = (0..20).map(|i| [7.0, 1.0, 4.0][(i / 4).min(2)]).collect();
        let high: Vec<f64> =
            high.iter().enumerate().map(|(i, v)| if i == 7 { 4.0 } else { *v }).collect();
        let (measure, factor) = measure(&low, &high);
        let found = AnswerDistribution::of(&measure, &factor);
        assert_eq!(found.floor(), [("a", 0.6)]);
        assert_eq!(found.ceiling(), [("b", 0.2)]);
        assert_eq!(found.levels.get("b").unwrap().at_lowest, Some(0.15));
    }

    #[test]
    fn spreads_are_unequal_beyond_a_ratio_of_two() {
        let around = |spread: f64| -> Vec<f64> {
            (0..12).map(|i| 4.0 + spread * (f64::from(i) - 5.5) / 5.5).collect()
        };
        let of = |a: f64, b: f64| {
            let (measure, factor) = measure(&around(a), &around(b));
            AnswerDistribution::of(&measure, &factor)
        };
        assert_eq!(of(0.6, 1.1).unequal_spreads(), None);
        let unequal = of(0.5, 1.3);
        let [largest, smallest] = unequal.unequal_spreads().unwrap();
        assert_eq!([largest.0, smallest.0], ["b", "a"]);
        assert!((largest.1 / smallest.1 - 2.6).abs() < 1e-9);
        let few = measure(&[1.0, 7.0, 4.0], &[4.0, 4.0, 4.0]);
        assert_eq!(AnswerDistribution::of(&few.0, &few.1).unequal_spreads(), None);
    }
}
