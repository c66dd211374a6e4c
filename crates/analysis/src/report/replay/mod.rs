//! The report's numbers for other programs: the trials as a table, every number under a key, and
//! scripts in R and Python that compute them again and compare.

mod blocks;
mod by_person;
mod check;
mod checks;
mod models;
mod shown;
mod trials;

use std::fmt::Write;

use mimique_report::ReportFile;
use mimique_report::document::csv_text;
use mimique_stats::{PROCEDURES, Procedure};

use crate::hypothesis::call::Argument;
use crate::report::section::Writer;
use check::{Check, Family, Nearness};
use checks::Collector;
use models::models;
use trials::trials;

/// `analysis.R`, `analysis.py` and what they read.
pub(crate) fn files(writer: &Writer<'_>) -> Vec<ReportFile> {
    let (checks, families) = Collector::of(&writer.results);
    let file = |path: &str, text: String| ReportFile { path: path.to_owned(), text };
    let tests = |code: fn(&Procedure) -> &'static str, between: &str| -> String {
        let codes = PROCEDURES.iter().map(|procedure| code(procedure).trim());
        codes.filter(|code| !code.is_empty()).collect::<Vec<_>>().join(between)
    };
    let r = include_str!("../scripts/analysis.R")
        .replacen("@TESTS@", &tests(|procedure| procedure.r, "\n\n"), 1)
        .replacen("@BLOCKS@", include_str!("../scripts/blocks.R").trim(), 1)
        .replacen("@CALLS@\n", &calls(&checks, &families, Script::R), 1)
        .replacen("@MODELS@\n", &models(writer), 1);
    let python = include_str!("../scripts/analysis.py")
        .replacen("@TESTS@", &tests(|procedure| procedure.python, "\n\n\n"), 1)
        .replacen("@BLOCKS@", include_str!("../scripts/blocks.py").trim(), 1)
        .replacen("@CALLS@\n", &calls(&checks, &families, Script::Python), 1);
    vec![
        file("analysis.R", r),
        file("analysis.py", python),
        file("data/trials.csv", trials(writer)),
        file("data/numbers.csv", numbers(&checks, &families)),
    ]
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
            Argument::Given(number) => format!("{number:?}"),
        });
        let arguments: Vec<String> =
            std::iter::once(check.call.test.to_owned()).chain(columns).collect();
        let call = format!("{}({})", check.call.design.function(), arguments.join(", "));
        let _ = writeln!(text, "check({}, {call})", quoted(&check.key));
    }
    for family in families {
        let mut arguments = vec![list(&family.of), list(&family.into)];
        let is_repeated = family.hypothesis.windows(2).any(|pair| pair[0] == pair[1]);
        if is_repeated {
            let hypotheses: Vec<String> = family.hypothesis.iter().map(usize::to_string).collect();
            arguments.push(list(&hypotheses));
        }
        let _ = writeln!(text, "holm({})", arguments.join(", "));
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

/// Key, name, value, and the difference that other programs may have beside that of rounding.
fn numbers(checks: &[Check], families: &[Family]) -> String {
    let line = |key: &str, name: &str, value: f64, nearness: Nearness| {
        let tolerance = nearness.tolerance(value).to_string();
        [key.to_owned(), name.to_owned(), format!("{value:?}"), tolerance]
    };
    let of_checks = checks.iter().flat_map(|check| {
        check.named().map(move |(name, value)| line(&check.key, &name, value, check.nearness))
    });
    let of_families = families.iter().flat_map(|family| {
        let corrected = family.into.iter().zip(&family.p_holm);
        corrected.map(move |(key, p_holm)| line(key, "p_holm", *p_holm, family.nearness))
    });
    let heading = ["key", "name", "value", "tolerance"].map(str::to_owned);
    csv_text(std::iter::once(heading).chain(of_checks).chain(of_families))
}
