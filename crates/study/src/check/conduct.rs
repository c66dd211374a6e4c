//! Device, calibration, time limits, practice, screening, attention checks, hosting without a server.

use super::conditions::{self, Asks};
use super::issue::{Issues, below};
use super::problem::Problem;
use super::values::{Counted, Nearest};
use super::{Subject, compared};
use crate::practice::right_answers;
use crate::question::Question;
use crate::study_file::{ClipShowing, Component, Hearing, TimeLimit, Training, Triggers};

pub(super) fn examine(subject: &Subject<'_>, issues: &mut Issues) {
    device(subject, issues);
    calibration(subject, issues);
    triggers(subject, issues);
    time_limits(subject, issues);
    if let Some(training) = &subject.study.training {
        practice(subject, training, issues);
    }
    screening(subject, issues);
    attention(subject, issues);
    codes(subject, issues);
    hosting(subject, issues);
}

fn device(subject: &Subject<'_>, issues: &mut Issues) {
    let Some(rules) = &subject.study.device else { return };
    for (key, size) in
        [("minimumWidth", rules.minimum_width), ("minimumHeight", rules.minimum_height)]
    {
        if let Some(size) = size.filter(|size| !(1..=4096).contains(size)) {
            issues.error(
                below("/device", key),
                Problem::OutOfRange {
                    value: f64::from(size),
                    unit: "pixels",
                    least: 1.0,
                    most: 4096.0,
                },
            );
        }
    }
    if let Some(share) = rules.minimum_frame_share.filter(|share| !(0.0..=1.0).contains(share)) {
        issues.error("/device/minimumFrameShare", Problem::NotAShare { share });
    }
    if let Some(hz) = rules.minimum_refresh_hz.filter(|hz| !(1.0..=500.0).contains(hz)) {
        issues.error(
            "/device/minimumRefreshHz",
            Problem::OutOfRange { value: hz, unit: "Hz", least: 1.0, most: 500.0 },
        );
    }
}

fn calibration(subject: &Subject<'_>, issues: &mut Issues) {
    let calibration = subject.study.calibration.as_ref();
    if let Some(rules) = calibration {
        if !rules.card && !rules.ask_distance && rules.distance_cm.is_none() {
            issues.error("/calibration", Problem::CalibratesNothing);
        }
        if let Some(cm) = rules.distance_cm.filter(|cm| !(15.0..=300.0).contains(cm)) {
            issues.error(
                "/calibration/distanceCm",
                Problem::OutOfRange {
                    value: cm,
                    unit: "cm from the screen",
                    least: 15.0,
                    most: 300.0,
                },
            );
        }
    }
    let look = &subject.study.stimuli.look;
    for (key, size) in [("widthMm", look.width_mm), ("heightMm", look.height_mm)] {
        if let Some(size) = size.filter(|size| !(10.0..=2000.0).contains(size)) {
            let place = below("/stimuli/look", key);
            issues.error(
                place,
                Problem::OutOfRange { value: size, unit: "mm", least: 10.0, most: 2000.0 },
            );
        }
    }
    if look.width_mm.is_some() != look.height_mm.is_some() {
        issues.error("/stimuli/look", Problem::OneSideInMillimetres);
    } else if look.width_mm.is_some() && calibration.is_none_or(|rules| !rules.card) {
        issues.error("/stimuli/look/widthMm", Problem::NoCalibration);
    }
}

/// Where another program listens.
fn triggers(subject: &Subject<'_>, issues: &mut Issues) {
    let Some(triggers) = subject.study.triggers else { return };
    if !Triggers::PORTS.contains(&triggers.port) {
        issues.error(
            "/triggers/port",
            Problem::OutOfRange {
                value: f64::from(triggers.port),
                unit: "as a port",
                least: f64::from(*Triggers::PORTS.start()),
                most: f64::from(*Triggers::PORTS.end()),
            },
        );
    }
}

