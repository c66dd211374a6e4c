//! Blocks of difference scaling: simulated people go through the study as a browser would, and the report finds the
//! scale that they perceive.

use mimique_analysis::Simulation;
use mimique_locale::Language;
use mimique_study::Study;
use serde_json::Value;

use crate::support::results::{careful, report, text};
use crate::support::simulated::simulated_export;

const PEOPLE: u64 = 30;

fn study(change: impl FnOnce(&mut Value)) -> Study {
    let file = include_str!("../../../../study-config/scale-alpha.json");
    let mut value = mimique_study::parse(file).unwrap();
    change(&mut value);
    Study::from_value(&value).unwrap()
}

/// People who perceive this scale, who answer with care and all come to the end.
fn export(study: &Study, range: f64, exponent: f64) -> String {
    let mut parameters = careful(study);
    let own = parameters.scaling.get_mut("scale").unwrap();
    (own.range, own.exponent, own.lapse) = (range, exponent, 0.0);
    parameters.check(study).unwrap();
    simulated_export(&Simulation::new(study, "hash", &parameters, 5).unwrap(), study, PEOPLE)
}

#[test]
fn planted_scales_are_found_again_by_triads_and_quadruples() {
    for rule in ["triads", "quadruples"] {
        let study = study(|value| value["components"]["scale"]["rule"] = rule.into());
        for exponent in [1.0, 0.5] {
            let (_, results) = report(&study, &export(&study, 4.0, exponent), Language::English);
            let block = &results["scalings"][0];
            assert_eq!((&block["block"], &block["parameter"]), (&"scale".into(), &"alpha".into()));
            let scale = &block["scale"];
            assert_eq!(
                (&scale["trials"], &scale["participants"]),
                (&(40 * PEOPLE).into(), &PEOPLE.into())
            );
            for (place, level) in [0.0, 0.2, 0.4, 0.6, 0.8, 1.0].into_iter().enumerate() {
                assert_eq!(scale["levels"][place], level);
                let found = scale["scale"][place].as_f64().unwrap();
                let planted = 4.0 * f64::powf(level, exponent);
                assert!((found - planted).abs() < 0.45, "{rule}, {level}: {found}, not {planted}");
            }
        }
    }
}

#[test]
fn the_report_draws_the_scale_and_asks_nothing_else_of_the_answers() {
    let study = study(|_| {});
    let csv = export(&study, 4.0, 1.0);
    let header = csv.lines().next().unwrap();
    assert!(header.contains("scaled_levels,second_differs_more,weights_expected"), "{header}");
    let (written, _) = report(&study, &csv, Language::English);
    let page = text(&written, "report.md");
    assert!(page.contains("1200 judgements of 30 people"), "{page}");
    let (sections, _) = page.split_once("## For a paper").unwrap();
    assert!(!sections.contains("Which two faces differ more?"), "no other section has its answers");
    assert!(
        text(&written, "figures/scale-scale.svg").contains("standard deviations of a judgement")
    );
    assert_eq!(text(&written, "tables/scale-scale.csv").lines().count(), 7);
    let (written, _) = report(&study, &csv, Language::French);
    assert!(text(&written, "report.md").contains("1200 jugements de 30 personnes"));
}

#[test]
fn people_who_never_err_have_no_scale_which_is_said() {
    let study = study(|_| {});
    let (written, results) = report(&study, &export(&study, 4000.0, 0.5), Language::English);
    assert!(results["scalings"][0]["scale"]["scale"].is_null());
    assert!(text(&written, "report.md").contains("The answers give no scale"));
}
