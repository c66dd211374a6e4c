//! The folder that `mimique analyze` writes: figures as SVG and PDF, and links to the clips that they are of.

use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::path::Path;

use crate::support::{mimique, ok, refused, text};

fn demo() -> String {
    text(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../../study-config/demo.json"))
}

/// Answers of simulated people, and a table of stimuli with a measure of a laboratory's own.
fn answers(folder: &Path) -> [String; 2] {
    let simulated = text(&folder.join("simulated"));
    ok(&["simulate", &demo(), "-n", "8", "--seed", "1", "--out", &simulated]);
    let export = folder.join("simulated/demo_responses.csv");
    let mut reader = csv::Reader::from_path(&export).unwrap();
    let place = reader.headers().unwrap().iter().position(|name| name == "stimulus").unwrap();
    let clips: BTreeSet<String> =
        reader.records().map(|row| row.unwrap()[place].to_owned()).collect();
    let mut table = "stimulus,mean_speed\n".to_owned();
    for (number, clip) in clips.iter().filter(|clip| !clip.is_empty()).enumerate() {
        writeln!(table, "{clip},{}", 3 * number % 7).unwrap();
    }
    let stimuli = folder.join("stimuli.csv");
    std::fs::write(&stimuli, table).unwrap();
    [text(&export), text(&stimuli)]
}

#[test]
fn every_figure_stands_there_as_svg_and_as_pdf() {
    let folder = tempfile::tempdir().unwrap();
    let [export, _] = answers(folder.path());
    let out = folder.path().join("report");
    let told = ok(&["--json", "analyze", &export, "--study", &demo(), "--out", &text(&out)]);
    let told: serde_json::Value = serde_json::from_str(&told).unwrap();
    let listed: BTreeSet<&str> =
        told["files"].as_array().unwrap().iter().map(|file| file.as_str().unwrap()).collect();
    let mut figures = 0;
    for file in std::fs::read_dir(out.join("figures")).unwrap() {
        let svg = file.unwrap().path();
        if svg.extension().is_none_or(|kind| kind != "svg") {
            continue;
        }
        let pdf = svg.with_extension("pdf");
        let name = pdf.file_name().unwrap().to_str().unwrap();
        assert!(listed.contains(&*format!("figures/{name}")), "{name} in {listed:?}");
        let read = lopdf::Document::load(&pdf).unwrap();
        assert_eq!(read.get_pages().len(), 1, "{name}");
        let words = read.extract_text(&[1]).unwrap();
        assert!(words.chars().filter(|c| c.is_alphanumeric()).count() > 10, "{name}: {words}");
        figures += 1;
    }
    assert!(figures > 10, "{figures}");
}

#[test]
fn points_lead_to_the_preview_that_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let [export, stimuli] = answers(folder.path());
    let out = folder.path().join("report");
    let study = demo();
    let analyze = |more: &[&str]| {
        let out = text(&out);
        let mut args = vec!["analyze", &export, "--study", &study, "--stimuli", &stimuli];
        args.extend(["--out", &out]);
        args.extend(more);
        mimique(&args)
    };
    let preview = "http://lab.example/preview/demo";
    let links = || {
        let page = std::fs::read_to_string(out.join("report.html")).unwrap();
        page.matches(&format!("href=\"{preview}?clip=")).count()
    };
    assert!(analyze(&["--preview-url", &format!("{preview}/")]).status.success());
    assert!(links() >= 12, "{}", links());
    assert!(analyze(&[]).status.success());
    assert_eq!(links(), 0, "without an address nothing leads anywhere");
    for wrong in ["lab.example/preview/demo", "javascript:alert(1)", "http://a/preview/demo?clip=x"]
    {
        let refused = analyze(&["--preview-url", wrong]);
        assert_eq!(refused.status.code(), Some(2), "{wrong}");
        let said = String::from_utf8_lossy(&refused.stderr).into_owned();
        assert!(said.contains(wrong) && said.contains("give the whole address"), "{said}");
    }
}

/// The demonstration with another rule for late frames, as a file, and answers of simulated people to it.
fn other_version(folder: &Path) -> [String; 2] {
    let mut file = mimique_study::parse(&std::fs::read_to_string(demo()).unwrap()).unwrap();
    file["exclusions"]["lateFrameShare"] = serde_json::json!(0.05);
    let versions = folder.join("versions");
    std::fs::create_dir(&versions).unwrap();
    let version = versions.join("spring.json");
    std::fs::write(&version, file.to_string()).unwrap();
    let simulated = folder.join("simulated");
    let (version, out) = (text(&version), text(&simulated));
    ok(&["simulate", &version, "-n", "8", "--seed", "1", "--out", &out]);
    [text(&versions), text(&simulated.join("demo_responses.csv"))]
}

