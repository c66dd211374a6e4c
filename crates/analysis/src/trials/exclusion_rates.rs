//! Whether the rules exclude more trials at one level of a factor than at another.
//!
//! The unit is the participant: the share of that participant's trials that was excluded at each level, compared by an
//! exact paired Wilcoxon test of two levels or by Friedman's test of more; between conditions, the share of all trials by
//! Kruskal and Wallis' test.

use mimique_stats::{
    Adjustment, Blocks, Factor, Friedman, Labelled, Numbers, Outcome, WilcoxonOptions, friedman,
    kruskal_wallis, wilcoxon,
};
use mimique_study::columns::ASSIGNED_CONDITION;
use serde::Serialize;

use crate::trials::export::{Export, Trial};

/// How many trials are excluded at each level of a factor of the clips, or in each assigned condition.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct ExclusionRates {
    pub factor: String,
    /// Excluded trials and all trials of each level.
    pub counts: Labelled<[usize; 2]>,
    /// Participants who have trials at every level; between conditions, all.
    pub people: usize,
    /// Whether the levels are those of different participants.
    pub between_people: bool,
    /// Of the test that the rates are equal; `None` where it is not defined.
    pub p: Option<f64>,
    /// After Holm's correction over the factors that are looked at.
    pub p_holm: Option<f64>,
}

/// The rates by some factors; factors with fewer than two levels are left out, and so is everything if no trial is
/// excluded.
pub(crate) fn by_factors(export: &Export, factors: &[&str]) -> Vec<ExclusionRates> {
    if export.excluded_trials.is_empty() {
        return Vec::new();
    }
    let mut person = vec![usize::MAX; export.trials.len()];
    for answer in export.all_answers().flatten() {
        person[answer.trial] = answer.person;
    }
    let used = person.into_iter().zip(&export.trials).filter(|(person, _)| *person != usize::MAX);
    let used = used.map(|(person, trial)| (person, trial, false));
    let excluded = export.excluded_trials.iter().map(|own| (own.person, &own.trial, true));
    let trials: Vec<(usize, &Trial, bool)> = used.chain(excluded).collect();
    let rates = factors.iter().filter_map(|factor| match *factor {
        ASSIGNED_CONDITION => by_condition(export, &trials),
        factor => by_factor(export, factor, &trials),
    });
    let mut rates: Vec<ExclusionRates> = rates.collect();
    let p: Vec<Option<f64>> = rates.iter().map(|own| own.p).collect();
    for (own, p_holm) in rates.iter_mut().zip(Adjustment::Holm.apply(&p)) {
        own.p_holm = p_holm;
    }
    rates
}

fn by_factor(
    export: &Export,
    factor: &str,
    trials: &[(usize, &Trial, bool)],
) -> Option<ExclusionRates> {
    let place = export.factors.iter().position(|name| name == factor)?;
    let level = |trial: &Trial| trial.levels[place].clone();
    let mut levels: Vec<String> =
        trials.iter().filter_map(|(_, trial, _)| Some(level(trial)?.to_string())).collect();
    levels.sort_unstable();
    levels.dedup();
    if levels.len() < 2 {
        return None;
    }
    let mut counts = vec![[0_usize; 2]; levels.len()];
    let mut of_people = vec![vec![[0_usize; 2]; levels.len()]; export.people.len()];
    for (person, trial, excluded) in trials {
        let Some(level) = level(trial) else { continue };
        let Ok(code) = levels.binary_search_by(|own| own.as_str().cmp(&level)) else { continue };
        for own in [&mut counts[code], &mut of_people[*person][code]] {
            own[0] += usize::from(*excluded);
            own[1] += 1;
        }
    }
    let complete =
        of_people.into_iter().enumerate().filter(|(_, own)| own.iter().all(|it| it[1] > 0));
    let share = |[excluded, all]: &[usize; 2]| *excluded as f64 / *all as f64;
    let (blocks, responses): (Vec<String>, Vec<Vec<f64>>) = complete
        .map(|(person, own)| (export.people[person].id.clone(), own.iter().map(share).collect()))
        .unzip();
    let people = blocks.len();
    let blocks = Blocks { groups: levels.clone(), blocks, responses, incomplete: 0, dropped: 0 };
    let p = if levels.len() == 2 {
        match wilcoxon(&blocks.differences(0, 1), WilcoxonOptions::default()) {
            Ok(Outcome::Ok(found)) => Some(found.p_value),
            _ => None,
        }
    } else {
        // Iman and Davenport's F does not exist where all participants agree.
        let p = |found: Friedman| found.iman_davenport.map_or(found.p_value, |f| f.p_value);
        friedman(&blocks).ok().map(p)
    };
    Some(ExclusionRates {
        factor: factor.to_owned(),
        counts: Labelled::zip(&levels, counts),
        people,
        between_people: false,
        p,
        p_holm: None,
    })
}

fn by_condition(export: &Export, trials: &[(usize, &Trial, bool)]) -> Option<ExclusionRates> {
    let (_, conditions) = export.about.iter().find(|(name, _)| name == ASSIGNED_CONDITION)?;
    let mut of_people = vec![[0_usize; 2]; export.people.len()];
    for (person, _, excluded) in trials {
        of_people[*person][0] += usize::from(*excluded);
        of_people[*person][1] += 1;
    }
    let people = of_people.iter().zip(conditions).filter(|([_, all], _)| *all > 0);
    let people: Vec<([usize; 2], Option<&str>)> =
        people.map(|(own, condition)| (*own, condition.as_deref())).collect();
    let condition =
        Factor::from_cells(ASSIGNED_CONDITION, people.iter().map(|(_, own)| *own), |_| None);
    if condition.levels.len() < 2 {
        return None;
    }
    let mut counts = vec![[0_usize; 2]; condition.levels.len()];
    for (&([excluded, all], _), &code) in people.iter().zip(&condition.codes) {
        if let Some(own) = counts.get_mut(code as usize) {
            own[0] += excluded;
            own[1] += all;
        }
    }
    let share = |([excluded, all], _): &([usize; 2], Option<&str>)| *excluded as f64 / *all as f64;
    let rates = Numbers { name: "excluded".to_owned(), values: people.iter().map(share).collect() };
    let p = match kruskal_wallis(&rates, &condition) {
        Ok(Outcome::Ok(found)) => Some(found.p_value),
        _ => None,
    };
    Some(ExclusionRates {
        factor: ASSIGNED_CONDITION.to_owned(),
        counts: Labelled::zip(&condition.levels, counts),
        people: people.len(),
        between_people: true,
        p,
        p_holm: None,
    })
}
