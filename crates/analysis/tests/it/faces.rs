//! Blocks of reverse correlation: simulated people go through the study as a browser would, and the report finds the
//! faces that they have in mind.

use mimique_analysis::{FacePart, Parameters, Simulation};
use mimique_locale::Language;
use mimique_study::Study;
use serde_json::Value;

use crate::support::results::{careful, report, text};
use crate::support::simulated::simulated_export;

const PEOPLE: u64 = 14;

fn study() -> Study {
    let file = include_str!("../../../../study-config/reverse-correlation.json");
    Study::from_value(&mimique_study::parse(file).unwrap()).unwrap()
}

/// People who have these faces in mind, who answer with care and all come to the end.
fn export(study: &Study, change: impl FnOnce(&mut Parameters)) -> String {
    let mut parameters = careful(study);
    change(&mut parameters);
    parameters.check(study).unwrap();
    simulated_export(&Simulation::new(study, "hash", &parameters, 5).unwrap(), study, PEOPLE)
}

/// Units whose presence goes with a category, p 0.05 or less.
fn found(results: &Value, category: &str) -> Vec<String> {
    let categories = results["faces"][0]["categories"].as_array().unwrap();
    let own = categories.iter().find(|own| own["category"] == category).unwrap();
    let units = own["group"]["units"].as_array().unwrap();
    let is_found = |unit: &&Value| {
        unit["presence"]["p"].as_f64().unwrap() <= 0.05
            && unit["presence"]["z"].as_f64().unwrap() > 0.0
    };
    units.iter().filter(is_found).map(|unit| unit["unit"].as_str().unwrap().to_owned()).collect()
}

#[test]
fn planted_faces_are_found_again() {
    let study = study();
    let csv = export(&study, |_| {});
    let (written, results) = report(&study, &csv, Language::English);
    let block = &results["faces"][0];
    assert_eq!((&block["block"], &block["not_replayed"]), (&"faces".into(), &0.into()));
    assert_eq!(block["n"], 200 * PEOPLE);
    // The prototypes of the guide: what people have in mind if nothing else is said.
    assert_eq!(found(&results, "joy"), ["AU06", "AU12"]);
    assert_eq!(found(&results, "surprise"), ["AU01", "AU02", "AU05", "AU26"]);
    assert_eq!(found(&results, "disgust"), ["AU09", "AU15", "AU16"]);
    assert!(found(&results, "other").is_empty(), "{:?}", found(&results, "other"));
    let page = text(&written, "report.md");
    assert!(page.contains("more often answered where the face shows AU06, AU12."), "{page}");
    // The face in mind is a file of recorded weights that begins and ends at rest.
    let played = text(&written, "figures/faces-joy-face.svg");
    assert!(played.contains("id=\"faces_joy_face_played\"") && played.contains("role=\"group\""));
    // One face moves, four stand still; what moves begins at rest and comes to its whole smile.
    let lips: Vec<&str> =
        played.split("<path").filter(|path| path.contains("class=\"lips\"")).collect();
    assert_eq!(lips.len(), 5);
    let frames = lips[0].split_once("values=\"M").unwrap().1.split('"').next().unwrap();
    let width = |frame: &str| {
        let points = frame.trim_matches(['M', 'Z']).split('L');
        let xs = || points.clone().map(|p| p.split(' ').next().unwrap().parse::<f64>().unwrap());
        xs().fold(f64::MIN, f64::max) - xs().fold(f64::MAX, f64::min)
    };
    let widths: Vec<f64> = frames.split(';').map(width).collect();
    let widest = widths.iter().copied().fold(0.0, f64::max);
    assert!(widest > 1.1 * widths[0] && widths[16] < 1.1 * widths[0], "{widths:?}");
    assert!(lips[1..].iter().all(|path| !path.contains("<animate")));
    // What is pressed and what is clipped is named once on the page, or one face would have the eyes of another.
    let html = text(&written, "report.html");
    let ids: Vec<&str> =
        html.split(" id=\"").skip(1).map(|rest| rest.split('"').next().unwrap()).collect();
    let once: std::collections::BTreeSet<&&str> = ids.iter().collect();
    assert_eq!((ids.len(), once.len() > 40), (once.len(), true), "{ids:?}");
    let face = text(&written, "tables/figure-faces-joy-face.csv");
    let lines: Vec<&str> = face.lines().collect();
    assert_eq!(lines[0], "frame,time,AU06,AU12");
    assert_eq!(lines.len(), 1 + 32);
    assert_eq!((lines[1], lines[32]), ("0,0.0000,0.0000,0.0000", "31,1.2917,0.0000,0.0000"));
    let middle: Vec<f64> = lines[16].split(',').map(|cell| cell.parse().unwrap()).collect();
    assert!(middle[2] > 0.2 && middle[3] > 0.2, "{}", lines[16]);
    assert!(text(&written, "figures/faces-joy.svg").contains("outline"), "something is framed");
    // The questions have no other section than the words for a paper: their answers are about no clip.
    let page = text(&written, "report.md");
    let (sections, _) = page.split_once("## For a paper").unwrap();
    assert!(!sections.contains("How strongly do you see it?"));
    let (written, _) = report(&study, &csv, Language::French);
    assert!(text(&written, "report.md").contains("Les visages que les gens ont en tête : faces"));
}

