//! Simulated answers as the analysis reads them, without events and without CSV.
//!
//! The same people answer the same questions as in [`crate::Simulation`]: a test holds both against each
//! other. Only what the study's hypotheses and exclusions need is drawn.

use std::sync::Arc;

use mimique_study::columns::{ASSIGNED_CONDITION, ColumnKind};
use mimique_study::{
    Answers, Component, KindOfQuestion as _, Questionnaire, Study, TrialsComponent,
};
use serde_json::Value;

use super::design::{Design, Step, has_conditions};
use super::drawn_pairs::OwnPairs;
use super::given::{Given, text};
use crate::simulate::{
    Asked, BEFORE_REPLAY_MS, ClipEffects, Companion, Model, PairChoices, Person, Raw, as_json,
    eighths,
};
use crate::trials::export::{
    Answer, Beside, ExcludedTrial, Export, Person as Who, Trial, exclude_people, why_left_out,
};
use crate::trials::straight_lining::Runs;

impl Design<'_> {
    /// The answers of the first `participants` people of a seed.
    pub(crate) fn answers(&self, model: &Model<'_>, seed: u64, participants: usize) -> Export {
        let clips = model.clip_effects(seed);
        let mut data = Data::new(self, model);
        for number in 1..=participants.min(self.walks.len()) {
            data.person(&clips, seed, number);
        }
        data.finish()
    }
}

/// Rows in the making.
struct Data<'d> {
    design: &'d Design<'d>,
    model: &'d Model<'d>,
    export: Export,
    stages: Vec<&'static str>,
    /// Levels of each clip, in the order of the factors.
    levels: Vec<Vec<Option<Arc<str>>>>,
    /// Answers and trials before the exclusions, with the quickest answer of each trial.
    trials: Vec<(usize, Trial, Option<f64>)>,
    answers: Vec<(String, Answer)>,
    /// What everybody so far chose in blocks whose pairs follow from answers.
    choices: PairChoices,
}

impl<'d> Data<'d> {
    fn new(design: &'d Design<'d>, model: &'d Model<'d>) -> Self {
        let factors = design.study.factor_names();
        let levels = model
            .clips
            .iter()
            .map(|clip| {
                factors.iter().map(|factor| clip.factor_text(factor).map(Arc::from)).collect()
            })
            .collect();
        let about = crate::simulate::traits(design.study)
            .into_keys()
            .chain(numbers_about(design.study))
            .map(|question| (question, Vec::new()))
            .collect();
        Self {
            design,
            model,
            export: Export::new(factors, about),
            stages: Vec::new(),
            levels,
            trials: Vec::new(),
            answers: Vec::new(),
            choices: PairChoices::new(),
        }
    }

    fn person(&mut self, clips: &ClipEffects, seed: u64, number: usize) {
        let walk = &self.design.walks[number - 1];
        let (condition, slot) = self.design.condition_and_slot(number);
        let mut person = Person::new(self.model, clips, seed, number as u64, condition);
        let trials = walk.iter().filter(|step| !matches!(step, Step::Page(_))).count();
        let leaves = person.fate.leaves_after.is_some_and(|after| after < trials);
        if person.fate.declines || (leaves && person.fate.withdraws) {
            return;
        }
        let place = self.export.people.len();
        let mut who = Who {
            id: format!("p{number:04}"),
            status: if leaves { "active" } else { "completed" }.to_owned(),
            trials: 0,
            failed_checks: 0,
            longest_run: 0,
            heard: self.design.study.has_sound(),
            excluded: None,
        };
        let mut has_rows = !person.about.is_empty() || self.design.study.training.is_some();
        let mut earlier = person.about.clone();
        let mut runs = Runs::default();
        let mut pairs = OwnPairs::new(self.design, slot);
        let mut done = 0;
        for step in walk {
            match step {
                Step::Page(name) if self.design.needs.pages => {
                    let Some(Component::Questionnaire(page)) = self.design.components.get(name)
                    else {
                        continue;
                    };
                    if let Some(told) = page_answers(&mut person, &mut who, page, &earlier) {
                        has_rows = true;
                        earlier.extend(told);
                    }
                }
                Step::Page(_) => {}
                Step::Trial { .. } | Step::DrawnPair(_)
                    if person.fate.leaves_after.is_some_and(|after| done >= after) =>
                {
                    break;
                }
                Step::Trial { block, .. } | Step::DrawnPair(block) => {
                    for (clip, beside) in self.shown(step, &mut pairs) {
                        has_rows = true;
                        let shown = (clip, beside, block.as_str(), done);
                        let own = (&mut who, &mut runs, &mut pairs);
                        self.trial(&mut person, own, place, shown, &earlier);
                        done += 1;
                    }
                }
            }
        }
        pairs.count(&mut self.choices);
        if !has_rows {
            return;
        }
        who.longest_run = runs.longest();
        for (question, cells) in &mut self.export.about {
            let assigned = condition.filter(|_| question == ASSIGNED_CONDITION);
            let told = || person.about.get(question).map(text);
            cells.push(assigned.map(str::to_owned).or_else(told));
        }
        self.export.people.push(who);
        self.stages.push("live");
    }

