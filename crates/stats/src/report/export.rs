//! The tidy export of a study as people, trials and answers, with the study's exclusions applied.

use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::sync::OnceLock;

use mimique_study::{Exclusions, Question, QuestionKind, Study};
use serde::Serialize;

use super::combinations::Combinations;
use crate::number::parse_number;
use crate::outcome::Refusal;
use crate::table::Table;

/// One person.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct Person {
    /// `participant_id`.
    pub id: String,
    /// How the session stands.
    pub status: String,
    /// Trials answered (practice not counted).
    pub trials: usize,
    /// Attention checks failed.
    pub failed_checks: usize,
    /// Why the person is left out.
    pub excluded: Option<&'static str>,
}

/// One answer in a trial that is used.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Answer {
    /// Place in [`Export::people`].
    pub person: usize,
    /// Identifier of the question.
    pub question: String,
    /// As exported.
    pub text: String,
    /// As a number, if it is one.
    pub number: Option<f64>,
    /// Whether it is right, where there is a right answer.
    pub correct: Option<bool>,
    /// The right answer.
    pub truth: Option<String>,
    /// Response time, milliseconds.
    pub rt_ms: Option<f64>,
    /// Place in [`Export::trials`].
    pub trial: usize,
}

/// One trial that is used: its clip, factors and frames.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Trial {
    pub stimulus: String,
    /// Place among the person's trials, from 1.
    pub order: Option<usize>,
    /// Value of each of [`Export::factors`].
    pub levels: Vec<Option<String>>,
    pub frames: Option<f64>,
    pub late: Option<f64>,
    pub longest_ms: Option<f64>,
}

/// What was left out, and why.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub(crate) struct Flow {
    /// People with at least one row.
    pub people: usize,
    /// People left out, by reason.
    pub people_left_out: BTreeMap<&'static str, usize>,
    /// Those of them whom the researcher excluded, by the reason given.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub researcher_reasons: BTreeMap<String, usize>,
    /// People used.
    pub people_used: usize,
    /// Trials of the people used.
    pub trials: usize,
    /// Trials left out, by reason.
    pub trials_left_out: BTreeMap<&'static str, usize>,
    /// Trials used.
    pub trials_used: usize,
    /// Rows of pilot sessions left out because there are live ones.
    pub pilot_people: usize,
    /// Rules of the study file, in words.
    pub rules: Vec<String>,
}

impl Flow {
    /// The reasons and their counts, in brackets; empty where there are none.
    pub fn why(&self) -> String {
        let reasons = self.people_left_out.iter().chain(&self.trials_left_out);
        let words: Vec<String> =
            reasons.map(|(reason, count)| format!("{reason}: {count}")).collect();
        if words.is_empty() { String::new() } else { format!(" ({})", words.join(", ")) }
    }
}

/// A study's answers.
#[derive(Debug, Clone)]
pub(crate) struct Export {
    pub people: Vec<Person>,
    pub trials: Vec<Trial>,
    pub answers: Vec<Answer>,
    /// Names of the factors.
    pub factors: Vec<String>,
    /// Answers about each person: column, then one cell a person.
    pub about: Vec<(String, Vec<Option<String>>)>,
    pub flow: Flow,
    /// Of the trials; found when first asked for.
    combinations: OnceLock<Combinations>,
}

/// Why somebody is left out whom the researcher excluded.
pub(crate) const BY_RESEARCHER: &str = "excluded by the researcher";

/// Columns that must be there.
const NEEDED: [&str; 5] = ["participant_id", "trial_id", "trial_type", "response_id", "answer"];

impl Export {
    /// Without people, trials and answers yet.
    pub(crate) fn new(factors: Vec<String>, about: Vec<(String, Vec<Option<String>>)>) -> Self {
        Self {
            people: Vec::new(),
            trials: Vec::new(),
            answers: Vec::new(),
            factors,
            about,
            flow: Flow::default(),
            combinations: OnceLock::new(),
        }
    }

    /// The combinations of levels that the trials have. The trials must be complete.
    pub(crate) fn combinations(&self) -> &Combinations {
        self.combinations.get_or_init(|| Combinations::of(&self.trials))
    }

