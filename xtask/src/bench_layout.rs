//! `cargo xtask bench --layout`: marker layouts beside scikit-learn and NumPy in one go, and the ratios.
//!
//! Ours (`crates/layout/benches/peers.rs`) and the peers (`tests/peers/layouts.py`) are two processes that take
//! turns, a measurement at a time, so that what else the machine does falls on both alike. Times are processor
//! time, one thread; a ratio is the median of the ratios of the rounds.

use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context as _, Result, bail};

use crate::bench::{Partner, extremes, median, number, print, record, text};
use crate::install;
use crate::process::{cargo, root, say, target};
use crate::web;

/// What is measured, by its name in the partners; what it is; whom it is compared with; how many times as
/// fast it must be.
const MEASURED: [(&str, &str, &str, f64); 2] = [
    ("k-means", "K-means, 40 clusters, 10 given starts", "scikit-learn's Elkan", 1.0),
    ("greedy", "greedy by the expected error, 40 markers", "NumPy", 3.0),
];

/// What is measured alone; what it is; the most seconds that it may take.
const ALONE: [(&str, &str, f64); 2] = [
    ("rehearse", "40 rehearsed markers, pairs, 6 takes", 15.0),
    ("drag", "curve of 40 markers after the first is dragged", 0.1),
];

/// The same of the studio's module in node.
const PAGE: (&str, &str, f64) =
    ("drag", "a drag in the studio's module: vertex, curve, what each of 40 is worth", 0.1);

/// How near both sides' numbers are: mirrored vertices are ties, which rounding may break otherwise in NumPy.
const SAME: f64 = 1e-4;

/// Measures, prints, and records where asked.
pub fn run(rounds: usize, recorded: bool) -> Result<()> {
    let folder = target().join("bench-layout");
    std::fs::create_dir_all(&folder)?;
    let mut ours = ours(&folder)?;
    let mut peers = peers(&folder)?;
    let mut out = String::from(
        "| measure | Mimique, s | peer, s | times as fast | target |\n|---|---|---|---|---|\n",
    );
    for (name, what, peer, goal) in MEASURED {
        let mut times = Vec::new();
        for _ in 0..rounds {
            let (own, other) = (measured(&mut ours, name)?, measured(&mut peers, name)?);
            if (own[1] / other[1] - 1.0).abs() > SAME {
                bail!("{name}: {} where {peer} finds {}: nothing to compare", own[1], other[1]);
            }
            times.push([own[0], other[0]]);
        }
        let ratios: Vec<f64> = times.iter().map(|[own, other]| other / own).collect();
        let [least, most] = extremes(&ratios);
        let [own, other] = [0, 1].map(|side| median(times.iter().map(|t| t[side]).collect()));
        let ratio = median(ratios);
        out.push_str(&format!(
            "| {what} | {own:.3} | {other:.3} ({peer}) | {ratio:.1}; rounds {least:.1} to {most:.1} | {goal} |\n"
        ));
        say(&format!("{name}: {ratio:.1} x {peer}"));
    }
    out.push_str(&format!(
        "\n{} places; scikit-learn {}, NumPy {}; {rounds} rounds, processor time, one thread.\n\n",
        number(&ours.greeting, "\"places\": ")?,
        text(&peers.greeting, "sklearn")?,
        text(&peers.greeting, "numpy")?,
    ));
    out.push_str("| measure | seconds | target, at most |\n|---|---|---|\n");
    for measure in ALONE {
        out.push_str(&alone(&mut ours, measure, rounds)?);
    }
    out.push_str(&alone(&mut page()?, PAGE, rounds)?);
    print(&out);
    if recorded {
        record("docs/measured/layout-benchmarks.md", &out)?;
    }
    Ok(())
}

/// The line of what is measured alone.
fn alone(
    partner: &mut Partner,
    (name, what, most): (&str, &str, f64),
    rounds: usize,
) -> Result<String> {
    let times: Result<Vec<f64>> = (0..rounds).map(|_| Ok(measured(partner, name)?[0])).collect();
    let seconds = median(times?);
    say(&format!("{what}: {seconds:.4} s"));
    Ok(format!("| {what} | {seconds:.4} | {most} |\n"))
}

/// The native side, one thread, built if need be.
fn ours(folder: &Path) -> Result<Partner> {
    let mut command = cargo();
    command.args(["bench", "--quiet", "--package", "mimique-layout", "--bench", "peers", "--"]);
    Partner::start(command.arg(folder).env("RAYON_NUM_THREADS", "1"))
}

/// The studio's module.
fn page() -> Result<Partner> {
    let dist = std::env::var_os("MIMIQUE_WEB_DIST").map_or_else(web::dist, PathBuf::from);
    let script = root().join("tests/wasm/layout_speed.mjs");
    Partner::start(Command::new("node").arg(script).arg(dist)).context("run cargo xtask web first")
}

/// scikit-learn and NumPy, one thread.
fn peers(folder: &Path) -> Result<Partner> {
    let requirements = root().join("tests/peers/layouts-requirements.txt");
    let python = match std::env::var_os("MIMIQUE_PYTHON") {
        Some(python) => PathBuf::from(python),
        None => install::python("python-layouts", &requirements)?.map_err(anyhow::Error::msg)?,
    };
    let one_thread = ["OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"];
    let mut command = Command::new(python);
    command.arg(root().join("tests/peers/layouts.py")).arg(folder);
    Partner::start(command.envs(one_thread.map(|name| (name, "1"))))
}

/// Seconds of a measurement, and the number that both sides find.
fn measured(partner: &mut Partner, name: &str) -> Result<[f64; 2]> {
    let line = partner.ask(name)?;
    Ok([number(&line, "\"seconds\":")?, number(&line, "\"answer\":")?])
}
