//! How far people agree: Krippendorff's alpha of the choices between the same two clips.

use std::collections::BTreeMap;

use mimique_stats::{Chosen, Factor, MeasurementLevel, Outcome, UnitValues, krippendorff};
use serde::Serialize;

use super::RankOptions;
use crate::votes::Vote;

/// How far people agree.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct Agreement {
    /// Krippendorff's alpha, nominal: 1 where all choose alike, 0 as by chance.
    pub alpha: f64,
    /// Its interval at 95 %, over resampled pairs of clips.
    pub interval: Option<[f64; 2]>,
    /// Pairs of clips that two people or more chose between.
    pub pairs: usize,
}

/// The agreement; none where it is not defined.
pub(super) fn agreement(votes: &[&Vote], options: &RankOptions) -> Option<Agreement> {
    // A person may be shown the same clips twice; the first choice counts.
    let mut first: BTreeMap<(&str, String), &str> = BTreeMap::new();
    for vote in votes {
        let mut pair = [vote.left.as_str(), vote.right.as_str()];
        pair.sort_unstable();
        let chosen = match vote.chosen {
            Chosen::Left => &vote.left,
            Chosen::Right => &vote.right,
            Chosen::Same => "=",
        };
        let unit = format!("{} {} {}", vote.take, pair[0], pair[1]);
        first.entry((&vote.session, unit)).or_insert(chosen);
    }
    let factor = |name: &str, cells: Vec<&str>| {
        Factor::from_cells(name, cells.into_iter().map(Some), |_| None)
    };
    let unit = factor("pair", first.keys().map(|(_, unit)| unit.as_str()).collect());
    let rater = factor("person", first.keys().map(|(session, _)| *session).collect());
    let value = factor("chosen", first.values().copied().collect());
    let values = UnitValues::of(&unit, &rater, &value).ok()?;
    let levels = [MeasurementLevel::Nominal];
    let found = krippendorff(&values, &levels, options.rounds, options.seed).ok()?;
    let pairs = found.units_with_two_or_more;
    match found.levels.0.into_iter().next()?.1 {
        Outcome::Ok(own) => Some(Agreement { alpha: own.alpha, interval: own.interval, pairs }),
        Outcome::Undefined { .. } => None,
    }
}
