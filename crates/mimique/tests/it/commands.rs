//! The commands as a researcher types them: results, exit codes, errors, and nothing half written.

use std::collections::BTreeMap;

use mimique_test_support::{real_file, repository};
use serde_json::{Value, json};

use crate::support::{mimique, ok, refused, text};

/// Frame and weights by shape, of a CSV with a column `frame`.
fn weights(csv: &str) -> BTreeMap<u64, BTreeMap<String, f64>> {
    let mut lines = csv.lines();
    let header: Vec<&str> = lines.next().expect("a header").split(',').collect();
    lines
        .map(|line| {
            let mut row: BTreeMap<String, f64> = header
                .iter()
                .zip(line.split(','))
                .map(|(name, cell)| ((*name).to_owned(), cell.parse().expect("a number")))
                .collect();
            row.remove("time");
            let frame = row.remove("frame").expect("a column frame");
            (frame as u64, row)
        })
        .collect()
}

#[test]
fn solve_gives_the_stored_weights_of_lsts_and_box() {
    let Some(data) = real_file("solve_gives_the_stored_weights_of_lsts_and_box", "lsts") else {
        return;
    };
    let folder = tempfile::tempdir().expect("a folder");
    for (method, alpha, stored) in [
        ("lsts", Some("0.3"), "F4_box_k0.1_a0.3.csv"),
        ("box", None, "box_no_prior_lsq_linear.csv"),
    ] {
        let (out, report) = (folder.path().join("w.csv"), folder.path().join("r.json"));
        let mut args = vec!["solve".to_owned(), "--method".to_owned(), method.to_owned()];
        for (option, path) in [
            ("--avatar", data.join("avatar_skin.glb")),
            ("--mocap", data.join("take_n01.csv")),
            ("--markers", data.join("mapping.csv")),
            ("--out", out.clone()),
            ("--report", report.clone()),
        ] {
            args.extend([option.to_owned(), text(&path)]);
        }
        // The stored optima are of a head that was not filtered, every shape solved.
        let more = [
            "--neutral",
            "0:60",
            "--head-lowpass",
            "none",
            "--gaze",
            "markers",
            "--untold",
            "solve",
        ];
        args.extend(more.map(str::to_owned));
        if let Some(alpha) = alpha {
            args.extend(["--alpha".to_owned(), alpha.to_owned()]);
        }
        ok(&args);
        let ours = weights(&std::fs::read_to_string(&out).expect("the weights"));
        assert_eq!(ours.len(), 5660);
        let stored = std::fs::read_to_string(data.join("frames").join(stored)).expect("stored");
        let stored = weights(&stored);
        assert_eq!(stored.len(), 10);
        for (frame, wanted) in &stored {
            for (shape, weight) in wanted {
                let difference = (ours[frame][shape] - weight).abs();
                assert!(difference < 1e-6, "{method}, frame {frame}, {shape}: {difference:e}");
            }
        }
        let report: Value =
            serde_json::from_slice(&std::fs::read(&report).expect("the report")).expect("JSON");
        let frames = report["frames"].as_array().expect("a report a frame");
        assert_eq!(frames.len(), 5660);
        assert_eq!(report["head_lowpass_hz"], Value::Null);
        for key in ["read", "set_up", "front_end", "solve", "write"] {
            assert!(report["seconds"][key].is_number(), "seconds of {key}");
        }
    }
}

#[test]
fn solve_refuses_and_writes_nothing() {
    let Some(data) = real_file("solve_refuses_and_writes_nothing", "lsts") else { return };
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("w.csv");
    let empty = folder.path().join("empty.c3d");
    std::fs::write(&empty, "").expect("an empty file");
    let avatar = text(&data.join("avatar_skin.glb"));
    let mocap = text(&data.join("take_n01.csv"));
    let markers = text(&data.join("mapping.csv"));
    let out_text = text(&out);
    let base = |avatar: &str, mocap: &str, more: &[&str]| {
        let mut args: Vec<String> = [
            "solve",
            "--avatar",
            avatar,
            "--mocap",
            mocap,
            "--markers",
            &markers,
            "--out",
            &out_text,
        ]
        .map(str::to_owned)
        .to_vec();
        args.extend(more.iter().map(|arg| (*arg).to_owned()));
        args
    };
    for (args, named) in [
        (base("nope.glb", &mocap, &[]), "nope.glb"),
        (base(&mocap, &mocap, &[]), "byte 0"),
        (base(&avatar, &text(&empty), &[]), "empty"),
        (base(&avatar, &mocap, &["--head", "M00,M01,NOSE"]), "NOSE"),
        (base(&avatar, &mocap, &["--alpha", "1.5"]), "alpha"),
        (base(&avatar, &mocap, &["--method", "box", "--alpha", "0.3"]), "alpha"),
        (base(&avatar, &mocap, &["--neutral", "9000:9060"]), "9000"),
    ] {
        let err = refused(&args);
        assert!(err.contains(named), "{named}: {err}");
        assert!(!out.exists(), "nothing is written: {err}");
    }
}

