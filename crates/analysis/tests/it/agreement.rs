//! Agreement about clips and the consistency of scales in the report: on planted answers, with gaps, of pages and of
//! trials, in both languages.

use mimique_analysis::analyze;
use mimique_locale::Language;
use mimique_stats::Table;
use mimique_study::{CompositeScale, Study};
use mimique_test_support::Random;
use serde_json::{Value, json};

use crate::support::{Raters, demo_study, export};

fn results(csv: &str, study: &Study, language: Language) -> (Value, String) {
    let report = analyze(&Table::parse(csv.as_bytes()).unwrap(), study, language).unwrap();
    let file = |path: &str| report.files.iter().find(|file| file.path == path).unwrap();
    (serde_json::from_str(&file("results.json").text).unwrap(), file("report.md").text.clone())
}

fn of<'r>(results: &'r Value, response: &str) -> &'r Value {
    let all = results["agreement"].as_array().unwrap();
    all.iter().find(|own| own["response"] == response).unwrap()
}

#[test]
fn people_agree_about_what_differs_between_clips() {
    let study = demo_study();
    let csv = export(&study, &Raters { people: 25, effect: 0.0, seed: 9 });
    let (found, text) = results(&csv, &study, Language::English);
    let single = |response: &str| of(&found, response)["icc"]["forms"][1]["icc"].as_f64().unwrap();
    let alpha = |response: &str| of(&found, response)["krippendorff"]["alpha"].as_f64().unwrap();
    // Intensities were planted to differ from clip to clip, believabilities were not.
    let [intensity, believability] = ["perceived_intensity", "believability"].map(single);
    assert!(intensity > believability + 0.05, "{intensity} {believability}");
    assert!(believability < 0.05, "{believability}");
    let [intensity, believability] = ["perceived_intensity", "believability"].map(alpha);
    assert!(intensity > believability + 0.05, "{intensity} {believability}");
    // Above half of the answers are right.
    assert!(alpha("emotion") > 0.1, "{}", alpha("emotion"));
    assert_eq!(of(&found, "emotion")["level"], "nominal");
    assert_eq!(of(&found, "believability")["level"], "ordinal");
    assert!(of(&found, "emotion")["icc"].is_null());
    let [low, high] = [0, 1].map(|end| {
        of(&found, "perceived_intensity")["krippendorff"]["interval"][end].as_f64().unwrap()
    });
    assert!(low < alpha("perceived_intensity") && alpha("perceived_intensity") < high);
    for words in ["## Agreement about the clips", "ICC(2,1)", "ICC2k", "Krippendorff’s alpha is"]
    {
        assert!(text.contains(words), "{words}");
    }
    assert!(!text.contains("## Scales"));
}

#[test]
fn too_few_people_have_no_coefficient_and_that_is_said() {
    let study = demo_study();
    let csv = export(&study, &Raters { people: 3, effect: 0.0, seed: 9 });
    for (language, words) in [
        (Language::English, "The ICC is undefined ("),
        (Language::French, "L’ICC n’est pas défini ("),
    ] {
        let (found, text) = results(&csv, &study, language);
        assert_eq!(of(&found, "believability")["icc"]["status"], "undefined");
        assert!(text.contains(words), "{text}");
    }
}

#[test]
fn a_scale_of_trials_is_consistent_until_an_item_is_turned_round() {
    let mut study = demo_study();
    let items = ["believability", "perceived_intensity"].map(str::to_owned);
    let scale =
        |reversed: &[String]| CompositeScale { items: items.to_vec(), reversed: reversed.to_vec() };
    let csv = export(&study, &Raters { people: 40, effect: 0.0, seed: 9 });
    study.scales.insert("strength".to_owned(), scale(&[]));
    study.scales.insert("turned".to_owned(), scale(&items[1..]));
    let (found, text) = results(&csv, &study, Language::French);
    let alpha = |place: usize| found["scales"][place]["cronbach"]["alpha"].as_f64().unwrap();
    // Each person's level is in both.
    assert!(alpha(0) > 0.8, "{}", alpha(0));
    assert!(alpha(1) < 0.0, "{}", alpha(1));
    assert!(text.contains("moyennées sur les essais"), "{text}");
}

#[test]
fn a_scale_of_a_page_is_read_from_its_rows() {
    let mut study = demo_study();
    let csv = export(&study, &Raters { people: 30, effect: 0.0, seed: 9 });
    let names: Vec<&str> = csv.lines().next().unwrap().split(',').collect();
    let row = |person: usize, item: &str, answer: i64| {
        let cells: Vec<String> = names
            .iter()
            .map(|name| match *name {
                "participant_id" => format!("p{:04}", person + 1),
                "participant" => (person + 1).to_string(),
                "trial_id" | "condition" => "empathy".to_owned(),
                "trial_type" => "questionnaire".to_owned(),
                "stage" => "live".to_owned(),
                "status" => if person + 1 == 30 { "active" } else { "completed" }.to_owned(),
                "response_id" => item.to_owned(),
                "answer" | "response" => answer.to_string(),
                _ => String::new(),
            })
            .collect();
        cells.join(",") + "\n"
    };
    let mut random = Random::new(3);
    let mut lines: Vec<(usize, String)> = Vec::new();
    for person in 0..30 {
        let level = (1.0 + 5.0 * random.uniform()) as i64;
        for (item, answer) in [("e1", level), ("e2", level + 1), ("e3", 8 - level), ("e4", 4)] {
            lines.push((person, row(person, item, answer)));
        }
    }
    // Each person's rows follow one another.
    let mut text = names.join(",") + "\n";
    for person in 0..30 {
        let id = format!("p{:04},", person + 1);
        csv.lines()
            .filter(|line| line.starts_with(&id))
            .for_each(|line| text += &format!("{line}\n"));
        lines.iter().filter(|(own, _)| *own == person).for_each(|(_, line)| text += line);
    }
    let mut file = serde_json::to_value(&study).unwrap();
    let question = |id: &str| json!({ "id": id, "type": "likert", "prompt": id, "numItems": 7, "leftLabel": "no", "rightLabel": "yes" });
    let questions = ["e1", "e2", "e3", "e4"].map(question);
    file["components"]["empathy"] = json!({ "type": "questionnaire", "questions": questions });
    file["scales"] =
        json!({ "empathy": { "items": ["e1", "e2", "e3", "e4"], "reversed": ["e3"] } });
    study = Study::from_value(&file).unwrap();
    let (found, text) = results(&text, &study, Language::English);
    let own = &found["scales"][0]["cronbach"];
    // Three items are one and the same, the fourth never differs: 4/3 (1 - 3 v / 9 v).
    assert!((own["alpha"].as_f64().unwrap() - 8.0 / 9.0).abs() < 1e-12, "{own}");
    let without = own["alpha_if_dropped"]["e4"].as_f64().unwrap();
    assert!((without - 1.0).abs() < 1e-12, "{own}");
    assert!(own["item_rest_correlation"]["e4"].is_null());
    assert!(text.contains("empathy: Cronbach’s alpha of 4 questions is 0.89"), "{text}");
}
