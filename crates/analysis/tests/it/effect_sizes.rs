//! Effect sizes with intervals, floor and ceiling effects, and the participants of the paragraph for a paper, each with
//! a planted truth.

use mimique_locale::Language;
use mimique_study::Study;
use serde_json::Value;

use crate::support::planted::answered;
use crate::support::results::{report, text};
use crate::support::{Raters, demo_study, export};

/// The person's number of `p0007`.
fn number(cell: &dyn Fn(&str) -> String) -> usize {
    cell("participant_id").trim_start_matches('p').parse().unwrap()
}

/// Every rating is 4, but for the first 7 of 20 people, whose ratings of lsts30 are 5.
fn seven_of_twenty_differ(study: &Study) -> String {
    let csv = export(study, &Raters { people: 21, effect: 0.0, seed: 3 });
    answered(&csv, "believability", |cell| {
        let higher = cell("method") == "lsts30" && number(cell) <= 7;
        if higher { "5" } else { "4" }.to_owned()
    })
}

fn hypothesis<'r>(results: &'r Value, id: &str) -> &'r Value {
    let all = results["hypotheses"].as_array().unwrap();
    all.iter().find(|own| own["id"] == id).unwrap()
}

#[test]
fn people_without_a_difference_count_in_d_w_and_not_in_the_rank_biserial() {
    let study = demo_study();
    let (found, results) = report(&study, &seven_of_twenty_differ(&study), Language::English);
    let test = &hypothesis(&results, "H3")["recommended"]["pairs"][0]["wilcoxon"];
    assert_eq!(test["effect"].as_f64().unwrap().abs(), 1.0);
    let sizes = test["effect_sizes"].as_array().unwrap();
    assert_eq!([&sizes[0]["kind"], &sizes[1]["kind"]], ["paired_dominance", "cohen_dz"]);
    assert!((sizes[0]["estimate"].as_f64().unwrap() - 0.35).abs() < 1e-12, "{sizes:?}");
    // Mean .35 and standard deviation sqrt(.35 x .65 x 20 / 19) of seven ones and thirteen zeros.
    let d_z = 0.35 / (0.35_f64 * 0.65 * 20.0 / 19.0).sqrt();
    assert!((sizes[1]["estimate"].as_f64().unwrap() - d_z).abs() < 1e-9, "{sizes:?}");
    let reading = hypothesis(&results, "H3")["reading"].as_str().unwrap();
    assert!(reading.contains("d_w = .35, 95% CI [.09, .5"), "{reading}");
    assert!(reading.contains("; d_z = 0.72, 95% CI ["), "{reading}");
    let table = text(&found, "tables/hypothesis-h3-effect-sizes.csv");
    assert!(table.contains(",d_w,.35,\"[.09, .5"), "{table}");
    let french = report(&study, &seven_of_twenty_differ(&study), Language::French).0;
    let words = text(&french, "report.html");
    assert!(words.contains("Tailles d’effet standardisées des valeurs des personnes"));
    assert!(text(&french, "tables/hypothesis-h3-effect-sizes.csv").contains(",d_w,\"0,35\","));
}

/// At lsts30 three of five answers are at the highest point, at box none is.
#[test]
fn a_ceiling_is_named_where_it_is() {
    let study = demo_study();
    let csv = export(&study, &Raters { people: 21, effect: 0.0, seed: 5 });
    let mut turn = 0;
    let csv = answered(&csv, "believability", |cell| {
        turn += 1;
        match cell("method").as_str() {
            "lsts30" => ["7", "7", "7", "5", "6"][turn % 5],
            _ => ["3", "4", "5"][turn % 3],
        }
        .to_owned()
    });
    let (found, results) = report(&study, &csv, Language::English);
    let own = hypothesis(&results, "H3");
    let at = own["answer_distributions"][0]["levels"]["lsts30"]["at_highest"].as_f64().unwrap();
    assert!((0.5..0.7).contains(&at), "{at}");
    assert_eq!(own["answer_distributions"][0]["levels"]["box"]["at_highest"], 0.0);
    let words = format!(
        "Ceiling effect: at lsts30 {:.0} % of the answers are at the highest point of the scale, 7",
        at * 100.0
    );
    assert!(own["reading"].as_str().unwrap().contains(&words), "{words}");
    assert!(!own["reading"].as_str().unwrap().contains("Floor effect"));
    // On the question's section, too.
    let page = text(&found, "report.md");
    let section = page.split("## Rating").find(|part| part.contains("By method")).unwrap();
    assert!(section.contains("Ceiling effect"), "{section}");
    let french = text(&report(&study, &csv, Language::French).0, "report.md");
    assert!(french.contains("Effet plafond : pour lsts30, "));
}

#[test]
fn the_paragraph_for_a_paper_says_who_took_part_with_what_and_by_which_model() {
    let study = demo_study();
    let csv = export(&study, &Raters { people: 14, effect: 1.0, seed: 3 });
    let page = text(&report(&study, &csv, Language::English).0, "report.md");
    let methods = page.split("### Methods").nth(1).unwrap().split("### Results").next().unwrap();
    for words in [
        "14 people took part. 1 participant was excluded (incomplete: 1), leaving 13 in the analysis.",
        "Participants were ",
        " years old on average (SD = ",
        "Model formulas in the notation of lme4 are H1: ",
        "believability ~ method + (1 | participant)",
        concat!("Analyses were computed with Mimique ", env!("CARGO_PKG_VERSION"), "."),
    ] {
        assert!(methods.replace('\\', "").contains(words), "{words}: {methods}");
    }
    let results = page.split("### Results").nth(1).unwrap().replace('\\', "");
    assert!(results.contains("d_z = ") && results.contains("d_w = "), "{results}");
    let french = text(&report(&study, &csv, Language::French).0, "report.md").replace('\\', "");
    for words in [
        "1 personne a été exclue (incomplets : 1), ce qui en laisse 13 dans l’analyse.",
        "Les participants avaient ",
        "Les formules des modèles, dans la notation de lme4, sont H1 : ",
    ] {
        assert!(french.contains(words), "{words}");
    }
}
