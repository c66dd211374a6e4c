//! Twins of the seeds of every format: a benign twin reads as its seed; a hostile one is refused with place
//! and remedy, reads as its seed, or carries a note that the seed does not. None is read otherwise in
//! silence.

use std::path::Path;

use mimique_geometry::coordinates;
use mimique_mocap::{
    CaptureFacts, CaptureFile, Format, ReadError, ReadOptions, WeightOptions, formats,
};

use crate::support::binary_twins;
use crate::support::twin_forms::FORMS;
use crate::support::twins::{self, Twin};

/// What is read of a file.
#[derive(Debug)]
struct Told {
    /// Labels, rate, unit and the bits of all numbers.
    content: (Vec<String>, String, Vec<u64>),
    /// What is said of it.
    notes: Vec<String>,
}

fn bits(numbers: &[f64]) -> Vec<u64> {
    numbers
        .iter()
        .map(|x| if x.is_nan() { f64::NAN.to_bits() } else { (x + 0.0).to_bits() })
        .collect()
}

fn told(bytes: &[u8], weights: bool) -> Result<Told, ReadError> {
    let mut file = CaptureFile::of_bytes(bytes)?;
    if weights {
        let names: Vec<String> = (0..4).map(|k| format!("shape{k}")).collect();
        let options = WeightOptions { rate_hz: Some(60.0), shape_names: &names, animation: None };
        let table = file.weights(&options)?;
        let rate = table.rate_hz().map(|rate| format!("{rate:.6}"));
        return Ok(Told {
            content: (table.shape_names, format!("{rate:?}"), bits(&table.weights)),
            notes: table
                .filled
                .iter()
                .map(|span| format!("filled {span:?}"))
                .chain(table.notes)
                .collect(),
        });
    }
    // An array of vertices has no rate; other files are held to their own.
    let rate_hz = file.format().filter(|format| format.id == "npy-vertices").map(|_| 60.0);
    let recording = file.recording(&ReadOptions { rate_hz, ..ReadOptions::default() })?;
    let facts = CaptureFacts::of(&recording);
    let capture = recording.capture;
    Ok(Told {
        content: (
            capture.labels,
            format!("{:.6} Hz, {:?}", capture.rate_hz, capture.unit),
            bits(coordinates(&capture.positions)),
        ),
        notes: facts.notes.into_iter().chain(facts.warnings).collect(),
    })
}

/// The seeds of a format, each with its name.
fn seeds(format: &Format) -> Vec<(String, Vec<u8>)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz/corpus").join(format.id);
    let mut seeds: Vec<(String, Vec<u8>)> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.file_name().unwrap().to_string_lossy().starts_with("seed-"))
        .map(|path| {
            (
                path.file_name().unwrap().to_string_lossy().into_owned(),
                std::fs::read(&path).unwrap(),
            )
        })
        .collect();
    seeds.sort();
    seeds
}

/// What is wrong with how a twin is read; `None` where nothing is.
fn fault(twin: &Twin, seed: &Told, weights: bool) -> Option<String> {
    match told(&twin.bytes, weights) {
        Err(error) if twin.benign => Some(format!("refused: {error}")),
        Err(error) => {
            let text = error.to_string();
            let whole = text.contains(": ") && text.contains("; ");
            (!whole).then(|| format!("neither place nor remedy: {text}"))
        }
        Ok(read) if read.content == seed.content => None,
        Ok(read) if twin.benign => {
            Some(format!("another capture: {:?} {}", read.content.0, read.content.1))
        }
        Ok(read) => {
            let said = read.notes.iter().any(|note| !seed.notes.contains(note));
            (!said).then(|| {
                let (labels, rate, numbers) = &read.content;
                format!(
                    "in silence: {labels:?} {rate}, {} numbers, {:?}",
                    numbers.len(),
                    read.notes
                )
            })
        }
    }
}

/// The least rows that the rules need to have something to change.
const LEAST_ROWS: usize = 8;

fn twins_of(format: &Format, bytes: &[u8]) -> Vec<Twin> {
    let Some(form) = FORMS.iter().find(|form| form.id == format.id) else {
        return binary_twins::twins(format.id, bytes);
    };
    let fronts: Vec<(String, String)> = formats()
        .iter()
        .filter(|other| FORMS.iter().any(|form| form.id == other.id))
        .flat_map(|other| {
            seeds(other).into_iter().map(|(_, bytes)| {
                let text = String::from_utf8(bytes).unwrap();
                let front: String = text.split_inclusive('\n').take(2).collect();
                (other.id.to_owned(), front)
            })
        })
        .collect();
    twins::text_twins(form, std::str::from_utf8(bytes).unwrap(), &fronts)
}

#[test]
fn no_twin_is_read_otherwise_in_silence() {
    let (mut faults, mut count) = (Vec::new(), 0);
    for format in formats() {
        let mut long_enough = 0;
        for (name, bytes) in seeds(format) {
            // The smallest seeds are for the fuzzer: the rules change the fourth row of several.
            let text = std::str::from_utf8(&bytes).unwrap_or_default();
            let form = FORMS.iter().find(|form| form.id == format.id);
            if form.is_some_and(|form| form.rows(text) < LEAST_ROWS) {
                continue;
            }
            long_enough += 1;
            let seed = told(&bytes, format.holds_weights()).unwrap();
            for twin in twins_of(format, &bytes) {
                count += 1;
                if let Some(fault) = fault(&twin, &seed, format.holds_weights()) {
                    faults.push(format!("{} {name}, {}: {fault}", format.id, twin.name));
                }
            }
        }
        assert!(long_enough > 0, "{format:?} has no seed of {LEAST_ROWS} rows");
    }
    assert!(count > 400, "{count} twins");
    assert!(faults.is_empty(), "{} of {count} twins:\n{}", faults.len(), faults.join("\n"));
}

#[test]
fn what_is_each_formats_own_is_in_its_seeds() {
    for form in &FORMS {
        let format = Format::by_id(form.id).unwrap();
        let texts: Vec<String> =
            seeds(format).into_iter().map(|(_, bytes)| String::from_utf8(bytes).unwrap()).collect();
        for what in form.replaced() {
            assert!(
                texts.iter().any(|text| text.contains(what)),
                "{}: no seed has {what:?}",
                form.id
            );
        }
    }
}
