//! `mimique exertion`: from a body's motion, or what a watch recorded of it, to a face's weights.

mod args;
mod document;
mod inputs;
mod plan;
mod report;
mod study;
mod train;
mod values;

use std::path::Path;

use anyhow::{anyhow, bail};
use mimique_exertion::{
    Clip, Expression, ExpressionModel, Face, Series, ShapeTable, Start, Window,
};
use mimique_locale::Language;
use mimique_mocap::{WeightOptions, WeightsTable};
use mimique_report::figure::time_courses;
use mimique_report::{ReportFile, document_files};
use mimique_stimulus::{ExertionTake, read_performance, sha256_of_file};

pub use self::args::Args;
use self::args::{Command, Options};
use self::inputs::Inputs;
use self::report::Report;
use crate::{output, report_folder};

/// Runs the command.
pub fn run(args: Args, json: bool) -> anyhow::Result<()> {
    match args.command {
        Some(Command::Train(own)) => train::run(&own, json),
        Some(Command::Study(own)) => study::run(&own, json),
        None => face(&args.options, json),
    }
}

/// A file and what is wrong with it.
fn blame(file: &Path, error: impl std::fmt::Display) -> anyhow::Error {
    anyhow!("{}: {error}", file.display())
}

/// Text of a file that says what to check where it cannot be read.
fn text_of(file: &Path) -> anyhow::Result<String> {
    std::fs::read_to_string(file).map_err(|e| blame(file, format!("open: {e}; check the path")))
}

/// SHA-256 of a file.
fn hash_of(file: &Path) -> anyhow::Result<String> {
    sha256_of_file(file).map_err(|e| blame(file, format!("open: {e}; check the path")))
}

/// From motion to face.
fn face(args: &Options, json: bool) -> anyhow::Result<()> {
    let person = values::person(args)?;
    let face = expression(args)?;
    let over = args.over.as_deref().map(|file| other_weights(file, args.out_rate)).transpose()?;
    let inputs = Inputs::read(args, &person)?;
    let heart = values::heart(args)?;
    let series = Series::of(&person, &inputs.plan, heart, Start::default())
        .map_err(|e| inputs.blame(args, &e))?;
    let window = window(args, inputs.plan.span_s(), over.as_ref())?;
    let clip = Clip::of(&person, &inputs.plan, &series, &window, &face)
        .map_err(|e| anyhow!("--window: {e}"))?;
    let take = ExertionTake { series, clip };
    let mut table = take.clip.table();
    if let Some(over) = &over {
        table = joined(&table, over);
    }
    let report = Report { args, person: &person, inputs: &inputs, heart, take: &take };

    // Everything is computed before anything is written.
    let mut files: Vec<(std::path::PathBuf, Vec<u8>)> = Vec::new();
    let mut note = None;
    if let Some(out) = &args.out {
        let (written, left_out) = crate::solve::weights_in_files(&table, out)?;
        files.extend(written);
        note = left_out;
    }
    if let Some(file) = &args.series {
        files.push((file.clone(), take.series.to_csv().into_bytes()));
    }
    if let Some(file) = &args.plot {
        let panels = report.panels(&face.expression);
        let title = format!("Heart rate, EPOC and curves of {}", inputs.name());
        files.push((file.clone(), time_courses(&title, &panels, report.marked()).into_bytes()));
    }
    let mut told = report.told(&table)?;
    if let (Some(note), Some(warnings)) = (note, told["warnings"].as_array_mut()) {
        warnings.push(note.into());
    }
    let mut pages = None;
    if let Some(file) = &args.report {
        let text = serde_json::to_string_pretty(&told)? + "\n";
        if file.extension().is_some_and(|own| own.eq_ignore_ascii_case("json")) {
            files.push((file.clone(), text.into_bytes()));
        } else {
            report_folder::check(file).map_err(|e| anyhow!("--report: {}: {e}", file.display()))?;
            let document = document::document(&report, &face.expression, &told)?;
            let mut all = document_files(&document, Language::English);
            all.push(ReportFile { path: "results.json".to_owned(), text });
            pages = Some((file, all));
        }
    }
    for (file, bytes) in &files {
        output::write(file, bytes)?;
    }
    if let Some((folder, all)) = pages {
        report_folder::write(&all, folder).map_err(|e| blame(folder, e))?;
    }
    report.print(&told, json)
}

/// What makes the curves, and which shapes they move.
fn expression(args: &Options) -> anyhow::Result<Face> {
    let expression = match args.model.as_str() {
        "rules" => Expression::Rules,
        "linear" => Expression::Linear,
        file => {
            let file = Path::new(file);
            let model = ExpressionModel::of_text(&text_of(file)?).map_err(|e| blame(file, e))?;
            Expression::Model(Box::new(model))
        }
    };
    let shapes = match &args.shapes {
        None => ShapeTable::default(),
        Some(file) => ShapeTable::of_text(&text_of(file)?).map_err(|e| blame(file, e))?,
    };
    Ok(Face { expression, shapes, breathing: !args.no_breath, skin: args.skin, seed: args.seed })
}

/// The window: as asked for, else all of the plan, or as much of it as the other weights last.
fn window(args: &Options, span: f64, over: Option<&WeightsTable>) -> anyhow::Result<Window> {
    let rate_hz = args.out_rate;
    let seconds = match (&args.window, over) {
        (Some(window), _) => window.0,
        (None, Some(over)) => {
            let length = (over.frames.len().max(2) - 1) as f64 / rate_hz;
            [(span - length).max(0.0), span]
        }
        (None, None) => [0.0, span],
    };
    if let Some(over) = over {
        let frames = ((seconds[1] - seconds[0]) * rate_hz + 1e-9).floor() as usize + 1;
        if over.frames.len() < frames {
            bail!(
                "--over: {} frames at {rate_hz} Hz, the window has {frames}; shorten the window \
                 (--window) to {:.2} s",
                over.frames.len(),
                (over.frames.len().max(1) - 1) as f64 / rate_hz
            );
        }
    }
    Ok(Window { seconds, rate_hz })
}

/// Weights of something else, at the rate of the face.
fn other_weights(file: &Path, rate_hz: f64) -> anyhow::Result<WeightsTable> {
    let options = WeightOptions { rate_hz: Some(rate_hz), ..WeightOptions::default() };
    let table = read_performance(file, &options).map_err(|e| blame(file, e))?.table;
    Ok(table.resampled(rate_hz))
}

/// Exertion onto other weights: shapes of both are added, at most 1; what the others alone have stays.
fn joined(own: &WeightsTable, over: &WeightsTable) -> WeightsTable {
    let mut names = over.shape_names.clone();
    let place_of = |names: &[String], name: &String| {
        names.iter().position(|other| other.eq_ignore_ascii_case(name))
    };
    let mut places = Vec::new();
    for name in &own.shape_names {
        places.push(place_of(&names, name).unwrap_or_else(|| {
            names.push(name.clone());
            names.len() - 1
        }));
    }
    let mut weights = Vec::with_capacity(own.frames.len() * names.len());
    for row in 0..own.frames.len() {
        let start = weights.len();
        weights.extend_from_slice(over.row(row));
        weights.resize(start + names.len(), 0.0);
        for (weight, &place) in own.row(row).iter().zip(&places) {
            let sum: &mut f64 = &mut weights[start + place];
            // What was above 1 already stays.
            *sum = (*sum + weight).min(sum.max(1.0));
        }
    }
    WeightsTable { shape_names: names, weights, ..own.clone() }
}
