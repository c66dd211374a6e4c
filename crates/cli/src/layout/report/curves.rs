//! Curves and tables of a comparison.

use mimique_layout::{Comparison, CurveRow, RowTrial};
use mimique_report::document::{Block, DataTable};

use super::drawing::{Look, Series, curves};
use super::figure;
use crate::layout::Made;

/// The mean of rows of the same number of markers.
fn mean_of(rows: &[&CurveRow]) -> Vec<[f64; 2]> {
    let mut counts: Vec<usize> = rows.iter().map(|row| row.markers).collect();
    counts.sort_unstable();
    counts.dedup();
    let mean = |count: usize| {
        let own: Vec<f64> = (rows.iter())
            .filter(|row| row.markers == count)
            .map(|row| row.errors.per_vertex_mm)
            .collect();
        own.iter().sum::<f64>() / own.len().max(1) as f64
    };
    counts.into_iter().map(|count| [count as f64, mean(count)]).collect()
}

/// Series of the layouts among some rows of one trial: the method, K-means, chance, then each set.
fn series(rows: &[&CurveRow], method: &str) -> Vec<Series> {
    let of = |name: &str| -> Vec<&CurveRow> {
        rows.iter().copied().filter(|row| row.layout == name).collect()
    };
    let mut found =
        vec![Series { name: method.to_owned(), look: Look::Main, points: mean_of(&of(method)) }];
    if method != "kmeans" {
        let points = mean_of(&of("kmeans"));
        found.push(Series { name: "kmeans".to_owned(), look: Look::Second, points });
    }
    let chance: Vec<&CurveRow> =
        rows.iter().copied().filter(|row| row.layout.starts_with("random ")).collect();
    let drawn =
        chance.iter().map(|row| &row.layout).collect::<std::collections::BTreeSet<_>>().len();
    found.push(Series {
        name: format!("drawn at random (mean of {drawn})"),
        look: Look::Third,
        points: mean_of(&chance),
    });
    let mut sets: Vec<String> = Vec::new();
    for row in rows {
        let made =
            row.layout == method || row.layout == "kmeans" || row.layout.starts_with("random ");
        if !made && !sets.contains(&row.layout) {
            sets.push(row.layout.clone());
        }
    }
    for name in sets {
        let points = mean_of(&of(&name));
        found.push(Series { name, look: Look::Numbered, points });
    }
    found
}

/// A figure of curves with its numbers.
pub(super) fn curves_figure(id: &str, caption: String, alt: &str, series: &[Series]) -> Block {
    let mut data = DataTable::new(id, caption.clone(), ["layout", "markers", "mm a vertex"]);
    for s in series {
        for [markers, error] in &s.points {
            data.row([s.name.clone(), format!("{markers:.0}"), format!("{error:.3}")]);
        }
    }
    figure(id, caption, alt, curves(alt, series), data)
}

/// The curve of the recommended judgement.
pub(super) fn recommended(made: &Made<'_, '_>, comparison: &Comparison) -> Vec<Block> {
    let method = made.ground.method.word();
    let curve = comparison.main_curve(method);
    let Some(first) = curve.first() else { return Vec::new() };
    let trial = &first.trial;
    let rows: Vec<&CurveRow> =
        comparison.recommended.iter().filter(|row| row.trial == *trial).collect();
    let folds = comparison.folds.join("; ");
    let caption = format!(
        "Error over the number of markers, as recommended: solved by {}, noise {} mm, markers {} mm beside their \
         places, another face in every other take, adaptation smoothed by {}. Left out in turn: {folds}",
        trial.solver, trial.noise_mm, trial.slip_mm, trial.smoothing
    );
    let mut blocks = vec![
        Block::Heading(2, "How many markers are enough".to_owned()),
        curves_figure(
            "curve-recommended",
            caption,
            "Error a vertex over the number of markers, as recommended",
            &series(&rows, method),
        ),
    ];
    let points: Vec<(usize, f64)> =
        curve.iter().map(|row| (row.markers, row.errors.per_vertex_mm)).collect();
    if let Some(enough) = mimique_layout::enough(&points) {
        blocks.push(Block::Reading(format!(
            "{enough} markers are within a tenth of the best error of these numbers; more of them gain less than \
             they cost to put on."
        )));
    }
    blocks.push(Block::Table(main_rows(method, &curve)));
    blocks.push(Block::Table(by_condition(comparison, method)));
    blocks
}

/// The rows of the main curve.
fn main_rows(method: &str, curve: &[&CurveRow]) -> DataTable {
    let caption = format!(
        "{method}, as recommended. 95 % of the frames are below the error of their column; the last column is eq. 3.5 \
         of the thesis as it is printed, the root of the sum over the vertices and not of their mean"
    );
    let mut table = DataTable::new("curve-of-the-method", caption, COLUMNS.map(|name| name));
    for row in curve {
        table.row(cells(row));
    }
    table
}

/// The error of a vertex for every noise and placement, a column for each number of markers.
fn by_condition(comparison: &Comparison, method: &str) -> DataTable {
    let own = || comparison.recommended.iter().filter(|row| row.layout == method);
    let mut counts: Vec<usize> = own().map(|row| row.markers).collect();
    counts.sort_unstable();
    counts.dedup();
    let mut trials: Vec<&RowTrial> = Vec::new();
    for row in own() {
        if !trials.contains(&&row.trial) {
            trials.push(&row.trial);
        }
    }
    let caption = format!(
        "{method}: error of a vertex, millimetres, by solver, noise, how far markers are put beside their places, \
         and rbfSmoothing, for each number of markers"
    );
    let mut names: Vec<String> =
        ["solver", "noise mm", "beside mm", "smoothing"].map(str::to_owned).to_vec();
    names.extend(counts.iter().map(ToString::to_string));
    let mut table = DataTable::new("errors-by-condition", caption, names);
    for trial in trials {
        let mut row = condition(trial);
        row.extend(counts.iter().map(|&count| {
            let found = own().find(|row| row.trial == *trial && row.markers == count);
            found.map_or(String::new(), |row| format!("{:.3}", row.errors.per_vertex_mm))
        }));
        table.row(row);
    }
    table
}

