//! `cargo xtask bench --annotate`: the annotation beside scikit-learn and hmmlearn in one go, and the ratios.
//!
//! Ours (`crates/annotate/benches/peers.rs`), the peers (`tests/peers/annotation.py`) and the studio's module
//! in node (`tests/wasm/label_speed.mjs`) are three processes that take turns, a measurement at a time, so
//! that what else the machine does falls on all alike. Times are processor time, one thread; a ratio is
//! the median of the ratios of the rounds.

use std::path::PathBuf;
use std::process::Command;

use anyhow::{Context as _, Result};

use crate::bench_figures::{median, print, record};
use crate::bench_partner::{Partner, text};
use crate::bench_peers::{Measured, Peers, measurement};
use crate::process::{root, target};
use crate::web;

/// What is measured.
const MEASURED: [Measured; 8] = [
    Measured {
        name: "viterbi",
        what: "Viterbi, 60 states of 20 Gaussians, 6,000 frames",
        peer: "hmmlearn",
        goal: 10.0,
        same: SAME,
    },
    Measured {
        name: "posteriors",
        what: "posteriors, the same",
        peer: "hmmlearn",
        goal: 10.0,
        same: SAME,
    },
    Measured {
        name: "baum-welch",
        what: "a Baum-Welch step, 5 states of 20, 3,000 frames",
        peer: "hmmlearn",
        goal: 5.0,
        same: SAME,
    },
    Measured {
        name: "neighbours",
        what: "15 neighbours among 5,000, 6,000 frames",
        peer: "scikit-learn",
        goal: 0.5,
        same: None,
    },
    Measured {
        name: "rbf fit",
        what: "RBF SVM, fit of 5,000 rows",
        peer: "scikit-learn",
        goal: 0.5,
        same: None,
    },
    Measured {
        name: "rbf decisions",
        what: "its decisions, 6,000 frames",
        peer: "scikit-learn",
        goal: 1.0,
        same: None,
    },
    Measured {
        name: "forest fit",
        what: "forest of 200 trees, fit of 5,000 rows",
        peer: "scikit-learn",
        goal: 1.0,
        same: None,
    },
    Measured {
        name: "forest answers",
        what: "its answers, 6,000 frames",
        peer: "scikit-learn",
        goal: 1.0,
        same: None,
    },
];

/// How near both sides' numbers are where they compute the same: the likelihoods of given models.
const SAME: Option<f64> = Some(1e-9);

/// Measures, prints, and records where asked.
pub fn run(rounds: usize, recorded: bool) -> Result<()> {
    let folder = target().join("bench-annotate");
    std::fs::create_dir_all(&folder)?;
    let mut peers = Peers::start("mimique-annotate", "annotation", &folder)?;
    let table = peers.table(&MEASURED, rounds)?;
    let versions = format!(
        "hmmlearn {}, scikit-learn {}, NumPy {}; {rounds} rounds, processor time, one thread.",
        text(&peers.theirs.greeting, "hmmlearn")?,
        text(&peers.theirs.greeting, "sklearn")?,
        text(&peers.theirs.greeting, "numpy")?,
    );
    let Peers { mut ours, theirs } = peers;
    drop(theirs);
    let ten_minutes = ten_minutes(&mut ours, &folder, rounds)?;
    print(&format!("{table}\n{versions}\n\n{ten_minutes}"));
    if recorded {
        let document = "docs/measured/annotation-benchmarks.md";
        record(document, &format!("{table}\n{versions}\n\n{ten_minutes}"))?;
    }
    Ok(())
}

/// A take of ten minutes labelled natively and by the studio's module.
fn ten_minutes(ours: &mut Partner, folder: &std::path::Path, rounds: usize) -> Result<String> {
    let dist = std::env::var_os("MIMIQUE_WEB_DIST").map_or_else(web::dist, PathBuf::from);
    let script = root().join("tests/wasm/label_speed.mjs");
    let mut wasm = Partner::start(Command::new("node").arg(script).args([&dist, folder]))
        .context("run cargo xtask web first")?;
    let mut times = Vec::new();
    for _ in 0..rounds {
        let (own, page) =
            (measurement(ours, "ten minutes")?, measurement(&mut wasm, "ten minutes")?);
        times.push([own[0], page[0]]);
    }
    let [own, page] = [0, 1].map(|side| median(times.iter().map(|t| t[side]).collect()));
    Ok(format!(
        "| ten minutes at 60 Hz, 51 shapes, forest, label path | seconds | target |\n|---|---|---|\n\
         | natively | {own:.2} | 1 |\n| the studio's module in node | {page:.2} | 3 |\n"
    ))
}
