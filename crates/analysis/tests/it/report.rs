//! The report of a simulated study: complete, the same each time, and true to what was planted.

mod mimicry;
mod stimulus_measures;

use std::collections::BTreeSet;

use mimique_analysis::{Parameters, Simulation, analyze};
use mimique_locale::Language;
use mimique_stats::Table;
use mimique_study::{Generalise, Hypothesis, Study};
use serde_json::json;

use crate::support::simulated::simulated_export;
use crate::support::{self, Raters, demo_study, export};

fn report(raters: &Raters, language: Language) -> mimique_analysis::Report {
    let study = demo_study();
    let table = Table::parse(export(&study, raters).as_bytes()).unwrap();
    analyze(&table, &study, language).unwrap()
}

fn results(report: &mimique_analysis::Report) -> serde_json::Value {
    let file = report.files.iter().find(|file| file.path == "results.json").unwrap();
    serde_json::from_str(&file.text).unwrap()
}

#[test]
fn writes_the_same_bytes_each_time() {
    let raters = Raters { people: 9, effect: 0.5, seed: 4 };
    assert_eq!(report(&raters, Language::English), report(&raters, Language::English));
}

#[test]
fn holds_every_part_under_its_own_name() {
    for language in [Language::English, Language::French] {
        let report = report(&Raters { people: 12, effect: 1.0, seed: 2 }, language);
        let paths: BTreeSet<&str> = report.files.iter().map(|file| file.path.as_str()).collect();
        assert_eq!(paths.len(), report.files.len(), "two files of one name: {paths:?}");
        for path in [
            "report.html",
            "report.md",
            "results.json",
            "tables/hypothesis-h1.csv",
            "tables/late-frames.csv",
            "figures/participants.svg",
            "figures/emotion-confusion-lsts30.svg",
            "figures/emotion-shares.svg",
            "figures/believability-by-method.svg",
            "figures/believability-by-method-differences.svg",
            "figures/response-times.svg",
            "figures/believability-by-method-people.svg",
            "figures/emotion-people.svg",
            "figures/course-believability.svg",
            "figures/course-emotion-rt.svg",
            "figures/late-frames-share.svg",
        ] {
            assert!(paths.contains(path), "{path} is missing among {paths:?}");
        }
        let page = &report.files[0].text;
        assert!(page.contains(&format!("<html lang=\"{}\">", language.code())));
        // One file, no network: nothing is fetched.
        for fetched in ["src=", "@import", "url(", "<script", "<link"] {
            assert!(!page.contains(fetched), "{fetched} in the page");
        }
        for file in report.files.iter().filter(|file| file.path.ends_with(".svg")) {
            assert!(file.text.contains("role=\"img\"") && file.text.contains("aria-label=\""));
            assert!(!file.text.contains("NaN") && !file.text.contains("inf"), "{}", file.path);
        }
        assert!(!page.contains("NaN"));
    }
}

#[test]
fn finds_a_planted_effect_and_says_who_stands_behind_it() {
    let report = report(&Raters { people: 28, effect: 1.0, seed: 7 }, Language::English);
    let results = results(&report);
    let hypothesis = &results["hypotheses"][1];
    assert_eq!(hypothesis["id"], "H2");
    let pair = &hypothesis["recommended"]["pairs"][0];
    assert_eq!([&pair["a"], &pair["b"]], ["lsts30", "box"]);
    assert_eq!(pair["n"], 27);
    assert!(pair["wilcoxon"]["p_value"].as_f64().unwrap() < 1e-4);
    let difference = &pair["difference"];
    assert!(difference["ci_low"].as_f64().unwrap() < 1.0);
    assert!(difference["ci_high"].as_f64().unwrap() > 0.8);
    let reading = &report.readings[1].1;
    assert!(reading.contains("lsts30 was rated higher than box"), "{reading}");
    assert!(reading.contains("of 27 people"), "{reading}");
    assert_eq!(hypothesis["as_in_the_thesis"]["assumes"], "independent observations");
}

