//! What the files of a layout hold: avatar, motion, region, maps.

use std::path::{Path, PathBuf};

use anyhow::{anyhow, bail};
use mimique_layout::{DenseTake, Face, NamedSet, Take, TakeContent, Where};
use mimique_mocap::{WeightOptions, WeightsTable, read_vertex_array};
use mimique_solver::MarkerSite;
use mimique_stimulus::{AvatarSkin, MarkerMap, RecordedWeights, read_performance};
use serde::Deserialize;

/// What is wrong with a file.
pub(super) fn blame(file: &Path, error: impl std::fmt::Display) -> anyhow::Error {
    anyhow!("{}: {error}", file.display())
}

/// An avatar's skin and its hash.
pub(super) struct AvatarFile {
    pub(super) skin: AvatarSkin,
    pub(super) key: String,
    pub(super) notes: Vec<String>,
}

/// Reads an avatar.
pub(super) fn avatar(file: &Path) -> anyhow::Result<AvatarFile> {
    let read = mimique_avatar_files::read_avatar(file).map_err(|e| blame(file, e))?;
    let skin = AvatarSkin::of(&read.avatar).map_err(|e| blame(file, e))?;
    Ok(AvatarFile { skin, key: mimique_stimulus::avatar_key(&read.avatar), notes: read.notes })
}

/// The takes of a command line, ranges of motion first, and what is to be said of them.
pub(super) fn takes(
    skin: &AvatarSkin,
    rom: &[PathBuf],
    dense: &[PathBuf],
    rate_hz: Option<f64>,
) -> anyhow::Result<(Vec<Take>, Vec<String>)> {
    let (mut takes, mut notes) = (Vec::new(), Vec::new());
    for file in rom {
        let table = weights(skin, file, rate_hz)?;
        let recorded =
            RecordedWeights::of(&table, &skin.shape_names).map_err(|e| blame(file, e))?;
        if recorded.names.driven.is_empty() {
            bail!(
                "{}: no column is a shape of the avatar; name the columns as its shapes are",
                file.display()
            );
        }
        let said = recorded.names.warnings(true);
        notes.extend(said.iter().map(|warning| format!("{}: {warning}", file.display())));
        takes.push(Take {
            name: name_of(file),
            rate_hz: recorded.table.rate_hz(),
            content: TakeContent::Weights(recorded.table.weights),
        });
    }
    for file in dense {
        let array = read_vertex_array(file).map_err(|e| blame(file, e))?;
        let take = DenseTake { vertices: array.vertices, positions: array.positions };
        takes.push(Take { name: name_of(file), rate_hz, content: TakeContent::Dense(take) });
    }
    Ok((takes, notes))
}

/// The weights of a file, or of the animation of a GLB.
fn weights(skin: &AvatarSkin, file: &Path, rate_hz: Option<f64>) -> anyhow::Result<WeightsTable> {
    let options = WeightOptions { rate_hz, shape_names: &skin.shape_names, animation: None };
    read_performance(file, &options).map(|read| read.table).map_err(|e| blame(file, e))
}

/// A file's name without folder and ending.
pub(super) fn name_of(file: &Path) -> String {
    file.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned())
}

/// The vertices of a file of a region.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Region {
    vertices: Option<Vec<usize>>,
    #[serde(default)]
    without: Vec<usize>,
}

/// Where markers may be by a file of a region: vertices of the avatar's file.
pub(super) fn region(skin: &AvatarSkin, file: &Path, place: &mut Where) -> anyhow::Result<()> {
    let text = std::fs::read_to_string(file)
        .map_err(|e| blame(file, format!("open: {e}; check the path")))?;
    let region: Region = serde_json::from_str(&text).map_err(|e| {
        blame(file, format!("{e}; write {{\"vertices\": [...]}} or {{\"without\": [...]}}"))
    })?;
    let count = skin.welded_from_file.len();
    let welded = |key: &str, vertices: &[usize]| -> anyhow::Result<Vec<usize>> {
        vertices
            .iter()
            .enumerate()
            .map(|(at, &v)| match skin.welded_from_file.get(v) {
                Some(&welded) => Ok(welded as usize),
                None => Err(blame(
                    file,
                    format!(
                        "{key}/{at}: vertex {v} of {count}; count from 0 in the avatar file's order"
                    ),
                )),
            })
            .collect()
    };
    place.only = region.vertices.as_deref().map(|v| welded("vertices", v)).transpose()?;
    place.without = welded("without", &region.without)?;
    Ok(())
}

/// A marker map and its places on a skin.
pub(super) struct MapFile {
    pub(super) map: MarkerMap,
    pub(super) sites: Vec<MarkerSite>,
    pub(super) text: String,
}

/// Reads a marker map.
pub(super) fn map(skin: &AvatarSkin, file: &Path) -> anyhow::Result<MapFile> {
    let text = std::fs::read_to_string(file)
        .map_err(|e| blame(file, format!("open: {e}; check the path")))?;
    let map = MarkerMap::from_text(&text).map_err(|e| blame(file, e))?;
    let sites = map.resolve(skin).map_err(|e| blame(file, e))?;
    Ok(MapFile { map, sites, text })
}

/// A map as a set with a name.
pub(super) fn named_set(skin: &AvatarSkin, name: &str, file: &Path) -> anyhow::Result<NamedSet> {
    let sites = map(skin, file)?.sites;
    let vertices = sites.iter().map(MarkerSite::vertex).collect();
    Ok(NamedSet { name: name.to_owned(), vertices })
}

/// The face of an avatar.
pub(super) fn face<'a>(file: &Path, skin: &'a AvatarSkin) -> anyhow::Result<Face<'a>> {
    Face::of(skin).map_err(|e| blame(file, e))
}
