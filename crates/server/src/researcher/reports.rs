//! The statistical report of a study, made from the answers as they are now and kept until they change.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

use mimique_analysis::{
    MeasuredFaces, Report, ReportOptions, ServedVersion, StudyVersions, analyze_with,
};
use mimique_locale::Language;
use mimique_stats::Table;
use mimique_storage::Storage;
use mimique_study::Study;
use tokio::sync::Semaphore;

use crate::error::Error;
use crate::export::sources::Sources;
use crate::export::{Format, Options, courses, export, stimuli};
use crate::state::hosted_study::HostedStudy;

/// A report takes a core for some seconds: one at a time.
static TURN: Semaphore = Semaphore::const_new(1);
/// Reports kept; beyond it all are made anew.
const MOST_KEPT: usize = 8;

/// What the report was made from, and the report.
type Kept = (String, Arc<Report>);

/// The reports made so far, by study, language and address of the preview.
#[derive(Default)]
pub(crate) struct Reports {
    made: Mutex<BTreeMap<(String, &'static str, String), Kept>>,
}

impl Reports {
    /// The report on the answers as they are now. Its figures lead to the preview at this address.
    pub async fn get(
        &self,
        storage: &Storage,
        study: &HostedStudy,
        language: Language,
        preview: &str,
    ) -> Result<Arc<Report>, Error> {
        let key = (study.id().to_owned(), language.code(), preview.to_owned());
        let beats = storage.pulse().await?;
        let beat = beats.into_iter().find(|(id, _)| id == study.id()).map(|(_, beat)| beat);
        let state = format!("{} {}", study.config_hash(), beat.unwrap_or_default());
        let known = self.made.lock().unwrap_or_else(PoisonError::into_inner).get(&key).cloned();
        if let Some((made_from, report)) = known
            && made_from == state
        {
            return Ok(report);
        }
        let closed = |_| Error::internal("the queue of reports is closed");
        let _turn = TURN.acquire().await.map_err(closed)?;
        let exported = export(storage, Some(study.id()), Format::Csv, Options::default()).await?;
        let csv = exported.files.into_iter().next().map(|(_, bytes)| bytes).unwrap_or_default();
        let (_, stimuli) = stimuli(storage, Some(study.id())).await?;
        let faces = match study.study().mimicry {
            Some(_) => Some(measured_faces(storage, study.id()).await?),
            None => None,
        };
        let sources = Sources::load(storage, study.id()).await?;
        let served: Vec<ServedVersion> = sources
            .versions
            .into_iter()
            .map(|own| ServedVersion { config_hashes: vec![own.config_hash], study: own.study })
            .collect();
        let hashes = [study.config_hash().to_owned()];
        let (study, preview) = (study.study().clone(), preview.to_owned());
        let made = tokio::task::spawn_blocking(move || {
            let versions = StudyVersions { config_hashes: &hashes, served: &served };
            make(&csv, &stimuli, faces.as_ref(), (&study, versions), language, &preview)
        });
        let report = made.await.map_err(Error::internal)??;
        let report = Arc::new(report);
        let mut kept = self.made.lock().unwrap_or_else(PoisonError::into_inner);
        if kept.len() >= MOST_KEPT {
            kept.clear();
        }
        kept.insert(key, (state, report.clone()));
        Ok(report)
    }
}

/// Participants' faces, and the courses of the clips, as CSV.
async fn measured_faces(storage: &Storage, id: &str) -> Result<[Vec<u8>; 2], Error> {
    let tracks = export(storage, Some(id), Format::Tracks, Options::default()).await?;
    let tracks = tracks.files.into_iter().next().map(|(_, bytes)| bytes).unwrap_or_default();
    let (_, courses) = courses(storage, Some(id)).await?;
    Ok([tracks, courses])
}

fn make(
    csv: &[u8],
    stimuli: &[u8],
    faces: Option<&[Vec<u8>; 2]>,
    (study, versions): (&Study, StudyVersions<'_>),
    language: Language,
    preview: &str,
) -> Result<Report, Error> {
    // Without any row there is no table.
    let table = Table::parse(csv).map_err(no_report)?;
    // A study of tables has no stimuli.
    let shown = !study.clips().is_empty();
    let stimuli = shown.then(|| Table::parse(stimuli)).transpose().map_err(no_report)?;
    // Before anybody was measured, or a clip is drawn, there is nothing below the heads.
    let parse = |bytes: &Vec<u8>| Table::parse(bytes.clone()).ok();
    let tables = faces.map(|[tracks, courses]| (parse(tracks), parse(courses)));
    let faces = match &tables {
        Some((Some(tracks), Some(courses))) => Some(MeasuredFaces { tracks, courses }),
        _ => None,
    };
    let preview = Some(preview);
    let options =
        ReportOptions { stimuli: stimuli.as_ref(), faces, preview, versions, multiverse: false };
    analyze_with(&table, study, language, options).map_err(no_report)
}

fn no_report(refusal: impl ToString) -> Error {
    Error::NoReport { problem: refusal.to_string() }
}
