//! The report's numbers for other programs: the trials as a table, every number under a key, and
//! scripts in R and Python that compute them again and compare.

use std::borrow::Cow;
use std::fmt::Write;

use mimique_stats::{Outcome, PROCEDURES, Procedure};
use rayon::iter::{IntoParallelIterator, ParallelIterator};

use crate::hypothesis::call::{Argument, Call, Design};
use crate::hypothesis::comparison::Comparison;
use crate::hypothesis::person_level::{Pair, PersonLevel};
use crate::hypothesis::test_line::TestLine;
use crate::hypothesis::trial_level::TrialLevel;
use crate::language::Language;
use crate::report::ReportFile;
use crate::report::document::csv_text;
use crate::report::results::Results;
use crate::report::section::Writer;
use crate::trials::export::Export;
use crate::trials::measure::{Measure, MeasureKind};

/// One computation: a key, how it is called, and what came out.
struct Check {
    key: String,
    call: Call,
    values: Vec<(&'static str, f64)>,
}

/// p-values that are corrected together: keys of their checks, and keys for the corrected ones.
struct Family {
    of: Vec<String>,
    into: Vec<String>,
    p_holm: Vec<f64>,
}

/// `analysis.R`, `analysis.py` and what they read.
pub(crate) fn files(writer: &Writer<'_>) -> Vec<ReportFile> {
    let (checks, families) = Collector::of(&writer.results);
    let file = |path: &str, text: String| ReportFile { path: path.to_owned(), text };
    let tests = |code: fn(&Procedure) -> &'static str, between: &str| -> String {
        let codes = PROCEDURES.iter().map(|procedure| code(procedure).trim());
        codes.filter(|code| !code.is_empty()).collect::<Vec<_>>().join(between)
    };
    let r = include_str!("scripts/analysis.R")
        .replacen("@TESTS@", &tests(|procedure| procedure.r, "\n\n"), 1)
        .replacen("@CALLS@\n", &calls(&checks, &families, Script::R), 1)
        .replacen("@MODELS@\n", &models(writer), 1);
    let python = include_str!("scripts/analysis.py")
        .replacen("@TESTS@", &tests(|procedure| procedure.python, "\n\n\n"), 1)
        .replacen("@CALLS@\n", &calls(&checks, &families, Script::Python), 1);
    vec![
        file("analysis.R", r),
        file("analysis.py", python),
        file("data/trials.csv", trials(writer)),
        file("data/numbers.csv", numbers(&checks, &families)),
    ]
}

/// Walks the results.
#[derive(Default)]
struct Collector {
    checks: Vec<Check>,
    families: Vec<Family>,
}

impl Collector {
    fn of(results: &Results<'_>) -> (Vec<Check>, Vec<Family>) {
        let mut all = Self::default();
        let mut decided = Family { of: Vec::new(), into: Vec::new(), p_holm: Vec::new() };
        for result in &results.hypotheses {
            let key = format!("hypothesis:{}", result.id);
            all.trial_level(&key, &result.as_in_the_thesis);
            all.person_level(&key, &result.recommended);
            if let (Some(p_holm), Some(deciding)) =
                (result.p_holm_over_hypotheses, deciding_key(&key, &result.recommended))
            {
                decided.of.push(deciding);
                decided.into.push(format!("{key}:over hypotheses"));
                decided.p_holm.push(p_holm);
            }
        }
        all.families.extend((!decided.of.is_empty()).then_some(decided));
        for matrix in &results.confusion {
            let by = matrix.by.as_deref().unwrap_or_default();
            let result = &matrix.result;
            let [wilson_low, wilson_high] = result.accuracy_ci_wilson;
            let mut values = vec![
                ("n", result.n as f64),
                ("accuracy", result.accuracy),
                ("wilson_low", wilson_low),
                ("wilson_high", wilson_high),
            ];
            values.extend(result.kappa.map(|kappa| ("kappa", kappa)));
            let call = Call::new(Design::Answers, "confusion").text(&matrix.response).text(by);
            let levels = matrix.by.as_ref().map(|_| matrix.of.clone());
            all.checks.push(Check {
                key: format!("confusion:{}:{}", matrix.response, matrix.of),
                call: call.list(levels.as_slice()),
                values,
            });
        }
        for comparison in &results.comparisons {
            all.comparison(comparison);
        }
        for two in &results.two_way {
            let key = format!("two-way:{}:{}", two.measure, two.factors.join(":"));
            all.trial_level(&key, &two.as_in_the_thesis);
            all.person_level(&key, &two.recommended);
        }
        for course in &results.course {
            all.line(format!("course:{}", course.measure), &course.trend);
        }
        all.layouts(results);
        (all.checks, all.families)
    }

