//! What was prepared before is known by the hash of what it was made of.

use mimique_stimulus::{Places, prepare};
use serde_json::{Value, json};

use crate::support::study::study_of;

#[test]
fn what_was_prepared_is_known_by_hash() {
    let folder = tempfile::tempdir().unwrap();
    let packs = folder.path().join("packs");
    let write = |end: f64| {
        let text = format!("frame,time,jawOpen,mouthSmileLeft\n0,0,0,0\n1,0.02,{end},0.5\n");
        std::fs::write(folder.path().join("weights.csv"), text).unwrap();
    };
    let mut stimuli = json!({
        "avatars": {"ada": {"builtin": {"seed": 3, "vertices": 2000}}},
        "captures": {"actor": {"builtin": {"actor": 1}}, "phone": {"file": "weights.csv"}},
        "segments": [
            {"id": "joy2", "capture": "actor",
             "performance": {"expression": "joy", "intensity": 2}},
            {"id": "talk", "capture": "phone", "first": 0, "end": 2},
        ],
        "methods": {"box": {"method": "box"}, "own": {"method": "recorded"}},
        "clips": {"list": [
            {"avatar": "ada", "segment": "joy2", "method": "box"},
            {"avatar": "ada", "segment": "talk", "method": "own"},
        ]},
    });
    let places = Places { study: folder.path().to_owned(), data: None, packs: packs.clone() };
    let prepare_now = |stimuli: &Value| {
        let mut worked_at = Vec::new();
        let prepared = prepare(&study_of(stimuli), &places, &mut |progress| {
            if progress.done < progress.total {
                worked_at.push(progress.what.to_owned());
            }
        });
        (prepared.unwrap(), worked_at.len())
    };
    write(0.2);
    let (first, worked_at) = prepare_now(&stimuli);
    assert_eq!(worked_at, 2);
    let (again, worked_at) = prepare_now(&stimuli);
    assert_eq!((again, worked_at), (first.clone(), 0), "nothing is read or solved anew");
    // A file with other content, and the same one again.
    write(0.9);
    let (changed, worked_at) = prepare_now(&stimuli);
    assert_eq!(worked_at, 2);
    assert_ne!(changed, first);
    write(0.2);
    assert_eq!(prepare_now(&stimuli), (first.clone(), 2));
    // A pack that is gone, or is not what it was.
    let pack = packs.join(first.clips.values().next().unwrap().packs().next().unwrap());
    let bytes = std::fs::read(&pack).unwrap();
    std::fs::remove_file(&pack).unwrap();
    assert_eq!(prepare_now(&stimuli), (first.clone(), 2));
    std::fs::write(&pack, &bytes[1..]).unwrap();
    assert_eq!(prepare_now(&stimuli), (first.clone(), 2));
    assert_eq!(std::fs::read(&pack).unwrap(), bytes);
    assert_eq!(prepare_now(&stimuli), (first.clone(), 0));
    // Other stimuli of the same files.
    stimuli["methods"]["box"]["gain"] = json!(0.5);
    assert_eq!(prepare_now(&stimuli).1, 2);
}
