//! What makes a site a study of JATOS (<https://www.jatos.org>, since version 3): an archive with one folder, the study's
//! assets, and beside it a file `*.jas` that describes the study, of one component, the participant's page.
//!
//! Answers go by its API as they come: what is posted to `resultData` beside the page is appended to the result of the
//! run. It takes 5 MB of results a run unless its administrator says otherwise (`jatos.resultData.maxSize`).

use mimique_clip::sha256_hex;
use mimique_study::{Multilingual as _, StaticHosting, Study};
use serde_json::{Value, json};

/// The script that starts the page there.
pub(super) const BOOT: &str = "participant/jatos.js";

/// What the page's policy allows beside its own files: JATOS's script puts what it loads, and the style of what it says,
/// into the page itself.
pub(super) const INLINE: &str = "'unsafe-inline'";

/// Where answers go: to the run that the page belongs to.
pub(super) fn hosting() -> StaticHosting {
    StaticHosting { post: Some("resultData".to_owned()), post_progress: true, download: false }
}

/// Ways to reach a study there, all of them: the researcher chooses among them in JATOS.
const WORKER_TYPES: [&str; 7] = [
    "Jatos",
    "PersonalSingle",
    "PersonalMultiple",
    "GeneralSingle",
    "GeneralMultiple",
    "MT",
    "MTSandbox",
];

/// Most letters of a title there.
const TITLE: usize = 255;

/// Name of the folder and of the file that describes the study.
pub(super) fn folder(study: &Study) -> String {
    format!("mimique-{}", study.id)
}

/// What `*.jas` says. The same study has the same identifiers, so that JATOS offers to put a corrected one in the place of
/// the one that is there.
pub(super) fn description(study: &Study, config_hash: &str) -> Value {
    let language = study.default_language();
    let metadata = &study.study_metadata;
    let title = plain(metadata.title.in_language(language));
    let identifier = |of: &str| uuid(&format!("mimique/jatos/{of}/{}/{title}", study.id));
    json!({
        "version": "3",
        "data": {
            "uuid": identifier("study"),
            "title": title,
            "description": plain(metadata.description.in_language(language)),
            "groupStudy": false,
            "linearStudy": false,
            "allowPreview": false,
            "dirName": folder(study),
            "comments": format!("Made by mimique {}, configuration {config_hash}", env!("CARGO_PKG_VERSION")),
            "studyInput": null,
            "endRedirectUrl": null,
            "studyEntryMsg": null,
            "componentList": [{
                "uuid": identifier("component"),
                "title": title,
                "htmlFilePath": "index.html",
                // A reload goes on where it was.
                "reloadable": true,
                "active": true,
                "comments": "",
                "componentInput": null,
            }],
            "batchList": [{
                "uuid": identifier("batch"),
                "title": "Default",
                "active": true,
                "maxActiveMembers": null,
                "maxTotalMembers": null,
                "maxTotalWorkers": null,
                "allowedWorkerTypes": WORKER_TYPES,
                "comments": null,
                "batchInput": null,
            }],
        },
    })
}

/// A text that JATOS takes: it refuses what could be HTML.
fn plain(text: &str) -> String {
    let text: String = text.chars().filter(|letter| !"<>&".contains(*letter)).collect();
    text.chars().take(TITLE).collect()
}

/// A UUID of version 8 (RFC 9562, section 5.8) that a text alone makes.
fn uuid(text: &str) -> String {
    let hash = sha256_hex(text.as_bytes());
    format!(
        "{}-{}-8{}-a{}-{}",
        &hash[..8],
        &hash[8..12],
        &hash[13..16],
        &hash[17..20],
        &hash[20..32]
    )
}
