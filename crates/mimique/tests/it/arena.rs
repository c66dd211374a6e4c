//! `mimique arena` from end to end: methods of the solver on the built-in actor, simulated voters with planted worths in two
//! laboratories, one of them with another head.

use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use serde_json::Value;

use crate::support::{copied, ok, refused, text};

/// An arena with four methods, and its study.
struct Place {
    folder: tempfile::TempDir,
}

impl Place {
    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn arg(&self, name: &str) -> String {
        text(&self.path(name))
    }
}

const WORTHS: &str = r#"{ "comparisons": { "better": { "worth":
    { "recorded": 2.2, "lsts": 0.6, "ridge": 0.6, "box": -1.4 }, "segmentSd": 0, "personSd": 0.2 } } }"#;

/// Two segments of 0.5 s each, so that solving is quick; made once.
fn place() -> &'static Place {
    static PLACE: OnceLock<Place> = OnceLock::new();
    PLACE.get_or_init(|| {
        let place = Place { folder: tempfile::tempdir().unwrap() };
        ok(&["sample", "--out", &place.arg("sample")]);
        let segments = "label,first_frame,last_frame\njoy,300,399\nfear,1200,1299\n";
        std::fs::write(place.path("segments.csv"), segments).unwrap();
        std::fs::write(place.path("worths.json"), WORTHS).unwrap();
        ok(&[
            "arena",
            "new",
            &place.arg("faces"),
            "--avatar",
            &place.arg("sample/head.glb"),
            "--capture",
            &place.arg("sample/take.c3d"),
            "--map",
            &place.arg("sample/markers.json"),
            "--segments",
            &place.arg("segments.csv"),
            "--reference",
            &place.arg("sample/weights.csv"),
            "--shown",
            "50",
            "--per-participant",
            "12",
            "--date",
            "2026-11-20",
        ]);
        for method in ["box", "ridge", "lsts"] {
            let out = place.arg(&format!("{method}.csv"));
            ok(&[
                "solve",
                "--avatar",
                &place.arg("sample/head.glb"),
                "--mocap",
                &place.arg("sample/take.c3d"),
                "--markers",
                &place.arg("sample/markers.json"),
                "--method",
                method,
                "--out",
                &out,
            ]);
            submit(&place, "faces", method, &out);
        }
        ok(&["arena", "study", &place.arg("faces"), "--out", &place.arg("study")]);
        place
    })
}

fn submit(place: &Place, arena: &str, method: &str, file: &str) -> String {
    ok(&[
        "arena",
        "submit",
        &place.arg(arena),
        "--method",
        method,
        "--weights",
        file,
        "--author",
        "A. Uthor",
        "--licence",
        "CC0-1.0",
        "--date",
        "2026-11-21",
    ])
}

/// An export of simulated people who vote on a study.
fn simulated(place: &Place, study: &str, people: &str, seed: &str, out: &str) -> String {
    let folder = place.arg(out);
    ok(&[
        "simulate",
        &place.arg(study),
        "--participants",
        people,
        "--seed",
        seed,
        "--parameters",
        &place.arg("worths.json"),
        "--prepare",
        "--out",
        &folder,
    ]);
    place.arg(&format!("{out}/faces_responses.csv"))
}

fn json(path: &Path) -> Value {
    serde_json::from_slice(&std::fs::read(path).unwrap()).unwrap()
}

