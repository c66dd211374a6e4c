//! `elan/`: words and frames of an annotator's tier, and the tiers that suggestions become.

use std::ops::Range;

use mimique_annotate::Vocabulary;
use mimique_stimulus::{EafAnnotation, EafDocument, TakeSegment};
use serde_json::{Value, json};

use super::Source;
use crate::case::Tolerance;
use crate::document::{Part, Table, text};
use crate::{Case, VerifyError};

/// The tier that is read, at every rate, and the tiers that are written.
pub(super) fn words(source: &Source<'_>, each: &mut dyn FnMut(Case)) -> Result<(), VerifyError> {
    let root = source.document.root();
    let file = source.folder.join("elan/manual.eaf");
    let document = EafDocument::parse(&text(&file)?).map_err(|e| VerifyError::file(&file, &e))?;
    let mut entries = Vec::new();
    for (label, word) in root.get("vocabulary")?.members()? {
        entries.push((label, word.text()?));
    }
    let words = Vocabulary::new(entries);
    let tier = root.get("tier")?;
    let tier = document.tier(tier.text()?).ok_or_else(|| tier.wrong("a tier of manual.eaf"))?;
    for (rate, expected) in root.get("read")?.members()? {
        let rate_hz: f64 =
            rate.parse().map_err(|_| expected.wrong("a list named by a rate in Hz"))?;
        let read = |annotation: &EafAnnotation| {
            let mark = words.read(&annotation.value);
            let frames = annotation.frames(rate_hz);
            json!({
                "first": frames.start,
                "end": frames.end,
                "value": annotation.value,
                "label": mark.and_then(|mark| words.name(mark)),
            })
        };
        let mut case = source.case(format_args!("read/{rate}"));
        let got: Value = tier.annotations.iter().map(read).collect();
        case.compare("annotations", expected.value(), &got, Tolerance::Exact);
        each(case);
    }
    let mut case = source.case("unknown");
    let unknown = tier.annotations.iter().filter(|a| words.read(&a.value).is_none());
    let mut unknown: Vec<&str> = unknown.map(|a| a.value.as_str()).collect();
    unknown.sort_unstable();
    unknown.dedup();
    case.compare("unknown", root.get("unknown")?.value(), &json!(unknown), Tolerance::Exact);
    each(case);
    if let Some(write) = root.find("write") {
        each(written(source, &document, &write)?);
    }
    Ok(())
}

/// Suggestions of a table.
fn suggested(source: &Source<'_>) -> Result<Vec<(TakeSegment, f64)>, VerifyError> {
    let table = Table::read(&source.folder.join("elan/suggested.csv"))?;
    let [label, first, last] = ["label", "first_frame", "last_frame"].map(|c| table.column(c));
    let (label, first, last, probability) = (label?, first?, last?, table.column("probability")?);
    let row = |row: usize| {
        let frames: Range<usize> = table.index(row, first)?..table.index(row, last)? + 1;
        let number = |cell: &str| cell.parse().ok();
        let probability = table.cell(row, probability, "a number", number)?;
        Ok((TakeSegment::new(table.rows[row][label].as_str(), frames), probability))
    };
    (0..table.rows.len()).map(row).collect()
}

/// Writes the suggestions beside the annotator's tier and reads them back; all other tiers stay.
fn written(
    source: &Source<'_>,
    document: &EafDocument,
    expected: &Part<'_>,
) -> Result<Case, VerifyError> {
    let mut case = source.case("write");
    let rate_hz = expected.get("rate_hz")?.number()?;
    let suggested = suggested(source)?;
    let tiers = expected.get("tiers")?.members()?;
    let mut written = document.clone();
    for (name, _) in &tiers {
        // The words are labels, or what stands for their probability.
        let annotation = |(segment, probability): &(TakeSegment, f64)| {
            let mut own = EafAnnotation::of(segment, rate_hz);
            if name.ends_with("(confidence)") {
                own.value = format!("{probability:.2}");
            }
            own
        };
        let annotations: Vec<EafAnnotation> = suggested.iter().map(annotation).collect();
        match written.with_tier(name, &annotations) {
            Ok(with) => written = with,
            Err(why) => case.refused(name, &why),
        }
    }
    for (name, expected) in &tiers {
        let tier = written.tier(name).map_or(&[][..], |tier| &tier.annotations);
        let got = tier.iter().map(|a| json!([a.start_ms, a.end_ms, a.value])).collect();
        case.compare(name, expected.value(), &got, Tolerance::Exact);
    }
    let others = |document: &EafDocument| -> Value {
        let own = document.tiers().iter().filter(|t| tiers.iter().all(|(name, _)| *name != t.id));
        own.map(|t| json!([t.id, t.annotations.len()])).collect()
    };
    case.compare("other tiers", &others(document), &others(&written), Tolerance::Exact);
    Ok(case)
}
