//! `cargo xtask bench --annotate`: the annotation beside scikit-learn and hmmlearn in one go, and the ratios.
//!
//! Ours (`crates/annotate/benches/peers.rs`), the peers (`tests/peers/annotation.py`) and the studio's module
//! in node (`tests/wasm/label_speed.mjs`) are three processes that take turns, a measurement at a time, so
//! that what else the machine does falls on all alike. Times are processor time, one thread; a ratio is
//! the median of the ratios of the rounds.

use std::path::PathBuf;
use std::process::Command;

use anyhow::{Context as _, Result, bail};

use crate::bench::{Partner, extremes, median, number, print, record, text};
use crate::install;
use crate::process::{cargo, root, say, target};
use crate::web;

/// What is measured, by its name in the partners; what it is; whom it is compared with; how many times as
/// fast it must be.
const MEASURED: [(&str, &str, &str, f64); 8] = [
    ("viterbi", "Viterbi, 60 states of 20 Gaussians, 6,000 frames", "hmmlearn", 10.0),
    ("posteriors", "posteriors, the same", "hmmlearn", 10.0),
    ("baum-welch", "a Baum-Welch step, 5 states of 20, 3,000 frames", "hmmlearn", 5.0),
    ("neighbours", "15 neighbours among 5,000, 6,000 frames", "scikit-learn", 0.5),
    ("rbf fit", "RBF SVM, fit of 5,000 rows", "scikit-learn", 0.5),
    ("rbf decisions", "its decisions, 6,000 frames", "scikit-learn", 1.0),
    ("forest fit", "forest of 200 trees, fit of 5,000 rows", "scikit-learn", 1.0),
    ("forest answers", "its answers, 6,000 frames", "scikit-learn", 1.0),
];

/// How near both sides' numbers are where they compute the same: the likelihoods of given models.
const SAME: f64 = 1e-9;

/// Measures, prints, and records where asked.
pub fn run(rounds: usize, recorded: bool) -> Result<()> {
    let folder = target().join("bench-annotate");
    std::fs::create_dir_all(&folder)?;
    let mut ours = ours(&folder)?;
    let mut peers = peers(&folder)?;
    let mut table = String::from(
        "| measure | Mimique, s | peer, s | times as fast | target |\n|---|---|---|---|---|\n",
    );
    for (name, what, peer, goal) in MEASURED {
        let mut times = Vec::new();
        for _ in 0..rounds {
            let (own, other) = (measured(&mut ours, name)?, measured(&mut peers, name)?);
            if goal > 1.0 && (own[1] / other[1] - 1.0).abs() > SAME {
                bail!("{name}: {} where {peer} finds {}: nothing to compare", own[1], other[1]);
            }
            times.push([own[0], other[0]]);
        }
        let ratios: Vec<f64> = times.iter().map(|[own, other]| other / own).collect();
        let [least, most] = extremes(&ratios);
        let [own, other] = [0, 1].map(|side| median(times.iter().map(|t| t[side]).collect()));
        let ratio = median(ratios);
        table.push_str(&format!(
            "| {what} | {own:.3} | {other:.3} ({peer}) | {ratio:.1}; rounds {least:.1} to {most:.1} | {goal} |\n"
        ));
        say(&format!("{name}: {ratio:.1} x {peer}"));
    }
    let versions = format!(
        "hmmlearn {}, scikit-learn {}, NumPy {}; {rounds} rounds, processor time, one thread.",
        text(&peers.greeting, "hmmlearn")?,
        text(&peers.greeting, "sklearn")?,
        text(&peers.greeting, "numpy")?,
    );
    drop(peers);
    let ten_minutes = ten_minutes(&mut ours, &folder, rounds)?;
    print(&format!("{table}\n{versions}\n\n{ten_minutes}"));
    if recorded {
        let document = "docs/measured/annotation-benchmarks.md";
        record(document, &format!("{table}\n{versions}\n\n{ten_minutes}"))?;
    }
    Ok(())
}

/// The native side, one thread, built if need be.
fn ours(folder: &std::path::Path) -> Result<Partner> {
    let mut command = cargo();
    command.args(["bench", "--quiet", "--package", "mimique-annotate", "--bench", "peers", "--"]);
    Partner::start(command.arg(folder).env("RAYON_NUM_THREADS", "1"))
}

/// scikit-learn and hmmlearn, one thread.
fn peers(folder: &std::path::Path) -> Result<Partner> {
    let requirements = root().join("tests/peers/annotation-requirements.txt");
    let python = match std::env::var_os("MIMIQUE_PYTHON") {
        Some(python) => PathBuf::from(python),
        None => install::python("python-annotate", &requirements)?.map_err(anyhow::Error::msg)?,
    };
    let one_thread = ["OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"];
    let script = root().join("tests/peers/annotation.py");
    let mut command = Command::new(python);
    Partner::start(command.arg(script).arg(folder).envs(one_thread.map(|name| (name, "1"))))
}

/// Seconds of a measurement, and the number that both sides find.
fn measured(partner: &mut Partner, name: &str) -> Result<[f64; 2]> {
    let line = partner.ask(name)?;
    Ok([number(&line, "\"seconds\":")?, number(&line, "\"answer\":")?])
}

/// A take of ten minutes labelled natively and by the studio's module.
fn ten_minutes(ours: &mut Partner, folder: &std::path::Path, rounds: usize) -> Result<String> {
    let dist = std::env::var_os("MIMIQUE_WEB_DIST").map_or_else(web::dist, PathBuf::from);
    let script = root().join("tests/wasm/label_speed.mjs");
    let mut wasm = Partner::start(Command::new("node").arg(script).args([&dist, folder]))
        .context("run cargo xtask web first")?;
    let mut times = Vec::new();
    for _ in 0..rounds {
        let (own, page) = (measured(ours, "ten minutes")?, measured(&mut wasm, "ten minutes")?);
        times.push([own[0], page[0]]);
    }
    let [own, page] = [0, 1].map(|side| median(times.iter().map(|t| t[side]).collect()));
    Ok(format!(
        "| ten minutes at 60 Hz, 51 shapes, forest, label path | seconds | target |\n|---|---|---|\n\
         | natively | {own:.2} | 1 |\n| the studio's module in node | {page:.2} | 3 |\n"
    ))
}
