//! Weights as a NumPy array: `.npy` of format 1.0, 2.0 or 3.0, frames x shapes.
//!
//! The array is of 4- or 8-byte floats, little- or big-endian, in C or Fortran order. It holds
//! neither names nor a rate: both stand in `NAME.shapes.json` beside `NAME.npy`, which is written
//! with it. Without that file the columns are the shapes of the avatar, where their number fits,
//! and the caller says the rate.

mod header;
pub(super) mod npz;
#[cfg(test)]
mod tests;
mod vertices;

pub use header::npy_header;
pub(super) use vertices::FORMAT as VERTICES;
pub use vertices::{VertexArray, read_vertex_array};

use std::io::SeekFrom;
use std::path::{Path, PathBuf};

use self::header::{Header, MAGIC, header};
use super::format::{Format, Read, Recognise, Write};
use super::source::{self, Source};
use crate::{ReadError, WeightOptions, WeightsTable};

const REMEDY: &str = "save it with numpy.save(file, weights), float32 or float64, frames x shapes";
const BESIDE: &str = "write NAME.shapes.json beside NAME.npy: \
                      {\"shape_names\": [\"jawOpen\", ...], \"rate_hz\": 60}";
pub(super) static FORMAT: Format = Format {
    id: "npy",
    name: "NumPy array (weights)",
    extensions: &["npy"],
    recognised_by: "`\\x93NUMPY`",
    reads: "format 1.0 to 3.0; `f4` and `f8`, both byte orders, C and Fortran order; names and rate from `NAME.shapes.json` beside it, else the avatar's shapes and the rate that is asked for",
    recognise: Recognise::Beginning(|bytes| bytes.starts_with(MAGIC)),
    read: Read::BinaryWeights(read),
    write: Some(Write::Weights { columns: None, write }),
};

/// What stands beside an array.
#[derive(Debug, Clone, Default, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct Beside {
    /// Names of the columns.
    shape_names: Vec<String>,
    /// Frames per second.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    rate_hz: Option<f64>,
    /// Number of the first frame.
    #[serde(default)]
    first_frame: u64,
}

impl Beside {
    fn path(array: &Path) -> PathBuf {
        array.with_extension("shapes.json")
    }

    /// What stands beside that array; `None` where there is no such file.
    fn read(array: &Path) -> Result<Option<Self>, ReadError> {
        let path = Self::path(array);
        let wrong = |what: String| ReadError::Beside {
            file: path.file_name().unwrap_or_default().to_string_lossy().into_owned(),
            what,
            remedy: BESIDE,
        };
        match std::fs::read(&path) {
            Ok(bytes) => {
                let beside: Self =
                    serde_json::from_slice(&bytes).map_err(|e| wrong(e.to_string()))?;
                match beside.rate_hz {
                    Some(rate) if !(rate > 0.0 && rate.is_finite()) => {
                        Err(wrong(format!("rate_hz: {rate} frames per second")))
                    }
                    _ => Ok(Some(beside)),
                }
            }
            Err(e) if e.kind() == std::io::ErrorKind::NotFound => Ok(None),
            Err(e) => Err(wrong(e.to_string())),
        }
    }
}

/// Read the document.
fn read(
    file: &mut dyn Source,
    path: Option<&Path>,
    options: &WeightOptions<'_>,
) -> Result<WeightsTable, ReadError> {
    let length = source::length(file)?;
    let header: Header<2> = header(file, length, REMEDY)?;
    let beside = path.map(Beside::read).transpose()?.flatten();
    let columns = header.shape[1];
    let names = match &beside {
        Some(beside) => &beside.shape_names,
        None => options.shape_names,
    };
    check_names(names, columns, beside.is_some())?;
    let rate_hz = options.rate_hz.or(beside.as_ref().and_then(|beside| beside.rate_hz));
    let rate_hz = checked_rate(rate_hz)?;
    let weights = numbers(file, &header, names)?;
    let first_frame = beside.as_ref().map_or(0, |beside| beside.first_frame);
    Ok(WeightsTable::at_rate(names.to_vec(), weights, first_frame, rate_hz))
}