    /// The clips of a step, each with what stands beside it: of a drawn pair every copy.
    fn shown(&self, step: &Step, pairs: &mut OwnPairs<'d>) -> Vec<(usize, Option<Companion>)> {
        let block = match step {
            Step::Trial { clip, beside, .. } => return vec![(*clip, *beside)],
            Step::DrawnPair(block) => block,
            Step::Page(_) => return Vec::new(),
        };
        let drawn = pairs.next(block, &self.choices);
        let copies = drawn.iter().flat_map(|[left, right]| {
            self.design.copies(left).iter().zip(self.design.copies(right))
        });
        let beside = |right| Some(Companion { clip: right, left: false });
        copies.map(|(&left, &right)| (left, beside(right))).collect()
    }

    fn trial(
        &mut self,
        person: &mut Person<'_>,
        (who, runs, pairs): (&mut Who, &mut Runs<'d>, &mut OwnPairs<'d>),
        place: usize,
        (clip, beside, block, done): (usize, Option<Companion>, &str, usize),
        earlier: &Answers,
    ) {
        let Some(Component::Trials(component)) = self.design.components.get(block) else {
            return;
        };
        let needs = &self.design.needs;
        let (trial, mut since_onset_ms) = self.show(person, component, (clip, beside));
        who.trials += 1;
        let mut quickest: Option<f64> = None;
        let mut told = Answers::new();
        for id in &component.questions {
            let Some(question) = self.model.question(id) else { continue };
            let asked = &self.model.questions[question];
            if asked.question.show_if.is_some() && !asked.question.is_shown(&told, earlier) {
                continue;
            }
            let ms = if needs.times { person.answering_ms(Some(clip)) } else { 0.0 };
            let raw = person.trial_answer(question, clip, beside, done);
            if let Some(check) = &asked.question.attention_check {
                let answer = raw.clone().map(|raw| as_json(asked, raw));
                who.failed_checks += usize::from(!is_same(answer.as_ref(), &check.expected));
            }
            if asked.question.kind.compares_clips()
                && let Some(beside) = beside
            {
                let answer = raw.clone().map(|raw| as_json(asked, raw));
                let shown = [clip, beside.clip].map(|it| self.design.clips.originals[it].as_str());
                pairs.answered(block, shown, answer.as_ref().and_then(Value::as_str));
            }
            let Some(raw) = raw else { continue };
            let rt_ms = needs.times.then(|| {
                since_onset_ms += eighths(ms);
                (since_onset_ms * 1000.0).round() / 1000.0
            });
            if let Some(rt_ms) = rt_ms {
                // From when answers could be given: the end of the first play.
                let open_ms = rt_ms - eighths(self.model.parameters.times.clip_ms);
                quickest = Some(quickest.map_or(open_ms, |least| least.min(open_ms)));
            }
            if has_conditions(self.design.study) {
                told.insert(id.clone(), as_json(asked, raw.clone()));
            }
            self.run(runs, asked, &raw);
            self.keep(id, &Given { person: place, clip, asked, raw: &raw, rt_ms });
        }
        self.trials.push((place, trial, quickest));
    }

    /// Counts an answer, or each of its parts, in its run of equal answers.
    fn run(&self, runs: &mut Runs<'d>, asked: &Asked<'_>, raw: &Raw) {
        let id = &asked.question.id;
        for response in &self.design.needs.runs {
            let Some(suffix) = response.strip_prefix(id.as_str()) else { continue };
            let told = as_json(asked, raw.clone());
            let answer = match suffix.strip_prefix('.') {
                Some(part) => asked.question.kind.part_of(&told, part),
                None if suffix.is_empty() => told,
                None => continue,
            };
            if !answer.is_null() {
                runs.add(response, &text(&answer));
            }
        }
    }