#[test]
fn versions_that_were_served_are_read_from_the_folder_that_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let [versions, export] = other_version(folder.path());
    let out = folder.path().join("report");
    let written = || std::fs::read_to_string(out.join("report.md")).unwrap();
    let study = demo();
    let report = text(&out);
    let analyze = ["analyze", &export, "--study", &study, "--out", &report];
    ok(&analyze);
    assert!(written().contains("8 participants answered another version of this study"));
    assert!(written().contains("The file of that version is not known here"));
    ok(&[&analyze[..], &["--versions", &versions]].concat());
    assert!(
        written().contains("rule lateFrameShare (served: 0.05; here: absent)"),
        "{}",
        written()
    );
    // A file among them that is no study is named, and nothing is written.
    let broken = Path::new(&versions).join("broken.json");
    std::fs::write(&broken, "{").unwrap();
    std::fs::remove_dir_all(&out).unwrap();
    let said = refused(&[&analyze[..], &["--versions", &versions]].concat());
    assert!(said.contains(&text(&broken)), "{said}");
    let nowhere = text(&folder.path().join("nowhere"));
    let said = refused(&[&analyze[..], &["--versions", &nowhere]].concat());
    assert!(said.contains(&nowhere) && said.contains("check the path"), "{said}");
    assert!(!out.exists());
}

#[test]
fn answers_to_a_published_file_that_is_served_again_are_its_own() {
    let folder = tempfile::tempdir().unwrap();
    let read = std::fs::read_to_string(demo()).unwrap();
    let demonstration = mimique_study::parse(&read).unwrap();
    let mut served = demonstration.clone();
    served["title"] = serde_json::json!("As it was served first");
    let published = mimique_study::published(&served, demonstration);
    let file = folder.path().join("study.json");
    std::fs::write(&file, published.to_string()).unwrap();
    let (file, simulated) = (text(&file), folder.path().join("simulated"));
    let out = folder.path().join("report");
    ok(&["simulate", &file, "-n", "8", "--seed", "1", "--out", &text(&simulated)]);
    let export = text(&simulated.join("demo_responses.csv"));
    ok(&["analyze", &export, "--study", &file, "--out", &text(&out)]);
    let report = std::fs::read_to_string(out.join("report.md")).unwrap();
    assert!(!report.contains("another version"), "the answers are to this file");
}

#[test]
fn verdicts_are_repeated_over_specifications_where_that_is_asked() {
    let folder = tempfile::tempdir().unwrap();
    let [export, _] = answers(folder.path());
    let out = folder.path().join("report");
    let analyze = ["analyze", &export, "--study", &demo(), "--out", &text(&out)];
    ok(&analyze);
    assert!(!out.join("tables/sensitivity.csv").exists());
    let said = ok(&[&analyze[..], &["--multiverse"]].concat());
    assert!(said.contains("Sensitivity of H1: "), "{said}");
    assert!(said.contains(" specifications."), "{said}");
    let table = std::fs::read_to_string(out.join("tables/sensitivity.csv")).unwrap();
    let heading = table.lines().next().unwrap();
    assert!(heading.contains("as fixed in the study file,excluded: incomplete,test"), "{heading}");
    for name in ["sensitivity-h1.svg", "sensitivity-h1.pdf"] {
        assert!(out.join("figures").join(name).exists(), "{name}");
    }
}

#[test]
fn a_study_without_hypotheses_has_no_verdict_to_repeat() {
    let folder = tempfile::tempdir().unwrap();
    let mut study = mimique_study::parse(&std::fs::read_to_string(demo()).unwrap()).unwrap();
    study.as_object_mut().unwrap().remove("hypotheses");
    let file = folder.path().join("study.json");
    std::fs::write(&file, study.to_string()).unwrap();
    let (file, simulated) = (text(&file), folder.path().join("simulated"));
    let out = text(&folder.path().join("report"));
    ok(&["simulate", &file, "-n", "8", "--seed", "1", "--out", &text(&simulated)]);
    let export = text(&simulated.join("demo_responses.csv"));
    let said = ok(&["analyze", &export, "--study", &file, "--out", &out, "--multiverse"]);
    assert!(said.contains("states no hypothesis, so there is no verdict to repeat"), "{said}");
}
