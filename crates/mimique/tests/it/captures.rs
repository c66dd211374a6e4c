//! Captures as a researcher repairs, cuts and solves them: repair, segment, the bank's diagnosis, and
//! the two methods that need more than a bank.

use std::path::{Path, PathBuf};

use mimique_test_support::real_file;
use serde_json::Value;

use crate::support::{self, ok, refused, text};

/// The planted take of the real data.
fn planted(test: &str) -> Option<PathBuf> {
    real_file(test, "lsts")
}

/// Rows of a CSV, its header first.
fn rows(path: &Path) -> Vec<Vec<String>> {
    let csv = std::fs::read_to_string(path).expect("a CSV");
    let lines = csv.lines().filter(|line| !line.starts_with('#'));
    lines.map(|line| line.split(',').map(str::to_owned).collect()).collect()
}

fn write(path: &Path, rows: &[Vec<String>]) {
    let lines: Vec<String> = rows.iter().map(|row| row.join(",")).collect();
    std::fs::write(path, lines.join("\n") + "\n").expect("a CSV");
}

/// The first 800 frames, with labels swapped, a spike and a gap.
fn damaged(data: &Path, to: &Path) {
    let mut rows = rows(&data.join("take_n01.csv"));
    rows.truncate(801);
    let column = |rows: &[Vec<String>], name: &str| {
        rows[0].iter().position(|cell| cell == name).expect("a column")
    };
    for axis in ["x", "y", "z"] {
        let (a, b) = (column(&rows, &format!("M10_{axis}")), column(&rows, &format!("M20_{axis}")));
        for row in &mut rows[401..441] {
            row.swap(a, b);
        }
        let lost = column(&rows, &format!("M05_{axis}"));
        for row in &mut rows[201..206] {
            row[lost].clear();
        }
    }
    let spike = column(&rows, "M30_y");
    let value: f64 = rows[301][spike].parse().expect("a number");
    rows[301][spike] = (value + 40.0).to_string();
    write(to, &rows);
}

#[test]
fn repair_lists_what_it_mends_and_solve_knows_of_it() {
    let Some(data) = planted("repair_lists_what_it_mends_and_solve_knows_of_it") else { return };
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| text(&folder.path().join(name));
    damaged(&data, &folder.path().join("raw.csv"));
    let said = ok(&["repair", &at("raw.csv"), "--out", &at("repaired.csv"), "--json"]);
    let said: Value = serde_json::from_str(&said).expect("JSON");
    let list = said["record"].to_string();
    for label in ["M10", "M20", "M05", "M30"] {
        assert!(list.contains(label), "{label}: {list}");
    }
    // The gap is filled, the others are where they were before the damage, to a tenth of a millimetre.
    let (before, after) =
        (rows(&data.join("take_n01.csv")), rows(&folder.path().join("repaired.csv")));
    let place = |rows: &[Vec<String>], frame: usize, name: &str| -> f64 {
        let column = rows[0].iter().position(|cell| cell == name).expect("a column");
        rows[frame + 1][column].parse().expect("a number")
    };
    for (frame, name, most) in
        [(420, "M10_x", 0.1), (420, "M20_z", 0.1), (300, "M30_y", 1.0), (202, "M05_x", 1.0)]
    {
        let off = place(&before, frame, name) - place(&after, frame, name);
        assert!(off.abs() < most, "{name} in frame {frame}: off by {off} mm");
    }

    let solve = |take: &str| {
        let args = ["solve", "--avatar", &text(&data.join("avatar_skin.glb")), "--mocap", take];
        let map = text(&data.join("mapping.csv"));
        let out = at("weights.csv");
        let more = ["--markers", &map, "--method", "box", "--neutral", "0:60", "--out", &out];
        let all: Vec<&str> = args.into_iter().chain(more).chain(["--json"]).collect();
        serde_json::from_str::<Value>(&ok(&all)).expect("JSON")
    };
    let with = solve(&at("repaired.csv"));
    let sidecar = folder.path().join("repaired.csv.repair.json");
    let record = std::fs::read(&sidecar).expect("the sidecar");
    std::fs::remove_file(&sidecar).expect("removed");
    let without = solve(&at("repaired.csv"));
    let field = |said: &Value, key: &str| {
        let found = said.pointer(&format!("/{key}")).or(said.pointer(&format!("/report/{key}")));
        found.and_then(Value::as_str).expect("a hash").to_owned()
    };
    assert_eq!(field(&with, "weights_hash"), field(&without, "weights_hash"));
    assert_ne!(field(&with, "provenance"), field(&without, "provenance"), "the repair is in it");

    // A sidecar of another capture is refused.
    std::fs::write(&sidecar, record).expect("written");
    let mut changed = std::fs::read(folder.path().join("repaired.csv")).expect("the capture");
    changed.truncate(changed.len() / 2);
    let cut = changed.iter().rposition(|b| *b == b'\n').expect("a line");
    std::fs::write(folder.path().join("repaired.csv"), &changed[..=cut]).expect("written");
    let error = refused(&[
        "solve",
        "--avatar",
        &text(&data.join("avatar_skin.glb")),
        "--mocap",
        &at("repaired.csv"),
        "--markers",
        &text(&data.join("mapping.csv")),
        "--method",
        "box",
        "--out",
        &at("none.csv"),
    ]);
    assert!(error.contains("repaired.csv"), "{error}");
    assert!(!folder.path().join("none.csv").exists());
}

