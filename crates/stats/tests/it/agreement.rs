//! Random data sets with ties, by R and by SciPy and by the library: the same numbers.
//!
//! The normal run takes 300 data sets; `MIMIQUE_AGREEMENT=10000` takes more, and writes what it found
//! to `tests/records/` at the repository's root.

use std::fmt::Write as _;
use std::path::Path;
use std::process::Command;

use mimique_stats::{
    Blocks, Contingency, CoupledPlay, Couplings, Courses, Factor, LagWindow,
    LaggedCorrelationOptions, Numbers, SumsOfSquares, Surrogates, WilcoxonOptions, WilcoxonVariant,
    chi_square, friedman, kruskal_wallis, lagged_correlation, mann_whitney, scheirer_ray_hare,
    spearman, wilcoxon,
};
use mimique_test_support::Random;
use serde_json::json;

const TESTS: [&str; 7] =
    ["kruskal", "wilcoxon", "mannwhitney", "spearman", "chisquare", "friedman", "srh"];

/// One data set: a test, values, and codes or second values.
struct DataSet {
    test: &'static str,
    x: Vec<f64>,
    y: Vec<f64>,
}

fn data_sets(count: usize) -> Vec<DataSet> {
    let mut random = Random::new(20_261_121);
    (0..count)
        .map(|place| {
            let test = TESTS[place % TESTS.len()];
            let n = 8 + (random.uniform() * random.uniform() * 200.0) as usize;
            // From ratings of few steps to values without ties.
            let steps = [3.0, 7.0, 20.0, 1e12][(random.uniform() * 4.0) as usize];
            let shift = random.uniform();
            let mut value = || ((random.normal() + shift).clamp(-3.0, 3.0) * steps / 6.0).round();
            let mut x: Vec<f64> = (0..n).map(|_| value()).collect();
            let mut y: Vec<f64> = match test {
                "spearman" => x.iter().map(|x| (0.4 * x + value()).round()).collect(),
                "kruskal" => (0..n).map(|i| (i % 4) as f64).collect(),
                "srh" => {
                    // Unbalanced, every cell there: three times four codes, some twice as often.
                    (0..n.max(24)).map(|i| if i < 12 { i } else { i * i % 12 } as f64).collect()
                }
                _ => (0..n).map(|i| f64::from(u8::from(i % 5 < 2))).collect(),
            };
            match test {
                "chisquare" => x.iter_mut().for_each(|x| *x = x.rem_euclid(5.0)),
                "friedman" => x.truncate(n - n % 3),
                "srh" => x.extend((x.len()..y.len()).map(|i| (i % 7) as f64)),
                "wilcoxon" | "kruskal" | "mannwhitney" | "spearman" => {}
                other => unreachable!("{other}"),
            }
            if matches!(test, "wilcoxon" | "friedman") {
                y.clear();
            }
            DataSet { test, x, y }
        })
        .collect()
}

/// What the library gives; none where it is undefined.
fn own(data: &DataSet) -> Option<Vec<f64>> {
    let column = |name: &str, values: &[f64]| Numbers { name: name.into(), values: values.into() };
    let factor = |values: Vec<f64>| {
        let cells: Vec<String> = values.iter().map(ToString::to_string).collect();
        Factor::from_cells("g", cells.iter().map(|cell| Some(cell.as_str())), |c| c.parse().ok())
    };
    let x = column("x", &data.x);
    match data.test {
        "kruskal" => {
            let result = kruskal_wallis(&x, &factor(data.y.clone())).unwrap().ok()?;
            Some(vec![result.statistic, result.p_value])
        }
        "wilcoxon" => {
            let options =
                WilcoxonOptions { variant: WilcoxonVariant::Thesis, ..Default::default() };
            let result = wilcoxon(&x, options).unwrap().ok()?;
            Some(vec![result.statistic, result.p_value])
        }
        "mannwhitney" => {
            let result = mann_whitney(&x, &factor(data.y.clone())).unwrap().ok()?;
            Some(vec![result.statistic, result.p_value])
        }
        "spearman" => {
            let result = spearman(&x, &column("y", &data.y)).unwrap().ok()?;
            Some(vec![result.rho, result.p_value?])
        }
        "chisquare" => {
            let table = Contingency::of(&factor(data.x.clone()), &factor(data.y.clone())).ok()?;
            let result = chi_square(&table).ok()?.default_yates_if_2x2;
            Some(vec![result.statistic, result.p_value])
        }
        "friedman" => {
            let rows: Vec<Vec<f64>> = data.x.chunks_exact(3).map(<[f64]>::to_vec).collect();
            let result = friedman(&Blocks {
                groups: ["a", "b", "c"].map(str::to_owned).to_vec(),
                blocks: (0..rows.len()).map(|row| row.to_string()).collect(),
                responses: rows,
                incomplete: 0,
                dropped: 0,
            })
            .ok()?;
            Some(vec![result.statistic, result.p_value])
        }
        _ => {
            let first = factor(data.y.iter().map(|code| (code / 4.0).floor()).collect());
            let second = factor(data.y.iter().map(|code| code % 4.0).collect());
            let both = [&first, &second];
            let result = scheirer_ray_hare(&x, both, SumsOfSquares::One).unwrap().ok()?.type1;
            let found: Vec<f64> = result.H.iter().chain(&result.p).flatten().copied().collect();
            Some(found)
        }
    }
}

