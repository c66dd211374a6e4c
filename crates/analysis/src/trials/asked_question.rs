//! The questions of an export, each with its place in the study file.

use std::collections::BTreeSet;
use std::ops::RangeInclusive;

use mimique_study::{KindOfQuestion as _, Question, Study};

use crate::trials::export::Export;

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
        self.question.is_some_and(|question| question.kind.truth().is_some())
    }

    /// The factor of the clip that holds the right answer; empty where there is none.
    pub(crate) fn truth(&self) -> String {
        let truth = self.question.and_then(|question| question.kind.truth());
        truth.unwrap_or_default().to_owned()
    }

    /// First and last point of a scale of few points.
    pub(crate) fn scale(&self) -> Option<(i64, i64)> {
        self.question?.kind.points().map(RangeInclusive::into_inner)
    }
}

impl Export {
    /// Questions that were answered in trials, in the study's order, then any other.
    pub(crate) fn questions<'s>(&self, study: &'s Study) -> Vec<AskedQuestion<'s>> {
        let asked: BTreeSet<&str> = self.answers.keys().map(String::as_str).collect();
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
