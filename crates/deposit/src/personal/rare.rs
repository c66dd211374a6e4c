//! People who are told apart by what they said of themselves: nobody else has their combination of answers.

use std::collections::BTreeMap;

use mimique_study::{KindOfQuestion as _, Study};

use crate::responses::Responses;

/// How many people are told apart, by which columns.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Rare {
    /// Columns of answers about people.
    pub columns: Vec<String>,
    /// People who share their combination with nobody.
    pub alone: usize,
    /// All people.
    pub people: usize,
}

/// People whose combination of answers about themselves nobody shares; none where there are none, or no such columns.
pub fn rare(responses: &Responses, study: &Study) -> Option<Rare> {
    let columns: Vec<String> = (study.demographics.iter())
        .flat_map(|page| &page.questions)
        .filter(|question| !question.kind.is_free_text())
        .flat_map(|question| question.response_ids())
        .filter(|name| responses.column(name).is_some())
        .collect();
    let people = responses.by_person();
    let mut combinations: BTreeMap<Vec<&str>, usize> = BTreeMap::new();
    for rows in people.values() {
        let answer = |name: &String| rows.first().map_or("", |row| responses.cell(*row, name));
        *combinations.entry(columns.iter().map(answer).collect()).or_default() += 1;
    }
    let alone = combinations
        .iter()
        .filter(|(answers, count)| **count == 1 && answers.iter().any(|answer| !answer.is_empty()))
        .count();
    let people = people.len();
    (alone > 0).then_some(Rare { columns, alone, people })
}