    /// Reads the tidy form and applies the study's exclusions.
    pub(crate) fn read(table: &Table, study: &Study) -> Result<Self, Refusal> {
        if let Some(missing) = NEEDED.iter().find(|name| !table.has(name)) {
            return Err(Refusal::column(
                *missing,
                "there is no such column",
                "give the tidy form that `mimique export --format csv` writes",
            ));
        }
        let column = |name: &str| Column::of(table, name);
        let [participant, status, stage, attention] =
            ["participant_id", "status", "stage", "attention_passed"].map(column);
        let mut people: Vec<Person> = Vec::new();
        let mut place: HashMap<&str, usize> = HashMap::new();
        let mut person_of_row = Vec::with_capacity(table.rows());
        let mut stages: Vec<&str> = Vec::new();
        for row in 0..table.rows() {
            let id = participant.needed(row)?;
            let person = *place.entry(id).or_insert_with(|| {
                people.push(Person {
                    id: id.to_owned(),
                    status: status.text(row).unwrap_or("unknown").to_owned(),
                    trials: 0,
                    failed_checks: 0,
                    excluded: None,
                });
                stages.push(stage.text(row).unwrap_or("live"));
                people.len() - 1
            });
            if attention.text(row) == Some("false") {
                people[person].failed_checks += 1;
            }
            person_of_row.push(person);
        }
        // The server marks whom the researcher excluded; how the session stood is kept beside it.
        let mut reasons: Vec<Option<&str>> = vec![None; people.len()];
        if table.has("excluded") && table.has("exclusion_reason") {
            let [excluded, reason] = ["excluded", "exclusion_reason"].map(column);
            for (row, &person) in person_of_row.iter().enumerate() {
                if excluded.text(row) == Some("true") {
                    "excluded".clone_into(&mut people[person].status);
                    reasons[person] = reason.text(row);
                }
            }
        }
        let mut flow = exclude_people(study, &mut people, &stages);
        for (person, reason) in people.iter().zip(&reasons) {
            if let (Some(BY_RESEARCHER), Some(reason)) = (person.excluded, reason) {
                *flow.researcher_reasons.entry((*reason).to_owned()).or_insert(0) += 1;
            }
        }
        let factors = study.factor_names().into_iter().filter(|name| table.has(name)).collect();
        let about = about_people(table, study, &person_of_row, people.len());
        let mut export = Self { people, flow, ..Self::new(factors, about) };
        export.read_trials(table, study, &person_of_row)?;
        Ok(export)
    }

    fn read_trials(
        &mut self,
        table: &Table,
        study: &Study,
        person_of_row: &[usize],
    ) -> Result<(), Refusal> {
        let rules = study.exclusions.clone().unwrap_or_default();
        let column = |name: &str| Column::of(table, name);
        let [kind, trial_id, rt, stimulus, order] =
            ["trial_type", "trial_id", "rt", "stimulus", "trial_order"].map(column);
        let [frames, late, longest] = ["frames", "frames_late", "frame_longest_ms"].map(column);
        let [response, answer, correct, truth] =
            ["response_id", "answer", "correct", "truth"].map(column);
        let levels: Vec<Column<'_>> = self.factors.iter().map(|factor| column(factor)).collect();
        // A trial is left out for its first reason; the quickest answer decides for all of it.
        let mut quickest: HashMap<(usize, &str), f64> = HashMap::new();
        for (row, &person) in person_of_row.iter().enumerate() {
            if let (Some("trial"), Some(trial), Some(rt)) =
                (kind.text(row), trial_id.text(row), rt.number(row)?)
                && rules.shortest_rt_ms.is_some()
            {
                let least = quickest.entry((person, trial)).or_insert(rt);
                *least = least.min(rt);
            }
        }
        let mut seen: HashMap<(usize, &str), Option<usize>> = HashMap::new();
        for (row, &person) in person_of_row.iter().enumerate() {
            if kind.text(row) != Some("trial") {
                continue;
            }
            let id = trial_id.needed(row)?;
            let known = seen.get(&(person, id)).copied();
            let trial = match known {
                Some(trial) => trial,
                None => {
                    self.people[person].trials += 1;
                    let trial = Trial {
                        stimulus: stimulus.text(row).unwrap_or_default().to_owned(),
                        order: order.number(row)?.map(|order| order as usize),
                        levels: levels.iter().map(|own| own.text(row).map(str::to_owned)).collect(),
                        frames: frames.number(row)?,
                        late: late.number(row)?,
                        longest_ms: longest.number(row)?,
                    };
                    let place = if self.people[person].excluded.is_some() {
                        None
                    } else {
                        self.flow.trials += 1;
                        let reason =
                            why_left_out(&rules, &trial, quickest.get(&(person, id)).copied());
                        match reason {
                            Some(reason) => {
                                *self.flow.trials_left_out.entry(reason).or_insert(0) += 1;
                                None
                            }
                            None => {
                                self.trials.push(trial);
                                Some(self.trials.len() - 1)
                            }
                        }
                    };
                    seen.insert((person, id), place);
                    place
                }
            };
            if let (Some(trial), Some(text)) = (trial, answer.text(row)) {
                self.answers.push(Answer {
                    person,
                    question: response.needed(row)?.to_owned(),
                    text: text.to_owned(),
                    number: text.parse().ok().filter(|number: &f64| number.is_finite()),
                    correct: match correct.text(row) {
                        Some("true") => Some(true),
                        Some("false") => Some(false),
                        _ => None,
                    },
                    truth: truth.text(row).map(str::to_owned),
                    rt_ms: rt.number(row)?,
                    trial,
                });
            }
        }
        self.flow.trials_used = self.trials.len();
        Ok(())
    }

