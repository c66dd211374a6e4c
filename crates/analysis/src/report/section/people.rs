//! Who took part, who was left out and why, and what people said about themselves.

use std::collections::BTreeMap;

use mimique_report::document::{Block, DataTable};
use mimique_stats::{Labelled, Outcome, describe};
use mimique_study::columns::ASSIGNED_CONDITION;

use crate::report::figure::flow_chart::flow_chart;
use crate::report::results::AboutPeople;
use crate::report::section::{MOST_LEVELS, Writer};
use crate::trials::rule::Rule;
use crate::trials::versions::{OtherVersion, Part};

impl Writer<'_> {
    pub(crate) fn participants(&mut self) {
        let language = self.language();
        self.heading(2, "Participants", "Participants");
        let flow = flow_chart(language, &self.export.flow);
        let mut rules_block = None;
        if self.export.flow.rules.is_empty() {
            self.paragraph(
                "The study file sets no rule of exclusion; only withdrawn and pilot sessions are left out.",
                "Le fichier de l’étude ne fixe aucune règle d’exclusion ; seules les sessions retirées et pilotes sont écartées.",
            );
        } else {
            let rules = Rule::listed(&self.export.flow.rules, language);
            let differ = |version: &OtherVersion| match &version.differences {
                Some(differences) => differences.iter().any(|own| own.of == Part::Rule),
                None => true,
            };
            let words = match self.other_versions.iter().any(differ) {
                true => language.pick(
                    format!("Rules of exclusion in the study file of this report, not in every file that participants were served (see In short): {rules}."),
                    format!("Règles d’exclusion du fichier d’étude de ce rapport, et non de tous les fichiers servis aux participants (voir En bref) : {rules}."),
                ),
                false => language.pick(
                    format!("Rules of exclusion, fixed in the study file: {rules}."),
                    format!("Règles d’exclusion, fixées dans le fichier de l’étude : {rules}."),
                ),
            };
            rules_block = Some(Block::Paragraph(words));
        }
        self.figure(flow);
        if let Some(rules) = rules_block {
            let heading = language.pick("Rules of exclusion", "Règles d’exclusion").to_owned();
            self.blocks.push(Block::Folded(heading, vec![rules]));
        }
        let caption = match self.study.conditions().is_empty() {
            true => language.pick(
                "Answers of the people in the analysis about themselves",
                "Réponses des personnes de l’analyse sur elles-mêmes",
            ),
            false => language.pick(
                "The people in the analysis: their condition, and their answers about themselves",
                "Les personnes de l’analyse : leur condition et leurs réponses sur elles-mêmes",
            ),
        };
        let mut table = DataTable::new(
            "about-people",
            caption,
            language.pick(["question", "people", "answers"], ["question", "personnes", "réponses"]),
        );
        for (column, cells) in &self.export.about {
            let used: Vec<&str> = cells
                .iter()
                .zip(&self.export.people)
                .filter(|(_, person)| person.excluded.is_none())
                .filter_map(|(cell, _)| cell.as_deref())
                .collect();
            let question = self
                .study
                .demographics
                .iter()
                .flat_map(|page| &page.questions)
                .find(|question| question.id == *column);
            let label = question.map_or_else(
                || self.naming.factor(column),
                |question| question.prompt.in_language(language.code()).to_owned(),
            );
            let (summary, words) = self.about_people(column, &used);
            table.row([label, used.len().to_string(), words]);
            self.results.about_people.insert(column.clone(), summary);
        }
        if !table.rows.is_empty() {
            self.blocks.push(Block::Table(table));
        }
    }

    fn about_people(&self, column: &str, used: &[&str]) -> (AboutPeople, String) {
        let language = self.language();
        let conditions = match column {
            ASSIGNED_CONDITION => self.study.conditions(),
            _ => Vec::new(),
        };
        let numbers: Option<Vec<f64>> =
            used.iter().map(|cell| cell.parse().ok().filter(|_| conditions.is_empty())).collect();
        if let Some(numbers) = numbers.filter(|numbers| !numbers.is_empty()) {
            let description = describe(&numbers);
            let words = match &description {
                Outcome::Ok(d) => language.pick(
                    format!(
                        "mean {}, sd {}, median {}, from {} to {}",
                        language.number(d.mean),
                        d.sd.map_or_else(|| "–".to_owned(), |sd| language.number(sd)),
                        language.number(d.median),
                        language.number(d.min),
                        language.number(d.max)
                    ),
                    format!(
                        "moyenne {}, écart type {}, médiane {}, de {} à {}",
                        language.number(d.mean),
                        d.sd.map_or_else(|| "–".to_owned(), |sd| language.number(sd)),
                        language.number(d.median),
                        language.number(d.min),
                        language.number(d.max)
                    ),
                ),
                Outcome::Undefined { reason } => reason.words(language),
            };
            return (AboutPeople::Numbers(description), words);
        }
        // A condition with nobody is one, too.
        let mut counts: BTreeMap<&str, usize> =
            conditions.into_iter().map(|condition| (condition, 0)).collect();
        for cell in used {
            *counts.entry(cell).or_insert(0) += 1;
        }
        let mut counts: Vec<(String, usize)> =
            counts.into_iter().map(|(cell, count)| (cell.to_owned(), count)).collect();
        counts.sort_by(|a, b| b.1.cmp(&a.1).then_with(|| a.0.cmp(&b.0)));
        let words: Vec<String> = counts
            .iter()
            .take(MOST_LEVELS)
            .map(|(cell, count)| format!("{}: {count}", self.naming.level(column, cell)))
            .collect();
        (AboutPeople::Counts(Labelled(counts)), words.join(", "))
    }
}
