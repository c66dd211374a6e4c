//! The R and Python functions of every procedure, on random data: they find the row that the test itself
//! gives, and the coefficients.

mod samples;

use std::fmt::Write as _;
use std::path::Path;
use std::process::Command;

use self::samples::{Replay, special, told};
use mimique_stats::{Arguments, Outcome, PROCEDURES, Procedure, Sample, Table};
use mimique_test_support::Random;

/// Data sets per test.
const SETS: usize = 6;

/// Rows of a data set: value, second value, group, second factor, block.
fn data(sample: Sample, groups: usize, random: &mut Random) -> Vec<[f64; 5]> {
    let size = 6 + (random.uniform() * 30.0) as usize;
    let shift = random.uniform();
    // From ratings of few steps, with ties and zeros, to values without.
    let steps = [3.0, 7.0, 1e9][(random.uniform() * 3.0) as usize];
    let mut value = |more: f64| ((random.normal() + shift + more) * steps / 3.0).round();
    (0..size * groups * 2)
        .map(|row| {
            let (group, second) = (row % groups, row / groups % 2);
            let block = match sample {
                Sample::Blocks => row / groups,
                _ => row / groups / 2,
            };
            let y = value(0.4 * group as f64);
            [y, y + value(0.0), group as f64, second as f64, block as f64]
        })
        .collect()
}

const COLUMNS: [&str; 5] = ["y", "x", "g", "h", "b"];

/// A data set of a procedure, and what its functions take.
fn replay(procedure: &Procedure, random: &mut Random) -> Replay {
    let sample = procedure.sample;
    if let Some(own) = special(sample, procedure.name, random) {
        return own;
    }
    let groups = if procedure.name == "mann-whitney" { 2 } else { 3 };
    let mut csv = COLUMNS.join(",") + "\n";
    for row in data(sample, groups, random) {
        let _ = writeln!(csv, "{}", row.map(|cell| cell.to_string()).join(","));
    }
    let (given, r, python) = calls(sample);
    Replay { csv, given, r, python }
}

/// What is given to the procedure, and what its functions take, with `d` for the data.
fn calls(sample: Sample) -> (Vec<(&'static str, &'static str)>, Vec<String>, Vec<String>) {
    let one = |r: &str, python: &str| (vec![r.to_owned()], vec![python.to_owned()]);
    let effects = |r: &str, python: &str| {
        let each =
            |arguments: &str| (1..=3).map(|effect| format!("{arguments}, {effect}")).collect();
        (each(r), each(python))
    };
    let groups = (
        "list(values = d$y, groups = factor(d$g))",
        "[d['y'][d['g'] == g] for g in np.unique(d['g'])]",
    );
    let (given, (r, python)) = match sample {
        Sample::Groups => (vec![("response", "y"), ("group", "g")], one(groups.0, groups.1)),
        Sample::Counts => (vec![("rows", "g"), ("columns", "y")], one(groups.0, groups.1)),
        Sample::Columns => (vec![("x", "x"), ("y", "y")], one("d$x, d$y", "d['x'], d['y']")),
        Sample::Differences => (vec![("difference", "y")], one("d$y", "d['y']")),
        Sample::Blocks => (
            vec![("response", "y"), ("group", "g"), ("block", "b")],
            one(
                "matrix(d$y, ncol = length(unique(d$g)), byrow = TRUE)",
                "d['y'].reshape(-1, len(np.unique(d['g'])))",
            ),
        ),
        Sample::TwoFactors => (
            vec![("response", "y"), ("factors", "g,h"), ("ss", "1")],
            effects("d$y, d$g, d$h", "d['y'], d['g'], d['h']"),
        ),
        Sample::TwoFactorsInBlocks => (
            vec![("response", "y"), ("factors", "g,h"), ("block", "b")],
            effects("d$y, d$g, d$h, d$b", "d['y'], d['g'], d['h'], d['b']"),
        ),
        other => unreachable!("{other:?} has data of its own"),
    };
    (given, r, python)
}

