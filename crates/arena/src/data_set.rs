//! Votes and stimuli for those who learn a measure of what people see: a table of votes by hashes, the weights of every
//! clip, and what the columns are.

use std::fmt::Write as _;

use serde::Serialize;

use crate::folder::ArenaFolder;
use crate::stimuli::ArenaStimuli;
use crate::votes::{Vote, VoteFileError, votes_csv};

/// A file of the data set.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum DataSetFile {
    /// Written anew: its name and bytes.
    Made(String, Vec<u8>),
    /// Copied out of the arena's folder, under the same name.
    Copied(String),
}

/// A clip's row.
#[derive(Serialize)]
struct ClipRow<'a> {
    method: &'a str,
    take: &'a str,
    provenance: &'a str,
    weights_hash: &'a str,
    duration_ms: f64,
    frames: usize,
    rate_hz: f64,
    weights: String,
    head: String,
    licence: &'a str,
}

/// The files of a data set.
///
/// # Errors
/// A table that cannot be written: a mistake of this version.
pub fn data_set(
    folder: &ArenaFolder,
    stimuli: &ArenaStimuli,
    votes: &[Vote],
) -> Result<Vec<DataSetFile>, VoteFileError> {
    let mut files = vec![DataSetFile::Copied(folder.arena.avatar.clone())];
    let mut writer = csv::Writer::from_writer(Vec::new());
    for (name, submission) in &folder.submissions {
        let place = ArenaFolder::place_of(name);
        let head = match &submission.avatar {
            None => folder.arena.avatar.clone(),
            Some(own) => {
                let file = format!("{place}/{}", own.file);
                files.push(DataSetFile::Copied(file.clone()));
                file
            }
        };
        files.push(DataSetFile::Copied(format!("{place}/submission.json")));
        for segment in &folder.arena.segments {
            let (Some(clip), Some(own)) =
                (stimuli.clip(name, &segment.id), submission.segments.get(&segment.id))
            else {
                continue;
            };
            let weights = format!("{place}/{}", own.file);
            let rate_hz =
                folder.arena.captures.get(&segment.capture).map_or(0.0, |own| own.rate_hz);
            files.push(DataSetFile::Copied(weights.clone()));
            writer.serialize(ClipRow {
                method: name,
                take: &segment.id,
                provenance: &clip.provenance,
                weights_hash: &clip.weights_hash,
                duration_ms: clip.duration_ms,
                frames: own.frames,
                rate_hz,
                weights,
                head: head.clone(),
                licence: &submission.details.licence,
            })?;
        }
    }
    let clips =
        writer.into_inner().map_err(|e| VoteFileError::from(csv::Error::from(e.into_error())))?;
    files.push(DataSetFile::Made("clips.csv".to_owned(), clips));
    files.push(DataSetFile::Made("votes.csv".to_owned(), votes_csv(votes)?));
    let readme = readme(folder, votes.len()).into_bytes();
    files.push(DataSetFile::Made("README.md".to_owned(), readme));
    Ok(files)
}

/// What the columns of both tables are.
const COLUMNS: [(&str, &[[&str; 2]]); 2] = [
    (
        "votes.csv",
        &[
            ["laboratory", "where the vote was given"],
            ["session", "whose it is: a hash, the same for all votes of a person in a session"],
            ["place", "place among all pages and trials of the session"],
            ["take", "the segment"],
            ["left, right", "the methods on both sides"],
            ["chosen", "`left`, `right` or `same`"],
            ["left_hash, right_hash", "provenance of both clips: `provenance` of `clips.csv`"],
            ["day", "the day, by the participant's clock"],
            ["rt_ms", "how long the answer took, milliseconds"],
            [
                "batch",
                "of a pair that was chosen by the answers so far its batch; empty of pairs that were dealt: pairs of \
              batches are not a random sample of pairs",
            ],
        ],
    ),
    (
        "clips.csv",
        &[
            ["method, take", "the method and the segment"],
            ["provenance", "SHA-256 of all that is shown and heard"],
            ["weights_hash", "SHA-256 of the weights as browsers play them"],
            ["duration_ms, frames, rate_hz", "how long it is; frames and rate as submitted"],
            ["weights", "the file of weights: a row per frame, a column per shape of the head"],
            ["head", "the GLB file whose shapes these are"],
            ["licence", "the licence of the weights"],
        ],
    ),
];

fn readme(folder: &ArenaFolder, votes: usize) -> String {
    let arena = &folder.arena;
    let mut text = format!(
        "# {}\n\nVotes and stimuli of the arena `{}`, opened {}: {votes} votes between {} methods on {} segments.\n\
         Written by `mimique arena export`.\n",
        arena.title,
        arena.id,
        arena.opened,
        folder.submissions.len(),
        arena.segments.len()
    );
    for (file, columns) in COLUMNS {
        let _ = write!(text, "\n## {file}\n\n| column | what it says |\n|---|---|\n");
        for [name, what] in columns {
            let _ = writeln!(text, "| {name} | {what} |");
        }
    }
    text.push_str(
        "\n## Methods\n\n| method | authors | citation | licence | code |\n|---|---|---|---|---|\n",
    );
    for (name, own) in &folder.submissions {
        let details = &own.details;
        let _ = writeln!(
            text,
            "| {name} | {} | {} | {} | {} |",
            details.authors.join(", "),
            details.citation.as_deref().unwrap_or_default(),
            details.licence,
            details.code.as_deref().unwrap_or_default()
        );
    }
    text
}
