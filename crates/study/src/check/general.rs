//! Languages and texts, contact, recruitment, consent, exclusions.

use std::collections::BTreeMap;

use serde_json::Value;

use super::Subject;
use super::issue::{Issues, below};
use super::problem::Problem;
use super::values::{Counted, Names, Nearest};
use crate::columns::is_reserved_column;
use crate::instant::instant_ms;
use crate::question::Question;
use crate::study_file::{LocalText, Recruitment, RepeatPrevention, Section, StraightLining};
use crate::text;

pub(super) fn examine(subject: &Subject<'_>, texts: &[String], issues: &mut Issues) {
    let study = subject.study;
    let plain =
        |letter: char| letter.is_ascii_lowercase() || letter.is_ascii_digit() || letter == '-';
    if study.id.is_empty() || !study.id.chars().all(plain) {
        issues.error("/id", Problem::StudyId { id: study.id.clone() });
    }
    if study.seed > 9_007_199_254_740_991 {
        issues.error("/seed", Problem::Seed { seed: study.seed });
    }
    if let Some(date) = &study.study_metadata.date {
        let shape: String =
            date.chars().map(|letter| if letter.is_ascii_digit() { '0' } else { letter }).collect();
        if shape != "0000-00-00" {
            issues.error("/studyMetadata/date", Problem::Date { date: date.clone() });
        }
    }
    languages(subject, texts, issues);
    contact(subject, issues);
    recruitment(subject, issues);
    consent(subject, issues);
    exclusions(subject, issues);
}

fn languages(subject: &Subject<'_>, texts: &[String], issues: &mut Issues) {
    let languages = &subject.study.languages;
    if languages.is_empty() {
        issues.error("/languages", Problem::NoLanguage);
        return;
    }
    for (index, language) in languages.iter().enumerate() {
        let pointer = below("/languages", index);
        if languages[..index].contains(language) {
            issues.error(pointer, Problem::NamedTwice { name: language.clone() });
        } else if !text::LANGUAGES.contains(&language.as_str())
            && !subject.study.translations.contains_key(language)
        {
            issues.warning(
                pointer,
                Problem::UntranslatedButtons {
                    language: language.clone(),
                    complete: Names::of(text::LANGUAGES),
                },
            );
        }
    }
    for (language, own) in &subject.study.translations {
        translation(language, own, subject, issues);
    }
    for pointer in texts {
        let Some(value) = subject.value.pointer(pointer) else { continue };
        local_text(pointer, value, languages, issues);
    }
}

/// The study's own buttons and messages in a language.
fn translation(
    language: &str,
    own: &BTreeMap<String, String>,
    subject: &Subject<'_>,
    issues: &mut Issues,
) {
    let languages = &subject.study.languages;
    let pointer = below("/translations", language);
    if !languages.iter().any(|known| known == language) {
        issues.warning(
            &pointer,
            Problem::UndeclaredTranslation {
                language: language.to_owned(),
                declared: Names::of(languages),
            },
        );
    }
    for (name, _) in own.iter().filter(|(_, text)| text.trim().is_empty()) {
        issues.error(below(&pointer, name), Problem::EmptyText);
    }
    let study = subject.study;
    let (sound, mimicry) = (study.has_sound(), study.mimicry.is_some());
    for fault in text::faults(language, own, text::OptionalTexts { sound, mimicry }) {
        match fault {
            text::Fault::Unknown { name } => {
                issues.error(
                    below(&pointer, &name),
                    Problem::UnknownText { known: Nearest::to(&name, text::names()), name },
                );
            }
            text::Fault::Placeholders { name, english } => {
                issues.error(
                    below(&pointer, &name),
                    Problem::WrongPlaceholders {
                        text: own.get(&name).cloned().unwrap_or_default(),
                        english: english.to_string(),
                    },
                );
            }
            text::Fault::Missing(names) => {
                issues.warning(
                    &pointer,
                    Problem::IncompleteTranslation {
                        language: language.to_owned(),
                        count: Counted(names.len(), "text"),
                        some: Names::of(names.iter().take(3)),
                    },
                );
            }
        }
    }
}