/// A frame that no face makes: nothing is written and the frame is named, or it is held and marked.
#[test]
fn a_frame_that_is_not_solved_refuses_the_take_or_is_held() {
    let Some(data) = planted("a_frame_that_is_not_solved_refuses_the_take_or_is_held") else {
        return;
    };
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| text(&folder.path().join(name));
    let mut take = rows(&data.join("take_n01.csv"));
    take.truncate(121);
    let column = take[0].iter().position(|cell| cell == "M05_y").expect("a column");
    let value: f64 = take[81][column].parse().expect("a number");
    take[81][column] = (value + 5000.0).to_string();
    let number: u64 = take[81][0].parse().expect("the frame's number");
    write(&folder.path().join("take.csv"), &take);
    let (avatar, map) = (text(&data.join("avatar_skin.glb")), text(&data.join("mapping.csv")));
    let (take, out, report) = (at("take.csv"), at("out.csv"), at("report.json"));
    let mut args = vec!["solve", "--avatar", &avatar, "--mocap", &take, "--markers", &map];
    args.extend(["--method", "nnls", "--neutral", "0:40", "--out", &out, "--report", &report]);
    let said = refused(&args);
    assert!(
        said.contains(&format!("frame {number}: ")) && said.contains("--unsolved hold"),
        "{said}"
    );
    assert!(!Path::new(&out).exists() && !Path::new(&report).exists(), "nothing is written");
    // A method within bounds solves the frame, but not without a word.
    let bounded: Vec<&str> = args.iter().map(|a| if *a == "nnls" { "box" } else { a }).collect();
    let said = ok(&bounded);
    assert!(said.contains(&format!("the worst is {number}, 7")), "{said}");
    args.extend(["--unsolved", "hold"]);
    let said = ok(&args);
    assert!(said.contains("note: ") && said.contains("take.csv: read as "), "{said}");
    let report = std::fs::read_to_string(report).expect("a report");
    let report: Value = serde_json::from_str(&report).expect("JSON");
    assert_eq!(report["summary"]["held"], serde_json::json!([1, 80]), "{}", report["summary"]);
    let weights = rows(Path::new(&out));
    let row = |frame: usize| -> Vec<f64> {
        weights[frame + 1][2..].iter().map(|cell| cell.parse().expect("a weight")).collect()
    };
    for ((held, before), after) in row(80).iter().zip(row(79)).zip(row(81)) {
        assert!(
            (held - (before + after) / 2.0).abs() < 1e-12,
            "{held} between {before} and {after}"
        );
    }
}

