//! Positions of vertices over time as a NumPy array, frames x vertices x 3: what `mimique solve --vertices`
//! writes, and what other systems give of a surface.

use std::path::Path;

use super::header::{Header, header};
use super::stored;
use crate::ReadError;
use crate::formats::source;

const REMEDY: &str = "save it with numpy.save(file, positions), float32 or float64, frames x vertices x 3, in metres";

/// Vertices over time.
#[derive(Debug, Clone, PartialEq)]
pub struct VertexArray {
    /// Vertices of a frame.
    pub vertices: usize,
    /// Frames x vertices x 3.
    pub positions: Vec<f32>,
}

/// Reads an array of vertices.
///
/// # Errors
/// [`ReadError`] with its place: not an array, another shape, cut off.
pub fn read_vertex_array(path: &Path) -> Result<VertexArray, ReadError> {
    let mut file = source::open(path)?;
    let length = source::length(&mut *file)?;
    let header: Header<3> = header(&mut *file, length, REMEDY)?;
    let [frames, vertices, axes] = header.shape;
    if axes != 3 {
        let what = format!("an array of shape {:?}", header.shape);
        return Err(ReadError::at_byte(0, "header", what, REMEDY));
    }
    let numbers = stored(&mut *file, &header)?;
    let place = |frame: usize, vertex: usize, axis: usize| match header.fortran_order {
        false => (frame * vertices + vertex) * 3 + axis,
        true => (axis * vertices + vertex) * frames + frame,
    };
    let mut positions = Vec::with_capacity(numbers.len());
    for frame in 0..frames {
        for vertex in 0..vertices {
            positions.extend((0..3).map(|axis| numbers[place(frame, vertex, axis)] as f32));
        }
    }
    Ok(VertexArray { vertices, positions })
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
        for (shape, count) in [(&[6, 3][..], 18), (&[3, 3, 2], 18), (&[3, 2, 3], 17)] {
            write(npy_header("<f4", shape), &numbers[..count]);
            let error = read_vertex_array(&file).unwrap_err().to_string();
            assert!(error.contains("frames x vertices x 3") || error.contains("copy"), "{error}");
        }
    }
}
