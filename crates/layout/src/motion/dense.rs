//! Dense takes: the skin itself, frame by frame, as scans and other systems give it.
//!
//! What a bank can do of a frame is its least-squares weights; of what is left over all frames a few modes are
//! kept, orthogonal, the largest frame that is left first, until hardly anything is.

use mimique_geometry::solve_linear;

use super::moments::products;
use crate::face::Face;

/// Most modes beside the shapes.
const MOST_MODES: usize = 40;
/// What may be left of a frame, metres a vertex, root mean square.
const LEFT_M: f64 = 2e-5;
/// Frames that the modes are found on: evenly spaced ones.
const MODE_FRAMES: usize = 240;
/// Ridge of the least squares, as a share of the largest diagonal entry: dependent shapes get the least
/// weights.
const RIDGE: f64 = 1e-9;
/// A take whose nearest frame is farther from the avatar's neutral face is of another face, metres a vertex.
const OTHER_FACE_M: f64 = 5e-4;

/// The positions of the skin's vertices.
#[derive(Debug, Clone, PartialEq)]
pub struct DenseTake {
    /// Vertices of a frame.
    pub vertices: usize,
    /// Frames x vertices x 3, metres: the welded skin's, or the avatar file's own.
    pub positions: Vec<f32>,
}

/// Why a dense take cannot be used.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum DenseTakeError {
    /// It is of another mesh.
    #[error(
        "{name}: {found} vertices in a frame, the avatar's skin has {file} ({welded} when its seams are closed); \
         give a take on the avatar's own mesh, as `mimique solve --vertices` writes"
    )]
    Topology {
        /// The take.
        name: String,
        /// Its vertices.
        found: usize,
        /// Those of the avatar's file.
        file: usize,
        /// Those of the welded skin.
        welded: usize,
    },
    /// It has no frame, or a number that is none.
    #[error("{name}: frame {frame}: {what}; give finite positions in metres")]
    Frame {
        /// The take.
        name: String,
        /// The frame.
        frame: usize,
        /// What is wrong.
        what: &'static str,
    },
}

/// The least squares of a bank.
pub(super) struct Bank {
    shapes: usize,
    gram: Vec<f64>,
}

/// A dense take, and what the bank does of it.
pub(super) struct InBank {
    /// Frames x 3 welded vertices, metres, from the person's rest.
    displacements: Vec<f64>,
    /// Numbers of a frame.
    width: usize,
    /// Frames x N.
    weights: Vec<f64>,
    /// Frames x 3 vertices: what the weights leave.
    left: Vec<f64>,
}

impl Bank {
    pub(super) fn of(face: &Face<'_>) -> Self {
        let n = face.shape_count();
        let mut gram = products(&face.deltas, n);
        let largest = (0..n).fold(0.0_f64, |most, k| most.max(gram[k * n + k]));
        (0..n).for_each(|k| gram[k * n + k] += RIDGE * largest);
        Self { shapes: n, gram }
    }

    /// A take in the bank.
    pub(super) fn project(
        &self,
        face: &Face<'_>,
        take: &DenseTake,
        name: &str,
    ) -> Result<InBank, DenseTakeError> {
        let displacements = displacements(face, take, name)?;
        let n = self.shapes;
        let width = 3 * face.skin.mesh.positions.len();
        let frames = displacements.len() / width;
        // Right sides: N x frames.
        let mut right = vec![0.0; n * frames];
        for (f, frame) in displacements.chunks_exact(width).enumerate() {
            let mut sums = vec![0.0; n];
            for (x, row) in frame.iter().zip(face.deltas.chunks_exact(n)) {
                if *x != 0.0 {
                    sums.iter_mut().zip(row).for_each(|(s, d)| *s += x * d);
                }
            }
            sums.iter().enumerate().for_each(|(k, s)| right[k * frames + f] = *s);
        }
        if solve_linear(&self.gram, &mut right, n).is_none() {
            right.fill(0.0);
        }
        let weights: Vec<f64> = (0..frames)
            .flat_map(|f| (0..n).map(move |k| (f, k)))
            .map(|(f, k)| right[k * frames + f])
            .collect();
        let mut left = displacements.clone();
        for (frame, weights) in left.chunks_exact_mut(width).zip(weights.chunks_exact(n)) {
            for (x, row) in frame.iter_mut().zip(face.deltas.chunks_exact(n)) {
                *x -= row.iter().zip(weights).map(|(d, w)| d * w).sum::<f64>();
            }
        }
        Ok(InBank { displacements, width, weights, left })
    }
}

impl InBank {
    /// Some frames of the trajectories, evenly spaced.
    pub(super) fn clustered(&self, most: usize) -> Vec<f64> {
        let frames = self.displacements.len() / self.width;
        let count = frames.min(most);
        (0..count)
            .flat_map(|i| {
                let frame = i * frames / count;
                &self.displacements[frame * self.width..(frame + 1) * self.width]
            })
            .copied()
            .collect()
    }
}

