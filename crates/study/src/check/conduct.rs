//! Device, calibration, time limits, practice, screening, attention checks, hosting without a server.

use super::issue::{Issues, below};
use super::nearest::suggestion;
use super::{Subject, conditions};
use crate::flow::right_answers;
use crate::study_file::{Component, Question, TimeLimit, Training};

pub(super) fn examine(subject: &Subject<'_>, issues: &mut Issues) {
    device(subject, issues);
    calibration(subject, issues);
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
            let message = format!("{size} pixels");
            issues.error(below("/device", key), "out-of-range", message, "take 1 to 4096");
        }
    }
    if let Some(hz) = rules.minimum_refresh_hz.filter(|hz| !(1.0..=500.0).contains(hz)) {
        let message = format!("{hz} Hz");
        issues.error("/device/minimumRefreshHz", "out-of-range", message, "take 1 to 500");
    }
}

fn calibration(subject: &Subject<'_>, issues: &mut Issues) {
    let calibration = subject.study.calibration.as_ref();
    if let Some(rules) = calibration {
        if !rules.card && !rules.ask_distance && rules.distance_cm.is_none() {
            let message = "the calibration asks nothing";
            let hint = "remove \"card\": false, or the section";
            issues.error("/calibration", "empty", message, hint);
        }
        if let Some(cm) = rules.distance_cm.filter(|cm| !(15.0..=300.0).contains(cm)) {
            let message = format!("{cm} cm from the screen");
            issues.error("/calibration/distanceCm", "out-of-range", message, "take 15 to 300");
        }
    }
    let look = &subject.study.stimuli.look;
    for (key, size) in [("widthMm", look.width_mm), ("heightMm", look.height_mm)] {
        if let Some(size) = size.filter(|size| !(10.0..=2000.0).contains(size)) {
            let message = format!("{size} mm");
            let place = below("/stimuli/look", key);
            issues.error(place, "out-of-range", message, "take 10 to 2000");
        }
    }
    if look.width_mm.is_some() != look.height_mm.is_some() {
        let message = "one side in millimetres";
        issues.error("/stimuli/look", "incomplete", message, "give both widthMm and heightMm");
    } else if look.width_mm.is_some() && calibration.is_none_or(|rules| !rules.card) {
        let message = "a size in millimetres on screens that nobody measures";
        let hint = "add \"calibration\": {\"card\": true, \"required\": true}";
        issues.error("/stimuli/look/widthMm", "no-calibration", message, hint);
    }
}

fn time_limits(subject: &Subject<'_>, issues: &mut Issues) {
    let study = subject.study;
    let mut limits: Vec<(String, Option<&TimeLimit>)> = Vec::new();
    let demographics = study.demographics.as_ref().and_then(|page| page.time_limit.as_ref());
    limits.push(("/demographics".to_owned(), demographics));
    let training = study.training.as_ref().and_then(|training| training.time_limit.as_ref());
    limits.push(("/training".to_owned(), training));
    for (name, component) in &study.components {
        let limit = match component {
            Component::Trials(block) => block.time_limit.as_ref(),
            Component::Questionnaire(page) => page.time_limit.as_ref(),
            Component::Page(page) => page.time_limit.as_ref(),
            Component::Break(_) => None,
        };
        limits.push((below("/components", name), limit));
    }
    for (pointer, limit) in limits {
        let (pointer, Some(limit)) = (below(&pointer, "timeLimit"), limit) else { continue };
        if !(1.0..=86_400.0).contains(&limit.seconds) {
            let message = format!("{} seconds", limit.seconds);
            let place = below(&pointer, "seconds");
            issues.error(place, "out-of-range", message, "take 1 to 86400");
        }
        if limit.extensions < 10 && limit.essential.is_none() {
            let message = format!(
                "{} extensions: people who read or move slowly are shut out (WCAG 2.2, 2.2.1)",
                limit.extensions
            );
            let hint = "allow ten, or say why the limit is essential: \"essential\": \"...\"";
            issues.warning(below(&pointer, "extensions"), "hard-time-limit", message, hint);
        }
    }
}