    /// Level of a factor in an answer's trial.
    pub(crate) fn level(&self, answer: &Answer, factor: &str) -> Option<&str> {
        let place = self.factors.iter().position(|name| name == factor)?;
        self.trials[answer.trial].levels[place].as_deref()
    }

    /// Questions that were answered in trials, in the study's order, then any other.
    pub(crate) fn questions<'s>(&self, study: &'s Study) -> Vec<AskedQuestion<'s>> {
        // Millions of answers to a few questions.
        let mut asked: BTreeSet<&str> = BTreeSet::new();
        for answer in &self.answers {
            if !asked.contains(answer.question.as_str()) {
                asked.insert(&answer.question);
            }
        }
        let mut found: Vec<AskedQuestion<'s>> = Vec::new();
        let mut left = asked.clone();
        for question in &study.questions {
            let own = asked.iter().filter(|id| {
                **id == question.id
                    || id.strip_prefix(&question.id).is_some_and(|rest| rest.starts_with('.'))
            });
            for id in own {
                if left.remove(*id) {
                    found.push(AskedQuestion { id: (*id).to_owned(), question: Some(question) });
                }
            }
        }
        found
            .extend(left.into_iter().map(|id| AskedQuestion { id: id.to_owned(), question: None }));
        found
    }
}

/// A question that was answered in trials.
#[derive(Debug, Clone)]
pub(crate) struct AskedQuestion<'s> {
    /// As in the export (`grid.valence`).
    pub id: String,
    /// Its place in the study file; none for one that the file no longer has.
    pub question: Option<&'s Question>,
}

impl AskedQuestion<'_> {
    /// What is asked, with the part of a question that has several.
    pub(crate) fn label(&self, language: &str) -> String {
        let Some(question) = self.question else { return self.id.clone() };
        let part = self.id.strip_prefix(&question.id).unwrap_or_default();
        let part = part.trim_start_matches('.');
        let prompt = question.prompt.in_language(language);
        if part.is_empty() { prompt.to_owned() } else { format!("{prompt} ({part})") }
    }

    /// Whether the clip holds the right answer.
    pub(crate) fn is_recognition(&self) -> bool {
        matches!(
            self.question.map(|question| &question.kind),
            Some(QuestionKind::SingleChoice(choice)) if choice.truth.is_some()
        )
    }

    /// First and last point of a scale of few points.
    pub(crate) fn scale(&self) -> Option<(i64, i64)> {
        match self.question.map(|question| &question.kind) {
            Some(QuestionKind::Likert(likert)) => Some((likert.start, likert.end())),
            Some(QuestionKind::ValenceArousal(grid)) => Some((1, i64::from(grid.num_items))),
            _ => None,
        }
    }
}

/// The cells of a column, if the table has it.
struct Column<'t> {
    table: &'t Table,
    name: String,
    place: Option<usize>,
}

impl<'t> Column<'t> {
    fn of(table: &'t Table, name: &str) -> Self {
        Self { table, name: name.to_owned(), place: table.position(name).ok() }
    }

