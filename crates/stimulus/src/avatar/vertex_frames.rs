//! Positions of the skin's vertices, frame by frame, as a NumPy array.

use std::io::{self, Write};

use mimique_geometry::{Point, coordinates};
use mimique_mocap::npy_header;
use mimique_solver::Synthesis;

use crate::{AvatarSkin, SolvedCapture};

/// The moved skin of a solved take: a bank's shapes, or the surface itself.
#[derive(Debug)]
pub struct VertexFrames<'a> {
    skin: &'a AvatarSkin,
    solved: &'a SolvedCapture,
}

impl<'a> VertexFrames<'a> {
    /// Of a take that was solved on `skin`.
    pub fn new(skin: &'a AvatarSkin, solved: &'a SolvedCapture) -> Self {
        Self { skin, solved }
    }

    /// Positions in one row of the weights, metres, a vertex of the file's skin meshes each.
    pub fn positions(&self, row: usize) -> Vec<Point> {
        let weights = self.solved.table.row(row);
        let mesh = &self.skin.mesh;
        let welded: Vec<Point> = match &self.solved.surface {
            Some(surface) => {
                let moved = surface.displacements(weights).into_iter().zip(&mesh.positions);
                moved.map(|(d, p)| *p + d).collect()
            }
            None => {
                let mut out = mesh.positions.clone();
                for (shape, w) in mesh.shapes.iter().zip(weights) {
                    for (&v, d) in shape.vertices.iter().zip(&shape.deltas) {
                        out[v as usize] += *w * *d;
                    }
                }
                out
            }
        };
        self.skin.welded_from_file.iter().map(|&v| welded[v as usize]).collect()
    }

    /// Writes all frames as NPY 1.0: f4, frames x vertices x 3.
    ///
    /// # Errors
    /// Those of the writer.
    pub fn write(&mut self, out: &mut dyn Write) -> io::Result<()> {
        let (frames, vertices) = (self.solved.table.frames.len(), self.skin.welded_from_file.len());
        out.write_all(&npy_header("<f4", &[frames, vertices, 3]))?;
        if self.solved.surface.is_none() {
            return self.write_bank(out);
        }
        for row in 0..frames {
            let positions = self.positions(row);
            let bytes = coordinates(&positions).iter().flat_map(|&x| (x as f32).to_le_bytes());
            out.write_all(&bytes.collect::<Vec<u8>>())?;
        }
        Ok(())
    }

    /// The frames of a bank, in single precision.
    fn write_bank(&self, out: &mut dyn Write) -> io::Result<()> {
        let synthesis = Synthesis::new(&self.skin.mesh);
        let width = synthesis.coordinates();
        let shapes = self.skin.mesh.shapes.len().max(1);
        let mut posed = vec![0.0; Synthesis::FRAMES * width];
        let mut bytes = Vec::new();
        for weights in self.solved.table.weights.chunks(Synthesis::FRAMES * shapes) {
            synthesis.pose(weights, &mut posed);
            for frame in posed.chunks_exact(width).take(weights.len() / shapes) {
                bytes.clear();
                for &v in &self.skin.welded_from_file {
                    let place = &frame[3 * v as usize..3 * v as usize + 3];
                    bytes.extend(place.iter().flat_map(|x| x.to_le_bytes()));
                }
                out.write_all(&bytes)?;
            }
        }
        Ok(())
    }
}
