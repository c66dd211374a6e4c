//! The R and Python functions of every test, on random data: they find the row that the test itself
//! gives.

use std::fmt::Write as _;
use std::path::Path;
use std::process::Command;

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

/// What is given to the procedure, and the calls of its functions, with `d` for the data.
fn calls(
    sample: Sample,
    function: &str,
) -> ([(&'static str, &'static str); 4], Vec<String>, Vec<String>) {
    let one = |r: &str, python: &str| {
        (vec![format!("{function}({r})")], vec![format!("{function}({python})")])
    };
    let effects = |r: &str, python: &str| {
        let each = |arguments: &str| {
            (1..=3).map(|effect| format!("{function}({arguments}, {effect})")).collect()
        };
        (each(r), each(python))
    };
    let groups = (
        "list(values = d$y, groups = factor(d$g))",
        "[d['y'][d['g'] == g] for g in np.unique(d['g'])]",
    );
    let (given, (r, python)) = match sample {
        Sample::Groups => {
            ([("response", "y"), ("group", "g"), ("", ""), ("", "")], one(groups.0, groups.1))
        }
        Sample::Counts => {
            ([("rows", "g"), ("columns", "y"), ("", ""), ("", "")], one(groups.0, groups.1))
        }
        Sample::Columns => {
            ([("x", "x"), ("y", "y"), ("", ""), ("", "")], one("d$x, d$y", "d['x'], d['y']"))
        }
        Sample::Differences => {
            ([("difference", "y"), ("", ""), ("", ""), ("", "")], one("d$y", "d['y']"))
        }
        Sample::Blocks => (
            [("response", "y"), ("group", "g"), ("block", "b"), ("", "")],
            one(
                "matrix(d$y, ncol = length(unique(d$g)), byrow = TRUE)",
                "d['y'].reshape(-1, len(np.unique(d['g'])))",
            ),
        ),
        Sample::TwoFactors => (
            [("response", "y"), ("factors", "g,h"), ("ss", "1"), ("", "")],
            effects("d$y, d$g, d$h", "d['y'], d['g'], d['h']"),
        ),
        Sample::TwoFactorsInBlocks => (
            [("response", "y"), ("factors", "g,h"), ("block", "b"), ("", "")],
            effects("d$y, d$g, d$h, d$b", "d['y'], d['g'], d['h'], d['b']"),
        ),
        Sample::Other => unreachable!("no test"),
    };
    (given, r, python)
}

/// A number that a peer must find: place of the call, its name, the value.
type Expected = (usize, &'static str, f64);

/// Scripts in R and Python that print `place name value`, and what they must print.
fn scripts(folder: &Path) -> (String, String, Vec<Expected>) {
    let mut random = Random::new(20_261_123);
    let (mut r, mut python) = (
        "show <- function(place, v) cat(sprintf(\"%d %s %.17g\\n\", place, names(v), v), sep = \"\")\n".to_owned(),
        "import math\nimport numpy as np\nfrom scipy import stats\ndef show(place, v):\n    for name, value in v.items():\n        print(place, name, repr(float(value)))\n".to_owned(),
    );
    let tests: Vec<&&Procedure> =
        PROCEDURES.iter().filter(|procedure| procedure.sample != Sample::Other).collect();
    for procedure in &tests {
        r += procedure.r;
        python += procedure.python;
    }
    let (mut expected, mut place) = (Vec::new(), 0);
    for procedure in tests {
        let mut compared = 0;
        for set in 0..SETS {
            let groups = if procedure.name == "mann-whitney" { 2 } else { 3 };
            let rows = data(procedure.sample, groups, &mut random);
            let mut csv = COLUMNS.join(",") + "\n";
            for row in &rows {
                let _ = writeln!(csv, "{}", row.map(|cell| cell.to_string()).join(","));
            }
            let file = folder.join(format!("{}-{set}.csv", procedure.name));
            std::fs::write(&file, &csv).unwrap();
            let (given, _, _) = calls(procedure.sample, "");
            let split = |text: &str| text.split(',').map(str::to_owned).collect::<Vec<_>>();
            let given = given.iter().filter(|(option, _)| !option.is_empty());
            let arguments =
                Arguments::new(given.map(|(option, text)| ((*option).to_owned(), split(text))));
            let table = Table::parse(csv.as_bytes()).unwrap();
            let (names, found) = (procedure.run)(&table, &arguments).unwrap().test.unwrap();
            let (_, in_r, in_python) = calls(procedure.sample, names.function);
            let file = file.to_str().unwrap();
            let _ = writeln!(r, "d <- read.csv(\"{file}\")");
            let _ = writeln!(python, "d = np.genfromtxt(r\"{file}\", delimiter=\",\", names=True)");
            for ((row, in_r), in_python) in found.iter().zip(&in_r).zip(&in_python) {
                let Outcome::Ok(row) = row else { continue };
                let _ = writeln!(r, "show({place}, {in_r})");
                let _ = writeln!(python, "show({place}, {in_python})");
                expected.extend([
                    (place, "statistic", row.statistic),
                    (place, "p", row.p_value),
                    (place, "n", row.n as f64),
                ]);
                expected.extend(row.effect.map(|effect| (place, "effect", effect)));
                place += 1;
                compared += 1;
            }
        }
        assert!(compared >= SETS - 1, "{}: only {compared} rows", procedure.name);
    }
    (r, python, expected)
}

fn compare(output: std::process::Output, expected: &[Expected]) {
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{errors}");
    let text = String::from_utf8_lossy(&output.stdout);
    let found: Vec<Vec<&str>> = text.lines().map(|line| line.split(' ').collect()).collect();
    for (place, name, value) in expected {
        let own = place.to_string();
        let line = found.iter().find(|line| line[0] == own && line[1] == *name);
        let line = line.unwrap_or_else(|| panic!("no {name} of {place}\n{errors}"));
        let theirs: f64 = line[2].parse().unwrap();
        let size = value.abs().max(theirs.abs());
        // A sum of squares near zero is rounding in both.
        assert!(
            (value - theirs).abs() <= 1e-8 * size + 1e-12,
            "call {place}, {name}: {value}, the peer has {theirs}"
        );
    }
}

#[test]
fn r_functions_find_the_rows_of_the_tests() {
    let name = "r_functions_find_the_rows_of_the_tests";
    let Some(rscript) = mimique_test_support::rscript(name) else { return };
    let folder = tempfile::tempdir().unwrap();
    let (script, _, expected) = scripts(folder.path());
    let path = folder.path().join("script.R");
    std::fs::write(&path, script).unwrap();
    compare(Command::new(rscript).arg(path).output().unwrap(), &expected);
}

#[test]
fn python_functions_find_the_rows_of_the_tests() {
    let name = "python_functions_find_the_rows_of_the_tests";
    let Some(python) = mimique_test_support::python(name) else { return };
    let folder = tempfile::tempdir().unwrap();
    let (_, script, expected) = scripts(folder.path());
    let path = folder.path().join("script.py");
    std::fs::write(&path, script).unwrap();
    compare(Command::new(python).arg(path).output().unwrap(), &expected);
}
