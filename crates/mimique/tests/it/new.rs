//! `mimique new`: every design and instrument gives a study that `check`, `simulate` and `analyze` take as it is; what
//! cannot be is refused, and then nothing is there.

use std::io::Write as _;
use std::path::Path;
use std::process::{Command, Stdio};

use serde_json::Value;

use crate::support::{ok, refused, sample, text};

const DESIGNS: [&str; 7] =
    ["rate-one", "compare-two", "all-pairs", "identify-emotion", "study1", "study2a", "study2b"];

fn study(folder: &Path) -> Value {
    let text = std::fs::read_to_string(folder.join("study.json")).unwrap();
    mimique_study::parse(&text).unwrap()
}

/// Checks, simulates and analyses a new study.
fn goes_all_the_way(folder: &Path) {
    let file = text(&folder.join("study.json"));
    let said = ok(&["check", "--without-clips", &file]);
    // A capture of one's own may gain by a smoothed adaptation, which is advice.
    let warnings = said.lines().filter(|line| line.starts_with("warning: "));
    assert!(warnings.clone().all(|line| line.contains("rbfSmoothing")), "{said}");
    assert!(said.contains("no errors, "), "{said}");
    let out = folder.join("simulated");
    ok(&["simulate", &file, "--participants", "8", "--seed", "1", "--out", &text(&out)]);
    let id = study(folder)["id"].as_str().unwrap().to_owned();
    let answers = text(&out.join(format!("{id}_responses.csv")));
    let report = folder.join("report");
    ok(&["analyze", &answers, "--study", &file, "--out", &text(&report)]);
    assert!(report.join("report.html").is_file());
}

#[test]
fn every_design_goes_all_the_way_in_both_languages() {
    let place = tempfile::tempdir().unwrap();
    for design in DESIGNS {
        let folder = place.path().join(format!("my-{design}"));
        ok(&["new", &text(&folder), "--design", design, "--languages", "fr,en"]);
        assert_eq!(study(&folder)["id"], format!("my-{design}"));
        assert_eq!(study(&folder)["languages"], serde_json::json!(["fr", "en"]));
        goes_all_the_way(&folder);
    }
    // In one language no other is left.
    for design in ["identify-emotion", "compare-two"] {
        let folder = place.path().join(format!("one-{design}"));
        ok(&["new", &text(&folder), "--design", design, "--title", "A title of mine"]);
        let said = ok(&["check", "--without-clips", &text(&folder.join("study.json"))]);
        assert!(said.contains("no errors, 0 warnings") && said.contains("language en"), "{said}");
        assert_eq!(study(&folder)["studyMetadata"]["title"]["en"], "A title of mine");
        assert!(!study(&folder).to_string().contains("\"fr\""), "{design}");
    }
    let listed: Value = serde_json::from_str(&ok(&["new", "--list", "--json"])).unwrap();
    let names: Vec<&Value> =
        listed["designs"].as_array().unwrap().iter().map(|design| &design["name"]).collect();
    assert_eq!(names, DESIGNS);
}

