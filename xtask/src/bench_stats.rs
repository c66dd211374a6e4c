//! `cargo xtask bench --stats`: the statistics and their peers in one go, and the ratios.
//!
//! Ours (`crates/stats/benches/million_rows.rs`) and SciPy, NumPy and polars (`peers.py` beside it) are
//! two processes that take turns, a measurement at a time, so that what else the machine does falls on
//! both alike: each measurement is the quickest of three, a ratio is the median of the ratios of the
//! rounds. Then the command itself, from the file to the printed result, on a million rows, on the
//! studies of the thesis, and on ten thousand participants.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Instant;

use anyhow::{Context, Result, bail};

use crate::bench_figures::{extremes, median, print, record};
use crate::bench_partner::{Partner, number, text};
use crate::demo;
use crate::install;
use crate::process::{cargo, root, say, show, target};

const TESTS: [&str; 4] = ["Kruskal-Wallis", "Wilcoxon", "Spearman", "Scheirer-Ray-Hare"];
/// Participants of the large study.
const MANY: &str = "10000";

/// Measures, prints, and records where asked.
pub fn run(rounds: usize, recorded: bool) -> Result<()> {
    demo::binary()?;
    let folder = target().join("bench-stats");
    std::fs::create_dir_all(&folder)?;
    let benches = root().join("crates/stats/benches");
    let python = match std::env::var_os("MIMIQUE_PYTHON") {
        Some(python) => PathBuf::from(python),
        None => install::python("python-stats", &benches.join("requirements.txt"))?
            .map_err(anyhow::Error::msg)?,
    };
    let file = folder.join("million.csv");
    let mut command = cargo();
    command.args(["bench", "--quiet", "--package", "mimique-stats", "--bench", "million_rows"]);
    let mut ours = Partner::start(command.args(["--", "--serve"]).arg(&file))?;
    let peers = || {
        let mut command = Command::new(&python);
        command.arg(benches.join("peers.py")).arg(&file);
        command
    };
    let mut theirs = Partner::start(&mut peers())?;
    let mut table = String::from(
        "| a million rows | Mimique, ms | peer, ms | times faster |\n|---|---|---|---|\n",
    );
    for (what, beside) in measurements() {
        let mut times = Vec::new();
        for _ in 0..rounds {
            let seconds = |partner: &mut Partner| number(&partner.ask(&what)?, "\"seconds\":");
            times.push((seconds(&mut ours)?, seconds(&mut theirs)?));
        }
        let ratios: Vec<f64> = times.iter().map(|(own, peer)| peer / own).collect();
        let [least, most] = extremes(&ratios);
        let own = 1e3 * median(times.iter().map(|(own, _)| *own).collect());
        let peer = 1e3 * median(times.iter().map(|(_, peer)| *peer).collect());
        let name = if what == "read" { "CSV to typed columns" } else { &what };
        table.push_str(&format!(
            "| {name} | {own:.0} | {peer:.0} ({beside}) | {:.1}; rounds {least:.1} to {most:.1} |\n",
            median(ratios)
        ));
        say(&format!("{name}: {own:.0} ms, {beside} {peer:.0} ms"));
    }
    let times_file = number(&ours.ask("memory")?, "\"times\":")?;
    let versions = format!(
        "NumPy {}, SciPy {}, polars {}; {rounds} rounds; {} threads. Reading takes {times_file:.1} times the file in memory at its peak.",
        text(&theirs.greeting, "numpy")?,
        text(&theirs.greeting, "scipy")?,
        text(&theirs.greeting, "polars")?,
        std::thread::available_parallelism()?,
    );
    drop((ours, theirs));
    let commands = commands(rounds, &folder, &file, peers)?;
    let model = mixed_model(&folder)?;
    let commands = format!("{commands}\n{model}");
    print(&format!("{table}\n{versions}\n\n{commands}"));
    if recorded {
        let document = "docs/measured/statistics-benchmarks.md";
        record(document, &format!("{table}\n{versions}\n\n{commands}"))?;
    }
    Ok(())
}

/// A cumulative link mixed model and R's `ordinal::clmm`, one after the other; or that R has no such package.
fn mixed_model(folder: &Path) -> Result<String> {
    let file = folder.join("mixed-model.csv");
    let mut command = cargo();
    command.args([
        "bench",
        "--quiet",
        "--package",
        "mimique-stats",
        "--bench",
        "mixed_model",
        "--",
    ]);
    let own = seconds(command.arg(&file))?;
    let script = root().join("crates/stats/benches/mixed_model.R");
    let mut r = Command::new("Rscript");
    let table = "| model | Mimique, s | R, s | times faster |\n|---|---|---|---|\n";
    let what = "54 x 100 ratings, 4 random terms, likelihood ratio test";
    Ok(match seconds(r.arg(script).arg(&file)) {
        Ok(peer) => {
            format!("{table}| {what} | {own:.2} | {peer:.1} (ordinal) | {:.0} |\n", peer / own)
        }
        Err(why) => {
            format!(
                "{table}| {what} | {own:.2} | - | - |\n\nNo R with the package ordinal: {why:#}\n"
            )
        }
    })
}

