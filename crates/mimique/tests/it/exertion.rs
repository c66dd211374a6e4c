//! `mimique exertion` as a researcher types it: results, exit codes, errors, and nothing half written.

use std::path::Path;

use mimique_test_support::repository;
use serde_json::Value;

use crate::support::{exertion_args, ok, refused, sample, text};

/// The report of a run.
fn told(words: &[&str], paths: &[(&str, &Path)]) -> Value {
    let mut all = exertion_args(words, paths);
    all.push("--json".to_owned());
    serde_json::from_str(&ok(&all)).unwrap()
}

fn number(value: &Value, pointer: &str) -> f64 {
    value.pointer(pointer).and_then(Value::as_f64).unwrap_or_else(|| panic!("{pointer}: {value}"))
}

/// The notes and warnings of a report.
fn said(value: &Value) -> String {
    let lines = ["notes", "warnings"].map(|key| value[key].as_array().cloned().unwrap_or_default());
    lines.concat().iter().filter_map(Value::as_str).collect::<Vec<_>>().join("\n")
}

#[test]
fn every_output_is_whole_and_recorded_reads_the_weights() {
    let folder = sample();
    let at = |name: &str| folder.path().join(name);
    let (run, out, series) = (at("run.bvh"), at("w.csv"), at("s.csv"));
    let (plot, report) = (at("p.svg"), at("r.json"));
    let told = told(
        &["--for", "1min", "--window", "50:60", "--seed", "3"],
        &[
            ("", &run),
            ("--out", &out),
            ("--series", &series),
            ("--plot", &plot),
            ("--report", &report),
        ],
    );
    assert_eq!(std::fs::read_to_string(&report).unwrap(), format!("{told:#}\n"));
    assert_eq!((number(&told, "/frames"), number(&told, "/seconds")), (601.0, 60.0));
    assert!((13.0..18.0).contains(&number(&told, "/parts/0/workPerSecond")), "{told}");
    let weights = std::fs::read_to_string(&out).unwrap();
    assert_eq!(weights.lines().count(), 602);
    assert!(weights.starts_with("frame,time,browDownLeft,"), "{}", &weights[..80]);
    let rows = std::fs::read_to_string(&series).unwrap();
    assert_eq!(rows.lines().count(), 62);
    assert!(rows.starts_with("t,w,p,rcn,hr,vo2,breaths,kcal,epoc,fatigue,flush,sweat,borg\n"));
    assert!(std::fs::read_to_string(&plot).unwrap().starts_with("<svg "));

    let (head, face) = (at("head.glb"), at("face.csv"));
    let solved = ok(&[
        "solve",
        "--method",
        "recorded",
        "--avatar",
        &text(&head),
        "--mocap",
        &text(&out),
        "--out",
        &text(&face),
    ]);
    assert!(solved.contains("601 frames at 60.00 Hz, 24 of "), "{solved}");
}

#[test]
fn a_report_is_pages_and_the_skin_columns() {
    let folder = sample();
    let at = |name: &str| folder.path().join(name);
    let (run, out, pages) = (at("run.bvh"), at("w.csv"), at("report"));
    told(
        &["--for", "3min", "--window", "170:180", "--skin"],
        &[("", &run), ("--out", &out), ("--report", &pages)],
    );
    let weights = std::fs::read_to_string(&out).unwrap();
    let head: Vec<&str> = weights.lines().next().unwrap().split(',').collect();
    assert_eq!(head[head.len() - 3..], ["breath", "flush", "sweat"]);
    let html = std::fs::read_to_string(pages.join("report.html")).unwrap();
    for part in ["Whose is what", "Provenance", "cut at the end of its range", "<svg ", "EPOC"] {
        assert!(html.contains(part), "{part}");
    }
    let told: Value =
        serde_json::from_str(&std::fs::read_to_string(pages.join("results.json")).unwrap())
            .unwrap();
    assert!(html.contains(told["provenance"].as_str().unwrap()));
    // A folder of something else stays as it is.
    let other = at("other");
    std::fs::create_dir(&other).unwrap();
    std::fs::write(other.join("mine.txt"), "mine").unwrap();
    let said = refused(&exertion_args(&["--for", "20"], &[("", &run), ("--report", &other)]));
    assert!(said.contains("--report: ") && said.contains("something else than a report"), "{said}");
    assert_eq!(std::fs::read_to_string(other.join("mine.txt")).unwrap(), "mine");
}

