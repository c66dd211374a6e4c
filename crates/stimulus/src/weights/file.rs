//! Files of weights: a performance read, whatever records it, and weights under the names that a format has.

use std::io::Read as _;
use std::path::Path;

use mimique_avatar_files::read_weight_animation;
use mimique_mocap::{CaptureFile, WeightOptions, WeightsTable, written_columns};

use super::{RecordedWeights, WeightBeyondSense};

/// What an animation is called where formats are.
const ANIMATION: &str = "animation of a glTF file (weights)";

/// Weights of a file.
#[derive(Debug, Clone, PartialEq)]
pub struct Performance {
    /// The weights under the file's own names.
    pub table: WeightsTable,
    /// The name of its format.
    pub format: &'static str,
}

/// Why a file gives no weights.
#[derive(Debug, thiserror::Error)]
pub enum PerformanceError {
    /// The file could not be opened.
    #[error("open: {0}; check the path and its permissions")]
    Open(std::io::Error),
    /// It is no file of weights, or a damaged one.
    #[error(transparent)]
    Weights(#[from] mimique_mocap::ReadError),
    /// It is a glTF file whose animation cannot be read.
    #[error(transparent)]
    Animation(#[from] mimique_avatar_files::ReadError),
    /// It is a glTF file without one.
    #[error(
        "animations: none moves morph targets; export the animation of the shapes with the file"
    )]
    NoAnimation,
    /// An animation is asked for, of a file that is no glTF.
    #[error("only a GLB or glTF file has animations to choose from; leave the choice out")]
    NotAnimated,
}

/// Reads weights from a file of any format of `mimique_mocap` that holds them, or from the animation of a GLB
/// or glTF file. The rate of an animation is its own.
///
/// # Errors
/// [`PerformanceError`] with place, value and remedy.
pub fn read_performance(
    path: &Path,
    options: &WeightOptions<'_>,
) -> Result<Performance, PerformanceError> {
    if is_gltf(path).map_err(PerformanceError::Open)? {
        let bytes = std::fs::read(path).map_err(PerformanceError::Open)?;
        let read = read_weight_animation(&bytes, path.parent(), options.animation)?;
        let read = read.ok_or(PerformanceError::NoAnimation)?;
        let table = WeightsTable::at_rate(read.shape_names, read.weights, 0, read.rate_hz);
        let table = WeightsTable { notes: read.notes, ..table };
        return Ok(Performance { table, format: ANIMATION });
    }
    let mut file = CaptureFile::open(path)?;
    if options.animation.is_some() {
        return Err(PerformanceError::NotAnimated);
    }
    let table = file.weights(options)?;
    Ok(Performance { table, format: file.format().map_or("", |format| format.name) })
}

/// Whether a file opens as a GLB, or as glTF's JSON, which begins with its `asset`. A pipe can be read only
/// once, and is taken for weights.
fn is_gltf(path: &Path) -> std::io::Result<bool> {
    if !std::fs::metadata(path)?.is_file() {
        return Ok(false);
    }
    let mut head = Vec::new();
    std::fs::File::open(path)?.take(512).read_to_end(&mut head)?;
    let asset = b"\"asset\"";
    let json = head.trim_ascii_start().starts_with(b"{");
    let is_named = path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("gltf"));
    let has_asset = head.windows(asset.len()).any(|window| window == asset);
    Ok(head.starts_with(b"glTF") || json && (has_asset || is_named))
}

/// Weights under the names that files of the format have which the name of `path` asks for, and the shapes
/// that it has none for. Formats that take any names get the table as it is.
///
/// # Errors
/// [`WeightBeyondSense`], as [`RecordedWeights::of`].
pub fn weights_for_file(
    table: &WeightsTable,
    path: &Path,
) -> Result<(WeightsTable, Vec<String>), WeightBeyondSense> {
    let Some(columns) = written_columns(path) else { return Ok((table.clone(), Vec::new())) };
    let columns: Vec<String> = columns.iter().map(|name| (*name).to_owned()).collect();
    let joined = RecordedWeights::of(table, &columns)?;
    Ok((joined.table, joined.names.unused))
}

#[cfg(test)]
mod tests {
    use super::*;
    use mimique_mocap::{read_weights_file, weights_files};

    #[test]
    fn weights_of_an_avatar_are_written_under_arkits_names() {
        let names = ["browInnerUp_L", "browInnerUp_R", "AU12", "breath"].map(str::to_owned);
        let table = WeightsTable::at_rate(
            names.to_vec(),
            vec![0.2, 0.4, 0.5, 1.0, 0.0, 0.0, 1.0, 0.0],
            0,
            60.0,
        );
        let folder = tempfile::tempdir().unwrap();
        for name in ["a.livelink.csv", "a.json"] {
            let path = folder.path().join(name);
            let (renamed, left_out) = weights_for_file(&table, &path).unwrap();
            assert_eq!(left_out, ["breath"]);
            for (path, bytes) in weights_files(&renamed, &path).unwrap() {
                std::fs::write(path, bytes).unwrap();
            }
            let back = read_weights_file(&path, &WeightOptions::default()).unwrap();
            let column = |name: &str| {
                back.shape_names.iter().position(|own| own.eq_ignore_ascii_case(name)).unwrap()
            };
            for (name, wanted) in [
                ("browInnerUp", 0.3),
                ("mouthSmileLeft", 0.5),
                ("mouthSmileRight", 0.5),
                ("jawOpen", 0.0),
            ] {
                assert!((back.row(0)[column(name)] - wanted).abs() < 1e-9, "{name}");
            }
        }
        let csv = weights_for_file(&table, "a.csv".as_ref()).unwrap();
        assert_eq!(csv, (table, Vec::new()));
    }
}