fn write(sets: &[DataSet], path: &Path) {
    let mut text = String::new();
    let list = |values: &[f64]| values.iter().map(f64::to_string).collect::<Vec<_>>().join(" ");
    for data in sets {
        let _ = write!(text, "{}\t{}", data.test, list(&data.x));
        if !data.y.is_empty() {
            let _ = write!(text, "\t{}", list(&data.y));
        }
        text.push('\n');
    }
    std::fs::write(path, text).unwrap();
}

/// How far a peer is from the library, by test: data sets compared, and the largest relative difference.
fn compare(peer: &str, mut command: Command, count: usize) -> Vec<(&'static str, usize, f64)> {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("agreement-{peer}.txt"));
    let sets = data_sets(count);
    write(&sets, &path);
    let output = command.arg(&path).output().unwrap();
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{errors}");
    let text = String::from_utf8_lossy(&output.stdout);
    assert_eq!(text.lines().count(), sets.len(), "{errors}");
    let mut found = TESTS.map(|test| (test, 0usize, 0f64));
    for (place, (data, line)) in sets.iter().zip(text.lines()).enumerate() {
        let theirs: Vec<f64> =
            line.split_whitespace().map(|cell| cell.parse().unwrap_or(f64::NAN)).collect();
        let Some(mut own) = own(data) else {
            // What has no answer here has none there, or one that is no number.
            assert!(theirs.iter().any(|value| !value.is_finite()), "{place} {}: {line}", data.test);
            continue;
        };
        if theirs.is_empty() {
            continue; // The peer has no such test.
        }
        if peer == "scipy" && data.test == "spearman" {
            own.truncate(1); // SciPy's p is that of t, without ties too.
        }
        let test = found.iter_mut().find(|(test, ..)| *test == data.test).unwrap();
        for (value, their) in own.iter().zip(&theirs) {
            // Sums of squares near zero are rounding in both.
            let size = value.abs().max(their.abs()).max(1e-6);
            let difference = (value - their).abs() / size;
            assert!(difference < 1e-8, "data set {place}, {}: {own:?} and {theirs:?}", data.test);
            test.2 = test.2.max(difference);
        }
        test.1 += 1;
    }
    for (test, compared, _) in &found {
        let known = peer != "scipy" || *test != "srh";
        assert!(!known || *compared * 3 > count / TESTS.len(), "{test}: only {compared}");
    }
    record(peer, count, &found);
    found.to_vec()
}

/// Keeps the record of a long run.
fn record(peer: &str, count: usize, found: &[(&str, usize, f64)]) {
    if count < 10_000 {
        return;
    }
    let mut text = format!(
        "# {count} random data sets with ties: the library and {peer}\n\nBy `MIMIQUE_AGREEMENT={count} cargo test --release -p mimique-stats --test it agreement`.\n\n| test | data sets compared | largest relative difference of statistic and p |\n|---|---|---|\n"
    );
    for (test, compared, difference) in found.iter().filter(|(_, compared, _)| *compared > 0) {
        let _ = writeln!(text, "| {test} | {compared} | {difference:.1e} |");
    }
    let folder = mimique_test_support::repository().join("tests/records");
    std::fs::create_dir_all(&folder).unwrap();
    std::fs::write(folder.join(format!("statistics-agreement-{peer}.md")), text).unwrap();
}

