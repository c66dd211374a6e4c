//! A study with sound: simulated people hear it, and the rules about sound leave out trials and people.

use mimique_analysis::{Parameters, Simulation, analyze};
use mimique_locale::Language;
use mimique_stats::Table;
use mimique_study::{Study, config_hash, parse};
use mimique_test_support::study_text;
use serde_json::Value;

use crate::support::simulated::simulated_export;

/// The flow of the report.
fn flow(csv: &str, study: &Study) -> Value {
    let table = Table::parse(csv.as_bytes()).unwrap();
    let report = analyze(&table, study, Language::English).unwrap();
    let file = report.files.iter().find(|file| file.path == "results.json").unwrap();
    serde_json::from_str::<Value>(&file.text).unwrap()["flow"].clone()
}

/// The export with a cell of some rows written anew.
fn with(csv: &str, column: &str, cell: &str, rows: impl Fn(&str) -> bool) -> String {
    let names: Vec<&str> = csv.lines().next().unwrap().split(',').collect();
    let place = names.iter().position(|name| *name == column).unwrap();
    let written = |line: &str| {
        if !rows(line) {
            return format!("{line}\n");
        }
        let mut cells: Vec<&str> = line.split(',').collect();
        cells[place] = cell;
        format!("{}\n", cells.join(","))
    };
    csv.lines().map(written).collect()
}

#[test]
fn trials_off_their_time_and_people_who_do_not_hear_are_left_out() {
    let value = parse(&study_text("sound.json")).unwrap();
    let study = Study::from_value(&value).unwrap();
    let parameters = Parameters::for_study(&study);
    let hash = config_hash(&value);
    let simulation = Simulation::new(&study, &hash, &parameters, 5).unwrap();
    let csv = simulated_export(&simulation, &study, 12);
    let whole = flow(&csv, &study);
    assert_eq!(whole["people_left_out"].get("sound not heard"), None, "{whole}");
    assert_eq!(
        whole["trials_left_out"].get("sound off its time"),
        None,
        "late by what was asked for"
    );
    let used = whole["trials_used"].as_u64().unwrap();
    // The first person who is used.
    let first = csv.lines().find(|line| line.contains("\"completed\"")).unwrap();
    let person = first.split(',').next().unwrap();
    let of = |line: &str, clip: &str| line.starts_with(person) && line.contains(clip);
    let late = with(&csv, "sound_offset_ms", "41", |line| of(line, "\"joy2.real.congruent\""));
    let mute = with(&late, "sound_status", "\"suspended\"", |line| of(line, "\"joy2.real.late\""));
    let near = with(&mute, "sound_offset_ms", "239", |line| of(line, "\"sadness2.real.late\""));
    let told = flow(&near, &study);
    assert_eq!(told["trials_left_out"]["sound off its time"], 2, "{told}");
    assert_eq!(told["trials_used"], used - 2);
    let deaf = csv.lines().map(|line| match line.starts_with(person) {
        true => format!("{}\n", line.replace("\"heard\"", "\"not_heard\"")),
        false => format!("{line}\n"),
    });
    let told = flow(&deaf.collect::<String>(), &study);
    assert_eq!(told["people_left_out"]["sound not heard"], 1, "{told}");
}