#[test]
fn shows_no_difference_where_there_is_none_and_does_not_call_it_proof() {
    let report = report(&Raters { people: 20, effect: 0.0, seed: 11 }, Language::English);
    let reading = &report.readings[2].1;
    assert!(reading.contains("no difference between lsts30 and box was shown"), "{reading}");
    assert!(report.files[0].text.contains("that is no proof that there is nothing"));
}

/// The decision is that of the corrected p, in the table and before everything else that is said; the p before the
/// correction is said to be that.
#[test]
fn what_the_correction_takes_back_is_not_decided() {
    let mut study = demo_study();
    let asked = study.hypotheses[1].clone();
    study.hypotheses =
        (1..=4).map(|number| Hypothesis { id: format!("H{number}"), ..asked.clone() }).collect();
    let (mut taken_back, mut kept) = (0, 0);
    for seed in 1..40 {
        let table = export(&study, &Raters { people: 16, effect: 0.25, seed });
        let report =
            analyze(&Table::parse(table.as_bytes()).unwrap(), &study, Language::English).unwrap();
        let results = results(&report);
        let hypothesis = &results["hypotheses"][0];
        let [p, corrected] =
            ["p", "p_holm_over_hypotheses"].map(|key| hypothesis[key].as_f64().unwrap());
        let words =
            if corrected < 0.05 { "no difference rejected" } else { "no difference not rejected" };
        let reading = &report.readings[0].1;
        let first =
            format!("Corrected for the 4 hypotheses of this study: null hypothesis of {words}, p");
        assert!(reading.starts_with(&first), "{p} {corrected} {reading}");
        assert!(reading.contains("; this p decides. Before that correction:"), "{reading}");
        let table = report.files.iter().find(|file| file.path == "tables/hypotheses.csv").unwrap();
        let row = table.text.lines().nth(1).unwrap();
        assert!(row.contains(words), "{corrected} {row}");
        assert!(table.text.starts_with("expected,decision,"));
        taken_back += usize::from(p < 0.05 && corrected >= 0.05);
        kept += usize::from(corrected < 0.05);
    }
    assert!(taken_back > 0 && kept > 0, "{taken_back} {kept}");
}

/// The first screen: who took part, and a row per hypothesis with its interval drawn.
#[test]
fn the_first_screen_has_a_row_per_hypothesis() {
    for (language, people) in [
        (Language::English, "13 people in the analysis"),
        (Language::French, "13 personnes dans l’analyse"),
    ] {
        let report = report(&Raters { people: 14, effect: 1.0, seed: 3 }, language);
        let page = &report.files[0].text;
        let first =
            &page[..page.find("id=\"s3\"").or_else(|| page.find("class=\"figures\"")).unwrap()];
        assert!(first.contains(people));
        let study = demo_study();
        assert_eq!(first.matches("<th scope=\"row\">").count(), study.hypotheses.len());
        assert!(first.matches("class=\"forest\"").count() >= 3);
        // What is computed stands behind headings; nothing of it is lost from the files.
        assert!(page.contains("<details class=\"folded\">"));
        assert!(report.files.iter().any(|file| file.path == "tables/hypothesis-h2.csv"));
    }
}

