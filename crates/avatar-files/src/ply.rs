//! A mesh from a PLY file (Turk 1994): the form in which VOCA, FLAME and MeshTalk give their templates.

use ply_rs_bw::parser::Parser;
use ply_rs_bw::ply::{DefaultElement, Property};

use crate::ReadError;
use crate::template::Surface;

/// What every PLY file begins with.
pub(crate) const MAGIC: &[u8] = b"ply";
/// Names that lists of a face's corners have.
const CORNERS: [&str; 2] = ["vertex_indices", "vertex_index"];

/// The vertices of a file in its order and its faces as triangles (polygons are fans from their first corner).
pub(crate) fn mesh_of(file: &str, bytes: &[u8]) -> Result<Surface, ReadError> {
    let mut reader = bytes;
    let read = Parser::<DefaultElement>::new().read_ply(&mut reader);
    let read = read.map_err(|error| ReadError::damaged(file, error.to_string()))?;
    let elements = |name: &str| read.payload.get(name).map(Vec::as_slice).unwrap_or_default();
    let mut positions = Vec::new();
    for (number, vertex) in elements("vertex").iter().enumerate() {
        let mut place = [0.0; 3];
        for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
            let value = vertex.get(name).and_then(Property::to_f32_lossy);
            place[axis] = value.filter(|x| x.is_finite()).ok_or_else(|| {
                let at = format!("{file}, vertex {number}");
                ReadError::damaged(at, format!("{name} is no number"))
            })?;
        }
        positions.push(place);
    }
    let mut triangles = Vec::new();
    for (number, face) in elements("face").iter().enumerate() {
        let at = |what: String| ReadError::damaged(format!("{file}, face {number}"), what);
        let corners = CORNERS.iter().find_map(|name| face.get(*name)?.to_u32_list());
        let corners = corners.ok_or_else(|| {
            at(format!("no list of vertices under the name {}", CORNERS.join(" or ")))
        })?;
        if let Some(corner) = corners.iter().find(|corner| **corner as usize >= positions.len()) {
            return Err(at(format!("vertex {corner} of {}", positions.len())));
        }
        let [first, others @ ..] = corners.as_slice() else { continue };
        triangles.extend(others.windows(2).map(|pair| [*first, pair[0], pair[1]]));
    }
    Ok((positions, triangles))
}

#[cfg(test)]
mod tests {
    use super::*;

    const ASCII: &str = "ply\nformat ascii 1.0\ncomment made here\nelement vertex 4\nproperty float x\n\
        property float y\nproperty double z\nproperty uchar red\nelement face 1\nproperty list uchar int vertex_index\n\
        end_header\n0 0 0 9\n1 0 0 9\n1 2 0 9\n0 2 0.5 9\n4 0 1 2 3\n";

    #[test]
    fn text_and_both_orders_of_bytes_are_read() {
        let expected = mesh_of("a.ply", ASCII.as_bytes()).unwrap();
        assert_eq!(expected.0[3], [0.0, 2.0, 0.5]);
        assert_eq!(expected.1, [[0, 1, 2], [0, 2, 3]]);
        for (order, big) in [("binary_little_endian", false), ("binary_big_endian", true)] {
            let header = ASCII.split("end_header\n").next().unwrap().replace("ascii", order);
            let mut bytes = format!("{header}end_header\n").into_bytes();
            let mut put = |mut number: Vec<u8>| {
                if big {
                    number.reverse();
                }
                bytes.extend(number);
            };
            for [x, y, z] in &expected.0 {
                put(x.to_le_bytes().to_vec());
                put(y.to_le_bytes().to_vec());
                put(f64::from(*z).to_le_bytes().to_vec());
                put(vec![9]);
            }
            put(vec![4]);
            (0..4_i32).for_each(|corner| put(corner.to_le_bytes().to_vec()));
            assert_eq!(mesh_of("b.ply", &bytes).unwrap(), expected, "{order}");
        }
    }

    #[test]
    fn damage_is_named_with_its_place() {
        let refused = |from: &str, to: &str| {
            mesh_of("a.ply", ASCII.replacen(from, to, 1).as_bytes()).unwrap_err().to_string()
        };
        assert_eq!(
            refused("4 0 1 2 3", "4 0 1 2 7"),
            "a.ply, face 0: vertex 7 of 4; export the file again"
        );
        assert!(refused("vertex_index", "corners").contains("vertex_indices or vertex_index"));
        assert!(refused("float x", "float u").contains("a.ply, vertex 0: x is no number"));
        // Cut off at any byte it is refused, and never taken for a smaller mesh.
        for end in 0..ASCII.len() - 1 {
            assert!(mesh_of("a.ply", &ASCII.as_bytes()[..end]).is_err(), "{end}");
        }
    }
}
