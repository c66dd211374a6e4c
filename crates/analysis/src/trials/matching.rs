//! Which answers are compared within participants: for each of them, those of the segments that remain at every level.
//!
//! Levels differ in more than the factor once trials are excluded: where a rule removes the clip of an intense emotion at
//! one level only, the means of what is left differ even if ratings follow the emotion alone. An answer is therefore
//! compared only if the same participant has an answer to the same segment at every other level. Where no segment is
//! shown at several levels (the expression is a property of the segment), the answers are matched on the other factors of
//! the clips instead.

use std::collections::{BTreeSet, HashMap};

use mimique_stats::Factor;
use serde::Serialize;

use crate::trials::export::{Export, Trial};
use crate::trials::measure::Measure;

/// Name of the segment among the columns that are matched on.
const SEGMENT: &str = "segment";

/// Answers of one participant that differ in the compared factor only, and how many of them remain.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct Matching {
    /// What is equal within a matched set: `segment` and names of factors. Empty where nothing can be matched.
    pub by: Vec<String>,
    /// Matched sets per participant as they were shown: the largest number.
    pub sets_shown: usize,
    /// Matched sets that remain: the smallest and the largest number over the participants who have any.
    pub sets_left: [usize; 2],
    /// Participants with a matched set.
    pub people: usize,
    /// Participants with answers but without a matched set.
    pub people_without: usize,
    /// Answers at a level of the factor that are not compared, because their set is incomplete.
    pub answers_unmatched: usize,
    /// The matched set of each answer; `None` if the answer is not compared.
    #[serde(skip)]
    pub set_of_row: Vec<Option<u32>>,
}

impl Matching {
    /// Places of the answers that are compared.
    pub(crate) fn rows(&self) -> Vec<usize> {
        let rows = self.set_of_row.iter().enumerate();
        rows.filter(|(_, set)| set.is_some()).map(|(row, _)| row).collect()
    }
}

/// The columns on which answers are matched.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct MatchingKeys {
    /// Whether the segment is one of them.
    segment: bool,
    /// Places of the others in [`Export::factors`].
    factors: Vec<usize>,
}

impl MatchingKeys {
    /// Their names, as scripts call the columns.
    pub(crate) fn names(&self, export: &Export) -> Vec<String> {
        let segment = self.segment.then(|| SEGMENT.to_owned());
        let names = self.factors.iter().map(|&place| export.factors[place].clone());
        let names: BTreeSet<String> = names.filter(|name| Some(name) != segment.as_ref()).collect();
        segment.into_iter().chain(names).collect()
    }
}

/// A trial at a level of the factor, of an answer or of an excluded trial.
struct Shown<'e> {
    person: usize,
    trial: &'e Trial,
    code: u32,
    /// Place of its answer in the measure; `None` of an excluded trial.
    row: Option<usize>,
}

impl Measure {
    /// The matched answers of a comparison within participants.
    pub(crate) fn matching(&self, export: &Export, factor: &Factor) -> Matching {
        self.matching_on(export, factor, &self.matching_keys(export, factor))
    }

    /// The finest columns on which at least nine tenths of the participants have a set at every level, by what they were
    /// shown before any trial was excluded: exclusions must not choose what is compared.
    pub(crate) fn matching_keys(&self, export: &Export, factor: &Factor) -> MatchingKeys {
        let shown = self.shown(export, factor);
        let levels = factor.levels.len();
        let people = |keys: &MatchingKeys| {
            let sets = Sets::of(&shown, keys);
            sets.per_person(&shown, &sets.complete(&shown, levels, |_| true)).len()
        };
        let mut crossed = self.crossed_places(export, factor);
        crossed.retain(|place| {
            let mut levels = shown.iter().map(|own| own.trial.levels[*place].as_deref());
            let first = levels.next().flatten();
            levels.any(|level| level != first)
        });
        let none = MatchingKeys { segment: false, factors: Vec::new() };
        let least = people(&none) * 9;
        let segments =
            MatchingKeys { segment: true, factors: varying_within_segments(&shown, &crossed) };
        let fine = [segments, MatchingKeys { segment: false, factors: crossed }];
        let is_enough = |keys: &MatchingKeys| (people(keys) * 10).max(1) >= least.max(1);
        fine.into_iter().find(|keys| people(keys) > 0 && is_enough(keys)).unwrap_or(none)
    }

    /// The matched answers by given columns.
    pub(crate) fn matching_on(
        &self,
        export: &Export,
        factor: &Factor,
        keys: &MatchingKeys,
    ) -> Matching {
        let shown = self.shown(export, factor);
        let by = (keys.names(export), self.values.len());
        Sets::of(&shown, keys).matching(&shown, factor.levels.len(), by)
    }

