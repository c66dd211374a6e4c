//! `mimique annotate`: labels learnt, suggested and evaluated, from every kind of file; what is refused.

use std::fmt::Write as _;
use std::path::Path;

use serde_json::Value;

use crate::support::{ok, refused, text};

const RATE_HZ: f64 = 25.0;
const SHAPES: [&str; 4] = ["jawOpen", "mouthSmileLeft", "browDownLeft", "eyeBlinkLeft"];
/// Neutral, joy, anger.
const FACES: [[f64; 3]; 3] = [[0.02, 0.0, 0.0], [0.1, 0.8, 0.0], [0.0, 0.1, 0.7]];
const WORDS: [&str; 3] = ["N", "J", "A"];

/// Which face is shown from when to when: two seconds each, a way of 0.4 s between them.
fn order(number: usize) -> [usize; 5] {
    if number.is_multiple_of(2) { [0, 1, 0, 2, 0] } else { [0, 2, 0, 1, 0] }
}

/// Weights of a take: 250 frames.
fn weights(person: usize, number: usize) -> Vec<[f64; 4]> {
    let shown = order(number);
    let ripple = |f: usize, s: usize| {
        0.015 * ((f * (s + 3) + 17 * person + 31 * number) as f64 * 0.37).sin()
    };
    let row = |f: usize| {
        let (part, inside) = (f / 50, f % 50);
        let next = shown[(part + 1).min(4)];
        let way = ((inside as f64 - 40.0) / 10.0).max(0.0);
        let face = |s: usize| FACES[shown[part]][s] * (1.0 - way) + FACES[next][s] * way;
        let blink = if (f + 7 * number) % 60 < 4 { 0.8 } else { 0.0 };
        let shift = 0.03 * person as f64;
        [0, 1, 2].map(|s| face(s) + shift + ripple(f, s)).into_iter().chain([blink]).collect()
    };
    let rows = (0..250).map(|f| -> Vec<f64> { row(f) });
    rows.map(|row| [row[0], row[1], row[2], row[3]]).collect()
}

fn csv(rows: &[[f64; 4]]) -> String {
    let mut csv = format!("frame,time,{}\n", SHAPES.join(","));
    for (frame, row) in rows.iter().enumerate() {
        let time = frame as f64 / RATE_HZ;
        let cells = row.map(|w| format!("{w:.4}")).join(",");
        let _ = writeln!(csv, "{frame},{time},{cells}");
    }
    csv
}

/// What an annotator writes: frames and word.
fn marks(number: usize) -> Vec<(usize, usize, String)> {
    let shown = order(number);
    let mut marks = Vec::new();
    for part in 0..5 {
        let end = if part == 4 { 250 } else { 50 * part + 40 };
        marks.push((50 * part, end, WORDS[shown[part]].to_owned()));
        if part < 4 {
            let word = format!("{}{}", WORDS[shown[part]], WORDS[shown[part + 1]]);
            marks.push((end, 50 * (part + 1), word));
        }
    }
    marks
}

/// An ELAN document with the annotator's tier `affect`, a tier of words whose times lie in slots without
/// times of their own, and a tier that refers to the first.
fn eaf(number: usize) -> String {
    let marks = marks(number);
    let ms = |frame: usize| frame as f64 * 1000.0 / RATE_HZ;
    let (mut slots, mut own, mut aligned, mut refers) =
        (String::new(), String::new(), String::new(), String::new());
    for (i, (first, end, word)) in marks.iter().enumerate() {
        for (kind, frame) in [("s", first), ("e", end)] {
            let time = ms(*frame);
            let _ = write!(slots, "<TIME_SLOT TIME_SLOT_ID=\"{kind}{i}\" TIME_VALUE=\"{time}\"/>");
        }
        let alignable = |id: &str, to: &str| {
            format!(
                "<ANNOTATION><ALIGNABLE_ANNOTATION ANNOTATION_ID=\"{id}{i}\" TIME_SLOT_REF1=\"s{i}\" \
                 TIME_SLOT_REF2=\"{to}{i}\"><ANNOTATION_VALUE>{word}</ANNOTATION_VALUE>\
                 </ALIGNABLE_ANNOTATION></ANNOTATION>"
            )
        };
        own += &alignable("a", "e");
        aligned += &alignable("b", "e");
        let _ = write!(
            refers,
            "<ANNOTATION><REF_ANNOTATION ANNOTATION_ID=\"r{i}\" ANNOTATION_REF=\"a{i}\">\
             <ANNOTATION_VALUE>{word}</ANNOTATION_VALUE></REF_ANNOTATION></ANNOTATION>"
        );
    }
    format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<ANNOTATION_DOCUMENT AUTHOR=\"\" DATE=\"\" \
         FORMAT=\"3.0\" VERSION=\"3.0\"><HEADER MEDIA_FILE=\"\" TIME_UNITS=\"milliseconds\"/>\
         <TIME_ORDER>{slots}</TIME_ORDER>\
         <TIER TIER_ID=\"affect\" LINGUISTIC_TYPE_REF=\"free\">{own}</TIER>\
         <TIER TIER_ID=\"aligned\" PARENT_REF=\"affect\" LINGUISTIC_TYPE_REF=\"in\">{aligned}</TIER>\
         <TIER TIER_ID=\"refers\" PARENT_REF=\"affect\" LINGUISTIC_TYPE_REF=\"one\">{refers}</TIER>\
         <LINGUISTIC_TYPE LINGUISTIC_TYPE_ID=\"free\" TIME_ALIGNABLE=\"true\"/>\
         <LINGUISTIC_TYPE LINGUISTIC_TYPE_ID=\"in\" CONSTRAINTS=\"Included_In\" TIME_ALIGNABLE=\"true\"/>\
         <LINGUISTIC_TYPE LINGUISTIC_TYPE_ID=\"one\" CONSTRAINTS=\"Symbolic_Association\"/>\
         </ANNOTATION_DOCUMENT>\n"
    )
}

