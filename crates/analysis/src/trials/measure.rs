//! A measure of the study: one number a trial, with its person and its factors.

use std::collections::{BTreeMap, BTreeSet};

use mimique_locale::Language;
use mimique_stats::{Blocks, Factor, Numbers};
use mimique_study::columns::ASSIGNED_CONDITION;
use serde::Serialize;

use crate::trials::asked_question::AskedQuestion;
use crate::trials::export::Export;
use crate::trials::matching::Matching;

/// What kind of number a measure is.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum MeasureKind {
    /// A rating or another number.
    Rating,
    /// 1 for a right answer, 0 for a wrong one.
    Recognition,
    /// Seconds.
    ResponseTime,
    /// Which of two clips: no number by itself.
    Choice,
}

/// One number a trial.
#[derive(Debug, Clone)]
pub(crate) struct Measure {
    /// Identifier of the question, `.rt` behind it for its response time.
    pub id: String,
    /// Identifier of the question.
    pub question: String,
    /// What people read.
    pub label: String,
    pub kind: MeasureKind,
    pub scale: Option<(i64, i64)>,
    pub values: Vec<f64>,
    pub person: Vec<usize>,
    pub trial: Vec<usize>,
}

/// Means of the people who have a value.
pub(crate) struct OverallMeans {
    /// Places in [`Export::people`], growing.
    pub people: Vec<usize>,
    /// The mean of each of them.
    pub means: Vec<f64>,
    /// The first value of each of them, its place in the measure.
    pub first_rows: Vec<usize>,
}

/// Means of the people who have a value at each level of a factor.
pub(crate) struct PersonMeans {
    /// Places in [`Export::people`].
    pub people: Vec<usize>,
    /// A mean a level, of each of them.
    pub means: Vec<Vec<f64>>,
    /// People without a value at some level.
    pub incomplete: usize,
}

impl PersonMeans {
    /// As blocks of a test.
    pub(crate) fn blocks(self, export: &Export, factor: &Factor) -> Blocks {
        Blocks {
            groups: factor.levels.clone(),
            blocks: self.people.iter().map(|&person| export.people[person].id.clone()).collect(),
            responses: self.means,
            incomplete: self.incomplete,
            dropped: 0,
        }
    }
}

impl Measure {
    /// Answers to a question as numbers: ratings as they are, right answers as 1. None if the question
    /// gives no numbers.
    pub(crate) fn of_question(
        export: &Export,
        asked: &AskedQuestion<'_>,
        language: Language,
    ) -> Option<Self> {
        let recognition = asked.is_recognition();
        let mut measure = Self {
            id: asked.id.clone(),
            question: asked.id.clone(),
            label: asked.label(language.code()),
            kind: if recognition { MeasureKind::Recognition } else { MeasureKind::Rating },
            scale: asked.scale(),
            values: Vec::new(),
            person: Vec::new(),
            trial: Vec::new(),
        };
        for answer in export.answers_to(&asked.id) {
            let value = if recognition {
                answer.correct.map(|correct| f64::from(u8::from(correct)))
            } else {
                // One answer that is no number makes the question one of words.
                Some(answer.number?)
            };
            if let Some(value) = value {
                measure.values.push(value);
                measure.person.push(answer.person);
                measure.trial.push(answer.trial);
            }
        }
        (!measure.values.is_empty()).then_some(measure)
    }

    /// Response times of a question, seconds.
    pub(crate) fn response_time(
        export: &Export,
        asked: &AskedQuestion<'_>,
        language: Language,
    ) -> Option<Self> {
        let mut measure = Self {
            id: format!("{}.rt", asked.id),
            question: asked.id.clone(),
            label: language.pick("Response time (s)", "Temps de réponse (s)").to_owned(),
            kind: MeasureKind::ResponseTime,
            scale: None,
            values: Vec::new(),
            person: Vec::new(),
            trial: Vec::new(),
        };
        for answer in export.answers_to(&asked.id) {
            if let Some(rt) = answer.rt_ms {
                measure.values.push(rt / 1000.0);
                measure.person.push(answer.person);
                measure.trial.push(answer.trial);
            }
        }
        (!measure.values.is_empty()).then_some(measure)
    }

