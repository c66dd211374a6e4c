//! Participants' faces as they were measured: a row per picture of each play; and the courses of the clips that they are
//! held against, a row per frame of each clip.

use std::collections::{BTreeMap, BTreeSet};

use mimique_session::wire::SessionStarted;
use mimique_session::{EventKind, TrackedFace};
use mimique_storage::Storage;
use mimique_study::TRACKED_SHAPES;
use mimique_study::columns::{COURSE_COLUMNS, TRACK_COLUMNS};
use serde_json::Value;

use super::choose;
use super::csv::{self, Cells};
use super::error::ExportError;
use super::layout::Lines;
use super::sources::Sources;

/// The first line of a table of tracks.
pub(super) fn header() -> Result<Vec<u8>, ExportError> {
    csv::header_of(TRACK_COLUMNS.into_iter().chain(TRACKED_SHAPES))
}

/// The tracks of one session, its events one after the other.
#[derive(Default)]
pub(super) struct TrackRows {
    /// What each trial showed: its clip, and what stood beside it.
    shown: BTreeMap<String, (String, String)>,
    plays: BTreeMap<String, u32>,
    lines: Lines,
}

impl TrackRows {
    /// Takes the next event, its body as JSON.
    pub fn add(&mut self, started: &SessionStarted, body: &str) -> Result<(), ExportError> {
        match EventKind::from_text(body) {
            Some(EventKind::TrialStarted { step, clip, beside, panel, .. }) => {
                let beside = beside.map_or_else(|| panel.join(" "), |beside| beside.clip);
                self.shown.insert(step, (clip, beside));
            }
            Some(EventKind::TrialPlayed { step, log }) => {
                let play = self.plays.entry(step.clone()).or_default();
                *play += 1;
                let Some(face) = TrackedFace::of(&log.mimicry) else { return Ok(()) };
                let (clip, beside) = self.shown.get(&step).cloned().unwrap_or_default();
                let whole = log.is_whole() && log.alone.is_none();
                let common: [Value; 8] = [
                    started.participant_id.as_str().into(),
                    started.stage.as_str().into(),
                    step.into(),
                    clip.into(),
                    beside.into(),
                    log.provenance.as_str().into(),
                    (*play).into(),
                    whole.into(),
                ];
                let row = |picture: mimique_session::TrackedPicture<'_>| -> Vec<Value> {
                    let mut row = common.to_vec();
                    row.push(picture.at_ms.into());
                    row.push(picture.scores.is_some().into());
                    match picture.scores {
                        Some(scores) => row.extend(scores.iter().map(|s| Value::from(s / 1e3))),
                        None => row.resize(row.len() + TRACKED_SHAPES.len(), Value::Null),
                    }
                    row
                };
                let rows: Vec<Vec<Value>> = face.pictures().map(row).collect();
                self.lines.bytes.extend(csv::lines(&rows, Cells::AsTheyAre)?);
                self.lines.rows += rows.len();
            }
            _ => {}
        }
        Ok(())
    }

    /// The rows.
    pub fn finish(self) -> Lines {
        self.lines
    }
}

/// The courses of the clips of a study as CSV, and the study's identifier: a row per frame, a column for each shape that
/// is measured of faces. A clip that was prepared anew for a later version, and differs, stands there twice, by its provenance. Only of
/// studies that measure faces; of others the head alone.
///
/// # Errors
/// There is no such study, or there are several and none is named; storage failed.
pub async fn courses(
    storage: &Storage,
    study_id: Option<&str>,
) -> Result<(String, Vec<u8>), ExportError> {
    let study_id = choose(storage, study_id).await?;
    let sources = Sources::load(storage, &study_id).await?;
    let mut bytes =
        csv::header_of(COURSE_COLUMNS.into_iter().chain(TRACKED_SHAPES).filter(is_moved))?;
    let mut told = BTreeSet::new();
    for version in &sources.versions {
        for measures in &version.measures {
            let Some(courses) = &measures.courses else { continue };
            let provenance = version.clips.get(&measures.clip).map(|clip| clip.provenance.clone());
            let provenance = provenance.unwrap_or_default();
            if !told.insert((measures.clip.clone(), provenance.clone())) {
                continue;
            }
            let by_name: BTreeMap<&str, &Vec<f64>> =
                courses.shapes.iter().map(|(name, own)| (name.as_str(), own)).collect();
            let frames = courses.shapes.first().map_or(0, |(_, own)| own.len());
            let row = |frame: usize| -> Vec<Value> {
                let time_ms = frame as f64 / courses.rate_hz * 1e3;
                let mut row: Vec<Value> = vec![
                    measures.clip.as_str().into(),
                    provenance.as_str().into(),
                    ((time_ms * 1e3).round() / 1e3).into(),
                ];
                let weight = |name: &&str| by_name.get(name).map(|own| own[frame]).into();
                row.extend(TRACKED_SHAPES.iter().filter(|name| is_moved(name)).map(weight));
                row
            };
            let rows: Vec<Vec<Value>> = (0..frames).map(row).collect();
            bytes.extend(csv::lines(&rows, Cells::AsTheyAre)?);
        }
    }
    Ok((study_id, bytes))
}

/// Whether a clip can move what is measured: the score of a face at rest is of no shape.
fn is_moved(name: &&str) -> bool {
    *name != TRACKED_SHAPES[0]
}
