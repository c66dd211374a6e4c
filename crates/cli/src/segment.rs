//! `mimique segment`: the expressions of a long take, suggested, carried between CSV and ELAN, and
//! told as the segments of a study file.

use std::io::Write;
use std::path::{Path, PathBuf};

use anyhow::{anyhow, bail};
use mimique_locale::counted;
use mimique_stimulus::{
    Channels, EafAnnotation, EafDocument, EafSegments, LeftOut, SuggestOptions, TakeSegment, cut,
    read_segments, study_segments, suggest, write_segments,
};
use serde_json::json;

use crate::border_options::{BorderOptions, Rule};
use crate::capture_options::CaptureOptions;
use crate::eaf_file::{document, is_eaf};
use crate::motion::{self, Motion};
use crate::output;
use crate::solve::Span;

/// Options.
#[derive(clap::Args)]
pub struct Args {
    /// Weights (CSV of `solve`, Live Link Face) or a capture
    take: PathBuf,
    /// Where the segments go: .csv, or .eaf (a document that is there keeps its other tiers)
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Take the segments from this CSV or .eaf, as corrected by hand, instead of suggesting them
    #[arg(long, value_name = "FILE")]
    from: Option<PathBuf>,
    /// Seconds of neutral before each expression, as far as there are
    #[arg(long, value_name = "SECONDS", default_value_t = 0.2)]
    lead_in: f64,
    /// Seconds of neutral after each expression, as far as there are
    #[arg(long, value_name = "SECONDS", default_value_t = 0.2)]
    lead_out: f64,
    /// Names of the expressions, in order of time
    #[arg(long, value_name = "NAME,NAME", value_delimiter = ',')]
    labels: Vec<String>,
    /// Frames of the neutral face, counted from 0 (by default the face that comes back most)
    #[arg(long, value_name = "FIRST:END")]
    neutral: Option<Span>,
    /// Tier of the .eaf
    #[arg(long, value_name = "NAME", default_value = "expressions")]
    tier: String,
    /// Video that a new .eaf belongs to
    #[arg(long, value_name = "FILE")]
    media: Option<String>,
    /// Print the segments of a study file instead, as cuts of its capture of this identifier
    #[arg(long, value_name = "CAPTURE")]
    study: Option<String>,
    /// How weak an expression may be: above 1 weaker ones are found, below 1 stronger ones alone
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0, value_parser = above_0)]
    sensitivity: f64,
    /// Which peaks of the energy are borders: peaks, one a change, or literal, as the thesis words it
    #[arg(long, value_name = "RULE", default_value = "peaks")]
    borders: Rule,
    #[command(flatten)]
    activity: BorderOptions,
    #[command(flatten)]
    read: CaptureOptions,
}

/// That the options can be what they say.
fn above_0(text: &str) -> Result<f64, String> {
    let value: f64 = text.parse().map_err(|_| format!("{text} is no number; give one above 0"))?;
    if value > 0.0 && value.is_finite() {
        Ok(value)
    } else {
        Err(format!("{text} is not above 0; give a number above 0"))
    }
}

fn check(args: &Args) -> anyhow::Result<()> {
    for (option, seconds) in [("--lead-in", args.lead_in), ("--lead-out", args.lead_out)] {
        if !(seconds >= 0.0 && seconds.is_finite()) {
            bail!("{option}: {seconds}; give seconds, 0 for none");
        }
    }
    if let Some(id) = &args.study {
        let plain = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
        if id.is_empty() || !id.chars().all(plain) {
            bail!("--study: {id:?} is no identifier of a capture; use letters, digits, _ and -");
        }
    }
    Ok(())
}

/// The segments of a file, all of which lie in the take; what of the file is none is noted.
fn read_of(file: &Path, tier: &str, take: &mut Motion) -> anyhow::Result<Vec<TakeSegment>> {
    let EafSegments { segments, left_out } = read(file, tier, take.rate_hz)?;
    let said = left_out.sentence().map(|left_out| format!("{}: {left_out}", file.display()));
    take.notes.extend(said);
    if let Some(out) = segments.iter().find(|s| s.clip.end > take.frames()) {
        bail!(
            "{}: {}: ends at frame {} of {}; give the segments of this take",
            file.display(),
            out.label,
            out.clip.end,
            take.frames()
        );
    }
    Ok(segments)
}

