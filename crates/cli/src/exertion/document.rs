//! The report as pages: what was computed, what is to be minded, whose is what, provenance.

use mimique_exertion::Expression;
use mimique_report::document::{Block, DataTable, Document, Figure};
use mimique_report::figure::time_courses;
use serde_json::Value;

use super::report::Report;
use crate::report_folder::sentence;

/// Rows of a figure's data, at most: the series has all of them.
const MOST_ROWS: usize = 61;

/// What each part of the model rests on.
const ORIGINS: [(&str, &str); 10] = [
    ("The chain from motion to face, its inputs, levels of training", "Boukhalfi 2012, 3 and 4"),
    ("rcn, the share of the heart's reserve (E1)", "Boukhalfi 2012, 3.3.1"),
    ("Work and power (E5), their unit and step", "Boukhalfi 2012, 3.2; unit and step ours"),
    ("Energies of the body's segments (E3, E4)", "Winter 2009"),
    ("Heart: thesis (E6)", "Boukhalfi 2012, 3.3.1, as printed"),
    ("Heart: steady (E7), heart rate at rest (E2)", "ours"),
    ("Oxygen (E8), breaths (E10)", "Boukhalfi 2012; VO2max Jackson 1990 (E9)"),
    ("EPOC, fatigue (E11)", "a stand-in of ours for a formula that is published nowhere"),
    ("Energy (E12), activities without a skeleton (E13)", "Mifflin 1990; ACSM"),
    ("rules, shapes, strong exhalations, swallows, chest, flush, sweat", "ours"),
];

/// The report's pages. `told` is the same as JSON.
pub(super) fn document(
    report: &Report<'_>,
    expression: &Expression,
    told: &Value,
) -> anyhow::Result<Document> {
    let mut blocks =
        vec![Block::Heading(2, "The exertion".to_owned()), Block::Reading(summary(report, told))];
    let lines = |key: &str| told[key].as_array().into_iter().flatten().filter_map(Value::as_str);
    blocks.extend(lines("warnings").map(|text| Block::Caution(sentence(text))));
    blocks.push(courses(report, expression)?);
    blocks.push(Block::Table(parts(told)));
    blocks.push(Block::Table(end(report, told)));
    blocks.push(Block::Table(person(told)));
    if lines("notes").next().is_some() {
        blocks.push(Block::Heading(2, "What was read".to_owned()));
        blocks.extend(lines("notes").map(|text| Block::Paragraph(sentence(text))));
    }
    blocks.push(Block::Heading(2, "Whose is what".to_owned()));
    blocks.push(Block::Paragraph(
        "No curve was learnt from people by us. The rules, and any model that they teach, show the mechanism. That \
         an open mouth and a dropped jaw follow effort (Timme and Brand 2020, 132 people) and that people frown \
         (de Morree 2010) supports their directions, not their sizes. The recordings and regressions of the \
         document are published nowhere; mimique exertion train takes one's own."
            .to_owned(),
    ));
    let mut origins = DataTable::new("origins", "What each part rests on", ["part", "source"]);
    origins.rows = ORIGINS.iter().map(|(part, source)| texts([part, source])).collect();
    blocks.push(Block::Table(origins));
    blocks.push(Block::Heading(2, "Provenance".to_owned()));
    let mut hashes = DataTable::new("provenance", "Hashes (SHA-256)", ["of", "hash"]);
    for (of, key) in [("weights", "weights_hash"), ("everything", "provenance")] {
        hashes.rows.push(texts([of, told[key].as_str().unwrap_or_default()]));
    }
    blocks.push(Block::Table(hashes));
    Ok(Document {
        title: format!("Exertion: {}", report.name()),
        subtitle: format!("mimique {}, {}", env!("CARGO_PKG_VERSION"), mimique_exertion::VERSION),
        blocks,
    })
}

/// Who did what, and how often curves were cut.
fn summary(report: &Report<'_>, told: &Value) -> String {
    let (clip, cut) = (&report.take.clip, report.take.clip.controls.cut_frames);
    let [from, to] = [clip.times.first(), clip.times.last()].map(|t| t.copied().unwrap_or(0.0));
    format!(
        "A person of level {} for {:.0} s, {:.1} J/kg of work in a second on the mean, {:.0} kcal. The heart ({}) \
         ends the window from {from} to {to} s at {:.0} beats per minute, {:.1} on the scale from 6 to 20. The face \
         has {} frames at {} Hz; {cut} of them have a curve that is cut at the end of its range.",
        number(&told["person"]["level"]),
        told["seconds"].as_f64().unwrap_or(0.0),
        report.mean_work(),
        told["kcal"].as_f64().unwrap_or(0.0),
        told["heart"].as_str().unwrap_or_default(),
        told["end"]["heartRate"].as_f64().unwrap_or(0.0),
        told["end"]["borg"].as_f64().unwrap_or(0.0),
        clip.times.len(),
        clip.rate_hz,
    )
}

