//! Tables of tests in the study's own layout: hypotheses, pairs, interactions, influences. As in the
//! thesis stands beside or above recommended.

use mimique_report::document::DataTable;
use mimique_stats::Outcome;
use mimique_study::TableLayout;
use mimique_study::columns::ASSIGNED_CONDITION;

use crate::hypothesis::HypothesisResult;
use crate::hypothesis::not_tested::NotTested;
use crate::hypothesis::person_level;
use crate::hypothesis::test_line::{TestLine, Unit};
use crate::hypothesis::trial_level;
use crate::hypothesis::two_way;
use crate::hypothesis::undefined::{TestOutcome, Why};
use crate::report::section::Writer;
use crate::report::section::layouts::{Column, LayoutCell, Row};
use crate::report::tables::{recommended_heading, thesis_heading};
use crate::trials::measure::{Measure, MeasureKind, as_numbers};

impl Writer<'_> {
    pub(crate) fn hypotheses_layout(
        &self,
        layout: &TableLayout,
        hypotheses: &[HypothesisResult],
    ) -> DataTable {
        let language = self.language();
        let thesis = thesis_heading(language);
        let recommended = recommended_heading(language);
        let first = language.pick("hypothesis", "hypothèse");
        let mut table = self.layout_table(layout, [first, "", thesis, recommended]);
        for result in hypotheses {
            let of_people: Vec<&TestOutcome> = if result.recommended.overall.is_empty() {
                result.recommended.pairs.iter().map(|pair| &pair.wilcoxon).collect()
            } else {
                result.recommended.overall.iter().collect()
            };
            let of_trials = &result.as_in_the_thesis.tests;
            for place in 0..of_trials.len().max(of_people.len()) {
                let (trials, people) = (of_trials.get(place), of_people.get(place).copied());
                let label = if place == 0 { result.id.clone() } else { String::new() };
                let (z, p) = (self.statistic(trials), self.p(trials, false));
                table.row([label, "Z".to_owned(), z, self.statistic(people)]);
                table.row([String::new(), p_name(self), p, self.p(people, true)]);
            }
        }
        table
    }

    pub(crate) fn pairs_layout(&mut self, layout: &TableLayout) -> DataTable {
        let language = self.language();
        let rows = self.layout_rows(layout);
        let name = layout.factors.first().map_or("", String::as_str);
        let levels = self.all_levels(&rows, name);
        let later: Vec<String> =
            levels.iter().skip(1).map(|level| self.naming.level(name, level)).collect();
        let mut headings = vec![language.pick("p of", "p de").to_owned(), String::new()];
        headings.extend(later.iter().chain(&later).cloned());
        let mut table = self.layout_table(layout, headings);
        table.groups = vec![
            (String::new(), 2),
            (thesis_heading(language).to_owned(), later.len()),
            (recommended_heading(language).to_owned(), later.len()),
        ];
        for row in &rows {
            let Some(column) = self.layout_column(&row.measure, name) else { continue };
            if column.about_people {
                continue;
            }
            let of_trials = trial_level::pairs(self.export, &row.measure, &column.factor);
            let of_people = person_level::within(self.export, &row.measure, &column.factor);
            for (place, a) in levels.iter().enumerate().take(levels.len() - 1) {
                let label = if place == 0 { row.measure.label.clone() } else { String::new() };
                let mut line = vec![label, self.naming.level(name, a)];
                let cell = |later: bool, b: &String, text: Option<String>| match text {
                    Some(text) => text,
                    None if later && levels.contains(b) => "NA".to_owned(),
                    None => String::new(),
                };
                let mut recommended = Vec::new();
                for (other, b) in levels.iter().enumerate().skip(1) {
                    let later = other > place;
                    let trials = of_trials.iter().find(|(x, y, _)| x == a && y == b);
                    let people = of_people.pairs.iter().find(|pair| pair.a == *a && pair.b == *b);
                    let p = trials.map(|(.., outcome)| self.p(Some(outcome), false));
                    line.push(cell(later, b, p));
                    let p = people.map(|pair| self.p(Some(&pair.wilcoxon), true));
                    recommended.push(cell(later, b, p));
                    if let (Some((.., trials)), Some(people)) = (trials, people) {
                        self.results.layouts.push(LayoutCell {
                            table: layout.id.clone(),
                            row: row.measure.id.clone(),
                            column: format!("{a} | {b}"),
                            as_in_the_thesis: Some(trials.clone()),
                            recommended: Some(people.wilcoxon.clone()),
                            p_holm: None,
                        });
                    }
                }
                line.extend(recommended);
                table.row(line);
            }
        }
        table
    }

    pub(crate) fn interactions_layout(&mut self, layout: &TableLayout) -> DataTable {
        let language = self.language();
        let rows = self.layout_rows(layout);
        let headings = language.pick(
            ["F1", "F2", "variable", "", "F1", "F2", "F1 × F2", "F1 × F2"],
            ["F1", "F2", "variable", "", "F1", "F2", "F1 × F2", "F1 × F2"],
        );
        let mut table = self.layout_table(layout, headings);
        table.groups = vec![
            (String::new(), 4),
            (thesis_heading(language).to_owned(), 3),
            (recommended_heading(language).to_owned(), 1),
        ];
        for [first, second] in &layout.crossings {
            for row in &rows {
                let columns = [first, second].map(|name| self.layout_column(&row.measure, name));
                let [Some(a), Some(b)] = columns else { continue };
                let values = row.measure.numbers();
                let both = [&a.factor, &b.factor];
                let trials = TestLine::scheirer_ray_hare(&values, both, &Unit::Trials);
                let people = self.recommended_interaction(&row.measure, [&a, &b]);
                let part = |place: usize| trials.get(place).or(trials.first());
                let names = [first, second].map(|name| self.naming.factor(name));
                let [first_name, second_name] = names;
                let mut line =
                    vec![first_name, second_name, row.measure.label.clone(), "Z".to_owned()];
                line.extend((0..3).map(|place| self.statistic(part(place))));
                line.push(self.statistic(people.as_ref()));
                table.row(line);
                let mut line = vec![String::new(), String::new(), String::new(), p_name(self)];
                line.extend((0..3).map(|place| self.p(part(place), false)));
                line.push(self.p(people.as_ref(), true));
                table.row(line);
                for (place, outcome) in trials.iter().enumerate() {
                    self.results.layouts.push(LayoutCell {
                        table: layout.id.clone(),
                        row: format!("{first} x {second}: {}", row.measure.id),
                        column: ["F1", "F2", "F1 x F2"][place.min(2)].to_owned(),
                        as_in_the_thesis: Some(outcome.clone()),
                        recommended: people.clone().filter(|_| place == 2),
                        p_holm: None,
                    });
                }
            }
        }
        table
    }

    /// Of two factors within people the aligned rank transform; of one within and one about people,
    /// whether people's differences depend on it.
    fn recommended_interaction(
        &self,
        measure: &Measure,
        columns: [&Column; 2],
    ) -> Option<TestOutcome> {
        let [first, second] = columns;
        match columns.map(|column| column.about_people) {
            [true, true] => None,
            [false, false] => {
                let both = [&first.factor, &second.factor];
                person_level::two_way(self.export, measure, both).overall.pop()
            }
            [true, false] => {
                Some(two_way::interaction(self.export, measure, &second.factor, &first.factor))
            }
            [false, true] => {
                Some(two_way::interaction(self.export, measure, &first.factor, &second.factor))
            }
        }
    }

    pub(crate) fn influences_layout(&mut self, layout: &TableLayout) -> DataTable {
        let language = self.language();
        let rows = self.layout_rows(layout);
        let mut headings = vec!["variable".to_owned(), String::new()];
        headings.extend(layout.factors.iter().map(|name| self.naming.column(name)));
        let mut table = self.layout_table(layout, headings);
        for row in &rows {
            let pairs: Vec<_> = layout
                .factors
                .iter()
                .map(|name| {
                    let column = self.layout_column(&row.measure, name)?;
                    Some(self.influence(row, &column))
                })
                .collect();
            let trials = |pair: &Option<[TestOutcome; 2]>| pair.as_ref().map(|p| p[0].clone());
            let people = |pair: &Option<[TestOutcome; 2]>| pair.as_ref().map(|p| p[1].clone());
            let mut line = vec![row.measure.label.clone(), "Z".to_owned()];
            line.extend(pairs.iter().map(|pair| self.statistic(trials(pair).as_ref())));
            table.row(line);
            let mut line = vec![String::new(), p_name(self)];
            line.extend(pairs.iter().map(|pair| self.p(trials(pair).as_ref(), false)));
            table.row(line);
            let words = language.pick("recommended", "recommandé").to_owned();
            let mut line = vec![String::new(), words];
            line.extend(pairs.iter().map(|pair| self.statistic(people(pair).as_ref())));
            table.row(line);
            let mut line = vec![String::new(), p_name(self)];
            line.extend(pairs.iter().map(|pair| self.p(people(pair).as_ref(), false)));
            table.row(line);
            for (name, pair) in layout.factors.iter().zip(pairs) {
                if let Some([trials, people]) = pair {
                    self.results.layouts.push(LayoutCell {
                        table: layout.id.clone(),
                        row: row.measure.id.clone(),
                        column: name.clone(),
                        as_in_the_thesis: Some(trials),
                        recommended: Some(people),
                        p_holm: None,
                    });
                }
            }
        }
        table
    }

    /// As in the thesis, then recommended. Numbers are correlated, words are compared.
    fn influence(&self, row: &Row<'_>, column: &Column) -> [TestOutcome; 2] {
        let (measure, factor) = (&row.measure, &column.factor);
        if factor.levels.len() < 2 {
            let why = NotTested::TooFewLevels { factor: factor.name.clone() };
            return [why.clone(), why].map(TestOutcome::undefined);
        }
        // Conditions are names, even those of digits.
        let numeric = factor.name != ASSIGNED_CONDITION
            && factor.levels.iter().all(|level| level.parse::<f64>().is_ok());
        let recognition = measure.kind == MeasureKind::Recognition;
        let undefined = || TestOutcome::undefined(Why::NoTest);
        match (column.about_people, numeric) {
            (true, true) => {
                let x = as_numbers(factor);
                let people = person_level::correlation(&x, measure).overall.pop();
                let people = people.unwrap_or_else(undefined);
                // Right and wrong have no order to correlate: the thesis too takes each person's share.
                let trials = if recognition {
                    people.clone()
                } else {
                    TestLine::spearman(&x, &measure.numbers(), &Unit::Trials)
                };
                [trials, people]
            }
            (true, false) => {
                let people = person_level::between(measure, factor).overall.pop();
                [trial_level::overall(measure, factor), people.unwrap_or_else(undefined)]
            }
            (false, true) if !recognition => {
                let x = as_numbers(factor);
                let trials = TestLine::spearman(&x, &measure.numbers(), &Unit::Trials);
                [trials, person_level::correlation_with_levels(self.export, measure, factor)]
            }
            (false, _) => {
                let people = person_level::within(self.export, measure, factor);
                let first_pair = people.pairs.into_iter().next().map(|pair| pair.wilcoxon);
                let people = people.overall.into_iter().next().or(first_pair);
                [trial_level::overall(measure, factor), people.unwrap_or_else(undefined)]
            }
        }
    }

    /// `χ² 0.645`.
    fn statistic(&self, outcome: Option<&TestOutcome>) -> String {
        match outcome {
            Some(Outcome::Ok(line)) => {
                let name = match line.names.statistic_symbol {
                    "rho" => "ρ",
                    other => other,
                };
                format!("{name} {}", self.language().fixed(line.row.statistic, 3))
            }
            Some(Outcome::Undefined { .. }) => "NA".to_owned(),
            None => String::new(),
        }
    }

    fn p(&self, outcome: Option<&TestOutcome>, holm: bool) -> String {
        let language = self.language();
        match outcome {
            Some(Outcome::Ok(line)) => {
                let p = line.p_holm.filter(|_| holm).unwrap_or(line.row.p_value);
                language.p(p).replacen("p = ", "", 1).replacen("p < ", "<", 1)
            }
            Some(Outcome::Undefined { .. }) => "NA".to_owned(),
            None => String::new(),
        }
    }
}

fn p_name(writer: &Writer<'_>) -> String {
    writer.language().pick("p-value", "p-valeur").to_owned()
}