/// Two paragraphs for a paper, with the numbers of the tables.
#[test]
fn words_for_a_paper_have_the_numbers_of_the_tables() {
    let report = report(&Raters { people: 28, effect: 1.0, seed: 7 }, Language::English);
    let results = results(&report);
    let model = &results["hypotheses"][1]["other_clips"]["linear_model"];
    let pair = &model["pairs"][0];
    let estimate = pair["difference"].as_f64().unwrap();
    let [low, high] = [0, 1].map(|end| pair["interval_95"][end].as_f64().unwrap());
    let page = &report.files.iter().find(|file| file.path == "report.md").unwrap().text;
    let words = format!("= {estimate:.2}, 95% CI \\[{low:.2}, {high:.2}\\]");
    assert!(page.contains(&words), "{words}");
    let f = format!(
        "F(1, {:.1}) = {:.2}, p",
        model["df_denominator"].as_f64().unwrap(),
        model["f"].as_f64().unwrap()
    );
    let words = "(H2): null hypothesis of no difference rejected, linear mixed model with random participants and segments, ";
    assert!(page.contains(&format!("{words}{f}")), "{f}: {page}");
    // The tests that ran are named, and no others.
    assert!(page.contains("Tests of H1, H2 and H3: linear mixed model, fitted by"));
    assert!(page.contains("; H4: aligned rank transform on"));
    let methods = page.split("### Methods").nth(1).unwrap().split("###").next().unwrap();
    assert!(!methods.contains("Friedman") && !methods.contains("Wilcoxon"), "{methods}");
}

#[test]
fn counts_who_and_what_is_left_out() {
    let raters = Raters { people: 14, effect: 0.0, seed: 3 };
    let results = results(&report(&raters, Language::English));
    let flow = &results["flow"];
    assert_eq!(flow["people"], 14);
    assert_eq!(flow["people_left_out"]["incomplete"], 1);
    assert_eq!(flow["people_used"], 13);
    let late = flow["trials_left_out"]["late frames"].as_u64().unwrap();
    assert!(late > 0);
    assert_eq!(flow["trials_used"].as_u64().unwrap() + late, 13 * 12);
}

#[test]
fn two_people_are_too_few_and_that_is_said() {
    let report = report(&Raters { people: 3, effect: 2.0, seed: 5 }, Language::English);
    let reading = &report.readings[1].1;
    assert!(reading.contains("too few to compare lsts30 and box"), "{reading}");
    assert!(reading.contains("p could not fall below 0.500"), "{reading}");
    let french = self::report(&Raters { people: 2, effect: 0.0, seed: 5 }, Language::French);
    assert!(french.files[0].text.contains("Comme dans la thèse"));
}

/// Of one person no test of people is defined; a French report says why in French.
#[test]
fn reasons_are_said_in_the_language_of_the_report() {
    let study = demo_study();
    let table = export(&study, &Raters { people: 2, effect: 0.0, seed: 1 });
    let table = Table::parse(table.as_bytes()).unwrap();
    let report = |language| analyze(&table, &study, language).unwrap();
    let (english, french) = (report(Language::English), report(Language::French));
    let [english_words, french_words] =
        ["one block only: Iman and Davenport", "le F d’Iman et Davenport n’existe pas"];
    assert!(english.files[0].text.contains(english_words));
    assert!(!french.files[0].text.contains(english_words));
    assert!(french.files[0].text.contains(french_words));
}

#[test]
fn an_export_without_trials_or_columns_is_refused() {
    let study = demo_study();
    let only_incomplete = export(&study, &Raters { people: 1, effect: 0.0, seed: 1 });
    let table = Table::parse(only_incomplete.as_bytes()).unwrap();
    let refusal = analyze(&table, &study, Language::English).unwrap_err().to_string();
    let wanted = "no trial is left: 1 of 1 people and 0 of 0 trials are left out (incomplete: 1)";
    assert!(refusal.contains(wanted), "{refusal}");
    let table = Table::parse(b"a,b\n1,2\n").unwrap();
    let refusal = analyze(&table, &study, Language::English).unwrap_err().to_string();
    assert!(refusal.contains("column \"participant_id\": there is no such column"), "{refusal}");
}

