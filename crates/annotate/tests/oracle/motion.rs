//! Energies, borders, stretches and features of whole takes.

use mimique_annotate::features::{StretchFeatures, level, mean, velocity};
use mimique_annotate::stretches::{Literal, activity, borders, root, stretches};
use mimique_annotate::{CUTOFF_HZ, Rows, Take};
use mimique_stimulus::ActivityOptions;
use serde_json::Value;

use crate::cases::{
    indices, json, list, near, number, numbers, relative, table, take, text, words,
};

fn case_take(test: &str, case: &Value) -> (Take, Vec<String>) {
    take(test, case["take"].as_str().unwrap(), number(&case["rate_hz"])).unwrap()
}

fn without(take: &Take, shapes: &[String], left_out: impl Fn(&str) -> bool) -> Take {
    let kept: Vec<usize> = (0..shapes.len()).filter(|&i| !left_out(&shapes[i])).collect();
    take.columns(&kept).unwrap()
}

#[test]
fn energies_borders_and_stretches() {
    let Some(cases) = json("energies_borders_and_stretches", "segmentation.json") else { return };
    for (place, case) in list(&cases).iter().enumerate() {
        let (take, shapes) = case_take("energies", case);
        let ignored = words(&case["ignore"]);
        let take = without(&take, &shapes, |shape| ignored.contains(&shape));
        let options = ActivityOptions {
            cutoff_hz: number(&case["cutoff_hz"]),
            time_unit_s: number(&case["time_unit_s"]),
        };
        let activity = activity(&take, &options).unwrap();
        let at = indices(&case["frames"]);
        for (name, found) in [
            ("velocity", &activity.velocity),
            ("acceleration", &activity.acceleration),
            ("energy", &activity.energy),
        ] {
            let found: Vec<f64> = at.iter().map(|&f| found[f]).collect();
            let what = format!("case {place}, {name}");
            relative(&found, &numbers(&case[name]), 1e-9, 1e-300, &what);
        }
        let found = borders(&activity, take.rate_hz);
        assert_eq!(found, indices(&case["borders"]), "case {place}");
        let ranges: Vec<Vec<usize>> =
            stretches(&found, take.frames()).iter().map(|r| vec![r.start, r.end]).collect();
        let expected: Vec<Vec<usize>> = list(&case["stretches"]).iter().map(indices).collect();
        assert_eq!(ranges, expected, "case {place}");
        let literal = Literal {
            window_s: number(&case["literal"]["window_s"]),
            share: number(&case["literal"]["share"]),
        };
        let found = literal.borders(&activity.energy, take.rate_hz);
        assert_eq!(found, indices(&case["literal"]["borders"]), "case {place}, literal");
    }
}

/// The frames that the annotator called neutral.
fn neutral_frames(test: &str, take: &str) -> Vec<usize> {
    let name = format!("takes/{}.labels.csv", take.trim_end_matches(".csv"));
    let (_, rows) = table(&text(test, &name).unwrap());
    let frame = |cell: &String| cell.parse::<usize>().unwrap();
    let neutral = rows.iter().filter(|row| row[0] == "neutral");
    neutral.flat_map(|row| frame(&row[1])..=frame(&row[2])).collect()
}

#[test]
fn frames_and_segments_in_numbers() {
    let Some(cases) = json("frames_and_segments_in_numbers", "features.json") else { return };
    for case in list(&cases) {
        let (take, shapes) = case_take("features", case);
        let name = case["take"].as_str().unwrap();
        let rate = take.rate_hz;
        let smooth = take.smooth(CUTOFF_HZ).unwrap();
        let neutral = neutral_frames("features", name);
        assert_eq!(neutral.len(), case["neutral_frames"].as_u64().unwrap() as usize);
        let face = mean(&smooth, neutral);
        near(&face, &numbers(&case["neutral"]), 1e-9, name);
        let speed = velocity(&smooth, rate).unwrap();
        let at = indices(&case["frames"]);
        let picked =
            |rows: &Rows| -> Vec<f64> { rows.select(at.iter().copied()).values().to_vec() };
        near(&picked(&take.weights), &numbers(&case["weights"]), 1e-9, name);
        near(&picked(&smooth), &numbers(&case["smooth"]), 1e-9, name);
        near(&picked(&speed), &numbers(&case["velocity"]), 1e-9 * rate, name);
        let away: Vec<f64> =
            picked(&smooth).iter().zip(face.iter().cycle()).map(|(w, n)| w - n).collect();
        near(&away, &numbers(&case["minus_neutral"]), 1e-9, name);
        let levels = level(&smooth, &face);
        let levels: Vec<f64> = at.iter().map(|&f| levels[f]).collect();
        near(&levels, &numbers(&case["level"]), 1e-9, name);
        let moving =
            without(&take, &shapes, |s| s.starts_with("eyeBlink") || s.starts_with("eyeLook"));
        let options = ActivityOptions { cutoff_hz: 3.0, time_unit_s: 0.1 };
        let activity = activity(&moving, &options).unwrap();
        let found = stretches(&borders(&activity, rate), take.frames());
        let segments = list(&case["segments"]);
        assert_eq!(found.len(), segments.len(), "{name}");
        for (stretch, expected) in found.into_iter().zip(segments) {
            let bounds =
                [&expected["first"], &expected["end"]].map(|v| v.as_u64().unwrap() as usize);
            assert_eq!([stretch.start, stretch.end], bounds, "{name}");
            let found = StretchFeatures::of(&take, &speed, &root(&activity), stretch).unwrap();
            near(&found.mean, &numbers(&expected["mean"]), 1e-9, name);
            near(&found.median, &numbers(&expected["median"]), 1e-9, name);
            near(&found.deviation, &numbers(&expected["deviation"]), 1e-9, name);
            near(&found.speed, &numbers(&expected["speed"]), 1e-9 * rate, name);
            near(&found.calm_mean, &numbers(&expected["calm_mean"]), 1e-9, name);
            let calm = [found.calm.len(), found.calm[0], found.calm[found.calm.len() - 1]];
            let expected = ["calm_frames", "calm_first", "calm_last"]
                .map(|key| expected[key].as_u64().unwrap() as usize);
            assert_eq!(calm, expected, "{name}");
        }
    }
}
