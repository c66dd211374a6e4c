//! Mimicry in the report: planted lags are found by factor and clip, what does not suit is told, bad tables are refused.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use mimique_analysis::{
    ExportError, MeasuredFaces, MimicryError, Report, ReportOptions, analyze_with,
};
use mimique_locale::Language;
use mimique_stats::Table;
use mimique_study::columns::{COURSE_COLUMNS, TRACK_COLUMNS};
use mimique_study::{Study, TRACKED_SHAPES};
use mimique_test_support::Random;
use serde_json::{Value, json};

use crate::support::{Raters, demo_study, export};

const RATE_HZ: f64 = 60.0;
const FRAMES: usize = 240;
const SHAPES: [&str; 3] = ["jawOpen", "mouthSmileLeft", "browDownRight"];

/// The demonstration, with faces measured.
fn study() -> Study {
    let mut file = serde_json::to_value(demo_study()).unwrap();
    file["mimicry"] = json!({ "consent": { "version": "1", "heading": "Face", "text": "Why." },
        "model": "face_landmarker.task", "runtime": "tasks-vision" });
    Study::from_value(&file).unwrap()
}

/// Courses of each clip: sums of slow waves, from 0 to 1.
fn courses(study: &Study) -> BTreeMap<String, Vec<Vec<f64>>> {
    let mut random = Random::new(3);
    let mut course = || -> Vec<f64> {
        let waves: Vec<[f64; 2]> = (0..4)
            .map(|_| [0.3 + 1.2 * random.uniform(), std::f64::consts::TAU * random.uniform()])
            .collect();
        let at = |frame: usize| {
            let time = frame as f64 / RATE_HZ;
            0.5 + waves
                .iter()
                .map(|[hz, phase]| (std::f64::consts::TAU * hz * time + phase).sin())
                .sum::<f64>()
                / 8.0
        };
        (0..FRAMES).map(at).collect()
    };
    study.clips().iter().map(|clip| (clip.id.clone(), SHAPES.map(|_| course()).to_vec())).collect()
}

fn courses_csv(courses: &BTreeMap<String, Vec<Vec<f64>>>) -> String {
    let names: Vec<&str> =
        COURSE_COLUMNS.into_iter().chain(TRACKED_SHAPES.into_iter().skip(1)).collect();
    let mut text = names.join(",") + "\n";
    for (clip, own) in courses {
        for frame in 0..FRAMES {
            write!(text, "{clip},p,{:.3}", frame as f64 * 1e3 / RATE_HZ).unwrap();
            for name in TRACKED_SHAPES.iter().skip(1) {
                let place = SHAPES.iter().position(|own| own == name);
                write!(
                    text,
                    ",{}",
                    place.map_or(String::new(), |place| own[place][frame].to_string())
                )
                .unwrap();
            }
            text.push('\n');
        }
    }
    text
}

/// People's faces: `gain` times the clip, `lag_s` later, for clips of the method `lsts30` alone; noise in all.
fn tracks_csv(
    study: &Study,
    courses: &BTreeMap<String, Vec<Vec<f64>>>,
    people: usize,
    lag_s: f64,
    gain: f64,
) -> String {
    let mut random = Random::new(8);
    let names: Vec<&str> = TRACK_COLUMNS.into_iter().chain(TRACKED_SHAPES).collect();
    let mut text = names.join(",") + "\n";
    for person in 0..people {
        for clip in study.clips() {
            let own = &courses[&clip.id];
            let follows = clip.method == "lsts30";
            // The camera has a clock and a rate of its own, and now and then no face.
            for picture in 0..100 {
                let time_s = 0.013 + picture as f64 / 28.0;
                let seen = picture % 23 != 11;
                write!(
                    text,
                    "p{:04},live,faces/{},{},,p,1,true,{:.3},{seen}",
                    person + 1,
                    clip.id,
                    clip.id,
                    time_s * 1e3
                )
                .unwrap();
                for name in TRACKED_SHAPES {
                    if !seen {
                        text.push(',');
                        continue;
                    }
                    let place = SHAPES.iter().position(|own| *own == name);
                    let frame = ((time_s - lag_s) * RATE_HZ).max(0.0) as usize;
                    let shown = place
                        .filter(|_| follows)
                        .map_or(0.0, |place| own[place][frame.min(FRAMES - 1)]);
                    let score = (0.1 + gain * shown + 0.03 * random.normal()).clamp(0.0, 1.0);
                    write!(text, ",{score:.3}").unwrap();
                }
                text.push('\n');
            }
        }
    }
    text
}

fn report(
    study: &Study,
    tracks: &str,
    courses: &str,
    language: Language,
) -> Result<Report, ExportError> {
    let table = Table::parse(export(study, &Raters { people: 8, effect: 0.0, seed: 7 })).unwrap();
    let (tracks, courses) = (Table::parse(tracks).unwrap(), Table::parse(courses).unwrap());
    let faces = Some(MeasuredFaces { tracks: &tracks, courses: &courses });
    analyze_with(&table, study, language, ReportOptions { faces, ..ReportOptions::default() })
}

fn file(report: &Report, path: &str) -> String {
    report
        .files
        .iter()
        .find(|file| file.path == path)
        .map(|file| file.text.clone())
        .unwrap_or_default()
}

fn mimicry(report: &Report) -> Value {
    let results: Value = serde_json::from_str(&file(report, "results.json")).unwrap();
    results["mimicry"].clone()
}