/// The seconds that a command prints as JSON.
fn seconds(command: &mut Command) -> Result<f64> {
    let shown = show(command);
    let output = command.output().with_context(|| format!("could not start: {shown}"))?;
    if !output.status.success() {
        bail!("failed: {shown}: {}", String::from_utf8_lossy(&output.stderr));
    }
    number(&String::from_utf8_lossy(&output.stdout), "\"seconds\":")
}

/// Names of measurements, and whom each is compared with.
fn measurements() -> Vec<(String, &'static str)> {
    let mut all = vec![("read".to_owned(), "polars")];
    for kind in ["ratings", "doubles"] {
        for test in TESTS {
            let peer = if test == "Scheirer-Ray-Hare" { "NumPy" } else { "SciPy" };
            all.push((format!("{test}, {kind}"), peer));
        }
    }
    all
}

/// The commands, from start to end.
fn commands(
    rounds: usize,
    folder: &Path,
    file: &Path,
    peers: impl Fn() -> Command,
) -> Result<String> {
    let mimique = |arguments: &[&str]| {
        let mut command = Command::new(demo::binary_path());
        command.args(arguments).current_dir(root());
        command
    };
    let path = |name: &str| folder.join(name).to_string_lossy().into_owned();
    let mut table =
        String::from("| command | seconds | memory, MiB | target |\n|---|---|---|---|\n");
    let mut row = |name: &str, run: &Run, target: &str| {
        let memory = run.memory.map_or("-".to_owned(), |bytes| format!("{:.0}", bytes / 1048576.0));
        table.push_str(&format!("| {name} | {:.3} | {memory} | {target} |\n", run.seconds));
        say(&format!("{name}: {:.3} s", run.seconds));
    };
    row("`mimique --version`", &best(10 * rounds, &mut mimique(&["--version"]))?, "0.020 s");
    let million = file.to_string_lossy();
    let mut kruskal = mimique(&[
        "test",
        "kruskal-wallis",
        &million,
        "--response",
        "seconds",
        "--group",
        "method",
    ]);
    row("`mimique test kruskal-wallis`, a million rows", &best(rounds, &mut kruskal)?, "");
    row("the same by polars and SciPy", &best(rounds, peers().arg("--once"))?, "");

    for (study, participants, name, runs, target) in
        [("study1", "27", "27 x 54", rounds, "1 s"), ("study1", MANY, "10,000 x 54", 1, "20 s")]
    {
        let study_file = format!("study-config/{study}.json");
        let export = path(&format!("{study}-{participants}"));
        let mut simulate =
            mimique(&["simulate", &study_file, "--seed", "1", "--participants", participants]);
        simulate.args(["--out", &export]);
        row(&format!("`mimique simulate`, {name}"), &best(1, &mut simulate)?, "");
        let answers = Path::new(&export)
            .join(format!("{study}_responses.csv"))
            .to_string_lossy()
            .into_owned();
        let report = path(&format!("report-{study}-{participants}"));
        let mut analyze = mimique(&["analyze", &answers, "--study", &study_file, "--out", &report]);
        row(&format!("`mimique analyze`, {name}"), &best(runs, &mut analyze)?, target);
    }
    let mut power = mimique(&["power", "study-config/study1.json", "--participants", "10,20,40"]);
    power.args(["--runs", "200", "--out", &path("power")]);
    row("`mimique power`, study 1, 10, 20, 40 participants, 200 runs", &best(1, &mut power)?, "");
    Ok(table)
}

/// A run of a command.
pub struct Run {
    /// From its start to its end.
    pub seconds: f64,
    /// Peak resident bytes, where the machine tells.
    pub memory: Option<f64>,
}

/// The quickest of some runs.
pub fn best(runs: usize, command: &mut Command) -> Result<Run> {
    let shown = show(command);
    let mut best = Run { seconds: f64::INFINITY, memory: None };
    for _ in 0..runs {
        let start = Instant::now();
        let mut child = command
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .spawn()
            .with_context(|| format!("could not start: {shown}"))?;
        let status = format!("/proc/{}/status", child.id());
        // The peak only grows, so the last look before the end tells it.
        let end = loop {
            if let Some(end) = child.try_wait()? {
                break end;
            }
            best.memory = peak(&status).or(best.memory);
            std::thread::sleep(std::time::Duration::from_millis(1));
        };
        if !end.success() {
            bail!("failed ({end}): {shown}");
        }
        best.seconds = best.seconds.min(start.elapsed().as_secs_f64());
    }
    Ok(best)
}

/// Peak resident memory that the system states of a process.
pub fn peak(status: &str) -> Option<f64> {
    let text = std::fs::read_to_string(status).ok()?;
    let line = text.lines().find(|line| line.starts_with("VmHWM"))?;
    Some(line.split_whitespace().nth(1)?.parse::<f64>().ok()? * 1024.0)
}
