//! A gaze that is given is shown by every method and by recorded weights, whatever the markers do.

use mimique_actor::{
    Clip, Density, Emotion, HeadSpec, SyntheticTake, build_head, marker_sites, synthetic_take,
};
use mimique_avatar::{GazeAngles, GazeShapes};
use mimique_clip::solve_packs;
use mimique_geometry::{Displacement, Point, align_rigidly};
use mimique_mocap::Capture;
use mimique_solver::{Gaze, Method, MethodSpec};
use mimique_stimulus::{
    AvatarSkin, GazeStatistics, GazeTrack, GivenGaze, MarkerMap, Places, SolvedCapture,
    TakeOptions, built_in_capture, built_in_map, prepare, solve_take,
};
use serde_json::json;

use crate::support::study::study_of;

/// A built-in actor's joy on the actor's own head.
struct Scene {
    skin: AvatarSkin,
    take: SyntheticTake,
    capture: Capture,
    map: MarkerMap,
}

impl Scene {
    fn new() -> Self {
        let spec = HeadSpec { density: Density::COARSE, ..HeadSpec::actor(3) };
        let (head, sites) = (build_head(&spec), marker_sites(&spec));
        let clip = Clip { emotion: Emotion::Joy, intensity: 3, seed: 1 };
        let take = synthetic_take(&head, &sites, &[clip], 5, 0.05);
        Self {
            skin: AvatarSkin::of(&head).unwrap(),
            capture: built_in_capture(&take),
            map: built_in_map(&sites),
            take,
        }
    }

    fn solve(&self, spec: &MethodSpec, gaze: Option<GivenGaze>) -> SolvedCapture {
        self.try_solve(&self.capture, spec, gaze).unwrap()
    }

    fn try_solve(
        &self,
        capture: &Capture,
        spec: &MethodSpec,
        gaze: Option<GivenGaze>,
    ) -> Result<SolvedCapture, mimique_stimulus::SolveError> {
        let [first, end] = self.take.neutral;
        let options = TakeOptions {
            neutral: Some(first..end),
            head: Some(self.take.head_labels.clone()),
            gaze,
            ..TakeOptions::default()
        };
        solve_take(&self.skin, capture, &self.map, spec, &options, &mut || 0.0)
    }

    fn gaze(&self, solved: &SolvedCapture, row: usize) -> GazeAngles {
        let shapes = GazeShapes::of(&self.skin.shape_names);
        shapes.eyes(solved.table.row(row)).gaze().unwrap()
    }
}

#[test]
fn every_method_shows_the_gaze_that_is_given() {
    let scene = Scene::new();
    let angles = |azimuth| GazeAngles { azimuth, elevation: -8.0, vergence: 4.0 };
    let seconds = vec![0.0, 2.0, 4.0];
    let track = GazeTrack::new(seconds, vec![angles(-10.0), angles(10.0), angles(0.0)]).unwrap();
    for method in [Method::Lsts, Method::Box, Method::Ridge, Method::Kouadio] {
        for asked in [Gaze::Rest, Gaze::Markers] {
            let spec = MethodSpec { gaze: Some(asked), ..MethodSpec::new(method) };
            let solved = scene.solve(&spec, Some(GivenGaze::Track(track.clone())));
            for row in [0, 200, 300, 500] {
                let (is, wanted) = (scene.gaze(&solved, row), track.at(row as f64 / 200.0));
                for (a, b) in [
                    (is.azimuth, wanted.azimuth),
                    (is.elevation, wanted.elevation),
                    (is.vergence, wanted.vergence),
                ] {
                    assert!((a - b).abs() < 1e-9, "{method}, row {row}: {is:?} {wanted:?}");
                }
            }
            let said = solved.report.gaze.unwrap();
            assert!(said.words().contains("elevation -8.0 to -8.0"), "{said:?}");
            assert!(solved.report.gaze_at_rest.is_empty());
            assert!(!solved.report.warnings.iter().any(|w| w.to_string().contains("gaze")));
        }
    }
    // Without a gaze the eyes rest, and what is known of the take differs.
    let spec = MethodSpec::new(Method::Box);
    let rests = scene.solve(&spec, None);
    assert!(rests.report.gaze.unwrap().is_still());
    let held = scene.solve(&spec, Some(GivenGaze::Held(angles(5.0))));
    assert_ne!(held.report.provenance, rests.report.provenance);
    // The given gaze is no worse for the markers than eyes that rest, but for the lids.
    assert_eq!(held.report.markers, rests.report.markers);
}