/// One row that cannot be read does not take the report away from everybody.
#[test]
fn rows_that_name_no_trial_or_response_are_skipped_and_counted() {
    let study = demo_study();
    let text = export(&study, &Raters { people: 9, effect: 0.5, seed: 4 });
    let whole = analyze(&Table::parse(text.as_bytes()).unwrap(), &study, Language::English);
    let names: Vec<&str> = text.lines().next().unwrap().split(',').collect();
    let row: Vec<&str> = text.lines().nth(1).unwrap().split(',').collect();
    let blank = |name: &str| {
        let place = names.iter().position(|known| *known == name).unwrap();
        let mut cells = row.clone();
        cells[place] = "";
        cells.join(",")
    };
    let spoilt = format!("{text}{}\n{}\n", blank("trial_id"), blank("response_id"));
    let report = analyze(&Table::parse(spoilt.as_bytes()).unwrap(), &study, Language::English);
    let (whole, report) = (whole.unwrap(), report.unwrap());
    assert_eq!(results(&report)["flow"]["rows_unread"], 2);
    assert_eq!(results(&whole)["flow"].get("rows_unread"), None);
    assert_eq!(report.readings, whole.readings, "what can be read is read as ever");
    let page = &report.files[0].text;
    assert!(page.contains("rows that name no trial or no response: 2"), "the chart says so");
}

/// Numbers of a table's row as its CSV has them.
fn row<'t>(report: &'t mimique_analysis::Report, path: &str, start: &str) -> Vec<&'t str> {
    let file = report.files.iter().find(|file| file.path == path).unwrap();
    let line = file.text.lines().find(|line| line.starts_with(start));
    line.unwrap_or_else(|| panic!("no row {start} in\n{}", file.text)).split(',').collect()
}

#[test]
fn tables_stand_in_the_layout_that_the_study_gives() {
    let study = support::parameter_study();
    let raters = Raters { people: 28, effect: 1.0, seed: 19 };
    let table = Table::parse(export(&study, &raters).as_bytes()).unwrap();
    let report = analyze(&table, &study, Language::English).unwrap();
    for laid_out in &study.tables {
        let path = format!("tables/table-{}.csv", laid_out.id.to_lowercase());
        assert!(report.files.iter().any(|file| file.path == path), "{path}");
    }
    // Planted: the first value of the parameter is rated a point higher.
    let means = row(&report, "tables/table-6-6.csv", "Believable?");
    let means: Vec<f64> = means[2..].iter().map(|cell| cell.parse().unwrap()).collect();
    assert!(means[0] > means[1] + 0.5 && means[0] > means[2] + 0.5, "{means:?}");
    let pairs = row(&report, "tables/table-6-4.csv", "How intense?");
    assert_eq!(pairs[1..4], ["0.3", "<0.001", "<0.001"]);
    assert_eq!(pairs[4..], ["<0.001", "<0.001"], "{pairs:?}");
    let last = row(&report, "tables/table-6-4.csv", ",0.5");
    assert_eq!((last[2], last[4]), ("", ""), "below the diagonal is nothing");
    // Table A.2: numbers about people by Spearman, words by Kruskal-Wallis or chi-square.
    let influences = row(&report, "tables/table-a-2.csv", "How intense?");
    let names: Vec<char> = influences[2..].iter().filter_map(|cell| cell.chars().next()).collect();
    assert_eq!(names, ['ρ', 'H', 'ρ', 'H', 'ρ', 'H'], "{influences:?}");
    let influences = row(&report, "tables/table-a-2.csv", "Which emotion?");
    let names: Vec<char> = influences[2..].iter().filter_map(|cell| cell.chars().next()).collect();
    assert_eq!(names, ['ρ', 'χ', 'ρ', 'χ', 'χ', 'χ'], "{influences:?}");
    // Nobody is counted twice, levels that nobody chose are there.
    let people = row(&report, "tables/table-fig-a-1a.csv", "people");
    assert_eq!(people.len(), 2 + 7);
    let counted: usize = people[2..].iter().map(|cell| cell.parse::<usize>().unwrap()).sum();
    assert_eq!(counted, 27);
    let by_sight = row(&report, "tables/table-fig-a-1b.csv", "How intense?,1 (very weak) to 7");
    assert_eq!(by_sight.len(), 5);
}

