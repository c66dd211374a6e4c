//! Hypotheses of equivalence from the study file to the report: verdicts on planted differences, the sentence, the
//! table and the figure, power at a true difference of 0, and the preregistration.

use mimique_analysis::{
    Parameters, PowerOptions, Preregistration, Report, analyze, power, preregistration,
};
use mimique_locale::Language;
use mimique_stats::{EquivalenceOptions, Numbers, Table, equivalence_of_pairs};
use mimique_study::Study;
use serde_json::Value;

use crate::support::equivalence::equivalence;
use crate::support::{Raters, demo_study, export, study_in_conditions};

const METHODS: [&str; 2] = ["lsts30", "box"];

/// The demonstration with one hypothesis of equivalence.
fn study(smallest: f64) -> Study {
    let mut study = demo_study();
    study.hypotheses = vec![equivalence("E1", "believability", "method", METHODS, smallest)];
    study
}

fn report(study: &Study, people: usize, effect: f64, language: Language) -> Report {
    let csv = export(study, &Raters { people, effect, seed: 9 });
    analyze(&Table::parse(csv.as_bytes()).unwrap(), study, language).unwrap()
}

fn file<'r>(report: &'r Report, path: &str) -> &'r str {
    &report.files.iter().find(|file| file.path == path).unwrap().text
}

fn hypothesis(report: &Report) -> Value {
    let results: Value = serde_json::from_str(file(report, "results.json")).unwrap();
    results["hypotheses"][0].clone()
}

#[test]
fn verdicts_follow_the_difference_that_was_planted() {
    for (people, effect, smallest, verdict, words) in [
        (60, 0.0, 0.5, "equivalent", "are equivalent: they differ by less than 0.5 points"),
        (60, 1.5, 0.5, "different", "differ, and that by less than 0.5 points"),
        (60, 1.0, 2.0, "different-but-small", "differ, but by less than 2 points"),
        (5, 0.0, 0.1, "undecided", "undecided: neither"),
    ] {
        let found = hypothesis(&report(&study(smallest), people, effect, Language::English));
        assert_eq!(found["equivalence"]["by_ranks"]["verdict"], verdict, "{found}");
        assert_eq!(found["equivalence"]["by_t"]["verdict"], verdict, "{found}");
        let reading = found["reading"].as_str().unwrap();
        assert!(reading.contains(words), "{reading}");
        assert!(reading.contains("Beside it two one-sided paired t tests"), "{reading}");
        // What decides goes into the correction over all hypotheses.
        assert_eq!(found["p"], found["equivalence"]["by_ranks"]["line"]["p_value"]);
    }
}

#[test]
fn for_other_clips_the_linear_mixed_model_decides() {
    for (effect, smallest, verdict, words) in [
        (0.0, 0.8, "equivalent", "are equivalent: they differ by less than 0.8 points"),
        (1.5, 0.5, "different", "differ, and that by less than 0.5 points"),
    ] {
        let mut study = study(smallest);
        study.hypotheses[0].generalise = None;
        let report = report(&study, 60, effect, Language::English);
        let found = hypothesis(&report);
        let own = &found["equivalence"]["for_other_clips"];
        assert_eq!(own["verdict"], verdict, "{found}");
        assert_eq!(found["scope"], "other_clips");
        assert_eq!(found["p"], own["p"]);
        // Of two levels F is t squared.
        let difference = own["p_difference"].as_f64().unwrap();
        let of_model = found["other_clips"]["linear_model"]["p"].as_f64().unwrap();
        assert!((difference - of_model).abs() < 1e-9, "{difference} {of_model}");
        assert!(own["se"].as_f64() > Some(0.0));
        let reading = found["reading"].as_str().unwrap();
        assert!(reading.starts_with("For other clips, on “"), "{reading}");
        assert!(reading.contains(words) && reading.contains("Of these clips alone:"), "{reading}");
        let table = file(&report, "tables/hypothesis-e1-equivalence.csv");
        assert!(table.contains("two one-sided t tests of the linear mixed model, for other clips"));
        let zone = file(&report, "figures/hypothesis-e1-zone.svg");
        assert!(zone.contains("linear mixed model, other clips"), "{zone}");
        let paper = file(&report, "report.html");
        assert!(paper.contains("two one-sided t tests of the difference in a linear mixed model"));
        assert!(!paper.contains("has shown no effect of"), "F is not the test of equivalence");
    }
}

