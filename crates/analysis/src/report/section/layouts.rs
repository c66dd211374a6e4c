//! Tables in the study's own layout: means, matrices, and the choice among all layouts.

use mimique_locale::Language;
use mimique_report::document::{Block, DataTable, slug};
use mimique_stats::{Confusion, Factor, confusion};
use mimique_study::{AnswerOfPair, KindOfQuestion as _, Layout, Measure as What, TableLayout};
use serde::Serialize;

use crate::hypothesis::HypothesisResult;
use crate::hypothesis::not_tested::of_pair_in_words;
use crate::hypothesis::undefined::TestOutcome;
use crate::report::section::Writer;
use crate::trials::asked_question::AskedQuestion;
use crate::trials::measure::{Measure, MeasureKind};

/// One place of a table of tests, for `results.json`.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct LayoutCell {
    pub table: String,
    pub row: String,
    pub column: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub as_in_the_thesis: Option<TestOutcome>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub recommended: Option<TestOutcome>,
    /// Recommended tests on pairs and parts are corrected by Holm's method within a row.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub p_holm: Option<f64>,
}

/// What a layout is about: a response, with what people read for it.
pub(crate) struct Row<'s> {
    pub asked: AskedQuestion<'s>,
    pub measure: Measure,
}

/// A factor of the clips or an answer about the person, with a code a value of a measure.
pub(crate) struct Column {
    pub factor: Factor,
    /// Whether every person has one level only.
    pub about_people: bool,
}

impl<'a> Writer<'a> {
    /// What stands above the tables that the study lays out.
    pub(crate) fn layouts_heading(&mut self) {
        self.heading(2, "Tables of the study", "Tables de l’étude");
        let caution = crate::hypothesis::reading::trial_level_caution(self.language());
        self.blocks.push(Block::Caution(caution.to_owned()));
    }

    /// A table that the study lays out; `hypotheses` are those that were tested.
    pub(crate) fn layout(&mut self, layout: &TableLayout, hypotheses: &[HypothesisResult]) {
        let language = self.language();
        if let Some(why) = self.layout_of_pair(layout) {
            let caption = layout.caption.in_language(language.code());
            let why = of_pair_in_words(&why, language);
            self.blocks.push(Block::Caution(
                language.pick(format!("{caption}: {why}."), format!("{caption} : {why}.")),
            ));
            return;
        }
        let table = match layout.layout {
            Layout::Hypotheses => self.hypotheses_layout(layout, hypotheses),
            Layout::Pairs => self.pairs_layout(layout),
            Layout::Means => self.means_layout(layout),
            Layout::Interactions => self.interactions_layout(layout),
            Layout::Influences => self.influences_layout(layout),
            Layout::Confusion => self.confusion_layout(layout),
        };
        if table.rows.is_empty() {
            let caption = layout.caption.in_language(language.code());
            self.blocks.push(Block::Caution(language.pick(
                format!("{caption}: the export has no answers for this table."),
                format!("{caption} : l’export n’a pas de réponses pour cette table."),
            )));
        } else {
            self.folded_table(table);
        }
    }

    /// Why a table cannot tell its responses by its factors, where they are about two clips.
    fn layout_of_pair(&self, layout: &TableLayout) -> Option<AnswerOfPair> {
        let asked = self.export.questions(self.study);
        let mut rows = asked.iter().filter(|asked| layout.responses.contains(&asked.id));
        rows.find_map(|asked| {
            let mut factors = layout.factors.iter().chain(layout.crossings.iter().flatten());
            factors.find_map(|factor| self.of_pair(asked, What::Answer, factor))
        })
    }

    pub(crate) fn layout_table(
        &self,
        layout: &TableLayout,
        columns: impl IntoIterator<Item = impl Into<String>>,
    ) -> DataTable {
        let caption = layout.caption.in_language(self.language().code());
        DataTable::new(format!("table-{}", slug(&layout.id)), caption, columns)
    }