#[test]
fn every_instrument_goes_all_the_way_and_is_cited_in_the_folder() {
    let place = tempfile::tempdir().unwrap();
    let listed: Value = serde_json::from_str(&ok(&["new", "--list", "--json"])).unwrap();
    let instruments = listed["instruments"].as_array().unwrap();
    assert!(instruments.len() >= 4, "{instruments:?}");
    let names: Vec<&str> = instruments.iter().map(|own| own["name"].as_str().unwrap()).collect();
    let folder = place.path().join("all");
    let (there, all) = (text(&folder), names.join(","));
    let options = ["--design", "rate-one", "--languages", "en,fr", "--instrument", &all];
    ok(&[&["new", &there][..], &options].concat());
    let readme = std::fs::read_to_string(folder.join("README.md")).unwrap();
    for own in instruments {
        for key in ["about", "citation", "licence", "scoring"] {
            assert!(readme.contains(own[key].as_str().unwrap()), "{key} of {own}");
        }
    }
    assert!(readme.contains("not validated"), "translations are called what they are");
    goes_all_the_way(&folder);
    let study = study(&folder);
    let components = study["sequence"]["components"].as_array().unwrap();
    assert_eq!(components[1..], ["sus", "nasa-tlx", "closeness"]);
    assert_eq!(study["components"]["faces"]["questions"][1], "affect");
    assert_eq!(study["scales"]["sus"]["reversed"].as_array().unwrap().len(), 5);
    let alpha = std::fs::read_to_string(folder.join("report/results.json")).unwrap();
    assert!(alpha.contains("\"sus\"") && alpha.contains("\"tlx\""), "the scales are in the report");

    // One of one's own, in the same form; what is asked of one clip does not go with two.
    let own = place.path().join("calm.json");
    let calm = r#"{"name": "Calm", "asked": "clip", "citation": "Nobody (2026).", "licence": "Ours.",
        "scoring": "The answer.", "questions": [{"id": "calm", "type": "likert", "numItems": 5, "start": 1,
        "prompt": {"en": "How calm?"}, "leftLabel": {"en": "not"}, "rightLabel": {"en": "very"}}]}"#;
    std::fs::write(&own, calm).unwrap();
    let folder = place.path().join("own");
    let (there, own) = (text(&folder), text(&own));
    let with = |design: &'static str| -> Vec<String> {
        ["new", &there, "--design", design, "--instrument", &own].map(str::to_owned).to_vec()
    };
    let err = refused(&with("all-pairs"));
    assert!(err.contains("calm") && err.contains("rate-one") && !folder.exists(), "{err}");
    ok(&with("identify-emotion"));
    goes_all_the_way(&folder);
}

#[test]
fn a_capture_of_ones_own_becomes_a_study_with_its_files() {
    let files = sample();
    let place = tempfile::tempdir().unwrap();
    let at = |name: &str| text(&files.path().join(name));
    let folder = place.path().join("mine");
    let mut options = vec!["new".to_owned(), text(&folder)];
    for (option, value) in [
        ("--design", "identify-emotion".to_owned()),
        ("--avatar", at("head.glb")),
        ("--capture", at("take.c3d")),
        ("--map", at("markers.json")),
        ("--cut", "100:160:anger".to_owned()),
        ("--cut", "300:360:disgust".to_owned()),
    ] {
        options.extend([option.to_owned(), value]);
    }
    let said = ok(&options);
    assert!(said.contains("mine/stimuli/take.c3d") && said.contains("mimique check"), "{said}");
    assert_eq!(
        std::fs::read(folder.join("stimuli/take.c3d")).unwrap(),
        std::fs::read(files.path().join("take.c3d")).unwrap()
    );
    let own = study(&folder);
    assert_eq!(own["questions"][0]["options"][1]["value"], "disgust");
    assert!(own["stimuli"]["captures"]["take"]["head"].as_array().unwrap().len() >= 3);
    ok(&["check", &text(&folder.join("study.json"))]);
    goes_all_the_way(&folder);

    // Again: it is there. Files that stay where they are; methods of one's own; no map: one is suggested.
    let err = refused(&options);
    assert!(err.contains("mine: it is there already"), "{err}");
    let other = place.path().join("other");
    options[1] = text(&other);
    let map = options.iter().position(|option| option == "--map").unwrap();
    options.drain(map..map + 2);
    options.extend(["--reference".to_owned(), "--method".to_owned(), "lsts,box,ridge".to_owned()]);
    let said = ok(&options);
    assert!(said.contains("note: stimuli/markers.json: suggested"), "{said}");
    let own = study(&other);
    assert_eq!(own["stimuli"]["captures"]["take"]["file"], at("take.c3d"));
    assert_eq!(own["hypotheses"][1]["test"], "friedman");
    // Two cuts of one take tell nothing of other clips.
    assert_eq!(own["hypotheses"][1]["generalise"], "these clips");
    let map = std::fs::read_to_string(other.join("stimuli/markers.json")).unwrap();
    assert!(map.contains("\"suggested\""), "{map}");

    // What is wrong is said as check says it, and nothing is there.
    let gone = place.path().join("gone");
    options[1] = text(&gone);
    options.extend(["--cut".to_owned(), "300:9999999:joy".to_owned()]);
    let err = refused(&options);
    assert!(err.contains("/stimuli/segments/2: frames 300:9999999 of "), "{err}");
    assert!(err.contains("nothing was written") && !gone.exists(), "{err}");
    let left = std::fs::read_dir(place.path()).unwrap().count();
    assert_eq!(left, 2, "nothing is left over beside the two folders");
}

