//! Positions of vertices over time as a NumPy array, frames x vertices x 3: what `mimique solve --vertices`
//! writes, and what other systems give of a surface (VOCA, FaceFormer, CodeTalker, FLAME).
//!
//! Read as a capture each vertex is a marker, `v0`, `v1`, ... in the array's order.

use std::io::Cursor;
use std::path::Path;

use mimique_geometry::Point;

use super::header::{Header, MAGIC, description, header, shape_at_the_beginning};
use super::{npz, stored};
use crate::capture::unit::decide_unit;
use crate::formats::format::{Format, Read, Recognise};
use crate::formats::plausibility::whole_or_missing;
use crate::formats::source::{self, Source};
use crate::{Capture, ReadError, ReadOptions, Recording};

const REMEDY: &str =
    "save it with numpy.save(file, positions), float32 or float64, frames x vertices x 3";

/// Vertices as markers.
pub(crate) static FORMAT: Format = Format {
    id: "npy-vertices",
    name: "NumPy array (vertices)",
    extensions: &["npy"],
    recognised_by: "`\\x93NUMPY`, three dimensions, the last of them 3",
    reads: "frames x vertices x 3 as markers `v0`, `v1`, ..., at the rate that is asked for",
    recognise: Recognise::Beginning(|bytes| {
        bytes.starts_with(MAGIC)
            && matches!(shape_at_the_beginning(bytes).as_deref(), Some([_, _, 3]))
    }),
    read: Read::Binary(read),
    write: None,
};

/// Vertices over time.
#[derive(Debug, Clone, PartialEq)]
pub struct VertexArray {
    /// Vertices of a frame.
    pub vertices: usize,
    /// Frames x vertices x 3.
    pub positions: Vec<f32>,
}

/// Reads an array of vertices: `.npy`, or the one in an `.npz`. The coordinates of a frame may stand in one
/// row (frames x 3 vertices), as FaceFormer and CodeTalker write them.
///
/// # Errors
/// [`ReadError`] with its place: not an array, another shape, cut off.
pub fn read_vertex_array(path: &Path) -> Result<VertexArray, ReadError> {
    let mut file = source::open(path)?;
    let length = source::length(&mut *file)?;
    if npz::is_archive(&source::beginning(&mut *file, 512)?) {
        let array = npz::vertices(&mut *file, length)?;
        return array_of(&mut Cursor::new(&array[..]), array.len() as u64);
    }
    array_of(&mut *file, length)
}

fn array_of(file: &mut dyn Source, length: u64) -> Result<VertexArray, ReadError> {
    let shape = description(file, length, REMEDY)?.keys.shape;
    if let [_, row] = shape[..]
        && row > 3
        && row.is_multiple_of(3)
    {
        let header: Header<2> = header(file, length, REMEDY)?;
        let (numbers, frames) = (stored(file, &header)?, header.shape[0]);
        let place = |i: usize| match header.fortran_order {
            false => i,
            true => i % row * frames + i / row,
        };
        let positions = (0..numbers.len()).map(|i| numbers[place(i)] as f32).collect();
        return Ok(VertexArray { vertices: row / 3, positions });
    }
    let (vertices, positions) = positions(file, length)?;
    Ok(VertexArray { vertices, positions: positions.iter().map(|x| *x as f32).collect() })
}

/// The number of vertices and all coordinates, frame by frame.
fn positions(file: &mut dyn Source, length: u64) -> Result<(usize, Vec<f64>), ReadError> {
    let header: Header<3> = header(file, length, REMEDY)?;
    let [frames, vertices, axes] = header.shape;
    if axes != 3 {
        let what = format!("an array of shape {:?}", header.shape);
        return Err(ReadError::at_byte(0, "header", what, REMEDY));
    }
    let numbers = stored(file, &header)?;
    if !header.fortran_order {
        return Ok((vertices, numbers));
    }
    let mut positions = Vec::with_capacity(numbers.len());
    for frame in 0..frames {
        for vertex in 0..vertices {
            positions
                .extend((0..3).map(|axis| numbers[(axis * vertices + vertex) * frames + frame]));
        }
    }
    Ok((vertices, positions))
}