#[test]
fn statistical_tests_print_the_expected_values() {
    let test = "statistical_tests_print_the_expected_values";
    let Some(data) = real_file(test, "stats") else { return };
    let expected: Value = serde_json::from_slice(
        &std::fs::read(data.join("expected.json")).expect("expected values"),
    )
    .expect("JSON");
    let mut compared = 0;
    for case in expected["cases"].as_array().expect("cases") {
        let columns = &case["columns"];
        let column = |key: &str| columns[key].as_str().map(str::to_owned);
        let (name, options) = match case["test"].as_str().expect("a test") {
            "kruskal_wallis" => (
                "kruskal-wallis",
                vec![("--response", column("response")), ("--group", column("group"))],
            ),
            "wilcoxon_signed_rank" => (
                "wilcoxon",
                vec![
                    ("--x", column("x")),
                    ("--y", column("y")),
                    ("--difference", column("difference").or_else(|| column("d"))),
                ],
            ),
            "scheirer_ray_hare" => {
                let factors = ["factor1", "factor2"].map(|key| column(key).unwrap_or_default());
                let factors = columns["factors"].as_array().map_or_else(
                    || factors.join(","),
                    |list| list.iter().filter_map(Value::as_str).collect::<Vec<_>>().join(","),
                );
                (
                    "scheirer-ray-hare",
                    vec![("--response", column("response")), ("--factors", Some(factors))],
                )
            }
            _ => continue,
        };
        let file = text(&data.join(case["file"].as_str().expect("a file")));
        let mut args = vec!["test".to_owned(), name.to_owned(), file, "--json".to_owned()];
        for (option, value) in options {
            args.extend(value.into_iter().flat_map(|value| [option.to_owned(), value]));
        }
        let out = mimique(&args);
        let id = case["id"].as_str().expect("an id");
        let actual: Value = serde_json::from_slice(&out.stdout)
            .unwrap_or_else(|e| panic!("{id}: {e}: {}", String::from_utf8_lossy(&out.stderr)));
        let wanted = &case["expected"];
        let status = wanted["status"].as_str().unwrap_or("ok");
        assert_eq!(actual["status"], status, "{id}");
        assert_eq!(out.status.code(), Some(if status == "refused" { 2 } else { 0 }), "{id}");
        for key in ["statistic", "df", "H", "p_value", "p", "W_plus", "n"] {
            if let (Some(wanted), Some(actual)) = (wanted[key].as_f64(), actual[key].as_f64()) {
                let near = (actual - wanted).abs() <= 1e-9 * wanted.abs();
                assert!(near, "{id}, {key}: {actual} instead of {wanted}");
                compared += 1;
            }
        }
        if let Some(variants) = wanted["p_by_semantics"].as_object() {
            for (variant, p) in variants {
                let (Some(p), Some(ours)) =
                    (p.as_f64(), actual["p_by_semantics"][variant].as_f64())
                else {
                    continue;
                };
                assert!(
                    (ours - p).abs() <= 1e-9 * p.abs(),
                    "{id}, {variant}: {ours} instead of {p}"
                );
                compared += 1;
            }
        }
        if let Some(types) = wanted["type2"]["H"].as_array() {
            for (index, wanted) in types.iter().filter_map(Value::as_f64).enumerate() {
                let ours = actual["type2"]["H"][index].as_f64().expect("H");
                assert!((ours - wanted).abs() <= 1e-9 * wanted.abs(), "{id}: {ours} for {wanted}");
                compared += 1;
            }
        }
    }
    assert!(compared > 30, "only {compared} values were compared");
    let file = text(&data.join("cases/airquality.csv"));
    let err = refused(&["test", "kruskal-wallis", &file, "--response", "Ozne", "--group", "Month"]);
    assert!(err.contains("airquality.csv") && err.contains("\"Ozne\""), "{err}");
}

