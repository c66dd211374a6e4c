//! The assigned condition as a factor of hypotheses and tables: one value a person, independent groups,
//! said who is in which; and its power.

use std::collections::BTreeMap;

use mimique_analysis::{
    Parameters, PowerOptions, Preregistration, Report, Simulation, analyze, power, preregistration,
};
use mimique_locale::Language;
use mimique_stats::{Numbers, Table, mann_whitney};
use mimique_study::{Generalise, Study, config_hash};
use serde_json::{Value, json};

use crate::support::simulated::simulated_export;
use crate::support::{
    Raters, condition_of, demo_study, export, parameter_study, study_in_conditions,
};

fn report(study: &Study, csv: &str) -> Report {
    analyze(&Table::parse(csv.as_bytes()).unwrap(), study, Language::English).unwrap()
}

fn file<'r>(report: &'r Report, path: &str) -> &'r str {
    let file = report.files.iter().find(|file| file.path == path);
    &file.unwrap_or_else(|| panic!("no {path}")).text
}

fn hypothesis(report: &Report, id: &str) -> Value {
    let results: Value = serde_json::from_str(file(report, "results.json")).unwrap();
    let all = results["hypotheses"].as_array().unwrap();
    all.iter().find(|each| each["id"] == id).unwrap().clone()
}

/// The export with some people's rows only.
fn rows_of(csv: &str, keep: impl Fn(usize) -> bool) -> String {
    let person = |line: &str| line[1..5].parse::<usize>().unwrap() - 1;
    let lines = csv.lines().enumerate();
    let kept = lines.filter(|(number, line)| *number == 0 || keep(person(line)));
    kept.map(|(_, line)| format!("{line}\n")).collect()
}

/// The mean rating of each person who completed, by hand.
fn means_by_hand(csv: &str) -> Vec<f64> {
    let mut lines = csv.lines();
    let names: Vec<&str> = lines.next().unwrap().split(',').collect();
    let column = |name: &str| names.iter().position(|each| *each == name).unwrap();
    let [who, question, answer, frames, late] =
        ["participant_id", "response_id", "answer", "frames", "frames_late"].map(column);
    let mut sums: BTreeMap<String, (f64, f64)> = BTreeMap::new();
    for line in lines {
        let cells: Vec<&str> = line.split(',').collect();
        let number = |place: usize| cells[place].parse::<f64>().unwrap();
        let smooth = number(late) / number(frames) <= 0.2;
        if cells[question] == "believability" && smooth {
            let sum = sums.entry(cells[who].to_owned()).or_default();
            (sum.0, sum.1) = (sum.0 + number(answer), sum.1 + 1.0);
        }
    }
    sums.values().map(|(sum, count)| sum / count).collect()
}

