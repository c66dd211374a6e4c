//! The suggested marker map against maps made by hand, whatever way up the capture is.

use mimique_actor::{Clip, Emotion, HeadSpec, Identity, build_head, marker_sites, synthetic_take};
use mimique_geometry::{DQuat, Displacement, RigidMotion};
use mimique_mocap::{Capture, LengthUnit};
use mimique_stimulus::{
    AvatarSkin, MarkerMap, MarkerRole, SuggestMapError, SuggestedMap, suggest_map,
};
use mimique_test_support::real_data;

/// Distance of each suggested vertex from the one that a person chose, millimetres, sorted.
fn errors_mm(skin: &AvatarSkin, map: &MarkerMap, suggested: &SuggestedMap) -> Vec<f64> {
    let sites = map.resolve(skin).unwrap();
    let mut errors: Vec<f64> = (sites.iter())
        .map(|site| {
            let found = suggested.markers.iter().find(|m| m.label == site.label).unwrap();
            let right = skin.mesh.positions[site.vertex()];
            let place = found.vertex.map_or(found.place, |v| skin.mesh.positions[v]);
            1e3 * (place - right).length()
        })
        .collect();
    errors.sort_by(f64::total_cmp);
    errors
}

/// The capture turned, moved and in another unit.
fn turned(capture: &Capture, quaternion: [f64; 4]) -> Capture {
    let motion = RigidMotion::turn(DQuat::from_array(quaternion));
    let positions = capture
        .positions
        .iter()
        .map(|&p| motion.apply(p) + Displacement::new(1200.0, -300.0, 77.0));
    Capture { positions: positions.collect(), ..capture.clone() }
}

fn unit(q: [f64; 4]) -> [f64; 4] {
    let length = q.iter().map(|x| x * x).sum::<f64>().sqrt();
    q.map(|x| x / length)
}

const WAYS: [[f64; 4]; 6] = [
    [0.0, 0.0, 0.0, 1.0],
    [1.0, 0.0, 0.0, 1.0],
    [0.0, 1.0, 0.0, 1.0],
    [0.2, -0.9, 0.3, 0.1],
    [-0.5, 0.5, 0.5, 0.5],
    [0.8, 0.1, -0.4, 0.3],
];

#[test]
fn the_built_in_actor_s_markers_are_found_on_another_person_whatever_way_up() {
    let actor = HeadSpec { identity: Identity::from_seed(77), ..HeadSpec::default() };
    let avatar = HeadSpec { identity: Identity::from_seed(3), ..HeadSpec::default() };
    let clips = [Emotion::Joy, Emotion::Anger, Emotion::Surprise].map(|emotion| Clip {
        emotion,
        intensity: 3,
        seed: 5,
    });
    let take = synthetic_take(&build_head(&actor), &marker_sites(&actor), &clips, 9, 0.1);
    let capture = Capture::new(
        take.labels.clone(),
        take.rate_hz,
        LengthUnit::Millimetre,
        take.positions.clone(),
    );
    let head = build_head(&avatar);
    let skin = AvatarSkin::of(&head).unwrap();
    let sites = marker_sites(&avatar);
    let places = &head.skin().unwrap().positions;
    for way in WAYS {
        let found = suggest_map(&skin, &turned(&capture, unit(way)), None).unwrap();
        let mut errors: Vec<f64> = (sites.face_labels().iter().zip(&sites.vertices))
            .map(|(label, &v)| {
                let m = found.markers.iter().find(|m| m.label == *label).unwrap();
                let right = places[v as usize].map(f64::from);
                let square: f64 = (0..3).map(|a| (m.place[a] - right[a]).powi(2)).sum();
                1e3 * square.sqrt()
            })
            .collect();
        errors.sort_by(f64::total_cmp);
        let median = errors[errors.len() / 2];
        let worst = errors[errors.len() - 1];
        assert!(median < 6.0, "{way:?}: {median} mm");
        assert!(worst < 12.0, "{way:?}: {worst} mm");
        let map = found.to_map(&skin);
        assert!(map.head.len() >= 3, "{:?}", map.head);
        // What it says is a map that is read back.
        let again = MarkerMap::from_text(&map.to_json()).unwrap();
        assert_eq!(again, map);
    }
}

#[test]
fn real_takes_are_laid_on_ict_facekit_as_by_hand() {
    let Some(data) = real_data("real_takes_are_laid_on_ict_facekit_as_by_hand") else { return };
    let read = |path: &str| mimique_mocap::read(&data.join(path)).unwrap();
    let skin = |path: &str| {
        AvatarSkin::of(&mimique_avatar_files::read_avatar(&data.join(path)).unwrap().avatar)
            .unwrap()
    };
    let text = |path: &str| std::fs::read_to_string(data.join(path)).unwrap();
    let ict = skin("ict-facekit/ict-facekit.glb");
    let planted = skin("lsts/avatar_skin.glb");
    let mut worst_medians = Vec::new();
    for (capture, skin, map) in [
        ("animface/JawMoCap.c3d", &ict, "animface/markers-ict-facekit.json"),
        ("animface/CheeksMoCap.c3d", &ict, "animface/markers-ict-facekit.json"),
        ("lsts/take_n01.c3d", &planted, "lsts/mapping.csv"),
    ] {
        let capture_of = read(capture);
        let map = MarkerMap::from_text(&text(map)).unwrap();
        for way in &WAYS[..3] {
            let found = suggest_map(skin, &turned(&capture_of, unit(*way)), None).unwrap();
            let errors = errors_mm(skin, &map, &found);
            let median = errors[errors.len() / 2];
            let worst = errors[errors.len() - 1];
            worst_medians.push((median, worst));
            let head = found.to_map(skin).head;
            assert!(head.len() >= 3, "{head:?}");
            let moves = |label: &String| {
                ["Mouth", "Chin", "brow", "eye", "cheek"].iter().any(|word| label.contains(word))
            };
            assert!(!head.iter().any(moves), "the head is taken from the skull: {head:?}");
        }
    }
    // The actor of AnimFace has a face of other proportions: a similarity leaves 7.2 mm rms at best.
    assert!(worst_medians[..6].iter().all(|m| m.0 < 4.5 && m.1 < 12.0), "{worst_medians:?}");
    // Labels that say nothing; a face of the avatar's own kind.
    assert!(worst_medians[6..].iter().all(|m| m.0 < 5.0 && m.1 < 10.0), "{worst_medians:?}");
}

#[test]
fn too_little_is_refused_with_a_remedy() {
    let spec = HeadSpec::default();
    let skin = AvatarSkin::of(&build_head(&spec)).unwrap();
    let capture = Capture::new(
        (0..4).map(|i| format!("M{i}")).collect(),
        100.0,
        LengthUnit::Millimetre,
        (0..400).map(|i| [f64::from(i % 4), f64::from(i % 4 % 2), 0.0]),
    );
    let error = suggest_map(&skin, &capture, None).unwrap_err();
    assert!(matches!(error, SuggestMapError::TooFew { seen: 4, .. }), "{error}");
    let error = suggest_map(&skin, &capture, Some(90..200)).unwrap_err();
    assert!(matches!(error, SuggestMapError::Neutral { end: 200, frames: 100, .. }), "{error}");
    let role = serde_json::to_value(MarkerRole::FaceAndHead).unwrap();
    assert_eq!(role, "face_and_head");
}