#[test]
fn arena_planted_order_is_found_over_two_laboratories_and_equal_methods_share_a_band() {
    let place = place();
    let one = simulated(place, "study/study.json", "70", "1", "one");
    let two = simulated(place, "study/study.json", "70", "2", "two");
    let [lyon, turin] = [format!("lyon={one}"), format!("turin={two}")];
    let said =
        ok(&["arena", "merge", &place.arg("faces"), &lyon, &turin, "--out", &place.arg("votes")]);
    assert!(said.contains("between 4 methods"), "{said}");
    let ranked = |votes: &str, out: &str| {
        ok(&[
            "arena",
            "rank",
            &place.arg("faces"),
            "--votes",
            &place.arg(votes),
            "--out",
            &place.arg(out),
            "--rounds",
            "200",
        ])
    };
    let said = ranked("votes", "ranking");
    let lines: Vec<&str> = said.lines().map(str::trim).collect();
    assert_eq!(lines[..3], ["1  recorded", "2 to 3  lsts, ridge", "4  box"], "{said}");
    let results = json(&place.path("ranking/results.json"));
    assert_eq!(results["ranking"]["notRanked"], Value::Null);
    assert!(results["ranking"]["heterogeneity"]["p"].as_f64().unwrap() > 0.01, "{results:#}");
    for file in
        ["report.html", "tables/ranking.csv", "tables/differences.csv", "figures/ranking.svg"]
    {
        assert!(place.path("ranking").join(file).is_file(), "{file}");
    }
    // The other way round, and one laboratory's export twice: the same bytes of votes and ranking.
    let again = format!("lyon={two}");
    ok(&["arena", "merge", &place.arg("faces"), &turin, &lyon, "--out", &place.arg("votes-2")]);
    let bytes = |name: &str| std::fs::read(place.path(name)).unwrap();
    assert_eq!(bytes("votes/votes.csv"), bytes("votes-2/votes.csv"));
    assert_eq!(bytes("votes/pooled.json"), bytes("votes-2/pooled.json"));
    ranked("votes-2", "ranking-2");
    assert_eq!(bytes("ranking/report.html"), bytes("ranking-2/report.html"));
    ok(&[
        "arena",
        "merge",
        &place.arg("faces"),
        &turin,
        &lyon,
        &again,
        "--out",
        &place.arg("votes-3"),
    ]);
    let count = |name: &str| String::from_utf8(bytes(name)).unwrap().lines().count();
    assert_eq!(count("votes/votes.csv"), count("votes-3/votes.csv"));
    // What was exported has every clip that votes name, and a file for each.
    ok(&[
        "arena",
        "export",
        &place.arg("faces"),
        "--votes",
        &place.arg("votes"),
        "--out",
        &place.arg("data"),
    ]);
    let clips = std::fs::read_to_string(place.path("data/clips.csv")).unwrap();
    assert_eq!(clips.lines().count(), 1 + 8);
    let votes = std::fs::read_to_string(place.path("data/votes.csv")).unwrap();
    let header: Vec<&str> = votes.lines().next().unwrap().split(',').collect();
    let hash = header.iter().position(|name| *name == "left_hash").unwrap();
    let first: Vec<&str> = votes.lines().nth(1).unwrap().split(',').collect();
    assert!(clips.contains(first[hash]) && first[hash].len() == 64, "{first:?}");
    assert!(place.path("data/submissions/lsts/joy.csv").is_file());
    assert!(place.path("data/head.glb").is_file());
}

#[test]
fn arena_laboratory_with_another_head_is_left_out_with_both_hashes() {
    let place = place();
    ok(&["sample", "--out", &place.arg("other"), "--avatar", "2"]);
    ok(&["arena", "study", &place.arg("faces"), "--out", &place.arg("tampered")]);
    std::fs::copy(place.path("other/head.glb"), place.path("tampered/head.glb")).unwrap();
    let honest = simulated(place, "study/study.json", "12", "3", "honest");
    let tampered = simulated(place, "tampered/study.json", "12", "4", "tampered-export");
    let [honest, tampered] = [format!("lyon={honest}"), format!("turin={tampered}")];
    let said = ok(&[
        "arena",
        "merge",
        &place.arg("faces"),
        &honest,
        &tampered,
        "--out",
        &place.arg("votes-tampered"),
    ]);
    assert!(said.contains("turin: 0 votes of 0 sessions"), "{said}");
    assert!(said.contains("is another clip than the arena's: provenance "), "{said}");
    let pooled = json(&place.path("votes-tampered/pooled.json"));
    let laboratories = pooled["laboratories"].as_array().unwrap();
    assert!(laboratories[0]["votes"].as_u64().unwrap() > 100);
    let reasons = laboratories[1]["leftOut"].as_array().unwrap();
    let own = reasons.iter().find(|own| own["reason"] == "stimulus").unwrap();
    assert_ne!(own["found"], own["expected"]);
    assert_eq!(own["expected"].as_str().unwrap().len(), 64);
}

