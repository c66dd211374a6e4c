//! `cargo xtask bench --layout`: marker layouts beside scikit-learn and NumPy in one go, and the ratios.
//!
//! Ours (`crates/layout/benches/peers.rs`) and the peers (`tests/peers/layouts.py`) are two processes that take
//! turns, a measurement at a time, so that what else the machine does falls on both alike. Times are processor
//! time, one thread; a ratio is the median of the ratios of the rounds.

use anyhow::Result;

use crate::bench_figures::{median, print, record};
use crate::bench_partner::{number, text};
use crate::bench_peers::{Measured, Peers, measurement};
use crate::process::{say, target};

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
    for (name, what, most) in ALONE {
        let times: Result<Vec<f64>> =
            (0..rounds).map(|_| Ok(measurement(&mut peers.ours, name)?[0])).collect();
        let seconds = median(times?);
        out.push_str(&format!("| {what} | {seconds:.4} | {most} |\n"));
        say(&format!("{name}: {seconds:.4} s"));
    }
    print(&out);
    if recorded {
        record("docs/measured/layout-benchmarks.md", &out)?;
    }
    Ok(())
}