#[test]
fn where_files_lie_changes_no_provenance_and_everything_else_does() {
    let folder = sample();
    let (run, moved) = (folder.path().join("run.bvh"), folder.path().join("moved.bvh"));
    std::fs::copy(&run, &moved).unwrap();
    let hash = |words: &[&str], file: &Path| {
        let told = told(words, &[("", file)]);
        told["provenance"].as_str().unwrap().to_owned()
    };
    let own = hash(&["--for", "20"], &run);
    assert_eq!(hash(&["--for", "20"], &moved), own);
    for other in [
        &["--for", "21"][..],
        &["--for", "20", "--level", "6"],
        &["--for", "20", "--seed", "1"],
        &["--for", "20", "--no-breath"],
        &["--for", "20", "--model", "linear"],
        &["--for", "20", "--heart", "steady"],
        &["--for", "20", "--lowpass", "8"],
        &["--for", "20", "--loads", "back=1"],
        &["--for", "20", "--expressivity", "eyes=0.5"],
        &["--for", "20", "--out-rate", "30"],
        &["--for", "20", "--window", "0:10"],
    ] {
        assert_ne!(hash(other, &run), own, "{other:?}");
    }
    assert_ne!(hash(&["--for", "20"], &folder.path().join("walk.bvh")), own);
}

#[test]
fn activities_of_every_format_give_work_and_heart() {
    let corpus = repository().join("fuzz/corpus/activity");
    for (name, from, heart) in [
        ("seed-fit-00", "power_w", "recorded"),
        ("seed-tcx-00", "power_w", "recorded"),
        ("seed-gpx-00", "speed", "recorded"),
        ("seed-activity-csv-01", "speed", "thesis"),
        ("seed-activity-csv-02", "work", "thesis"),
    ] {
        let told = told(&[], &[("", &corpus.join(name))]);
        let own = (told["parts"][0]["workFrom"].as_str(), told["heart"].as_str());
        assert_eq!(own, (Some(from), Some(heart)), "{name}");
        assert_eq!(number(&told, "/seconds"), 23.0, "{name}");
    }
    let ride = corpus.join("seed-fit-00");
    let law = told(&["--heart", "thesis"], &[("", &ride)]);
    let recorded = told(&["--heart", "recorded"], &[("", &ride)]);
    assert_eq!(number(&recorded, "/end/heartRate"), 113.0);
    assert!(number(&law, "/end/heartRate") < 100.0);
}

#[test]
fn a_plan_of_parts_keeps_their_order() {
    let folder = sample();
    let walk = folder.path().join("walk.bvh");
    let plan = format!("rest 30, {} 1min, work 40 30, rest 1min", walk.display());
    let series = folder.path().join("s.csv");
    let told = told(&["--plan", &plan, "--heart", "steady"], &[("--series", &series)]);
    assert_eq!(number(&told, "/seconds"), 180.0);
    assert_eq!(told["parts"].as_array().map(Vec::len), Some(4));
    let rows = std::fs::read_to_string(series).unwrap();
    let w: Vec<f64> =
        rows.lines().skip(1).map(|line| line.split(',').nth(1).unwrap().parse().unwrap()).collect();
    assert!(w[..31].iter().all(|w| *w == 0.0) && w[125..].iter().all(|w| *w == 0.0));
    assert!(w[35..90].iter().all(|w| (3.0..8.0).contains(w)), "{:?}", &w[35..90]);
    assert!(w[92..=120].iter().all(|w| (w - 40.0).abs() < 1e-9), "{:?}", &w[90..121]);
}

#[test]
fn jitter_a_wrong_rate_a_loop_and_a_strange_unit_are_told() {
    let folder = sample();
    let walk = folder.path().join("walk.bvh");
    let clean = told(&["--for", "1min"], &[("", &walk)]);
    assert!(said(&clean).contains("repeated 7.1 times: the work is repeated, not the motion"));
    assert!(!said(&clean).contains("jitters"), "{}", said(&clean));

    // Hips that jump up and down by a centimetre from frame to frame.
    let motion = std::fs::read_to_string(&walk).unwrap();
    let (hierarchy, frames) = motion.split_at(motion.find("MOTION").unwrap());
    let shaken: Vec<String> = frames
        .lines()
        .enumerate()
        .map(|(row, line)| {
            let mut words: Vec<String> = line.split(' ').map(str::to_owned).collect();
            if let (true, Ok(height)) = (row > 2, words.get(1).map_or("x", |w| w).parse::<f64>()) {
                words[1] = format!("{}", height + if row % 2 == 0 { 1.0 } else { -1.0 });
            }
            words.join(" ")
        })
        .collect();
    let jittery = folder.path().join("jittery.bvh");
    std::fs::write(&jittery, format!("{hierarchy}{}\n", shaken.join("\n"))).unwrap();
    let told_of = told(&["--for", "1min"], &[("", &jittery)]);
    assert!(
        said(&told_of).contains("the motion jitters: without the low-pass"),
        "{}",
        said(&told_of)
    );
    let ratio =
        number(&told_of, "/parts/0/workPerSecond") / number(&clean, "/parts/0/workPerSecond");
    assert!((0.9..1.1).contains(&ratio), "{ratio}");

    let slow = told(&["--rate", "15"], &[("", &walk)]);
    let ratio = number(&clean, "/parts/0/workPerSecond") / number(&slow, "/parts/0/workPerSecond");
    assert!(ratio > 8.0, "a quarter of the rate has a tenth of the work: {ratio}");
    let fast = told(&["--rate", "240"], &[("", &folder.path().join("sprint.bvh"))]);
    assert!(said(&fast).contains("more than 120 J/kg"), "{}", said(&fast));

    let child = folder.path().join("child.json");
    std::fs::write(&child, "{\"heightM\": 1.2}").unwrap();
    let small = told(&[], &[("", &walk), ("--person", &child)]);
    assert!(said(&small).contains("the person would be 1.75 m tall (--unit)"), "{}", said(&small));
    let own = told(&["--unit", "cm"], &[("", &walk)]);
    assert_eq!(number(&own, "/parts/0/metresPerUnit"), 0.01);
}

