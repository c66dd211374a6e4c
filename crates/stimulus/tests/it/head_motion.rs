//! The head's own motion: what head markers tell is what the actor did, and every method shows the same.

use mimique_avatar::pack::decode_pack;
use mimique_avatar::{HEAD_POSE_SHAPES, HeadAngles};
use mimique_clip::{SolvedTake, solve_packs};
use mimique_stimulus::{Places, Prepared, prepare};
use serde_json::{Value, json};

use crate::support::study::study_of;

/// The clips of an actor's sadness by three methods and as it was performed, at 60 frames per second.
fn prepared(capture: Value, packs: &std::path::Path) -> Prepared {
    let study = study_of(&json!({
        "avatars": {"own": {"builtin": {"actor": 1, "vertices": 2000}}},
        "captures": {"actor": capture},
        "segments": [{"id": "sadness3", "capture": "actor",
                      "performance": {"expression": "sadness", "intensity": 3}}],
        "methods": {"lsts": {"method": "lsts"}, "box": {"method": "box"},
                    "surface": {"method": "thin-shell-surface"}, "real": {"method": "recorded"}},
    }));
    let places = Places { study: packs.to_owned(), data: None, packs: packs.to_owned() };
    prepare(&study, &places, &mut |_| {}).unwrap()
}

fn solved(prepared: &Prepared, packs: &std::path::Path, method: &str) -> SolvedTake {
    let source = &prepared.clips[&format!("sadness3.{method}")];
    let fetch = |hash: &str| std::fs::read(packs.join(hash)).unwrap();
    let solved =
        solve_packs(&fetch(&source.operators), &fetch(&source.take), &source.method).unwrap();
    assert_eq!(solved.weights_hash, source.weights_hash);
    // The stage takes weights in the avatar's order; those of the shapes at the end may be left out.
    let avatar = decode_pack(&fetch(&source.avatar)).unwrap();
    assert!(avatar.shape_names.starts_with(&solved.shape_names), "{:?}", solved.shape_names);
    solved
}

/// The head in every frame; nothing where the clip does not turn it.
fn head(solved: &SolvedTake) -> Vec<HeadAngles> {
    let place = |name: &str| solved.shape_names.iter().position(|own| own == name);
    let [Some(nod), Some(turn), Some(tilt)] = HEAD_POSE_SHAPES.map(place) else {
        return Vec::new();
    };
    let rows = solved.weights.chunks_exact(solved.shape_names.len());
    rows.map(|row| HeadAngles::of_weights([row[nod], row[turn], row[tilt]])).collect()
}

fn most(angles: impl Iterator<Item = f64>) -> f64 {
    angles.fold(0.0, f64::max)
}

#[test]
fn head_markers_tell_what_the_actor_did_and_every_method_shows_it() {
    let packs = tempfile::tempdir().unwrap();
    let whole = prepared(json!({"builtin": {"actor": 1}, "rateHz": 60}), packs.path());
    let performed = head(&solved(&whole, packs.path(), "real"));
    let far = most(performed.iter().map(|angles| angles.apart(&HeadAngles::default())));
    assert!((2.0..15.0).contains(&far), "a head that moves a little: {far} degrees");
    let lsts = head(&solved(&whole, packs.path(), "lsts"));
    assert_eq!(lsts.len(), performed.len());
    let off = most(lsts.iter().zip(&performed).map(|(a, b)| a.apart(b)));
    assert!(off < 0.3, "{off} degrees from what was performed");
    for method in ["box", "surface"] {
        assert_eq!(head(&solved(&whole, packs.path(), method)), lsts, "{method}");
    }
    // A share of it, and none.
    let half =
        prepared(json!({"builtin": {"actor": 1}, "rateHz": 60, "headMotion": 0.5}), packs.path());
    for method in ["lsts", "real"] {
        let (all, half) = (
            head(&solved(&whole, packs.path(), method)),
            head(&solved(&half, packs.path(), method)),
        );
        let off = most(all.iter().zip(&half).map(|(a, b)| {
            let twice = HeadAngles { nod: 2.0 * b.nod, turn: 2.0 * b.turn, tilt: 2.0 * b.tilt };
            a.apart(&twice)
        }));
        // Packs keep weights in steps of 0.0001, a thousandth of a degree.
        assert!(off < 0.005, "{method}: {off}");
    }
    let still =
        prepared(json!({"builtin": {"actor": 1}, "rateHz": 60, "headMotion": 0}), packs.path());
    assert!(head(&solved(&still, packs.path(), "lsts")).is_empty());
    let real = head(&solved(&still, packs.path(), "real"));
    assert_eq!(most(real.iter().map(|angles| angles.apart(&HeadAngles::default()))), 0.0);
    // The face is the same, whatever the head does.
    let face = |prepared| {
        let solved = solved(prepared, packs.path(), "lsts");
        let n = solved.shape_names.iter().take_while(|name| !name.starts_with("head")).count();
        let rows = solved.weights.chunks_exact(solved.shape_names.len());
        rows.flat_map(|row| row[..n].to_vec()).collect::<Vec<f64>>()
    };
    assert_eq!(face(&whole), face(&still));
}