#[test]
fn every_table_is_there_as_latex() {
    let study = support::parameter_study();
    let raters = Raters { people: 8, effect: 1.0, seed: 2 };
    let table = Table::parse(export(&study, &raters).as_bytes()).unwrap();
    for language in [Language::English, Language::French] {
        let report = analyze(&table, &study, language).unwrap();
        let find = |path: &str| report.files.iter().find(|file| file.path == path);
        let all = &find("tables/all.tex").unwrap().text;
        let mut tables = 0;
        for file in report.files.iter().filter(|file| file.path.ends_with(".csv")) {
            let path = file.path.replace(".csv", ".tex");
            let Some(latex) = find(&path) else { continue };
            let latex = &latex.text;
            tables += 1;
            let columns = latex.lines().find(|line| line.starts_with("\\begin{tabular}")).unwrap();
            let columns = columns["\\begin{tabular}{".len()..].replace("{7cm}", "").len() - 1;
            for line in latex.lines().skip_while(|line| *line != "\\midrule").skip(1) {
                if line == "\\bottomrule" {
                    break;
                }
                let cells = line.replace("\\&", "").matches(" & ").count() + 1;
                assert_eq!(cells, columns, "{path}: {line}");
                assert!(line.ends_with(" \\\\"), "{path}: {line}");
            }
            let strange = |c: char| !c.is_ascii() && !('\u{a0}'..='\u{17f}').contains(&c);
            assert!(!latex.contains(strange), "{path} has a letter that LaTeX lacks:\n{latex}");
        }
        assert!(tables > 30, "{tables}");
        assert!(all.contains("\\input{table-6-3}") && all.ends_with("\\end{document}\n"));
    }
}

/// Of two methods only one has the parameter: what is asked of the parameter is asked of its trials.
#[test]
fn a_parameter_that_one_method_lacks_is_compared_where_it_is() {
    let mut study = support::parameter_study();
    let box_entry = serde_json::from_value(serde_json::json!({ "method": "box" })).unwrap();
    study.stimuli.methods.insert("box".to_owned(), box_entry);
    let raters = Raters { people: 13, effect: 1.0, seed: 23 };
    let with_box = export(&study, &raters);
    let without_box: String = with_box
        .lines()
        .filter(|line| !line.contains(".box,"))
        .map(|line| format!("{line}\n"))
        .collect();
    let results_of = |text: &str| {
        let table = Table::parse(text.as_bytes()).unwrap();
        results(&analyze(&table, &study, Language::English).unwrap())
    };
    let (both, one) = (results_of(&with_box), results_of(&without_box));
    let mut of_parameter = 0;
    for (with, without) in
        both["hypotheses"].as_array().unwrap().iter().zip(one["hypotheses"].as_array().unwrap())
    {
        if with["factors"][0] != "alpha" {
            continue;
        }
        of_parameter += 1;
        assert_eq!(with["as_in_the_thesis"], without["as_in_the_thesis"]);
        assert_eq!(with["recommended"], without["recommended"]);
        assert_eq!(with["trials_without_level"], 12 * 18, "{with}");
        assert_eq!(without["trials_without_level"], 0);
        assert!(with["reading"].as_str().unwrap().contains("left out here: 216 trials."));
    }
    assert_eq!(of_parameter, 5);
    // Each value of the parameter is one method: the same trials are not compared twice.
    let factors = |results: &serde_json::Value| -> Vec<String> {
        let all = results["comparisons"].as_array().unwrap();
        let own = all.iter().filter(|c| c["measure"] == "difficulty");
        own.map(|c| c["factor"].as_str().unwrap().to_owned()).collect()
    };
    for results in [&both, &one] {
        let factors = factors(results);
        assert!(factors.iter().any(|name| name == "method"), "{factors:?}");
        assert!(!factors.iter().any(|name| name == "alpha"), "{factors:?}");
    }
}