fn segments_csv(number: usize) -> String {
    let mut csv = String::from("label,first_frame,last_frame\n");
    for (first, end, word) in marks(number) {
        let _ = writeln!(csv, "{word},{first},{}", end - 1);
    }
    csv
}

/// A folder with six takes of two people, their labels in ELAN documents, and `takes.csv`.
struct Corpus(tempfile::TempDir);

impl Corpus {
    fn new() -> Self {
        let corpus = Self(tempfile::tempdir().expect("a folder"));
        let mut table = String::from("# Made for a test.\nweights,labels,person,kind\n");
        for (person, number) in (0..2).flat_map(|p| (0..3).map(move |n| (p, n))) {
            corpus.write(&format!("{person}{number}.csv"), &csv(&weights(person, number)));
            corpus.write(&format!("{person}{number}.eaf"), &eaf(number));
            let kind = if number == 2 { "sentence" } else { "posed" };
            let _ = writeln!(table, "{person}{number}.csv,{person}{number}.eaf,p{person},{kind}");
        }
        corpus.write("takes.csv", &table);
        corpus
    }

    fn at(&self, name: &str) -> String {
        text(&self.0.path().join(name))
    }

    fn write(&self, name: &str, contents: &str) {
        std::fs::write(self.0.path().join(name), contents).expect("written");
    }

    fn read(&self, name: &str) -> String {
        std::fs::read_to_string(self.0.path().join(name)).expect(name)
    }

    fn train(&self, more: &[&str]) -> String {
        let (takes, model) = (self.at("takes.csv"), self.at("model.json"));
        let args = ["annotate", "train", &takes, "--tier", "affect", "--out", &model];
        ok(&[&args, more].concat())
    }

    /// What is refused of training, with nothing written.
    fn no_training(&self, more: &[&str]) -> String {
        let (takes, model) = (self.at("takes.csv"), self.at("none.json"));
        let args = ["annotate", "train", &takes, "--out", &model];
        let said = refused(&[&args, more].concat());
        assert!(!Path::new(&model).exists());
        said
    }
}