fn local_text(pointer: &str, value: &Value, languages: &[String], issues: &mut Issues) {
    if let Some(text) = value.as_str() {
        // Names, numbers and single marks are the same everywhere.
        let is_name = pointer.ends_with("/name") || !text.chars().any(char::is_alphabetic);
        if languages.len() > 1 && !is_name {
            issues.warning(pointer, Problem::OneTextForAll { languages: languages.len() });
        }
        return;
    }
    let Some(map) = value.as_object() else { return };
    for language in languages {
        match map.get(language).and_then(Value::as_str) {
            None => {
                issues.error(pointer, Problem::MissingTranslation { language: language.clone() });
            }
            Some(text) if text.trim().is_empty() => {
                let place = below(pointer, language);
                issues.error(place, Problem::EmptyText);
            }
            Some(_) => {}
        }
    }
    for language in map.keys().filter(|key| !languages.contains(key)) {
        issues.warning(
            below(pointer, language),
            Problem::UndeclaredLanguage {
                language: language.clone(),
                declared: Names::of(languages),
            },
        );
    }
}

fn contact(subject: &Subject<'_>, issues: &mut Issues) {
    let Some(contact) = &subject.study.contact else {
        issues.error("", Problem::NoContact);
        return;
    };
    if contact.ethics_board.is_none() {
        issues.error("/contact", Problem::NoEthicsBoard);
    }
    let people = [
        ("investigator", Some(&contact.investigator)),
        ("ethicsBoard", contact.ethics_board.as_ref()),
    ];
    for (key, person) in people {
        let Some(person) = person else { continue };
        let parts: Vec<&str> = person.email.split('@').collect();
        if parts.len() != 2 || parts.iter().any(|part| part.is_empty()) {
            let place = format!("/contact/{key}/email");
            issues.error(place, Problem::Email { address: person.email.clone() });
        }
    }
}

fn recruitment(subject: &Subject<'_>, issues: &mut Issues) {
    let recruitment = &subject.study.recruitment;
    let mut taken: Vec<&str> = Vec::new();
    for (index, name) in recruitment.url_parameters.iter().enumerate() {
        let plain = |letter: char| letter.is_ascii_alphanumeric() || letter == '_' || letter == '-';
        let pointer = below("/recruitment/urlParameters", index);
        if name.is_empty() || !name.chars().all(plain) {
            issues.error(pointer, Problem::ParameterName { name: name.clone() });
        } else if taken.contains(&name.as_str()) {
            issues.error(pointer, Problem::NamedTwice { name: name.clone() });
        } else if is_reserved_column(name)
            || subject.study.questions.iter().any(|question| question.id == *name)
            || subject.clips.iter().any(|clip| clip.factors.contains_key(name))
        {
            // The export with identifiers has a column for each parameter.
            issues.error(pointer, Problem::ParameterIsColumn { name: name.clone() });
        }
        taken.push(name);
    }
    if recruitment.repeat_prevention == RepeatPrevention::RecruitmentIdentifier
        && recruitment.url_parameters.is_empty()
    {
        issues.error("/recruitment", Problem::NoRecruitmentIdentifier);
    }
    enrolment(recruitment, issues);
    way_back(recruitment, issues);
    let Some(redirect) = &recruitment.redirect else { return };
    let pointer = "/recruitment/redirect";
    if !redirect.starts_with("https://") {
        issues.error(pointer, Problem::NotSecure { address: redirect.clone() });
    }
    for name in redirect.split('{').skip(1).filter_map(|rest| rest.split('}').next()) {
        if name == "code" && recruitment.completion_code.is_none() {
            issues.error(pointer, Problem::NoCompletionCode);
        } else if name != "code" && !taken.contains(&name) {
            issues.error(pointer, Problem::UnknownParameter { name: name.to_owned() });
        }
    }
}

/// Whether the last page goes back by itself, and when.
fn way_back(recruitment: &Recruitment, issues: &mut Issues) {
    let Some(seconds) = recruitment.return_after_seconds else { return };
    let pointer = "/recruitment/returnAfterSeconds";
    if recruitment.redirect.is_none() {
        issues.error(pointer, Problem::NoWayBack);
    }
    if !(LEAST_RETURN_SECONDS..=3600).contains(&seconds) {
        let (value, least) = (f64::from(seconds), f64::from(LEAST_RETURN_SECONDS));
        issues.error(pointer, Problem::OutOfRange { value, unit: "s", least, most: 3600.0 });
    }
}

/// Least seconds before the last page goes back by itself: WCAG 2.2, 2.2.1, gives 20 to press one key.
const LEAST_RETURN_SECONDS: u32 = 20;

