//! The report of a study: every table, figure and sentence from its export and its study file.
//!
//! In: the tidy export as a [`Table`], the study, a language. Out: files as text, the same for the same
//! input. Each test stands in two columns: as in the thesis (trials taken for independent
//! observations) and as recommended (one value a person).

pub(crate) mod figure;
mod preview;
mod replay;
pub(crate) mod results;
pub(crate) mod section;
pub(crate) mod tables;

use mimique_locale::Language;
use mimique_report::{ReportFile, document_files};
use mimique_stats::Table;
use mimique_study::Study;

use crate::mimicry::tables::FaceTables;
use crate::sensitivity::sensitivity;
use crate::trials::error::ExportError;
use crate::trials::export::Export;
use crate::trials::stimulus_measures::StimulusMeasures;
use crate::trials::versions::{StudyVersions, other_versions};
use preview::Preview;

/// A report: its files, and its findings in short.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Report {
    /// Every file.
    pub files: Vec<ReportFile>,
    /// People used and people in the export.
    pub people: (usize, usize),
    /// Trials used.
    pub trials: usize,
    /// The reading of each hypothesis: identifier and words.
    pub readings: Vec<(String, String)>,
    /// How much each verdict depends on choices of the analysis, on segments and on participants, where that was asked for:
    /// identifier of the hypothesis and words. Empty for a study without hypotheses.
    pub sensitivity: Vec<(String, String)>,
}

/// What a report may be made with beside the export and the study.
#[derive(Debug, Clone, Copy, Default)]
pub struct ReportOptions<'a> {
    /// The table of stimuli: answers are held against what was measured of them, too.
    pub stimuli: Option<&'a Table>,
    /// Participants' faces (`mimique export --format tracks`) and the courses of the clips (`mimique export --courses`), in
    /// studies that measure them.
    pub faces: Option<MeasuredFaces<'a>>,
    /// Address of the study's preview: what stands for one clip in a figure leads to that clip there.
    pub preview: Option<&'a str>,
    /// Which study file this is and which were served: another study's answers are refused, and differences are reported.
    pub versions: StudyVersions<'a>,
    /// Whether every verdict is repeated over the reasonable rules of exclusion and tests, and without each segment and
    /// each participant: a section of the report, which takes time.
    pub multiverse: bool,
}

/// Participants' faces, and how the clips moved that they saw.
#[derive(Debug, Clone, Copy)]
pub struct MeasuredFaces<'a> {
    /// A row per picture of a face.
    pub tracks: &'a Table,
    /// A row per frame of a clip.
    pub courses: &'a Table,
}

/// Computes the report. Refuses an export without the columns of the tidy form or without any trial
/// that can be used.
pub fn analyze(table: &Table, study: &Study, language: Language) -> Result<Report, ExportError> {
    analyze_with(table, study, language, ReportOptions::default())
}

/// The same with more. Refuses a table of stimuli without the column `stimulus`, or with text in a column of numbers.
pub fn analyze_with(
    table: &Table,
    study: &Study,
    language: Language,
    options: ReportOptions<'_>,
) -> Result<Report, ExportError> {
    let ReportOptions { stimuli, faces, preview, versions, multiverse } = options;
    let versions = other_versions(table, study, versions)?;
    let stimuli = stimuli.map(|table| StimulusMeasures::read(table, study)).transpose()?;
    let read = |MeasuredFaces { tracks, courses }| FaceTables::read(tracks, courses);
    let faces = faces.map(read).transpose()?;
    let export = Export::read(table, study)?;
    if export.trials.is_empty() {
        return Err(export.flow.no_trial());
    }
    let sensitivity = multiverse.then(|| sensitivity(table, study, &export)).transpose()?;
    let section::Sections { document, results, readings, sensitivity, replay } = {
        let beside = section::Beside {
            stimuli: stimuli.as_ref(),
            faces: faces.as_ref(),
            versions: &versions,
            sensitivity: sensitivity.as_ref(),
        };
        section::write(&export, study, beside, preview.map(Preview), language)
    };
    let mut files = document_files(&document, language);
    files.push(ReportFile { path: "results.json".to_owned(), text: results });
    files.extend(replay);
    Ok(Report {
        files,
        people: (export.flow.people_used, export.flow.people),
        trials: export.flow.trials_used,
        readings,
        sensitivity,
    })
}
