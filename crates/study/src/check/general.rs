//! Languages and texts, contact, recruitment, consent, exclusions.

use serde_json::Value;

use super::Subject;
use super::issue::{Issues, below, listed};
use super::nearest::suggestion;
use crate::instant::instant_ms;
use crate::responses::is_reserved_column;
use crate::sorted_map::SortedMap;
use crate::study_file::{LocalText, Recruitment, RepeatPrevention, Section};
use crate::text;

pub(super) fn examine(subject: &Subject<'_>, texts: &[String], issues: &mut Issues) {
    let study = subject.study;
    let plain =
        |letter: char| letter.is_ascii_lowercase() || letter.is_ascii_digit() || letter == '-';
    if study.id.is_empty() || !study.id.chars().all(plain) {
        let message = format!("\"{}\" cannot stand in an address", study.id);
        issues.error("/id", "bad-id", message, "use lower-case letters, digits and -");
    }
    if study.seed > 9_007_199_254_740_991 {
        let message = format!("{} is above 2^53 - 1", study.seed);
        issues.error("/seed", "out-of-range", message, "take a smaller number");
    }
    if let Some(date) = &study.study_metadata.date {
        let shape: String =
            date.chars().map(|letter| if letter.is_ascii_digit() { '0' } else { letter }).collect();
        if shape != "0000-00-00" {
            let message = format!("\"{date}\" is not a date");
            issues.error("/studyMetadata/date", "bad-date", message, "write YYYY-MM-DD");
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
        issues.error("/languages", "no-language", "no language", "add one: [\"en\"]");
        return;
    }
    for (index, language) in languages.iter().enumerate() {
        let pointer = below("/languages", index);
        if languages[..index].contains(language) {
            issues.error(pointer, "duplicate", format!("\"{language}\" twice"), "name it once");
        } else if !text::LANGUAGES.contains(&language.as_str())
            && !subject.study.translations.contains_key(language)
        {
            let message = format!("buttons and messages are not translated to \"{language}\"");
            let hint = format!(
                "they will be in English; complete are {}; `mimique check --words {language}` prints what \
                 to translate into /translations/{language}",
                listed(&text::LANGUAGES)
            );
            issues.warning(pointer, "untranslated-buttons", message, hint);
        }
    }
    for (language, own) in &subject.study.translations {
        translation(language, own, languages, issues);
    }
    for pointer in texts {
        let Some(value) = subject.value.pointer(pointer) else { continue };
        local_text(pointer, value, languages, issues);
    }
}

/// The study's own buttons and messages in a language.
fn translation(
    language: &str,
    own: &SortedMap<String, String>,
    languages: &[String],
    issues: &mut Issues,
) {
    let pointer = below("/translations", language);
    if !languages.iter().any(|known| known == language) {
        let message = format!("\"{language}\" is not one of the study's languages");
        let hint = format!("add it to /languages; there is {}", listed(languages));
        issues.warning(&pointer, "undeclared-language", message, hint);
    }
    for (name, _) in own.iter().filter(|(_, text)| text.trim().is_empty()) {
        issues.error(below(&pointer, name), "empty-text", "the text is empty", "write it");
    }
    for fault in text::faults(language, own) {
        match fault {
            text::Fault::Unknown { name } => {
                let message = format!("no button or message is called \"{name}\"");
                let hint = suggestion(&name, text::names());
                issues.error(below(&pointer, &name), "unknown-text", message, hint);
            }
            text::Fault::Placeholders { name, english } => {
                let text = own.get(&name).map_or("", String::as_str);
                let message = format!("\"{text}\" has not the words in braces of \"{english}\"");
                let hint = "write each of them once, as it is in English";
                issues.error(below(&pointer, &name), "wrong-placeholders", message, hint);
            }
            text::Fault::Missing(names) => {
                let some = names.iter().take(3).copied().collect::<Vec<_>>();
                let message =
                    format!("{} texts are not translated: {}", names.len(), listed(&some));
                let hint = format!(
                    "they will be in English; `mimique check --words {language}` prints all of them"
                );
                issues.warning(&pointer, "incomplete-translation", message, hint);
            }
        }
    }
}

fn local_text(pointer: &str, value: &Value, languages: &[String], issues: &mut Issues) {
    if let Some(text) = value.as_str() {
        // Names, numbers and single marks are the same everywhere.
        let is_name = pointer.ends_with("/name") || !text.chars().any(char::is_alphabetic);
        if languages.len() > 1 && !is_name {
            let message = format!("the same text for {} languages", languages.len());
            let hint = "write one text a language: {\"en\": \"...\", \"fr\": \"...\"}";
            issues.warning(pointer, "one-text-for-all", message, hint);
        }
        return;
    }
    let Some(map) = value.as_object() else { return };
    for language in languages {
        match map.get(language).and_then(Value::as_str) {
            None => {
                let message = format!("no text in \"{language}\"");
                let hint = format!("add \"{language}\": \"...\"");
                issues.error(pointer, "missing-translation", message, hint);
            }
            Some(text) if text.trim().is_empty() => {
                let place = below(pointer, language);
                issues.error(place, "empty-text", "the text is empty", "write it");
            }
            Some(_) => {}
        }
    }
    for language in map.keys().filter(|key| !languages.contains(key)) {
        let message = format!("\"{language}\" is not one of the study's languages");
        let hint =
            format!("add it to /languages, or remove it here; there is {}", listed(languages));
        issues.warning(below(pointer, language), "undeclared-language", message, hint);
    }
}

fn contact(subject: &Subject<'_>, issues: &mut Issues) {
    let Some(contact) = &subject.study.contact else {
        let message = "no contact: participants cannot ask anybody";
        let hint = "add \"contact\": {\"investigator\": {\"name\": \"...\", \"email\": \"...\"}, \"ethicsBoard\": {...}}";
        issues.error("", "no-contact", message, hint);
        return;
    };
    if contact.ethics_board.is_none() {
        let message = "no contact of the ethics board";
        let hint = "add \"ethicsBoard\": {\"name\": \"...\", \"email\": \"...\"}";
        issues.error("/contact", "no-ethics-board", message, hint);
    }
    let people = [
        ("investigator", Some(&contact.investigator)),
        ("ethicsBoard", contact.ethics_board.as_ref()),
    ];
    for (key, person) in people {
        let Some(person) = person else { continue };
        let parts: Vec<&str> = person.email.split('@').collect();
        if parts.len() != 2 || parts.iter().any(|part| part.is_empty()) {
            let message = format!("\"{}\" is not an address", person.email);
            let place = format!("/contact/{key}/email");
            issues.error(place, "bad-email", message, "write NAME@DOMAIN");
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
            let message = format!("\"{name}\" is not a parameter's name");
            issues.error(pointer, "bad-id", message, "use letters, digits, _ and -");
        } else if taken.contains(&name.as_str()) {
            issues.error(pointer, "duplicate", format!("\"{name}\" twice"), "name it once");
        } else if is_reserved_column(name)
            || subject.study.questions.iter().any(|question| question.id == *name)
            || subject.clips.iter().any(|clip| clip.factors.contains_key(name))
        {
            // The export with identifiers has a column for each parameter.
            let message = format!("\"{name}\" is the name of another column of the export");
            issues.error(pointer, "name-taken", message, "let the address name it otherwise");
        }
        taken.push(name);
    }
    if recruitment.repeat_prevention == RepeatPrevention::RecruitmentIdentifier
        && recruitment.url_parameters.is_empty()
    {
        let message =
            "repeats are to be recognised by the recruitment identifier, but none is kept";
        let hint = "add \"urlParameters\": [\"PROLIFIC_PID\"]";
        issues.error("/recruitment", "no-identifier", message, hint);
    }
    enrolment(recruitment, issues);
    let Some(redirect) = &recruitment.redirect else { return };
    let pointer = "/recruitment/redirect";
    if !redirect.starts_with("https://") {
        let message = format!("\"{redirect}\" is not a secure address");
        issues.error(pointer, "bad-address", message, "begin it with https://");
    }
    for name in redirect.split('{').skip(1).filter_map(|rest| rest.split('}').next()) {
        if name == "code" && recruitment.completion_code.is_none() {
            let message = "{code} stands for a completion code that is not given";
            issues.error(pointer, "no-code", message, "add \"completionCode\"");
        } else if name != "code" && !taken.contains(&name) {
            let message = format!("{{{name}}} is not one of urlParameters");
            issues.error(pointer, "unknown-parameter", message, "add it to urlParameters");
        }
    }
}

/// Who can begin, and when.
fn enrolment(recruitment: &Recruitment, issues: &mut Issues) {
    if recruitment.participants == Some(0) {
        let hint = "write how many, or leave it out for any number";
        issues.error("/recruitment/participants", "out-of-range", "nobody could take part", hint);
    }
    if recruitment.reservation_minutes == Some(0) {
        let message = "a place that is kept for 0 minutes is lost at once";
        let hint = "write the time that the study takes, in minutes";
        issues.error("/recruitment/reservationMinutes", "out-of-range", message, hint);
    }
    for (key, text) in [("opens", &recruitment.opens), ("closes", &recruitment.closes)] {
        if let Some(text) = text.as_ref().filter(|text| instant_ms(text).is_none()) {
            let message = format!("\"{text}\" is not a time");
            let hint = "write it with its offset: 2026-03-01T08:00:00+01:00";
            issues.error(format!("/recruitment/{key}"), "bad-date", message, hint);
        }
    }
    if let (Some(opens), Some(closes)) = (recruitment.opens_ms(), recruitment.closes_ms())
        && closes <= opens
    {
        let message = "the study closes before it opens";
        issues.error("/recruitment/closes", "out-of-range", message, "write a later time");
    }
}

fn consent(subject: &Subject<'_>, issues: &mut Issues) {
    let Some(consent) = &subject.study.consent else {
        let message = "no consent: participants are not asked whether they agree";
        issues.error("", "no-consent", message, "add \"consent\": {\"version\": \"1\", ...}");
        return;
    };
    if consent.minimum_age.is_none() {
        let message = "no minimum age";
        issues.error("/consent", "no-minimum-age", message, "add \"minimumAge\": 18");
    }
    if consent.retention.is_none() {
        let message = "no retention period: participants are not told how long answers are kept";
        issues.error("/consent", "no-retention", message, "add \"retention\": \"...\"");
    }
    if consent.retention_days == Some(0) {
        let message = "answers that are kept for 0 days are deleted at once";
        let hint = "write how many days, or leave it out to keep them";
        issues.error("/consent/retentionDays", "out-of-range", message, hint);
    }
    if consent.version.trim().is_empty() {
        let message = "the version is empty";
        issues.error("/consent/version", "empty-text", message, "write \"1\"");
    }
    if consent.sections.is_empty() {
        let message = "nothing is said that a participant could agree to";
        issues.error("/consent/sections", "empty", message, "add a section: what they will do");
    }
    let is_empty =
        |text: &LocalText| matches!(text, LocalText::Plain(text) if text.trim().is_empty());
    for (index, Section { heading, text }) in consent.sections.iter().enumerate() {
        for (key, text) in [("heading", heading), ("text", text)] {
            if is_empty(text) {
                let place = format!("/consent/sections/{index}/{key}");
                issues.error(place, "empty-text", "the text is empty", "write it");
            }
        }
    }
}

fn exclusions(subject: &Subject<'_>, issues: &mut Issues) {
    let Some(rules) = &subject.study.exclusions else { return };
    if let Some(share) = rules.late_frame_share.filter(|share| !(0.0..=1.0).contains(share)) {
        let message = format!("{share} is not a share");
        issues.error("/exclusions/lateFrameShare", "out-of-range", message, "write 0 to 1");
    }
    for (key, value) in
        [("longestFrameMs", rules.longest_frame_ms), ("shortestRtMs", rules.shortest_rt_ms)]
    {
        if let Some(value) = value.filter(|value| *value <= 0.0) {
            let message = format!("{value} ms excludes nothing or everything");
            let place = format!("/exclusions/{key}");
            issues.error(place, "out-of-range", message, "write a time above 0");
        }
    }
}