/// Who can begin, and when.
fn enrolment(recruitment: &Recruitment, issues: &mut Issues) {
    if recruitment.participants == Some(0) {
        issues.error("/recruitment/participants", Problem::NoParticipants);
    }
    if recruitment.reservation_minutes == Some(0) {
        issues.error("/recruitment/reservationMinutes", Problem::NoReservation);
    }
    for (key, text) in [("opens", &recruitment.opens), ("closes", &recruitment.closes)] {
        if let Some(text) = text.as_ref().filter(|text| instant_ms(text).is_none()) {
            issues.error(format!("/recruitment/{key}"), Problem::NotATime { text: text.clone() });
        }
    }
    if let (Some(opens), Some(closes)) = (recruitment.opens_ms(), recruitment.closes_ms())
        && closes <= opens
    {
        issues.error("/recruitment/closes", Problem::ClosesBeforeOpening);
    }
}

fn consent(subject: &Subject<'_>, issues: &mut Issues) {
    let Some(consent) = &subject.study.consent else {
        issues.error("", Problem::NoConsent);
        return;
    };
    if consent.minimum_age.is_none() {
        issues.error("/consent", Problem::NoMinimumAge);
    }
    if consent.retention.is_none() {
        issues.error("/consent", Problem::NoRetention);
    }
    if consent.retention_days == Some(0) {
        issues.error("/consent/retentionDays", Problem::NoRetentionDays);
    }
    if consent.version.trim().is_empty() {
        issues.error("/consent/version", Problem::NoConsentVersion);
    }
    if consent.sections.is_empty() {
        issues.error("/consent/sections", Problem::NothingToAgreeTo);
    }
    let is_empty =
        |text: &LocalText| matches!(text, LocalText::Plain(text) if text.trim().is_empty());
    for (index, Section { heading, text }) in consent.sections.iter().enumerate() {
        for (key, text) in [("heading", heading), ("text", text)] {
            if is_empty(text) {
                let place = format!("/consent/sections/{index}/{key}");
                issues.error(place, Problem::EmptyText);
            }
        }
    }
}

fn exclusions(subject: &Subject<'_>, issues: &mut Issues) {
    advice_on_careless_people(subject, issues);
    let Some(rules) = &subject.study.exclusions else { return };
    if let Some(share) = rules.late_frame_share.filter(|share| !(0.0..=1.0).contains(share)) {
        issues.error("/exclusions/lateFrameShare", Problem::NotAShare { share });
    }
    for (key, value) in [
        ("longestFrameMs", rules.longest_frame_ms),
        ("shortestRtMs", rules.shortest_rt_ms),
        ("soundOffsetMs", rules.sound_offset_ms),
    ] {
        if let Some(value) = value.filter(|value| *value <= 0.0) {
            let place = format!("/exclusions/{key}");
            issues.error(place, Problem::ExcludesNothing { ms: value });
        }
    }
    let of_sound = [
        ("soundOffsetMs", rules.sound_offset_ms.is_some()),
        ("soundNotHeard", rules.sound_not_heard),
    ];
    for (key, _) in of_sound.iter().filter(|(_, given)| *given && !subject.study.has_sound()) {
        issues.error(format!("/exclusions/{key}"), Problem::NoSound);
    }
    if let Some(rule) = &rules.straight_lining {
        straight_lining(subject, rule, issues);
    }
}

fn straight_lining(subject: &Subject<'_>, rule: &StraightLining, issues: &mut Issues) {
    let place = "/exclusions/straightLining";
    if rule.longest_run < 3 {
        let run = rule.longest_run;
        issues.error(below(place, "longestRun"), Problem::ShortRun { run });
    }
    let shared = &subject.study.questions;
    for (index, id) in rule.questions.iter().enumerate() {
        let place = format!("{place}/questions/{index}");
        match shared.iter().find(|question| question.id == *id) {
            None => {
                let known: Vec<_> = shared.iter().map(|question| question.id.as_str()).collect();
                issues.error(place, Problem::unknown("question", id, known));
            }
            Some(question) if !question.is_closed() => {
                issues.error(place, Problem::NotClosed { question: id.clone() });
            }
            Some(_) => {}
        }
    }
}

/// What a study whose people are sent back to a panel, which pays them, does well to rule beforehand.
fn advice_on_careless_people(subject: &Subject<'_>, issues: &mut Issues) {
    let study = subject.study;
    let is_asked = study.questions.iter().any(Question::is_closed);
    if study.recruitment.redirect.is_none() || !is_asked {
        return;
    }
    let rules = study.exclusions.clone().unwrap_or_default();
    if rules.shortest_rt_ms.is_none() {
        issues.warning("/exclusions", Problem::NoSpeedRule);
    }
    if rules.straight_lining.is_none() {
        issues.warning("/exclusions", Problem::NoStraightLiningRule);
    }
}