#[test]
fn everybody_counts_once_and_the_groups_are_told() {
    let mut study = study_in_conditions();
    study.exclusions.as_mut().unwrap().late_frame_share = Some(0.2);
    // The last of 17 does not finish, and is left out: 6, 5 and 5 people.
    let csv = export(&study, &Raters { people: 17, effect: 0.4, seed: 15 });
    let report = report(&study, &csv);
    let means = means_by_hand(&rows_of(&csv, |person| person < 16));
    let all = hypothesis(&report, "C1");
    let groups = all["people_by_condition"].as_object().unwrap();
    assert_eq!(groups.keys().collect::<Vec<_>>(), ["10", "at-once", "rested"]);
    for (name, group) in groups {
        let of = |person: &usize| condition_of(&study, *person) == name;
        let own: Vec<f64> = (0..16).filter(of).map(|person| means[person]).collect();
        assert_eq!(group["people"].as_u64().unwrap() as usize, own.len());
        let mean = own.iter().sum::<f64>() / own.len() as f64;
        assert!((group["mean"].as_f64().unwrap() - mean).abs() < 1e-12, "{name}");
    }
    let line = &all["recommended"]["overall"][0];
    assert_eq!((&line["test"], &line["n"]), (&json!("Kruskal-Wallis of person means"), &json!(16)));
    assert_eq!(all["as_in_the_thesis"]["tests"][0]["test"], "Kruskal-Wallis of trials");
    // Two levels named: their order is that of the signs, the third condition takes no part.
    let two = hypothesis(&report, "C2");
    let line = &two["recommended"]["overall"][0];
    let wanted: Vec<usize> = (0..16).filter(|person| person % 3 < 2).collect();
    let values = Numbers {
        name: "y".to_owned(),
        values: wanted.iter().map(|person| means[*person]).collect(),
    };
    let labels = wanted.iter().map(|person| Some(condition_of(&study, *person)));
    let factor = mimique_stats::Factor::from_cells("g", labels, |_| None);
    let factor = factor.restricted(&["rested".to_owned(), "at-once".to_owned()]).unwrap();
    let own = mann_whitney(&values, &factor).unwrap().ok().unwrap();
    assert_eq!(line["term"], "rested | at-once");
    assert_eq!(line["statistic"].as_f64().unwrap(), own.statistic);
    assert!((line["p_value"].as_f64().unwrap() - own.p_value).abs() < 1e-14);
    assert_eq!((&line["n"], &two["recommended"]["people"]), (&json!(11), &json!(11)));
    assert_eq!(two["people_by_condition"].as_object().unwrap().len(), 2);
    let reading = two["reading"].as_str().unwrap();
    assert!(reading.contains("Mean of the people in each condition: rested "), "{reading}");
    assert!(reading.contains("(6 people), at-once "), "{reading}");
    // Shares of right answers; response times; the interaction with a factor within people.
    let test = |id: &str, place: usize| -> String {
        let line = hypothesis(&report, id)["recommended"]["overall"][place].clone();
        line["test"].as_str().unwrap().to_owned()
    };
    assert_eq!(test("C3", 0), "Kruskal-Wallis of person means");
    assert_eq!(test("C4", 0), "Mann-Whitney of person means");
    assert_eq!(test("C5", 0), "Kruskal-Wallis of person means");
    assert!(test("C5", 2).starts_with("Kruskal-Wallis of person differences"), "{}", test("C5", 2));
}

#[test]
fn tables_and_figures_show_the_conditions_in_the_order_of_the_study() {
    let study = study_in_conditions();
    let csv = export(&study, &Raters { people: 17, effect: 0.4, seed: 15 });
    let report = report(&study, &csv);
    let means = file(&report, "tables/table-means.csv");
    assert!(means.lines().next().unwrap().ends_with("rested,at-once,10"), "{means}");
    assert!(means.lines().nth(1).unwrap().ends_with(",6,5,5"), "{means}");
    // A condition called 10 is no number to correlate with.
    assert!(file(&report, "tables/table-influences.csv").contains("H "));
    for path in ["tables/table-interactions.csv", "tables/table-confusion.csv"] {
        assert!(file(&report, path).lines().count() > 2, "{path}");
    }
    let about = file(&report, "tables/about-people.csv");
    assert!(about.contains("assigned condition,16,"), "{about}");
    let figure = file(&report, "figures/hypothesis-c1-people.svg");
    assert_eq!(figure.matches("class=\"dot\"").count(), 16);
    assert_eq!(figure.matches("class=\"mark\"").count(), 3);
    let data = file(&report, "tables/figure-hypothesis-c1-people.csv");
    assert_eq!(data.lines().count(), 17);
}

