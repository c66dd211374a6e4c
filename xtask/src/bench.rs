//! `cargo xtask bench`: the solver and its peers on the same problem in one go, and their ratios.
//!
//! Ours (`crates/stimulus/benches/figures.rs`), SciPy (`tests/peers/solvers.py`) and the browser's
//! module in node (`tests/wasm/solver_speed.mjs`) run as three processes that take turns, a
//! measurement at a time, so that what else the machine does falls on all of them alike. Times are
//! processor time; a ratio is the median of the ratios of the rounds.

use std::io::{BufRead, BufReader, Write as _};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

use anyhow::{Context, Result, bail};

use crate::bench_plot;
use crate::bench_stats;
use crate::install;
use crate::process::{cargo, output, root, say, show, target};
use crate::web;

/// Options of `cargo xtask bench`.
#[derive(clap::Args)]
pub struct Args {
    /// The statistics beside SciPy and polars instead of the solver
    #[arg(long, conflicts_with_all = ["browser", "plot"])]
    stats: bool,
    /// Rounds; more are steadier
    #[arg(long, default_value_t = 5)]
    rounds: usize,
    /// Solve 54 clips in Chromium too
    #[arg(long)]
    browser: bool,
    /// Draw set-up time and memory against the number of vertices, up to a million
    #[arg(long)]
    plot: bool,
    /// Write the figures into docs/solver-benchmarks.md, or docs/statistics-benchmarks.md
    #[arg(long)]
    record: bool,
}

/// A process that answers lines with lines of JSON.
pub struct Partner {
    child: Child,
    to: Option<ChildStdin>,
    from: BufReader<ChildStdout>,
    /// Its first line.
    pub greeting: String,
}

/// Seconds of one measurement, and what they were spent on.
type Seconds = Vec<f64>;