#[test]
fn joints_of_other_names_are_mapped() {
    let folder = sample();
    let motion = std::fs::read_to_string(folder.path().join("run.bvh")).unwrap();
    let other = folder.path().join("other.bvh");
    std::fs::write(&other, motion.replace("Left", "Gauche").replace("Right", "Droite")).unwrap();
    let said = refused(&exertion_args(&[], &[("", &other)]));
    assert!(said.contains("leftHip") && said.contains("with --joints MAP"), "{said}");
    let mut map = serde_json::Map::new();
    for (side, name) in [("left", "Gauche"), ("right", "Droite")] {
        for (joint, label) in [
            ("Hip", "UpLeg"),
            ("Knee", "Leg"),
            ("Ankle", "Foot"),
            ("Toe", "ToeBase"),
            ("Shoulder", "Arm"),
            ("Elbow", "ForeArm"),
            ("Wrist", "Hand"),
            ("HandEnd", "Hand_end"),
        ] {
            map.insert(format!("{side}{joint}"), format!("{name}{label}").into());
        }
    }
    map.insert("neck".to_owned(), "Neck".into());
    map.insert("headTop".to_owned(), "Head_end".into());
    let file = folder.path().join("map.json");
    std::fs::write(&file, Value::Object(map).to_string()).unwrap();
    let mapped = told(&[], &[("", &other), ("--joints", &file)]);
    let own = told(&[], &[("", &folder.path().join("run.bvh"))]);
    assert_eq!(mapped["weights_hash"], own["weights_hash"]);
}

#[test]
fn exertion_goes_onto_speech() {
    let folder = sample();
    let (run, speech, out) = (
        folder.path().join("run.bvh"),
        folder.path().join("speech.csv"),
        folder.path().join("both.csv"),
    );
    let rows: String =
        (0..61).map(|i| format!("{i},{},0.5,0.25,0.9\n", f64::from(i) / 30.0)).collect();
    std::fs::write(&speech, format!("frame,time,JawOpen,tongueOut,eyeSquintLeft\n{rows}")).unwrap();
    let alone = folder.path().join("alone.csv");
    ok(&exertion_args(&["--for", "1min", "--window", "58:60"], &[("", &run), ("--out", &alone)]));
    let paths: [(&str, &Path); 3] = [("", &run), ("--over", &speech), ("--out", &out)];
    ok(&exertion_args(&["--for", "1min"], &paths));
    let column = |file: &Path, name: &str| -> Vec<f64> {
        let text = std::fs::read_to_string(file).unwrap();
        let at = text.lines().next().unwrap().split(',').position(|own| own == name).unwrap();
        text.lines().skip(1).map(|row| row.split(',').nth(at).unwrap().parse().unwrap()).collect()
    };
    let (jaw, both) = (column(&alone, "jawOpen"), column(&out, "JawOpen"));
    assert_eq!(both.len(), 121);
    assert!(jaw.iter().zip(&both).all(|(jaw, both)| (jaw + 0.5 - both).abs() < 1e-12));
    assert!(column(&out, "tongueOut").iter().all(|weight| *weight == 0.25));
    assert!(column(&out, "eyeSquintLeft").iter().all(|weight| *weight == 1.0));
    std::fs::remove_file(&out).unwrap();
    let said = refused(&exertion_args(&["--for", "1min", "--window", "50:60"], &paths));
    assert!(said.contains("--over: 121 frames at 60 Hz, the window has 601; shorten"), "{said}");
    assert!(!out.exists());
}

#[test]
fn seeds_of_breath_are_repeatable() {
    let folder = sample();
    let run = folder.path().join("run.bvh");
    let hash = |words: &[&str]| {
        let mut all = vec!["--for", "1min"];
        all.extend(words);
        told(&all, &[("", &run)])["weights_hash"].as_str().unwrap().to_owned()
    };
    let own = hash(&["--seed", "5"]);
    assert_eq!(hash(&["--seed", "5"]), own);
    assert_ne!(hash(&["--seed", "6"]), own);
    assert_ne!(hash(&[]), own);
}
