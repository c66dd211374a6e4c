//! `mimique capsule`: what is in it, what stays out, the same bytes each time, and what is refused.

use std::collections::BTreeMap;
use std::io::{Cursor, Read as _};
use std::path::{Path, PathBuf};

use serde_json::{Value, json};
use sha2::{Digest as _, Sha256};

use crate::support::{mimique, ok, refused, text};

/// A small study of the built-in head, with a question that people answer in their own words.
fn study(folder: &Path) -> PathBuf {
    let text = |words: &str| json!({ "en": words, "fr": words });
    let study = json!({
        "id": "shared",
        "studyMetadata": { "title": text("Faces"), "version": "1" },
        "languages": ["en", "fr"],
        "contact": {
            "investigator": { "name": "A", "email": "a@example.org" },
            "ethicsBoard": { "name": "B", "email": "b@example.org" },
        },
        "recruitment": { "completionCode": "SECRETCODE", "urlParameters": ["PROLIFIC_PID"] },
        "consent": {
            "version": "1", "minimumAge": 18, "retention": text("One year."),
            "sections": [{ "heading": text("What"), "text": text("Watch.") }],
        },
        "demographics": { "questions": [{ "id": "job", "type": "shortText", "prompt": text("Your job?") }] },
        "questions": [
            { "id": "strong", "type": "likert", "prompt": text("How strong?"), "numItems": 7,
              "leftLabel": text("weak"), "rightLabel": text("strong") },
            { "id": "why", "type": "longText", "prompt": text("Why?") },
        ],
        "components": { "faces": { "type": "trials", "questions": ["strong", "why"] } },
        "sequence": { "order": "random", "components": ["faces"] },
        "stimuli": {
            "avatars": { "head": { "builtin": { "seed": 1 } } },
            "captures": { "actor": { "builtin": { "actor": 7 } } },
            "segments": [{ "id": "joy2", "capture": "actor", "performance": { "expression": "joy", "intensity": 2 } }],
            "methods": { "box": { "method": "box" }, "real": { "method": "lsts" } },
        },
        "hypotheses": [{
            "id": "H1", "statement": text("The methods differ."), "test": "wilcoxon", "response": "strong",
            "factors": ["method"], "levels": ["box", "real"],
        }],
    });
    let path = folder.join("shared.json");
    std::fs::write(&path, study.to_string()).unwrap();
    path
}

/// The two exports of simulated people; a tenth column of identifiers stands behind the others, and a person withdraws.
struct Exports {
    study: PathBuf,
    csv: PathBuf,
    events: PathBuf,
    packs: PathBuf,
}

fn exports(folder: &Path) -> Exports {
    let study = study(folder);
    for format in ["csv", "events"] {
        let out = text(folder);
        ok(&[
            "simulate",
            &text(&study),
            "-n",
            "12",
            "--seed",
            "5",
            "--format",
            format,
            "--out",
            &out,
        ]);
    }
    let csv = folder.join("shared_responses.csv");
    let events = folder.join("shared_events.jsonl");
    let lines = std::fs::read_to_string(&csv).unwrap();
    let with_identifiers = lines.lines().enumerate().map(|(k, line)| match k {
        0 => format!("{line},PROLIFIC_PID\n"),
        _ => format!("{line},5f0secret\n"),
    });
    std::fs::write(&csv, with_identifiers.collect::<String>()).unwrap();
    Exports { study, csv, events, packs: folder.join("packs") }
}

fn args(exports: &Exports, out: &Path) -> Vec<String> {
    let Exports { study, csv, events, packs } = exports;
    let mut args = vec!["capsule".to_owned(), text(study), text(csv)];
    for (option, path) in [("--events", events.as_path()), ("--packs", packs), ("--out", out)] {
        args.extend([option.to_owned(), text(path)]);
    }
    args
}

fn files(archive: &Path) -> BTreeMap<String, Vec<u8>> {
    let bytes = std::fs::read(archive).unwrap();
    let mut archive = zip::ZipArchive::new(Cursor::new(bytes)).unwrap();
    let all = 0..archive.len();
    all.map(|place| {
        let mut file = archive.by_index(place).unwrap();
        let mut bytes = Vec::new();
        file.read_to_end(&mut bytes).unwrap();
        let path = file.name().unwrap().into_owned();
        let name = path.strip_prefix("capsule-shared/").expect("below one folder");
        (name.to_owned(), bytes)
    })
    .collect()
}