/// A folder of poses is an avatar like any other: for recorded weights, and in a study file.
#[test]
fn a_folder_of_poses_takes_recorded_weights_and_stands_in_a_study() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| text(&folder.path().join(name));
    let head = folder.path().join("head");
    std::fs::create_dir(&head).expect("a folder");
    for (name, lift) in [("neutral", 0.0), ("smile", 3.0), ("jawOpen", -5.0)] {
        let pose = format!("o Head\nv 0 0 0\nv 10 {lift} 0\nv 10 10 1\nv 0 10 0\nf 1 2 3 4\n");
        std::fs::write(head.join(format!("{name}.obj")), pose).expect("a pose");
    }
    let weights = "frame,time,jawOpen,smile\n0,0,0,0\n1,0.01,0.5,1\n";
    std::fs::write(folder.path().join("weights.csv"), weights).expect("weights");
    let solve = |head: &str| {
        let said = ok(&[
            "solve",
            "--method",
            "recorded",
            "--avatar",
            head,
            "--mocap",
            &at("weights.csv"),
            "--out",
            &at("out.csv"),
            "--json",
        ]);
        serde_json::from_str::<Value>(&said).expect("JSON")["provenance"].clone()
    };
    let before = solve(&at("head"));
    assert_eq!(rows(&folder.path().join("out.csv"))[2][2..], ["0.5", "1"]);
    // What the avatar is known by is what it holds.
    let pose = head.join("smile.obj");
    let other = std::fs::read_to_string(&pose).expect("a pose").replace("10 3 0", "10 4 0");
    std::fs::write(&pose, other).expect("a pose");
    assert_ne!(solve(&at("head")), before);

    let study = serde_json::json!({
        "id": "s", "studyMetadata": {"title": "t", "version": "1"}, "languages": ["en"],
        "components": {"i": {"type": "instructions", "text": {"en": "x"}}},
        "sequence": {"order": "fixed", "components": ["i"]},
        "stimuli": {"avatars": {"mine": {"file": "head"}, "none": {"file": "nothing"}}},
    });
    std::fs::write(folder.path().join("study.json"), study.to_string()).expect("a study");
    let said = support::mimique(&["check", &at("study.json")]);
    let said = String::from_utf8_lossy(&said.stdout).into_owned();
    assert!(said.contains("/stimuli/avatars/none"), "{said}");
    assert!(!said.contains("/stimuli/avatars/mine/file"), "{said}");
}

#[test]
fn segments_go_to_csv_and_elan_and_back() {
    let Some(data) = planted("segments_go_to_csv_and_elan_and_back") else { return };
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| text(&folder.path().join(name));
    // The truth has no times: 200 Hz.
    let truth = text(&data.join("truth.csv"));
    let rate = ["--mocap-rate", "200"];
    let run = |more: &[&str]| ok(&[&["segment", &truth], more, &rate].concat());
    run(&["--out", &at("a.csv")]);
    let found = rows(&folder.path().join("a.csv"));
    let planted = rows(&data.join("segments.csv"));
    let expressions = planted[1..].iter().filter(|row| row[0] != "N").count();
    assert_eq!(found.len() - 1, expressions, "{found:?}");
    run(&["--from", &at("a.csv"), "--lead-in", "0", "--lead-out", "0", "--out", &at("b.eaf")]);
    assert!(std::fs::read_to_string(at("b.eaf")).expect("ELAN").contains("<ANNOTATION_DOCUMENT"));
    run(&["--from", &at("b.eaf"), "--lead-in", "0", "--lead-out", "0", "--out", &at("c.csv")]);
    run(&["--from", &at("a.csv"), "--lead-in", "0", "--lead-out", "0", "--out", &at("d.csv")]);
    assert_eq!(rows(&folder.path().join("c.csv")), rows(&folder.path().join("d.csv")));
    std::fs::write(at("bad.eaf"), "<ANNOTATION_DOCUMENT>").expect("written");
    let args = ["segment", &truth, "--from", &at("bad.eaf"), "--out", &at("e.csv")];
    let error = refused(&[&args[..], &rate].concat());
    assert!(error.contains("bad.eaf: byte 21"), "{error}");
    assert!(!folder.path().join("e.csv").exists());
}