/// How each vertex of the welded skin goes from the person's rest: the avatar's own neutral face, or, of
/// another face, the frame that is nearest to it.
fn displacements(
    face: &Face<'_>,
    take: &DenseTake,
    name: &str,
) -> Result<Vec<f64>, DenseTakeError> {
    let mesh = &face.skin.mesh;
    let (welded, file) = (mesh.positions.len(), face.skin.welded_from_file.len());
    if take.vertices != welded && take.vertices != file || take.vertices == 0 {
        let (name, found) = (name.to_owned(), take.vertices);
        return Err(DenseTakeError::Topology { name, found, file, welded });
    }
    let wrong =
        |frame: usize, what| Err(DenseTakeError::Frame { name: name.to_owned(), frame, what });
    if take.positions.is_empty() {
        return wrong(0, "there is none");
    }
    // The vertex of the take for each of the welded skin.
    let mut source: Vec<usize> = (0..welded).collect();
    if take.vertices == file {
        for (v, &w) in face.skin.welded_from_file.iter().enumerate().rev() {
            source[w as usize] = v;
        }
    }
    let mut out = Vec::with_capacity(take.positions.len() / take.vertices * welded);
    let mut nearest = (0, f64::INFINITY);
    for (f, frame) in take.positions.chunks_exact(3 * take.vertices).enumerate() {
        let mut square = 0.0;
        for (&v, rest) in source.iter().zip(&mesh.positions) {
            for axis in 0..3 {
                let x = f64::from(frame[3 * v + axis]) - rest[axis];
                if !x.is_finite() {
                    return wrong(f, "a position is not finite");
                }
                square += x * x;
                out.push(x);
            }
        }
        if square < nearest.1 {
            nearest = (f, square);
        }
    }
    let width = 3 * welded;
    if (nearest.1 / welded as f64).sqrt() > OTHER_FACE_M {
        let rest = out[nearest.0 * width..(nearest.0 + 1) * width].to_vec();
        for frame in out.chunks_exact_mut(width) {
            frame.iter_mut().zip(&rest).for_each(|(x, r)| *x -= r);
        }
    }
    Ok(out)
}

/// Orthogonal fields beside a bank.
pub(super) struct Modes {
    pub(super) count: usize,
    /// Count x 3 vertices, of length 1.
    fields: Vec<f64>,
    width: usize,
}

/// The modes of what some takes have beside a bank's shapes.
pub(super) fn modes<'a>(takes: impl Iterator<Item = &'a InBank>, vertices: usize) -> Modes {
    let width = 3 * vertices;
    let mut left: Vec<Vec<f64>> = Vec::new();
    for take in takes {
        let frames = take.left.len() / width;
        let count = frames.min(MODE_FRAMES);
        let frame = |i: usize| i * frames / count;
        left.extend((0..count).map(|i| take.left[frame(i) * width..][..width].to_vec()));
    }
    let square = |x: &[f64]| x.iter().map(|x| x * x).sum::<f64>();
    let enough = LEFT_M * LEFT_M * vertices as f64;
    let mut fields: Vec<f64> = Vec::new();
    let mut count = 0;
    while count < MOST_MODES {
        let largest = (0..left.len())
            .map(|i| (square(&left[i]), i))
            .reduce(|best, next| if next.0 > best.0 { next } else { best });
        let Some((size, place)) = largest.filter(|(size, _)| *size > enough) else { break };
        let field: Vec<f64> = left[place].iter().map(|x| x / size.sqrt()).collect();
        for other in &mut left {
            let share: f64 = other.iter().zip(&field).map(|(x, f)| x * f).sum();
            other.iter_mut().zip(&field).for_each(|(x, f)| *x -= share * f);
        }
        fields.extend(field);
        count += 1;
    }
    Modes { count, fields, width }
}

impl Modes {
    /// The basis: the bank's columns, then the modes.
    pub(super) fn beside(&self, bank: &[f64], n: usize) -> Vec<f64> {
        if self.count == 0 {
            return bank.to_vec();
        }
        let mut out = Vec::with_capacity(bank.len() / n * (n + self.count));
        for (place, row) in bank.chunks_exact(n).enumerate() {
            out.extend(row);
            out.extend((0..self.count).map(|m| self.fields[m * self.width + place]));
        }
        out
    }

    /// Weights with no motion beside the bank's.
    pub(super) fn widened(&self, weights: &[f64], n: usize) -> Vec<f64> {
        let rest = std::iter::repeat_n(0.0, self.count);
        weights.chunks_exact(n).flat_map(|row| row.iter().copied().chain(rest.clone())).collect()
    }

    /// The coefficients of a take's frames.
    pub(super) fn coefficients(&self, take: &InBank, n: usize) -> Vec<f64> {
        let mut out = Vec::new();
        let frames = take.weights.chunks_exact(n).zip(take.left.chunks_exact(take.width));
        for (weights, left) in frames {
            out.extend(weights);
            let amount = |m: usize| -> f64 {
                let field = &self.fields[m * self.width..(m + 1) * self.width];
                field.iter().zip(left).map(|(f, x)| f * x).sum()
            };
            out.extend((0..self.count).map(amount));
        }
        out
    }
}