#[test]
fn a_model_learns_suggests_and_says_what_it_learnt_from() {
    let corpus = Corpus::new();
    let said = corpus.train(&[]);
    assert!(said.contains("forest of 200 trees"), "{said}");
    assert!(said.contains("from 6 takes held out in turn"), "{said}");
    assert!(!said.contains("keep it as their data"), "{said}");
    let file: Value = serde_json::from_str(&corpus.read("model.json")).expect("JSON");
    assert_eq!((&file["version"], file["hash"].as_str().map(str::len)), (&1.into(), Some(64)));
    let model = &file["model"];
    assert_eq!(model["channel"], "affect");
    assert_eq!(model["labels"], serde_json::json!(["A", "J", "N"]));
    assert_eq!(model["shapes"], serde_json::json!(SHAPES));
    let rate_hz = model["rateHz"].as_f64().expect("a rate");
    assert!((rate_hz - 25.0).abs() < 1e-9 && model["holdsFrames"] == false, "{rate_hz}");
    let take = &model["learntFrom"]["takes"][0];
    assert_eq!(
        (&take["name"], &take["person"], &take["kind"]),
        (&"00.csv".into(), &"p0".into(), &"posed".into())
    );
    // Two takes of each person have anger for 1.6 s, as have all.
    let seconds = model["learntFrom"]["seconds"][0].as_f64().expect("seconds");
    assert!((seconds - 9.6).abs() < 1e-9, "{seconds}");

    // A take that nobody has annotated; its document keeps everything.
    corpus.write("new.csv", &csv(&weights(1, 7)));
    corpus.write("new.eaf", &eaf(7));
    let (before, out, table, frames) =
        (corpus.read("new.eaf"), corpus.at("new.eaf"), corpus.at("t.csv"), corpus.at("p.csv"));
    let (new, file) = (corpus.at("new.csv"), corpus.at("model.json"));
    let args = [
        "annotate", "apply", &new, "--model", &file, "--out", &out, "--table", &table, "--frames",
        &frames,
    ];
    let said = ok(&args);
    assert!(said.contains("5 segments in 10.0 s at 25 Hz"), "{said}");
    let rows: Vec<Vec<String>> =
        corpus.read("t.csv").lines().map(|l| l.split(',').map(str::to_owned).collect()).collect();
    assert_eq!(rows[0][7..], ["probability", "second", "second_probability"]);
    let labels: Vec<&str> = rows[1..].iter().map(|row| row[0].as_str()).collect();
    assert_eq!(labels, ["N", "A", "N", "J", "N"]);
    for (row, border) in rows[1..].iter().zip([0_i64, 45, 95, 145, 195]) {
        assert!((row[1].parse::<i64>().expect("a frame") - border).abs() <= 6, "{row:?}");
        let probability: f64 = row[7].parse().expect("a probability");
        assert!(probability > 0.6 && row[9].parse::<f64>().expect("one") < 0.4, "{row:?}");
    }
    let probabilities = corpus.read("p.csv");
    assert!(probabilities.starts_with("frame,time,A,J,N\n"));
    for line in probabilities.lines().skip(1) {
        let sum: f64 = line.split(',').skip(2).map(|p| p.parse::<f64>().expect("one")).sum();
        assert!((sum - 1.0).abs() < 1e-5, "{line}");
    }
    let document = corpus.read("new.eaf");
    for tier in ["affect", "aligned", "refers", "affect (suggested)", "affect (confidence)"] {
        assert!(document.contains(&format!("TIER_ID=\"{tier}\"")), "{tier}");
    }
    let own =
        &before[before.find("<TIER ").expect("tiers")..before.find("<LINGUISTIC").expect("types")];
    assert!(document.contains(own), "the annotator's tiers have changed");
    // Once more: tiers take the place of the old ones.
    ok(&args);
    assert_eq!(corpus.read("new.eaf").matches("affect (suggested)").count(), 1);

    // What is less probable is unknown; the JSON has all. Every take began neutrally, so that this one does too.
    let args = [
        "annotate", "apply", &new, "--model", &file, "--table", &table, "--below", "0.999",
        "--json",
    ];
    let told: Value = serde_json::from_str(&ok(&args)).expect("JSON");
    let segments = told["segments"].as_array().expect("segments");
    let names: Vec<&str> = segments.iter().filter_map(|own| own["label"].as_str()).collect();
    assert_eq!(names, ["N", "?", "?", "?", "?"], "{told}");
    assert!(corpus.read("t.csv").lines().nth(2).expect("a row").starts_with("?,"));
}

#[test]
fn tiers_of_every_kind_and_tables_give_the_same_model() {
    let corpus = Corpus::new();
    let models: Vec<Value> = ["affect", "aligned", "refers"]
        .into_iter()
        .map(|tier| {
            let (takes, model) = (corpus.at("takes.csv"), corpus.at("model.json"));
            ok(&["annotate", "train", &takes, "--tier", tier, "--out", &model]);
            let mut file: Value = serde_json::from_str(&corpus.read("model.json")).expect("JSON");
            file["model"]["channel"] = "x".into();
            file["model"].clone()
        })
        .collect();
    assert_eq!(models[0], models[1]);
    assert_eq!(models[0], models[2]);
    for number in 0..3 {
        corpus.write(&format!("0{number}.eaf"), "");
        corpus.write(&format!("0{number}.labels.csv"), &segments_csv(number));
    }
    let table = corpus.read("takes.csv");
    let table = (0..3)
        .fold(table, |table, n| table.replace(&format!("0{n}.eaf"), &format!("0{n}.labels.csv")));
    corpus.write("takes.csv", &table);
    corpus.train(&[]);
    let file: Value = serde_json::from_str(&corpus.read("model.json")).expect("JSON");
    assert_eq!(file["model"]["classifier"], models[0]["classifier"]);
    // Named words, and what nobody has marked.
    let words = ["--words", "neutral=N,joy=J", "--rest", "neutral"];
    let said = corpus.train(&words);
    assert!(said.contains("words that are no label: \"A\""), "{said}");
    let file: Value = serde_json::from_str(&corpus.read("model.json")).expect("JSON");
    assert_eq!(file["model"]["labels"], serde_json::json!(["joy", "neutral"]));
}

