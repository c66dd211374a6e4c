//! `cargo xtask bench`: the solver and its peers on the same problem in one go, and their ratios.
//!
//! Ours (`crates/stimulus/benches/figures.rs`), SciPy (`tests/peers/solvers.py`) and the browser's
//! module in node (`tests/wasm/solver_speed.mjs`) run as three processes that take turns, a
//! measurement at a time, so that what else the machine does falls on all of them alike. Times are
//! processor time; a ratio is the median of the ratios of the rounds.

use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, bail};

use crate::bench_annotate;
use crate::bench_figures::{extremes, median, print, record};
use crate::bench_layout;
use crate::bench_partner::{Partner, number, text};
use crate::bench_plot;
use crate::bench_server;
use crate::bench_stats;
use crate::bench_verdicts;
use crate::install;
use crate::process::{cargo, output, root, say, show, target};
use crate::web;

/// Options of `cargo xtask bench`.
#[derive(clap::Args)]
pub struct Args {
    /// The statistics beside SciPy and polars instead of the solver
    #[arg(long, conflicts_with_all = ["browser", "plot"])]
    stats: bool,
    /// The server with a study of a million events, on each database: exports, dashboard, restart
    #[arg(long, conflicts_with_all = ["stats", "browser", "plot"])]
    server: bool,
    /// With --server: the study, by its name in study-config
    #[arg(long, default_value = "demo", requires = "server")]
    study: String,
    /// The annotation beside scikit-learn and hmmlearn instead of the solver
    #[arg(long, conflicts_with_all = ["browser", "plot", "stats", "server"])]
    annotate: bool,
    /// Measure marker layouts beside scikit-learn and NumPy instead of the solver
    #[arg(long, conflicts_with_all = ["browser", "plot", "stats", "annotate"])]
    layout: bool,
    /// Count how often each kind of verdict finds a difference where there is none
    #[arg(long, conflicts_with_all = ["browser", "plot", "stats", "annotate", "layout", "server"])]
    verdicts: bool,
    /// With --verdicts: simulated studies a row
    #[arg(long, default_value_t = 2000, requires = "verdicts")]
    runs: usize,
    /// Rounds; more are steadier
    #[arg(long, default_value_t = 5)]
    rounds: usize,
    /// Solve 54 clips in Chromium too
    #[arg(long)]
    browser: bool,
    /// Draw set-up time and memory against the number of vertices, up to a million
    #[arg(long)]
    plot: bool,
    /// Write the figures into the document of docs/measured that holds them
    #[arg(long)]
    record: bool,
}

/// Measures, prints, and records where asked.
pub fn run(args: &Args) -> Result<()> {
    if args.stats {
        return bench_stats::run(args.rounds.max(1), args.record);
    }
    if args.server {
        return bench_server::run_bench(&args.study, args.record);
    }
    if args.annotate {
        return bench_annotate::run(args.rounds.max(1), args.record);
    }
    if args.verdicts {
        return bench_verdicts::run(args.runs.max(1), args.record);
    }
    if args.layout {
        return bench_layout::run(args.rounds.max(1), args.record);
    }
    let data = crate::test::data();
    if !data.join("lsts/frames").is_dir() {
        bail!("no real data in {}; set MIMIQUE_DATA to their folder", data.display());
    }
    let folder = target().join("bench");
    std::fs::create_dir_all(&folder)?;
    let dist = std::env::var_os("MIMIQUE_WEB_DIST").map_or_else(web::dist, PathBuf::from);
    let mut partners = Partners::start(&data, &folder, &dist)?;
    let differences = Differences::of(&partners.peers)?;
    differences.check()?;
    let mut rounds = Vec::new();
    for round in 1..=args.rounds.max(1) {
        say(&format!("round {round} of {}", args.rounds.max(1)));
        rounds.push(partners.round()?);
    }
    let mut rows = rows(&rounds);
    if args.browser {
        rows.push(in_browser(&dist, &folder)?);
    }
    let table = table(&rows);
    print(&table);
    if args.plot {
        plot(&data)?;
    }
    if args.record {
        let versions = format!(
            "SciPy {}, NumPy {}, {} rounds.",
            text(&partners.peers.greeting, "scipy")?,
            text(&partners.peers.greeting, "numpy")?,
            rounds.len()
        );
        record(
            "docs/measured/solver-benchmarks.md",
            &format!("{table}\n{versions} {}.\n", differences.sentence()),
        )?;
    }
    Ok(())
}

/// The baselines, each timed on the whole take beside `lsts`.
const BASELINES: [&str; 6] = ["box", "ridge", "a2f", "sparse", "smooth-sparse", "greedy"];

/// The processes whose figures are compared: they wait for questions, so that every round asks all of them.
struct Partners {
    ours: Partner,
    peers: Partner,
    wasm: Partner,
}