    fn comparison(&mut self, comparison: &Comparison) {
        let (measure, factor) = (&comparison.measure, &comparison.factor);
        let key = format!("comparison:{measure}:{factor}");
        for (level, outcome) in comparison.descriptions.iter() {
            let Outcome::Ok(d) = outcome else { continue };
            let mut values = vec![
                ("n", d.n as f64),
                ("mean", d.mean),
                ("median", d.median),
                ("q1", d.q1),
                ("q3", d.q3),
            ];
            values.extend(d.sd.map(|sd| ("sd", sd)));
            self.checks.push(Check {
                key: format!("{key}:{level}"),
                call: Call::new(Design::Level, "describe").text(measure).text(factor).text(level),
                values,
            });
        }
        for (place, (level, mean)) in comparison.person_means.iter().enumerate() {
            let Some(mean) = mean else { continue };
            let call = Call::new(Design::PersonMean, "mean").text(measure).text(factor);
            self.checks.push(Check {
                key: format!("{key}:{level}:people"),
                call: call.list(&comparison.levels).number(place + 1),
                values: vec![("mean", *mean)],
            });
        }
        self.trial_level(&key, &comparison.as_in_the_thesis);
        self.person_level(&key, &comparison.recommended);
    }

    fn layouts(&mut self, results: &Results<'_>) {
        let mut family = Family { of: Vec::new(), into: Vec::new(), p_holm: Vec::new() };
        let mut row = None;
        for cell in &results.layouts {
            let key = format!("table:{}:{}:{}", cell.table, cell.row, cell.column);
            // The pairs of a row are corrected together.
            if row.replace((&cell.table, &cell.row)) != Some((&cell.table, &cell.row)) {
                self.close(&mut family);
            }
            if let Some(outcome) = &cell.as_in_the_thesis {
                self.line(format!("{key}:thesis"), outcome);
            }
            if let Some(outcome) = &cell.recommended {
                let key = format!("{key}:recommended");
                self.line(key.clone(), outcome);
                if let Outcome::Ok(TestLine { p_holm: Some(p), call, .. }) = outcome
                    && call.design == Design::People
                {
                    family.of.push(key.clone());
                    family.into.push(key);
                    family.p_holm.push(*p);
                }
            }
        }
        self.close(&mut family);
    }

    fn close(&mut self, family: &mut Family) {
        let empty = Family { of: Vec::new(), into: Vec::new(), p_holm: Vec::new() };
        let whole = std::mem::replace(family, empty);
        self.families.extend((!whole.of.is_empty()).then_some(whole));
    }

    fn trial_level(&mut self, key: &str, trials: &TrialLevel) {
        for (place, outcome) in trials.tests.iter().enumerate() {
            self.line(format!("{key}:thesis {}", place + 1), outcome);
        }
    }

    fn person_level(&mut self, key: &str, people: &PersonLevel) {
        for (place, outcome) in people.overall.iter().enumerate() {
            self.line(overall_key(key, place), outcome);
        }
        let mut family = Family { of: Vec::new(), into: Vec::new(), p_holm: Vec::new() };
        for pair in &people.pairs {
            let key = pair_key(key, pair);
            self.line(key.clone(), &pair.wilcoxon);
            let (Outcome::Ok(line), Some(check)) = (&pair.wilcoxon, self.checks.last_mut()) else {
                continue;
            };
            if let Some(difference) = pair.difference {
                check.values.extend([
                    ("estimate", difference.estimate),
                    ("low", difference.ci_low),
                    ("high", difference.ci_high),
                ]);
            }
            if let Some(p_holm) = line.p_holm {
                family.of.push(key.clone());
                family.into.push(key);
                family.p_holm.push(p_holm);
            }
        }
        self.close(&mut family);
    }