#[test]
fn a_planted_lag_is_found_where_it_was_planted() {
    let study = study();
    let courses = courses(&study);
    let tracks = tracks_csv(&study, &courses, 8, 0.4, 0.15);
    let report = report(&study, &tracks, &courses_csv(&courses), Language::English).unwrap();
    let found = mimicry(&report);
    let all = &found["all"];
    assert!((all["lag_s"].as_f64().unwrap() - 0.4).abs() < 0.06, "{}", all["lag_s"]);
    assert_eq!(all["kind"], "other-clips");
    assert!(all["p_value"].as_f64().unwrap() <= 0.01);
    // The person who stopped half-way is left out, and trials with too many late frames.
    let excluded = found["left_out"]["excluded"].as_u64().unwrap() as usize;
    assert!((study.clips().len()..4 * study.clips().len()).contains(&excluded), "{excluded}");
    let of = |level: &str| {
        found["levels"]
            .as_array()
            .unwrap()
            .iter()
            .find(|own| own["level"] == level)
            .unwrap()
            .clone()
    };
    let (follows, other) = (of("lsts30"), of("box"));
    assert!(follows["found"]["highest_r"].as_f64().unwrap() > 0.5, "{follows}");
    assert!(follows["found"]["p_value"].as_f64().unwrap() <= 0.01);
    assert!(
        other["found"]["highest_r"].as_f64().unwrap() < 0.2
            && other["found"]["p_value"].as_f64().unwrap() > 0.01
    );
    for clip in study.clips() {
        let own =
            found["clips"].as_array().unwrap().iter().find(|own| own["clip"] == clip.id).unwrap();
        let r = own["r"].as_f64().unwrap();
        assert_eq!(r > 0.3, clip.method == "lsts30", "{own}");
    }
    let text = file(&report, "report.md");
    assert!(
        text.contains("People’s faces followed the clips: the mean correlation is highest"),
        "{text}"
    );
    assert!(file(&report, "figures/mimicry-by-lag.svg").contains("lag (s)"));
    assert!(file(&report, "tables/mimicry-by-clip.csv").lines().count() == 1 + study.clips().len());
}

#[test]
fn what_does_not_suit_is_told_in_both_languages() {
    let study = study();
    let courses = courses(&study);
    let csv = courses_csv(&courses);
    // A table without rows is none: nobody was measured.
    assert!(Table::parse(tracks_csv(&study, &courses, 0, 0.0, 0.0)).is_err());
    // No course is known.
    let told = |tracks: &str, courses: &str, language| {
        let report = report(&study, tracks, courses, language).unwrap();
        assert_eq!(mimicry(&report), Value::Null);
        file(&report, "report.md")
    };
    let tracks = tracks_csv(&study, &courses, 2, 0.0, 0.0);
    let other = csv.replace(",p,", ",another,");
    assert!(
        told(&tracks, &other, Language::French)
            .contains("d’extraits dont la table des cours ne dit rien")
    );
    // Clips that move nothing with a name of ARKit's: their courses rest.
    let rest: String = csv
        .lines()
        .enumerate()
        .map(|(line, text)| match line {
            0 => format!("{text}\n"),
            _ => format!(
                "{}{}\n",
                text.split(',').take(3).collect::<Vec<_>>().join(","),
                ",0".repeat(51)
            ),
        })
        .collect();
    assert!(
        told(&tracks, &rest, Language::English)
            .contains("of clips that move no shape with one of ARKit’s names")
    );
    // Without the tables the report says how to give them.
    let table = Table::parse(export(&study, &Raters { people: 4, effect: 0.0, seed: 7 })).unwrap();
    let without =
        analyze_with(&table, &study, Language::English, ReportOptions::default()).unwrap();
    assert!(file(&without, "report.md").contains("takes them as --tracks and --courses"));
    // A study that measures none says nothing of it.
    let without =
        analyze_with(&table, &demo_study(), Language::English, ReportOptions::default()).unwrap();
    assert!(!file(&without, "report.md").contains("Mimicry"));
}

#[test]
fn tables_that_are_none_are_refused_with_their_place() {
    let study = study();
    let courses = courses(&study);
    let (tracks, csv) = (tracks_csv(&study, &courses, 1, 0.0, 0.1), courses_csv(&courses));
    let refused =
        |tracks: &str, courses: &str| match report(&study, tracks, courses, Language::English) {
            Err(ExportError::Mimicry(error)) => error,
            other => panic!("{other:?}"),
        };
    let error = refused(&tracks.replace("time_ms", "when"), &csv);
    assert_eq!(error, MimicryError::NoColumn { table: "tracks", column: "time_ms".to_owned() });
    let error = refused(&tracks, &csv.replacen("jawOpen", "jaw", 1));
    assert_eq!(error, MimicryError::NoColumn { table: "courses", column: "jawOpen".to_owned() });
    let error = refused(&tracks.replacen("true,13.000,true", "true,soon,true", 1), &csv);
    assert!(
        matches!(&error, MimicryError::NotANumber { table: "tracks", line: 2, cell, .. } if cell == "soon"),
        "{error}"
    );
    let error = refused(&tracks, &csv.replacen(",p,16.667", ",p,0", 1));
    assert_eq!(error, MimicryError::Time { table: "courses", line: 3 });
}
