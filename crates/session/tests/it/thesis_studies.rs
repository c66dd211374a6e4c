//! The three studies of the thesis (Reverdy 2019, chapter 6): how many trials, of what, in which blocks, with
//! which questions, for any participant and in both languages.

use std::collections::{BTreeMap, BTreeSet};

use mimique_session::flow::{
    ChoiceView, Input, Plan, QuestionKindView, QuestionView, Step, StepKind, TrialStep, View,
};

use crate::support::{Page, first_answer, started, study_text};

const PARTICIPANTS: u64 = 60;
const EMOTIONS: [&str; 6] = ["anger", "disgust", "fear", "joy", "sadness", "surprise"];
const FOUR: [&str; 4] = ["emotion", "perceived_intensity", "ease", "believability"];

fn plan(name: &str, participant: u64) -> Plan {
    let (study, session) = started(&study_text(name), participant);
    Plan::new(study.projection(), session).unwrap()
}

/// Every performance by each of these ways of showing it.
fn each_once(ways: &[&str]) -> BTreeMap<String, usize> {
    let segments =
        EMOTIONS.iter().flat_map(|emotion| (1..=3).map(move |n| format!("{emotion}{n}")));
    segments.flat_map(|it| ways.iter().map(move |way| (format!("{it}.{way}"), 1))).collect()
}

fn counted<'a>(trials: impl IntoIterator<Item = &'a TrialStep>) -> BTreeMap<String, usize> {
    let mut counts = BTreeMap::new();
    for trial in trials {
        *counts.entry(trial.clip.clone()).or_insert(0) += 1;
    }
    counts
}

/// What follows what, runs of trials by their condition and length: `faces 18`, `rest`, ...
fn course(plan: &Plan) -> Vec<String> {
    let mut course: Vec<(String, usize)> = Vec::new();
    for Step { id, kind, .. } in &plan.steps {
        let (name, trials) = match kind {
            StepKind::Trial(trial) => (trial.condition.clone(), 1),
            _ => (id.split(['/', '#']).next().unwrap().to_owned(), 0),
        };
        match course.last_mut() {
            Some((last, count)) if *last == name => *count += trials,
            _ => course.push((name, trials)),
        }
    }
    let said = |(name, trials): (String, usize)| match trials {
        0 => name,
        trials => format!("{name} {trials}"),
    };
    course.into_iter().map(said).collect()
}

fn trials(plan: &Plan) -> Vec<&TrialStep> {
    plan.steps.iter().filter_map(Step::trial).collect()
}

fn questions(trial: &TrialStep) -> Vec<&str> {
    trial.questions.iter().map(|question| question.id.as_str()).collect()
}

const BEFORE: [&str; 4] = ["consent", "device", "demographics", "instructions"];

fn around(middle: &[&str]) -> Vec<String> {
    let all = BEFORE.iter().chain(middle).chain(&["debriefing"]);
    all.map(|part| (*part).to_owned()).collect()
}

#[test]
fn study_1_shows_18_performances_at_three_settings() {
    let mut orders = BTreeSet::new();
    for participant in 1..=PARTICIPANTS {
        let plan = plan("study1.json", participant);
        let trials = trials(&plan);
        assert_eq!(trials.len(), 54);
        assert_eq!(
            counted(trials.iter().copied()),
            each_once(&["lsts30", "lsts50", "lsts70"]),
            "participant {participant}"
        );
        let middle = ["faces 18", "rest", "faces 18", "rest", "faces 18"];
        assert_eq!(course(&plan), around(&middle));
        for trial in &trials {
            assert_eq!(questions(trial), FOUR);
            assert!(trial.beside.is_none() && !trial.training);
        }
        orders.insert(trials.iter().map(|trial| trial.clip.clone()).collect::<Vec<_>>());
    }
    assert_eq!(orders.len() as u64, PARTICIPANTS, "everybody has another order");
}

#[test]
fn study_2a_shows_36_animations_mixed_and_then_18_performances() {
    let mut orders = BTreeSet::new();
    for participant in 1..=PARTICIPANTS {
        let plan = plan("study2a.json", participant);
        let trials = trials(&plan);
        assert_eq!(trials.len(), 54);
        let (animations, people) = trials.split_at(36);
        let ways = ["lsts30.head", "box.head"];
        assert_eq!(counted(animations.iter().copied()), each_once(&ways));
        assert_eq!(counted(people.iter().copied()), each_once(&["real.actor"]));
        let middle = ["animations 18", "rest", "animations 18", "change", "people 18"];
        assert_eq!(course(&plan), around(&middle));
        for trial in &trials {
            assert_eq!(questions(trial), FOUR);
            assert!(trial.beside.is_none());
        }
        // Mixed: in either half of the animations there are both methods.
        for half in animations.chunks(18) {
            let lsts = half.iter().filter(|trial| trial.clip.ends_with(".lsts30.head")).count();
            assert!((1..18).contains(&lsts), "participant {participant}: {lsts} of 18");
        }
        orders.insert(trials.iter().map(|trial| trial.clip.clone()).collect::<Vec<_>>());
    }
    assert_eq!(orders.len() as u64, PARTICIPANTS);
}