#[test]
fn check_accepts_the_studies_of_the_repository_and_names_every_mistake() {
    let study = |name: &str| text(&repository().join("study-config").join(name));
    ok(&["check", &study("demo.json")]);
    ok(&["check", &study("template.json"), "--without-clips"]);
    ok(&["check", &study("baselines.json"), "--without-clips"]);
    let folder = tempfile::tempdir().expect("a folder");
    let bad = folder.path().join("bad.json");
    std::fs::write(&bad, r#"{ "id": "x", "languges": ["en"], "components": {} }"#).expect("a file");
    // What is found is what was asked for: it goes to standard output.
    let found = mimique(&["check", &text(&bad)]);
    assert_eq!(found.status.code(), Some(2));
    let err = String::from_utf8_lossy(&found.stdout);
    let parts = [
        "/languges",
        "did you mean \"languages\"",
        "studyMetadata",
        "stimuli",
        "no contact",
        "no consent",
    ];
    for part in parts {
        assert!(err.contains(part), "{part}: {err}");
    }
    let listed: Value = {
        let out = mimique(&["check", &text(&bad), "--json"]);
        assert_eq!(out.status.code(), Some(2));
        serde_json::from_slice(&out.stdout).expect("JSON")
    };
    assert!(listed.to_string().contains("\"pointer\""), "{listed}");
}

#[test]
fn check_prints_the_words_to_translate() {
    let printed = ok(&["check", "--words", "de"]);
    let words: Value = serde_json::from_str(&printed).expect("JSON");
    let words = words["translations"]["de"].as_object().expect("texts by name");
    assert_eq!(words["trial_of"], "Clip {number} of {of}");
    // In the order of the pages: the language's own name first, refusals last.
    let place = |name: &str| printed.find(&format!("\"{name}\"")).expect("the name");
    assert!(place("language_name") < place("agree") && place("agree") < place("refused_internal"));
    let french = ok(&["check", "--words", "fr"]);
    assert!(french.contains("J’accepte de participer"), "{french}");
    for empty in ["", "  "] {
        let err = refused(&["check", "--words", empty]);
        assert!(err.contains("--words") && err.contains("write its code"), "{err}");
    }
}

#[test]
fn order_is_the_same_every_time_and_differs_between_participants() {
    let study = text(&repository().join("study-config/demo.json"));
    let of = |participant: &str| ok(&["order", &study, "--participant", participant, "--json"]);
    assert_eq!(of("3"), of("3"));
    let orders: std::collections::BTreeSet<String> = ["1", "2", "3", "4", "5"].map(of).into();
    assert_eq!(orders.len(), 5);
    let err = refused(&["order", &study, "--participant", "-1"]);
    assert!(err.contains("--participant"), "{err}");
}

#[test]
fn order_is_that_of_the_participants_condition() {
    let demo = repository().join("study-config/demo.json");
    let mut file = mimique_study::parse(&std::fs::read_to_string(demo).unwrap()).unwrap();
    let condition = |id: &str, order: &str| json!({ "id": id, "conditional": true, "order": order, "components": ["faces"] });
    file["sequence"] = json!({ "order": "fixed",
        "components": [condition("drawn", "random"), condition("as-listed", "fixed")] });
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("conditions.json");
    std::fs::write(&path, file.to_string()).expect("written");
    let study = text(&path);
    ok(&["check", &study]);
    let of = |participant: &str, condition: &str| {
        ok(&["order", &study, "-k", participant, "--condition", condition])
    };
    assert_eq!(of("1", "as-listed"), of("2", "as-listed"));
    assert_ne!(of("1", "drawn"), of("2", "drawn"));
    let json = ok(&["order", &study, "-k", "1", "--condition", "drawn", "--json"]);
    assert!(json.contains("\"condition\": \"drawn\""), "{json}");
    let err = refused(&["order", &study, "-k", "1"]);
    assert!(err.contains("--condition drawn or --condition as-listed"), "{err}");
    let err = refused(&["order", &study, "-k", "1", "--condition", "Drawn"]);
    assert!(err.contains("no condition \"Drawn\"; the study has: drawn, as-listed"), "{err}");
    let demo = text(&repository().join("study-config/demo.json"));
    let err = refused(&["order", &demo, "-k", "1", "--condition", "drawn"]);
    assert!(err.contains("no condition \"drawn\"; the study has: –"), "{err}");
}

#[test]
fn inspect_tells_what_a_capture_holds() {
    let Some(data) = real_file("inspect_tells_what_a_capture_holds", "animface") else { return };
    let file = text(&data.join("JawMoCap.c3d"));
    let facts: Value = serde_json::from_str(&ok(&["inspect", &file, "--json"])).expect("JSON");
    let said = facts.to_string();
    for part in ["\"C3D\"", "1590", "ForeHead_M"] {
        assert!(said.contains(part), "{part}: {said}");
    }
}

#[test]
fn export_of_a_database_that_is_not_there_is_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let database = folder.path().join("none.sqlite");
    let out = folder.path().join("x.csv");
    let url = format!("sqlite:{}", database.display());
    let err = refused(&["export", "--database", &url, "--out", &text(&out)]);
    assert!(err.contains("none.sqlite"), "{err}");
    assert!(!database.exists() && !out.exists(), "nothing is made");
}
