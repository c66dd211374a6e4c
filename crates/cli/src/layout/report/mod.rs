//! The report of a layout: curves, comparisons, the worth of each marker, what to measure.

mod curves;
mod drawing;
mod markers;

use std::path::Path;

use mimique_layout::{Measures, Method};
use mimique_locale::Language;
use mimique_report::document::{Block, DataTable, Document, Figure};
use mimique_report::{ReportFile, document_files};

use super::args::Make;
use super::inputs::blame;
use super::{CountReason, Made};
use crate::report_folder::{self, sentence};

/// Writes the report into a folder: a document, every curve as a table, `results.json`.
pub(super) fn write(
    folder: &Path,
    args: &Make,
    made: &Made<'_, '_>,
    measures: &[Measures],
) -> anyhow::Result<()> {
    let mut files = document_files(&document(args, made, measures), Language::English);
    let mut more = |path: String, text: String| files.push(ReportFile { path, text });
    if let Some(comparison) = &made.comparison {
        let tables = [
            curves::all_rows("recommended", &comparison.recommended),
            curves::all_rows("as-in-the-thesis", &comparison.as_in_the_thesis),
        ];
        for table in tables {
            more(format!("tables/{}.csv", table.id), table.to_csv());
        }
    }
    more("results.json".to_owned(), serde_json::to_string_pretty(&made.comparison)? + "\n");
    report_folder::write(&files, folder).map_err(|e| blame(folder, e))?;
    Ok(())
}

fn document(args: &Make, made: &Made<'_, '_>, measures: &[Measures]) -> Document {
    let count = made.layout.markers.len();
    let mut blocks =
        vec![Block::Heading(2, "The layout".to_owned()), Block::Reading(summary(args, made))];
    blocks.extend(made.warnings.iter().map(|warning| Block::Caution(sentence(warning))));
    if let Some(comparison) = &made.comparison {
        blocks.extend(curves::recommended(made, comparison));
        blocks.extend(curves::as_in_the_thesis(comparison));
        blocks.extend(curves::beside_sets(made, comparison));
        blocks.push(Block::Paragraph(
            "Every layout under every condition: tables/curves-recommended.csv and tables/curves-as-in-the-thesis.csv, \
             or results.json."
                .to_owned(),
        ));
    }
    blocks.extend(markers::worth(made));
    blocks.extend(markers::places(measures));
    Document {
        title: format!("Marker layout for {}", made.ground.face.skin.name),
        subtitle: format!("{count} face markers and {} head markers", made.layout.head.len()),
        blocks,
    }
}

fn summary(args: &Make, made: &Made<'_, '_>) -> String {
    let count = made.layout.markers.len();
    let method = if args.as_thesis { "K-means as in the thesis" } else { said(made.ground.method) };
    let why = match made.count {
        CountReason::Asked => format!("{count} markers were asked for"),
        CountReason::Enough => format!(
            "{count} markers are enough: the least number whose error is within a tenth of the best of the range"
        ),
        CountReason::Reaches(wanted) => format!("{count} markers are enough for {wanted} mm"),
        CountReason::NotReached(wanted) => format!(
            "no number of the range reaches {wanted} mm; {count} markers are within a tenth of the best"
        ),
    };
    let mut text = format!("{why}. Method: {method}.");
    if let Some(error) = made.rehearsed_mm {
        text += &format!(
            " In the simulated takes that they were sought with they leave {error:.2} mm a vertex."
        );
    }
    if let Some(heads) = &made.heads {
        text += &format!(
            " Sensor noise of 0.3 mm on the head's markers turns into {:.2} mm on the face.",
            1e3 * heads.error
        );
    }
    text
}

/// How a method chooses.
fn said(method: Method) -> &'static str {
    match method {
        Method::Rehearse => "rehearsal in simulated takes",
        Method::Kmeans => "K-means of trajectories",
        Method::Greedy => "greedy choice by the expected error",
        Method::Qr => "pivoted QR of the modes of the motion",
        Method::Shell => "greedy choice by the error of a thin-shell surface",
        Method::Farthest => "distance alone",
        Method::Reduce => "thinning by rehearsal",
    }
}

/// A figure with its numbers.
fn figure(id: &str, caption: String, alt: &str, svg: String, data: DataTable) -> Block {
    Block::Figure(Figure { id: id.to_owned(), caption, alt: alt.to_owned(), svg, data })
}