/// Measures, prints, and records where asked.
pub fn run(args: &Args) -> Result<()> {
    if args.stats {
        return bench_stats::run(args.rounds.max(1), args.record);
    }
    let data = crate::test::data();
    if !data.join("lsts/frames").is_dir() {
        bail!("no real data in {}; set MIMIQUE_DATA to their folder", data.display());
    }
    let folder = target().join("bench");
    std::fs::create_dir_all(&folder)?;
    let mut ours = Partner::start(figures(&data).arg(&folder))?;
    let python = match std::env::var_os("MIMIQUE_PYTHON") {
        Some(python) => Ok(PathBuf::from(python)),
        None => install::python("python", &root().join("tests/support/requirements.txt"))?,
    };
    let python = python.map_err(anyhow::Error::msg)?;
    let mut peers = Partner::start(
        Command::new(python)
            .arg(root().join("tests/peers/solvers.py"))
            .arg(&folder)
            .envs(["OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"].map(|n| (n, "1"))),
    )?;
    let dist = std::env::var_os("MIMIQUE_WEB_DIST").map_or_else(web::dist, PathBuf::from);
    let mut wasm = Partner::start(
        Command::new("node").arg(root().join("tests/wasm/solver_speed.mjs")).args([&dist, &folder]),
    )?;
    let apart = |name: &str| number(&peers.greeting, &format!("\"{name}\":"));
    let (bvls, tight, default) = (apart("lsts")?, apart("lsts-norm")?, apart("lsts-norm-default")?);
    say(&format!(
        "largest difference between SciPy's weights and ours: bvls {bvls:.1e}, L-BFGS-B {tight:.1e} (tolerances 0 and 1e-10), {default:.1e} (as it comes)"
    ));
    if !(bvls < 1e-8 && tight < 1e-5) {
        bail!("SciPy finds other weights than we do: nothing to compare");
    }

    let mut rounds: Vec<[f64; 14]> = Vec::new();
    let mut memory = 0.0;
    for round in 1..=args.rounds.max(1) {
        say(&format!("round {round} of {}", args.rounds.max(1)));
        let mut packs = |method: &str| -> Result<[f64; 2]> {
            let native = ours.rate(&format!("packs {method}"))?;
            let line = wasm.ask(method)?;
            memory = number(&line, "\"memory\":")?;
            Ok([native, number(&line, "\"units\":")? / number(&line, "\"seconds\":")?])
        };
        let ([native, in_wasm], [native_norm, in_wasm_norm]) =
            (packs("lsts")?, packs("lsts-norm")?);
        rounds.push([
            ours.rate("lsts")?,
            peers.rate("lsts")?,
            ours.rate("lsts-norm")?,
            peers.rate("lsts-norm")?,
            peers.rate("lsts-norm-default")?,
            ours.rate("front end")?,
            ours.rate("synthesis")?,
            native,
            in_wasm,
            native_norm,
            in_wasm_norm,
            1.0 / ours.rate("set-up 11248")?,
            1.0 / ours.rate("set-up 26719")?,
            ours.rate("lsts fine")?,
        ]);
    }
    let column = |k: usize| median(rounds.iter().map(|r| r[k]).collect());
    let ratio = |a: usize, b: usize| median(rounds.iter().map(|r| r[a] / r[b]).collect());
    let rate = |k: usize| format!("{:.0} frames/s", column(k));
    let against = |a: usize, b: usize, what: &str| {
        let ratios: Vec<f64> = rounds.iter().map(|r| r[a] / r[b]).collect();
        let (least, most) =
            ratios.iter().fold((f64::MAX, 0.0_f64), |(l, m), &r| (l.min(r), m.max(r)));
        format!(
            "{:.0} x {what} ({:.0} frames/s); rounds {least:.0} to {most:.0}",
            ratio(a, b),
            column(b)
        )
    };
    let mut rows: Vec<[String; 4]> = Vec::new();
    let mut row = |what: &str, figure: String, beside: String, goal: &str| {
        rows.push([what.to_owned(), figure, beside, goal.to_owned()]);
    };
    row("`lsts`, solve alone", rate(0), against(0, 1, "bvls"), "80 x");
    row("`lsts-norm`, solve alone", rate(2), against(2, 3, "L-BFGS-B, tight"), "60 x");
    row("", String::new(), against(2, 4, "L-BFGS-B as it comes"), "");
    row(
        "`lsts`, mesh four times as fine",
        rate(13),
        format!("{:.2} of the skin's", ratio(13, 0)),
        "the same",
    );
    row("front end", rate(5), String::new(), "100,000 frames/s");
    row("vertex synthesis, S = 11,248", rate(6), String::new(), "15,000 frames/s");
    let wasm_row =
        |a: usize, b: usize| format!("{:.2} of native ({:.0} frames/s)", ratio(b, a), column(a));
    row("wasm, packs to weights, `lsts`", rate(8), wasm_row(7, 8), "0.6");
    row("wasm, packs to weights, `lsts-norm`", rate(10), wasm_row(9, 10), "0.6");
    row("set-up, skin, S = 11,248", format!("{:.1} ms", 1e3 * column(11)), String::new(), "60 ms");
    row(
        "set-up, whole head",
        format!("{:.1} ms", 1e3 * column(12)),
        "S = 26,511: seams closed".into(),
        "160 ms",
    );
    row(
        "wasm memory",
        format!("{:.1} MiB", memory / 1048576.0),
        "after both methods on 5,660 frames".into(),
        "150 MiB",
    );
    if args.browser {
        let folder_of_tests = root().join("tests/browser");
        install::npm(&folder_of_tests)?;
        let mut node = Command::new("node");
        node.arg(folder_of_tests.join("solver_speed.mjs")).args([&dist, &folder]);
        let line = output(&mut node).with_context(|| format!("failed: {}", show(&node)))?;
        let (played, seconds) = (number(&line, "\"played\":")?, number(&line, "\"seconds\":")?);
        let gap = number(&line, "\"longestGapMs\":")?;
        let none = line.contains("\"longTasks\":[]");
        let blocked = if none {
            "no task of 50 ms on the page"
        } else {
            "the page was blocked for 50 ms or more"
        };
        row(
            "54 clips of 4 s in Chromium's worker",
            format!("{:.0} x as fast as they play", played / seconds),
            format!("{seconds:.2} s; {blocked}, longest gap {gap:.0} ms"),
            "20 x, never 50 ms",
        );
    }
    let table = table(&rows);
    print(&table);
    if args.plot {
        let points = bench_plot::measure(|parts| {
            let mut command = figures(&data);
            command.args(["scale", &parts.to_string()]);
            output(&mut command).with_context(|| format!("failed: {}", show(&command)))
        })?;
        let file = root().join("docs/solver-set-up.svg");
        std::fs::write(&file, bench_plot::svg(&points))?;
        say(&format!("drawn: {}", file.display()));
    }
    if args.record {
        let versions = format!(
            "SciPy {}, NumPy {}, {} rounds.",
            text(&peers.greeting, "scipy")?,
            text(&peers.greeting, "numpy")?,
            rounds.len()
        );
        record(
            "docs/solver-benchmarks.md",
            &format!(
                "{table}\n{versions} Largest difference between SciPy's weights and ours: bvls {bvls:.1e}, L-BFGS-B {tight:.1e} with tolerances 0 and 1e-10, {default:.1e} as it comes.\n"
            ),
        )?;
    }
    Ok(())
}

