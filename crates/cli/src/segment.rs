//! `mimique segment`: the expressions of a long take, suggested, carried between CSV and ELAN, and
//! told as the segments of a study file.

use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::time::{SystemTime, UNIX_EPOCH};

use anyhow::{anyhow, bail};
use mimique_mocap::{CaptureFile, Format, stabilise};
use mimique_stimulus::{
    Channels, EafAnnotation, EafDocument, SuggestOptions, TakeSegment, WeightsTable, cut,
    read_segments, study_segments, suggest, write_segments,
};
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
    /// Take the segments from this CSV or .eaf, as mended by hand, instead of suggesting them
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
    /// Film that a new .eaf belongs to
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

/// Runs the command.
pub fn run(args: Args, json: bool) -> anyhow::Result<()> {
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
    let blame = |e: String| anyhow!("{}: {e}", args.take.display());
    let take = take(&args)?;
    let channels = Channels { values: &take.values, count: take.count, rate_hz: take.rate_hz };
    let options = SuggestOptions {
        neutral: args.neutral.as_ref().map(|n| n.0.clone()),
        labels: args.labels.clone(),
        ..SuggestOptions::default()
    };
    let mut found = suggest(channels, &options).map_err(|e| blame(e.to_string()))?;
    if let Some(file) = &args.from {
        found.segments = read(file, &args.tier, take.rate_hz)?;
        if let Some(out) = found.segments.iter().find(|s| s.clip.end > take.frames()) {
            bail!(
                "{}: {}: ends at frame {} of {}; give the segments of this take",
                file.display(),
                out.label,
                out.clip.end,
                take.frames()
            );
        }
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
    writeln!(
        out,
        "{}: {} expressions in {:.1} s at {} Hz{}",
        args.take.display(),
        found.segments.len(),
        take.frames() as f64 / take.rate_hz,
        take.rate_hz,
        if args.from.is_none() { ", suggested: look at them before they are used" } else { "" },
    )?;
    for s in &found.segments {
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
    take.notes.iter().try_for_each(|note| writeln!(out, "note: {note}"))?;
    Ok(())
}

/// The take's channels: weights as they are, or the markers in a still head.
fn take(args: &Args) -> anyhow::Result<Take> {
    let blame = |e: String| anyhow!("{}: {e}", args.take.display());
    let mut file = CaptureFile::open(&args.take).map_err(|e| blame(e.to_string()))?;
    match file.format() {
        Some(Format::LiveLinkCsv) => {
            let weights = file.weights().map_err(|e| blame(e.to_string()))?;
            let (count, rate_hz) = (weights.names.len(), weights.rate_hz);
            Ok(Take { values: weights.weights, count, rate_hz, notes: Vec::new() })
        }
        Some(_) => {
            let mut capture = args.read.recording(&args.take, &mut file)?.capture;
            let head = args.read.head()?;
            let mut notes = std::mem::take(&mut capture.notes);
            if head.is_empty() {
                notes.push(
                    "no head markers are named: head motion is taken for expression; use --head"
                        .to_owned(),
                );
            } else {
                stabilise(&mut capture, &head).map_err(|e| blame(e.to_string()))?;
            }
            let count = 3 * capture.labels.len();
            let values = capture.positions.into_flattened();
            Ok(Take { values, count, rate_hz: capture.rate_hz, notes })
        }
        None => {
            let bytes = std::fs::read(&args.take)
                .map_err(|e| blame(format!("open: {e}; check the path and its permissions")))?;
            let (text, rate) = (String::from_utf8_lossy(&bytes), args.read.mocap_rate);
            let table = WeightsTable::from_csv(&text, rate).map_err(|e| blame(e.to_string()))?;
            let rate_hz = rate.or(table.rate_hz()).ok_or_else(|| {
                blame("column time: no rate; give it with --mocap-rate".to_owned())
            })?;
            let count = table.shape_names.len();
            Ok(Take { values: table.weights, count, rate_hz, notes: Vec::new() })
        }
    }
}

/// Segments from a CSV or an ELAN document.
fn read(file: &Path, tier: &str, rate_hz: f64) -> anyhow::Result<Vec<TakeSegment>> {
    let blame = |e: String| anyhow!("{}: {e}", file.display());
    let text =
        std::fs::read_to_string(file).map_err(|e| blame(format!("open: {e}; check the path")))?;
    if is_eaf(file) {
        let document = EafDocument::parse(&text).map_err(|e| blame(e.to_string()))?;
        document.segments(tier, rate_hz).map_err(|e| blame(e.to_string()))
    } else {
        read_segments(&text).map_err(|e| blame(e.to_string()))
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
    let seconds = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |d| d.as_secs());
    let (days, time) = (seconds / 86_400, seconds % 86_400);
    let (year, month, day) = date(days);
    let (hour, minute, second) = (time / 3600, time / 60 % 60, time % 60);
    format!("{year:04}-{month:02}-{day:02}T{hour:02}:{minute:02}:{second:02}+00:00")
}

/// Year, month and day of a day since 1970-01-01.
fn date(days: u64) -> (u64, u64, u64) {
    // Years that begin in March, in eras of 400 years: leap days come last.
    let days = days + 719_468;
    let (era, day) = (days / 146_097, days % 146_097);
    let year = (day - day / 1460 + day / 36_524 - day / 146_096) / 365;
    let day = day - (365 * year + year / 4 - year / 100);
    let month = (5 * day + 2) / 153;
    let (month_of_year, carry) = if month < 10 { (month + 3, 0) } else { (month - 9, 1) };
    (400 * era + year + carry, month_of_year, day - (153 * month + 2) / 5 + 1)
}

#[cfg(test)]
mod tests {
    #[test]
    fn dates_of_known_days() {
        for (days, want) in [
            (0, (1970, 1, 1)),
            (19_782, (2024, 2, 29)),
            (19_783, (2024, 3, 1)),
            (20_453, (2025, 12, 31)),
        ] {
            assert_eq!(super::date(days), want);
        }
    }
}