    /// The values as a column.
    pub(crate) fn numbers(&self) -> Numbers {
        Numbers { name: self.id.clone(), values: self.values.clone() }
    }

    /// A factor of the trials, a code a value; only `levels` if any are given.
    pub(crate) fn factor(&self, export: &Export, name: &str, levels: &[String]) -> Factor {
        let place = export.factors.iter().position(|factor| factor == name);
        let combinations = export.combinations();
        let mut met = vec![Factor::MISSING; combinations.first.len()];
        let mut first: Vec<usize> = Vec::new();
        for &trial in &self.trial {
            let met = &mut met[combinations.of_trial[trial] as usize];
            if *met == Factor::MISSING {
                *met = first.len() as u32;
                first.push(trial);
            }
        }
        let cells = first.iter().map(|&trial| export.trials[trial].levels[place?].as_deref());
        let mut factor = Factor::from_cells(name, cells, |level| level.parse().ok());
        let of_trial = |&trial: &usize| met[combinations.of_trial[trial] as usize] as usize;
        factor.codes = self.trial.iter().map(|trial| factor.codes[of_trial(trial)]).collect();
        let known: Vec<String> =
            levels.iter().filter(|level| factor.levels.contains(level)).cloned().collect();
        if known.is_empty() { factor } else { factor.restricted(&known).unwrap_or(factor) }
    }

    /// An answer about the person, or the assigned condition, a code a value.
    pub(crate) fn trait_factor(&self, export: &Export, name: &str) -> Option<Factor> {
        let (_, cells) = export.about.iter().find(|(column, _)| column == name)?;
        let cells = self.person.iter().map(|&person| cells[person].as_deref());
        // A condition is a name, even one of digits.
        let number = |level: &str| level.parse().ok().filter(|_| name != ASSIGNED_CONDITION);
        Some(Factor::from_cells(name, cells, number))
    }

    /// Mean of each person at each level of a factor over the matched sets that the person has at every level; people
    /// without such a set are incomplete.
    pub(crate) fn person_means(
        &self,
        export: &Export,
        factor: &Factor,
        matching: &Matching,
    ) -> Blocks {
        self.person_means_by_place(factor, matching).blocks(export, factor)
    }

    /// The same, with the people's places in the export.
    pub(crate) fn person_means_by_place(
        &self,
        factor: &Factor,
        matching: &Matching,
    ) -> PersonMeans {
        let k = factor.levels.len();
        let sets = &matching.set_of_row;
        let last = sets.iter().flatten().max().map_or(0, |last| *last as usize + 1);
        let mut sums = Sums::new(last, k);
        let mut person_of_set = vec![0; last];
        for (i, set) in sets.iter().enumerate() {
            if let Some(set) = *set {
                person_of_set[set as usize] = self.person[i];
                sums.add(set as usize, factor.codes[i], self.values[i]);
            }
        }
        // Every set counts the same, however many answers it has at a level.
        let mut of_person: BTreeMap<usize, (Vec<f64>, f64)> = BTreeMap::new();
        for (set, means) in sums.complete() {
            let own = of_person.entry(person_of_set[set]).or_insert_with(|| (vec![0.0; k], 0.0));
            own.1 += 1.0;
            own.0.iter_mut().zip(means).for_each(|(sum, mean)| *sum += mean);
        }
        let people: Vec<usize> = of_person.keys().copied().collect();
        let means = of_person.into_values();
        let means = means.map(|(sums, n)| sums.into_iter().map(|sum| rounded(sum / n)).collect());
        let means: Vec<Vec<f64>> = means.collect();
        let answering: BTreeSet<usize> = self.person.iter().copied().collect();
        PersonMeans { incomplete: answering.len() - people.len(), people, means }
    }

