//! `cargo xtask bench --verdicts`: how often each kind of verdict finds a difference where there is none, with people and clips
//! that differ more or less by chance, by the product's own `mimique power`.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::process::Command;

use anyhow::{Context, Result};
use serde_json::{Value, json};

use crate::bench_figures::{print, record};
use crate::demo;
use crate::process::{output, root, say, target};

const PEOPLE: [usize; 3] = [20, 80, 160];
/// Clips, four methods of each segment.
const CLIPS: [usize; 2] = [24, 72];
const CLIP_SDS: [f64; 3] = [0.0, 0.1, 0.3];
const TASTE_SDS: [f64; 3] = [0.0, 0.3, 0.6];
/// Points of the slider for one of the rating.
const SLIDER: f64 = 100.0 / 6.0;

/// Simulates, prints, and records where asked.
pub fn run(runs: usize, recorded: bool) -> Result<()> {
    demo::binary()?;
    let folder = target().join("bench-verdicts");
    std::fs::create_dir_all(&folder)?;
    let study = root().join("study-config/power/verdicts.json");
    let mut kinds: Vec<String> = Vec::new();
    let mut rows = String::new();
    let mut highest: BTreeMap<String, f64> = BTreeMap::new();
    for clip_sd in CLIP_SDS {
        for taste_sd in TASTE_SDS {
            let file = folder.join("parameters.json");
            let parameters = parameters(clip_sd, taste_sd);
            std::fs::write(&file, serde_json::to_string_pretty(&parameters)?)?;
            say(&format!("clips differ by {clip_sd}, people in their taste by {taste_sd}"));
            let list = |numbers: &[usize]| {
                numbers.iter().map(ToString::to_string).collect::<Vec<_>>().join(",")
            };
            let mut command = Command::new(demo::binary_path());
            command.arg("--json").arg("power").arg(&study);
            command.args(["--participants", &list(&PEOPLE), "--clips", &list(&CLIPS)]);
            // Without effects the power that is counted is the share of false positives.
            command.args(["--runs", &runs.to_string(), "--no-false-positives", "--parameters"]);
            command.arg(&file);
            let found: Value =
                serde_json::from_str(&output(&mut command).context("mimique power failed")?)?;
            let points = found["power"]["points"].as_array().context("no points")?;
            for point in points {
                let hypotheses = point["hypotheses"].as_array().context("no hypotheses")?;
                let mut cells = Vec::new();
                for own in hypotheses {
                    let id = own["id"].as_str().context("no id")?.to_owned();
                    let wrong = own["power"]["deciding"]["share"].as_f64();
                    let wrong = wrong.context("no false positives")?;
                    let most = highest.entry(id.clone()).or_default();
                    *most = most.max(wrong);
                    cells.push(format!("{:.1}", 100.0 * wrong));
                    if !kinds.contains(&id) {
                        kinds.push(id);
                    }
                }
                writeln!(
                    rows,
                    "| {} | {} | {clip_sd} | {taste_sd} | {} |",
                    point["participants"],
                    point["segments"],
                    cells.join(" | ")
                )?;
            }
        }
    }
    let highest: Vec<String> =
        kinds.iter().map(|kind| format!("{:.1}", 100.0 * highest[kind])).collect();
    let text = format!(
        "| people | segments | clip SD | taste SD | {} |\n|{}\n{rows}| highest | | | | {} |\n\n{runs} runs a row; by chance \
         a rate of 5 % lies below {:.1} % in 95 of 100 rows.\n",
        kinds.join(" | "),
        "---|".repeat(4 + kinds.len()),
        highest.join(" | "),
        100.0 * (0.05 + 1.645 * (0.05 * 0.95 / runs as f64).sqrt()),
    );
    print(&text);
    if recorded {
        record("docs/measured/verdicts.md", &text)?;
    }
    Ok(())
}

/// What the simulation assumes: no effects; people, segments and clips that differ.
fn parameters(clip_sd: f64, taste_sd: f64) -> Value {
    let rating = |unit: f64, mean: f64| {
        json!({
            "mean": mean,
            "noiseSd": unit,
            "personSd": 0.6 * unit,
            "personBySd": { "method": taste_sd * unit },
            "segmentSd": 0.5 * unit,
            "clipSd": clip_sd * unit,
            "effects": {},
            "interactions": [],
        })
    };
    json!({
        "ratings": {
            "rating": rating(1.0, 4.0),
            "faithful": rating(SLIDER, 50.0),
            "together": rating(SLIDER, 50.0),
        },
        "comparisons": { "better": {
            "factor": "method",
            "worth": { "box": 0, "ridge": 0, "lsts30": 0, "lsts70": 0 },
            "personSd": taste_sd,
            "segmentSd": clip_sd,
        } },
        "recognition": { "emotion": {
            "personSd": 0.5,
            "personBySd": { "method": taste_sd },
            "segmentSd": 0.5,
            "clipSd": clip_sd,
            "effects": {},
            "interactions": [],
        } },
        "times": { "effects": {} },
        "careless": { "share": 0 },
        "dropout": { "declined": 0, "perTrial": 0 },
    })
}