#[test]
fn every_method_and_decoding_is_learnt_and_read_again() {
    let corpus = Corpus::new();
    let (model, new) = (corpus.at("model.json"), corpus.at("00.csv"));
    let methods: [&[&str]; 7] = [
        &["--method", "knn", "--neighbours", "1"],
        &["--method", "svm", "--kernel", "linear", "--balanced"],
        &["--method", "svm", "--c", "10", "--gamma", "1"],
        &["--method", "logistic", "--c", "5"],
        &["--method", "forest", "--trees", "20", "--thin", "all"],
        &["--method", "hmm", "--states", "2", "--components", "1", "--steps", "5"],
        &[
            "--method",
            "hmm",
            "--states",
            "2",
            "--components",
            "1",
            "--topology",
            "left-right",
            "--temper",
            "0.5",
        ],
    ];
    for more in methods {
        let said = corpus.train(more);
        let holds = said.contains("keep it as their data");
        assert_eq!(holds, ["knn", "svm"].contains(&more[1]), "{more:?}: {said}");
        let hmm = more[1] == "hmm";
        assert_eq!(said.contains("log likelihood"), hmm, "{said}");
        for decode in [
            &["--decode", "path", "--stay", "1"][..],
            &["--decode", "frames"],
            &["--segments", "peaks"],
            &["--segments", "literal"],
        ] {
            let args = ["annotate", "apply", &new, "--model", &model, "--json"];
            let told: Value = serde_json::from_str(&ok(&[&args, decode].concat())).expect("JSON");
            let segments = told["segments"].as_array().expect("segments");
            let frames = |label: &str| -> u64 {
                let own = segments.iter().filter(|s| s["label"] == label);
                own.map(|s| {
                    s["end_frame"].as_u64().expect("one") - s["first_frame"].as_u64().expect("one")
                })
                .sum()
            };
            assert_eq!(frames("N") + frames("J") + frames("A"), 250, "{more:?} {decode:?}");
            assert!(
                frames("J") > 25 && frames("A") > 25 && frames("N") > 100,
                "{more:?} {decode:?}: {told}"
            );
        }
    }
    // Segments of a file: those are labelled, and nothing else.
    corpus.write("given.csv", "label,first_frame,last_frame\nx,55,85\ny,155,185\n");
    let args = [
        "annotate",
        "apply",
        &new,
        "--model",
        &model,
        "--segments",
        &corpus.at("given.csv"),
        "--json",
    ];
    let told: Value = serde_json::from_str(&ok(&args)).expect("JSON");
    let found: Vec<(&Value, &Value)> = told["segments"]
        .as_array()
        .expect("two")
        .iter()
        .map(|s| (&s["first_frame"], &s["label"]))
        .collect();
    assert_eq!(found, [(&55.into(), &"J".into()), (&155.into(), &"A".into())]);
}

#[test]
fn an_evaluation_tells_the_majority_beside_each_score_and_writes_a_whole_report() {
    let corpus = Corpus::new();
    let (takes, out) = (corpus.at("takes.csv"), corpus.at("report"));
    let args = ["annotate", "evaluate", &takes, "--tier", "affect", "--out", &out];
    let said = ok(&args);
    assert!(said.contains("6 takes of 2 people, 3 labels, takes held out one by one"), "{said}");
    assert!(said.contains("Made for a test."), "{said}");
    for score in ["frames right", "F1@10", "F1@25", "F1@50", "edit score", "borders, F1", "kappa"] {
        assert!(said.contains(score), "{score}: {said}");
    }
    assert!(said.contains("always N"), "{said}");
    let results: Value = serde_json::from_str(&corpus.read("report/results.json")).expect("JSON");
    let [thesis, recommended] = [0, 1].map(|i| &results["candidates"][i]);
    assert_eq!(
        (&thesis["as"], &recommended["as"]),
        (&"As in the thesis".into(), &"Recommended".into())
    );
    assert_eq!(
        (&thesis["eachPersonAlone"], &recommended["eachPersonAlone"]),
        (&true.into(), &false.into())
    );
    let scores = &recommended["summary"]["scores"];
    assert!(scores["frames"]["accuracy"].as_f64().expect("one") > 0.95, "{scores}");
    assert!(scores["segments"]["f1"][2].as_f64().expect("one") > 0.9, "{scores}");
    // 1.6 s at the start, in the middle and 2 s at the end of 10 s, without the ways.
    let always = &recommended["summary"]["majority"];
    let expected = (40.0 + 40.0 + 50.0) / (40.0 * 4.0 + 50.0);
    assert_eq!(always["label"], "N");
    let accuracy = always["scores"]["frames"]["accuracy"].as_f64().expect("one");
    assert!((accuracy - expected).abs() < 1e-12, "{always}");
    let interval = &recommended["summary"]["intervals"][0];
    assert_eq!(interval["score"], "accuracy");
    assert!(interval["ends"][0].as_f64() <= scores["frames"]["accuracy"].as_f64());
    let page = corpus.read("report/report.html");
    for part in ["As in the thesis", "Always N", "Made for a test.", "no claim about faces"] {
        assert!(page.contains(part), "{part}");
    }
    assert_eq!(page.matches("<figure>").count(), 2 + 1 + 6);
    for file in [
        "report.md",
        "tables/scores.csv",
        "tables/scores.tex",
        "tables/all.tex",
        "figures/confusion-recommended.svg",
    ] {
        assert!(!corpus.read(&format!("report/{file}")).is_empty(), "{file}");
    }
    // The same words in French, in the place of the first report; other splits.
    ok(&[&args[..], &["--language", "fr", "--split", "person"]].concat());
    let page = corpus.read("report/report.html");
    assert!(page.contains("Comme dans la thèse") && page.contains("Toujours N"));
    let results: Value = serde_json::from_str(&corpus.read("report/results.json")).expect("JSON");
    assert_eq!(results["candidates"][1]["summary"]["intervals"], Value::Null, "two people");
    assert_eq!(results["candidates"][0]["eachPersonAlone"], false);
    for split in ["kind", "fold=3"] {
        ok(&["annotate", "evaluate", &takes, "--tier", "affect", "--split", split]);
    }
    // Another folder's files are not written over.
    std::fs::create_dir(corpus.0.path().join("mine")).expect("a folder");
    corpus.write("mine/notes.txt", "mine");
    let args = ["annotate", "evaluate", &takes, "--tier", "affect", "--out", &corpus.at("mine")];
    assert!(refused(&args).contains("holds something else than a report"));
    assert_eq!(corpus.read("mine/notes.txt"), "mine");
}