fn courses(report: &Report<'_>, expression: &Expression) -> anyhow::Result<Block> {
    let panels = report.panels(expression);
    let caption = "Heart rate, EPOC and curves of the face, second by second".to_owned();
    let mut columns = vec!["s".to_owned()];
    for panel in &panels {
        columns.extend(panel.lines.iter().map(|(name, _)| match name.is_empty() {
            true => panel.label.clone(),
            false => format!("{name}, %"),
        }));
    }
    let mut data = DataTable::new("courses", caption.clone(), columns);
    let seconds = report.take.series.seconds();
    let step = seconds.div_ceil(MOST_ROWS).max(1);
    for second in (0..seconds).step_by(step) {
        let values = panels.iter().flat_map(|panel| &panel.lines).map(|(_, line)| line[second]);
        let cells = std::iter::once(second.to_string()).chain(values.map(|v| format!("{v:.1}")));
        data.rows.push(cells.collect());
    }
    Ok(Block::figure(Figure {
        id: "courses".to_owned(),
        svg: time_courses(&caption, &panels, report.marked()),
        alt: format!("{caption}, over {:.1} minutes", seconds as f64 / 60.0),
        caption,
        data,
    }))
}

/// The parts of the plan.
fn parts(told: &Value) -> DataTable {
    let mut table = DataTable::new(
        "parts",
        "Parts of the plan",
        ["part", "what", "length, s", "work, J/kg in a second", "how"],
    );
    for (i, part) in told["parts"].as_array().into_iter().flatten().enumerate() {
        let word = |key: &str| part[key].as_str().map(str::to_owned);
        let how: Vec<String> = [
            word("file"),
            word("format"),
            word("workFrom").map(|column| format!("work from {column}")),
            part["repeated"].as_bool().filter(|own| *own).map(|_| "repeated".to_owned()),
            part["rateHz"].as_f64().map(|hz| format!("{hz} Hz")),
            part["lowpassHz"].as_f64().map(|hz| format!("low-pass {hz} Hz")),
            word("convention"),
            word("naming").map(|naming| format!("names of {naming}")),
        ]
        .into_iter()
        .flatten()
        .collect();
        table.rows.push(vec![
            (i + 1).to_string(),
            word("kind").unwrap_or_default(),
            number(&part["seconds"]),
            part["workPerSecond"].as_f64().map_or("0".to_owned(), |w| format!("{w:.1}")),
            how.join(", "),
        ]);
    }
    table
}

/// Body and face at the end of the window.
fn end(report: &Report<'_>, told: &Value) -> DataTable {
    let mut table =
        DataTable::new("end", "Body and face at the end of the window", ["what", "value", "unit"]);
    let state = &told["end"];
    for (what, key, unit) in [
        ("work of the last second", "w", "J/kg"),
        ("share of the heart's reserve", "rcn", "1"),
        ("heart rate", "heartRate", "beats per minute"),
        ("uptake of oxygen", "vo2", "ml/kg/min"),
        ("breaths", "breaths", "per minute"),
        ("EPOC", "epoc", "ml/kg"),
        ("fatigue", "fatigue", "1"),
        ("perceived exertion, computed", "borg", "6 to 20"),
    ] {
        table.rows.push(texts([what, &number(&state[key]), unit]));
    }
    for (name, value) in told["curves_at_end"].as_object().into_iter().flatten() {
        table.rows.push(texts([&format!("curve {name}"), &number(value), "%"]));
    }
    let skin = &report.take.series.metabolism;
    for (what, values) in [("flush", &skin.flush), ("sweat", &skin.sweat)] {
        let second = state["second"].as_u64().and_then(|s| values.get(s as usize));
        table.rows.push(texts([what, &format!("{:.2}", second.unwrap_or(&0.0)), "1"]));
    }
    table
}

/// Who it is.
fn person(told: &Value) -> DataTable {
    let mut table = DataTable::new("person", "The person", ["what", "value"]);
    for (key, value) in told["person"].as_object().into_iter().flatten() {
        match value {
            Value::Object(members) => {
                for (name, value) in members {
                    table.rows.push(texts([&format!("{key}, {name}"), &number(value)]));
                }
            }
            Value::Null => {}
            value => table.rows.push(texts([key, &number(value)])),
        }
    }
    table
}

/// A number in at most three decimals, or the text.
fn number(value: &Value) -> String {
    match (value.as_f64(), value.as_str()) {
        (Some(number), _) => format!("{}", (number * 1e3).round() / 1e3),
        (None, Some(text)) => text.to_owned(),
        (None, None) => String::new(),
    }
}

fn texts<const N: usize>(cells: [&str; N]) -> Vec<String> {
    cells.map(str::to_owned).to_vec()
}