/// What a script of the capsule hands over, as JSON.
fn handed_over(files: &BTreeMap<String, Vec<u8>>, name: &str) -> Value {
    let script = String::from_utf8(files[&format!("files/{name}.js")].clone()).unwrap();
    let call = script.strip_prefix("capsule.text(").unwrap().strip_suffix(");\n").unwrap();
    let arguments: Vec<String> = serde_json::from_str(&format!("[{call}]")).unwrap();
    assert_eq!(arguments[0], name);
    serde_json::from_str(&arguments[2]).unwrap()
}

fn count(csv: &[u8]) -> usize {
    csv::Reader::from_reader(csv).records().count()
}

#[test]
fn a_capsule_holds_study_stimuli_answers_frames_and_report_and_nothing_personal() {
    let folder = tempfile::tempdir().unwrap();
    let exports = exports(folder.path());
    // A person withdraws; of another the events are erased between the two exports.
    let lines = std::fs::read_to_string(&exports.events).unwrap();
    let kept = lines.lines().filter(|line| !line.contains(r#""participant_id":"p0004""#));
    let mut kept: Vec<String> = kept.map(str::to_owned).collect();
    let of = |line: &str| line.contains(r#""participant_id":"p0003""#);
    let last = kept.iter().rposition(|line| of(line)).expect("p0003 has events");
    let mut withdrawal: Value = serde_json::from_str(&kept[last]).unwrap();
    withdrawal["body"] = json!({ "type": "withdrawn" });
    withdrawal["sequence"] = json!(withdrawal["sequence"].as_u64().unwrap() + 1);
    kept.insert(last + 1, withdrawal.to_string());
    std::fs::write(&exports.events, kept.join("\n") + "\n").unwrap();

    let out = folder.path().join("shared.zip");
    let told = ok(&args(&exports, &out));
    for said in [
        "Not in it: 1 person who withdrew.",
        "of whom only one of the two exports knows",
        "Not in it: what people wrote in their own words (job, why).",
        "Not in it: identifiers of recruitment (PROLIFIC_PID).",
    ] {
        assert!(told.contains(said), "{said}\n{told}");
    }
    let files = files(&out);
    for name in [
        "index.html",
        "take-part.html",
        "FORMATS.md",
        "study.json",
        "data/responses.csv",
        "data/stimuli.csv",
        "report/report.html",
        "report/results.json",
        "files/plays/p0001.json.js",
        "formats/avatar/entropy.rs",
        "data/weights/joy2.box.csv",
    ] {
        assert!(files.contains_key(name), "{name} of {:?}", files.keys());
    }
    let all = files
        .iter()
        .filter(|(name, _)| !name.starts_with("files/assets") && !name.starts_with("files/packs"));
    for (name, bytes) in all {
        let held = String::from_utf8_lossy(bytes);
        for secret in ["SECRETCODE", "5f0secret", "simulated answer", "p0003", "p0004"] {
            assert!(!held.contains(secret), "{name} holds {secret}");
        }
    }
    let csv = &files["data/responses.csv"];
    let exported = std::fs::read(&exports.csv).unwrap();
    assert!(count(csv) > 20 && count(csv) < count(&exported));
    assert_eq!(handed_over(&files, "study.json")["id"], "shared");
    assert!(handed_over(&files, "study.json").get("recruitment").is_none());

    // Every trial that the reader lists has its plays, with frames, and clips that are there.
    let trials = handed_over(&files, "trials.json");
    let site = handed_over(&files, "site.json");
    assert_eq!((&site["codes"], &site["hosting"]["download"]), (&json!({}), &json!(false)));
    let trials = trials["trials"].as_array().unwrap();
    assert!(trials.len() >= 10);
    for trial in trials.iter().filter(|trial| trial["plays"] != 0) {
        let person = trial["participant"].as_str().unwrap();
        let pages = handed_over(&files, &format!("plays/{person}.json"));
        let plays = &pages["pages"][trial["step"].as_str().unwrap()]["plays"];
        assert_eq!(plays.as_array().unwrap().len() as u64, trial["plays"].as_u64().unwrap());
        assert!(plays[0]["frames"].as_array().unwrap().len() > 30, "{plays}");
        assert_eq!(plays[0]["clips"][0]["clip"], trial["stimulus"]);
    }
    // Packs are there under their hashes, and the weights as numbers have the hash of the clip.
    for (clip, source) in site["bundle"]["clips"].as_object().unwrap() {
        for pack in ["avatar", "operators", "take"] {
            let name = format!("files/packs/{}.js", source[pack].as_str().unwrap());
            assert!(files.contains_key(&name), "{clip}: {name}");
        }
        let mut hash = Sha256::new();
        let mut reader = csv::Reader::from_reader(&files[&format!("data/weights/{clip}.csv")][..]);
        for row in reader.records() {
            for weight in row.unwrap().iter().skip(1) {
                hash.update(weight.parse::<f64>().unwrap().to_le_bytes());
            }
        }
        let found = hash.finalize().iter().map(|byte| format!("{byte:02x}")).collect::<String>();
        assert_eq!(found, source["weights_hash"].as_str().unwrap(), "{clip}");
    }
    // The report is the one that `analyze` writes of the same files.
    let unpacked = folder.path().join("unpacked");
    std::fs::create_dir(&unpacked).unwrap();
    for name in ["data/responses.csv", "study.json", "data/stimuli.csv"] {
        std::fs::write(unpacked.join(name.rsplit('/').next().unwrap()), &files[name]).unwrap();
    }
    let path = |name: &str| text(&unpacked.join(name));
    ok(&[
        "analyze",
        &path("responses.csv"),
        "--study",
        &path("study.json"),
        "--stimuli",
        &path("stimuli.csv"),
        "--out",
        &path("report"),
    ]);
    let results = std::fs::read(unpacked.join("report/results.json")).unwrap();
    assert_eq!(results, files["report/results.json"]);
    // Texts stay where that is asked for.
    let mut more = args(&exports, &out);
    more.push("--keep-texts".to_owned());
    ok(&more);
    let kept = self::files(&out);
    assert!(String::from_utf8_lossy(&kept["data/responses.csv"]).contains("simulated answer"));
}

#[test]
fn the_same_input_gives_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let exports = exports(folder.path());
    let out = ["one.zip", "other.zip"].map(|name| folder.path().join(name));
    for out in &out {
        ok(&args(&exports, out));
    }
    let [one, other] = out.map(|path| std::fs::read(path).unwrap());
    assert!(one == other, "{} and {} bytes", one.len(), other.len());
}

#[test]
fn what_cannot_be_made_into_one_is_refused_and_nothing_is_written() {
    let folder = tempfile::tempdir().unwrap();
    let exports = exports(folder.path());
    let out = folder.path().join("out.zip");
    let good = args(&exports, &out);
    let with = |place: usize, value: &str| {
        let mut args = good.clone();
        args[place] = value.to_owned();
        args
    };
    let broken = folder.path().join("broken.jsonl");
    std::fs::write(&broken, "{\"participant_id\": \"p0001\"}\n").unwrap();
    let nobody = folder.path().join("nobody.jsonl");
    std::fs::write(&nobody, "").unwrap();
    let wide = folder.path().join("wide.csv");
    std::fs::write(&wide, "participant_id,a\np0001,1\n").unwrap();
    for (args, said) in [
        (
            with(8, &text(&folder.path().join("out.tar"))),
            "out.tar: a capsule is a ZIP archive; give --out a name",
        ),
        (with(2, &text(&folder.path().join("absent.csv"))), "absent.csv: cannot be read"),
        (
            with(2, &text(&wide)),
            "wide.csv: line 1: there is no column status; give the tidy export",
        ),
        (with(4, &text(&broken)), "broken.jsonl: line 1: missing field `sequence`"),
        (with(4, &text(&nobody)), "no row is left of people who are in both exports"),
    ] {
        let error = refused(&args);
        assert!(error.contains(said), "{said}\n{error}");
    }
    assert!(!out.exists());
    // Whoever has no events, has no capsule either: the option must be there.
    let out = mimique(&good[..3]);
    assert_eq!(out.status.code(), Some(2));
}
