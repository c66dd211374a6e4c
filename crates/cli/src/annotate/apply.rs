//! `mimique annotate apply`: a take and a model in, suggested labels out.

use std::io::Write as _;
use std::path::{Path, PathBuf};

use anyhow::{anyhow, bail};
use mimique_annotate::labels::UNKNOWN;
use mimique_annotate::{Answer, LARGEST, Model, Suggested, Take};
use mimique_locale::counted;
use mimique_mocap::WeightsTable;
use mimique_stimulus::{EafAnnotation, TakeSegment, write_segments_with};
use serde_json::json;

use super::decoding::DecodeOptions;
use super::rounded;
use crate::capture_options::CaptureOptions;
use crate::eaf_file::{document, is_eaf};
use crate::motion::{self, Motion};
use crate::output;

/// Options.
#[derive(clap::Args)]
pub struct Args {
    /// Weights (CSV of `solve`, Live Link Face) or a capture
    take: PathBuf,
    /// The model, as `annotate train` or the studio writes it
    #[arg(long, value_name = "FILE")]
    model: PathBuf,
    /// ELAN document for the tiers `NAME (suggested)` and `NAME (confidence)`; one that is there keeps all
    /// others
    #[arg(long, value_name = "FILE.eaf")]
    out: Option<PathBuf>,
    /// Table of the segments with probability, second label and its probability
    #[arg(long, value_name = "FILE.csv")]
    table: Option<PathBuf>,
    /// Table of the frames with the probability of every label
    #[arg(long, value_name = "FILE.csv")]
    frames: Option<PathBuf>,
    /// Write ? for segments that are less probable than this
    #[arg(long, value_name = "PROBABILITY", default_value_t = 0.0)]
    below: f64,
    /// Name of the tiers (by default that of what was learnt)
    #[arg(long, value_name = "NAME")]
    tier: Option<String>,
    /// Video that a new .eaf belongs to
    #[arg(long, value_name = "FILE")]
    media: Option<String>,
    #[command(flatten)]
    read: CaptureOptions,
    #[command(flatten)]
    decode: DecodeOptions,
}

/// The model of a file.
pub fn model(file: &Path) -> anyhow::Result<Model> {
    let blame = |e: String| anyhow!("{}: {e}", file.display());
    let open = |e: std::io::Error| blame(format!("open: {e}; check the path"));
    let length = std::fs::metadata(file).map_err(open)?.len();
    if length > LARGEST as u64 {
        return Err(blame(format!(
            "{length} bytes, at most {LARGEST}; give a model of annotate train"
        )));
    }
    let text = std::fs::read_to_string(file).map_err(open)?;
    Model::from_json(&text).map_err(|e| blame(e.to_string()))
}

/// The take of a motion, its columns the model's shapes.
pub fn take_for(model: &Model, file: &Path, motion: Motion) -> anyhow::Result<Take> {
    let blame = |e: mimique_annotate::AnnotateError| anyhow!("{}: {e}", file.display());
    let kept = model.columns(&motion.names).map_err(blame)?;
    let take = Take::new(motion.values, motion.names.len(), motion.rate_hz).map_err(blame)?;
    take.columns(&kept).map_err(blame)
}

/// Runs the command.
pub fn run(args: &Args, json: bool) -> anyhow::Result<()> {
    if !(0.0..=1.0).contains(&args.below) {
        bail!("--below: {}; give a probability from 0 to 1", args.below);
    }
    if let Some(out) = args.out.as_ref().filter(|out| !is_eaf(out)) {
        bail!(
            "--out: {}: tiers go into an ELAN document; name a .eaf, or use --table",
            out.display()
        );
    }
    let model = model(&args.model)?;
    let motion = motion::read_comparable(&args.take, &args.read)?;
    let notes = motion.notes.clone();
    let take = take_for(&model, &args.take, motion)?;
    let decode = if args.decode.is_default() {
        model.decoding.of(&take, &model.shapes)?
    } else {
        args.decode.chosen(None)?.of(&take, &model.shapes, args.tier.as_deref())?
    };
    let answer = model.label(&take, &decode);
    let answer = answer.map_err(|e| anyhow!("{}: {e}", args.take.display()))?;
    // All texts are made before the first file is written.
    let files = [
        (&args.out, args.out.as_ref().map(|out| tiers(args, out, &model, &take, &answer))),
        (&args.table, args.table.as_ref().map(|_| Ok(table(args, &model, &take, &answer)))),
        (&args.frames, args.frames.as_ref().map(|_| Ok(frames(&model, &take, &answer)))),
    ];
    let mut texts = Vec::new();
    for (file, text) in files {
        if let (Some(file), Some(text)) = (file, text) {
            texts.push((file, text?));
        }
    }
    texts.iter().try_for_each(|(file, text)| output::write(file, text.as_bytes()))?;
    if json {
        print_json(args, &model, &take, &answer, &notes)
    } else {
        print(args, &model, &take, &answer, &notes)
    }
}