    /// The responses of a layout that were answered.
    pub(crate) fn layout_rows(&self, layout: &TableLayout) -> Vec<Row<'a>> {
        let asked = self.export.questions(self.study);
        let find = |id: &String| asked.iter().find(|asked| asked.id == *id).cloned();
        layout
            .responses
            .iter()
            .filter_map(find)
            .filter_map(|asked| {
                let measure = Measure::of_question(self.export, &asked, self.language())?;
                Some(Row { asked, measure })
            })
            .collect()
    }

    /// A factor over a measure's values, its levels in the study's order.
    pub(crate) fn layout_column(&self, measure: &Measure, name: &str) -> Option<Column> {
        let about_people = !self.export.factors.iter().any(|factor| factor == name);
        let factor = if about_people {
            measure.trait_factor(self.export, name)?
        } else {
            measure.factor(self.export, name, &[])
        };
        let order = self.naming.level_order(name);
        let mut levels: Vec<String> =
            order.iter().filter(|level| factor.levels.contains(level)).cloned().collect();
        levels.extend(factor.levels.iter().filter(|level| !order.contains(level)).cloned());
        Some(Column { factor: factor.restricted(&levels).unwrap_or(factor), about_people })
    }

    /// Levels of a factor in the study's order, those that nobody saw or gave included.
    pub(crate) fn all_levels(&self, rows: &[Row<'_>], name: &str) -> Vec<String> {
        let mut levels = self.naming.level_order(name);
        for row in rows {
            let found = self.layout_column(&row.measure, name);
            for level in found.into_iter().flat_map(|column| column.factor.levels) {
                if !levels.contains(&level) {
                    levels.push(level);
                }
            }
        }
        levels
    }

    fn means_layout(&mut self, layout: &TableLayout) -> DataTable {
        let language = self.language();
        let rows = self.layout_rows(layout);
        let name = layout.factors.first().map_or("", String::as_str);
        let levels = self.all_levels(&rows, name);
        let second = layout.factors.get(1);
        let parts: Vec<Option<String>> = match second {
            None => vec![None],
            Some(second) => std::iter::once(None)
                .chain(self.all_levels(&rows, second).into_iter().map(Some))
                .collect(),
        };
        let headings = language.pick(["question", "scale"], ["question", "échelle"]);
        let mut headings: Vec<String> = headings.map(str::to_owned).to_vec();
        headings.extend(second.map(|second| self.naming.factor(second)));
        headings.extend(levels.iter().map(|level| self.naming.level(name, level)));
        let mut table = self.layout_table(layout, headings);
        if let Some((_, cells)) = self.export.about.iter().find(|(column, _)| column == name) {
            let mut line = vec![language.pick("people", "effectifs").to_owned(), String::new()];
            line.extend(second.map(|_| String::new()));
            line.extend(levels.iter().map(|level| self.people_of_level(cells, level).to_string()));
            table.row(line);
        }
        for row in &rows {
            let Some(column) = self.layout_column(&row.measure, name) else { continue };
            let by = second.and_then(|second| self.layout_column(&row.measure, second));
            for part in &parts {
                let inside = |i: usize| match (part, &by) {
                    (None, _) => true,
                    (Some(part), Some(by)) => by.factor.level(i) == Some(part),
                    (Some(_), None) => false,
                };
                let mut line = vec![row.measure.label.clone(), self.scale_words(row)];
                if let Some(second) = second {
                    line.push(part.as_ref().map_or_else(
                        || language.pick("all", "toutes").to_owned(),
                        |part| self.naming.level(second, part),
                    ));
                }
                for level in &levels {
                    let chosen: Vec<f64> = (0..row.measure.values.len())
                        .filter(|&i| column.factor.level(i) == Some(level) && inside(i))
                        .map(|i| row.measure.values[i])
                        .collect();
                    line.push(if chosen.is_empty() {
                        "NA".to_owned()
                    } else {
                        language.fixed(chosen.iter().sum::<f64>() / chosen.len() as f64, 3)
                    });
                }
                table.row(line);
            }
        }
        table
    }

    /// People in the analysis who gave this answer; `cells` has one a person.
    fn people_of_level(&self, cells: &[Option<String>], level: &str) -> usize {
        let used = cells
            .iter()
            .zip(&self.export.people)
            .filter(|(cell, person)| person.excluded.is_none() && cell.as_deref() == Some(level));
        used.count()
    }

    /// `1 (very weak) to 7 (very strong)`; for recognition that it is a share.
    fn scale_words(&self, row: &Row<'_>) -> String {
        let language = self.language();
        if row.measure.kind == MeasureKind::Recognition {
            return language.pick("share of right answers", "part de réponses justes").to_owned();
        }
        let Some(kind) = row.asked.question.map(|question| &question.kind) else {
            return String::new();
        };
        let (Some(points), Some(ends)) = (kind.points(), kind.ends()) else {
            return String::new();
        };
        let [low, high] = ends.map(|end| {
            end.map_or_else(String::new, |text| format!(" ({})", text.in_language(language.code())))
        });
        let (first, last) = (points.start(), points.end());
        language
            .pick(format!("{first}{low} to {last}{high}"), format!("{first}{low} à {last}{high}"))
    }

    fn confusion_layout(&mut self, layout: &TableLayout) -> DataTable {
        let language = self.language();
        let rows = self.layout_rows(layout);
        let Some(row) = rows.first() else { return self.layout_table(layout, [""; 0]) };
        let truth = row.asked.truth();
        let matrices = self.matrices(layout, row);
        let order = self.naming.level_order(&row.asked.id);
        let labels: Vec<&String> = order
            .iter()
            .filter(|label| matrices.iter().any(|(_, matrix)| matrix.labels.contains(label)))
            .collect();
        let name_of = |label: &str| self.naming.level(&truth, label);
        let mut headings = vec![language.pick("played", "jouée").to_owned()];
        for _ in &matrices {
            headings.extend(labels.iter().map(|label| name_of(label)));
        }
        let mut table = self.layout_table(layout, headings);
        table.groups = vec![(String::new(), 1)];
        for (part, matrix) in &matrices {
            let of = match (layout.factors.first(), part) {
                (Some(name), Some(part)) => self.naming.level(name, part),
                _ => language.pick("all trials", "tous les essais").to_owned(),
            };
            let right = language.percent(matrix.accuracy);
            let heading = language.pick(
                format!("{of}: % of each row, n = {}, right {right}", matrix.n),
                format!("{of} : % de chaque ligne, n = {}, justes {right}", matrix.n),
            );
            table.groups.push((heading, labels.len()));
        }
        for label in &labels {
            let rows: Vec<_> = matrices
                .iter()
                .map(|(_, matrix)| matrix_row(language, matrix, label, &labels))
                .collect();
            if rows.iter().any(Option::is_some) {
                let missing = || vec!["NA".to_owned(); labels.len()];
                let cells = rows.into_iter().flat_map(|row| row.unwrap_or_else(missing));
                table.row(std::iter::once(name_of(label)).chain(cells).collect::<Vec<_>>());
            }
        }
        table
    }

    /// A confusion matrix for each level of the layout's factor, or one of all answers.
    fn matrices(&self, layout: &TableLayout, row: &Row<'_>) -> Vec<(Option<String>, Confusion)> {
        let answers = self.export.answers_to(&row.asked.id);
        let parts: Vec<Option<String>> = match layout.factors.first() {
            None => vec![None],
            Some(name) => {
                let found = self.layout_column(&row.measure, name);
                found.into_iter().flat_map(|column| column.factor.levels).map(Some).collect()
            }
        };
        let of_part = |part: &Option<String>| -> Vec<_> {
            answers
                .iter()
                .filter(|answer| match (layout.factors.first(), part) {
                    (Some(name), Some(part)) => {
                        let about = self.export.about.iter().find(|(column, _)| column == name);
                        let level = match about {
                            Some((_, cells)) => cells[answer.person].as_deref(),
                            None => self.export.level(answer, name),
                        };
                        level == Some(part)
                    }
                    _ => true,
                })
                .collect()
        };
        parts
            .into_iter()
            .filter_map(|part| {
                let chosen = of_part(&part);
                let shown = chosen.iter().map(|answer| answer.truth.as_deref());
                let shown = Factor::from_cells("truth", shown, |_| None);
                let given = chosen.iter().map(|answer| Some(&*answer.text));
                let given = Factor::from_cells(&row.asked.id, given, |_| None);
                Some((part, confusion(&shown, &given).ok()?))
            })
            .collect()
    }
}

/// Percentages of the answers to what was played; none where it never was.
fn matrix_row(
    language: Language,
    matrix: &Confusion,
    played: &str,
    answers: &[&String],
) -> Option<Vec<String>> {
    let all: u64 = matrix.labels.iter().map(|answer| matrix.count(played, answer)).sum();
    (all > 0).then(|| {
        let share = |answer: &&String| 100.0 * matrix.count(played, answer) as f64 / all as f64;
        answers.iter().map(|answer| language.fixed(share(answer), 1)).collect()
    })
}
