//! What `repair` and `segment` ask of the capture that they read: unit, rate, markers of the head.

use std::path::{Path, PathBuf};

use anyhow::anyhow;
use mimique_mocap::{CaptureFile, ReadOptions, Recording};
use mimique_stimulus::MarkerMap;

use crate::solve::length_unit;

/// Options.
#[derive(clap::Args)]
pub struct CaptureOptions {
    /// Hold the head still by these markers
    #[arg(long, value_name = "LABEL,LABEL,LABEL", value_delimiter = ',')]
    head: Vec<String>,
    /// Hold the head still by the head markers of this marker map
    #[arg(long, value_name = "MAP", conflicts_with = "head")]
    markers: Option<PathBuf>,
    /// Unit of the capture where its file does not say: m, cm or mm
    #[arg(long, value_name = "UNIT")]
    mocap_unit: Option<String>,
    /// Frames a second where the file does not say
    #[arg(long, value_name = "HZ")]
    pub mocap_rate: Option<f64>,
}

impl CaptureOptions {
    /// The head's markers: named, or those of the marker map; none where neither is given.
    pub fn head(&self) -> anyhow::Result<Vec<String>> {
        let Some(path) = &self.markers else { return Ok(self.head.clone()) };
        let blame = |e: String| anyhow!("{}: {e}", path.display());
        let text = std::fs::read_to_string(path)
            .map_err(|e| blame(format!("open: {e}; check the path")))?;
        let map = MarkerMap::from_text(&text).map_err(|e| blame(e.to_string()))?;
        if map.head.is_empty() {
            return Err(blame("head: no head markers; name them there, or with --head".to_owned()));
        }
        Ok(map.head)
    }

    /// What an opened file holds.
    pub fn recording(&self, path: &Path, file: &mut CaptureFile<'_>) -> anyhow::Result<Recording> {
        let unit = self.mocap_unit.as_deref().map(length_unit).transpose()?;
        file.recording(&ReadOptions { unit, rate_hz: self.mocap_rate })
            .map_err(|e| anyhow!("{}: {e}", path.display()))
    }
}