#[test]
fn conditions_are_told_in_french_too() {
    let study = support::study_in_conditions();
    let text = export(&study, &Raters { people: 14, effect: 0.5, seed: 6 });
    // Nobody is in the second condition.
    let text: String = text
        .lines()
        .filter(|line| !line.contains(",at-once,"))
        .map(|line| format!("{line}\n"))
        .collect();
    let table = Table::parse(text.as_bytes()).unwrap();
    let report = analyze(&table, &study, Language::French).unwrap();
    let reading = &report.readings[0].1;
    for words in [
        "Moyenne des personnes de chaque condition : rested ",
        " (5 personnes), 10 ",
        "n’est dans la condition at-once",
        "condition attribuée (10 | rested)",
    ] {
        assert!(reading.contains(words), "{words} in {reading}");
    }
    let page = &report.files[0].text;
    assert!(page.contains("moyenne de chaque personne, par condition"));
    assert!(page.contains("Entre conditions"));
}

/// A factor about people beside one of the clips: everyone counts once, and the reading says how.
#[test]
fn a_factor_about_people_is_tested_on_people() {
    let mut study = support::parameter_study();
    study.hypotheses.iter_mut().for_each(|own| own.generalise = Some(Generalise::TheseClips));
    let raters = Raters { people: 16, effect: 0.5, seed: 5 };
    let table = Table::parse(export(&study, &raters).as_bytes()).unwrap();
    let report = analyze(&table, &study, Language::English).unwrap();
    let results = results(&report);
    let hypothesis = |id: &str| {
        let all = results["hypotheses"].as_array().unwrap();
        all.iter().find(|hypothesis| hypothesis["id"] == id).unwrap().clone()
    };
    let reading = |id: &str| &report.readings.iter().find(|(own, _)| own == id).unwrap().1;
    let terms = |tested: &serde_json::Value| -> Vec<String> {
        let lines = tested["recommended"]["overall"].as_array().unwrap();
        lines.iter().map(|line| line["term"].as_str().unwrap().to_owned()).collect()
    };
    // One of the clips, one about people: means, Friedman, differences.
    let mixed = hypothesis("H05");
    let overall = &mixed["recommended"]["overall"];
    assert_eq!(terms(&mixed), ["alpha", "gender", "alpha:gender"]);
    assert!(overall[0]["test"].as_str().unwrap().starts_with("Friedman on person means"));
    assert_eq!(overall[1]["test"], "Mann-Whitney of person means");
    assert!(overall[2]["test"].as_str().unwrap().starts_with("Mann-Whitney of person differences"));
    for line in overall.as_array().unwrap() {
        assert!(line["n"].as_u64().unwrap() <= 16, "{line}");
    }
    // It stands or falls by the smallest p of three pairs after Holm's correction.
    assert_eq!(mixed["p"], overall[2]["p_holm"]);
    let (p, p_holm) =
        (overall[2]["p_value"].as_f64().unwrap(), overall[2]["p_holm"].as_f64().unwrap());
    assert!((p_holm - (3.0 * p).min(1.0)).abs() < 1e-12, "{p} {p_holm}");
    assert!(reading("H05").contains("of each person’s difference"), "{}", reading("H05"));
    assert!(reading("H05").contains("after Holm’s correction"));
    // The order is the hypothesis's own; seven steps of habit are groups of Kruskal-Wallis.
    let habit = hypothesis("H06");
    assert_eq!(terms(&habit), ["familiarity", "intensity", "familiarity:intensity"]);
    assert_eq!(habit["recommended"]["overall"][0]["test"], "Kruskal-Wallis of person means");
    // Both about people: one mean a person.
    let both = hypothesis("H07");
    assert_eq!(terms(&both), ["gender", "vision", "gender:vision"]);
    assert_eq!(both["recommended"]["overall"][2]["n"], results["flow"]["people_used"]);
    assert!(reading("H07").contains("on one mean a person"), "{}", reading("H07"));
}

