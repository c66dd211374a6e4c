//! `cargo xtask bench --layout`: marker layouts beside scikit-learn and NumPy in one go, and the ratios.
//!
//! Ours (`crates/layout/benches/peers.rs`) and the peers (`tests/peers/layouts.py`) are two processes that take
//! turns, a measurement at a time, so that what else the machine does falls on both alike. Times are processor
//! time, one thread; a ratio is the median of the ratios of the rounds.

use std::path::PathBuf;
use std::process::Command;

use anyhow::{Context as _, Result};

use crate::bench_figures::{median, print, record};
use crate::bench_partner::{Partner, number, text};
use crate::bench_peers::{Measured, Peers, measurement};
use crate::process::{root, say, target};
use crate::web;

/// What is measured.
const MEASURED: [Measured; 2] = [
    Measured {
        name: "k-means",
        what: "K-means, 40 clusters, 10 given starts",
        peer: "scikit-learn's Elkan",
        goal: 1.0,
        same: SAME,
    },
    Measured {
        name: "greedy",
        what: "greedy by the expected error, 40 markers",
        peer: "NumPy",
        goal: 3.0,
        same: SAME,
    },
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
const SAME: Option<f64> = Some(1e-4);

/// Measures, prints, and records where asked.
pub fn run(rounds: usize, recorded: bool) -> Result<()> {
    let folder = target().join("bench-layout");
    std::fs::create_dir_all(&folder)?;
    let mut peers = Peers::start("mimique-layout", "layouts", &folder)?;
    let mut out = peers.table(&MEASURED, rounds)?;
    out.push_str(&format!(
        "\n{} places; scikit-learn {}, NumPy {}; {rounds} rounds, processor time, one thread.\n\n",
        number(&peers.ours.greeting, "\"places\": ")?,
        text(&peers.theirs.greeting, "sklearn")?,
        text(&peers.theirs.greeting, "numpy")?,
    ));
    out.push_str("| measure | seconds | target, at most |\n|---|---|---|\n");
    for measure in ALONE {
        out.push_str(&alone(&mut peers.ours, measure, rounds)?);
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
    let times: Result<Vec<f64>> = (0..rounds).map(|_| Ok(measurement(partner, name)?[0])).collect();
    let seconds = median(times?);
    say(&format!("{what}: {seconds:.4} s"));
    Ok(format!("| {what} | {seconds:.4} | {most} |\n"))
}

/// The studio's module.
fn page() -> Result<Partner> {
    let dist = std::env::var_os("MIMIQUE_WEB_DIST").map_or_else(web::dist, PathBuf::from);
    let script = root().join("tests/wasm/layout_speed.mjs");
    Partner::start(Command::new("node").arg(script).arg(dist)).context("run cargo xtask web first")
}