#[test]
fn a_condition_with_nobody_and_groups_too_small_are_said() {
    let study = study_in_conditions();
    let csv = export(&study, &Raters { people: 30, effect: 0.0, seed: 3 });
    let reading = |keep: &dyn Fn(usize) -> bool, id: &str| {
        let report = report(&study, &rows_of(&csv, keep));
        let found = hypothesis(&report, id);
        (found["reading"].as_str().unwrap().to_owned(), found)
    };
    // Nobody in the third condition: two are left, and compared.
    let (words, found) = reading(&|person| person % 3 < 2, "C1");
    assert!(words.contains("Nobody in the analysis is in the condition 10"), "{words}");
    assert_eq!(found["recommended"]["overall"][0]["test"], "Mann-Whitney of person means");
    assert!(found["p"].is_number());
    // One condition: nothing to compare.
    let (words, found) = reading(&|person| person % 3 == 0, "C1");
    assert!(words.contains("fewer than two levels"), "{words}");
    assert!(words.contains("in the condition at-once"), "{words}");
    assert!(found["p"].is_null());
    // Neither of the two that are named: no other takes their place.
    let (words, found) = reading(&|person| person % 3 == 2, "C2");
    assert!(words.contains("Not tested") && found["p"].is_null(), "{words}");
    // Three against three: 2 of 20 ways.
    let (words, _) = reading(&|person| person < 9, "C2");
    assert!(words.contains("3 and 3 people are too few"), "{words}");
    assert!(words.contains("below 0.100"), "{words}");
    // Nine against four.
    let (words, _) = reading(&|person| person % 3 == 0 || person < 12, "C2");
    assert!(words.contains("at least twice as many people"), "{words}");
}

/// A study of a simulation, with its parameters: two conditions, one rating, no spread but the people's.
fn simulated(shift: f64) -> (Study, String, Parameters) {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../study-config/power/independence.json");
    let mut file = mimique_study::parse(&std::fs::read_to_string(path).unwrap()).unwrap();
    let condition = |id: &str| {
        json!({ "id": id, "conditional": true, "order": "random",
            "components": file["sequence"]["components"] })
    };
    file["sequence"] =
        json!({ "order": "fixed", "components": [condition("rested"), condition("at-once")] });
    file["hypotheses"] = json!([{ "id": "H", "statement": "s", "test": "mann-whitney",
        "response": "rating", "factors": ["assigned_condition"] }]);
    let study = Study::from_value(&file).unwrap();
    let path = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../study-config/power/independence.parameters.json"
    );
    let text = std::fs::read_to_string(path).unwrap();
    let mut base = Parameters::for_study(&study);
    base.ratings.get_mut("rating").unwrap().effects.clear();
    let mut parameters = Parameters::read_over(&base, &text, &study).unwrap();
    let rating = parameters.ratings.get_mut("rating").unwrap();
    rating.effects = [(
        "assigned_condition".to_owned(),
        [("rested".to_owned(), shift / 2.0), ("at-once".to_owned(), -shift / 2.0)].into(),
    )]
    .into();
    parameters.check(&study).unwrap();
    (study, config_hash(&file), parameters)
}

fn options(participants: usize, runs: usize) -> PowerOptions {
    PowerOptions {
        participants: vec![participants],
        clips: Vec::new(),
        runs,
        seed: 20_261_122,
        alpha: 0.05,
        false_positives: true,
        mixed: false,
    }
}

/// Planted in the sessions, read from the export as the server writes it.
#[test]
fn a_difference_between_conditions_is_found_again_in_a_simulated_export() {
    let (study, hash, parameters) = simulated(1.2);
    let simulation = Simulation::new(&study, &hash, &parameters, 5).unwrap();
    let csv = simulated_export(&simulation, &study, 30);
    let report = report(&study, &csv);
    let found = hypothesis(&report, "H");
    let groups = &found["people_by_condition"];
    assert_eq!([&groups["rested"]["people"], &groups["at-once"]["people"]], [15, 15]);
    let mean = |name: &str| groups[name]["mean"].as_f64().unwrap();
    // People spread by 0.6: the difference of two means of 15 has a standard error of 0.22.
    let difference = mean("rested") - mean("at-once");
    assert!((0.7..=1.7).contains(&difference), "{difference}");
    assert!(found["p"].as_f64().unwrap() < 0.01, "{}", found["p"]);
    let reading = found["reading"].as_str().unwrap();
    assert!(
        reading.contains("the levels of assigned condition (at-once | rested) differ: U = "),
        "{reading}"
    );
    // Parameters fitted to it have the difference again.
    let fitted = Parameters::fit(&Table::parse(csv.as_bytes()).unwrap(), &study).unwrap();
    let effects = &fitted.ratings["rating"].effects["assigned_condition"];
    let difference = effects["rested"] - effects["at-once"];
    assert!((0.7..=1.7).contains(&difference), "{effects:?}");
}