#[test]
fn whom_the_researcher_excluded_is_left_out_with_the_reason() {
    let study = demo_study();
    let csv = export(&study, &Raters { people: 9, effect: 0.5, seed: 4 });
    let mut rows = csv.lines();
    let mut marked = format!("{},excluded,exclusion_reason\n", rows.next().unwrap());
    for row in rows {
        let (excluded, reason) = match row.split(',').next().unwrap() {
            "p0002" | "p0005" => ("true", "watched with a friend"),
            "p0003" => ("true", "fell asleep"),
            _ => ("false", ""),
        };
        marked.push_str(&format!("{row},{excluded},{reason}\n"));
    }
    let table = Table::parse(marked.as_bytes()).unwrap();
    let report = analyze(&table, &study, Language::English).unwrap();
    let before = analyze(&Table::parse(csv.as_bytes()).unwrap(), &study, Language::English);
    let (used, all) = before.unwrap().people;
    assert_eq!(report.people, (used - 3, all));
    let page = &report.files[0].text;
    for line in [
        "excluded by the researcher (fell asleep): 1",
        "excluded by the researcher (watched with a friend): 2",
    ] {
        assert!(page.contains(line), "{line}");
    }
    let reasons = results(&report)["flow"].to_string();
    assert!(reasons.contains("\"watched with a friend\":2"), "{reasons}");
}

/// A place on a grid is two answers, a ranking and a matrix as many as they have parts: each has a name of
/// its own, which `check` takes for a hypothesis and the analysis finds.
#[test]
fn parts_of_questions_are_tested_by_their_names() {
    let path = format!("{}/../../study-config/demo.json", env!("CARGO_MANIFEST_DIR"));
    let mut value = mimique_study::parse(&std::fs::read_to_string(path).unwrap()).unwrap();
    let text = |word: &str| json!({ "en": word, "fr": word });
    let grid = json!({ "id": "grid", "type": "valenceArousal", "prompt": text("Where?"), "numItems": 9,
        "leftLabel": text("bad"), "rightLabel": text("good"), "bottomLabel": text("calm"), "topLabel": text("wild") });
    let point = |point: &str| json!({ "value": point, "label": text(point) });
    let matrix = json!({ "id": "parts", "type": "matrix", "prompt": text("How far?"),
        "rows": [point("brow"), point("lips")], "options": [point("1"), point("2"), point("3")] });
    let ranking = json!({ "id": "order", "type": "ranking", "prompt": text("Which first?"),
        "options": [point("eyes"), point("mouth")] });
    value["questions"].as_array_mut().unwrap().extend([grid, matrix, ranking]);
    let asked = value["components"]["faces"]["questions"].as_array_mut().unwrap();
    asked.extend(["grid", "parts", "order"].map(Into::into));
    let hypotheses = value["hypotheses"].as_array_mut().unwrap();
    let responses = ["grid.valence", "grid.arousal", "parts.lips", "order.eyes"];
    let of = |response: &&str| {
        let mut hypothesis = hypotheses[1].clone();
        (hypothesis["id"], hypothesis["response"]) = ((*response).into(), (*response).into());
        hypothesis
    };
    value["hypotheses"] = responses.iter().map(of).collect();
    let report = mimique_study::check(&value.to_string(), &|_| Ok(()));
    assert!(report.issues.is_empty(), "{:?}", report.issues);

    let study = Study::from_value(&value).unwrap();
    let mut parameters = Parameters::for_study(&study);
    let arousal = parameters.ratings.get_mut("grid.arousal").unwrap();
    let [lsts, _] = ["lsts30", "box"].map(|method| arousal.effects["method"][method]);
    assert!(lsts != 0.0, "a default of its own");
    let valence = parameters.ratings.get_mut("grid.valence").unwrap();
    valence.effects.insert("method".into(), [("lsts30".into(), 2.0), ("box".into(), 0.0)].into());
    let hash = mimique_study::config_hash(&value);
    let csv =
        simulated_export(&Simulation::new(&study, &hash, &parameters, 3).unwrap(), &study, 25);
    let table = Table::parse(csv.as_bytes()).unwrap();
    let results = results(&analyze(&table, &study, Language::English).unwrap());
    for (found, response) in results["hypotheses"].as_array().unwrap().iter().zip(responses) {
        assert_eq!(found["measure"], response);
        let p = found["p"].as_f64().unwrap_or_else(|| panic!("{response} is not tested: {found}"));
        assert!(response != "grid.valence" || p < 1e-3, "{response}: {p}");
    }
}

