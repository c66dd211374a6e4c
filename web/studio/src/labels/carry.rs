//! Labels into and out of the expressions, CSV, ELAN and the segments of a study file.

use mimique_stimulus::{
    EafAnnotation, EafDocument, TakeSegment, study_segments, write_segments_with,
};
use serde_json::{Value, json};

use super::WHAT;
use super::boxes::{LabelBox, outside};
use crate::problem::Problem;
use crate::workspace::Workspace;

/// Tiers of an ELAN document: confirmed labels, suggested ones, how probable those are.
const TIERS: [&str; 3] = ["labels", "labels (suggested)", "labels (confidence)"];
/// The label of a face at rest.
const NEUTRAL: &str = "neutral";

impl Workspace {
    /// Takes the expressions of the timeline as confirmed labels, without the numbers behind their
    /// names (`joy2` is `joy`); with `rest_is_neutral` what lies between them as the neutral face.
    ///
    /// # Errors
    /// [`Problem`]: no take, no expression, expressions that overlap.
    pub fn labels_from_expressions(&mut self, rest_is_neutral: bool) -> Result<Value, Problem> {
        let (frames, _) = self.length()?;
        let mut segments = self.segments.clone();
        segments.sort_by_key(|segment| segment.expression.start);
        if segments.is_empty() {
            return Err(Problem::of(WHAT, "no expression; open some, or add one at the playhead"));
        }
        if let Some(pair) =
            segments.windows(2).find(|p| p[1].expression.start < p[0].expression.end)
        {
            let what = format!("{} and {} overlap; move one", pair[0].label, pair[1].label);
            return Err(Problem::of(WHAT, what));
        }
        let mut boxes = Vec::new();
        for TakeSegment { label, expression, .. } in &segments {
            let bare = label.trim_end_matches(|c: char| c.is_ascii_digit()).trim_end();
            let label = self.labels.label(if bare.is_empty() { label } else { bare });
            boxes.push(LabelBox::truth(expression.clone(), label));
        }
        if rest_is_neutral {
            let neutral = self.labels.label(NEUTRAL);
            let expressions: Vec<_> = segments.into_iter().map(|s| s.expression).collect();
            let rest = outside(0..frames, &expressions);
            boxes.extend(rest.into_iter().map(|frames| LabelBox::truth(frames, neutral)));
        }
        self.labels.boxes.put(boxes);
        Ok(self.labels_state())
    }

    /// Puts the labelled stretches but those of the neutral face in the place of the expressions; the
    /// confirmed ones alone where that is asked for. Answers the expressions.
    ///
    /// # Errors
    /// [`Problem`]: no take, or nothing that is labelled.
    pub fn labels_to_expressions(&mut self, confirmed_only: bool) -> Result<Value, Problem> {
        let boxes = self.labels.boxes.all().iter().filter(|own| own.confirmed || !confirmed_only);
        let segments: Vec<TakeSegment> = boxes
            .map(|own| TakeSegment::new(self.labels.names[own.label].as_str(), own.frames.clone()))
            .filter(|segment| !segment.label.eq_ignore_ascii_case(NEUTRAL))
            .collect();
        if segments.is_empty() {
            return Err(Problem::of(
                WHAT,
                "no label but the neutral face; suggest or confirm some",
            ));
        }
        self.put_expressions(WHAT, segments)
    }

    /// The labels as CSV: the columns of segments, `probability,second,second_probability,confirmed`.
    ///
    /// # Errors
    /// [`Problem`]: no take.
    pub fn labels_csv(&self) -> Result<String, Problem> {
        let (_, rate_hz) = self.length()?;
        let boxes = self.labels.boxes.all();
        let segments: Vec<TakeSegment> = boxes.iter().map(|own| self.segment_of(own)).collect();
        let beside = |own: &LabelBox| {
            let (second, probability) = match own.second {
                Some((label, p)) => (self.labels.names[label].clone(), p.to_string()),
                None => (String::new(), String::new()),
            };
            let confirmed = u8::from(own.confirmed).to_string();
            [own.probability.to_string(), second, probability, confirmed]
        };
        let beside: Vec<[String; 4]> = boxes.iter().map(beside).collect();
        let names = ["probability", "second", "second_probability", "confirmed"];
        Ok(write_segments_with(&segments, rate_hz, &names, &beside))
    }

    /// The labels as tiers of an ELAN document: confirmed, suggested, and how probable those are; all
    /// other tiers of `document` stay.
    ///
    /// # Errors
    /// [`Problem`]: no take, a document that cannot be read or written.
    pub fn labels_eaf(&self, document: Option<&str>, date: &str) -> Result<String, Problem> {
        let (_, rate_hz) = self.length()?;
        let problem = |e| Problem::of("ELAN document", e);
        let mut document = match document {
            Some(text) => EafDocument::parse(text),
            None => EafDocument::new(date, None),
        }
        .map_err(problem)?;
        let annotation = |own: &LabelBox| EafAnnotation::of(&self.segment_of(own), rate_hz);
        let of = |confirmed: bool| {
            self.labels.boxes.all().iter().filter(move |own| own.confirmed == confirmed)
        };
        let probable = |own: &LabelBox| EafAnnotation {
            value: format!("{:.2}", own.probability),
            ..annotation(own)
        };
        let tiers: [Vec<EafAnnotation>; 3] = [
            of(true).map(annotation).collect(),
            of(false).map(annotation).collect(),
            of(false).map(probable).collect(),
        ];
        for (name, annotations) in TIERS.into_iter().zip(&tiers) {
            document = document.with_tier(name, annotations).map_err(problem)?;
        }
        Ok(document.text().to_owned())
    }

    /// The expressions as the `segments` of a study file, as JSON.
    ///
    /// # Errors
    /// [`Problem`]: no take.
    pub fn study_segments(&self) -> Result<String, Problem> {
        self.length()?;
        let segments = study_segments(&self.segments, self.take_name());
        let text = serde_json::to_string_pretty(&json!({ "segments": segments }));
        text.map_err(|e| Problem::of(WHAT, e))
    }

    fn segment_of(&self, own: &LabelBox) -> TakeSegment {
        TakeSegment::new(self.labels.names[own.label].as_str(), own.frames.clone())
    }
}
