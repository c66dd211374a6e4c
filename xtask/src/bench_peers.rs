//! Our side of a benchmark and its peers in Python: two processes that take turns, a measurement at a time, so
//! that what else the machine does falls on both alike. One thread each; a ratio is the median of the ratios of
//! the rounds.

use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Result, bail};

use crate::bench_figures::{extremes, median};
use crate::bench_partner::{Partner, number};
use crate::install;
use crate::process::{cargo, root, say};

/// The two sides.
pub struct Peers {
    pub ours: Partner,
    pub theirs: Partner,
}

/// A measurement.
pub struct Measured {
    /// Its name in both processes.
    pub name: &'static str,
    /// What it is.
    pub what: &'static str,
    /// Whom it is compared with.
    pub peer: &'static str,
    /// How many times as fast it must be.
    pub goal: f64,
    /// How near, of itself, the numbers of both sides are; none where they do not compute the same.
    pub same: Option<f64>,
}

impl Peers {
    /// Starts the benchmark `peers` of a package, built if need be, and `tests/peers/SCRIPT.py` with what
    /// `tests/peers/SCRIPT-requirements.txt` names. Both get the folder.
    pub fn start(package: &str, script: &str, folder: &Path) -> Result<Self> {
        let mut ours = cargo();
        ours.args(["bench", "--quiet", "--package", package, "--bench", "peers", "--"]);
        let ours = Partner::start(ours.arg(folder).env("RAYON_NUM_THREADS", "1"))?;
        let requirements = root().join(format!("tests/peers/{script}-requirements.txt"));
        let python = match std::env::var_os("MIMIQUE_PYTHON") {
            Some(python) => PathBuf::from(python),
            None => install::python(&format!("python-{script}"), &requirements)?
                .map_err(anyhow::Error::msg)?,
        };
        let one_thread = ["OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"];
        let mut theirs = Command::new(python);
        theirs.arg(root().join(format!("tests/peers/{script}.py"))).arg(folder);
        let theirs = Partner::start(theirs.envs(one_thread.map(|name| (name, "1"))))?;
        Ok(Self { ours, theirs })
    }

    /// The table of measurements, in Markdown. Where both sides find something else, it stops.
    pub fn table(&mut self, measured: &[Measured], rounds: usize) -> Result<String> {
        let mut table = String::from(
            "| measure | Mimique, s | peer, s | times as fast | target |\n|---|---|---|---|---|\n",
        );
        for Measured { name, what, peer, goal, same } in measured {
            let mut times = Vec::new();
            for _ in 0..rounds {
                let (own, other) =
                    (measurement(&mut self.ours, name)?, measurement(&mut self.theirs, name)?);
                if same.is_some_and(|same| (own[1] / other[1] - 1.0).abs() > same) {
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
        Ok(table)
    }
}

/// Seconds of a measurement, and the number that is found.
pub fn measurement(partner: &mut Partner, name: &str) -> Result<[f64; 2]> {
    let line = partner.ask(name)?;
    Ok([number(&line, "\"seconds\":")?, number(&line, "\"answer\":")?])
}