#[test]
fn it_is_the_test_of_person_means_and_stands_in_table_and_figure() {
    let study = study(0.5);
    let csv = export(&study, &Raters { people: 20, effect: 0.2, seed: 9 });
    let table = Table::parse(csv.as_bytes()).unwrap();
    let report = analyze(&table, &study, Language::French).unwrap();
    let found = hypothesis(&report);
    // The means of each person once more, from the export alone.
    let column = |name: &str| table.names().iter().position(|own| own == name);
    let names = [
        "participant",
        "method",
        "response_id",
        "answer",
        "frames_late",
        "frames",
        "expression",
        "status",
    ];
    let [person, method, response, answer, late, frames, expression, status] =
        names.map(|name| column(name).unwrap());
    // Ratings of one person and segment by both methods.
    let mut pairs = std::collections::BTreeMap::new();
    for row in 0..table.rows() {
        let cell = |at: usize| table.cell(row, at).unwrap_or_default();
        let number = |at: usize| cell(at).parse::<f64>().unwrap();
        // The study leaves trials with many late frames out.
        let is_used = cell(response) == "believability" && cell(status) == "completed";
        if !is_used || number(late) > 0.2 * number(frames) {
            continue;
        }
        let key = (cell(person).to_owned(), cell(expression).to_owned());
        let own: &mut [Option<f64>; 2] = pairs.entry(key).or_default();
        own[usize::from(cell(method) == "box")] = Some(number(answer));
    }
    // A segment that the rule takes away at one method is compared at neither.
    let mut sums = std::collections::BTreeMap::new();
    for ((person, _), own) in pairs {
        if let [Some(lsts), Some(boxed)] = own {
            let sum: &mut [f64; 2] = sums.entry(person).or_default();
            sum[0] += lsts - boxed;
            sum[1] += 1.0;
        }
    }
    let used = found["equivalence"]["people"][0].as_u64().unwrap() as usize;
    let differences: Vec<f64> = sums.values().map(|[sum, n]| sum / n).collect();
    assert_eq!(differences.len(), used);
    let numbers = Numbers { name: "d".to_owned(), values: differences };
    let own = equivalence_of_pairs(&numbers, &EquivalenceOptions::smallest_effect(0.5));
    let own = own.unwrap().wilcoxon.ok().unwrap();
    let p = found["p"].as_f64().unwrap();
    assert!((own.p - p).abs() < 1e-12, "{} {p}", own.p);
    let zone = file(&report, "tables/figure-hypothesis-e1-zone.csv");
    assert_eq!(zone.lines().count(), 3, "{zone}");
    assert!(zone.contains("zone bas") && zone.contains("différence de Hodges-Lehmann"), "{zone}");
    assert!(file(&report, "figures/hypothesis-e1-zone.svg").contains("La zone va de −0,5 à 0,5"));
    let table = file(&report, "tables/hypothesis-e1-equivalence.csv");
    assert!(table.contains("deux tests unilatéraux des rangs signés"), "{table}");
}

#[test]
fn groups_of_people_are_compared_by_rank_sums() {
    let mut study = study_in_conditions();
    let groups = ["rested", "at-once"];
    let factor = "assigned_condition";
    study.hypotheses = vec![equivalence("E1", "believability", factor, groups, 0.5)];
    let found = hypothesis(&report(&study, 61, 0.0, Language::English));
    let people = &found["equivalence"]["people"];
    assert_eq!((people[0].as_u64(), people[1].as_u64()), (Some(20), Some(20)), "{found}");
    assert_eq!(found["equivalence"]["within_people"], false);
    assert!(found["equivalence"]["by_t"]["interval_90"].is_array());
    assert!(found["reading"].as_str().unwrap().contains("Welch"), "{found}");
}