    fn line(&mut self, key: String, outcome: &Outcome<TestLine>) {
        let Outcome::Ok(line) = outcome else { return };
        let mut values = vec![
            ("statistic", line.row.statistic),
            ("p", line.row.p_value),
            ("n", line.row.n as f64),
        ];
        values.extend(line.row.effect.map(|effect| ("effect", effect)));
        if line.call.design == Design::DifferencesByTrait {
            values.extend(line.p_holm.map(|p| ("p_holm", p)));
        }
        self.checks.push(Check { key, call: line.call.clone(), values });
    }
}

fn overall_key(key: &str, place: usize) -> String {
    format!("{key}:recommended {}", place + 1)
}

fn pair_key(key: &str, pair: &Pair) -> String {
    format!("{key}:{} | {}", pair.a, pair.b)
}

/// The check whose p decides a hypothesis.
fn deciding_key(key: &str, people: &PersonLevel) -> Option<String> {
    match (people.overall.len(), people.pairs.as_slice()) {
        (0, [one]) => Some(pair_key(key, one)),
        (0, _) => None,
        (several, _) => Some(overall_key(key, several - 1)),
    }
}

#[derive(Clone, Copy, PartialEq)]
enum Script {
    R,
    Python,
}

fn calls(checks: &[Check], families: &[Family], script: Script) -> String {
    let mut text = String::new();
    let list = |items: &[String]| {
        let items: Vec<String> = items.iter().map(|item| quoted(item)).collect();
        match script {
            Script::R if items.is_empty() => "character()".to_owned(),
            Script::R => format!("c({})", items.join(", ")),
            Script::Python => format!("[{}]", items.join(", ")),
        }
    };
    for check in checks {
        let columns = check.call.arguments.iter().map(|argument| match argument {
            Argument::Text(text) => quoted(text),
            Argument::List(items) => list(items),
            Argument::Number(number) => number.to_string(),
        });
        let arguments: Vec<String> =
            std::iter::once(check.call.test.to_owned()).chain(columns).collect();
        let call = format!("{}({})", check.call.design.function(), arguments.join(", "));
        let _ = writeln!(text, "check({}, {call})", quoted(&check.key));
    }
    for family in families {
        let _ = writeln!(text, "holm({}, {})", list(&family.of), list(&family.into));
    }
    text
}

/// A text between quotes, read alike by R and Python.
fn quoted(text: &str) -> String {
    let mut quoted = String::from("\"");
    for c in text.chars() {
        match c {
            '"' => quoted.push_str("\\\""),
            '\\' => quoted.push_str("\\\\"),
            '\n' => quoted.push_str("\\n"),
            '\r' => quoted.push_str("\\r"),
            '\t' => quoted.push_str("\\t"),
            c => quoted.push(c),
        }
    }
    quoted.push('"');
    quoted
}

fn numbers(checks: &[Check], families: &[Family]) -> String {
    let line =
        |key: &str, name: &str, value: f64| [key.to_owned(), name.to_owned(), format!("{value:?}")];
    let of_checks = checks.iter().flat_map(|check| {
        check.values.iter().map(move |(name, value)| line(&check.key, name, *value))
    });
    let of_families = families.iter().flat_map(|family| {
        let corrected = family.into.iter().zip(&family.p_holm);
        corrected.map(move |(key, p_holm)| line(key, "p_holm", *p_holm))
    });
    let heading = ["key", "name", "value"].map(str::to_owned);
    csv_text(std::iter::once(heading).chain(of_checks).chain(of_families))
}

/// A column of the trials' file.
enum Cells<'e> {
    Texts(Vec<&'e str>),
    Numbers(Vec<Option<f64>>),
}

impl Cells<'_> {
    /// The text of a cell, in bytes.
    fn bytes(&self, row: usize) -> Cow<'_, [u8]> {
        match self {
            Self::Texts(cells) => Cow::Borrowed(cells[row].as_bytes()),
            Self::Numbers(cells) => match cells[row] {
                Some(number) => Cow::Owned(number.to_string().into_bytes()),
                None => Cow::Borrowed(&[]),
            },
        }
    }
}