fn wanted() -> usize {
    std::env::var("MIMIQUE_AGREEMENT").ok().and_then(|text| text.parse().ok()).unwrap_or(300)
}

#[test]
fn r_agrees_on_random_data_sets() {
    let Some(rscript) = mimique_test_support::rscript("r_agrees_on_random_data_sets") else {
        return;
    };
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/agreement/peers.R");
    let mut command = Command::new(rscript);
    command.arg(script);
    compare("r", command, wanted());
}

#[test]
fn scipy_agrees_on_random_data_sets() {
    let Some(python) = mimique_test_support::python("scipy_agrees_on_random_data_sets") else {
        return;
    };
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/agreement/peers.py");
    let mut command = Command::new(python);
    command.arg(script);
    compare("scipy", command, wanted());
}

/// People who follow clips of two shapes after half a second, with noise of their own and stretches that were not measured.
fn couplings() -> Couplings {
    const INSTANTS: usize = 120;
    let mut random = Random::new(20_261_127);
    let mut course = || -> Vec<f64> {
        let mut state = 0.0;
        let mut step = || {
            state = 0.9 * state + 0.4 * random.normal();
            state
        };
        (0..INSTANTS).map(|_| step()).collect()
    };
    let clips: Vec<Courses> = (0..3).map(|_| vec![course(), course()]).collect();
    let mut plays = Vec::new();
    for person in 0..5 {
        for (clip, shown) in clips.iter().enumerate() {
            let mut follow = |shown: &Vec<f64>| -> Vec<f64> {
                let own = course();
                let seen = |at: usize| at.checked_sub(15).map_or(0.0, |before| shown[before]);
                (0..INSTANTS).map(|at| 0.5 * seen(at) + own[at]).collect()
            };
            let mut track: Courses = shown.iter().map(&mut follow).collect();
            let from = 11 * (person + 3 * clip) % (INSTANTS - 25);
            track.iter_mut().for_each(|course| course[from..from + 25].fill(f64::NAN));
            plays.push(CoupledPlay { person, clip, track });
        }
    }
    Couplings { people: (0..5).map(|person| format!("p{person}")).collect(), clips, plays }
}

#[test]
fn scipy_agrees_on_lagged_correlations_with_gaps() {
    let name = "scipy_agrees_on_lagged_correlations_with_gaps";
    let Some(python) = mimique_test_support::python(name) else { return };
    let given = couplings();
    let window = LagWindow::of_seconds(30.0, [-0.5, 1.5], 2.0);
    let plays: Vec<_> = (given.plays.iter())
        .map(|play| json!({ "person": play.person, "clip": play.clip, "track": play.track }))
        .collect();
    let courses = json!({
        "first": window.first, "last": window.last, "least": window.least,
        "clips": given.clips, "plays": plays,
    });
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("lagged.json");
    std::fs::write(&path, courses.to_string()).unwrap();
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/agreement/lagged.py");
    let output = Command::new(python).arg(script).arg(&path).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let theirs: Vec<Vec<f64>> = (String::from_utf8_lossy(&output.stdout).lines())
        .map(|line| line.split_whitespace().map(|cell| cell.parse().unwrap()).collect())
        .collect();
    let kind = Surrogates::OtherClips;
    let options = LaggedCorrelationOptions { window, surrogates: 19, kind, seed: 1 };
    let own = lagged_correlation(&given, options).unwrap().unwrap();
    assert_eq!((own.lags_s.len(), own.lag_s), (theirs.len(), 0.5));
    let intervals = own.interval_95.unwrap();
    for ((r, [low, high]), their) in own.r.iter().zip(&intervals).zip(&theirs) {
        for (value, their) in [r, low, high].into_iter().zip(their) {
            assert!((value - their).abs() < 1e-12, "{value} and {their}");
        }
    }
}
