//! Blocks of pairs, from people with worths to report, power and preregistration.

use mimique_analysis::{Parameters, PowerOptions, Report, Simulation, analyze, power};
use mimique_locale::Language;
use mimique_stats::Table;
use mimique_study::Study;
use serde_json::Value;

use crate::support::preregistered::preregistered;
use crate::support::simulated::simulated_export;

const WORTHS: [(&str, f64); 4] = [("box", -0.6), ("ridge", -0.2), ("lsts", 0.2), ("recorded", 0.6)];

fn study() -> Study {
    let file = mimique_study::parse(include_str!("../../../../study-config/pairs.json")).unwrap();
    Study::from_value(&file).unwrap()
}

fn planted(study: &Study, scale: f64) -> Parameters {
    let mut parameters = Parameters::for_study(study);
    let own = parameters.comparisons.get_mut("better").unwrap();
    own.worth = WORTHS.iter().map(|(level, worth)| ((*level).to_owned(), scale * worth)).collect();
    (own.side, own.lapse) = (-0.3, 0.0);
    parameters
}

fn export(study: &Study, people: u64) -> String {
    let parameters = planted(study, 1.0);
    let simulation = Simulation::new(study, "hash", &parameters, 5).unwrap();
    simulated_export(&simulation, study, people)
}

fn report(study: &Study, csv: &str, language: Language) -> Report {
    analyze(&Table::parse(csv.as_bytes()).unwrap(), study, language).unwrap()
}

fn file<'r>(report: &'r Report, path: &str) -> &'r str {
    let found = report.files.iter().find(|file| file.path == path);
    &found.unwrap_or_else(|| panic!("no {path}")).text
}

fn column(table: &Table, name: &str) -> Vec<String> {
    table.column(name).unwrap().map(|cell| cell.unwrap_or_default().to_owned()).collect()
}

#[test]
fn worths_and_side_planted_in_a_share_of_the_pairs_are_found_again() {
    let study = study();
    let report = report(&study, &export(&study, 90), Language::English);
    let results: Value = serde_json::from_str(file(&report, "results.json")).unwrap();
    let choices = results["choices"].as_array().unwrap();
    let tests = &choices.iter().find(|own| own["by"] == "method").unwrap()["tests"];
    let worths = &tests["worths"];
    let items = worths["items"].as_array().unwrap();
    for (level, planted) in WORTHS {
        let place = items.iter().position(|item| item == level).unwrap();
        let [found, se] = ["worth", "se_cluster"].map(|key| worths[key][place].as_f64().unwrap());
        // The taste of people (0.5) and clips (0.2) draws estimates towards 0 a little.
        assert!(se < 0.15 && (found - planted).abs() < 3.0 * se + 0.08, "{level}: {found} ± {se}");
    }
    let side = worths["side"]["estimate"].as_f64().unwrap();
    assert!((side + 0.3).abs() < 0.25, "{side}");
    assert!(tests["consistency"].is_null() || tests["triads"].is_null(), "no complete tournaments");
}

#[test]
fn items_in_the_export_are_the_levels_of_its_clips() {
    let study = study();
    let table = Table::parse(export(&study, 6).as_bytes()).unwrap();
    let names = ["stimulus", "beside", "item_left", "item_right", "cell", "answer", "item_chosen"];
    let columns = names.map(|name| column(&table, name));
    let mut rows = 0;
    for (place, response) in column(&table, "response_id").into_iter().enumerate() {
        if response != "better" {
            continue;
        }
        let [left_clip, right_clip, left, right, cell, answer, chosen] =
            columns.each_ref().map(|column| column[place].as_str());
        let segment = cell.split('|').next().unwrap();
        assert_eq!([left_clip, right_clip], [left, right].map(|own| format!("{segment}.{own}")));
        let expected = match answer {
            "left" => left,
            "right" => right,
            _ => "",
        };
        assert_eq!(chosen, expected);
        rows += 1;
    }
    assert_eq!(rows, 6 * 12);
}

#[test]
fn reasons_are_counted_by_what_was_chosen() {
    let study = study();
    let csv = export(&study, 20);
    let report = report(&study, &csv, Language::French);
    let table = file(&report, "tables/better-reasons-duels.csv");
    let lines: Vec<&str> = table.lines().collect();
    assert!(lines[0].contains("Sourcils") && lines[0].starts_with("choisi,"), "{}", lines[0]);
    // Four levels and no difference.
    assert_eq!(lines.len(), 6, "{table}");
    let answered: u64 = lines[1..]
        .iter()
        .map(|line| line.rsplit(',').next().unwrap().parse::<u64>().unwrap())
        .sum();
    let data = Table::parse(csv.as_bytes()).unwrap();
    let rows = column(&data, "response_id").into_iter().zip(column(&data, "answer"));
    let given = rows.filter(|(response, answer)| response == "why" && !answer.is_empty()).count();
    assert_eq!(answered, given as u64);
}

#[test]
fn power_is_that_of_the_dealt_pairs_and_the_preregistration_says_how_they_are_dealt() {
    let study = study();
    let parameters = planted(&study, 1.0);
    let options = PowerOptions {
        participants: vec![24],
        clips: vec![24],
        runs: 40,
        seed: 5,
        alpha: 0.05,
        false_positives: true,
        mixed: false,
    };
    let found = power(&study, "hash", &parameters, &options, &|| {}).unwrap();
    let own = &found.points[0].hypotheses[0];
    assert!(own.effect && own.power.deciding.share > 0.8, "{:?}", own.power);
    let none = own.false_positives.unwrap();
    assert!(none.deciding.share <= 0.15, "{none:?}");
    for (language, words) in [
        (Language::English, "Each participant is shown 12 of them"),
        (Language::French, "Chaque participant en voit 12"),
    ] {
        let text = preregistered(&study, &parameters, &found, language);
        assert!(text.contains(words) && text.contains("36 pai"), "{text}");
    }
}