/// Three shapes that open and close, four times, at 100 Hz.
fn weights_of_four_expressions(to: &Path) {
    let mut csv = String::from("frame,time,a,b,c\n");
    for frame in 0..1000_u32 {
        let (t, which) = (f64::from(frame % 250) / 100.0, frame / 250);
        // From 0.75 s to 1.75 s of each 2.5 s.
        let bump = (std::f64::consts::PI * (t - 0.75).clamp(0.0, 1.0)).sin().powi(2);
        let w: Vec<f64> = (0..3).map(|k| if k == which % 3 { bump } else { 0.0 }).collect();
        csv.push_str(&format!("{frame},{},{},{},{}\n", f64::from(frame) / 100.0, w[0], w[1], w[2]));
    }
    std::fs::write(to, csv).expect("weights");
}

#[test]
fn segments_pasted_into_a_study_file_pass_its_check() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| text(&folder.path().join(name));
    weights_of_four_expressions(&folder.path().join("weights.csv"));
    let labels = ["--labels", "joy,fear,joy,dégoût"];
    let more = ["--study", "jaw", "--out", &at("segments.csv")];
    let printed = ok(&[&["segment", &at("weights.csv")], &labels[..], &more].concat());
    let segments: Value = serde_json::from_str(&printed).expect("JSON and nothing else");
    let field = |name: &str| -> Vec<&str> {
        segments.as_array().expect("a list").iter().filter_map(|s| s[name].as_str()).collect()
    };
    assert_eq!(field("id"), ["joy", "fear", "joy-2", "degout"]);
    assert_eq!(field("capture"), ["jaw"; 4]);
    // The frames are the clips of the table, which the same run wrote.
    let table = rows(&folder.path().join("segments.csv"));
    for (row, segment) in table[1..].iter().zip(segments.as_array().expect("a list")) {
        assert_eq!(row[0], segment["factors"]["expression"].as_str().expect("a label"));
        assert_eq!(row[1], segment["first"].to_string());
        assert_eq!(
            row[2].parse::<u64>().expect("a frame") + 1,
            segment["end"].as_u64().expect("one")
        );
    }

    // Pasted into a study of the repository, in the place of its own segments.
    let study = concat!(env!("CARGO_MANIFEST_DIR"), "/../../study-config/animface.json");
    let study = std::fs::read_to_string(study).expect("the study");
    let (before, rest) = study.split_once("\"segments\": [").expect("segments");
    let (_, after) = rest.split_once("],\n    \"methods\"").expect("methods");
    let study = format!("{before}\"segments\": {printed},\n    \"methods\"{after}")
        .replace("\"truth\": \"movement\"", "\"truth\": \"expression\"")
        .replace("\"factor\": \"movement\"", "\"factor\": \"expression\"")
        .replace("\"value\": \"jaw-open\"", "\"value\": \"joy\"")
        .replace("\"value\": \"jaw-aside\"", "\"value\": \"fear\"")
        .replace("\"value\": \"smile\"", "\"value\": \"dégoût\"")
        .replace("${MIMIQUE_DATA}/", "");
    let files =
        ["ict-facekit/ict-facekit.glb", "animface/JawMoCap.c3d", "animface/CheeksMoCap.c3d"];
    for file in files.into_iter().chain(["animface/markers-ict-facekit.json"]) {
        let file = folder.path().join(file);
        std::fs::create_dir_all(file.parent().expect("a folder")).expect("a folder");
        std::fs::write(file, "").expect("a file that is there");
    }
    let file = folder.path().join("study.json");
    std::fs::write(&file, &study).expect("the study");
    let checked = support::mimique(&["check", &text(&file), "--without-clips", "--json"]);
    let said: Value = serde_json::from_slice(&checked.stdout).expect("JSON");
    // The files hold nothing, which is all that is wrong: nothing is wrong with the segments themselves.
    let issues = said["issues"].as_array().expect("a list");
    let errors: Vec<&Value> = issues.iter().filter(|issue| issue["severity"] == "error").collect();
    let of_a_file = |issue: &&Value| {
        let pointer = issue["pointer"].as_str().expect("a place");
        pointer.starts_with("/stimuli/avatars") || pointer.starts_with("/stimuli/captures")
    };
    assert!(!errors.is_empty() && errors.iter().all(of_a_file), "{said}");
    // The check does look at them: a clip without frames is an error.
    std::fs::write(&file, study.replacen("\"end\"", "\"beyond\"", 1)).expect("the study");
    assert_ne!(support::mimique(&["check", &text(&file)]).status.code(), Some(0));

    let error = refused(&["segment", &at("weights.csv"), "--study", "two words"]);
    assert!(error.contains("--study: \"two words\" is no identifier"), "{error}");
}