/// What is written for a segment: its label, or that nobody knows.
fn word<'m>(args: &Args, model: &'m Model, found: &Suggested) -> &'m str {
    if found.probability < args.below { UNKNOWN } else { &model.labels[found.label] }
}

fn segment(args: &Args, model: &Model, found: &Suggested) -> TakeSegment {
    TakeSegment::new(word(args, model, found), found.frames.clone())
}

/// The document with both tiers.
fn tiers(
    args: &Args,
    out: &Path,
    model: &Model,
    take: &Take,
    answer: &Answer,
) -> anyhow::Result<String> {
    let name = args.tier.as_deref().unwrap_or(&model.channel);
    let annotation =
        |found: &Suggested| EafAnnotation::of(&segment(args, model, found), take.rate_hz);
    let confidence = |found: &Suggested| EafAnnotation {
        value: format!("{:.2}", found.probability),
        ..annotation(found)
    };
    let labels: Vec<EafAnnotation> = answer.segments.iter().map(annotation).collect();
    let probabilities: Vec<EafAnnotation> = answer.segments.iter().map(confidence).collect();
    let with = document(out, args.media.as_deref())?
        .with_tier(&format!("{name} (suggested)"), &labels)
        .and_then(|with| with.with_tier(&format!("{name} (confidence)"), &probabilities));
    Ok(with.map_err(|e| anyhow!("{}: {e}", out.display()))?.text().to_owned())
}

/// The segments as CSV.
fn table(args: &Args, model: &Model, take: &Take, answer: &Answer) -> String {
    let segments: Vec<TakeSegment> =
        answer.segments.iter().map(|found| segment(args, model, found)).collect();
    let beside = |found: &Suggested| {
        let (second, probability) = match found.second {
            Some((label, probability)) => (model.labels[label].clone(), shown(probability)),
            None => (String::new(), String::new()),
        };
        [shown(found.probability), second, probability]
    };
    let beside: Vec<[String; 3]> = answer.segments.iter().map(beside).collect();
    let names = ["probability", "second", "second_probability"];
    write_segments_with(&segments, take.rate_hz, &names, &beside)
}

/// A probability as tables have it.
fn shown(probability: f64) -> String {
    ((probability * 1e4).round() / 1e4).to_string()
}

/// The probability of each label at every frame as CSV.
fn frames(model: &Model, take: &Take, answer: &Answer) -> String {
    let values = answer.probabilities.values().iter().map(|p| (p * 1e6).round() / 1e6).collect();
    WeightsTable::at_rate(model.labels.clone(), values, 0, take.rate_hz).to_csv()
}

fn print(
    args: &Args,
    model: &Model,
    take: &Take,
    answer: &Answer,
    notes: &[String],
) -> anyhow::Result<()> {
    let mut out = std::io::stdout().lock();
    writeln!(
        out,
        "{}: {} in {:.1} s at {} Hz, suggested: look at them before they are used",
        args.take.display(),
        counted(answer.segments.len(), "segment"),
        take.frames() as f64 / take.rate_hz,
        rounded(take.rate_hz),
    )?;
    for found in &answer.segments {
        let second = found.second.map_or_else(String::new, |(label, probability)| {
            format!(", then {} {probability:.2}", model.labels[label])
        });
        writeln!(
            out,
            "{:<16} frames {:>6} to {:>6}, {:.2} s, probability {:.2}{second}",
            word(args, model, found),
            found.frames.start,
            found.frames.end - 1,
            found.frames.len() as f64 / take.rate_hz,
            found.probability,
        )?;
    }
    notes.iter().try_for_each(|note| writeln!(out, "note: {note}"))?;
    Ok(())
}

fn print_json(
    args: &Args,
    model: &Model,
    take: &Take,
    answer: &Answer,
    notes: &[String],
) -> anyhow::Result<()> {
    let segments = answer.segments.iter().map(|found| {
        json!({
            "label": word(args, model, found),
            "first_frame": found.frames.start,
            "end_frame": found.frames.end,
            "probability": found.probability,
            "second": found.second.map(|(label, _)| &model.labels[label]),
            "second_probability": found.second.map(|(_, probability)| probability),
        })
    });
    let told = json!({
        "take": args.take,
        "model": model.hash()?,
        "frames": take.frames(),
        "rate_hz": take.rate_hz,
        "segments": segments.collect::<Vec<_>>(),
        "notes": notes,
    });
    writeln!(std::io::stdout().lock(), "{}", serde_json::to_string_pretty(&told)?)?;
    Ok(())
}