/// The native side, one thread, built if need be.
fn figures(data: &Path) -> Command {
    let mut command = cargo();
    command.args(["bench", "--quiet", "--package", "mimique-stimulus", "--bench", "figures", "--"]);
    command.env("RAYON_NUM_THREADS", "1").env("MIMIQUE_DATA", data);
    command
}

impl Partner {
    /// Starts it and waits for its greeting.
    pub fn start(command: &mut Command) -> Result<Partner> {
        let shown = show(command);
        say(&shown);
        let mut child = command
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .with_context(|| format!("could not start: {shown}"))?;
        let (to, from) = (child.stdin.take(), child.stdout.take());
        let from = BufReader::new(from.context("no standard output")?);
        let mut partner = Partner { child, to, from, greeting: String::new() };
        partner.greeting = partner.line().with_context(|| format!("failed: {shown}"))?;
        Ok(partner)
    }

    fn line(&mut self) -> Result<String> {
        loop {
            let mut line = String::new();
            if self.from.read_line(&mut line)? == 0 {
                bail!("it ended before it answered");
            }
            if line.starts_with('{') {
                return Ok(line);
            }
        }
    }

    /// The answer to a line.
    pub fn ask(&mut self, what: &str) -> Result<String> {
        let to = self.to.as_mut().context("it takes no more questions")?;
        writeln!(to, "{what}")?;
        to.flush()?;
        self.line().with_context(|| what.to_owned())
    }

    /// Units a second.
    fn rate(&mut self, what: &str) -> Result<f64> {
        let line = self.ask(what)?;
        Ok(number(&line, "\"units\":")? / number(&line, "\"seconds\":")?)
    }
}

impl Drop for Partner {
    fn drop(&mut self) {
        // The end of its input is its end.
        drop(self.to.take());
        let _ = self.child.wait();
    }
}

/// The number after a key of one line of JSON that we write ourselves.
pub fn number(line: &str, key: &str) -> Result<f64> {
    let rest = line.split_once(key).with_context(|| format!("no {key} in {line}"))?.1;
    let end = rest.find([',', '}', ']']).unwrap_or(rest.len());
    rest[..end].trim().parse().with_context(|| format!("{key} in {line}"))
}

/// The text after a key of one line of JSON that we write ourselves.
pub fn text<'l>(line: &'l str, key: &str) -> Result<&'l str> {
    let rest = line.split_once(&format!("\"{key}\": \"")).with_context(|| format!("no {key}"))?.1;
    Ok(rest.split('"').next().unwrap_or_default())
}

/// Median.
pub fn median(mut values: Seconds) -> f64 {
    values.sort_by(f64::total_cmp);
    let middle = values.len() / 2;
    if values.len() % 2 == 1 { values[middle] } else { 0.5 * (values[middle - 1] + values[middle]) }
}

fn table(rows: &[[String; 4]]) -> String {
    let mut out = String::from("| measure | measured | beside | target |\n|---|---|---|---|\n");
    for [what, figure, beside, goal] in rows {
        out.push_str(&format!("| {what} | {figure} | {beside} | {goal} |\n"));
    }
    out
}

/// Prints a table.
#[expect(clippy::print_stdout, reason = "xtask talks to the person at the terminal")]
pub fn print(table: &str) {
    println!("{table}");
}

/// Writes the figures between the marks of a document.
pub fn record(document: &str, figures: &str) -> Result<()> {
    let file = root().join(document);
    let (start, end) = ("<!-- figures -->\n", "<!-- end of figures -->");
    let text = std::fs::read_to_string(&file).with_context(|| file.display().to_string())?;
    let parts =
        text.split_once(start).and_then(|(head, rest)| Some((head, rest.split_once(end)?.1)));
    let (head, tail) = parts.with_context(|| format!("{document} has lost its marks"))?;
    std::fs::write(&file, format!("{head}{start}{figures}{end}{tail}"))?;
    say(&format!("recorded: {}", file.display()));
    Ok(())
}
