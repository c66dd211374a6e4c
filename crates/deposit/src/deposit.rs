//! The whole of a deposit, put together of its parts.

use std::collections::BTreeMap;

use mimique_session::rows::Column;
use mimique_study::{KindOfQuestion as _, Study};

use crate::about::About;
use crate::described::{MANIFEST, METADATA, PREVIEW, REPORT};
use crate::file::{DepositFile, NotWritten, json_bytes};
use crate::personal::Judged;
use crate::readme::Told;
use crate::responses::Responses;
use crate::stimuli::{Pack, StimulusRow};
use crate::study_files::{StudySource, StudyVersion};
use crate::{bids, citation, dictionary, manifest, preview, psych_ds, readme, ro_crate, software};
use crate::{stimuli, study_files};

/// What a deposit is made of.
#[derive(Debug, Clone, Copy)]
pub struct Parts<'a> {
    /// What is said of it.
    pub about: &'a About,
    /// The study as it is run again.
    pub study: &'a Study,
    /// Its versions, the last being the one that is run again.
    pub versions: &'a [StudyVersion],
    /// The files that the study names.
    pub sources: &'a [StudySource],
    /// The columns that exports of these versions have.
    pub known: &'a BTreeMap<String, Column>,
    /// The answers, without what is left out.
    pub responses: &'a Responses,
    /// What became of what is personal.
    pub judged: &'a Judged,
    /// The clips.
    pub stimuli: &'a [StimulusRow],
    /// Their packs, where they are deposited; then the study's sources are, too.
    pub packs: Option<&'a [Pack]>,
    /// The files of the report by their paths in its folder.
    pub report: &'a [(String, Vec<u8>)],
}

/// Every file of a deposit by its path: the same bytes for the same parts.
///
/// # Errors
/// A file cannot be put together.
pub fn deposit_files(parts: &Parts<'_>) -> Result<Vec<DepositFile>, NotWritten> {
    let Parts { about, study, responses, known, .. } = *parts;
    let columns = dictionary::dictionary(known, responses.columns());
    let about_people: Vec<String> = (study.demographics.iter())
        .flat_map(|page| &page.questions)
        .filter(|question| !question.kind.is_free_text())
        .flat_map(|question| question.response_ids())
        .collect();
    let mut files = psych_ds::files(about, study, responses, &columns)?;
    files.extend(bids::files(about, responses, known, parts.stimuli, &about_people)?);
    files.extend(stimuli::files(parts.stimuli, parts.packs)?);
    let (of_study, changes) =
        study_files::files(parts.versions, parts.sources, parts.packs.is_some())?;
    files.extend(of_study);
    files.extend(software::files()?);
    let of_report = |(name, bytes): &(String, Vec<u8>)| {
        DepositFile::made(format!("{REPORT}/{name}"), bytes.clone())
    };
    files.extend(parts.report.iter().map(of_report));
    let told =
        Told { judged: parts.judged, changes: &changes, with_stimuli: parts.packs.is_some() };
    for (name, text) in [
        ("README.md", readme::readme(about, &told)),
        ("LICENSE.md", readme::licences(about)),
        ("CITATION.cff", citation::citation(about)),
    ] {
        files.push(DepositFile::made(name, text.into_bytes()));
    }
    files.sort_by(|left, right| left.path.cmp(&right.path));
    let page = preview::preview(about, &files);
    files.push(DepositFile::made(PREVIEW, page.into_bytes()));
    let metadata = json_bytes(&ro_crate::metadata(about, &files, &[MANIFEST]))?;
    files.push(DepositFile::made(METADATA, metadata));
    let manifest = manifest::manifest(&files);
    files.push(DepositFile::made(MANIFEST, manifest.into_bytes()));
    files.sort_by(|left, right| left.path.cmp(&right.path));
    match files.windows(2).find(|pair| pair[0].path == pair[1].path) {
        Some(pair) => Err(NotWritten::Twice { path: pair[0].path.clone() }),
        None => Ok(files),
    }
}