/// Refuses names that are not one of its own for each column.
fn check_names(names: &[String], columns: usize, with_the_array: bool) -> Result<(), ReadError> {
    if names.len() != columns {
        let what = match (with_the_array, names.len()) {
            (true, n) => format!("{columns} columns, NAME.shapes.json has {n} names"),
            (false, 0) => format!("{columns} columns, whose names are not known"),
            (false, n) => format!("{columns} columns, the avatar has {n} shapes"),
        };
        return Err(ReadError::at_byte(0, "header", what, BESIDE));
    }
    if let Some(k) = (0..columns).find(|&k| names[k].is_empty() || names[..k].contains(&names[k])) {
        let what = format!("shape {:?} empty or twice", names[k]);
        return Err(ReadError::at_byte(0, "names", what, "give every column a name of its own"));
    }
    Ok(())
}

/// The rate, which an array has not.
fn checked_rate(rate_hz: Option<f64>) -> Result<f64, ReadError> {
    rate_hz.filter(|rate| rate.is_finite() && *rate > 0.0).ok_or_else(|| {
        ReadError::at_byte(
            0,
            "header",
            "no rate: an array has none",
            "give it, or write NAME.shapes.json beside NAME.npy: {\"shape_names\": [...], \"rate_hz\": 60}",
        )
    })
}

/// The numbers, frame by frame.
fn numbers(
    file: &mut dyn Source,
    header: &Header<2>,
    names: &[String],
) -> Result<Vec<f64>, ReadError> {
    let Header { shape: [rows, columns], data, width, .. } = *header;
    let numbers = stored(file, header)?;
    let mut weights = Vec::with_capacity(rows * columns);
    for row in 0..rows {
        for (column, name) in names.iter().enumerate().take(columns) {
            let place =
                if header.fortran_order { column * rows + row } else { row * columns + column };
            let found = numbers.get(place).copied();
            weights.push(found.filter(|w| w.is_finite()).ok_or_else(|| {
                let what = format!(
                    "row {row}, column {column} ({name}): {}",
                    found.map_or("missing".to_owned(), |w| w.to_string())
                );
                let at = data + (place * width) as u64;
                ReadError::at_byte(at, "data", what, "write a finite number for every weight")
            })?);
        }
    }
    Ok(weights)
}

/// The numbers of an array in the order of the file, as many as there are.
fn stored<const R: usize>(
    file: &mut dyn Source,
    header: &Header<R>,
) -> Result<Vec<f64>, ReadError> {
    let (width, big_endian) = (header.width, header.big_endian);
    file.seek(SeekFrom::Start(header.data)).map_err(ReadError::Read)?;
    // The header was held against the length of the file: no more is asked for than there is.
    let mut bytes = vec![0; header.shape.iter().product::<usize>() * width];
    let filled = source::fill(file, &mut bytes)?;
    bytes.truncate(filled);
    let value = |here: &[u8]| match (width, big_endian) {
        (4, false) => here.try_into().map_or(f64::NAN, |b| f64::from(f32::from_le_bytes(b))),
        (4, true) => here.try_into().map_or(f64::NAN, |b| f64::from(f32::from_be_bytes(b))),
        (_, false) => here.try_into().map_or(f64::NAN, f64::from_le_bytes),
        (_, true) => here.try_into().map_or(f64::NAN, f64::from_be_bytes),
    };
    Ok(bytes.chunks_exact(width).map(value).collect())
}

/// The array, and beside it its names, rate and first frame.
fn write(table: &WeightsTable, path: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    let mut array = npy_header("<f8", &[table.frames.len(), table.shape_names.len()]);
    array.extend(table.weights.iter().flat_map(|w| w.to_le_bytes()));
    let beside = Beside {
        shape_names: table.shape_names.clone(),
        rate_hz: table.rate_hz(),
        first_frame: table.frames.first().copied().unwrap_or(0),
    };
    let beside = serde_json::to_vec_pretty(&beside).unwrap_or_default();
    vec![(Beside::path(path), beside), (path.to_owned(), array)]
}
