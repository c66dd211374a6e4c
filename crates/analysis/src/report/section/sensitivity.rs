//! How much each verdict depends on choices of the analysis, on single segments and on single participants.

use std::collections::BTreeSet;

use mimique_report::document::{Block, DataTable, slug};

use crate::hypothesis::decision::{Decision, EffectUnit};
use crate::hypothesis::reading;
use crate::report::figure::{Choices, CurvePoint, CurveWords, specification_curve};
use crate::report::section::Writer;
use crate::sensitivity::{
    HypothesisSensitivity, Influence, OmittedUnit, Sensitivity, Specification,
};
use crate::trials::rule::Rule;

impl Writer<'_> {
    /// The section, in a report for which it was asked. Returns what it says of each hypothesis: identifier and words.
    pub(crate) fn sensitivity(&mut self, found: &Sensitivity) -> Vec<(String, String)> {
        self.heading(2, "Sensitivity", "Sensibilité");
        if found.hypotheses.is_empty() {
            self.paragraph(
                "The study file states no hypothesis, so there is no verdict to repeat.",
                "Le fichier de l’étude n’énonce aucune hypothèse : il n’y a aucun verdict à répéter.",
            );
            return Vec::new();
        }
        self.what_is_repeated(found);
        let mut all: Option<DataTable> = None;
        let mut said = Vec::new();
        for own in &found.hypotheses {
            let table = self.specifications(found, own);
            said.push((own.id.clone(), self.hypothesis_sensitivity(found, own, &table)));
            match &mut all {
                Some(all) => all.rows.extend(table.rows),
                None => all = Some(table),
            }
        }
        if let Some(mut table) = all {
            "sensitivity".clone_into(&mut table.id);
            let caption = self.language().pick("All specifications", "Toutes les spécifications");
            caption.clone_into(&mut table.caption);
            self.folded_table(table);
        }
        said
    }

    /// One hypothesis: in words, its curve, and the ranges over omissions. Returns the words.
    fn hypothesis_sensitivity(
        &mut self,
        found: &Sensitivity,
        own: &HypothesisSensitivity,
        table: &DataTable,
    ) -> String {
        let result = self.study.hypotheses.iter().find(|each| each.id == own.id);
        let code = self.language().code();
        let statement = result.map_or("", |hypothesis| hypothesis.statement.in_language(code));
        self.blocks.push(Block::Heading(3, format!("{}. {statement}", own.id)));
        let mut said = reading::dependence(&self.naming, &found.rules, own);
        self.blocks.push(Block::Reading(said.clone()));
        self.curve(found, own, table);
        let words = own.influence.iter().map(|it| reading::influence(&self.naming, own, it));
        let words: Vec<String> = words.filter(|words| !words.is_empty()).collect();
        if !words.is_empty() {
            let words = words.join(" ");
            said = format!("{said} {words}");
            self.blocks.push(Block::Reading(words));
        }
        self.omissions(own);
        said
    }

    /// Which rules and tests, and how many specifications.
    fn what_is_repeated(&mut self, found: &Sensitivity) {
        let language = self.language();
        let all = || found.hypotheses.iter().flat_map(|own| &own.specifications);
        let sets: BTreeSet<&[bool]> = all().map(|own| own.applied.as_slice()).collect();
        let specifications = language.counted(
            all().count(),
            ["specification", "specifications"],
            ["spécification", "spécifications"],
        );
        let choices = match (found.rules.len(), sets.len()) {
            (0, _) => language
                .pick(
                    "every test that can decide the hypothesis (the study file sets no rule of exclusion)",
                    "chaque test qui peut décider l’hypothèse (le fichier de l’étude ne fixe aucune règle d’exclusion)",
                )
                .to_owned(),
            (rules, sets) if sets == 1 << rules => language.pick(
                format!("every combination of the rules of exclusion, applied or not ({sets} in all), with every test that can decide the hypothesis"),
                format!("toutes les combinaisons des règles d’exclusion, appliquées ou non ({sets} en tout), avec chaque test qui peut décider l’hypothèse"),
            ),
            (_, sets) => language.pick(
                format!("all rules of exclusion, all but one of them, and none ({sets} sets of rules), with every test that can decide the hypothesis"),
                format!("toutes les règles d’exclusion, toutes sauf une, et aucune ({sets} ensembles de règles), avec chaque test qui peut décider l’hypothèse"),
            ),
        };
        let words = language.pick(
            format!("Every verdict is repeated under other reasonable choices: {choices}. That makes {specifications} for all hypotheses. p is corrected over the hypotheses as in the rest of the report. Tests of single trials and the cumulative mixed model are not among the tests, because their p is too small. The estimate of min F' is the mean difference of the participants, without an interval. Participants who withdrew or declined, pilot sessions and exclusions by the researcher are excluded in every specification."),
            format!("Chaque verdict est répété avec d’autres choix raisonnables : {choices}. Cela fait {specifications} pour toutes les hypothèses. p est corrigé sur les hypothèses comme dans le reste du rapport. Les tests sur les essais pris un à un et le modèle mixte cumulatif n’en font pas partie, car leur p est trop petit. L’estimation de min F' est la différence moyenne des participants, sans intervalle. Les personnes qui se sont retirées ou n’ont pas donné leur accord, les sessions pilotes et les exclusions par le chercheur sont exclues dans chaque spécification."),
        );
        self.blocks.push(Block::Paragraph(words));
        self.paragraph(
            "Then each segment and each participant is omitted in turn, under the rules and the tests of the study file. Where p is near 0.05 a verdict changes easily: see the range of p, too.",
            "Puis chaque segment et chaque participant est omis tour à tour, avec les règles et les tests du fichier de l’étude. Là où p est proche de 0,05, un verdict change facilement : voyez aussi l’étendue de p.",
        );
    }

    /// A row per specification of a hypothesis, sorted as the curve.
    fn specifications(&self, found: &Sensitivity, own: &HypothesisSensitivity) -> DataTable {
        let language = self.language();
        let (yes, no) = language.pick(("yes", "no"), ("oui", "non"));
        let start = language.pick(
            ["hypothesis", "as fixed in the study file"],
            ["hypothèse", "telle que fixée dans le fichier de l’étude"],
        );
        let end = language.pick(
            ["test", "people", "trials", "estimate", "low", "high", "unit", "p", "verdict"],
            ["test", "personnes", "essais", "estimation", "bas", "haut", "unité", "p", "verdict"],
        );
        let rules = found.rules.iter().map(|rule| self.rule_label(rule));
        let columns = start.map(str::to_owned).into_iter().chain(rules);
        let caption = language
            .pick(format!("{}: specifications", own.id), format!("{} : spécifications", own.id));
        let id = format!("sensitivity-{}", slug(&own.id));
        let mut table = DataTable::new(id, caption, columns.chain(end.map(str::to_owned)));
        if !found.rules.is_empty() {
            let excluded = language.pick("excluded", "exclus").to_owned();
            let rules = found.rules.len();
            table.groups = vec![(String::new(), 2), (excluded, rules), (String::new(), end.len())];
        }
        let first = own.of_the_study_file();
        for each in sorted(own) {
            let finding = &each.finding;
            let estimate = finding.estimate.as_ref();
            let number = |value: Option<f64>| match (value, estimate) {
                (Some(value), Some(own)) => language.fixed(in_unit(own.unit, value), 3),
                _ => String::new(),
            };
            let interval = estimate.and_then(|own| own.interval);
            let mut row = vec![own.id.clone()];
            row.push(if first == Some(each) { yes } else { no }.to_owned());
            row.extend(each.applied.iter().map(|own| if *own { yes } else { no }.to_owned()));
            row.push(reading::test_choice(language, own.kind, each.test).to_owned());
            row.extend([each.people, each.trials].map(|count| count.to_string()));
            row.push(number(estimate.map(|own| own.value)));
            row.extend([
                number(interval.map(|[low, _]| low)),
                number(interval.map(|[_, high]| high)),
            ]);
            row.push(estimate.map_or_else(String::new, |own| self.unit_label(own.unit).to_owned()));
            row.push(finding.p.map_or_else(String::new, |p| language.p_cell(p, p.ln())));
            row.push(reading::verdict_of(&self.naming, own, finding));
            table.row(row);
        }
        table
    }

    /// The specification curve, of the specifications that can be computed.
    fn curve(&mut self, found: &Sensitivity, own: &HypothesisSensitivity, table: &DataTable) {
        let language = self.language();
        let tests: BTreeSet<_> = own.specifications.iter().map(|each| each.test as u8).collect();
        let tests: Vec<_> = (tests.into_iter())
            .filter_map(|test| own.specifications.iter().find(|each| each.test as u8 == test))
            .map(|each| each.test)
            .collect();
        let first = own.of_the_study_file();
        let points: Vec<CurvePoint> = (sorted(own).into_iter())
            .filter_map(|each| {
                let estimate = each.finding.estimate.as_ref();
                let drawn = |value: f64| in_unit(estimate.and_then(|own| own.unit), value);
                let of_tests = tests.iter().map(|test| each.test == *test);
                Some(CurvePoint {
                    estimate: estimate.map(|own| drawn(own.value)),
                    interval: estimate.and_then(|own| own.interval).map(|ends| ends.map(drawn)),
                    p: each.finding.p?,
                    shown: each.finding.verdict.as_ref().is_some_and(|own| is_shown(own.decision)),
                    of_the_study_file: first == Some(each),
                    made: each.applied.iter().copied().chain(of_tests).collect(),
                })
            })
            .collect();
        if points.len() < 2 {
            return;
        }
        let mut choices = Vec::new();
        if !found.rules.is_empty() {
            let rows = found.rules.iter().map(|rule| self.rule_label(rule)).collect();
            choices.push(Choices { heading: language.pick("excluded", "exclus"), rows });
        }
        let rows = tests
            .iter()
            .map(|test| reading::test_choice_short(language, own.kind, *test).to_owned())
            .collect();
        choices.push(Choices { heading: "test", rows });
        let words = self.curve_words(own, &points);
        let data = DataTable { caption: words.caption.clone(), ..table.clone() };
        let figure = specification_curve(language, words, &points, &choices, data);
        self.figure(figure);
    }

    fn curve_words(&self, own: &HypothesisSensitivity, points: &[CurvePoint]) -> CurveWords {
        let language = self.language();
        let estimate = own.specifications.iter().find_map(|each| each.finding.estimate.as_ref());
        let unit = estimate.and_then(|own| own.unit);
        let of = match estimate.and_then(|own| own.levels.as_ref()) {
            Some([a, b]) if unit == Some(EffectUnit::Chosen) => {
                let [a, b] = [a, b].map(|level| self.naming.level(&own.factor, level));
                language.pick(format!("{a} over {b}"), format!("{a} plutôt que {b}"))
            }
            Some([a, b]) => self.naming.pair(&own.factor, a, b),
            None => language.pick("rank correlation", "corrélation des rangs").to_owned(),
        };
        let estimates = match unit {
            Some(_) => format!("{of} ({})", self.unit_label(unit)),
            None => of,
        };
        let caption = language.pick(
            format!("{}: specification curve. Filled: shown; open: not shown; diamond: as fixed in the study file", own.id),
            format!("{} : courbe des spécifications. Plein : montré ; vide : non montré ; losange : tel que fixé dans le fichier de l’étude", own.id),
        );
        let shown = points.iter().filter(|point| point.shown).count();
        let values: Vec<f64> = points.iter().filter_map(|point| point.estimate).collect();
        let range = match (values.first(), values.last()) {
            (Some(low), Some(high)) => {
                let [low, high] = [low, high].map(|value| language.fixed(*value, 2));
                language.pick(
                    format!(" Estimates ({estimates}) from {low} to {high}."),
                    format!(" Estimations ({estimates}) de {low} à {high}."),
                )
            }
            _ => String::new(),
        };
        let n = points.len();
        let alt = language.pick(
            format!("{n} specifications, in {shown} of which something was shown.{range} The rows below mark the rules that are applied and the test."),
            format!("{n} spécifications, dont {shown} ont montré quelque chose.{range} Les lignes du bas indiquent les règles appliquées et le test."),
        );
        let no_effect = if unit == Some(EffectUnit::Chosen) { 50.0 } else { 0.0 };
        CurveWords {
            id: format!("sensitivity-{}", slug(&own.id)),
            caption,
            alt,
            estimates,
            no_effect,
        }
    }

    /// Ranges over all omissions, a row per kind of unit.
    fn omissions(&mut self, own: &HypothesisSensitivity) {
        if own.influence.is_empty() {
            return;
        }
        let language = self.language();
        let columns = language.pick(
            [
                "omitted, one at a time",
                "number",
                "not computable",
                "estimate, from",
                "to",
                "p, from",
                "to",
                "change the verdict",
            ],
            [
                "omis un à un",
                "nombre",
                "non calculables",
                "estimation, de",
                "à",
                "p, de",
                "à",
                "changent le verdict",
            ],
        );
        let caption = language.pick(
            format!("{}: segments and participants omitted one at a time", own.id),
            format!("{} : segments et participants omis un à un", own.id),
        );
        let id = format!("sensitivity-{}-omitted", slug(&own.id));
        let mut table = DataTable::new(id, caption, columns);
        for influence in &own.influence {
            table.row(self.influence_row(own, influence));
        }
        self.blocks.push(Block::Table(table));
    }

    fn influence_row(&self, own: &HypothesisSensitivity, influence: &Influence) -> Vec<String> {
        let language = self.language();
        let unit = match influence.unit {
            OmittedUnit::Segment => language.pick("segments", "segments"),
            OmittedUnit::Participant => language.pick("participants", "participants"),
        };
        let all = &influence.omissions;
        let unknown = all.iter().filter(|each| each.finding.p.is_none()).count();
        let estimates: Vec<f64> = (all.iter())
            .filter_map(|each| each.finding.estimate.as_ref())
            .map(|own| in_unit(own.unit, own.value))
            .collect();
        let p: Vec<f64> = all.iter().filter_map(|each| each.finding.p).collect();
        let ends = |values: &[f64], words: &dyn Fn(f64) -> String| -> [String; 2] {
            if values.is_empty() {
                return ["–", "–"].map(str::to_owned);
            }
            let low = values.iter().copied().fold(f64::INFINITY, f64::min);
            let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            [words(low), words(high)]
        };
        let changing: Vec<&str> =
            own.changing(influence).map(|each| each.omitted.as_str()).collect();
        let changing = match changing.as_slice() {
            [] => language.pick("none", "aucun").to_owned(),
            names => names.join(", "),
        };
        let mut row = vec![unit.to_owned(), all.len().to_string(), unknown.to_string()];
        row.extend(ends(&estimates, &|value| language.fixed(value, 2)));
        row.extend(ends(&p, &|p| language.p_cell(p, p.ln())));
        row.push(changing);
        row
    }

    /// A rule in two or three words.
    fn rule_label(&self, rule: &Rule) -> String {
        let reason = rule.reason();
        let words = self.language().pick(reason.english(), reason.french());
        match rule {
            Rule::Bs1534(block) => format!("BS.1534 ({block})"),
            _ => words.to_owned(),
        }
    }

    fn unit_label(&self, unit: Option<EffectUnit>) -> &'static str {
        let language = self.language();
        match unit {
            None => "rho",
            Some(EffectUnit::Points) => language.pick("points", "points"),
            Some(EffectUnit::Shares) => language.pick("percentage points", "points de pourcentage"),
            Some(EffectUnit::Seconds) => "s",
            Some(EffectUnit::Chosen | EffectUnit::ChosenOverOthers) => {
                language.pick("% of choices", "% des choix")
            }
            Some(EffectUnit::Worth) => language.pick("JND", "DJP"),
        }
    }
}

/// The specifications by their estimates, then those without an estimate by p, then those that cannot be computed.
fn sorted(own: &HypothesisSensitivity) -> Vec<&Specification> {
    let mut sorted: Vec<&Specification> = own.specifications.iter().collect();
    let key = |each: &Specification| {
        let estimate = each.finding.estimate.as_ref().map_or(f64::INFINITY, |own| own.value);
        (estimate, each.finding.p.unwrap_or(f64::INFINITY))
    };
    sorted.sort_by(|a, b| {
        let (a, b) = (key(a), key(b));
        a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1))
    });
    sorted
}

/// A value in the unit in which it is printed: shares as percentages.
fn in_unit(unit: Option<EffectUnit>, value: f64) -> f64 {
    match unit {
        Some(EffectUnit::Shares | EffectUnit::Chosen | EffectUnit::ChosenOverOthers) => {
            100.0 * value
        }
        _ => value,
    }
}

/// Whether a decision is that something was shown.
fn is_shown(decision: Decision) -> bool {
    !matches!(
        decision,
        Decision::NotShown(_)
            | Decision::NotTested
            | Decision::NotForOtherClips
            | Decision::Equivalence(mimique_stats::EquivalenceVerdict::Undecided)
    )
}