/// One line a trial in the analysis: person, clip, factors, answers about the person, every measure.
fn trials(writer: &Writer<'_>) -> String {
    let export: &Export = writer.export;
    let rows = export.trials.len();
    let mut person = vec![0; rows];
    for answer in export.answers.values().flatten() {
        person[answer.trial] = answer.person;
    }
    let ids = person.iter().map(|&person| export.people[person].id.as_str());
    let clips = export.trials.iter().map(|trial| &*trial.stimulus);
    let orders = export.trials.iter().map(|trial| trial.order.map(|order| order as f64));
    let mut columns: Vec<(String, Cells<'_>)> = vec![
        ("participant_id".to_owned(), Cells::Texts(ids.collect())),
        ("stimulus".to_owned(), Cells::Texts(clips.collect())),
        ("trial_order".to_owned(), Cells::Numbers(orders.collect())),
    ];
    for (place, factor) in export.factors.iter().enumerate() {
        let levels = export.trials.iter().map(|trial| trial.levels[place].as_deref());
        columns
            .push((factor.clone(), Cells::Texts(levels.map(Option::unwrap_or_default).collect())));
    }
    for (name, cells) in &export.about {
        let texts = person.iter().map(|&person| cells[person].as_deref().unwrap_or_default());
        columns.push((name.clone(), Cells::Texts(texts.collect())));
    }
    let mut measures: Vec<Measure> = Vec::new();
    for asked in export.questions(writer.study) {
        let measure = Measure::of_question(export, &asked, Language::English);
        if measure.as_ref().is_some_and(|measure| measure.kind == MeasureKind::Recognition) {
            let (mut truth, mut given) = (vec![""; rows], vec![""; rows]);
            for answer in export.answers_to(&asked.id) {
                truth[answer.trial] = answer.truth.as_deref().unwrap_or_default();
                given[answer.trial] = &answer.text;
            }
            columns.push((format!("{}.truth", asked.id), Cells::Texts(truth)));
            columns.push((format!("{}.answer", asked.id), Cells::Texts(given)));
        }
        measures.extend(measure);
        measures.extend(Measure::response_time(export, &asked, Language::English));
    }
    for measure in measures {
        let mut cells = vec![None; rows];
        for (value, &trial) in measure.values.iter().zip(&measure.trial) {
            cells[trial] = Some(*value);
        }
        columns.push((measure.id, Cells::Numbers(cells)));
    }
    in_lines(&columns, rows)
}

/// The columns as CSV, pieces of it at the same time.
fn in_lines(columns: &[(String, Cells<'_>)], rows: usize) -> String {
    let lines = |first: usize| {
        let row = |row: usize| columns.iter().map(move |(_, cells)| cells.bytes(row));
        csv_text((first..(first + ROWS).min(rows)).map(row))
    };
    let starts: Vec<usize> = (0..rows).step_by(ROWS).collect();
    let pieces: Vec<String> = starts.into_par_iter().map(lines).collect();
    csv_text([columns.iter().map(|(name, _)| name)]) + &pieces.concat()
}

/// Lines of the trials' file that are written together.
const ROWS: usize = 4096;

/// Mixed models of each rating and each recognition on the first two factors.
fn models(writer: &Writer<'_>) -> String {
    let mut text = String::new();
    let Some(first) = writer.factors.first() else { return text };
    let second = writer.factors.get(1);
    let fixed = if second.is_some() { "a * b" } else { "a" };
    let clips = if writer.one_clip_a_cell() { "" } else { " + (1 | clip)" };
    for asked in writer.export.questions(writer.study) {
        let Some(measure) = Measure::of_question(writer.export, &asked, Language::English) else {
            continue;
        };
        let data = format!(
            "data.frame(y = number({}), a = factor(trials[[{}]]), {}person = factor(person), clip = factor(trials$stimulus))",
            quoted(&measure.id),
            quoted(first),
            second.map_or_else(String::new, |second| {
                format!("b = factor(trials[[{}]]), ", quoted(second))
            })
        );
        let random = format!("(1 | person) + (1 | person:a){clips}");
        let (title, package, model) = if measure.kind == MeasureKind::Recognition {
            (
                format!("Binomial mixed model of {}", measure.id),
                "lme4",
                format!("lme4::glmer(y ~ {fixed} + {random}, data, family = binomial)"),
            )
        } else if measure.scale.is_some() {
            (
                format!("Cumulative link mixed model of {}", measure.id),
                "ordinal",
                format!("ordinal::clmm(ordered(y) ~ {fixed} + {random}, data)"),
            )
        } else {
            continue;
        };
        let by = second.map_or_else(String::new, |second| format!(", b = {second}"));
        let title = quoted(&format!("{title} (a = {first}{by})"));
        let _ = writeln!(
            text,
            "fit({title}, \"{package}\", function() {{\n  data <- {data}\n  {model}\n}})"
        );
    }
    text
}