/// A normal shift of d people's spreads: the power of Mann-Whitney is near that of the t test of 3/pi as
/// many people. Without an effect 5 % are positive, of single trials many more.
#[test]
fn power_grows_with_the_difference_and_is_alpha_without() {
    let (study, hash, parameters) = simulated(0.9);
    let result = power(&study, &hash, &parameters, &options(24, 1500), &|| {}).unwrap();
    let point = &result.points[0];
    assert_eq!(point.people_used, 24.0);
    let found = &point.hypotheses[0];
    let none = found.false_positives.unwrap();
    assert!((0.035..=0.06).contains(&none.deciding.share), "{}", none.deciding.share);
    assert!(none.as_in_the_thesis.share > 0.3, "{}", none.as_in_the_thesis.share);
    assert_eq!(none.deciding.undefined, 0);
    // Spread of a person's mean over 54 trials: sqrt(0.6^2 + 1/54) = 0.615, and what rounding adds.
    let share = found.power.deciding.share;
    assert!((0.85..=0.97).contains(&share), "{share}");
}

/// A response time that is a fifth longer and one that is a fifth shorter, of people who differ by a tenth.
#[test]
fn a_difference_of_response_times_is_planted_too() {
    let (mut study, hash, mut parameters) = simulated(0.0);
    study.hypotheses[0].measure = mimique_study::Measure::Rt;
    parameters.times.person_sigma = 0.1;
    let shifts = [("rested".to_owned(), 0.2), ("at-once".to_owned(), -0.2)];
    parameters.times.effects = [("assigned_condition".to_owned(), shifts.into())].into();
    let result = power(&study, &hash, &parameters, &options(16, 40), &|| {}).unwrap();
    let found = &result.points[0].hypotheses[0];
    assert_eq!(found.power.deciding.positive, 40);
    assert!(found.false_positives.unwrap().deciding.positive < 10);
    // The default parameters of a study plant the difference that its hypothesis looks for.
    let own = Parameters::for_study(&study);
    let effects = &own.times.effects["assigned_condition"];
    assert!((effects["rested"] - effects["at-once"] - 0.1).abs() < 1e-9, "{effects:?}");
}

#[test]
fn the_preregistration_says_the_test_and_that_it_is_between_participants() {
    let (mut study, hash, parameters) = simulated(0.9);
    study.hypotheses.iter_mut().for_each(|own| own.generalise = Some(Generalise::TheseClips));
    let result = power(&study, &hash, &parameters, &options(8, 5), &|| {}).unwrap();
    let from = Preregistration {
        study: &study,
        config_hash: &hash,
        parameters: &parameters,
        power: &result,
        language: Language::English,
        curve: None,
    };
    let text = preregistration(&from);
    assert!(text.contains("decides: Mann-Whitney test on one mean a person."), "{text}");
    assert!(
        text.contains("2 levels (tested, between participants), column `assigned_condition`"),
        "{text}"
    );
}

/// What was not assigned is not invented: studies without conditions stay as they were.
#[test]
fn a_study_without_conditions_has_no_such_factor() {
    for study in [demo_study(), parameter_study()] {
        let csv = export(&study, &Raters { people: 8, effect: 0.4, seed: 2 });
        let text = report(&study, &csv);
        for file in &text.files {
            assert!(!file.text.contains("assigned_condition"), "{}", file.path);
            assert!(!file.text.contains("people_by_condition"), "{}", file.path);
        }
    }
}