#[test]
fn the_bank_is_held_against_the_five_rules() {
    let Some(data) = planted("the_bank_is_held_against_the_five_rules") else { return };
    let avatar = text(&data.join("avatar_skin.glb"));
    let map = text(&data.join("mapping.csv"));
    let said = ok(&["inspect", &avatar, "--bank", "--markers", &map]);
    assert!(said.contains("53") && said.contains("40"), "{said}");
    let json: Value =
        serde_json::from_str(&ok(&["inspect", &avatar, "--bank", "--markers", &map, "--json"]))
            .expect("JSON");
    let flat = json.to_string();
    for key in ["rank", "dependent", "dead"] {
        assert!(flat.contains(key), "{key}: {flat}");
    }
}

#[test]
fn a_surface_is_moved_and_a_regression_learns() {
    let Some(data) = planted("a_surface_is_moved_and_a_regression_learns") else { return };
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| text(&folder.path().join(name));
    let mut take = rows(&data.join("take_n01.csv"));
    take.truncate(401);
    write(&folder.path().join("take.csv"), &take);
    let mut weights = rows(&data.join("truth.csv"));
    weights.truncate(401);
    write(&folder.path().join("weights.csv"), &weights);
    let avatar = text(&data.join("avatar_skin.glb"));
    let map = text(&data.join("mapping.csv"));
    let common = |out: &str, method: &str| -> Vec<String> {
        let list = [
            "solve",
            "--avatar",
            &avatar,
            "--mocap",
            &at("take.csv"),
            "--markers",
            &map,
            "--neutral",
            "0:60",
            "--method",
            method,
            "--out",
            out,
        ];
        list.map(str::to_owned).to_vec()
    };
    let mut surface = common(&at("surface.csv"), "thin-shell-surface");
    surface.extend(["--vertices".to_owned(), at("vertices.npy")]);
    ok(&surface);
    let found = rows(&folder.path().join("surface.csv"));
    assert_eq!((found.len(), found[0].len()), (401, 2 + 3 * 40));
    let npy = std::fs::read(at("vertices.npy")).expect("vertices");
    assert!(npy.starts_with(b"\x93NUMPY"));

    let mut learnt = common(&at("learnt.csv"), "regression");
    let known = ["--training", &at("take.csv"), "--training-weights", &at("weights.csv")];
    learnt.extend(known.map(str::to_owned));
    learnt.extend(["--training-neutral", "0:60"].map(str::to_owned));
    ok(&learnt);
    let found = rows(&folder.path().join("learnt.csv"));
    assert_eq!(found.len(), 401);
    // What it was taught it says again.
    let number = |cell: &String| -> f64 { cell.parse().expect("a number") };
    let mut square = 0.0;
    let mut count = 0;
    for (row, truth) in found[1..].iter().zip(&weights[1..]) {
        for (name, cell) in found[0].iter().zip(row).skip(2) {
            let Some(column) = weights[0].iter().position(|other| other == name) else { continue };
            square += (number(cell) - number(&truth[column])).powi(2);
            count += 1;
        }
    }
    let rms = (square / f64::from(count)).sqrt();
    assert!(count > 400 * 40 && rms < 0.02, "rms {rms} of {count} weights");
    let error = refused(&common(&at("none.csv"), "regression"));
    assert!(error.contains("--training"), "{error}");
}