#[test]
fn study_2b_shows_36_animations_each_beside_its_performance() {
    for participant in 1..=PARTICIPANTS {
        let plan = plan("study2b.json", participant);
        let trials = trials(&plan);
        assert_eq!(trials.len(), 36);
        assert_eq!(counted(trials.iter().copied()), each_once(&["lsts30.head", "box.head"]));
        assert_eq!(course(&plan), around(&["pairs 18", "rest", "pairs 18"]));
        for trial in &trials {
            assert_eq!(questions(trial), ["fidelity"]);
            let beside = trial.beside.as_ref().unwrap();
            let segment = trial.clip.split('.').next().unwrap();
            assert_eq!(beside.clip, format!("{segment}.real.actor"));
            assert!(!beside.left, "the person stands right");
        }
    }
}

/// Every text of a question.
fn texts(question: &QuestionView) -> Vec<String> {
    let labels = |options: &[ChoiceView]| options.iter().map(|each| each.label.clone()).collect();
    let mut texts: Vec<String> = match &question.kind {
        QuestionKindView::SingleChoice { options } => labels(options),
        QuestionKindView::Likert { left, right, points } => {
            assert_eq!(
                points.iter().map(|point| point.0).collect::<Vec<_>>(),
                [1, 2, 3, 4, 5, 6, 7]
            );
            vec![left.clone(), right.clone()]
        }
        QuestionKindView::Number { unit, .. } => unit.iter().cloned().collect(),
        other => panic!("{other:?}"),
    };
    texts.push(question.prompt.clone());
    texts
}

/// Everything that a participant reads, page by page, to the end.
fn read(name: &str, language: &str) -> Vec<Vec<String>> {
    let mut page = Page::open(&study_text(name), 1);
    page.send(Input::ChooseLanguage(language.to_owned()));
    let mut pages = Vec::new();
    loop {
        let shown = match page.view() {
            View::Consent { agreement, agree, decline, .. } => {
                let mut all = vec![agreement.title, agree, decline];
                all.extend(
                    agreement
                        .sections
                        .into_iter()
                        .flat_map(|it| [vec![it.heading], it.text].concat()),
                );
                all
            }
            View::Questions { title, questions, button, .. } => {
                let mut all = vec![title, button.label];
                all.extend(questions.iter().flat_map(texts));
                all
            }
            View::Page { heading, text, button, .. } => {
                [vec![heading, button.label], text].concat()
            }
            View::Trial(trial) => {
                let mut all = vec![trial.heading, trial.instruction.unwrap()];
                all.extend(trial.questions.iter().flat_map(texts));
                if let Some(beside) = trial.beside {
                    all.extend([beside.caption.unwrap(), beside.clip_caption.unwrap()]);
                }
                all
            }
            View::End(end) => [vec![end.heading], end.text].concat(),
            other => panic!("{other:?}"),
        };
        if pages.last() != Some(&shown) {
            pages.push(shown);
        }
        if !page.act(&mut first_answer) {
            return pages;
        }
    }
}

#[test]
fn every_page_of_the_three_stands_in_both_languages() {
    for (name, trials) in [("study1.json", 54), ("study2a.json", 54), ("study2b.json", 36)] {
        let (english, french) = (read(name, "en"), read(name, "fr"));
        assert_eq!(english.len(), french.len(), "{name}");
        assert!(english.len() > trials + 4, "{name}: {} pages", english.len());
        for (english, french) in english.iter().zip(&french) {
            assert_eq!(english.len(), french.len(), "{name}: {english:?} {french:?}");
            assert!(
                english.iter().chain(french).all(|text| !text.trim().is_empty()),
                "{english:?}"
            );
            let same: Vec<_> =
                english.iter().zip(french).filter(|(one, other)| one == other).collect();
            // "Surprise" is one word in both.
            assert!(
                same.iter().all(|(text, _)| text.to_lowercase() == "surprise"),
                "{name}: in English on the French page: {same:?}"
            );
        }
    }
}