#[test]
fn people_who_do_not_look_have_no_face_in_mind() {
    let study = study();
    let csv = export(&study, |parameters| parameters.careless.share = 1.0);
    let (_, results) = report(&study, &csv, Language::English);
    let all = ["joy", "surprise", "anger", "disgust", "other"];
    let by_chance: usize = all.iter().map(|category| found(&results, category).len()).sum();
    // Each image has any unit of p <= 0.05 in one study of twenty.
    assert!(by_chance <= 1, "{by_chance}");
}

#[test]
fn trials_that_the_seed_does_not_give_again_are_left_out_and_told() {
    let study = study();
    let csv = export(&study, |_| {});
    let mut reader = csv::Reader::from_reader(csv.as_bytes());
    let head = reader.headers().unwrap().clone();
    let place = |name: &str| head.iter().position(|own| own == name).unwrap();
    let (person, expected) = (place("participant_id"), place("weights_expected"));
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(&head).unwrap();
    let rows: Vec<csv::StringRecord> = reader.records().map(Result::unwrap).collect();
    let first = rows[0][person].to_owned();
    for row in &rows {
        let cell = |(at, cell)| if at == expected && row[person] == first { "false" } else { cell };
        writer.write_record(row.iter().enumerate().map(cell)).unwrap();
    }
    let spoilt = String::from_utf8(writer.into_inner().unwrap()).unwrap();
    let (written, results) = report(&study, &spoilt, Language::English);
    assert_eq!(results["faces"][0]["not_replayed"], 200);
    assert_eq!(results["faces"][0]["participants"], PEOPLE - 1);
    assert!(text(&written, "report.md").contains("200 trials are not those that the seed gives"));
}

#[test]
fn templates_that_the_study_cannot_have_are_refused_by_name() {
    let study = study();
    let base = Parameters::for_study(&study);
    for (text, says) in [
        (r#"{"templates": {"face": {}}}"#, "/templates/face"),
        (
            r#"{"templates": {"faces": {"categories": {"fear": [{"unit": "AU01"}]}}}}"#,
            "no option \"fear\"",
        ),
        (
            r#"{"templates": {"faces": {"categories": {"joy": [{"unit": "AU43"}]}}}}"#,
            "\"AU43\" is not drawn",
        ),
        (r#"{"templates": {"faces": {"categories": {"joy": []}}}}"#, "a face without units"),
        (
            r#"{"templates": {"faces": {"categories": {"joy": [{"unit": "AU12", "atSeconds": 3}]}}}}"#,
            "3 s is no time",
        ),
        (r#"{"templates": {"faces": {"noise": -1}}}"#, "/templates/faces/noise"),
        (r#"{"templates": {"faces": {"otherwise": "nothing"}}}"#, "no option \"nothing\""),
    ] {
        let error = Parameters::read_over(&base, text, &study).unwrap_err().to_string();
        assert!(error.contains(says), "{error}");
    }
    let own = r#"{"templates": {"faces": {"categories": {"joy": [{"unit": "AU12", "atSeconds": 0.9}]}}}}"#;
    let read = Parameters::read_over(&base, own, &study).unwrap();
    let part = FacePart { unit: "AU12".to_owned(), at_seconds: Some(0.9) };
    assert_eq!(read.templates["faces"].categories["joy"], [part]);
    assert_eq!(read.templates["faces"].categories.len(), 1, "the faces are replaced whole");
}
