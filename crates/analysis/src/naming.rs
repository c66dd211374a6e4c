//! What people read for factors and their levels.

use mimique_locale::Language;
use mimique_study::columns::ASSIGNED_CONDITION;
use mimique_study::{KindOfQuestion as _, Study};

/// Names of factors and levels in the report's language, from the study file.
#[derive(Clone, Copy)]
pub(crate) struct Naming<'s> {
    pub language: Language,
    pub study: &'s Study,
}

impl Naming<'_> {
    /// A factor.
    pub(crate) fn factor(&self, factor: &str) -> String {
        let known = match factor {
            "method" => self.language.pick("method", "méthode"),
            "expression" => self.language.pick("emotion", "émotion"),
            "intensity" => self.language.pick("intensity", "intensité"),
            ASSIGNED_CONDITION => self.language.pick("assigned condition", "condition attribuée"),
            other => other,
        };
        known.to_owned()
    }

    /// The factors of an effect; of an interaction joined by `×`.
    pub(crate) fn interaction(&self, factors: &[String]) -> String {
        factors.iter().map(|factor| self.factor(factor)).collect::<Vec<_>>().join(" × ")
    }

    /// A level of a factor: the label of the option or method that it is.
    pub(crate) fn level(&self, factor: &str, level: &str) -> String {
        let code = self.language.code();
        for question in self.study.all_questions() {
            if (question.kind.truth() == Some(factor) || question.id == factor)
                && let Some(option) =
                    question.kind.levels().iter().find(|option| option.value == level)
            {
                return option.label.in_language(code).to_owned();
            }
        }
        if factor == "method" {
            let labels = self.study.stimuli.methods.values().filter(|entry| {
                let own = entry.factors.get("method").map(ToString::to_string);
                own.unwrap_or_else(|| entry.word()) == level
            });
            let labels: Vec<&str> = labels
                .filter_map(|entry| entry.label.as_ref())
                .map(|label| label.in_language(code))
                .collect();
            if let [one] = labels.as_slice() {
                return (*one).to_owned();
            }
        }
        level.to_owned()
    }

    /// Levels of a factor or answers to a question in the study's order; none where the study leaves
    /// them open.
    pub(crate) fn level_order(&self, name: &str) -> Vec<String> {
        if name == ASSIGNED_CONDITION {
            return self.study.conditions().into_iter().map(str::to_owned).collect();
        }
        let mut levels: Vec<String> = Vec::new();
        for clip in self.study.clips() {
            let level = clip.factors.get(name).map(ToString::to_string);
            levels.extend(level.filter(|level| !levels.contains(level)));
        }
        if levels.iter().all(|level| level.parse::<f64>().is_ok()) {
            let number = |level: &String| level.parse::<f64>().unwrap_or(0.0);
            levels.sort_by(|a, b| number(a).total_cmp(&number(b)));
        }
        if !levels.is_empty() {
            return levels;
        }
        let asked = self.study.all_questions().find(|question| question.id == name);
        let Some(kind) = asked.map(|question| &question.kind) else { return levels };
        match kind.few_answers() {
            none if none.is_empty() => {
                kind.options().iter().map(|option| option.value.clone()).collect()
            }
            answers => answers,
        }
    }

    /// A factor, or what a question about the person asks.
    pub(crate) fn column(&self, name: &str) -> String {
        let question = self.study.all_questions().find(|question| question.id == name);
        question.map_or_else(
            || self.factor(name),
            |question| question.prompt.in_language(self.language.code()).to_owned(),
        )
    }

    /// `a − b` of two levels.
    pub(crate) fn pair(&self, factor: &str, a: &str, b: &str) -> String {
        format!("{} − {}", self.level(factor, a), self.level(factor, b))
    }
}

/// A number of people with its noun: "1 person", "2 people".
pub(crate) fn people_counted(language: Language, people: usize) -> String {
    language.counted(people, ["person", "people"], ["personne", "personnes"])
}