/// Read the document.
fn read(file: &mut dyn Source, options: &ReadOptions) -> Result<Recording, ReadError> {
    let length = source::length(file)?;
    let (vertices, positions) = positions(file, length)?;
    let rate_hz = options.rate_hz.filter(|rate| rate.is_finite() && *rate > 0.0);
    let rate_hz = rate_hz.ok_or_else(|| {
        let what = "no rate: an array has none";
        ReadError::at_byte(0, "header", what, "give the rate of the recording (--mocap-rate)")
    })?;
    if positions.is_empty() {
        return Err(ReadError::at_byte(0, "header", "no frame", REMEDY));
    }
    let mut notes = Vec::new();
    let points = positions.as_chunks::<3>().0.iter();
    let mut points: Vec<Point> = points.map(|&[x, y, z]| Point::new(x, y, z)).collect();
    whole_or_missing(&mut points, &mut notes);
    let unit = decide_unit(options.unit, None, &points, vertices, &mut notes);
    let capture = Capture {
        labels: (0..vertices).map(|v| format!("v{v}")).collect(),
        rate_hz,
        first_frame: 0,
        unit,
        positions: points,
        notes,
    };
    Ok(Recording { capture, format: &FORMAT, system: None, analog_channels: 0, events: Vec::new() })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::npy_header;

    #[test]
    fn vertices_are_read_in_both_orders_and_other_shapes_are_refused() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("v.npy");
        let write = |header: Vec<u8>, numbers: &[f32]| {
            let bytes = numbers.iter().flat_map(|x| x.to_le_bytes());
            std::fs::write(&file, header.into_iter().chain(bytes).collect::<Vec<u8>>()).unwrap();
        };
        let numbers: Vec<f32> = (0..18).map(|i| i as f32).collect();
        write(npy_header("<f4", &[3, 2, 3]), &numbers);
        let read = read_vertex_array(&file).unwrap();
        assert_eq!((read.vertices, read.positions), (2, numbers.clone()));
        let fortran = String::from_utf8(npy_header("<f4", &[3, 2, 3])[10..].to_vec()).unwrap();
        let fortran = fortran.replace("False", "True ");
        let head = [&npy_header("<f4", &[3, 2, 3])[..10], fortran.as_bytes()].concat();
        write(head, &numbers);
        let read = read_vertex_array(&file).unwrap();
        assert_eq!(read.positions[..6], [0.0, 6.0, 12.0, 3.0, 9.0, 15.0]);
        write(npy_header("<f4", &[3, 6]), &numbers);
        let read = read_vertex_array(&file).unwrap();
        assert_eq!((read.vertices, read.positions), (2, numbers.clone()));
        for (shape, count) in [(&[6, 3][..], 18), (&[3, 3, 2], 18), (&[3, 2, 3], 17)] {
            write(npy_header("<f4", shape), &numbers[..count]);
            let error = read_vertex_array(&file).unwrap_err().to_string();
            assert!(error.contains("frames x vertices x 3") || error.contains("copy"), "{error}");
        }
    }

    #[test]
    fn vertices_are_markers_at_the_rate_that_is_said() {
        let header = npy_header("<f8", &[3, 2, 3]);
        let numbers: Vec<f64> = (0..18).map(|i| f64::from(i) / 100.0).collect();
        let bytes: Vec<u8> =
            header.into_iter().chain(numbers.iter().flat_map(|x| x.to_le_bytes())).collect();
        assert_eq!(crate::recognise(&bytes).map(|f| f.id), Some("npy-vertices"));
        let options = ReadOptions { rate_hz: Some(60.0), ..ReadOptions::default() };
        let capture = crate::read_recording(&bytes, &options).unwrap().capture;
        assert_eq!(
            (&capture.labels[..], capture.frames()),
            (&["v0", "v1"].map(str::to_owned)[..], 3)
        );
        assert_eq!(capture.unit, crate::LengthUnit::Metre);
        assert_eq!(capture.positions[5], [0.15, 0.16, 0.17]);
        let error = crate::read_bytes(&bytes).unwrap_err().to_string();
        assert!(error.starts_with("byte 0, header: no rate: an array has none; give"), "{error}");
    }
}
