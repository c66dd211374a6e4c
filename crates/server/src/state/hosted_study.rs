//! A study as this server hosts it: its file, its hash, where its clips' packs are.

use std::collections::BTreeMap;

use mimique_comparison::ClipMeasures;
use mimique_session::wire::{Bundle, StudySummary};
use mimique_stimulus::Places;
use mimique_storage::{StorageError, StudyVersion};
use mimique_study::{ClipSource, MIMICRY_FILES, MimicryFile, StudyProjection};
use mimique_study::{Study, StudyFileError, config_hash, percent_encoded};
use serde_json::Value;

use crate::export::sources::Version;

/// Whether answers count.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Stage {
    /// Trying out: the answers are marked so.
    Pilot,
    /// The real thing.
    #[default]
    Live,
}

impl Stage {
    /// The word in sessions and exports.
    pub fn word(self) -> &'static str {
        match self {
            Self::Pilot => "pilot",
            Self::Live => "live",
        }
    }
}

/// A study as this server hosts it.
#[derive(Debug, Clone)]
pub struct HostedStudy {
    study: Study,
    stage: Stage,
    file: Value,
    bundle: Bundle,
    /// What was measured of its clips; empty where nothing was.
    measures: Vec<ClipMeasures>,
    /// Where the files are that its study file names, where that is known.
    places: Option<Places>,
}

impl HostedStudy {
    /// A study file that `study::check` has found free of errors, and its clips.
    pub fn new(
        file: Value,
        clips: BTreeMap<String, ClipSource>,
        stage: Stage,
    ) -> Result<Self, StudyFileError> {
        let study = Study::from_value(&file)?;
        Ok(Self::from_parts(file, study, clips, stage))
    }

    /// A version as it was stored.
    pub(crate) fn from_version(version: &StudyVersion, stage: Stage) -> Result<Self, StorageError> {
        let Version { file, study, clips, measures, .. } = Version::read(version)?;
        Ok(Self::from_parts(file, study, clips, stage).with_measures(measures))
    }

    fn from_parts(
        file: Value,
        study: Study,
        clips: BTreeMap<String, ClipSource>,
        stage: Stage,
    ) -> Self {
        let bundle = Bundle {
            study_id: study.id.clone(),
            config_hash: config_hash(&file),
            study: projection(&study, &clips),
            clips,
        };
        Self { study, stage, file, bundle, measures: Vec::new(), places: None }
    }

    /// The same, its files lying there: what previews compute anew is computed of them.
    #[must_use]
    pub fn with_places(self, places: Places) -> Self {
        Self { places: Some(places), ..self }
    }

    /// The same, with what was measured of its clips: exports and reports tell of it.
    #[must_use]
    pub fn with_measures(self, measures: Vec<ClipMeasures>) -> Self {
        Self { measures, ..self }
    }

    /// Where its files are, where that is known.
    pub(crate) fn places(&self) -> Option<&Places> {
        self.places.as_ref()
    }

    /// Identifier used in addresses.
    pub fn id(&self) -> &str {
        &self.study.id
    }

    /// The study, read.
    pub fn study(&self) -> &Study {
        &self.study
    }

    /// Its clips and media, where their packs are.
    pub(crate) fn clips(&self) -> &BTreeMap<String, ClipSource> {
        &self.bundle.clips
    }

    /// Whether answers count.
    pub fn stage(&self) -> Stage {
        self.stage
    }

    /// SHA-256 of the canonical study file, hexadecimal.
    pub fn config_hash(&self) -> &str {
        &self.bundle.config_hash
    }

    /// The study file, whole.
    pub fn file(&self) -> &Value {
        &self.file
    }

    /// What the page needs.
    pub fn bundle(&self) -> &Bundle {
        &self.bundle
    }

    /// The version as the database keeps it.
    pub(crate) fn version(&self) -> StudyVersion {
        StudyVersion {
            study_id: self.study.id.clone(),
            config_hash: self.bundle.config_hash.clone(),
            file: self.file.to_string(),
            clips: serde_json::to_string(&self.bundle.clips).unwrap_or_default(),
            measures: serde_json::to_string(&self.measures).unwrap_or_default(),
        }
    }

    pub(crate) fn summary(&self) -> StudySummary {
        StudySummary {
            id: self.study.id.clone(),
            title: serde_json::json!(self.study.study_metadata.title),
            config_hash: self.bundle.config_hash.clone(),
        }
    }

    pub(crate) fn title(&self, language: &str) -> &str {
        self.study.study_metadata.title.in_language(language)
    }

    /// The recruitment parameters that the study says it keeps; control characters and what is
    /// longer than any platform's identifier are cut off.
    pub(crate) fn kept_parameters(
        &self,
        given: BTreeMap<String, String>,
    ) -> BTreeMap<String, String> {
        const LONGEST: usize = 200;
        given
            .into_iter()
            .filter(|(name, _)| self.study.recruitment.url_parameters.contains(name))
            .map(|(name, value)| {
                (name, value.chars().filter(|c| !c.is_control()).take(LONGEST).collect())
            })
            .collect()
    }

    /// Where a participant whose session has ended goes back to, with this code.
    pub(crate) fn redirect(
        &self,
        parameters: &BTreeMap<String, String>,
        code: Option<&str>,
    ) -> Option<String> {
        let recruitment = &self.study.recruitment;
        let address = recruitment.redirect.as_ref()?;
        let mut filled = address.replace("{code}", &percent_encoded(code.unwrap_or_default()));
        for name in &recruitment.url_parameters {
            let value = parameters.get(name).map_or("", String::as_str);
            filled = filled.replace(&format!("{{{name}}}"), &percent_encoded(value));
        }
        Some(filled)
    }
}

/// What the page needs of a study, with where the files are that measure faces.
fn projection(study: &Study, clips: &BTreeMap<String, ClipSource>) -> StudyProjection {
    let mut projection = study.projection();
    if !projection.mimicry.is_null() {
        let of = |file: &MimicryFile| {
            Some((file.name.to_owned(), clips.get(&file.key())?.avatar.as_str().into()))
        };
        let files: serde_json::Map<String, Value> = MIMICRY_FILES.iter().filter_map(of).collect();
        projection.mimicry["files"] = files.into();
    }
    projection
}
