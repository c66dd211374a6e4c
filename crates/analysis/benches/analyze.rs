//! The report of an export: `cargo bench -p mimique-analysis --bench analyze -- EXPORT.csv STUDY.json`.
//!
//! From the file to all files of the report, in memory; prints seconds and peak memory as JSON.
#![allow(clippy::print_stdout, missing_docs)]

use std::time::Instant;

use mimique_analysis::analyze;
use mimique_locale::Language;
use mimique_stats::Table;
use mimique_study::Study;

fn main() {
    let arguments: Vec<String> = std::env::args().filter(|word| !word.starts_with("--")).collect();
    let [_, export, study] = arguments.as_slice() else {
        println!("give EXPORT.csv STUDY.json behind --");
        return;
    };
    let study = Study::from_text(&std::fs::read_to_string(study).expect("the study's file"))
        .expect("a study");
    let start = Instant::now();
    let bytes = std::fs::read(export).expect("the export");
    let size = bytes.len();
    let table = Table::parse(bytes).expect("a table");
    let read = start.elapsed().as_secs_f64();
    let report = analyze(&table, &study, Language::English).expect("a report");
    println!(
        "{{\"people\": {}, \"trials\": {}, \"bytes\": {size}, \"read\": {read:.3}, \"seconds\": {:.3}, \"memory\": {}}}",
        report.people.1,
        report.trials,
        start.elapsed().as_secs_f64(),
        peak_bytes()
    );
}

/// Peak resident memory of this process.
fn peak_bytes() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find(|line| line.starts_with("VmHWM"));
    let kib = line.and_then(|line| line.split_whitespace().nth(1)?.parse::<u64>().ok());
    kib.unwrap_or(0) * 1024
}