fn time_limits(subject: &Subject<'_>, issues: &mut Issues) {
    let study = subject.study;
    let mut limits: Vec<(String, Option<TimeLimit>)> = Vec::new();
    let demographics = study.demographics.as_ref().and_then(|page| page.time_limit.clone());
    limits.push(("/demographics".to_owned(), demographics));
    let training = study.training.as_ref().and_then(|training| training.time_limit.clone());
    limits.push(("/training".to_owned(), training));
    for (name, component) in &study.components {
        let limit = match component {
            Component::Trials(block) => block.time_limit.clone(),
            Component::Pairs(block) => block.read().ok().and_then(|block| block.time_limit),
            Component::Panel(block) => block.read().ok().and_then(|block| block.time_limit),
            Component::ReverseCorrelation(block) => {
                block.read().ok().and_then(|block| block.time_limit)
            }
            Component::Scaling(block) => block.read().ok().and_then(|block| block.time_limit),
            Component::Questionnaire(page) => page.time_limit.clone(),
            Component::Page(page) => page.time_limit.clone(),
            Component::Adaptive(_) | Component::Break(_) => None,
        };
        limits.push((below("/components", name), limit));
    }
    for (pointer, limit) in limits {
        let (pointer, Some(limit)) = (below(&pointer, "timeLimit"), limit) else { continue };
        if !(1.0..=86_400.0).contains(&limit.seconds) {
            let place = below(&pointer, "seconds");
            issues.error(
                place,
                Problem::OutOfRange {
                    value: limit.seconds,
                    unit: "seconds",
                    least: 1.0,
                    most: 86_400.0,
                },
            );
        }
        if limit.extensions < 10 && limit.essential.is_none() {
            issues.warning(
                below(&pointer, "extensions"),
                Problem::HardTimeLimit {
                    extensions: Counted(limit.extensions as usize, "extension"),
                },
            );
        }
    }
}

fn practice(subject: &Subject<'_>, training: &Training, issues: &mut Issues) {
    let asked: Vec<Question> = training
        .questions
        .iter()
        .filter_map(|id| subject.study.questions.iter().find(|question| question.id == *id))
        .cloned()
        .collect();
    practice_pairs(subject, training, issues);
    stated_answers(training, &asked, issues);
    let judged = training
        .clips
        .iter()
        .filter(|clip| !right_answers(training, clip, subject.clips, &asked).is_empty())
        .count();
    if training.feedback && judged == 0 {
        issues.error("/training/feedback", Problem::NoRightAnswer);
    }
    let Some(rule) = &training.criterion else { return };
    if rule.correct == 0 || rule.correct as usize > judged {
        let problem = Problem::Criterion { correct: rule.correct, judged };
        issues.error("/training/criterion/correct", problem);
    }
    if !(1..=20).contains(&rule.maximum_rounds) {
        let value = f64::from(rule.maximum_rounds);
        let problem = Problem::OutOfRange { value, unit: "rounds", least: 1.0, most: 20.0 };
        issues.error("/training/criterion/maximumRounds", problem);
    }
    if !training.feedback {
        issues.warning("/training", Problem::NoFeedback);
    }
}

/// What stands beside practice clips: beside those of the training alone, and each another clip.
fn practice_pairs(subject: &Subject<'_>, training: &Training, issues: &mut Issues) {
    let clips: Vec<&String> = subject.clips.iter().map(|clip| &clip.id).collect();
    for (clip, other) in &training.beside {
        let place = below("/training/beside", clip);
        if !training.clips.contains(clip) {
            let known = Nearest::to(clip, &training.clips);
            issues.error(&place, Problem::NotAPracticeClip { clip: clip.clone(), known });
        } else if !clips.contains(&other) {
            issues.error(&place, Problem::unknown("clip", other, &clips));
        } else if other == clip {
            issues.error(&place, Problem::BesideItself { clip: clip.clone() });
        } else if training.show == ClipShowing::InStep {
            let pair = [clip.clone(), other.clone()];
            compared::one_sound(subject, [pair.as_slice()], &place, issues);
        }
    }
}

