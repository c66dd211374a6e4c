//! The sentences on participants in the paragraph for a paper: how many, who was excluded, and what they answered about
//! themselves.

use mimique_locale::Language;
use mimique_stats::{Description, Outcome, describe};
use mimique_study::{KindOfQuestion as _, Question, QuestionKind};

use crate::naming::people_counted;
use crate::report::figure::flow_chart::{people_left_out, reasons};
use crate::report::section::Writer;
use crate::trials::rule::Rule;

/// The identifier of the background question whose answer is the participant's age in years.
const AGE: &str = "age";

impl Writer<'_> {
    /// How many took part, who and what was excluded and by which rules, and the background questions.
    pub(super) fn participants_in_paper(&self) -> Vec<String> {
        let (language, flow) = (self.language(), &self.export.flow);
        let took_part = language.pick(
            format!("{} took part.", people_counted(language, flow.people)),
            format!(
                "{} participé.",
                language.counted(flow.people, ["", ""], ["personne a", "personnes ont"])
            ),
        );
        let mut sentences = vec![took_part];
        let out = flow.people - flow.people_used;
        if out > 0 {
            let why = language.list(&people_left_out(language, flow));
            let left = flow.people_used;
            let excluded = language.counted(
                out,
                ["participant was", "participants were"],
                ["personne a été exclue", "personnes ont été exclues"],
            );
            sentences.push(language.pick(
                format!("{excluded} excluded ({why}), leaving {left} in the analysis."),
                format!("{excluded} ({why}), ce qui en laisse {left} dans l’analyse."),
            ));
        }
        let trials_out = flow.trials - flow.trials_used;
        if trials_out > 0 {
            let why = language.list(&reasons(language, &flow.trials_left_out));
            let all = flow.trials;
            let excluded = language.pick(
                format!(
                    "{trials_out} of {all} trials {}",
                    if trials_out == 1 { "was" } else { "were" }
                ),
                format!("{trials_out} essais sur {all} ont été exclus"),
            );
            sentences.push(
                language
                    .pick(format!("{excluded} excluded ({why})."), format!("{excluded} ({why}).")),
            );
        }
        if !flow.rules.is_empty() {
            let rules = Rule::listed(&flow.rules, language);
            sentences.push(language.pick(
                format!("The study file, fixed beforehand, excludes {rules}."),
                format!("Le fichier de l’étude, fixé à l’avance, exclut {rules}."),
            ));
        }
        sentences.extend(self.background_in_paper());
        sentences
    }

    /// A sentence on each background question that asks for a number or for one of several options.
    fn background_in_paper(&self) -> Vec<String> {
        let mut sentences = Vec::new();
        for (column, cells) in &self.export.about {
            let mut questions = self.study.demographics.iter().flat_map(|page| &page.questions);
            let Some(question) = questions.find(|question| question.id == *column) else {
                continue;
            };
            let used = cells.iter().zip(&self.export.people);
            let used = used.filter(|(_, person)| person.excluded.is_none());
            let answers: Vec<&str> = used.filter_map(|(cell, _)| cell.as_deref()).collect();
            let missing = self.export.flow.people_used.saturating_sub(answers.len());
            sentences.extend(background(self.language(), question, &answers, missing));
        }
        sentences
    }
}

/// What participants answered to a background question; `None` for other kinds of question, or without answers.
fn background(
    language: Language,
    question: &Question,
    answers: &[&str],
    missing: usize,
) -> Option<String> {
    if answers.is_empty() {
        return None;
    }
    let prompt = question.prompt.in_language(language.code());
    match &question.kind {
        QuestionKind::Number(field) => {
            let numbers: Vec<f64> = answers.iter().filter_map(|cell| cell.parse().ok()).collect();
            let Outcome::Ok(found) = describe(&numbers) else { return None };
            if question.id == AGE {
                return Some(age(language, &found, missing));
            }
            let unit = field.unit.as_ref().map(|unit| unit.in_language(language.code()));
            let unit = unit.map_or_else(String::new, |unit| format!(" {unit}"));
            let (mean, spread) = (language.fixed(found.mean, 1), spread(language, &found, missing));
            Some(language.pick(
                format!("The mean answer to “{prompt}” was {mean}{unit} ({spread})."),
                format!("La réponse moyenne à « {prompt} » était de {mean}{unit} ({spread})."),
            ))
        }
        QuestionKind::SingleChoice(_) => chosen(language, question, prompt, answers, missing),
        _ => None,
    }
}