#[test]
fn as_in_the_thesis_and_the_short_paper() {
    let corpus = Corpus::new();
    let said = corpus.train(&["--as-in", "thesis"]);
    assert!(said.contains("forest of 200 trees"), "{said}");
    let model: Value = serde_json::from_str(&corpus.read("model.json")).expect("JSON");
    let model = &model["model"];
    assert_eq!(model["thinnedToHz"], Value::Null);
    let cut = &model["decoding"]["segments"];
    assert_eq!(cut["rule"]["literal"], serde_json::json!({"windowS": 0.1, "share": 0.15}));
    let activity = serde_json::json!({"cutoffHz": 6.0, "timeUnitS": 0.1, "blinksAndGaze": true});
    assert_eq!(cut["activity"], activity);

    let (takes, out) = (corpus.at("takes.csv"), corpus.at("report"));
    let evaluate = ["annotate", "evaluate", &takes, "--tier", "affect", "--out", &out, "--as-in"];
    ok(&[&evaluate[..], &["thesis"]].concat());
    let results: Value = serde_json::from_str(&corpus.read("report/results.json")).expect("JSON");
    let rows = results["figure44"].as_array().expect("figure 4.4");
    let methods: Vec<&str> =
        rows.iter().filter_map(|row| row["method"]["method"].as_str()).collect();
    assert_eq!(methods, ["knn", "knn", "svm", "svm", "forest"]);
    for row in rows {
        // Five stable stretches a take.
        assert_eq!(row["manual"]["n"], 30, "{row}");
        assert!(row["manual"]["accuracy"].as_f64().expect("one") > 0.9, "{row}");
        assert_eq!(row["manual"]["majority"], 0.6, "{row}");
        assert!(row["automatic"]["n"].as_u64().expect("one") > 30, "{row}");
    }
    assert!(corpus.read("report/report.html").contains("figure 4.4"));

    // The short paper learns from takes of one expression: their peaks, and what is neutral in them.
    let mut table = String::from("weights,labels\n");
    for (i, label) in [1, 2, 1, 2].into_iter().enumerate() {
        let face = |f: usize, s: usize| {
            let up = ((f % 100) as f64 / 10.0 - 3.0).clamp(0.0, 1.0)
                - ((f % 100) as f64 / 10.0 - 8.0).clamp(0.0, 1.0);
            FACES[0][s]
                + up * (FACES[label][s] - FACES[0][s])
                + 0.01 * ((f * (s + 2) + i) as f64 * 0.7).sin()
        };
        let rows: Vec<[f64; 4]> =
            (0..500).map(|f| [face(f, 0), face(f, 1), face(f, 2), 0.0]).collect();
        corpus.write(&format!("e{i}.csv"), &csv(&rows));
        let mut labels = String::from("label,first_frame,last_frame\n");
        for repeat in 0..5 {
            let _ = writeln!(labels, "N,{},{}", 100 * repeat, 100 * repeat + 29);
            let _ =
                writeln!(labels, "{},{},{}", WORDS[label], 100 * repeat + 40, 100 * repeat + 79);
        }
        corpus.write(&format!("e{i}.labels.csv"), &labels);
        let _ = writeln!(table, "e{i}.csv,e{i}.labels.csv");
    }
    corpus.write("single.csv", &table);
    let (single, model) = (corpus.at("single.csv"), corpus.at("short.json"));
    let train = ["annotate", "train", &single, "--as-in", "short-paper", "--out", &model];
    let said = ok(&[&train[..], &["--components", "2", "--states", "2"]].concat());
    for part in ["A: log likelihood", "N in takes of A: log likelihood", "N in takes of J"] {
        assert!(said.contains(part), "{part}: {said}");
    }
    let model: Value = serde_json::from_str(&corpus.read("short.json")).expect("JSON");
    let settings = &model["model"]["settings"];
    assert_eq!((&settings["method"], &settings["meanStayS"]), (&"hmm".into(), &0.5.into()));
    let labels = &model["model"]["classifier"]["hmm"]["labelOfClass"];
    assert_eq!(*labels, serde_json::json!([0, 2, 1, 2]));
    let args =
        ["annotate", "apply", &corpus.at("e0.csv"), "--model", &corpus.at("short.json"), "--json"];
    let told: Value = serde_json::from_str(&ok(&args)).expect("JSON");
    let joy =
        told["segments"].as_array().expect("segments").iter().filter(|s| s["label"] == "J").count();
    assert!((5..=9).contains(&joy), "{told}");
    // The other takes show both.
    let both = ["--as-in", "short-paper", "--tier", "affect"];
    assert!(corpus.no_training(&both).contains("no take shows one expression"));
}

