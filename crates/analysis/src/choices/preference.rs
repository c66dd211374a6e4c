//! Which level is preferred, and by how much: the ranking of several levels, or how often one of two is chosen.

use mimique_stats::Outcome;
use serde::Serialize;

use super::tested::ChoiceTests;

/// What choices prefer.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Preference {
    /// Several levels, the most chosen first.
    Ranking(Vec<RankedLevel>),
    /// Two levels, the more chosen first.
    OneOfTwo(ChosenShare),
}

/// A level with its worth.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct RankedLevel {
    pub level: String,
    /// In just noticeable differences from the mean of all levels.
    pub worth_jnd: f64,
    /// At 95 %.
    pub interval: Option<[f64; 2]>,
}

/// How often one of two levels is chosen.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct ChosenShare {
    pub levels: [String; 2],
    /// Of the first, among the choices of one.
    pub share: f64,
    /// At 95 %.
    pub interval: Option<[f64; 2]>,
}

/// What the choices prefer; none where worths have no estimate.
pub(crate) fn preference(found: &ChoiceTests) -> Option<Preference> {
    let Outcome::Ok(estimates) = &found.worths.as_ref()?.estimates else { return None };
    if let [contrast] = estimates.contrasts.as_slice() {
        let is_first = contrast.preferred >= 0.5;
        let own = |share: f64| if is_first { share } else { 1.0 - share };
        let (a, b) = if is_first { (&contrast.a, &contrast.b) } else { (&contrast.b, &contrast.a) };
        let interval = contrast.preferred_interval.map(|ends| {
            let [low, high] = ends.map(own);
            [low.min(high), low.max(high)]
        });
        let levels = [a.clone(), b.clone()];
        return Some(Preference::OneOfTwo(ChosenShare {
            levels,
            share: own(contrast.preferred),
            interval,
        }));
    }
    let mut ranked: Vec<RankedLevel> = (estimates.in_jnd().into_iter().zip(&found.levels))
        .map(|((worth_jnd, interval), level)| RankedLevel {
            level: level.clone(),
            worth_jnd,
            interval,
        })
        .collect();
    ranked.sort_by(|a, b| b.worth_jnd.total_cmp(&a.worth_jnd));
    Some(Preference::Ranking(ranked))
}