fn practice(subject: &Subject<'_>, training: &Training, issues: &mut Issues) {
    let asked: Vec<&Question> = training
        .questions
        .iter()
        .filter_map(|id| subject.study.questions.iter().find(|question| question.id == *id))
        .collect();
    for (clip, answers) in &training.answers {
        let place = below("/training/answers", clip);
        if !training.clips.contains(clip) {
            let known: Vec<&str> = training.clips.iter().map(String::as_str).collect();
            let message = format!("\"{clip}\" is no practice clip");
            issues.error(&place, "unknown-reference", message, suggestion(clip, &known));
        }
        for (id, answer) in answers {
            let place = below(&place, id);
            match asked.iter().find(|question| question.id == *id) {
                None => {
                    let known: Vec<&str> = training.questions.iter().map(String::as_str).collect();
                    let message = format!("\"{id}\" is not asked in practice");
                    issues.error(place, "unknown-reference", message, suggestion(id, &known));
                }
                Some(question) if question.accept(Some(answer)).is_err() => {
                    let message = format!("{answer} is no answer to this question");
                    let hint = "write an answer that can be given";
                    issues.error(place, "bad-answer", message, hint);
                }
                Some(_) => {}
            }
        }
    }
    let asked: Vec<Question> = asked.into_iter().cloned().collect();
    let judged = training
        .clips
        .iter()
        .filter(|clip| !right_answers(training, clip, subject.clips, &asked).is_empty())
        .count();
    if training.feedback && judged == 0 {
        let message = "of no practice clip a right answer is known";
        let hint = "give a question \"truth\", or state them in \"answers\"";
        issues.error("/training/feedback", "no-right-answer", message, hint);
    }
    let Some(rule) = &training.criterion else { return };
    if rule.correct == 0 || rule.correct as usize > judged {
        let message =
            format!("{} right clips of {judged} that can be right are wanted", rule.correct);
        let hint = format!("take 1 to {judged}, or state more right answers in \"answers\"");
        issues.error("/training/criterion/correct", "out-of-range", message, hint);
    }
    if !(1..=20).contains(&rule.maximum_rounds) {
        let message = format!("{} rounds", rule.maximum_rounds);
        let place = "/training/criterion/maximumRounds";
        issues.error(place, "out-of-range", message, "take 1 to 20");
    }
    if !training.feedback {
        let message = "practice is repeated, but nobody is told what was wrong";
        issues.warning("/training", "no-feedback", message, "add \"feedback\": true");
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
            let known: Vec<&str> = page_questions(subject).map(|each| each.id.as_str()).collect();
            let message = format!("no page asks \"{}\"", condition.question);
            let hint = suggestion(&condition.question, &known);
            issues.error(below(&place, "question"), "unknown-reference", message, hint);
            continue;
        };
        // Whoever is to be turned away must be able to say so.
        let hint = "widen the question's minimum and maximum, so that people can say the truth";
        conditions::values(condition, question, &place, hint, issues);
    }
}

fn attention(subject: &Subject<'_>, issues: &mut Issues) {
    let Some(rule) = &subject.study.attention_checks else { return };
    let checks =
        subject.study.all_questions().filter(|each| each.attention_check.is_some()).count();
    if checks == 0 {
        let message = "no question is an attention check";
        let hint = "give one \"attentionCheck\": {\"expected\": ...}, or remove the section";
        issues.error("/attentionChecks", "nothing-to-fail", message, hint);
    } else if rule.allowed_failures == 0 {
        let message = "one failed check ends the session";
        let hint = "allow one failure: Prolific accepts that only of studies under five minutes";
        issues.warning("/attentionChecks/allowedFailures", "unfair-check", message, hint);
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
        || study.training.as_ref().and_then(|it| it.criterion.as_ref()).is_some();
    if screens && recruitment.screened_out_code.is_none() {
        let message = "people who are screened out have no code to go back with";
        let hint = "add \"screenedOutCode\": \"...\"";
        issues.warning("/recruitment", "no-code", message, hint);
    }
    if study.attention_checks.is_some() && recruitment.failed_checks_code.is_none() {
        let message = "people who fail the attention checks have no code to go back with";
        let hint = "add \"failedChecksCode\": \"...\"";
        issues.warning("/recruitment", "no-code", message, hint);
    }
}

fn hosting(subject: &Subject<'_>, issues: &mut Issues) {
    let Some(hosting) = &subject.study.static_hosting else { return };
    let Some(post) = &hosting.post else {
        if !hosting.download {
            let message = "answers go nowhere: neither posted nor downloaded";
            issues.error("/staticHosting", "empty", message, "add \"post\", or let them download");
        }
        return;
    };
    let place = "/staticHosting/post";
    let plain = |letter: char| letter.is_ascii_graphic() && !"\"'<>\\`;,".contains(letter);
    let secure = post.starts_with("https://") || post.starts_with("http://127.0.0.1:");
    if !secure || !post.replace("{session}", "").chars().all(plain) {
        let message = format!("\"{post}\" is not a secure address");
        issues.error(place, "bad-address", message, "write https://HOST/PATH without blanks");
    }
}
