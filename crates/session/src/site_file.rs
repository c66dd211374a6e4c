//! The file that takes the server's place where pages are hosted as files: `mimique export-site` writes it, the
//! page reads it.

use std::collections::BTreeMap;

use mimique_study::{ClipSource, StaticHosting};
use serde::{Deserialize, Serialize};

use crate::wire::Bundle;

/// What stands beside the pages of one study. The page reads a `SiteFile<Value>`, as it reads a
/// [`Bundle`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SiteFile<Clip = ClipSource> {
    /// The study and its clips.
    pub bundle: Bundle<Clip>,
    /// `pilot` or `live`.
    pub stage: String,
    /// Seed of the study's random streams.
    pub seed: u64,
    /// The code of each standing that has one, by the standing's word in the export.
    pub codes: BTreeMap<String, String>,
    /// Address to return to, if the study has one.
    pub redirect: Option<String>,
    /// Where answers go.
    pub hosting: StaticHosting,
    /// Whom to send the answers' file to.
    pub email: String,
}
