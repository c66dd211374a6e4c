//! `mimique segment`: the expressions of a long take, suggested, carried between CSV and ELAN, and
//! told as the segments of a study file.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::{SystemTime, UNIX_EPOCH};

use anyhow::{anyhow, bail};
use mimique_geometry::coordinates;
use mimique_mocap::{CaptureFile, Format, WeightOptions, stabilise};
use mimique_stimulus::{
    Channels, EafAnnotation, EafDocument, EafSegments, LeftOut, SuggestOptions, TakeSegment, cut,
    read_segments, study_segments, suggest, write_segments,
};
use mimique_study::iso_time;
use serde_json::json;

use crate::capture_options::CaptureOptions;
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
    #[command(flatten)]
    read: CaptureOptions,
}

/// What is cut: channels over time.
struct Take {
    values: Vec<f64>,
    count: usize,
    rate_hz: f64,
    notes: Vec<String>,
}

impl Take {
    fn frames(&self) -> usize {
        self.values.len() / self.count.max(1)
    }
}

/// That the options can be what they say.
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
fn read_of(file: &Path, tier: &str, take: &mut Take) -> anyhow::Result<Vec<TakeSegment>> {
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
    let mut take = take(&args)?;
    let channels = Channels { values: &take.values, count: take.count, rate_hz: take.rate_hz };
    let options = SuggestOptions {
        neutral: args.neutral.as_ref().map(|n| n.0.clone()),
        labels: args.labels.clone(),
        ..SuggestOptions::default()
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
    take: &Take,
    segments: &[TakeSegment],
) -> std::io::Result<()> {
    writeln!(
        out,
        "{}: {} expressions in {:.1} s at {} Hz{}",
        args.take.display(),
        segments.len(),
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

/// The take's channels: weights as they are, or the markers in a still head.
fn take(args: &Args) -> anyhow::Result<Take> {
    let blame = |e: String| anyhow!("{}: {e}", args.take.display());
    let mut file = CaptureFile::open(&args.take).map_err(|e| blame(e.to_string()))?;
    match file.format() {
        Some(format) if format.holds_weights() => {
            let rate_hz = args.read.mocap_rate;
            let options = WeightOptions { rate_hz, ..WeightOptions::default() };
            let table = file.weights(&options).map_err(|e| blame(e.to_string()))?;
            let rate_hz = rate_hz.or(table.rate_hz()).ok_or_else(|| {
                blame("column time: no rate; give it with --mocap-rate".to_owned())
            })?;
            let count = table.shape_names.len();
            let notes = file.format().map(Format::taken_for).into_iter().collect();
            Ok(Take { values: table.weights, count, rate_hz, notes })
        }
        _ => {
            let recording = args.read.recording(&args.take, &mut file)?;
            let (mut capture, head) = (recording.capture, args.read.head()?);
            let mut notes = vec![recording.format.taken_for()];
            notes.append(&mut capture.notes);
            if head.is_empty() {
                notes.push(
                    "no head markers are named: head motion is taken for expression; use --head"
                        .to_owned(),
                );
            } else {
                stabilise(&mut capture, &head).map_err(|e| blame(e.to_string()))?;
            }
            let count = 3 * capture.labels.len();
            let values = coordinates(&capture.positions).to_vec();
            Ok(Take { values, count, rate_hz: capture.rate_hz, notes })
        }
    }
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
    take: &Take,
    args: &Args,
) -> anyhow::Result<String> {
    if !is_eaf(out) {
        return Ok(write_segments(segments, take.rate_hz));
    }
    let blame = |e: String| anyhow!("{}: {e}", out.display());
    let document = match std::fs::read_to_string(out) {
        Ok(text) => EafDocument::parse(&text),
        Err(e) if e.kind() == std::io::ErrorKind::NotFound => {
            EafDocument::new(&now(), args.media.as_deref())
        }
        Err(e) => return Err(blame(format!("open: {e}; check the path"))),
    };
    let annotations: Vec<EafAnnotation> =
        segments.iter().map(|s| EafAnnotation::of(s, take.rate_hz)).collect();
    let with = document.and_then(|d| d.with_tier(&args.tier, &annotations));
    Ok(with.map_err(|e| blame(e.to_string()))?.text().to_owned())
}

fn is_eaf(file: &Path) -> bool {
    file.extension().is_some_and(|e| e.eq_ignore_ascii_case("eaf"))
}

/// The present time as ISO 8601.
fn now() -> String {
    let since_1970 = SystemTime::now().duration_since(UNIX_EPOCH);
    iso_time(since_1970.map_or(0.0, |since| since.as_secs() as f64 * 1000.0))
}