#[test]
fn what_cannot_be_is_refused_with_a_remedy() {
    let place = tempfile::tempdir().unwrap();
    let folder = text(&place.path().join("study"));
    for (options, says) in [
        (vec!["--design", "rate-two"], "no design \"rate-two\"; take one of rate-one"),
        (vec!["--design", "rate-one", "--instrument", "godspeed"], "bartneck.de"),
        (vec!["--design", "rate-one", "--instrument", "mood"], "take one of sus"),
        (vec!["--design", "rate-one", "--instrument", "absent.json"], "absent.json: open"),
        (vec!["--design", "rate-one", "--avatar", "head.glb"], "head.glb: there is no such file"),
        (vec!["--design", "rate-one", "--capture", "take.c3d"], "--avatar head.glb"),
        (vec!["--design", "rate-one", "--cut", "1:9:joy"], "--cut: it belongs to a capture"),
        (vec!["--design", "rate-one", "--cut", "9:1:joy"], "330:570:jaw-open"),
        (vec!["--design", "study1", "--method", "box"], "has its own performances"),
        (vec!["--design", "rate-one", "--method", "magic"], "/stimuli/methods/magic"),
        (vec!["--design", "rate-one", "--instrument", "sus,sus"], "sus"),
    ] {
        let err = refused(&[&["new", &folder][..], &options].concat());
        assert!(err.contains(says), "{options:?}: {err}");
        assert!(!Path::new(&folder).exists(), "{options:?}");
    }
    assert_eq!(std::fs::read_dir(place.path()).unwrap().count(), 0);
}

/// Runs `mimique new` with answers on standard input: exit code, output, what was asked.
fn asked(args: &[&str], answers: &str) -> (Option<i32>, String, String) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_mimique"));
    let piped = command.arg("new").args(args).stdin(Stdio::piped());
    let mut child = piped.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    child.stdin.take().unwrap().write_all(answers.as_bytes()).unwrap();
    let out = child.wait_with_output().unwrap();
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
    (out.status.code(), text(out.stdout), text(out.stderr))
}

#[test]
fn without_a_design_everything_is_asked() {
    let files = sample();
    let place = tempfile::tempdir().unwrap();
    let folder = place.path().join("asked");
    let at = |name: &str| text(&files.path().join(name));
    // A number that is none is asked again, and so are frames.
    let answers = [
        "9",
        "1",
        "",
        "en,fr",
        "sus",
        &at("head.glb"),
        &at("take.c3d"),
        &at("markers.json"),
        "",
        "60",
        "0:60",
        "100:160",
        "100:160:anger",
        "300:360:disgust",
        "",
        "",
    ]
    .join("\n");
    let (code, out, questions) = asked(&[&text(&folder)], &answers);
    assert_eq!(code, Some(0), "{questions}");
    assert!(out.contains("asked/study.json"), "{out}");
    assert!(questions.contains("\"9\": none of these"), "{questions}");
    assert!(questions.contains("\"60\": give the first frame"), "{questions}");
    let own = study(&folder);
    assert_eq!(own["languages"], serde_json::json!(["en", "fr"]));
    assert_eq!(own["stimuli"]["captures"]["take"]["neutral"], serde_json::json!([0, 60]));
    assert_eq!(own["stimuli"]["segments"].as_array().unwrap().len(), 2);
    goes_all_the_way(&folder);

    // Where the answers end, nothing is written.
    let folder = place.path().join("cut-short");
    let (code, _, questions) = asked(&[&text(&folder)], "1\n");
    assert_eq!(code, Some(2), "{questions}");
    assert!(
        questions.contains("error: ") && questions.contains("there is no answer"),
        "{questions}"
    );
    assert!(!folder.exists());
}