/// Values by name.
type Values = Vec<(&'static str, f64)>;

/// What the functions of a procedure are called, and for each call the values that it must find.
fn expected_of(
    procedure: &Procedure,
    answer: &mimique_stats::Answer,
) -> (String, Vec<Option<Values>>) {
    let Some((names, rows)) = &answer.test else {
        let json: serde_json::Value = serde_json::from_str(&answer.json).unwrap();
        let value = |place: &str| json.pointer(place).and_then(serde_json::Value::as_f64);
        let found =
            told(procedure.name).iter().map(|(name, place)| Some((*name, value(place)?))).collect();
        return (procedure.name.replace('-', "_"), vec![found]);
    };
    let row = |row: &Outcome<mimique_stats::TestRow>| {
        let Outcome::Ok(row) = row else { return None };
        let mut own = vec![("statistic", row.statistic), ("p", row.p_value), ("n", row.n as f64)];
        own.extend(row.effect.map(|effect| ("effect", effect)));
        Some(own)
    };
    (names.function.to_owned(), rows.iter().map(row).collect())
}

/// A number that a peer must find: the procedure, place of the call, its name, the value.
type Expected = (&'static str, usize, &'static str, f64);

/// Of all procedures but some: scripts in R and Python that print `place name value`, and what they must print.
fn scripts(folder: &Path, but: &[&str]) -> (String, String, Vec<Expected>) {
    let mut random = Random::new(20_261_123);
    let (mut r, mut python) = (
        "show <- function(place, v) cat(sprintf(\"%d %s %.17g\\n\", place, names(v), v), sep = \"\")\n".to_owned(),
        "import math\nimport numpy as np\nfrom scipy import stats\ndef show(place, v):\n    for name, value in v.items():\n        print(place, name, repr(float(value)))\n".to_owned(),
    );
    let procedures: Vec<&&'static Procedure> =
        PROCEDURES.iter().filter(|procedure| procedure.sample != Sample::Other).collect();
    let procedures: Vec<&&'static Procedure> =
        procedures.into_iter().filter(|procedure| !but.contains(&procedure.name)).collect();
    for procedure in &procedures {
        r += procedure.r;
        python += procedure.python;
    }
    let (mut expected, mut place) = (Vec::new(), 0);
    for procedure in procedures {
        let mut compared = 0;
        for set in 0..SETS {
            let replay = replay(procedure, &mut random);
            let file = folder.join(format!("{}-{set}.csv", procedure.name));
            std::fs::write(&file, &replay.csv).unwrap();
            let split = |text: &str| text.split(',').map(str::to_owned).collect::<Vec<_>>();
            let given =
                replay.given.iter().map(|(option, text)| ((*option).to_owned(), split(text)));
            let table = Table::parse(replay.csv.as_bytes()).unwrap();
            let answer = (procedure.run)(&table, &Arguments::new(given)).unwrap();
            let (function, found) = expected_of(procedure, &answer);
            let file = file.to_str().unwrap();
            let _ = writeln!(r, "d <- read.csv(\"{file}\")");
            // Columns of names are texts, all others numbers with a fraction.
            let texts = ["l", "r", "a", "c", "t"].iter().any(|name| {
                replay
                    .csv
                    .lines()
                    .next()
                    .is_some_and(|header| header.split(',').any(|h| h == *name))
            });
            let kind = if texts { ", dtype=None, encoding='utf-8'" } else { "" };
            let _ = writeln!(
                python,
                "d = np.genfromtxt(r\"{file}\", delimiter=\",\", names=True{kind})"
            );
            for ((own, in_r), in_python) in found.into_iter().zip(&replay.r).zip(&replay.python) {
                let Some(own) = own else { continue };
                let _ = writeln!(r, "show({place}, {function}({in_r}))");
                let _ = writeln!(python, "show({place}, {function}({in_python}))");
                let own = own.into_iter();
                expected.extend(own.map(|(name, value)| (procedure.name, place, name, value)));
                place += 1;
                compared += 1;
            }
        }
        assert!(compared >= SETS - 1, "{}: only {compared} rows", procedure.name);
    }
    (r, python, expected)
}

/// How near a peer comes: those that find a maximum by a general optimiser have half of the digits.
fn nearness(procedure: &str) -> f64 {
    match procedure {
        "mixed-model" => 2e-3,
        "linear-mixed-model" => 5e-4,
        "thurstone" | "psychometric" | "difference-scaling" => 1e-5,
        _ => 1e-8,
    }
}

fn compare(output: std::process::Output, expected: &[Expected]) {
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{errors}");
    let text = String::from_utf8_lossy(&output.stdout);
    let found: Vec<Vec<&str>> = text.lines().map(|line| line.split(' ').collect()).collect();
    for (procedure, place, name, value) in expected {
        let own = place.to_string();
        let line = found.iter().find(|line| line[0] == own && line[1] == *name);
        let line =
            line.unwrap_or_else(|| panic!("no {name} of {procedure}, call {place}\n{errors}"));
        let theirs: f64 = line[2].parse().unwrap();
        let size = value.abs().max(theirs.abs());
        // A sum of squares near zero is rounding in both.
        assert!(
            (value - theirs).abs() <= nearness(procedure) * size + 1e-12,
            "{procedure}, call {place}, {name}: {value}, the peer has {theirs}"
        );
    }
}

#[test]
fn r_functions_find_the_rows_of_the_tests() {
    let name = "r_functions_find_the_rows_of_the_tests";
    let Some(rscript) = mimique_test_support::rscript(name) else { return };
    let folder = tempfile::tempdir().unwrap();
    // The functions that take packages.
    let mut but = Vec::new();
    for (function, package, debian) in [
        ("mixed-model", "ordinal", "r-cran-ordinal"),
        ("linear-mixed-model", "lmerTest", "r-cran-lmertest"),
    ] {
        let has = format!("quit(status = 1 - requireNamespace(\"{package}\", quietly = TRUE))");
        if !Command::new(&rscript).args(["-e", &has]).status().unwrap().success() {
            let why = format!("R has no package {package}; install {debian}");
            mimique_test_support::skip(name, &why);
            but.push(function);
        }
    }
    let (script, _, expected) = scripts(folder.path(), &but);
    let path = folder.path().join("script.R");
    std::fs::write(&path, script).unwrap();
    compare(Command::new(rscript).arg(path).output().unwrap(), &expected);
}

#[test]
fn python_functions_find_the_rows_of_the_tests() {
    let name = "python_functions_find_the_rows_of_the_tests";
    let Some(python) = mimique_test_support::python(name) else { return };
    let folder = tempfile::tempdir().unwrap();
    let (_, script, expected) = scripts(folder.path(), &[]);
    let path = folder.path().join("script.py");
    std::fs::write(&path, script).unwrap();
    compare(Command::new(python).arg(path).output().unwrap(), &expected);
}