    fn text(&self, row: usize) -> Option<&'t str> {
        self.table.cell(row, self.place?)
    }

    fn needed(&self, row: usize) -> Result<&'t str, Refusal> {
        self.text(row).ok_or_else(|| {
            let problem = format!("line {}: the cell is blank", self.table.line(row));
            Refusal::column(&self.name, problem, "export the study again")
        })
    }

    fn number(&self, row: usize) -> Result<Option<f64>, Refusal> {
        let Some(cell) = self.text(row) else { return Ok(None) };
        parse_number(cell, true).map(Some).ok_or_else(|| {
            let problem = format!("line {}: \"{cell}\" is not a number", self.table.line(row));
            Refusal::column(&self.name, problem, "export the study again")
        })
    }
}

/// Why a trial is left out, if it is: its first reason. `quickest_ms` is its shortest response time.
pub(crate) fn why_left_out(
    rules: &Exclusions,
    trial: &Trial,
    quickest_ms: Option<f64>,
) -> Option<&'static str> {
    let share = match (trial.late, trial.frames) {
        (Some(late), Some(frames)) if frames > 0.0 => Some(late / frames),
        _ => None,
    };
    let over = |value: Option<f64>, limit: Option<f64>| matches!((value, limit), (Some(value), Some(limit)) if value > limit);
    let quick =
        matches!((quickest_ms, rules.shortest_rt_ms), (Some(rt), Some(limit)) if rt < limit);
    if over(share, rules.late_frame_share) {
        Some("late frames")
    } else if over(trial.longest_ms, rules.longest_frame_ms) {
        Some("long frame")
    } else if quick {
        Some("answered too soon")
    } else {
        None
    }
}

/// Marks the people whom the rules leave out, and counts them.
pub(crate) fn exclude_people(study: &Study, people: &mut [Person], stages: &[&str]) -> Flow {
    let rules = study.exclusions.clone().unwrap_or_default();
    let live = stages.iter().any(|stage| *stage != "pilot");
    let mut flow = Flow { people: people.len(), rules: rules_in_words(&rules), ..Flow::default() };
    for (person, stage) in people.iter_mut().zip(stages) {
        person.excluded = if live && *stage == "pilot" {
            flow.pilot_people += 1;
            Some("pilot")
        } else if person.status == "withdrawn" {
            Some("withdrawn")
        } else if person.status == "declined" {
            Some("declined")
        } else if person.status == "excluded" {
            Some(BY_RESEARCHER)
        } else if rules.incomplete && person.status != "completed" {
            Some("incomplete")
        } else if rules
            .failed_attention_checks
            .is_some_and(|limit| person.failed_checks > limit as usize)
        {
            Some("attention checks")
        } else {
            None
        };
        if let Some(reason) = person.excluded {
            *flow.people_left_out.entry(reason).or_insert(0) += 1;
        }
    }
    flow.people_used = people.iter().filter(|person| person.excluded.is_none()).count();
    flow
}

fn rules_in_words(rules: &Exclusions) -> Vec<String> {
    let mut words = Vec::new();
    if rules.incomplete {
        words.push("incomplete".to_owned());
    }
    if let Some(limit) = rules.failed_attention_checks {
        words.push(format!("failedAttentionChecks > {limit}"));
    }
    if let Some(limit) = rules.late_frame_share {
        words.push(format!("lateFrameShare > {limit}"));
    }
    if let Some(limit) = rules.longest_frame_ms {
        words.push(format!("longestFrameMs > {limit}"));
    }
    if let Some(limit) = rules.shortest_rt_ms {
        words.push(format!("rt < {limit} ms"));
    }
    words
}

/// Columns of answers about the person: the same in each of the person's rows.
fn about_people(
    table: &Table,
    study: &Study,
    person_of_row: &[usize],
    people: usize,
) -> Vec<(String, Vec<Option<String>>)> {
    let questions: Vec<&str> = study
        .demographics
        .iter()
        .flat_map(|page| &page.questions)
        .map(|question| question.id.as_str())
        .collect();
    let own = |name: &String| {
        questions
            .iter()
            .any(|id| name == id || name.strip_prefix(id).is_some_and(|rest| rest.starts_with('.')))
    };
    let mut about = Vec::new();
    for (place, name) in table.names().iter().enumerate().filter(|(_, name)| own(name)) {
        let mut cells: Vec<Option<String>> = vec![None; people];
        for (row, &person) in person_of_row.iter().enumerate() {
            if cells[person].is_none() {
                cells[person] = table.cell(row, place).map(str::to_owned);
            }
        }
        about.push((name.clone(), cells));
    }
    about
}