    /// Shows the clip of a trial: the trial's row, and the time from its onset to the end of its last
    /// play, milliseconds.
    fn show(
        &self,
        person: &mut Person<'_>,
        component: &TrialsComponent,
        (clip, beside): (usize, Option<Companion>),
    ) -> (Trial, f64) {
        let mut trial = Trial {
            stimulus: self.model.clips[clip].id.as_str().into(),
            segment: Some(self.model.clips[clip].segment.as_str().into()),
            // The order of trials has no part in the study's tests.
            order: None,
            level: None,
            face: None,
            scaled: None,
            beside: beside.map(|beside| Beside {
                clip: self.model.clips[beside.clip].id.as_str().into(),
                left: beside.left,
                levels: self.levels[beside.clip].clone(),
            }),
            levels: self.levels[clip].clone(),
            frames: None,
            late: None,
            longest_ms: None,
            sound_off_ms: None,
        };
        let clip_ms = eighths(self.model.parameters.times.clip_ms);
        let mut since_onset_ms = clip_ms;
        if self.design.needs.display {
            let showing = person.showing(component.maximum_replays);
            let again = eighths(BEFORE_REPLAY_MS) + eighths(60.0) + clip_ms;
            since_onset_ms += showing.replays as f64 * again;
            trial.frames = Some(showing.frames.len() as f64);
            trial.late = Some(showing.late() as f64);
            trial.longest_ms = Some((showing.longest_ms() * 1000.0).round() / 1000.0);
        }
        (trial, since_onset_ms)
    }

    /// Keeps an answer to a question of the trial that is being made, once for each response that the
    /// hypotheses are about.
    fn keep(&mut self, question: &str, given: &Given<'_>) {
        let responses = &self.design.needs.responses;
        let trial = self.trials.len();
        for response in responses {
            let Some(suffix) = response.strip_prefix(question) else { continue };
            if !suffix.is_empty() && !suffix.starts_with('.') {
                continue;
            }
            // Several hypotheses may be about one response.
            let again = |(to, answer): &(String, Answer)| answer.trial == trial && to == response;
            if self.answers.iter().rev().take(responses.len()).any(again) {
                continue;
            }
            let part = suffix.trim_start_matches('.');
            let Some(answer) = given.as_answer(part, trial) else { continue };
            self.answers.push((response.clone(), answer));
        }
    }

    /// Applies the study's exclusions.
    fn finish(mut self) -> Export {
        let study = self.design.study;
        let rules = study.exclusions.clone().unwrap_or_default();
        let flow = exclude_people(study, &mut self.export.people, &self.stages);
        self.export.flow = flow;
        let mut kept: Vec<Option<usize>> = Vec::with_capacity(self.trials.len());
        let mut excluded: Vec<Option<usize>> = vec![None; self.trials.len()];
        for (number, (person, trial, quickest)) in self.trials.into_iter().enumerate() {
            if self.export.people[person].excluded.is_some() {
                kept.push(None);
                continue;
            }
            self.export.flow.trials += 1;
            match why_left_out(&rules, &trial, quickest) {
                Some(reason) => {
                    *self.export.flow.trials_left_out.entry(reason).or_insert(0) += 1;
                    kept.push(None);
                    excluded[number] = Some(self.export.excluded_trials.len());
                    let own = ExcludedTrial { person, trial, questions: Vec::new() };
                    self.export.excluded_trials.push(own);
                }
                None => {
                    self.export.trials.push(trial);
                    kept.push(Some(self.export.trials.len() - 1));
                }
            }
        }
        self.export.flow.trials_used = self.export.trials.len();
        for (response, answer) in self.answers {
            if let Some(place) = excluded[answer.trial] {
                self.export.excluded_trials[place].questions.push(response.clone());
            }
            if let Some(trial) = kept[answer.trial] {
                let answers = self.export.answers.entry(response).or_default();
                answers.push(Answer { trial, ..answer });
            }
        }
        self.export
    }
}

/// The answers of a page, its attention checks counted; none where no question is shown.
fn page_answers(
    person: &mut Person<'_>,
    who: &mut Who,
    page: &Questionnaire,
    earlier: &Answers,
) -> Option<Answers> {
    let mut told = Answers::new();
    let mut is_empty = true;
    for question in &page.questions {
        if !question.is_shown(&told, earlier) {
            continue;
        }
        is_empty = false;
        let answer = person.page_answer(&question.id);
        if let Some(check) = &question.attention_check {
            who.failed_checks += usize::from(!is_same(answer.as_ref(), &check.expected));
        }
        if let Some(answer) = answer {
            told.insert(question.id.clone(), answer);
        }
    }
    (!is_empty).then_some(told)
}

fn numbers_about(study: &Study) -> impl Iterator<Item = String> {
    let questions = study.demographics.iter().flat_map(|page| &page.questions);
    questions
        .filter(|question| question.kind.column_kind() == ColumnKind::Number)
        .map(|question| question.id.clone())
}

fn is_same(answer: Option<&Value>, expected: &Value) -> bool {
    answer.is_some_and(|answer| match (answer.as_f64(), expected.as_f64()) {
        (Some(left), Some(right)) => left == right,
        _ => answer == expected,
    })
}
