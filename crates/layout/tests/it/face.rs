//! Landmarks, parts, excluded places and candidates of the built-in head.

use mimique_actor::{HeadSpec, build_head, marker_sites};
use mimique_layout::{Candidates, Excluded, Face, FacePart, Layout, Side, Where};
use mimique_stimulus::{AvatarSkin, MarkerMap, MarkerPlace};

use crate::support;

/// The built-in head with its own markers: labels and vertices of the welded skin.
fn head() -> (AvatarSkin, Vec<(String, usize)>) {
    let spec = HeadSpec::default();
    let skin = AvatarSkin::of(&build_head(&spec)).unwrap();
    let sites = marker_sites(&spec);
    let marked = (sites.face_labels().iter().zip(&sites.vertices))
        .map(|(label, &v)| (label.clone(), skin.welded_from_file[v as usize] as usize))
        .collect();
    (skin, marked)
}

#[test]
fn landmarks_are_where_the_head_was_built() {
    let (skin, marked) = head();
    let face = Face::of(&skin).unwrap();
    let at = |label: &str| face.place(marked.iter().find(|(own, _)| own == label).unwrap().1);
    let mm = |a: mimique_geometry::Point, b: mimique_geometry::Point| 1e3 * (a - b).length();
    let marks = &face.landmarks;
    assert!(mm(marks.pronasale, at("nose_tip")) < 4.0);
    // Between the marked upper and lower lip, which are 2 rings away from the border.
    let (upper, lower) = (at("lip_upper"), at("lip_lower"));
    assert!(upper.y > marks.stomion.y && marks.stomion.y > lower.y);
    assert!(mm(marks.cheilion[0], at("mouth_corner_left")) < 8.0, "{:?}", marks.cheilion);
    assert!(mm(marks.cheilion[1], at("mouth_corner_right")) < 8.0);
    assert!(marks.cheilion[0].x > 0.0 && marks.cheilion[1].x < 0.0, "the person's left is +X");
    assert!(marks.nasion.y < at("glabella").y && marks.nasion.y > marks.pronasale.y);
    assert!(marks.gnathion.y < at("chin").y + 0.004);
}

#[test]
fn parts_and_sides_of_the_head_s_own_markers_are_their_names() {
    let (skin, marked) = head();
    let face = Face::of(&skin).unwrap();
    let part = |label: &str| match label {
        l if l.starts_with("forehead") => Some(FacePart::Forehead),
        // The inner and outer ends of these brows are as low as lids.
        l if l.starts_with("brow_middle") || l == "glabella" => Some(FacePart::Brow),
        l if l.starts_with("lid") => Some(FacePart::Eye),
        l if l.starts_with("nose") => Some(FacePart::Nose),
        l if l.starts_with("lip") => Some(FacePart::Mouth),
        "chin" => Some(FacePart::Chin),
        _ => None,
    };
    let mut named = 0;
    for (label, v) in &marked {
        if let Some(part) = part(label) {
            assert_eq!(face.part(*v), part, "{label}");
            named += 1;
        }
        let side = match label {
            l if l.ends_with("_left") => Side::Left,
            l if l.ends_with("_right") => Side::Right,
            _ => Side::Middle,
        };
        assert_eq!(Side::of(&face, face.place(*v)), side, "{label}");
    }
    assert!(named >= 20, "{named} markers have a part in their name");
}

#[test]
fn candidates_are_moved_seen_allowed_and_as_many_left_as_right() {
    let skin = support::skin();
    let face = Face::of(&skin).unwrap();
    let usual = Candidates::of(&face, &Where::default());
    let counts = usual.counts;
    assert!(counts.vertices > counts.moved && counts.moved > counts.seen);
    assert!(counts.seen == counts.named && counts.named > counts.allowed);
    assert_eq!(counts.allowed, usual.vertices.len());
    for &v in &usual.vertices {
        assert!(face.reach[v] >= 1e-3);
    }
    for part in Excluded::USUAL {
        let mask = part.mask(&face);
        assert!(usual.vertices.iter().all(|&v| !mask[v]), "{part}");
        let less = Where { exclude: vec![part], ..Where::default() };
        let nothing = Where { exclude: vec![], ..Where::default() };
        let (less, all) = (Candidates::of(&face, &less), Candidates::of(&face, &nothing));
        assert!(less.vertices.len() <= all.vertices.len(), "{part}");
        assert_eq!(all.counts.seen, all.counts.allowed);
    }
    let aside = |v: &usize| face.mirror.plane.distance(face.place(*v));
    let left = usual.vertices.iter().filter(|v| aside(v) > 1e-4).count();
    let right = usual.vertices.iter().filter(|v| aside(v) < -1e-4).count();
    assert!(left.abs_diff(right) * 50 < left, "{left} left, {right} right");
}

#[test]
fn regions_keep_and_take_away() {
    let skin = support::skin();
    let face = Face::of(&skin).unwrap();
    let all = Candidates::of(&face, &Where::default());
    let half: Vec<usize> = all.vertices.iter().copied().step_by(2).collect();
    let only = Where { only: Some(half.clone()), ..Where::default() };
    assert_eq!(Candidates::of(&face, &only).vertices, half);
    let without = Where { without: half.clone(), ..Where::default() };
    let rest = Candidates::of(&face, &without).vertices;
    assert_eq!(rest.len() + half.len(), all.vertices.len());
    assert!(rest.iter().all(|v| !half.contains(v)));
}

#[test]
fn labels_number_units_and_a_map_holds_them_where_they_are() {
    let skin = support::skin();
    let face = Face::of(&skin).unwrap();
    let ground = support::Ground::of(&face);
    let units = ground.units(true, &[], 0.008);
    let pair =
        units.each.iter().find(|u| u.len() == 2 && face.part(u[0]) == FacePart::Mouth).unwrap();
    let single = units.each.iter().find(|u| u.len() == 1).unwrap();
    let second =
        units.each.iter().rfind(|u| u.len() == 2 && face.part(u[0]) == FacePart::Mouth).unwrap();
    let chosen = vec![pair.clone(), single.clone(), second.clone()];
    let layout = Layout::named(&face, &chosen, &[5]);
    let labels: Vec<&str> = layout.markers.iter().map(|m| m.label.as_str()).collect();
    assert_eq!(labels[..2], ["Mouth_L1", "Mouth_R1"]);
    assert!(labels[2].ends_with("_M1"));
    let number = if labels[2].starts_with("Mouth") { 3 } else { 2 };
    assert_eq!(labels[3..], [format!("Mouth_L{number}"), format!("Mouth_R{number}")]);
    assert!(layout.head[0].label.starts_with("Head_") && layout.head[0].label.ends_with('1'));

    let text = layout.to_json(&face, serde_json::json!({"method": "greedy"}));
    let map = MarkerMap::from_text(&text).unwrap();
    assert_eq!(map.head, [layout.head[0].label.clone()]);
    let sites = map.resolve(&skin).unwrap();
    for (site, marker) in sites.iter().zip(&layout.markers) {
        assert_eq!(site.label, marker.label);
        assert!((site.position(&skin.mesh) - face.place(marker.vertex)).length() < 1e-9);
    }
    assert!(matches!(map.face[0].place, MarkerPlace::Position(_)));
}