#[test]
fn a_given_model_is_held_against_what_it_has_not_learnt_from() {
    let corpus = Corpus::new();
    let table = corpus.read("takes.csv");
    let of = |person: &str| -> String {
        let kept = |line: &&str| line.starts_with("weights") || line.contains(person);
        table.lines().filter(kept).flat_map(|line| [line, "\n"]).collect()
    };
    corpus.write("first.csv", &of("p0"));
    corpus.write("second.csv", &of("p1"));
    let (first, second, model) =
        (corpus.at("first.csv"), corpus.at("second.csv"), corpus.at("model.json"));
    ok(&["annotate", "train", &first, "--tier", "affect", "--out", &model]);
    let evaluate = |takes: &str, split: &str| -> Vec<String> {
        let args = [
            "annotate", "evaluate", takes, "--tier", "affect", "--model", &model, "--split", split,
        ];
        args.map(str::to_owned).to_vec()
    };
    let said = ok(&evaluate(&second, "person"));
    assert!(said.contains("the model") && said.contains("3 takes of 1 people"), "{said}");
    // The same motion, whatever it is called; the same person in another take; the same kind.
    corpus.write("again.csv", &csv(&weights(0, 1)));
    corpus.write("renamed.csv", "weights,labels,person,kind\nagain.csv,01.eaf,p9,other\n");
    let said = refused(&evaluate(&corpus.at("renamed.csv"), "take"));
    assert!(
        said.contains("renamed.csv: line 2: take again.csv: the model has learnt from it (01.csv)"),
        "{said}"
    );
    corpus.write("other.csv", &csv(&weights(0, 5)));
    corpus.write("other.eaf", &eaf(5));
    corpus.write("others.csv", "weights,labels,person,kind\nother.csv,other.eaf,p0,posed\n");
    ok(&evaluate(&corpus.at("others.csv"), "take"));
    let said = refused(&evaluate(&corpus.at("others.csv"), "person"));
    assert!(said.contains("line 2: person p0: the model has learnt from it"), "{said}");
    assert!(refused(&evaluate(&corpus.at("others.csv"), "kind")).contains("kind posed"));
}

#[test]
fn live_link_and_captures_are_labelled_as_well() {
    let corpus = Corpus::new();
    // Live Link Face: other spelling, rotations of the head beside the weights.
    let live = |person: usize, number: usize| {
        let names = SHAPES.map(|name| name[..1].to_uppercase() + &name[1..]);
        let mut csv = format!("Timecode,BlendShapeCount,{},HeadYaw\n", names.join(","));
        for (f, row) in weights(person, number).iter().enumerate() {
            // 30 frames a second.
            let (s, ff) = (f / 30, 2 * (f % 30));
            let cells = row.map(|w| format!("{w:.4}")).join(",");
            let _ = writeln!(csv, "00:00:{s:02}:{ff:02}.000,5,{cells},{}", (f as f64 * 0.1).sin());
        }
        csv
    };
    corpus.train(&["--method", "logistic"]);
    corpus.write("live.csv", &live(1, 4));
    let (live, model) = (corpus.at("live.csv"), corpus.at("model.json"));
    let said = ok(&["annotate", "apply", &live, "--model", &model]);
    assert!(said.contains("columns that are no weights are left out: HeadYaw"), "{said}");
    assert!(said.contains("5 segments"), "{said}");

    // Captures of two built-in actors, their heads held still.
    let mut table = String::from("weights,labels,person\n");
    for actor in ["1", "2"] {
        let folder = corpus.at(&format!("s{actor}"));
        let told: Value =
            serde_json::from_str(&ok(&["sample", "--out", &folder, "--actor", actor, "--json"]))
                .expect("JSON");
        let mut labels = String::from("label,first_frame,last_frame\nneutral,0,99\n");
        for segment in told["segments"].as_array().expect("segments") {
            let first = segment["first_frame"].as_u64().expect("one");
            let name = segment["name"].as_str().expect("a name").trim_end_matches(char::is_numeric);
            let _ = writeln!(labels, "{name},{},{}", first + 250, first + 500);
        }
        corpus.write(&format!("s{actor}/labels.csv"), &labels);
        let _ = writeln!(table, "s{actor}/take.c3d,s{actor}/labels.csv,{actor}");
    }
    corpus.write("captures.csv", &table);
    let (captures, markers) = (corpus.at("captures.csv"), corpus.at("s1/markers.json"));
    let args = ["annotate", "train", &captures, "--out", &model, "--method", "knn"];
    let said = refused(&args);
    assert!(said.contains("take.c3d: a capture without head markers"), "{said}");
    let said = ok(&[&args[..], &["--markers", &markers]].concat());
    assert!(
        said.contains("2 files: displacements from frames") || said.contains("the stillest second"),
        "{said}"
    );
    let take = corpus.at("s2/take.c3d");
    let args = ["annotate", "apply", &take, "--model", &model, "--markers", &markers, "--json"];
    let told: Value = serde_json::from_str(&ok(&args)).expect("JSON");
    let found: Vec<&str> = told["segments"]
        .as_array()
        .expect("segments")
        .iter()
        .filter_map(|s| s["label"].as_str())
        .collect();
    assert!(found.len() >= 12 && found.contains(&"surprise"), "{found:?}");
}

