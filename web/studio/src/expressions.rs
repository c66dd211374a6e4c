//! The expressions of a take: suggested, corrected on the timeline, carried to CSV and ELAN and back.

use mimique_geometry::coordinates;
use mimique_mocap::stabilise;
use mimique_stimulus::{
    Channels, EafAnnotation, EafDocument, SuggestOptions, TakeSegment, cut, read_segments, suggest,
    write_segments,
};
use serde::Deserialize;
use serde_json::{Value, json};

use crate::problem::{Problem, Trouble};
use crate::workspace::{Take, Workspace};

/// Tier of an ELAN document.
const TIER: &str = "expressions";
/// Seconds of neutral before and after an expression.
const LEAD_S: f64 = 0.2;

/// A segment as the timeline hands it back.
#[derive(Deserialize)]
struct Edited {
    label: String,
    expression: [usize; 2],
}

/// The channels that expressions are found in.
struct Track {
    values: Vec<f64>,
    count: usize,
    rate_hz: f64,
    /// Names of the blendshapes; none of markers.
    names: Vec<String>,
}

impl Workspace {
    /// Suggests expressions, from the weights of `slot` where there are some, else from the markers
    /// in a still head; answers the timeline. `sensitivity` as [`SuggestOptions`] has it.
    ///
    /// # Errors
    /// [`Problem`]: nothing to look at, or too short.
    pub fn suggest_expressions(
        &mut self,
        slot: &str,
        labels: &str,
        sensitivity: f64,
    ) -> Result<Value, Problem> {
        let track = self.track(slot)?;
        let options = SuggestOptions {
            sensitivity,
            neutral: self.map.neutral.clone().filter(|_| self.capture().is_ok()),
            labels: labels
                .split(',')
                .map(str::trim)
                .filter(|l| !l.is_empty())
                .map(str::to_owned)
                .collect(),
            ..SuggestOptions::default()
        };
        let channels = Channels {
            values: &track.values,
            count: track.count,
            rate_hz: track.rate_hz,
            names: &track.names,
        };
        let mut found = suggest(channels, &options).map_err(|e| Problem::of("expressions", e))?;
        let frames = track.values.len() / track.count.max(1);
        found.segments = cut(&found.segments, frames, track.rate_hz, LEAD_S, LEAD_S);
        self.segments = found.segments.clone();
        Ok(json!(found.timeline()))
    }

    /// Takes segments as corrected on the timeline: `[{label, expression: [first, end]}, ...]`.
    ///
    /// # Errors
    /// [`Problem`]: not segments of the take.
    pub fn set_expressions(&mut self, segments: &str) -> Result<Value, Problem> {
        let edited: Vec<Edited> =
            serde_json::from_str(segments).map_err(|e| Problem::of("expressions", e))?;
        let segments: Vec<TakeSegment> = (edited.into_iter())
            .map(|s| TakeSegment::new(s.label, s.expression[0]..s.expression[1]))
            .collect();
        self.put_expressions("expressions", segments)
    }

    /// Takes segments from a file: CSV, or ELAN (`.eaf`). `leftOut` says what of an ELAN tier is no segment.
    ///
    /// # Errors
    /// [`Problem`] with the file's name.
    pub fn expressions_file(&mut self, file: &str, text: &str) -> Result<Value, Problem> {
        let (_, rate_hz) = self.length()?;
        if !is_eaf(file) {
            let segments = read_segments(text).map_err(|e| Problem::of(file, e))?;
            return self.put_expressions(file, segments);
        }
        let document = EafDocument::parse(text).map_err(|e| Problem::of(file, e))?;
        let found = document.segments(TIER, rate_hz).map_err(|e| Problem::of(file, e))?;
        let mut told = self.put_expressions(file, found.segments)?;
        told["leftOut"] = json!(found.left_out.sentence());
        Ok(told)
    }

