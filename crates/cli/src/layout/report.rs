//! The report of a layout: curves, comparisons, the worth of each marker, what to measure.

use std::path::Path;

use anyhow::Context as _;
use mimique_analysis::Language;
use mimique_analysis::report_parts::{Block, DataTable, Document, Figure, html};
use mimique_layout::{Comparison, CurveRow, Measures};

use super::args::Make;
use super::figure::{Look, Series, bars, curves};
use super::{CountReason, Made};
use crate::output;

/// Writes `report.html`, its tables and `curves.json` into a folder.
pub(super) fn write(
    folder: &Path,
    args: &Make,
    made: &Made<'_, '_>,
    measures: &[Measures],
) -> anyhow::Result<()> {
    let document = document(args, made, measures);
    let make = |path: &Path| {
        std::fs::create_dir_all(path).with_context(|| {
            format!("{}: make the folder; check its parent's permissions", path.display())
        })
    };
    let tables = folder.join("tables");
    make(&tables)?;
    for block in &document.blocks {
        let table = match block {
            Block::Table(table) => table,
            Block::Figure(figure) => &figure.data,
            _ => continue,
        };
        output::write(&tables.join(format!("{}.csv", table.id)), table.to_csv().as_bytes())?;
    }
    let text = serde_json::to_string_pretty(&made.comparison)? + "\n";
    output::write(&folder.join("curves.json"), text.as_bytes())?;
    let page = html(&document, Language::English);
    output::write(&folder.join("report.html"), page.as_bytes())
}

fn document(args: &Make, made: &Made<'_, '_>, measures: &[Measures]) -> Document {
    let count = made.layout.markers.len();
    let mut blocks =
        vec![Block::Heading(2, "The layout".to_owned()), Block::Reading(summary(args, made))];
    blocks.extend(made.warnings.iter().map(|warning| Block::Caution(sentence(warning))));
    if let Some(comparison) = &made.comparison {
        blocks.extend(recommended(args, made, comparison));
        blocks.extend(as_in_the_thesis(comparison));
        blocks.extend(beside_sets(args, made, comparison));
        blocks.push(Block::Heading(2, "Every curve".to_owned()));
        blocks.push(Block::Table(all_rows("recommended", &comparison.recommended)));
        blocks.push(Block::Table(all_rows("as-in-the-thesis", &comparison.as_in_the_thesis)));
    }
    blocks.extend(worth(made));
    blocks.extend(places(measures));
    Document {
        title: format!("Marker layout for {}", made.ground.face.skin.name),
        subtitle: format!("{count} face markers and {} head markers", made.layout.head.len()),
        blocks,
    }
}

/// A warning as a sentence.
fn sentence(text: &str) -> String {
    let mut letters = text.chars();
    let first = letters.next().map(|c| c.to_uppercase().to_string()).unwrap_or_default();
    format!("{first}{}.", letters.as_str())
}

