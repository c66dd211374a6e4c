//! What each file of a deposit is, by its path: in words, as a media type, and under which licence.

use crate::{bids, psych_ds, software, stimuli, study_files};

/// A folder at the top of a deposit and what is in it.
pub(crate) const FOLDERS: [(&str, &str); 6] = [
    (psych_ds::FOLDER, "The answers as a Psych-DS data set: one table, and what its columns mean"),
    (bids::FOLDER, "The same answers as BIDS events: one table for each participant"),
    (
        stimuli::FOLDER,
        "The clips that were shown: a row for each, and the packs that they are played from, named by their SHA-256",
    ),
    (study_files::FOLDER, "The study file, and the files that it names"),
    (
        REPORT,
        "Every table, test and figure, computed from the answers in this deposit; scripts in R and Python that compute them again",
    ),
    (software::FOLDER, "The software: its version, how to get it, what it is made of"),
];

/// The folder of the report.
pub const REPORT: &str = "report";

/// The metadata of the crate.
pub(crate) const METADATA: &str = "ro-crate-metadata.json";
/// The page that shows them.
pub(crate) const PREVIEW: &str = "ro-crate-preview.html";
/// Hashes of all files but itself.
pub(crate) const MANIFEST: &str = "manifest-sha256.txt";

/// Under what a file is put.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Under {
    /// The licence of the data.
    Data,
    /// The licence of the code.
    Code,
    /// The software's own.
    Software,
}

/// What a file is, in words; none where its name says it.
pub(crate) fn words(path: &str) -> Option<&'static str> {
    Some(match path {
        "README.md" => "What lies where in this deposit, and how to compute its results again",
        "CITATION.cff" => "How this data set is cited",
        "LICENSE.md" => "What is under which licence",
        PREVIEW => "This deposit as a page",
        MANIFEST => "SHA-256 of every other file",
        "psych-ds/dataset_description.json" => "Data dictionary: what every column means",
        "bids/dataset_description.json" => "Name, authors and licence of the BIDS data set",
        "bids/participants.tsv" => "What participants said of themselves",
        "stimuli/stimuli.csv" => "A row for each clip: factors, duration, hashes",
        "study/study.json" => "The study file: what was asked, in which order, of which clips",
        "study/provenance.json" => {
            "Hashes of the study file as it was served and as it is here, what was taken out, and hashes of the files that it names"
        }
        "report/report.html" => "The report as a page",
        "report/results.json" => "Every number of the report",
        "software/Cargo.lock" => "Every crate that the software is compiled from, with SHA-256",
        "software/sbom.cdx.json" => "The same as CycloneDX 1.5",
        _ if path.starts_with("psych-ds/data/") => {
            "The answers: one row a participant x trial x response"
        }
        _ if path.ends_with("_events.tsv") => {
            "What one participant was shown and answered, in seconds"
        }
        _ if path.starts_with("stimuli/packs/") => {
            "A pack of an avatar, of operators, of a take, or a file of sound or video"
        }
        _ => return None,
    })
}

/// The media type of a file, by the ending of its name.
pub(crate) fn media_type(path: &str) -> &'static str {
    let ending = path.rsplit_once('.').map_or("", |(_, ending)| ending);
    match ending {
        "csv" => "text/csv",
        "tsv" => "text/tab-separated-values",
        "json" => "application/json",
        "md" => "text/markdown",
        "html" => "text/html",
        "svg" => "image/svg+xml",
        "png" => "image/png",
        "pdf" => "application/pdf",
        "tex" => "text/x-tex",
        "txt" | "lock" | "R" | "py" | "cff" => "text/plain",
        "glb" => "model/gltf-binary",
        "gltf" => "model/gltf+json",
        "obj" => "model/obj",
        "wav" => "audio/wav",
        "mp4" => "video/mp4",
        "webm" => "video/webm",
        _ => "application/octet-stream",
    }
}

/// Under what a file is put.
pub(crate) fn under(path: &str) -> Under {
    let is_script = path.ends_with(".R") || path.ends_with(".py");
    if path.starts_with("software/") {
        Under::Software
    } else if path.starts_with("study/") || is_script {
        Under::Code
    } else {
        Under::Data
    }
}