    /// Mean of each person at each combination of factors, over all answers; people without a value at some combination
    /// are incomplete.
    pub(crate) fn cell_means(&self, export: &Export, cells: &Factor) -> Blocks {
        let mut sums = Sums::new(self.people(), cells.levels.len());
        for (i, &value) in self.values.iter().enumerate() {
            sums.add(self.person[i], cells.codes[i], value);
        }
        let (people, means): (Vec<usize>, Vec<Vec<f64>>) = sums.complete().unzip();
        let means = PersonMeans { incomplete: sums.met() - people.len(), people, means };
        means.blocks(export, cells)
    }

    /// Whether no person has several values.
    pub(crate) fn has_one_row_per_person(&self) -> bool {
        let mut seen = vec![false; self.people()];
        self.person.iter().all(|&person| !std::mem::replace(&mut seen[person], true))
    }

    /// One more than the last person's place.
    pub(crate) fn people(&self) -> usize {
        self.person.iter().max().map_or(0, |last| last + 1)
    }

    /// Mean of each person over all trials.
    pub(crate) fn overall_person_means(&self) -> OverallMeans {
        let mut sums = Sums::new(self.people(), 1);
        let mut first_of = vec![usize::MAX; self.people()];
        for (row, (&person, &value)) in self.person.iter().zip(&self.values).enumerate() {
            sums.add(person, 0, value);
            first_of[person] = first_of[person].min(row);
        }
        let (people, means): (Vec<usize>, Vec<Vec<f64>>) = sums.complete().unzip();
        OverallMeans {
            means: means.into_iter().flatten().collect(),
            first_rows: people.iter().map(|&person| first_of[person]).collect(),
            people,
        }
    }

    /// Trials of one person that differ in the tested factor only, as blocks: the pairs of trial-level
    /// tests. What else must be equal is every other factor that occurs at each of its levels.
    pub(crate) fn matched_trials(&self, export: &Export, factor: &Factor) -> Blocks {
        let others = self.crossed_places(export, factor);
        let combinations = export.combinations();
        // The other levels of each combination, and their place in order.
        let key = |&trial: &usize| -> Vec<&str> {
            let levels = &export.trials[trial].levels;
            others.iter().map(|&place| levels[place].as_deref().unwrap_or_default()).collect()
        };
        let of_combination: Vec<Vec<&str>> = combinations.first.iter().map(key).collect();
        let keys: BTreeSet<&Vec<&str>> = of_combination.iter().collect();
        let keys: Vec<&Vec<&str>> = keys.into_iter().collect();
        let places: Vec<usize> =
            of_combination.iter().map(|key| keys.binary_search(&key).unwrap_or_default()).collect();
        let mut sums = Sums::new(self.people() * keys.len(), factor.levels.len());
        for (i, &value) in self.values.iter().enumerate() {
            let key = places[combinations.of_trial[self.trial[i]] as usize];
            sums.add(self.person[i] * keys.len() + key, factor.codes[i], value);
        }
        let (mut blocks, mut responses) = (Vec::new(), Vec::new());
        for (row, means) in sums.complete() {
            let (person, key) = (row / keys.len(), keys[row % keys.len()]);
            blocks.push(format!("{} {}", export.people[person].id, key.join(" ")));
            responses.push(means);
        }
        Blocks {
            groups: factor.levels.clone(),
            incomplete: sums.met() - blocks.len(),
            blocks,
            responses,
            dropped: 0,
        }
    }

    /// The factors that are equal within a pair of matched trials.
    pub(crate) fn matched_factors(&self, export: &Export, factor: &Factor) -> Vec<String> {
        let places = self.crossed_places(export, factor);
        places.into_iter().map(|place| export.factors[place].clone()).collect()
    }

