//! Trials of dynamic reverse correlation: which courses were shown, and what was answered.

use std::collections::BTreeMap;

use mimique_adaptive::Trajectory;

use crate::refusal::{Refusal, Unfit};
use crate::table::Numbers;
use crate::table::factor::Factor;
use crate::table::sample::complete_rows;

/// One trial.
#[derive(Debug, Clone, PartialEq)]
pub struct ReverseTrial {
    /// Place among the people.
    pub person: usize,
    /// Place among the categories.
    pub answer: usize,
    /// How intense it was said to be.
    pub intensity: Option<f64>,
    /// What was shown, each unit once at most: `unit` is its place among the units.
    pub courses: Vec<Trajectory>,
}

/// The trials of a study.
#[derive(Debug, Clone, PartialEq)]
pub struct ReverseTrials {
    /// The people.
    pub people: Vec<String>,
    /// What was answered.
    pub categories: Vec<String>,
    /// The action units.
    pub units: Vec<String>,
    /// The trials.
    pub trials: Vec<ReverseTrial>,
    /// Rows left out because of missing values.
    pub dropped: usize,
    /// What the answers are called in the data.
    pub answer_column: String,
}

impl ReverseTrials {
    /// From a row per trial and unit that it shows. `labels` are the people, their trials, the answers and the units;
    /// `courses` are onset, peak and offset in seconds, and amplitude. Without `bends`, the shares of rise and fall at
    /// which half of the height is passed, both are one half. Refuses courses that are none, a unit that a trial shows
    /// twice, and a trial with two answers.
    pub fn of(
        [participant, trial, answer, unit]: [&Factor; 4],
        courses: [&Numbers; 4],
        bends: Option<[&Numbers; 2]>,
        intensity: Option<&Numbers>,
    ) -> Result<Self, Refusal> {
        let mut numbers = courses.to_vec();
        numbers.extend(bends.into_iter().flatten());
        let complete = complete_rows(&numbers, &[participant, trial, answer, unit])?;
        let rows = complete.to_vec();
        let [people, numbers_of_trials, answers, units] =
            [participant, trial, answer, unit].map(|factor| factor.rows(&rows));
        let mut trials: BTreeMap<(u32, u32), ReverseTrial> = BTreeMap::new();
        for (at, &row) in rows.iter().enumerate() {
            let [onset_s, peak_s, offset_s, amplitude] = courses.map(|column| column.values[row]);
            let bend = |which: usize| bends.map_or(0.5, |columns| columns[which].values[row]);
            let course = Trajectory {
                unit: units.codes[at] as usize,
                onset_s,
                peak_s,
                offset_s,
                amplitude,
                acceleration: bend(0),
                deceleration: bend(1),
            };
            let ascending = 0.0 <= onset_s && onset_s < peak_s && peak_s < offset_s;
            let inside = |share: f64| share > 0.0 && share < 1.0;
            let high = amplitude > 0.0 && amplitude <= 1.0;
            if !(ascending && high && inside(bend(0)) && inside(bend(1))) {
                return Err(Unfit::NoCourse { row: row + 1 }.into());
            }
            let key = (people.codes[at], numbers_of_trials.codes[at]);
            let said = answers.codes[at] as usize;
            let intensity = intensity.map(|c| c.values[row]).filter(|value| value.is_finite());
            let own = trials.entry(key).or_insert_with(|| ReverseTrial {
                person: key.0 as usize,
                answer: said,
                intensity,
                courses: Vec::new(),
            });
            let name =
                || [&people, &numbers_of_trials].map(|f| f.levels[f.codes[at] as usize].clone());
            if own.answer != said || own.intensity != intensity {
                let [participant, trial] = name();
                return Err(Unfit::TwoAnswersToTrial { participant, trial }.into());
            }
            if own.courses.iter().any(|known| known.unit == course.unit) {
                let ([participant, trial], unit) = (name(), units.levels[course.unit].clone());
                return Err(Unfit::UnitTwice { participant, trial, unit }.into());
            }
            own.courses.push(course);
        }
        Ok(Self {
            people: people.levels,
            categories: answers.levels,
            units: units.levels,
            trials: trials.into_values().collect(),
            dropped: complete.dropped(),
            answer_column: answer.name.clone(),
        })
    }

    /// The latest offset, seconds.
    pub fn latest_offset_s(&self) -> f64 {
        let courses = self.trials.iter().flat_map(|trial| &trial.courses);
        courses.fold(0.0, |latest, course| course.offset_s.max(latest))
    }

    pub(super) fn require_two_categories(&self) -> Result<(), Refusal> {
        let answered = |place: &usize| self.trials.iter().any(|trial| trial.answer == *place);
        let answered = (0..self.categories.len()).filter(answered);
        let levels: Vec<String> = answered.map(|place| self.categories[place].clone()).collect();
        if levels.len() >= 2 {
            return Ok(());
        }
        let (column, rows) = (self.answer_column.clone(), self.trials.len());
        Err(Refusal::TooFewLevels { column, levels, rows, needed: 2 })
    }
}