/// Whoever gives the same answer in more trials in a row than the rule allows is left out by that name, in the
/// chart and in the file; the rows may come in any order.
#[test]
fn straight_lining_is_left_out_by_the_study_s_rule() {
    let path = format!("{}/../../study-config/demo.json", env!("CARGO_MANIFEST_DIR"));
    let mut value = mimique_study::parse(&std::fs::read_to_string(path).unwrap()).unwrap();
    value["exclusions"]["straightLining"] =
        json!({"longestRun": 8, "questions": ["believability"]});
    let study = Study::from_value(&value).unwrap();
    let csv = export(&demo_study(), &Raters { people: 9, effect: 0.5, seed: 4 });
    let mut rows: Vec<Vec<String>> =
        csv.lines().map(|row| row.split(',').map(str::to_owned).collect()).collect();
    let column = |name: &str| rows[0].iter().position(|cell| cell == name).unwrap();
    let (response, answer) = (column("response_id"), column("answer"));
    for row in &mut rows {
        if row[0] == "p0004" && row[response] == "believability" {
            row[answer] = "4".to_owned();
        }
    }
    rows[1..].reverse();
    let text: Vec<String> = rows.iter().map(|row| row.join(",")).collect();
    let table = Table::parse(text.join("\n").as_bytes()).unwrap();
    let report = analyze(&table, &study, Language::French).unwrap();
    let flow = &results(&report)["flow"];
    assert_eq!(flow["people_left_out"]["straight-lining"], 1, "{flow}");
    assert!(flow["rules"].to_string().contains("straightLining.longestRun > 8"), "{flow}");
    assert!(report.files[0].text.contains("réponses toujours identiques\u{a0}: 1"));
    assert!(
        report.files[0].text.contains("dans plus de 8 essais de suite"),
        "in the reader's words"
    );
    let before = analyze(&table, &demo_study(), Language::French).unwrap();
    assert_eq!(report.people.0 + 1, before.people.0);
}

/// Counts of one are in the singular, in both languages.
#[test]
fn one_person_is_no_people() {
    for (language, wrong, right) in [
        (Language::English, " 1 people", "1 person"),
        (Language::French, " 1 personnes", "1 personne"),
    ] {
        // The second person does not finish.
        let report = report(&Raters { people: 2, effect: 0.0, seed: 3 }, language);
        let text = &report.files.iter().find(|file| file.path == "report.md").unwrap().text;
        for line in text.lines() {
            assert!(!line.contains(wrong), "{line}");
        }
        assert!(text.contains(right), "{text}");
    }
}

/// A report says why a test is undefined; what to type on a command line instead is not for its readers.
#[test]
fn reasons_name_no_options_of_the_command_line() {
    let mut study = support::study_in_conditions();
    study.hypotheses.truncate(2);
    // Mann-Whitney of three conditions.
    study.hypotheses[1].levels.clear();
    let csv = export(&study, &Raters { people: 31, effect: 0.0, seed: 3 });
    let table = Table::parse(csv.as_bytes()).unwrap();
    for language in [Language::English, Language::French] {
        let report = analyze(&table, &study, language).unwrap();
        let text = &report.files.iter().find(|file| file.path == "report.md").unwrap().text;
        let table = report.files.iter().find(|file| file.path == "results.json").unwrap();
        assert!(table.text.contains("this test compares two"), "the reason is there");
        assert!(!text.contains("--levels"), "{text}");
    }
}