/// `Participants were 31.3 years old on average (SD = 4.2, range 19 to 54).`
fn age(language: Language, found: &Description, missing: usize) -> String {
    let (mean, spread) = (language.fixed(found.mean, 1), spread(language, found, missing));
    language.pick(
        format!("Participants were {mean} years old on average ({spread})."),
        format!("Les participants avaient {mean} ans en moyenne ({spread})."),
    )
}

/// Standard deviation, range, and the number of answers where some are missing.
fn spread(language: Language, found: &Description, missing: usize) -> String {
    let mut parts = Vec::new();
    if let Some(sd) = found.sd {
        let sd = language.fixed(sd, 1);
        parts.push(language.pick(format!("SD = {sd}"), format!("ET = {sd}")));
    }
    let [low, high] = [found.min, found.max].map(|value| language.number(value));
    parts.push(language.pick(format!("range {low} to {high}"), format!("étendue {low} à {high}")));
    if missing > 0 {
        parts.push(format!("n = {}", found.n));
    }
    parts.join(", ")
}

/// How many chose each option, in the order of the study file, by the options' labels.
fn chosen(
    language: Language,
    question: &Question,
    prompt: &str,
    answers: &[&str],
    missing: usize,
) -> Option<String> {
    let counts = question.kind.options().iter().map(|option| {
        let count = answers.iter().filter(|answer| **answer == option.value).count();
        (count, option.label.in_language(language.code()))
    });
    let counts: Vec<(usize, &str)> = counts.filter(|(count, _)| *count > 0).collect();
    let mut parts: Vec<String> = counts
        .iter()
        .enumerate()
        .map(|(place, (count, label))| match (place, language) {
            (0, Language::English) => format!("{count} answered “{label}”"),
            (_, Language::English) => format!("{count} “{label}”"),
            (0, Language::French) if *count == 1 => format!("1 a répondu « {label} »"),
            (0, Language::French) => format!("{count} ont répondu « {label} »"),
            (_, Language::French) => format!("{count} « {label} »"),
        })
        .collect();
    if parts.is_empty() {
        return None;
    }
    if missing > 0 {
        parts.push(
            language.pick(format!("{missing} gave no answer"), format!("{missing} sans réponse")),
        );
    }
    let parts = language.list(&parts);
    Some(language.pick(
        format!("Asked “{prompt}”, {parts}."),
        format!("À la question « {prompt} », {parts}."),
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn question(json: &str) -> Question {
        serde_json::from_str(json).unwrap()
    }

    #[test]
    fn age_is_a_sentence_of_a_paper() {
        let asked = question(
            r#"{ "id": "age", "type": "number", "prompt": { "en": "How old are you?", "fr": "Âge ?" } }"#,
        );
        let answers = ["19", "31", "54", "30"];
        assert_eq!(
            background(Language::English, &asked, &answers, 0).unwrap(),
            "Participants were 33.5 years old on average (SD = 14.7, range 19 to 54)."
        );
        assert_eq!(
            background(Language::French, &asked, &answers, 1).unwrap(),
            "Les participants avaient 33,5 ans en moyenne (ET = 14,7, étendue 19 à 54, n = 4)."
        );
        assert_eq!(background(Language::English, &asked, &[], 4), None);
    }

    #[test]
    fn other_numbers_have_their_unit() {
        let asked = question(
            r#"{ "id": "practice", "type": "number", "prompt": { "en": "Practice?" }, "unit": { "en": "hours" } }"#,
        );
        assert_eq!(
            background(Language::English, &asked, &["2", "4"], 0).unwrap(),
            "The mean answer to “Practice?” was 3.0 hours (SD = 1.4, range 2 to 4)."
        );
    }

    #[test]
    fn options_are_counted_in_the_order_of_the_study() {
        let asked = question(
            r#"{ "id": "gender", "type": "singleChoice", "prompt": { "en": "Gender?", "fr": "Genre ?" }, "options": [
                { "value": "w", "label": { "en": "Woman", "fr": "Femme" } },
                { "value": "m", "label": { "en": "Man", "fr": "Homme" } },
                { "value": "n", "label": { "en": "I prefer not to say", "fr": "Sans réponse" } } ] }"#,
        );
        let answers = ["m", "w", "w", "n"];
        assert_eq!(
            background(Language::English, &asked, &answers, 0).unwrap(),
            "Asked “Gender?”, 2 answered “Woman”, 1 “Man” and 1 “I prefer not to say”."
        );
        assert_eq!(
            background(Language::French, &asked, &["w"], 2).unwrap(),
            "À la question « Genre ? », 1 a répondu « Femme » et 2 sans réponse."
        );
    }
}
