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
    /// twice, and a trial whose rows differ in answer or intensity; a trial without an answer is left out.
    pub fn of(
        [participant, trial, answer, unit]: [&Factor; 4],
        courses: [&Numbers; 4],
        bends: Option<[&Numbers; 2]>,
        intensity: Option<&Numbers>,
    ) -> Result<Self, Refusal> {
        let complete = complete_rows(&[], &[participant, trial, answer])?;
        let rows = complete.to_vec();
        let [people, numbers_of_trials, answers, units] =
            [participant, trial, answer, unit].map(|factor| factor.rows(&rows));
        half_answered(participant, trial, answer)?;
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
            let high = amplitude > 0.0 && amplitude <= 1.0 && offset_s.is_finite();
            let named = units.codes[at] != Factor::MISSING;
            if !(named && ascending && high && inside(bend(0)) && inside(bend(1))) {
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

/// Refuses a trial that has an answer in some of its rows and none in others.
fn half_answered(participant: &Factor, trial: &Factor, answer: &Factor) -> Result<(), Refusal> {
    let mut known: BTreeMap<(u32, u32), bool> = BTreeMap::new();
    for ((&person, &number), &said) in participant.codes.iter().zip(&trial.codes).zip(&answer.codes)
    {
        if person == Factor::MISSING || number == Factor::MISSING {
            continue;
        }
        let said = said != Factor::MISSING;
        if *known.entry((person, number)).or_insert(said) != said {
            let participant = participant.levels[person as usize].clone();
            let trial = trial.levels[number as usize].clone();
            return Err(Unfit::TwoAnswersToTrial { participant, trial }.into());
        }
    }
    Ok(())
}