#[test]
fn the_eyes_turn_to_a_marker_wherever_the_head_goes() {
    let scene = Scene::new();
    let spec = MethodSpec::new(Method::Box);
    let people = HeadSpec { density: Density::COARSE, ..HeadSpec::actor(3) };
    let (head, sites) = (build_head(&people), marker_sites(&people));
    // A point 40 cm before the face, to its left and above, that goes with the skull.
    let [left, right] = scene.skin.eyes.unwrap();
    let middle = left + (right - left) * 0.5;
    let looked_at = middle + Displacement::new(0.07, 0.04, 0.4);
    let on_skull: Vec<Point> = (scene.take.head_labels.iter())
        .map(|label| {
            let site = sites.labels.iter().position(|l| l == label).unwrap();
            let vertex = sites.vertices[site] as usize;
            Point::from(head.skin().unwrap().positions[vertex].map(|x| 1e3 * f64::from(x)))
        })
        .collect();
    let mut capture = scene.capture.clone();
    let columns: Vec<usize> =
        scene.take.head_labels.iter().map(|l| capture.marker_index(l).unwrap()).collect();
    let mut positions = Vec::new();
    for frame in 0..capture.frames() {
        let row = capture.frame(frame).to_vec();
        let seen: Vec<Point> = columns.iter().map(|&c| row[c]).collect();
        let pose = align_rigidly(&on_skull, &seen).unwrap();
        let target = pose.apply(Point::ORIGIN + (looked_at - Point::ORIGIN) * 1e3);
        positions.extend(row);
        // Lost for a while: the eyes stay where they were.
        let lost = (300..310).contains(&frame);
        positions.push(if lost { Point::from([f64::NAN; 3]) } else { target });
    }
    capture.positions = positions;
    capture.labels.push("PointOfGaze".to_owned());
    let given = GivenGaze::Target("PointOfGaze".to_owned());
    let solved = scene.try_solve(&capture, &spec, Some(given.clone())).unwrap();
    let angle = |across: f64, along: f64| across.atan2(along).to_degrees();
    let half = (left - right).length() / 2.0;
    let wanted = [
        f64::midpoint(angle(0.07 - half, 0.4), angle(0.07 + half, 0.4)),
        angle(0.04, 0.4_f64.hypot(0.07)),
        angle(0.07 + half, 0.4) - angle(0.07 - half, 0.4),
    ];
    for row in 0..capture.frames() {
        let is = scene.gaze(&solved, row);
        for (is, wanted) in [is.azimuth, is.elevation, is.vergence].into_iter().zip(wanted) {
            assert!((is - wanted).abs() < 0.5, "row {row}: {is} {wanted}");
        }
    }
    let error = scene.try_solve(&scene.capture, &spec, Some(given)).unwrap_err();
    assert!(
        error.to_string().starts_with("gaze target PointOfGaze: not in the capture"),
        "{error}"
    );
}

#[test]
fn a_study_shows_one_gaze_by_every_method_and_by_the_performance_itself() {
    let study = |gaze: serde_json::Value| {
        study_of(&json!({
            "avatars": {"own": {"builtin": {"actor": 1, "vertices": 2000}}},
            "captures": {"actor": {"builtin": {"actor": 1}, "rateHz": 60, "gaze": gaze}},
            "segments": [{"id": "joy2", "capture": "actor",
                          "performance": {"expression": "joy", "intensity": 2}}],
            "methods": {"lsts": {"method": "lsts", "alpha": 0.3}, "box": {"method": "box"},
                        "real": {"method": "recorded"}},
        }))
    };
    let packs = tempfile::tempdir().unwrap();
    let places = Places { study: packs.path().into(), data: None, packs: packs.path().into() };
    let gazes = |gaze: serde_json::Value| -> Vec<Vec<GazeAngles>> {
        let prepared = prepare(&study(gaze), &places, &mut |_| ()).unwrap();
        let read = |hash: &str| std::fs::read(packs.path().join(hash)).unwrap();
        (prepared.clips.values())
            .map(|clip| {
                let solved =
                    solve_packs(&read(&clip.operators), &read(&clip.take), &clip.method).unwrap();
                let shapes = GazeShapes::of(&solved.shape_names);
                let rows = solved.weights.chunks_exact(solved.shape_names.len());
                rows.map(|row| shapes.eyes(row).gaze().unwrap()).collect()
            })
            .collect()
    };
    for gaze in [
        json!({"performed": true}),
        json!({"held": {"azimuth": -6, "elevation": 3, "vergence": 2}}),
    ] {
        let shown = gazes(gaze.clone());
        assert_eq!(shown.len(), 3);
        for other in &shown[1..] {
            assert_eq!(other.len(), shown[0].len());
            for (a, b) in other.iter().zip(&shown[0]) {
                // Weights lie on the steps of packs.
                let far = (a.azimuth - b.azimuth).abs().max((a.elevation - b.elevation).abs());
                assert!(far < 0.02 && (a.vergence - b.vergence).abs() < 0.02, "{a:?} {b:?}");
            }
        }
        let moves = shown[0].windows(2).any(|pair| pair[0] != pair[1]);
        assert_eq!(moves, gaze["performed"] == true);
    }
    let file = packs.path().join("gaze.csv");
    std::fs::write(&file, "frame,time,azimuth,elevation\n0,0,9,1\n1,60,9,1\n").unwrap();
    assert!((gazes(json!({"file": "gaze.csv"}))[0][7].azimuth - 9.0).abs() < 0.01);
    std::fs::write(&file, "frame,time,jawOpen\n0,0,9\n1,60,9\n").unwrap();
    let error =
        prepare(&study(json!({"file": "gaze.csv"})), &places, &mut |_| ()).unwrap_err().remove(0);
    assert_eq!(error.pointer, "/stimuli/captures/actor/gaze/file");
    assert!(error.message.contains("no column tells a gaze (there are jawOpen)"), "{error}");
}

#[test]
fn a_performance_whose_eyes_part_is_warned_of() {
    let scene = Scene::new();
    let mut table = scene.solve(&MethodSpec::new(Method::Box), None).table;
    let n = table.shape_names.len();
    let at = |name: &str| table.shape_names.iter().position(|s| s == name).unwrap();
    let (left, right) = (at("eyeLookOutLeft"), at("eyeLookOutRight"));
    for row in table.weights.chunks_exact_mut(n).take(3) {
        (row[left], row[right]) = (0.3, 0.28);
    }
    let said = GazeStatistics::of(&table.shape_names, &table.weights)
        .unwrap()
        .warning(7)
        .unwrap()
        .to_string();
    assert!(
        said.starts_with("3 frames with a gaze that eyes do not have; at worst, in frame 7"),
        "{said}"
    );
    assert!(said.contains("diverge by 17.4 degrees"), "{said}");
}