impl Partners {
    fn start(data: &Path, folder: &Path, dist: &Path) -> Result<Self> {
        let ours = Partner::start(figures(data).arg(folder))?;
        let python = match std::env::var_os("MIMIQUE_PYTHON") {
            Some(python) => Ok(PathBuf::from(python)),
            None => install::python("python", &root().join("tests/support/requirements.txt"))?,
        };
        let python = python.map_err(anyhow::Error::msg)?;
        let one_thread = ["OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"];
        let peers = Partner::start(
            Command::new(python)
                .arg(root().join("tests/peers/solvers.py"))
                .arg(folder)
                .envs(one_thread.map(|name| (name, "1"))),
        )?;
        let script = root().join("tests/wasm/solver_speed.mjs");
        let wasm = Partner::start(Command::new("node").arg(script).args([dist, folder]))?;
        Ok(Self { ours, peers, wasm })
    }

    /// Asks everybody everything once.
    fn round(&mut self) -> Result<Round> {
        let (lsts_wasm, _) = self.wasm("lsts")?;
        let (lsts_norm_wasm, memory) = self.wasm("lsts-norm")?;
        let ours = &mut self.ours;
        let mut baselines = [0.0; BASELINES.len()];
        for (rate, name) in baselines.iter_mut().zip(BASELINES) {
            *rate = ours.rate(name)?;
        }
        Ok(Round {
            baselines,
            lsts: ours.rate("lsts")?,
            lsts_peer: self.peers.rate("lsts")?,
            lsts_norm: ours.rate("lsts-norm")?,
            lsts_norm_peer: self.peers.rate("lsts-norm")?,
            lsts_norm_peer_default: self.peers.rate("lsts-norm-default")?,
            front_end: ours.rate("front end")?,
            synthesis: ours.rate("synthesis")?,
            lsts_wasm,
            lsts_norm_wasm,
            wasm_memory: memory,
            set_up_skin: 1.0 / ours.rate("set-up 11248")?,
            set_up_head: 1.0 / ours.rate("set-up 26719")?,
            lsts_fine: ours.rate("lsts fine")?,
        })
    }

    /// From packs to weights: frames per second natively and in wasm, and the module's memory, bytes.
    fn wasm(&mut self, method: &str) -> Result<([f64; 2], f64)> {
        let native = self.ours.rate(&format!("packs {method}"))?;
        let line = self.wasm.ask(method)?;
        let in_wasm = number(&line, "\"units\":")? / number(&line, "\"seconds\":")?;
        Ok(([native, in_wasm], number(&line, "\"memory\":")?))
    }
}

/// How far SciPy's weights are from ours.
struct Differences {
    bvls: f64,
    /// L-BFGS-B with tolerances 0 and 1e-10.
    tight: f64,
    /// L-BFGS-B as it comes.
    default: f64,
}

impl Differences {
    fn of(peers: &Partner) -> Result<Self> {
        let apart = |name: &str| number(&peers.greeting, &format!("\"{name}\":"));
        let (bvls, tight) = (apart("lsts")?, apart("lsts-norm")?);
        Ok(Self { bvls, tight, default: apart("lsts-norm-default")? })
    }

    /// Only who finds the same weights is compared.
    fn check(&self) -> Result<()> {
        say(&self.sentence());
        if !(self.bvls < 1e-8 && self.tight < 1e-5) {
            bail!("SciPy finds other weights than we do: nothing to compare");
        }
        Ok(())
    }

    fn sentence(&self) -> String {
        let Self { bvls, tight, default } = self;
        format!(
            "Largest difference between SciPy's weights and ours: bvls {bvls:.1e}, L-BFGS-B \
             {tight:.1e} with tolerances 0 and 1e-10, {default:.1e} as it comes"
        )
    }
}

/// The figures of one round: frames per second, seconds of a set-up, bytes of memory.
struct Round {
    /// Of [`BASELINES`].
    baselines: [f64; BASELINES.len()],
    lsts: f64,
    lsts_peer: f64,
    lsts_norm: f64,
    lsts_norm_peer: f64,
    lsts_norm_peer_default: f64,
    front_end: f64,
    synthesis: f64,
    /// From packs to weights, natively and in wasm.
    lsts_wasm: [f64; 2],
    lsts_norm_wasm: [f64; 2],
    wasm_memory: f64,
    set_up_skin: f64,
    set_up_head: f64,
    lsts_fine: f64,
}

/// What is measured, the figure, what it is compared with, the goal.
type Row = [String; 4];

fn row(what: &str, figure: String, beside: String, goal: &str) -> Row {
    [what.to_owned(), figure, beside, goal.to_owned()]
}

