//! Positions of the skin's vertices, frame by frame, as a NumPy array.

use std::io::{self, Write};

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
    pub fn positions(&self, row: usize) -> Vec<[f64; 3]> {
        let weights = self.solved.table.row(row);
        let mesh = &self.skin.mesh;
        let welded: Vec<[f64; 3]> = match &self.solved.surface {
            Some(surface) => {
                let moved = surface.displacements(weights).into_iter().zip(&mesh.positions);
                moved.map(|(d, p)| [p[0] + d[0], p[1] + d[1], p[2] + d[2]]).collect()
            }
            None => {
                let mut out = mesh.positions.clone();
                for (shape, w) in mesh.shapes.iter().zip(weights) {
                    for (&v, d) in shape.vertices.iter().zip(&shape.deltas) {
                        for a in 0..3 {
                            out[v as usize][a] += w * d[a];
                        }
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
        let head = format!(
            "{{'descr': '<f4', 'fortran_order': False, 'shape': ({frames}, {vertices}, 3), }}"
        );
        // Magic, version, length and the header with its line end fill whole lines of 64 bytes.
        let padded = (10 + head.len() + 1).next_multiple_of(64) - 11;
        out.write_all(b"\x93NUMPY\x01\x00")?;
        out.write_all(&((padded + 1) as u16).to_le_bytes())?;
        out.write_all(format!("{head:padded$}\n").as_bytes())?;
        if self.solved.surface.is_none() {
            return self.write_bank(out);
        }
        for row in 0..frames {
            let positions = self.positions(row);
            let bytes = positions.iter().flatten().flat_map(|&x| (x as f32).to_le_bytes());
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