/// The right answers that the file states: to practice clips, to questions that are asked there.
fn stated_answers(training: &Training, asked: &[Question], issues: &mut Issues) {
    for (clip, answers) in &training.answers {
        let place = below("/training/answers", clip);
        if !training.clips.contains(clip) {
            let known = Nearest::to(clip, &training.clips);
            issues.error(&place, Problem::NotAPracticeClip { clip: clip.clone(), known });
        }
        for (id, answer) in answers {
            let place = below(&place, id);
            match asked.iter().find(|question| question.id == *id) {
                None => {
                    let known = Nearest::to(id, &training.questions);
                    let problem = Problem::NotAskedInPractice { question: id.clone(), known };
                    issues.error(place, problem);
                }
                Some(question) if question.accept(Some(answer)).is_err() => {
                    issues.error(place, Problem::NoAnswer { answer: answer.clone() });
                }
                Some(_) => {}
            }
        }
    }
}

/// The questions of pages, which screening can ask about.
fn page_questions<'a>(subject: &'a Subject<'_>) -> impl Iterator<Item = &'a Question> {
    let study = subject.study;
    let pages = study.components.values().filter_map(|component| match component {
        Component::Questionnaire(page) => Some(page),
        _ => None,
    });
    study.demographics.iter().chain(pages).flat_map(|page| &page.questions)
}

fn screening(subject: &Subject<'_>, issues: &mut Issues) {
    for (index, rule) in subject.study.screening.iter().enumerate() {
        let place = below(&below("/screening", index), "if");
        let condition = &rule.condition;
        let Some(question) = page_questions(subject).find(|each| each.id == condition.question)
        else {
            issues.error(
                below(&place, "question"),
                Problem::NoPageAsks {
                    question: condition.question.clone(),
                    known: Nearest::to(
                        &condition.question,
                        page_questions(subject).map(|each| &each.id),
                    ),
                },
            );
            continue;
        };
        // Whoever is to be turned away must be able to say so.
        conditions::values(condition, question, &place, Asks::Whom, issues);
    }
}

fn attention(subject: &Subject<'_>, issues: &mut Issues) {
    let Some(rule) = &subject.study.attention_checks else { return };
    let checks =
        subject.study.all_questions().filter(|each| each.attention_check.is_some()).count();
    if checks == 0 {
        issues.error("/attentionChecks", Problem::NoAttentionCheck);
    } else if rule.allowed_failures == 0 {
        issues.warning("/attentionChecks/allowedFailures", Problem::OneFailureEnds);
    }
}

/// A way back with a code needs a code for every way out.
fn codes(subject: &Subject<'_>, issues: &mut Issues) {
    let study = subject.study;
    let recruitment = &study.recruitment;
    if !recruitment.redirect.as_ref().is_some_and(|address| address.contains("{code}")) {
        return;
    }
    let screens = study.device.is_some()
        || !study.screening.is_empty()
        || study.sound.as_ref().is_some_and(|it| it.check.hearing == Hearing::Required)
        || study.training.as_ref().and_then(|it| it.criterion.as_ref()).is_some();
    if screens && recruitment.screened_out_code.is_none() {
        issues.warning("/recruitment", Problem::NoScreenedOutCode);
    }
    if study.attention_checks.is_some() && recruitment.failed_checks_code.is_none() {
        issues.warning("/recruitment", Problem::NoFailedChecksCode);
    }
}

fn hosting(subject: &Subject<'_>, issues: &mut Issues) {
    let Some(hosting) = &subject.study.static_hosting else { return };
    let Some(post) = &hosting.post else {
        if !hosting.download {
            issues.error("/staticHosting", Problem::AnswersGoNowhere);
        }
        if hosting.post_progress {
            issues.error("/staticHosting/postProgress", Problem::ProgressGoesNowhere);
        }
        return;
    };
    let place = "/staticHosting/post";
    let plain = |letter: char| letter.is_ascii_graphic() && !"\"'<>\\`;,".contains(letter);
    let secure = post.starts_with("https://") || post.starts_with("http://127.0.0.1:");
    if !secure || !post.replace("{session}", "").chars().all(plain) {
        issues.error(place, Problem::PostNotSecure { address: post.clone() });
    }
}
