//! What one participant goes through, step by step: fixed at the start of the session.

mod json_blocks;
mod practice;

use std::collections::BTreeMap;

use crate::event::ChosenClips;
use crate::panel::Panel;
use crate::tracked_face::MIMICRY_STEP;
use crate::wire::SessionStarted;
use json_blocks::{as_json, json_trial};
use mimique_study::text::{Words, words};
use mimique_study::{
    Answers, Beside, BreakComponent, Calibration, Clip, Component, DealtPairs, Draw,
    KindOfQuestion as _, LocalText, Multilingual as _, OptionOrder, OrderError, OrderedItem,
    Question, Questionnaire, Section, Sides, StudyProjection, TimeLimit, option_order, order,
};
use practice::practice;
use serde::Deserialize as _;

/// What one participant goes through.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// The study, as the page needs it.
    pub study: StudyProjection,
    /// The session: participant, seed, hash, withdrawal code.
    pub started: SessionStarted,
    /// The steps, from the first page to the debriefing.
    pub steps: Vec<Step>,
    /// Shown order of options, by question, where it is drawn.
    pub option_orders: BTreeMap<String, Vec<usize>>,
    /// Index of the step after each round of practice.
    pub rounds: Vec<usize>,
    translated: Vec<Words>,
}

/// One page or trial.
#[derive(Debug, Clone, PartialEq)]
pub struct Step {
    /// `consent`, `demographics`, `instructions/1`, `faces/joy2.lsts30`...
    pub id: String,
    /// What it is.
    pub kind: StepKind,
    /// How long it may take.
    pub time_limit: Option<TimeLimit>,
}

/// What a step is.
#[derive(Debug, Clone, PartialEq)]
pub enum StepKind {
    /// The agreement.
    Consent,
    /// What browser and display can do.
    Device,
    /// How large a CSS pixel is.
    Calibration(Calibration),
    /// Where the volume is set and tones are counted.
    Sound,
    /// Where the measuring of the face is agreed to.
    Mimicry,
    /// Which answers to the practice clip before were right.
    Feedback {
        /// Index of the trial's step.
        of: usize,
    },
    /// A page of questions; `demographics` is true for those about the participant.
    Questions {
        /// The page.
        page: Questionnaire,
        /// Whether it asks about the participant.
        demographics: bool,
    },
    /// A page to read.
    Page(Section),
    /// A rest.
    Break(BreakComponent),
    /// A trial.
    Trial(TrialStep),
    /// A page after the last answer.
    Debriefing(Section),
}

/// A clip and its questions.
#[derive(Debug, Clone, PartialEq)]
pub struct TrialStep {
    /// Identifier of the clip; empty in an adaptive block, where it follows from answers
    /// ([`TrialStep::pair`]).
    pub clip: String,
    /// The questions, in the order they are asked.
    pub questions: Vec<Question>,
    /// A line above the clip.
    pub instruction: Option<LocalText>,
    /// Most replays after the first whole play.
    pub maximum_replays: Option<u32>,
    /// Whether it is for practice.
    pub training: bool,
    /// 1-based place among the trials, or among the practice trials.
    pub number: usize,
    /// Nearest sequence with an identifier, else the component.
    pub condition: String,
    /// What is played in step beside the clip.
    pub beside: Option<Companion>,
    /// The panel, where several clips are rated on one scale, or stand beside each other to be told apart.
    pub panel: Option<Box<Panel>>,
    /// What the stage calls its face, where that is drawn for this trial alone ([`Plan::face`]): the step. Empty before
    /// the session, when nobody's draw is known.
    pub face: Option<String>,
    /// Place among those pairs of its block that follow from answers, from 0; none of other trials.
    pub active: Option<usize>,
    /// Right answers by question, of a practice trial.
    pub right: Answers,
}

/// A clip that is played in step beside another.
#[derive(Debug, Clone, PartialEq)]
pub struct Companion {
    /// Identifier of the clip.
    pub clip: String,
    /// Whether it stands left of the trial's own clip.
    pub left: bool,
    /// A line below it.
    pub caption: Option<LocalText>,
    /// A line below the trial's own clip.
    pub clip_caption: Option<LocalText>,
    /// Whether it is played after the trial's own clip, not in step with it.
    pub in_turn: bool,
}

impl Companion {
    /// The clip on the right of a pair.
    fn of_pair(right: &str, pairs: Option<&DealtPairs>) -> Self {
        Self {
            clip: right.to_owned(),
            left: false,
            caption: None,
            clip_caption: None,
            in_turn: pairs.is_some_and(|pairs| pairs.in_turn),
        }
    }
}