/// Runs the command.
pub fn run(args: Args, json: bool) -> anyhow::Result<()> {
    check(&args)?;
    let blame = |e: String| anyhow!("{}: {e}", args.take.display());
    let mut take = motion::read(&args.take, &args.read)?;
    let channels = Channels {
        values: &take.values,
        count: take.names.len(),
        rate_hz: take.rate_hz,
        names: take.shape_names(),
    };
    let options = SuggestOptions {
        activity: args.activity.options()?,
        rule: args.borders.0,
        neutral: args.neutral.as_ref().map(|n| n.0.clone()),
        labels: args.labels.clone(),
        sensitivity: args.sensitivity,
    };
    let mut found = suggest(channels, &options).map_err(|e| blame(e.to_string()))?;
    if let Some(file) = &args.from {
        found.segments = read_of(file, &args.tier, &mut take)?;
    }
    found.segments = cut(&found.segments, take.frames(), take.rate_hz, args.lead_in, args.lead_out);
    if let Some(out) = &args.out {
        let text = written(out, &found.segments, &take, &args)?;
        output::write(out, text.as_bytes())?;
    }
    let mut out = std::io::stdout().lock();
    if let Some(capture) = &args.study {
        // Nothing but what is to be pasted.
        let rows = study_segments(&found.segments, capture);
        let rows: Result<Vec<_>, _> = rows.iter().map(serde_json::to_string).collect();
        writeln!(out, "[\n  {}\n]", rows?.join(",\n  "))?;
        take.notes.iter().for_each(|note| eprintln!("note: {note}"));
        return Ok(());
    }
    if json {
        writeln!(
            out,
            "{}",
            serde_json::to_string_pretty(&json!({
                "take": args.take, "out": args.out, "timeline": found.timeline(), "notes": take.notes,
            }))?
        )?;
        return Ok(());
    }
    print_segments(&mut out, &args, &take, &found.segments)?;
    Ok(())
}

/// The segments, a line each.
fn print_segments(
    out: &mut impl Write,
    args: &Args,
    take: &Motion,
    segments: &[TakeSegment],
) -> std::io::Result<()> {
    writeln!(
        out,
        "{}: {} in {:.1} s at {} Hz{}",
        args.take.display(),
        counted(segments.len(), "expression"),
        take.frames() as f64 / take.rate_hz,
        take.rate_hz,
        if args.from.is_none() { ", suggested: look at them before they are used" } else { "" },
    )?;
    for s in segments {
        writeln!(
            out,
            "{:<16} frames {:>6} to {:>6}, clip {:>6} to {:>6}, {:.2} s",
            s.label,
            s.expression.start,
            s.expression.end - 1,
            s.clip.start,
            s.clip.end - 1,
            s.clip.len() as f64 / take.rate_hz,
        )?;
    }
    take.notes.iter().try_for_each(|note| writeln!(out, "note: {note}"))
}

/// Segments from a CSV or an ELAN document.
fn read(file: &Path, tier: &str, rate_hz: f64) -> anyhow::Result<EafSegments> {
    let blame = |e: String| anyhow!("{}: {e}", file.display());
    let text =
        std::fs::read_to_string(file).map_err(|e| blame(format!("open: {e}; check the path")))?;
    if is_eaf(file) {
        let document = EafDocument::parse(&text).map_err(|e| blame(e.to_string()))?;
        document.segments(tier, rate_hz).map_err(|e| blame(e.to_string()))
    } else {
        let segments = read_segments(&text).map_err(|e| blame(e.to_string()))?;
        Ok(EafSegments { segments, left_out: LeftOut::default() })
    }
}

/// The text of a CSV or an ELAN document; one that is there keeps its other tiers.
fn written(
    out: &Path,
    segments: &[TakeSegment],
    take: &Motion,
    args: &Args,
) -> anyhow::Result<String> {
    if !is_eaf(out) {
        return Ok(write_segments(segments, take.rate_hz));
    }
    let document = document(out, args.media.as_deref())?;
    let annotations: Vec<EafAnnotation> =
        segments.iter().map(|s| EafAnnotation::of(s, take.rate_hz)).collect();
    let with = document.with_tier(&args.tier, &annotations);
    Ok(with.map_err(|e| anyhow!("{}: {e}", out.display()))?.text().to_owned())
}