fn summary(args: &Make, made: &Made<'_, '_>) -> String {
    let count = made.layout.markers.len();
    let method = if args.as_thesis { "K-means as in the thesis" } else { made.ground.method.word() };
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
    let mut text = format!("{why}. Their places were chosen by {method}.");
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
fn figure(id: &str, caption: String, alt: &str, series: Vec<Series>) -> Block {
    let mut data = DataTable::new(id, caption.clone(), ["layout", "markers", "mm a vertex"]);
    for s in &series {
        for [markers, error] in &s.points {
            data.row([s.name.clone(), format!("{markers:.0}"), format!("{error:.3}")]);
        }
    }
    let svg = curves(alt, &series);
    Block::Figure(Figure { id: id.to_owned(), caption, alt: alt.to_owned(), svg, data })
}

/// The curve of the recommended judgement.
fn recommended(args: &Make, made: &Made<'_, '_>, comparison: &Comparison) -> Vec<Block> {
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
        figure(
            "curve-recommended",
            caption,
            "Error a vertex over the number of markers, as recommended",
            series(&rows, method),
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
    blocks.push(Block::Table(of_method(comparison, method)));
    blocks
}

/// The errors of the method with every noise, exact and put.
fn of_method(comparison: &Comparison, method: &str) -> DataTable {
    let caption = format!(
        "{method}: errors by noise and placement. 95 %: of the frames are below. Folds: the best and the worst. As \
         printed: eq. 3.5 of the thesis, the sum over the vertices"
    );
    let mut table = DataTable::new(
        "errors-of-the-method",
        caption,
        [
            "solver",
            "noise mm",
            "beside mm",
            "smoothing",
            "markers",
            "mm a vertex",
            "95 %",
            "folds",
            "worst part",
            "mm there",
            "as printed mm",
        ],
    );
    for row in comparison.recommended.iter().filter(|row| row.layout == method) {
        table.row(cells(row));
    }
    table
}

fn cells(row: &CurveRow) -> Vec<String> {
    let errors = &row.errors;
    vec![
        row.trial.solver.clone(),
        format!("{}", row.trial.noise_mm),
        format!("{}", row.trial.slip_mm),
        format!("{}", row.trial.smoothing),
        row.markers.to_string(),
        format!("{:.3}", errors.per_vertex_mm),
        format!("{:.3}", errors.of_95_percent_mm),
        format!("{:.3} to {:.3}", errors.folds_mm[0], errors.folds_mm[1]),
        errors.worst_part.name().to_lowercase(),
        format!("{:.3}", errors.worst_part_mm),
        format!("{:.1}", errors.as_printed_mm),
    ]
}

fn all_rows(id: &str, rows: &[CurveRow]) -> DataTable {
    let mut table = DataTable::new(
        format!("curves-{id}"),
        format!("All layouts and conditions, {}", id.replace('-', " ")),
        [
            "layout",
            "solver",
            "noise mm",
            "beside mm",
            "smoothing",
            "markers",
            "mm a vertex",
            "95 %",
            "folds",
            "worst part",
            "mm there",
            "as printed mm",
        ],
    );
    for row in rows {
        table.row(std::iter::once(row.layout.clone()).chain(cells(row)));
    }
    table
}

/// The curve of the thesis's judgement.
fn as_in_the_thesis(comparison: &Comparison) -> Vec<Block> {
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
        figure(
            "curve-as-in-the-thesis",
            caption,
            "Error a vertex over the number of markers, as in the thesis",
            drawn,
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
fn beside_sets(args: &Make, made: &Made<'_, '_>, comparison: &Comparison) -> Vec<Block> {
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

/// What each marker is worth.
fn worth(made: &Made<'_, '_>) -> Vec<Block> {
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
        figure(
            "placing-order",
            "Error with the first markers of this layout alone, in their placing order".to_owned(),
            "Error a vertex over the first markers of the layout",
            vec![Series { name: "this layout".to_owned(), look: Look::Main, points: before }],
        ),
        Block::Figure(Figure {
            id: "missed".to_owned(),
            caption: "How much the error of a vertex rises without a marker, millimetres; markers at the bottom may \
                      be dropped first"
                .to_owned(),
            alt: alt.to_owned(),
            svg: bars(alt, &missed),
            data: bars_data,
        }),
        Block::Table(table),
    ]
}

/// What to measure on the actor.
fn places(measures: &[Measures]) -> Vec<Block> {
    let mut table = DataTable::new(
        "places",
        "Where to put each marker, millimetres: to the side from the middle plane, above the nasion, in a straight \
         line from the nasion, and along the skin to two landmarks",
        ["no.", "marker", "side", "height", "straight", "skin", "to", "skin", "to"],
    );
    for m in measures {
        let side = match m.left_mm {
            x if x.abs() < 0.5 => "middle".to_owned(),
            x if x > 0.0 => format!("{x:.0} left"),
            x => format!("{:.0} right", -x),
        };
        let [first, second] = &m.along_skin;
        table.row([
            m.number.to_string(),
            m.label.clone(),
            side,
            format!("{:+.0}", m.above_nasion_mm),
            format!("{:.0}", m.from_nasion_mm),
            format!("{:.0}", first.mm),
            first.landmark.to_owned(),
            format!("{:.0}", second.mm),
            second.landmark.to_owned(),
        ]);
    }
    vec![Block::Heading(2, "Where to put them".to_owned()), Block::Table(table)]
}