impl Plan {
    /// The plan of the participant whose session has started.
    pub fn new(study: StudyProjection, started: SessionStarted) -> Result<Self, OrderError> {
        let draw = Draw {
            seed: started.seed,
            config_hash: &started.config_hash,
            participant: started.slot(),
            condition: started.condition.as_deref(),
        };
        let items = order(&study, draw)?;
        let mut steps = before_training(&study);
        let rounds = match &study.training {
            Some(training) => practice(&study, training, &mut steps),
            None => Vec::new(),
        };
        steps.extend(ordered(&study, draw, &items));
        let debriefing = study.debriefing.iter().enumerate().map(|(index, section)| {
            let id = format!("debriefing/{}", index + 1);
            Step::new(id, StepKind::Debriefing(section.clone()))
        });
        steps.extend(debriefing);
        let option_orders = option_orders(&study, draw);
        let translated = study.translations.keys().map(|each| study.words(each)).collect();
        Ok(Self { study, started, steps, option_orders, rounds, translated })
    }

    /// The questions of a step, by its identifier.
    pub fn questions_of(&self, step: &str) -> Vec<&Question> {
        let here = self.steps.iter().find(|each| each.id == step);
        here.into_iter().flat_map(Step::questions).collect()
    }

    /// The step at this place; `None` past the last one.
    pub fn step(&self, index: usize) -> Option<&Step> {
        self.steps.get(index)
    }

    /// Whether a step stands before the session: agreement and device. Until they are passed nobody holds a
    /// place, and nothing is kept.
    pub fn is_before_session(&self, index: usize) -> bool {
        self.step(index)
            .is_some_and(|step| matches!(step.kind, StepKind::Consent | StepKind::Device))
    }

    /// How many trials there are, or practice trials in a round.
    pub fn trial_count(&self, training: bool) -> usize {
        if let (true, Some(training)) = (training, &self.study.training) {
            return training.clips.len();
        }
        let counts = |step: &&Step| matches!(&step.kind, StepKind::Trial(trial) if trial.training == training);
        self.steps.iter().filter(counts).count()
    }

    /// The fixed texts in a language: the study's own, or those built in.
    pub fn words(&self, language: &str) -> &Words {
        let own = self.translated.iter().find(|own| own.language() == language);
        own.unwrap_or_else(|| words(language))
    }
}

impl TrialStep {
    /// Whether its clips follow from answers.
    pub fn is_adaptive(&self) -> bool {
        self.clip.is_empty()
    }

    /// Its clip; the one beside it, and whether that one stands left. `chosen` is what follows from answers: empty
    /// names before.
    pub fn pair<'a>(
        &'a self,
        chosen: Option<&'a ChosenClips>,
    ) -> (&'a str, Option<(&'a str, bool)>) {
        if self.is_adaptive() {
            return chosen
                .map_or(("", Some(("", false))), |it| (&it.clip, Some((&it.against, it.left))));
        }
        let beside = self.beside.as_ref();
        (&self.clip, beside.map(|beside| (beside.clip.as_str(), beside.left)))
    }
}

/// The steps before the first trial for practice.
fn before_training(study: &StudyProjection) -> Vec<Step> {
    let mut steps = Vec::new();
    let mut push = |id: &str, kind: StepKind| steps.push(Step::new(id.to_owned(), kind));
    if study.consent.is_some() {
        push("consent", StepKind::Consent);
    }
    if study.device.is_some() || study.draws_clips {
        push("device", StepKind::Device);
    }
    if let Some(page) = study.demographics.clone().filter(|page| !page.questions.is_empty()) {
        push("demographics", StepKind::Questions { page, demographics: true });
    }
    for (index, section) in study.instructions.iter().enumerate() {
        push(&format!("instructions/{}", index + 1), StepKind::Page(section.clone()));
    }
    if let Some(calibration) = study.calibration.clone() {
        push("calibration", StepKind::Calibration(calibration));
    }
    if !study.sound.is_null() {
        push("sound", StepKind::Sound);
    }
    if !study.mimicry.is_null() {
        push(MIMICRY_STEP, StepKind::Mimicry);
    }
    steps
}