#[test]
fn what_cannot_be_learnt_is_refused_with_its_place() {
    let corpus = Corpus::new();
    let tier = ["--tier", "affect"];
    let table = corpus.read("takes.csv");
    let with = |from: &str, to: &str| corpus.write("takes.csv", &table.replacen(from, to, 1));
    let said = corpus.no_training(&["--tier", "mood"]);
    assert!(
        said.contains(
            "00.eaf: tier \"mood\": not in the document, which has affect, aligned, refers"
        ),
        "{said}"
    );
    assert!(
        corpus
            .no_training(&[])
            .contains("no tier is named of affect, aligned, refers; name one with --tier")
    );
    assert!(
        corpus
            .no_training(&["--tier", "affect", "--words", "joy=J"])
            .contains("1 label with frames")
    );
    let said = corpus.no_training(&["--tier", "affect", "--words", "joy=J,fear=F,neutral=N"]);
    assert!(said.contains("takes.csv: label fear: in 0 of the takes"), "{said}");
    assert!(corpus.no_training(&["--tier", "affect", "--words", "joy=?"]).contains("--words"));
    for (option, value, said) in [
        ("--trees", "0", "trees 0"),
        ("--neighbours", "3", "--neighbours: forest does not listen to it"),
        ("--thin", "none", "give frames a second, or all"),
        ("--stay", "0", "--stay: 0; give seconds above 0"),
        ("--segments", "some.csv", "a file is of one take"),
    ] {
        let told = corpus.no_training(&[&tier[..], &[option, value]].concat());
        assert!(told.contains(said), "{option}: {told}");
    }
    // The table.
    for (from, to, said) in [
        ("weights,labels,person,kind", "weights,labels,people,kind", "line 1: column \"people\""),
        ("weights,labels,person,kind", "motion,labels,person,kind", "line 1: column \"motion\""),
        ("00.csv,", ",", "line 3: column weights: no file"),
        ("00.csv,00.eaf,p0", "00.csv,00.eaf", "line 3: 3 cells where the header has 4"),
        ("00.csv", "nothing.csv", "nothing.csv: "),
        ("00.eaf", "nothing.eaf", "nothing.eaf: open"),
        ("01.csv", "00.csv", "line 4: 00.csv is the same motion as that of line 3"),
    ] {
        with(from, to);
        let told = corpus.no_training(&tier);
        assert!(told.contains(said), "{to}: {told}");
    }
    corpus.write("takes.csv", "weights,labels\n");
    assert!(corpus.no_training(&tier).contains("takes.csv: no take"));
    corpus.write("takes.csv", &table);
    // The takes.
    let weights_csv = corpus.read("00.csv");
    let shorter: String = weights_csv.lines().take(101).flat_map(|line| [line, "\n"]).collect();
    let slower = weights_csv.lines().map(|line| {
        let mut cells: Vec<String> = line.split(',').map(str::to_owned).collect();
        if let Ok(time) = cells[1].parse::<f64>() {
            cells[1] = (2.0 * time).to_string();
        }
        cells.join(",") + "\n"
    });
    for (contents, said) in [
        (weights_csv.replacen(SHAPES[2], "other", 1), "shape \"browDownLeft\" is missing"),
        (weights_csv.replacen("0.0", "NaN", 1), "NaN"),
        (shorter, "01.eaf: frames 90:100 of 100"),
        (slower.collect(), "01.csv has 12.5 Hz, the first take 25; bring all takes to one rate"),
    ] {
        corpus.write("01.csv", &contents);
        let told = corpus.no_training(&tier);
        let beyond = said.starts_with("01.eaf") && told.contains("01.eaf: frames");
        assert!(told.contains(said) || beyond, "{said}: {told}");
    }
    corpus.write("01.csv", &csv(&weights(0, 1)));
    // Intervals that overlap, in a table.
    with("00.eaf", "00.labels.csv");
    corpus.write("00.labels.csv", "label,first_frame,last_frame\nN,0,60\nJ,50,80\nA,100,110\n");
    assert!(corpus.no_training(&tier).contains("00.labels.csv: frames 50:81 of 250"));
    // Splits.
    corpus.write("takes.csv", &table.replace(",p0,", ",,"));
    let args = ["annotate", "evaluate", &corpus.at("takes.csv"), "--tier", "affect", "--split"];
    let said = refused(&[&args[..], &["person"]].concat());
    assert!(said.contains("takes.csv: line 3: column person says nothing"), "{said}");
    corpus.write("takes.csv", &table.replace(",p1,", ",p0,"));
    assert!(refused(&[&args[..], &["person"]].concat()).contains("groups to leave out: 1"));
    assert!(refused(&[&args[..], &["fold=9"]].concat()).contains("takes to fold: 6 where 9"));
    assert!(
        refused(&[&args[..], &["frames"]].concat()).contains("give take, person, kind, or fold=K")
    );
    corpus.write("takes.csv", &table);
    for number in 0..3 {
        // Only the second person is ever angry.
        corpus.write(&format!("0{number}.eaf"), &eaf(number).replace(">A<", ">?<"));
    }
    let said = refused(&[&args[..], &["person"]].concat());
    assert!(said.contains("label A: in no take that is not held out together"), "{said}");
}