/// A hypothesis of equivalence has two p. Both are corrected over the hypotheses of the study, and the decision, the table
/// and the paragraph for a paper have the one that supports the decision.
#[test]
fn the_p_next_to_a_decision_is_the_p_of_that_decision() {
    let mut study = study(0.1);
    let asked = study.hypotheses[0].clone();
    study.hypotheses = (1..=4)
        .map(|number| mimique_study::Hypothesis { id: format!("E{number}"), ..asked.clone() })
        .collect();
    let (mut taken_back, mut kept) = (0, 0);
    for seed in 1..40 {
        let csv = export(&study, &Raters { people: 16, effect: 0.35, seed });
        let table = Table::parse(csv.as_bytes()).unwrap();
        let report = analyze(&table, &study, Language::English).unwrap();
        let found = hypothesis(&report);
        let p = found["equivalence"]["by_ranks"]["p_difference"].as_f64().unwrap();
        let corrected = found["p_difference_holm_over_hypotheses"].as_f64().unwrap();
        assert!((corrected - (4.0 * p).min(1.0)).abs() < 1e-12, "{p} {corrected}");
        let row = file(&report, "tables/hypotheses.csv").lines().nth(1).unwrap();
        if corrected < 0.05 {
            assert!(row.contains("different") && row.contains("(difference)"), "{row}");
            assert!(!row.contains("(equivalence)"), "{row}");
            let printed = Language::English.p_rounded(corrected);
            assert!(row.contains(&format!("{printed} (difference)")), "{printed} {row}");
            let paper = file(&report, "report.md").split("### Results").nth(1).unwrap();
            assert!(paper.contains("(difference)"), "{paper}");
        } else {
            assert!(row.contains("undecided"), "{corrected} {row}");
        }
        taken_back += usize::from(p < 0.05 && corrected >= 0.05);
        kept += usize::from(corrected < 0.05);
    }
    assert!(taken_back > 0 && kept > 0, "{taken_back} {kept}");
}

#[test]
fn four_people_cannot_show_equivalence_and_that_is_said() {
    // The last person does not finish.
    for (people, is_said) in [(5, true), (6, false)] {
        let found = hypothesis(&report(&study(6.0), people, 0.0, Language::English));
        assert_eq!(found["equivalence"]["people"][0], people - 1);
        let reading = found["reading"].as_str().unwrap();
        assert_eq!(reading.contains("p could not fall below 0.0625"), is_said, "{reading}");
    }
}

#[test]
fn without_a_smallest_effect_nothing_is_tested() {
    let mut study = study(0.5);
    study.hypotheses[0].smallest_effect = None;
    let found = hypothesis(&report(&study, 8, 0.0, Language::English));
    assert_eq!(found["p"], Value::Null);
    assert!(found["reading"].as_str().unwrap().contains("smallestEffect"), "{found}");
}

#[test]
fn power_is_that_at_no_difference_and_is_preregistered() {
    let mut study = study(1.0);
    let mut parameters = Parameters::for_study(&study);
    let options = |smallest_people: usize| PowerOptions {
        participants: vec![smallest_people],
        clips: Vec::new(),
        runs: 40,
        seed: 1,
        alpha: 0.05,
        false_positives: false,
        mixed: false,
    };
    // However far apart the methods are in the parameters, the power is at no difference.
    let found = power(&study, "hash", &parameters, &options(30), &|| {}).unwrap();
    let first = &found.points[0].hypotheses[0];
    assert!(first.effect && first.false_positives.is_none());
    assert!(first.power.deciding.share > 0.8, "{:?}", first.power.deciding);
    parameters.ratings.get_mut("believability").unwrap().effects.clear();
    let without = power(&study, "hash", &parameters, &options(30), &|| {}).unwrap();
    assert_eq!(without.points[0].hypotheses[0].power, first.power);
    // A zone that is hardly wider than chance needs more people.
    study.hypotheses[0].smallest_effect = Some(0.05);
    let narrow = power(&study, "hash", &parameters, &options(8), &|| {}).unwrap();
    assert!(narrow.points[0].hypotheses[0].power.deciding.share < 0.2);
    for (language, words) in [
        (
            Language::English,
            [
                "smallest difference that matters: 0.05, because: nobody sees it",
                "decides: two one-sided signed rank tests on one mean a person",
                "within the zone",
            ],
        ),
        (
            Language::French,
            [
                "plus petite différence qui compte : 0,05, car : personne ne le voit",
                "décide : deux tests unilatéraux des rangs signés sur une moyenne par personne",
                "dans la zone",
            ],
        ),
    ] {
        let text = preregistration(&Preregistration {
            study: &study,
            config_hash: "hash",
            power: &narrow,
            parameters: &parameters,
            language,
            curve: None,
        });
        for words in words {
            assert!(text.contains(words), "{words}: {text}");
        }
    }
}