    pub(crate) fn put_expressions(
        &mut self,
        from: &str,
        segments: Vec<TakeSegment>,
    ) -> Result<Value, Problem> {
        let (frames, rate_hz) = self.length()?;
        if let Some(s) = segments.iter().find(|s| s.expression.is_empty() || s.clip.end > frames) {
            let what = format!(
                "{}: frames {}:{} of {frames}; give a range inside the take",
                s.label, s.expression.start, s.expression.end
            );
            return Err(Problem::of(from, what));
        }
        self.segments = cut(&segments, frames, rate_hz, LEAD_S, LEAD_S);
        Ok(self.expressions())
    }

    /// The segments as they are now.
    pub fn expressions(&self) -> Value {
        let rate_hz = self.length().map_or(1.0, |(_, rate)| rate);
        let seconds =
            |r: &std::ops::Range<usize>| [r.start as f64 / rate_hz, r.end as f64 / rate_hz];
        let segments = self.segments.iter().map(|s| {
            json!({
                "label": s.label,
                "clip": [s.clip.start, s.clip.end],
                "expression": [s.expression.start, s.expression.end],
                "clip_s": seconds(&s.clip),
                "expression_s": seconds(&s.expression),
            })
        });
        json!({ "segments": segments.collect::<Vec<Value>>() })
    }

    /// The segments as CSV.
    ///
    /// # Errors
    /// [`Problem`]: no take.
    pub fn expressions_csv(&self) -> Result<String, Problem> {
        let (_, rate_hz) = self.length()?;
        Ok(write_segments(&self.segments, rate_hz))
    }

    /// The segments as a tier of an ELAN document: of `document` where given, whose other tiers
    /// stay; else of a new one of that `date` (ISO 8601).
    ///
    /// # Errors
    /// [`Problem`]: no take, a document that cannot be read, segments that overlap.
    pub fn expressions_eaf(&self, document: Option<&str>, date: &str) -> Result<String, Problem> {
        let (_, rate_hz) = self.length()?;
        let problem = |e| Problem::of("ELAN document", e);
        let document = match document {
            Some(text) => EafDocument::parse(text),
            None => EafDocument::new(date, None),
        };
        let annotations: Vec<EafAnnotation> =
            self.segments.iter().map(|s| EafAnnotation::of(s, rate_hz)).collect();
        let document = document.and_then(|d| d.with_tier(TIER, &annotations)).map_err(problem)?;
        Ok(document.text().to_owned())
    }

    /// Frames and rate of the take.
    pub(crate) fn length(&self) -> Result<(usize, f64), Problem> {
        match &self.take {
            Some(Take::Markers { recording, .. }) => {
                Ok((recording.capture.frames(), recording.capture.rate_hz))
            }
            Some(Take::Weights { name, table, .. }) => {
                let rate = table.rate_hz().ok_or_else(|| Problem::of(name, "no rate"))?;
                Ok((table.frames.len(), rate))
            }
            None => Err(Trouble::NoCapture.into()),
        }
    }

    fn track(&self, slot: &str) -> Result<Track, Problem> {
        if let Some(solved) = self.solved.get(slot) {
            return Ok(Track {
                values: solved.table.weights.clone(),
                count: solved.table.shape_names.len(),
                rate_hz: solved.rate_hz,
                names: solved.table.shape_names.clone(),
            });
        }
        if let Some(Take::Weights { table, .. }) = &self.take {
            let (_, rate_hz) = self.length()?;
            let names = table.shape_names.clone();
            return Ok(Track { values: table.weights.clone(), count: names.len(), rate_hz, names });
        }
        let mut capture = self.capture()?.clone();
        if !self.map.head.is_empty() {
            stabilise(&mut capture, &self.map.head).map_err(|e| Problem::of("head", e))?;
        }
        Ok(Track {
            count: 3 * capture.labels.len(),
            rate_hz: capture.rate_hz,
            values: coordinates(&capture.positions).to_vec(),
            names: Vec::new(),
        })
    }
}

fn is_eaf(file: &str) -> bool {
    file.to_ascii_lowercase().ends_with(".eaf")
}
