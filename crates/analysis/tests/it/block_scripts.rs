//! `analysis.R` and `analysis.py` of blocks that choose what is shown, and of courses over time: other programs find the
//! numbers again, and tell those that are changed.

use std::process::Command;

use mimique_analysis::{Parameters, Report, Simulation, analyze};
use mimique_locale::Language;
use mimique_stats::Table;
use mimique_study::Study;
use serde_json::{Value, json};

use crate::support::followed::{followed, followers};
use crate::support::rerun::{compare, write};
use crate::support::results::careful;
use crate::support::simulated::simulated_export;

/// A report, and the first number of each of its families.
struct Case {
    name: &'static str,
    report: Report,
    families: &'static [&'static str],
}

/// Small studies: fewer trials and people than the studies have that they are made of.
fn cases() -> Vec<Case> {
    let adaptive = include_str!("../../../../study-config/jnd-alpha.json");
    let scaling = include_str!("../../../../study-config/scale-alpha.json");
    let faces = include_str!("../../../../study-config/reverse-correlation.json");
    let of = |text: &str, change: fn(&mut Value)| {
        let mut file = mimique_study::parse(text).unwrap();
        change(&mut file);
        Study::from_value(&file).unwrap()
    };
    // Three blocks, two of them with levels that fall from the hardest to the easiest.
    let adaptive = of(adaptive, |file| {
        let mut block = file["components"]["limit"].clone();
        // Intervals, which are not looked at here, run the rule a thousand times: a staircase is soon run.
        file["components"]["limit"]["rule"] =
            json!({ "staircase": { "down": 2, "steps": [0.2, 0.1] } });
        block["trials"] = 20.into();
        block["vary"] = json!({ "parameter": "lowpassHz", "from": 12, "to": 2, "levels": 21 });
        block["rule"]["questPlus"] = json!({
            "function": "logistic", "threshold": [2.5, 11.5, 10], "spread": [2.0],
        });
        // The third one asks for yes or no.
        let option = |value| json!({ "value": value, "label": { "en": value, "fr": value } });
        let options = ["yes", "no"].map(option);
        let mut yes_or_no = block.clone();
        file["components"]["falling"] = block;
        file["questions"].as_array_mut().unwrap().push(json!({
            "id": "differ", "type": "singleChoice", "prompt": { "en": "Do they differ?", "fr": "Diffèrent-ils ?" },
            "options": options,
        }));
        (yes_or_no["question"], yes_or_no["yes"]) = ("differ".into(), "yes".into());
        file["components"]["differing"] = yes_or_no;
        file["sequence"]["components"] = json!(["limit", "falling", "differing"]);
    });
    let scaling = of(scaling, |_| ());
    let faces = of(faces, |file| file["components"]["faces"]["trials"] = 60.into());
    let follow = followed();
    let means = [("box", 60.0), ("lsts", 80.0), ("recorded", 62.0)];
    vec![
        Case {
            name: "adaptive",
            report: report(&adaptive, &discriminating(&adaptive), 2),
            families: &[
                "threshold:limit:p0001",
                "threshold:limit:mean",
                "threshold:falling:p0002",
                "threshold:differing:p0001",
            ],
        },
        Case {
            name: "scaling",
            report: report(&scaling, &careful(&scaling), 6),
            families: &["scaling:scale"],
        },
        Case {
            name: "faces",
            report: report(&faces, &careful(&faces), 3),
            families: &[
                "faces:faces:joy",
                "faces:faces:joy:p",
                "faces:faces:joy:presence",
                "faces:faces:joy:presence p",
            ],
        },
        // More people than all changes of whose signs the scripts go through.
        Case {
            name: "followed",
            report: report(&follow, &followers(&follow, means), 13),
            families: &["trace:strength:method:box | lsts", "trace:strength:method:box | lsts:p"],
        },
    ]
}

fn report(study: &Study, parameters: &Parameters, people: u64) -> Report {
    let simulation = Simulation::new(study, "hash", parameters, 5).unwrap();
    let csv = simulated_export(&simulation, study, people);
    analyze(&Table::parse(csv.as_bytes()).unwrap(), study, Language::English).unwrap()
}

/// People whose answers rise over several levels.
fn discriminating(study: &Study) -> Parameters {
    let mut parameters = careful(study);
    for (block, threshold, spread) in [("limit", 0.4, 0.2), ("falling", 7.0, 2.0)] {
        let own = parameters.discrimination.get_mut(block).unwrap();
        (own.threshold, own.person_sd, own.spread) = (threshold, 0.0, spread);
    }
    parameters
}

/// The report with the first number of each family changed to just beyond what may differ.
fn changed(case: &Case) -> Report {
    let mut report = case.report.clone();
    let file = report.files.iter_mut().find(|own| own.path == "data/numbers.csv").unwrap();
    for key in case.families {
        let start = format!("{key},");
        let line = file.text.lines().find(|line| line.starts_with(&start));
        let line = line.unwrap_or_else(|| panic!("no {key}")).to_owned();
        let cells: Vec<&str> = line[start.len()..].split(',').collect();
        let [name, value, tolerance] = cells[..] else { panic!("{line}") };
        let (value, allowed): (f64, f64) = (value.parse().unwrap(), tolerance.parse().unwrap());
        // What the script finds may itself be off by the tolerance.
        let value = value + 2.1 * allowed + 3e-8 * value.abs();
        file.text = file.text.replace(&line, &format!("{start}{name},{value},{tolerance}"));
    }
    report
}

#[test]
fn r_and_python_find_what_blocks_give_and_tell_what_is_changed() {
    let name = "r_and_python_find_what_blocks_give_and_tell_what_is_changed";
    let rscript = mimique_test_support::rscript(name);
    let python = mimique_test_support::python(name);
    let scripts =
        [(rscript, "analysis.R", "numbers-r.csv"), (python, "analysis.py", "numbers-python.csv")];
    let cases = cases();
    let check = |case: &Case| {
        let folder = write(&changed(case), &format!("block-{}", case.name));
        for (program, script, numbers) in &scripts {
            let Some(program) = program else { continue };
            let output = Command::new(program).arg(folder.join(script)).output().unwrap();
            let text = [output.stdout, output.stderr].concat();
            let text = String::from_utf8_lossy(&text);
            assert_eq!(output.status.code(), Some(1), "{}: {text}", case.name);
            assert!(text.contains(&format!(" {} differ", case.families.len())), "{text}");
            assert!(case.families.iter().all(|key| text.contains(key)), "{text}");
            assert!(compare(&case.report, &folder, numbers) > 12, "{}", case.name);
        }
    };
    std::thread::scope(|scope| {
        for case in &cases {
            scope.spawn(|| check(case));
        }
    });
}