/// What a trial is made of.
fn condition(trial: &RowTrial) -> Vec<String> {
    vec![
        trial.solver.clone(),
        trial.noise_mm.to_string(),
        trial.slip_mm.to_string(),
        trial.smoothing.to_string(),
    ]
}

/// The columns of [`cells`].
const COLUMNS: [&str; 8] = [
    "markers",
    "mm a vertex",
    "95 %",
    "best fold",
    "worst fold",
    "worst part",
    "mm there",
    "mm as printed",
];

fn cells(row: &CurveRow) -> Vec<String> {
    let errors = &row.errors;
    vec![
        row.markers.to_string(),
        format!("{:.3}", errors.per_vertex_mm),
        format!("{:.3}", errors.of_95_percent_mm),
        format!("{:.3}", errors.folds_mm[0]),
        format!("{:.3}", errors.folds_mm[1]),
        errors.worst_part.name().to_lowercase(),
        format!("{:.3}", errors.worst_part_mm),
        format!("{:.1}", errors.as_printed_mm),
    ]
}

/// Every row of one of the two judgements, for a file of its own.
pub(super) fn all_rows(id: &str, rows: &[CurveRow]) -> DataTable {
    let conditions = ["layout", "solver", "noise mm", "beside mm", "smoothing"];
    let names = conditions.into_iter().chain(COLUMNS);
    let mut table = DataTable::new(format!("curves-{id}"), "", names.collect::<Vec<_>>());
    for row in rows {
        let cells =
            std::iter::once(row.layout.clone()).chain(condition(&row.trial)).chain(cells(row));
        table.row(cells);
    }
    table
}

/// The curve of the thesis's judgement.
pub(super) fn as_in_the_thesis(comparison: &Comparison) -> Vec<Block> {
    let of = |solver: &str| -> Vec<&CurveRow> {
        comparison.as_in_the_thesis.iter().filter(|row| row.trial.solver == solver).collect()
    };
    let sparse = of("regression sparse");
    let exact = of("regression exact");
    if sparse.is_empty() {
        return Vec::new();
    }
    let mut drawn = series(&sparse, "kmeans");
    let kmeans: Vec<&CurveRow> = exact.into_iter().filter(|row| row.layout == "kmeans").collect();
    drawn.insert(
        1,
        Series {
            name: "kmeans, exact process".to_owned(),
            look: Look::Second,
            points: mean_of(&kmeans),
        },
    );
    let caption = "Error over the number of markers, as in the thesis (3.5, 3.6): K-means of any place of the face, \
                   a sparse Gaussian process from markers to weights, markers exactly at their vertices, no noise"
        .to_owned();
    vec![
        Block::Heading(2, "As in the thesis".to_owned()),
        curves_figure(
            "curve-as-in-the-thesis",
            caption,
            "Error a vertex over the number of markers, as in the thesis",
            &drawn,
        ),
        Block::Caution(
            "The thesis reads a least number of markers off this curve. Where it levels off is as much a property of \
             the process (how many basis vectors it keeps) as of the markers; the recommended curve has the solver \
             that will be used, and what goes wrong when people put markers on."
                .to_owned(),
        ),
    ]
}

/// Sets that were used before beside the method's layouts of the same size.
pub(super) fn beside_sets(made: &Made<'_, '_>, comparison: &Comparison) -> Vec<Block> {
    let method = made.ground.method.word();
    let curve = comparison.main_curve(method);
    let Some(first) = curve.first() else { return Vec::new() };
    let of_thesis = |layout: &str, markers: usize| {
        comparison
            .as_in_the_thesis
            .iter()
            .find(|row| {
                row.layout == layout
                    && row.markers == markers
                    && row.trial.solver == "regression sparse"
            })
            .map_or(String::new(), |row| format!("{:.3}", row.errors.per_vertex_mm))
    };
    let mut table = DataTable::new(
        "sets",
        format!(
            "Sets that were used before, beside {method} with as many markers or the next fewer"
        ),
        [
            "set",
            "markers",
            "mm a vertex",
            &format!("{method}, markers"),
            &format!("{method}, mm"),
            "as in the thesis, mm",
        ],
    );
    let rows: Vec<&CurveRow> = (comparison.recommended.iter())
        .filter(|row| row.trial == first.trial)
        .filter(|row| {
            row.layout != method && row.layout != "kmeans" && !row.layout.starts_with("random ")
        })
        .collect();
    for row in &rows {
        let beside = curve.iter().rev().find(|own| own.markers <= row.markers);
        table.row([
            row.layout.clone(),
            row.markers.to_string(),
            format!("{:.3}", row.errors.per_vertex_mm),
            beside.map_or(String::new(), |own| own.markers.to_string()),
            beside.map_or(String::new(), |own| format!("{:.3}", own.errors.per_vertex_mm)),
            of_thesis(&row.layout, row.markers),
        ]);
    }
    if rows.is_empty() {
        return Vec::new();
    }
    vec![Block::Heading(2, "Beside sets that were used before".to_owned()), Block::Table(table)]
}
