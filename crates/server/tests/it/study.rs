//! A small study without clips, and the pages' stand-ins.

use std::collections::BTreeMap;
use std::path::Path;

use mimique_server::{Assets, HostedStudy, PackStore, Stage};
use serde_json::{Value, json};
use sha2::{Digest, Sha256};

/// What the only pack holds.
pub fn pack() -> String {
    "a pack ".repeat(500)
}

/// SHA-256, hexadecimal.
pub fn sha256(text: &str) -> String {
    hex::encode(Sha256::digest(text))
}

/// A study of one questionnaire.
pub fn file() -> Value {
    json!({
        "id": "faces",
        "studyMetadata": {
            "title": {"en": "Faces & <feelings>", "fr": "Visages"},
            "version": "1.0.0",
        },
        "languages": ["en", "fr"],
        "seed": 9_007_199_254_740_991_u64,
        "recruitment": {
            "completionCode": "C1 X",
            "redirect": "https://example.org/back?cc={code}&who={PROLIFIC_PID}",
            "urlParameters": ["PROLIFIC_PID"],
        },
        "components": {"how": {"type": "questionnaire", "questions": [{
            "id": "mood",
            "prompt": {"en": "How are you?", "fr": "Comment allez-vous ?"},
            "type": "likert", "numItems": 7, "start": 1,
        }]}},
        "sequence": {"order": "fixed", "components": ["how"]},
        "stimuli": {"avatars": {}, "captures": {}, "segments": [], "methods": {}},
        "hypotheses": [],
    })
}

/// The study as hosted.
pub fn hosted() -> HostedStudy {
    host(file())
}

/// The file of the demo study.
pub fn demo_file() -> Value {
    of("demo")
}

/// The file of a study of `study-config`.
pub fn of(name: &str) -> Value {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../study-config");
    let path = folder.join(format!("{name}.json"));
    mimique_study::parse(&std::fs::read_to_string(path).unwrap()).unwrap()
}

/// The demo study as hosted, without its packs.
pub fn demo() -> HostedStudy {
    host(demo_file())
}

/// A study as hosted, without packs.
pub fn host(file: Value) -> HostedStudy {
    HostedStudy::new(file, BTreeMap::new(), Stage::Live).unwrap()
}

/// Pages as small as they can be.
pub fn assets(folder: &Path) -> Assets {
    let folder = folder.join("pages");
    std::fs::create_dir_all(&folder).unwrap();
    for (name, text) in [
        (
            "participant/index.html",
            "<!doctype html><html lang=\"{{lang}}\"><title>{{title}}</title>\
             <meta content=\"packs={{packs}}\">\
             <script src=\"{{assets}}/app.js\"></script></head>",
        ),
        (
            "studio/studio.html",
            "<!doctype html><body data-files=\"{{files}}\" data-token=\"{{token}}\">",
        ),
        ("researcher/preview.html", "<!doctype html><p>{{assets}}</p>"),
        ("style/style.css", &"p { color: black }\n".repeat(100)),
        ("app.js", "export {};"),
    ] {
        let path = folder.join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, text).unwrap();
    }
    Assets::from_folder(&folder).unwrap()
}

/// One pack.
pub fn packs(folder: &Path) -> PackStore {
    std::fs::write(folder.join(sha256(&pack())), pack()).unwrap();
    let mut packs = PackStore::default();
    packs.load(folder, &sha256(&pack())).unwrap();
    packs
}
