//! What each marker is worth, and where it is put.

use mimique_layout::Measures;
use mimique_report::document::{Block, DataTable};

use super::curves::curves_figure;
use super::drawing::{Look, Series, bars};
use super::figure;
use crate::layout::Made;

/// What each marker is worth.
pub(super) fn worth(made: &Made<'_, '_>) -> Vec<Block> {
    if made.worth.is_empty() {
        return Vec::new();
    }
    let markers = &made.layout.markers;
    let mut table = DataTable::new(
        "worth",
        "The worth of each marker in its placing order: the error with the markers up to it, and how much the error \
         rises without it",
        ["number", "marker", "with those before, mm", "missed, mm"],
    );
    let mut missed: Vec<(String, f64)> = Vec::new();
    let mut before: Vec<[f64; 2]> = Vec::new();
    for (number, (marker, worth)) in markers.iter().zip(&made.worth).enumerate() {
        let cell = |value: Option<f64>| value.map_or(String::new(), |mm| format!("{mm:.3}"));
        table.row([
            (number + 1).to_string(),
            marker.label.clone(),
            cell(worth.with_those_before_mm),
            cell(worth.missed_mm),
        ]);
        missed.extend(worth.missed_mm.map(|mm| (marker.label.clone(), mm)));
        before.extend(worth.with_those_before_mm.map(|mm| [(number + 1) as f64, mm]));
    }
    missed.sort_by(|a, b| b.1.total_cmp(&a.1));
    let mut bars_data =
        DataTable::new("missed", "How much the error rises without a marker", ["marker", "mm"]);
    missed.iter().for_each(|(label, mm)| bars_data.row([label.clone(), format!("{mm:.3}")]));
    let alt = "How much the error rises without each marker, millimetres";
    vec![
        Block::Heading(2, "What each marker is worth".to_owned()),
        curves_figure(
            "placing-order",
            "Error with the first markers of this layout alone, in their placing order".to_owned(),
            "Error a vertex over the first markers of the layout",
            &[Series { name: "this layout".to_owned(), look: Look::Main, points: before }],
        ),
        figure(
            "missed",
            "How much the error of a vertex rises without a marker, millimetres; markers at the bottom may be dropped \
             first"
                .to_owned(),
            alt,
            bars(alt, &missed),
            bars_data,
        ),
        Block::Table(table),
    ]
}

/// What to measure on the actor.
pub(super) fn places(measures: &[Measures]) -> Vec<Block> {
    let mut table = DataTable::new(
        "places",
        "Where to put each marker, millimetres: to the side from the middle plane, above the nasion, in a straight \
         line from the nasion, and along the skin to two landmarks",
        ["no.", "marker", "side", "height", "straight", "skin", "to", "skin", "to"],
    );
    for own in measures {
        table.row(own.cells());
    }
    vec![Block::Heading(2, "Where to put them".to_owned()), Block::Table(table)]
}