    pub(super) fn crossed_places(&self, export: &Export, factor: &Factor) -> Vec<usize> {
        let combinations = export.combinations();
        // Each combination of levels with each code that it comes with.
        let k = factor.levels.len() + 1;
        let mut met = vec![false; combinations.first.len() * k];
        for (&trial, &code) in self.trial.iter().zip(&factor.codes) {
            // A trial without a level of the factor comes last.
            let code = (code as usize).min(k - 1);
            met[combinations.of_trial[trial] as usize * k + code] = true;
        }
        let met: Vec<(usize, usize)> = met
            .into_iter()
            .enumerate()
            .filter(|(_, met)| *met)
            .map(|(place, _)| (combinations.first[place / k], place % k))
            .collect();
        let is_crossed = |place: &usize| {
            let (mut found, mut levels) = (BTreeSet::new(), BTreeSet::new());
            for &(trial, code) in met.iter().filter(|(_, code)| *code < k - 1) {
                let Some(level) = export.trials[trial].levels[*place].as_deref() else {
                    return false;
                };
                found.insert((code, level));
                levels.insert(level);
            }
            levels.len() * factor.levels.len() == found.len()
        };
        let other = |place: &usize| export.factors[*place] != factor.name;
        (0..export.factors.len()).filter(other).filter(is_crossed).collect()
    }
}

/// Sums and counts in rows of cells; only rows that are met take room.
struct Sums {
    width: usize,
    cells: Vec<(f64, f64)>,
    /// Where the cells of each row begin, in rows; [`ABSENT`] where none was met.
    begins: Vec<u32>,
    met: u32,
}

const ABSENT: u32 = u32::MAX;

impl Sums {
    fn new(rows: usize, width: usize) -> Self {
        Self { width, cells: Vec::new(), begins: vec![ABSENT; rows], met: 0 }
    }

    /// Adds a value; a code that is no cell only says that the row is there.
    fn add(&mut self, row: usize, code: u32, value: f64) {
        if self.begins[row] == ABSENT {
            self.begins[row] = self.met;
            self.met += 1;
            self.cells.resize(self.met as usize * self.width, (0.0, 0.0));
        }
        let begin = self.begins[row] as usize * self.width;
        if let Some(cell) = self.cells[begin..begin + self.width].get_mut(code as usize) {
            cell.0 += value;
            cell.1 += 1.0;
        }
    }

    /// Rows that were met.
    fn met(&self) -> usize {
        self.met as usize
    }

    /// Rows with a value in each cell, and their means.
    fn complete(&self) -> impl Iterator<Item = (usize, Vec<f64>)> {
        let own = |begin: u32| &self.cells[begin as usize * self.width..][..self.width];
        self.begins
            .iter()
            .enumerate()
            .filter(|(_, begin)| **begin != ABSENT)
            .map(move |(row, &begin)| (row, own(begin)))
            .filter(|(_, cells)| cells.iter().all(|(_, count)| *count > 0.0))
            .map(|(row, cells)| (row, cells.iter().map(|(sum, count)| sum / count).collect()))
    }
}

/// A mean of means to ten decimals: ranks must not see the rounding errors of equal means.
fn rounded(mean: f64) -> f64 {
    const SCALE: f64 = 1e10;
    (mean * SCALE).round() / SCALE
}

/// A factor's levels as numbers; if they are words, their places in order.
pub(crate) fn as_numbers(factor: &Factor) -> Numbers {
    let numbers: Option<Vec<f64>> = factor.levels.iter().map(|level| level.parse().ok()).collect();
    let numbers = numbers.unwrap_or_else(|| (1..=factor.levels.len()).map(|i| i as f64).collect());
    let values =
        factor.codes.iter().map(|&code| numbers.get(code as usize).copied().unwrap_or(f64::NAN));
    Numbers { name: factor.name.clone(), values: values.collect() }
}