#[test]
fn what_cannot_be_suggested_is_refused_and_nothing_is_written() {
    let corpus = Corpus::new();
    corpus.train(&["--method", "hmm", "--states", "1", "--components", "1"]);
    let (new, model, table) = (corpus.at("00.csv"), corpus.at("model.json"), corpus.at("t.csv"));
    let apply = |more: &[&str]| {
        let args = ["annotate", "apply", &new, "--model", &model, "--table", &table];
        let said = refused(&[&args[..], more].concat());
        assert!(!Path::new(&table).exists());
        said
    };
    assert!(apply(&["--out", &corpus.at("x.csv")]).contains("name a .eaf, or use --table"));
    assert!(apply(&["--below", "2"]).contains("--below: 2; give a probability"));
    let said = apply(&["--mocap-rate", "50"]);
    assert!(said.contains("00.csv: take of 50 Hz among"), "{said}");
    corpus.write("bad.eaf", "<ANNOTATION_DOCUMENT>");
    assert!(apply(&["--out", &corpus.at("bad.eaf")]).contains("bad.eaf: byte 21"));
    assert_eq!(corpus.read("bad.eaf"), "<ANNOTATION_DOCUMENT>");
    corpus.write("late.csv", "label,first_frame,last_frame\nx,200,300\n");
    let said = apply(&["--segments", &corpus.at("late.csv")]);
    assert!(
        said.contains("late.csv: frames 200:301 of 250; give the segments of this take"),
        "{said}"
    );
    corpus.write("both.csv", "label,first_frame,last_frame\nx,20,40\ny,30,50\n");
    assert!(apply(&["--segments", &corpus.at("both.csv")]).contains("overlap"));
    let whole = corpus.read("model.json");
    for (from, to, said) in [
        ("\"version\":1", "\"version\":9", "model of version 9: versions up to 1 are read"),
        ("\"rateHz\":2", "\"rateHz\":3", "its hash is not that of what it holds"),
        ("\"labels\":[\"A\",", "\"labels\":[", "do not fit"),
        ("{", "", "line 1, column"),
        ("\"channel\"", "\"kanal\"", "line 1, column"),
    ] {
        corpus.write("model.json", &whole.replacen(from, to, 1));
        let told = apply(&[]);
        assert!(told.contains("model.json: ") && told.contains(said), "{to}: {told}");
    }
    corpus.write("model.json", &whole);
    corpus.write("00.csv", &csv(&weights(0, 0)).replacen("jawOpen", "mouthOpen", 1));
    assert!(apply(&[]).contains("00.csv: shape \"jawOpen\" is missing"));
}

#[test]
fn segment_has_the_same_borders() {
    let corpus = Corpus::new();
    let new = corpus.at("00.csv");
    let borders = |more: &[&str]| -> usize {
        let told: Value = serde_json::from_str(&ok(&[&["segment", &new, "--json"], more].concat()))
            .expect("JSON");
        told["timeline"]["borders_s"].as_array().expect("borders").len()
    };
    // Four ways between faces; blinks are no borders unless they are asked for.
    assert_eq!(borders(&[]), 4);
    assert!(borders(&["--blinks-and-gaze"]) > 4);
    assert!(borders(&["--borders", "literal"]) > 8);
    assert!(
        refused(&["segment", &new, "--time-unit", "0"])
            .contains("--time-unit: 0; give a number above 0")
    );
    assert!(refused(&["segment", &new, "--borders", "some"]).contains("give peaks or literal"));
}