#[test]
fn arena_takes_another_method_and_keeps_votes_and_what_the_laboratory_wrote() {
    let place = place();
    copied(&place.path("faces"), &place.path("grown"));
    ok(&["arena", "study", &place.arg("grown"), "--out", &place.arg("grown-study")]);
    let before = simulated(place, "grown-study/study.json", "20", "5", "before");
    let file = place.path("grown-study/study.json");
    let edited = std::fs::read_to_string(&file)
        .unwrap()
        .replace("investigator@example.org", "me@example.org");
    std::fs::write(&file, edited).unwrap();
    let halved = halved(&place.path("lsts.csv"), &place.path("halved.csv"));
    submit(place, "grown", "halved", &halved);
    let said = ok(&["arena", "study", &place.arg("grown"), "--out", &place.arg("grown-study")]);
    assert!(
        said.contains("5 methods on 2 segments") && said.contains("are those that were there"),
        "{said}"
    );
    let study = std::fs::read_to_string(&file).unwrap();
    assert!(study.contains("me@example.org") && study.contains("joy_halved"));
    ok(&["check", "--without-clips", &text(&file)]);
    let after = simulated(place, "grown-study/study.json", "20", "6", "after");
    let out = place.arg("votes-grown");
    let exports = [format!("lyon={before}"), format!("lyon={after}")];
    let said =
        ok(&["arena", "merge", &place.arg("grown"), &exports[0], &exports[1], "--out", &out]);
    assert!(said.contains("between 5 methods") && !said.contains("is another clip"), "{said}");
    let pooled = json(&place.path("votes-grown/pooled.json"));
    assert_eq!(pooled["laboratories"][0]["configurations"].as_array().unwrap().len(), 2);
    // Votes on the earlier clips of a method that was submitted anew are named.
    let quarter = self::halved(&place.path("halved.csv"), &place.path("quarter.csv"));
    let again = [
        "arena",
        "submit",
        &place.arg("grown"),
        "--method",
        "halved",
        "--weights",
        &quarter,
        "--author",
        "A. Uthor",
        "--licence",
        "CC0-1.0",
    ];
    assert!(refused(&again).contains("it was submitted already"));
    ok(&[&again[..], &["--replace"]].concat());
    let said = ok(&["arena", "merge", &place.arg("grown"), &exports[1], "--out", &out]);
    assert!(said.contains("by halved is another clip than the arena's"), "{said}");
}

/// A file of weights with every weight halved.
fn halved(from: &Path, to: &Path) -> String {
    let table = std::fs::read_to_string(from).unwrap();
    let mut lines = table.lines();
    let mut out = lines.next().unwrap().to_owned() + "\n";
    for line in lines {
        let cells: Vec<&str> = line.split(',').collect();
        let halved = cells[2..].iter().map(|cell| (cell.parse::<f64>().unwrap() / 2.0).to_string());
        let row: Vec<String> =
            cells[..2].iter().map(|cell| (*cell).to_owned()).chain(halved).collect();
        out += &(row.join(",") + "\n");
    }
    std::fs::write(to, out).unwrap();
    text(to)
}

#[test]
fn arena_refuses_bad_input_whole_and_writes_nothing() {
    let place = place();
    let bad = place.path("bad.csv");
    std::fs::write(&bad, "frame,time,jawOpn\n0,0,0.5\n1,0.1,1.5\n").unwrap();
    let said = refused(&[
        "arena",
        "submit",
        &place.arg("faces"),
        "--method",
        "Mine",
        "--weights",
        &format!("joy={}", text(&bad)),
        "--licence",
        "",
    ]);
    for part in [
        "method \"Mine\": write lower-case letters",
        "author \"\": name who made it",
        "licence \"\": name one",
        "bad.csv: 2 frames; joy has 100",
        "bad.csv: 10 frames per second; joy has 200",
        "column \"jawOpn\": the head has no such shape",
        "jawOpn in frame 1: 1.5; keep weights within 0 and 1",
        "segment fear: no file has it",
        "nothing was written",
    ] {
        assert!(said.contains(part), "{part}: {said}");
    }
    assert!(!place.path("faces/submissions/Mine").exists());
    // A file that was changed after it was submitted.
    copied(&place.path("faces"), &place.path("changed"));
    let joy = place.path("changed/submissions/box/joy.csv");
    let text_of = std::fs::read_to_string(&joy).unwrap();
    std::fs::write(&joy, text_of.replacen("0.0", "0.1", 1) + "\n").unwrap();
    let said = refused(&["arena", "study", &place.arg("changed"), "--out", &place.arg("never")]);
    assert!(said.contains("joy.csv: it is not what was submitted (SHA-256"), "{said}");
    assert!(!place.path("never").exists());
    // An arena file that says what cannot be.
    let file = place.path("changed/arena.json");
    let wrong = std::fs::read_to_string(&file).unwrap().replace("\"first\": 300", "\"first\": 900");
    std::fs::write(&file, wrong).unwrap();
    let said = refused(&["arena", "study", &place.arg("changed"), "--out", &place.arg("never")]);
    assert!(said.contains("arena.json: /segments/0: frames 900 to 400 of a capture of"), "{said}");
    // Nothing is written over what is something else.
    let said = refused(&["arena", "study", &place.arg("faces"), "--out", &place.arg("sample")]);
    assert!(said.contains("it holds something else"), "{said}");
    let said = refused(&[
        "arena",
        "rank",
        &place.arg("faces"),
        "--votes",
        &place.arg("sample"),
        "--out",
        &place.arg("r"),
    ]);
    assert!(said.contains("give the folder that `mimique arena merge` wrote"), "{said}");
}

