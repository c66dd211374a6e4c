//! The combinations of levels that trials have: far fewer than trials.

use std::collections::HashMap;
use std::sync::Arc;

use crate::trials::export::Trial;

/// Which combination of levels each trial has.
#[derive(Debug, Clone, Default)]
pub(crate) struct Combinations {
    /// A trial of each combination: the first that has it.
    pub first: Vec<usize>,
    /// The combination of each trial.
    pub of_trial: Vec<u32>,
}

impl Combinations {
    pub(crate) fn of(trials: &[Trial]) -> Self {
        // Trials of one clip have the same levels, so most of them are found by the clip alone.
        let mut by_clip: HashMap<&str, u32> = HashMap::new();
        let mut by_levels: HashMap<&[Option<Arc<str>>], u32> = HashMap::new();
        let mut found = Self::default();
        for (place, trial) in trials.iter().enumerate() {
            let known = by_clip.get(&*trial.stimulus).copied();
            let same = |&known: &u32| trials[found.first[known as usize]].levels == trial.levels;
            let combination = match known.filter(same) {
                Some(known) => known,
                None => {
                    let combination = *by_levels.entry(&trial.levels).or_insert_with(|| {
                        found.first.push(place);
                        found.first.len() as u32 - 1
                    });
                    by_clip.insert(&trial.stimulus, combination);
                    combination
                }
            };
            found.of_trial.push(combination);
        }
        found
    }
}