fn rows(rounds: &[Round]) -> Vec<Row> {
    let of = |figure: fn(&Round) -> f64| median(rounds.iter().map(figure).collect());
    let rate = |figure: fn(&Round) -> f64| format!("{:.0} frames/s", of(figure));
    let against = |figures: fn(&Round) -> [f64; 2], what: &str| {
        let ratios: Vec<f64> = rounds.iter().map(figures).map(|[own, peer]| own / peer).collect();
        let [least, most] = extremes(&ratios);
        let peer = median(rounds.iter().map(|round| figures(round)[1]).collect());
        let ratio = median(ratios);
        format!("{ratio:.0} x {what} ({peer:.0} frames/s); rounds {least:.0} to {most:.0}")
    };
    let wasm = |figures: fn(&Round) -> [f64; 2]| {
        let ratio = median(rounds.iter().map(figures).map(|[own, wasm]| wasm / own).collect());
        let native = median(rounds.iter().map(|round| figures(round)[0]).collect());
        format!("{ratio:.2} of native ({native:.0} frames/s)")
    };
    let milliseconds = |figure: fn(&Round) -> f64| format!("{:.1} ms", 1e3 * of(figure));
    let tight = against(|r| [r.lsts_norm, r.lsts_norm_peer], "L-BFGS-B, tight");
    let default = against(|r| [r.lsts_norm, r.lsts_norm_peer_default], "L-BFGS-B as it comes");
    let bvls = against(|r| [r.lsts, r.lsts_peer], "bvls");
    let fine = format!("{:.2} of the skin's", of(|r| r.lsts_fine / r.lsts));
    let (alone, memory) = (String::new, format!("{:.1} MiB", of(|r| r.wasm_memory) / 1048576.0));
    let mut rows = vec![
        row("`lsts`, solve alone", rate(|r| r.lsts), bvls, "80 x"),
        row("`lsts-norm`, solve alone", rate(|r| r.lsts_norm), tight, "60 x"),
        row("", alone(), default, ""),
        row("`lsts`, mesh four times as fine", rate(|r| r.lsts_fine), fine, "the same"),
        row("front end", rate(|r| r.front_end), alone(), "100,000 frames/s"),
        row("vertex synthesis, S = 11,248", rate(|r| r.synthesis), alone(), "15,000 frames/s"),
        row(
            "wasm, packs to weights, `lsts`",
            rate(|r| r.lsts_wasm[1]),
            wasm(|r| r.lsts_wasm),
            "0.6",
        ),
        row(
            "wasm, packs to weights, `lsts-norm`",
            rate(|r| r.lsts_norm_wasm[1]),
            wasm(|r| r.lsts_norm_wasm),
            "0.6",
        ),
        row("set-up, skin, S = 11,248", milliseconds(|r| r.set_up_skin), alone(), "60 ms"),
        row(
            "set-up, whole head",
            milliseconds(|r| r.set_up_head),
            "S = 26,511: seams closed".into(),
            "160 ms",
        ),
        row("wasm memory", memory, "after both methods on 5,660 frames".into(), "150 MiB"),
    ];
    for (k, name) in BASELINES.iter().enumerate() {
        let own = median(rounds.iter().map(|round| round.baselines[k]).collect());
        let ratio = median(rounds.iter().map(|round| round.baselines[k] / round.lsts).collect());
        let what = format!("`{name}`, solve alone");
        rows.push(row(&what, format!("{own:.0} frames/s"), format!("{ratio:.2} of `lsts`"), ""));
    }
    rows
}

/// 54 clips solved by the page's own worker.
fn in_browser(dist: &Path, folder: &Path) -> Result<Row> {
    let tests = root().join("tests/browser");
    install::npm(&tests)?;
    let mut node = Command::new("node");
    node.arg(tests.join("solver_speed.mjs")).args([dist, folder]);
    let line = output(&mut node).with_context(|| format!("failed: {}", show(&node)))?;
    let (played, seconds) = (number(&line, "\"played\":")?, number(&line, "\"seconds\":")?);
    let gap = number(&line, "\"longestGapMs\":")?;
    let blocked = match line.contains("\"longTasks\":[]") {
        true => "no task of 50 ms on the page",
        false => "the page was blocked for 50 ms or more",
    };
    Ok(row(
        "54 clips of 4 s in Chromium's worker",
        format!("{:.0} x as fast as they play", played / seconds),
        format!("{seconds:.2} s; {blocked}, longest gap {gap:.0} ms"),
        "20 x, never 50 ms",
    ))
}

/// Draws how set-up grows with the mesh.
fn plot(data: &Path) -> Result<()> {
    let points = bench_plot::measure(|parts| {
        let mut command = figures(data);
        command.args(["scale", &parts.to_string()]);
        output(&mut command).with_context(|| format!("failed: {}", show(&command)))
    })?;
    let file = root().join("docs/measured/solver-set-up.svg");
    std::fs::write(&file, bench_plot::svg(&points))?;
    say(&format!("drawn: {}", file.display()));
    Ok(())
}

/// The native side, one thread, built if need be.
fn figures(data: &Path) -> Command {
    let mut command = cargo();
    command.args(["bench", "--quiet", "--package", "mimique-stimulus", "--bench", "figures", "--"]);
    command.env("RAYON_NUM_THREADS", "1").env("MIMIQUE_DATA", data);
    command
}

fn table(rows: &[[String; 4]]) -> String {
    let mut out = String::from("| measure | measured | beside | target |\n|---|---|---|---|\n");
    for [what, figure, beside, goal] in rows {
        out.push_str(&format!("| {what} | {figure} | {beside} | {goal} |\n"));
    }
    out
}