#[test]
fn arena_shows_vertices_on_the_same_head() {
    let place = place();
    // The skin that the weights of lsts give, as vertices of each segment.
    for segment in ["joy", "fear"] {
        let weights = place.path(&format!("faces/submissions/lsts/{segment}.csv"));
        write_skin(
            &place.path("sample/head.glb"),
            &weights,
            &place.path(&format!("{segment}.npy")),
        );
    }
    let arrays = [place.arg("joy.npy"), place.arg("fear.npy")];
    copied(&place.path("faces"), &place.path("mesh"));
    let args = |rate: &'static str| {
        let mut args = ["arena", "submit", &place.arg("mesh"), "--method", "mesh", "--rate", rate]
            .map(str::to_owned)
            .to_vec();
        args.extend(
            ["--author", "A. Uthor", "--licence", "CC0-1.0", "--replace", "--vertices"]
                .map(str::to_owned),
        );
        args.extend(arrays.clone());
        args
    };
    let said = ok(&args("200"));
    assert!(said.contains("principal shapes give every vertex again to within"), "{said}");
    let submission = json(&place.path("mesh/submissions/mesh/submission.json"));
    assert_eq!(submission["kind"], "vertices");
    assert!(submission["avatar"]["largestErrorMm"].as_f64().unwrap() <= 0.05);
    let said = ok(&["arena", "study", &place.arg("mesh"), "--out", &place.arg("mesh-study")]);
    assert!(said.contains("5 methods"), "{said}");
    let export = simulated(place, "mesh-study/study.json", "12", "7", "mesh-export");
    let said = ok(&[
        "arena",
        "merge",
        &place.arg("mesh"),
        &format!("x={export}"),
        "--out",
        &place.arg("mesh-votes"),
    ]);
    assert!(said.contains("between 5 methods"), "{said}");
    // Another rate is another performance; what is not at the head is named with its place.
    let said = refused(&args("100"));
    assert!(said.contains("joy.npy: 100 frames per second; joy has 200"), "{said}");
    let mut bytes = std::fs::read(place.path("joy.npy")).unwrap();
    let last = bytes.len() - 4;
    bytes[last..].copy_from_slice(&0.4f32.to_le_bytes());
    std::fs::write(place.path("joy.npy"), bytes).unwrap();
    let said = refused(&args("200"));
    assert!(
        said.contains("joy.npy: frame 99, vertex ") && said.contains(" mm from its place at rest"),
        "{said}"
    );
}

/// Writes the places of the skin's vertices at weights of the head, a frame each.
fn write_skin(head: &Path, weights: &Path, to: &Path) {
    let head = mimique_avatar_files::read_avatar(head).unwrap().avatar;
    let skins = || head.meshes.iter().filter(|mesh| mesh.part == mimique_avatar::Part::Skin);
    let table = std::fs::read_to_string(weights).unwrap();
    let frames: Vec<Vec<f64>> = (table.lines().skip(1))
        .map(|line| line.split(',').skip(2).map(|cell| cell.parse().unwrap()).collect())
        .collect();
    let vertices: usize = skins().map(|mesh| mesh.positions.len()).sum();
    let mut bytes = mimique_mocap::npy_header("<f4", &[frames.len(), vertices, 3]);
    for frame in &frames {
        let places = skins().flat_map(|mesh| mesh.posed(frame)).flatten();
        bytes.extend(places.flat_map(f32::to_le_bytes));
    }
    std::fs::write(to, bytes).unwrap();
}
