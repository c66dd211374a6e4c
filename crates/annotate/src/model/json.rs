//! A model as JSON: `{"version", "hash", "model"}`, the hash over the model's canonical text.

use serde::{Deserialize, Serialize};

use super::Model;
use crate::{AnnotateError, Temperature};

/// Version of the models that are written.
pub const VERSION: u32 = 1;
/// Largest model that is written or read, bytes.
pub const LARGEST: usize = 64 << 20;

/// The one field that is read whatever the version.
#[derive(Deserialize)]
struct OfVersion {
    version: u32,
}

/// What a file holds.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct File<M> {
    version: u32,
    hash: String,
    model: M,
}

impl Model {
    /// SHA-256 of the model's canonical JSON, hexadecimal: what it has learnt, by one name.
    ///
    /// # Errors
    /// [`AnnotateError::Unfit`] when it cannot be told as JSON.
    pub fn hash(&self) -> Result<String, AnnotateError> {
        let value = serde_json::to_value(self);
        let value = value.map_err(|_| AnnotateError::Unfit { part: "parts" })?;
        Ok(mimique_study::config_hash(&value))
    }

    /// The model as JSON; reading it gives the same model.
    ///
    /// # Errors
    /// [`AnnotateError::Limit`] above 64 MiB.
    pub fn to_json(&self) -> Result<String, AnnotateError> {
        let file = File { version: VERSION, hash: self.hash()?, model: self };
        let text = serde_json::to_string(&file);
        let text = text.map_err(|_| AnnotateError::Unfit { part: "parts" })?;
        crate::error::at_most("bytes of a model", text.len(), LARGEST)?;
        Ok(text)
    }

    /// Read a model.
    ///
    /// # Errors
    /// [`AnnotateError::Limit`] above 64 MiB, [`AnnotateError::Version`], [`AnnotateError::Json`]
    /// with the place, [`AnnotateError::Hash`] when it was changed since it was written,
    /// [`AnnotateError::Unfit`] when its parts contradict each other.
    pub fn from_json(text: &str) -> Result<Self, AnnotateError> {
        crate::error::at_most("bytes of a model", text.len(), LARGEST)?;
        let place = |error: serde_json::Error| AnnotateError::Json {
            line: error.line(),
            column: error.column(),
        };
        let OfVersion { version } = serde_json::from_str(text).map_err(place)?;
        if version == 0 || version > VERSION {
            return Err(AnnotateError::Version { version, known: VERSION });
        }
        let File { hash, model, .. }: File<Self> = serde_json::from_str(text).map_err(place)?;
        model.check()?;
        if model.hash()? != hash {
            return Err(AnnotateError::Hash);
        }
        Ok(model)
    }

    /// Refuses parts that do not fit each other.
    fn check(&self) -> Result<(), AnnotateError> {
        let unfit = |part: &'static str| Err(AnnotateError::Unfit { part });
        if !self.classifier.fits(self.labels.len()) {
            return unfit("parameters");
        }
        if self.classifier.width() != self.shapes.len() {
            return unfit("columns");
        }
        if self.learnt_from.seconds.len() != self.labels.len() {
            return unfit("seconds of each label");
        }
        if self.holds_frames != self.classifier.holds_frames() {
            return unfit("frames of people");
        }
        crate::error::above_zero("rate in Hz", self.rate_hz)?;
        Temperature::new(self.temperature.value())?;
        Ok(())
    }
}