    /// Every trial with a level of the factor in which the question was answered, excluded or not.
    fn shown<'e>(&self, export: &'e Export, factor: &Factor) -> Vec<Shown<'e>> {
        let rows = self.person.iter().zip(&self.trial).zip(&factor.codes).enumerate();
        let mut shown: Vec<Shown<'e>> = rows
            .filter(|(_, (_, code))| **code != Factor::MISSING)
            .map(|(row, ((&person, &trial), &code))| Shown {
                person,
                trial: &export.trials[trial],
                code,
                row: Some(row),
            })
            .collect();
        let Some(place) = export.factors.iter().position(|name| *name == factor.name) else {
            return shown;
        };
        for excluded in &export.excluded_trials {
            let level = excluded.trial.levels[place].as_deref();
            let code = factor.levels.iter().position(|own| Some(own.as_str()) == level);
            if let (Some(code), true) = (code, excluded.questions.contains(&self.question)) {
                let (person, trial) = (excluded.person, &excluded.trial);
                shown.push(Shown { person, trial, code: code as u32, row: None });
            }
        }
        shown
    }

    /// The answers that are compared alone, with their codes of the factor.
    pub(crate) fn matched(&self, export: &Export, factor: &Factor) -> (Self, Factor) {
        let rows = self.matching(export, factor).rows();
        self.at(factor, &rows)
    }

    /// The answers that are matched in two factors at the same time, with their codes of both.
    pub(crate) fn matched_in_both(
        &self,
        export: &Export,
        factors: [&Factor; 2],
        keys: &[MatchingKeys; 2],
    ) -> (Self, [Factor; 2]) {
        let mut own = (self.clone(), factors.map(Factor::clone));
        // What the second factor loses, the first must lose as well.
        for place in [0, 1, 0] {
            let rows = own.0.matching_on(export, &own.1[place], &keys[place]).rows();
            let (measure, first) = own.0.at(&own.1[0], &rows);
            let (_, second) = own.0.at(&own.1[1], &rows);
            own = (measure, [first, second]);
        }
        own
    }

    /// Some of the answers, with their codes of a factor whose levels stay.
    pub(crate) fn at(&self, factor: &Factor, rows: &[usize]) -> (Self, Factor) {
        let own = Self {
            values: rows.iter().map(|&row| self.values[row]).collect(),
            person: rows.iter().map(|&row| self.person[row]).collect(),
            trial: rows.iter().map(|&row| self.trial[row]).collect(),
            ..self.clone()
        };
        let codes = rows.iter().map(|&row| factor.codes[row]).collect();
        (own, Factor { codes, ..factor.clone() })
    }
}

/// The factors that take several levels within a segment at one level of the compared factor.
fn varying_within_segments(shown: &[Shown<'_>], crossed: &[usize]) -> Vec<usize> {
    let varies = |place: &&usize| {
        let mut first: HashMap<(Option<&str>, u32), Option<&str>> = HashMap::new();
        shown.iter().any(|own| {
            let level = own.trial.levels[**place].as_deref();
            let key = (own.trial.segment.as_deref(), own.code);
            *first.entry(key).or_insert(level) != level
        })
    };
    crossed.iter().filter(varies).copied().collect()
}

/// The set of each trial that was shown.
struct Sets {
    of_trial: Vec<u32>,
    count: usize,
}

impl Sets {
    fn of(shown: &[Shown<'_>], keys: &MatchingKeys) -> Self {
        let mut known: HashMap<(usize, Option<&str>, Vec<&str>), u32> = HashMap::new();
        let of_trial = shown.iter().map(|own| {
            let segment = own.trial.segment.as_deref().filter(|_| keys.segment);
            let level = |&place: &usize| own.trial.levels[place].as_deref().unwrap_or_default();
            let key = (own.person, segment, keys.factors.iter().map(level).collect());
            let next = known.len() as u32;
            *known.entry(key).or_insert(next)
        });
        let of_trial: Vec<u32> = of_trial.collect();
        let count = of_trial.iter().max().map_or(0, |last| *last as usize + 1);
        Self { of_trial, count }
    }

    /// Whether each set has a trial at every level, of the trials that count.
    fn complete(
        &self,
        shown: &[Shown<'_>],
        levels: usize,
        counts: impl Fn(&Shown<'_>) -> bool,
    ) -> Vec<bool> {
        let mut met = vec![false; self.count * levels];
        for (own, &set) in shown.iter().zip(&self.of_trial).filter(|(own, _)| counts(own)) {
            met[set as usize * levels + own.code as usize] = true;
        }
        met.chunks(levels.max(1)).map(|levels| levels.iter().all(|met| *met)).collect()
    }

    /// The number of complete sets of each participant who has one.
    fn per_person(&self, shown: &[Shown<'_>], complete: &[bool]) -> HashMap<usize, usize> {
        let mut counted = vec![false; self.count];
        let mut people: HashMap<usize, usize> = HashMap::new();
        for (own, &set) in shown.iter().zip(&self.of_trial) {
            let set = set as usize;
            if complete[set] && !std::mem::replace(&mut counted[set], true) {
                *people.entry(own.person).or_insert(0) += 1;
            }
        }
        people
    }

    fn matching(
        &self,
        shown: &[Shown<'_>],
        levels: usize,
        (by, rows): (Vec<String>, usize),
    ) -> Matching {
        let as_shown = self.per_person(shown, &self.complete(shown, levels, |_| true));
        let complete = self.complete(shown, levels, |own| own.row.is_some());
        let left = self.per_person(shown, &complete);
        let mut set_of_row = vec![None; rows];
        let mut answering = BTreeSet::new();
        let mut unmatched = 0;
        for (own, &set) in shown.iter().zip(&self.of_trial) {
            let Some(row) = own.row else { continue };
            answering.insert(own.person);
            if complete[set as usize] {
                set_of_row[row] = Some(set);
            } else {
                unmatched += 1;
            }
        }
        Matching {
            by,
            sets_shown: as_shown.values().copied().max().unwrap_or(0),
            sets_left: [
                left.values().copied().min().unwrap_or(0),
                left.values().copied().max().unwrap_or(0),
            ],
            people: left.len(),
            people_without: answering.len() - left.len(),
            answers_unmatched: unmatched,
            set_of_row,
        }
    }
}
