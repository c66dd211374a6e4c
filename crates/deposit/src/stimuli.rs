//! What was shown: a row for each clip with the hashes of the packs that it is played from, and the packs themselves,
//! each under its hash.

use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;

use mimique_study::columns::STIMULI_COLUMNS;
use mimique_study::{ClipSource, Study};

use crate::file::{DepositFile, NotWritten};

/// Their folder in the deposit.
pub const FOLDER: &str = "stimuli";

/// A clip, or a picture of a question.
#[derive(Debug, Clone, PartialEq)]
pub struct StimulusRow {
    /// Identifier of the clip, as in the column `stimulus`.
    pub clip: String,
    /// Identifiers of segment, avatar and method.
    pub made_of: [String; 3],
    /// Factors of the clip, by name.
    pub factors: BTreeMap<String, String>,
    /// How long it is, where that is known (of videos it is not).
    pub duration_ms: Option<f64>,
    /// SHA-256 over all that it is made of.
    pub provenance: String,
    /// SHA-256 of its weights.
    pub weights_hash: String,
    /// SHA-256 of the packs that it is played from.
    pub packs: Vec<String>,
}

/// A pack as it lies on disk.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Pack {
    /// SHA-256, its name.
    pub sha256: String,
    /// Where it lies.
    pub from: PathBuf,
    /// Its size.
    pub bytes: u64,
}

/// The rows of a study's clips as they were prepared.
pub fn stimulus_rows(study: &Study, clips: &BTreeMap<String, ClipSource>) -> Vec<StimulusRow> {
    let known: BTreeMap<String, mimique_study::Clip> = (study.clips().into_iter())
        .chain(study.level_clips().into_iter().map(|level| level.clip))
        .chain(study.clips_at_rest().into_iter().map(|(clip, _)| clip))
        .map(|clip| (clip.id.clone(), clip))
        .collect();
    let row = |(id, source): (&String, &ClipSource)| {
        let clip = known.get(id);
        let made_of = clip.map_or_else(Default::default, |clip| {
            [clip.segment.clone(), clip.avatar.clone(), clip.method.clone()]
        });
        let value = |value: &mimique_study::FactorValue| {
            let value = value.to_value();
            value.as_str().map_or_else(|| value.to_string(), str::to_owned)
        };
        let factors = clip.into_iter().flat_map(|clip| &clip.factors);
        StimulusRow {
            clip: id.clone(),
            made_of,
            factors: factors.map(|(name, own)| (name.clone(), value(own))).collect(),
            duration_ms: Some(source.duration_ms).filter(|duration| *duration > 0.0),
            provenance: source.provenance.clone(),
            weights_hash: source.weights_hash.clone(),
            packs: source.packs().map(str::to_owned).collect(),
        }
    };
    clips.iter().map(row).collect()
}

/// Every pack's hash, each once.
pub fn pack_hashes(rows: &[StimulusRow]) -> BTreeSet<&str> {
    rows.iter().flat_map(|row| &row.packs).map(String::as_str).collect()
}

/// The table, and the packs where they are deposited.
pub(crate) fn files(
    rows: &[StimulusRow],
    packs: Option<&[Pack]>,
) -> Result<Vec<DepositFile>, NotWritten> {
    let mut made = vec![DepositFile::made(format!("{FOLDER}/stimuli.csv"), table(rows)?)];
    for pack in packs.unwrap_or_default() {
        made.push(DepositFile::copied(
            format!("{FOLDER}/packs/{}", pack.sha256),
            pack.from.clone(),
            pack.sha256.clone(),
            pack.bytes,
        ));
    }
    Ok(made)
}

fn table(rows: &[StimulusRow]) -> Result<Vec<u8>, csv::Error> {
    let fixed = STIMULI_COLUMNS;
    let factors: BTreeSet<&str> = (rows.iter())
        .flat_map(|row| row.factors.keys())
        .map(String::as_str)
        .filter(|name| !fixed.contains(name))
        .collect();
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(fixed.into_iter().chain(["packs"]).chain(factors.iter().copied()))?;
    for row in rows {
        let [segment, avatar, method] = &row.made_of;
        let duration = row.duration_ms.map_or_else(String::new, |duration| duration.to_string());
        let packs = row.packs.join("|");
        let cells =
            [&row.clip, segment, avatar, method, &duration, &row.provenance, &row.weights_hash];
        let factor = |name: &&str| row.factors.get(*name).map_or("", String::as_str);
        let cells = cells.into_iter().map(String::as_str).chain([packs.as_str()]);
        writer.write_record(cells.chain(factors.iter().map(factor)))?;
    }
    writer.into_inner().map_err(|error| error.into_error().into())
}