/// The trials and components of the sequence, in the participant's order.
fn ordered(study: &StudyProjection, draw: Draw<'_>, items: &[OrderedItem]) -> Vec<Step> {
    let mut sides = Sides::new(study, draw, items);
    let mut trials = 0;
    let mut shown: Vec<&str> = Vec::new();
    // Trials of each block that follow from answers.
    let mut active: BTreeMap<&str, usize> = BTreeMap::new();
    let mut steps = Vec::new();
    for item in items {
        steps.extend(match item {
            OrderedItem::Trial { trial, component, clip, beside, panel, condition } => {
                let found = study.components.get(component);
                if let Some((block, asked)) = found.and_then(as_json) {
                    trials += 1;
                    let mut step = json_trial(study, block, &asked, trials, condition);
                    step.clip.clone_from(clip);
                    step.panel = (!panel.is_empty()).then(|| Box::new(Panel::unrated(panel)));
                    if matches!(found, Some(Component::ReverseCorrelation(_))) {
                        let is_drawn = !draw.config_hash.is_empty();
                        step.face = Some(if is_drawn { trial.clone() } else { String::new() });
                    }
                    let time_limit = TimeLimit::deserialize(&block["timeLimit"]).ok();
                    let kind = StepKind::Trial(step);
                    steps.push(Step { id: trial.clone(), kind, time_limit });
                    continue;
                }
                let Some(Component::Trials(block)) = found else { continue };
                trials += 1;
                let asked = questions(study, &block.questions);
                let pages = block.panel.as_deref();
                let (panel, questions) =
                    match pages.and_then(|pages| Panel::of(pages, panel, asked.clone())) {
                        Some((panel, questions)) => (Some(Box::new(panel)), questions),
                        None => (None, asked),
                    };
                // Of a pair that follows from answers no clip is known.
                let is_active = block.pairs.is_some() && clip.is_empty();
                let place = active.entry(component.as_str()).or_insert(0_usize);
                let step = TrialStep {
                    active: is_active.then_some(*place),
                    clip: clip.clone(),
                    questions,
                    panel,
                    instruction: block.instruction.clone(),
                    maximum_replays: block.maximum_replays,
                    training: false,
                    number: trials,
                    condition: condition.clone(),
                    beside: match beside {
                        Some(right) => Some(Companion::of_pair(right, block.pairs.as_deref())),
                        None if is_active => Some(Companion::of_pair("", block.pairs.as_deref())),
                        None => block.beside.as_ref().and_then(|beside| {
                            companion(beside, clip, &study.clips, sides.is_left(component, beside))
                        }),
                    },
                    face: None,
                    right: Answers::new(),
                };
                *place += usize::from(is_active);
                let time_limit = block.time_limit.clone();
                Some(Step { id: trial.clone(), kind: StepKind::Trial(step), time_limit })
            }
            OrderedItem::Component { component } => {
                shown.push(component);
                let times = shown.iter().filter(|each| *each == component).count();
                let id = match times {
                    1 => component.clone(),
                    again => format!("{component}#{again}"),
                };
                study.components.get(component).and_then(|found| component_step(id, found))
            }
        });
    }
    steps
}

/// The step of a component that is no block of trials.
fn component_step(id: String, component: &Component) -> Option<Step> {
    let (kind, time_limit) = match component {
        Component::Questionnaire(page) => (
            StepKind::Questions { page: page.clone(), demographics: false },
            page.time_limit.clone(),
        ),
        Component::Page(page) => {
            let section = Section { heading: page.heading.clone(), text: page.text.clone() };
            (StepKind::Page(section), page.time_limit.clone())
        }
        Component::Break(rest) => (StepKind::Break(rest.clone()), None),
        Component::Trials(_)
        | Component::Pairs(_)
        | Component::Panel(_)
        | Component::Adaptive(_)
        | Component::Scaling(_)
        | Component::ReverseCorrelation(_) => return None,
    };
    Some(Step { id, kind, time_limit })
}

fn companion(beside: &Beside, clip: &str, clips: &[Clip], left: bool) -> Option<Companion> {
    let clip = clips.iter().find(|each| each.id == clip)?;
    Some(Companion {
        clip: beside.of(clip, clips)?.id.clone(),
        left,
        caption: beside.caption.clone(),
        clip_caption: beside.clip_caption.clone(),
        in_turn: false,
    })
}

impl Step {
    fn new(id: String, kind: StepKind) -> Self {
        let time_limit = match &kind {
            StepKind::Questions { page, .. } => page.time_limit.clone(),
            _ => None,
        };
        Self { id, kind, time_limit }
    }

    /// The questions it asks.
    pub fn questions(&self) -> &[Question] {
        match &self.kind {
            StepKind::Questions { page, .. } => &page.questions,
            StepKind::Trial(trial) => &trial.questions,
            _ => &[],
        }
    }

    /// The trial, if it is one.
    pub fn trial(&self) -> Option<&TrialStep> {
        match &self.kind {
            StepKind::Trial(trial) => Some(trial),
            _ => None,
        }
    }
}

fn questions(study: &StudyProjection, ids: &[String]) -> Vec<Question> {
    ids.iter()
        .filter_map(|id| study.questions.iter().find(|question| question.id == *id).cloned())
        .collect()
}

fn option_orders(study: &StudyProjection, draw: Draw<'_>) -> BTreeMap<String, Vec<usize>> {
    let mut orders = BTreeMap::new();
    for question in study.all_questions() {
        if question.kind.option_order() == OptionOrder::Random {
            let count = question.kind.options().len();
            orders.insert(question.id.clone(), option_order(draw, &question.id, count));
        }
    }
    orders
}
