//! A sequence of vertices as an avatar and weights: the principal components of the displacements from the
//! template, as many as the sequence needs.
//!
//! X: T x 3V, displacements of T frames. X = U S W' (singular value decomposition); a shape is a row of W', its
//! weight in a frame the entry of U S. U and S come of the eigenvectors of X X' (T x T), the method of snapshots
//! (Sirovich 1987), since sequences have fewer frames than coordinates. Nothing is centred: at weights of 0 the
//! avatar is the template. Each shape is scaled so that its largest weight is 1.

use faer::linalg::matmul::matmul;
use faer::{Accum, Mat, MatRef, Par, Side};
use mimique_avatar::{Avatar, MOST_SHAPES, Mesh, SparseShape};
use mimique_avatar_files::Template;
use mimique_mocap::{VertexArray, WeightsTable};

/// Colour of a mesh that has none: grey clay, linear RGB.
const CLAY: [f32; 3] = [0.45, 0.42, 0.4];
/// Most frames: the eigenvectors take the cube of it.
const MOST_FRAMES: usize = 6000;
/// Most coordinates of all frames.
const MOST_COORDINATES: usize = 1 << 27;
/// Coordinates of all frames taken at a time.
const BLOCK: usize = 2048;
/// Components whose eigenvalue is below this share of the largest are lost in the rounding of X X'.
const ROUNDING: f64 = 1e-13;

/// How exact the avatar is to be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VertexBankOptions {
    /// Frames per second of the sequence.
    pub rate_hz: f64,
    /// No vertex of any frame is to be farther off, metres.
    pub tolerance_m: f64,
    /// No more shapes than these, even if that is not reached; at most [`MOST_SHAPES`].
    pub most_shapes: usize,
}

/// An avatar that a sequence of vertices was compressed to.
#[derive(Debug, Clone, PartialEq)]
pub struct VertexBank {
    /// The template with the shapes `component1`, ...
    pub avatar: Avatar,
    /// The weights of the sequence, between -1 and 1.
    pub weights: WeightsTable,
    /// The largest distance of a vertex of any frame from its place in the sequence, metres.
    pub largest_error_m: f64,
    /// Frame and vertex of that.
    pub largest_at: (usize, usize),
    /// The root mean square of that distance, metres.
    pub rms_error_m: f64,
}

/// Why a sequence cannot be compressed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum VertexBankError {
    /// Template and sequence are of different meshes.
    #[error(
        "vertices: {found} in each frame, the template has {wanted}; give the template of the sequence, its \
         vertices in the same order"
    )]
    Vertices {
        /// In the sequence.
        found: usize,
        /// In the template.
        wanted: usize,
    },
    /// Fewer than two frames.
    #[error("frames: {0}; give a sequence of two or more")]
    Frames(usize),
    /// More than can be held or decomposed.
    #[error(
        "frames: {frames} of {vertices} vertices; cut the sequence into takes of {most} frames at most"
    )]
    TooLong {
        /// In the sequence.
        frames: usize,
        /// In each frame.
        vertices: usize,
        /// Frames that are possible.
        most: usize,
    },
    /// A position that is none.
    #[error("frame {frame}, vertex {vertex}: {value}; write a finite number for every coordinate")]
    NotFinite {
        /// Frame, from 0.
        frame: usize,
        /// Vertex, from 0.
        vertex: usize,
        /// What stands there.
        value: f32,
    },
    /// A face that goes away from its template.
    #[error(
        "frame {frame}, vertex {vertex}: {distance_mm:.0} mm from the template, in the template's unit of {unit_m} \
         m; give both in one unit, the head held still"
    )]
    Far {
        /// Frame, from 0.
        frame: usize,
        /// Vertex, from 0.
        vertex: usize,
        /// Distance.
        distance_mm: f64,
        /// Unit that the template's size tells.
        unit_m: f64,
    },
    /// Every frame is the template.
    #[error("frames: every one is the template; give a sequence that moves")]
    Still,
    /// The eigenvectors were not found.
    #[error("frames: their covariance has no eigenvectors; give a shorter sequence")]
    NoEigenvectors,
}

/// A vertex farther from the template than this is of another mesh or unit, metres.
const FARTHEST_M: f64 = 1.0;

impl VertexBank {
    /// Compresses a sequence, whose numbers are in the template's unit.
    ///
    /// # Errors
    /// [`VertexBankError`]: another mesh, too few or too many frames, numbers that are none.
    pub fn of(
        name: &str,
        template: &Template,
        sequence: &VertexArray,
        options: &VertexBankOptions,
    ) -> Result<Self, VertexBankError> {
        let mut residual = displacements(template, sequence)?;
        let width = 3 * template.positions.len();
        let frames = residual.len() / width;
        let (values, vectors) = eigenvectors(&residual, frames, width)?;
        let first = values[frames - 1];
        if first <= 0.0 {
            return Err(VertexBankError::Still);
        }
        let (mut shapes, mut columns) = (Vec::new(), Vec::new());
        let mut error = Error::of(&residual, width);
        for k in (0..frames).rev() {
            let enough = error.largest_m <= options.tolerance_m && !shapes.is_empty();
            let most = options.most_shapes.clamp(1, MOST_SHAPES);
            if enough || shapes.len() == most || values[k] <= ROUNDING * first {
                break;
            }
            let column: Vec<f64> = (0..frames).map(|frame| vectors[(frame, k)]).collect();
            let (shape, weights) = component(&residual, &column, width);
            take_off(&mut residual, &shape, &weights);
            error = Error::of(&residual, width);
            shapes.push(SparseShape::from_dense(shape.as_chunks::<3>().0));
            columns.push(weights);
        }
        let shape_names: Vec<String> =
            (1..=shapes.len()).map(|k| format!("component{k}")).collect();
        let weights = (0..frames).flat_map(|frame| columns.iter().map(move |c| c[frame]));
        let weights =
            WeightsTable::at_rate(shape_names.clone(), weights.collect(), 0, options.rate_hz);
        let mesh = Mesh {
            name: "face".to_owned(),
            positions: template.positions.clone(),
            triangles: template.triangles.clone(),
            base_colour: CLAY,
            shapes,
            ..Mesh::default()
        };
        let avatar =
            Avatar { name: name.to_owned(), shape_names, meshes: vec![mesh], ..Avatar::default() };
        Ok(Self {
            avatar,
            weights,
            largest_error_m: error.largest_m,
            largest_at: error.at,
            rms_error_m: error.rms_m,
        })
    }
}

/// The displacements from the template, metres: T x 3V.
fn displacements(template: &Template, sequence: &VertexArray) -> Result<Vec<f32>, VertexBankError> {
    let wanted = template.positions.len();
    if sequence.vertices != wanted {
        return Err(VertexBankError::Vertices { found: sequence.vertices, wanted });
    }
    let frames = sequence.positions.len() / (3 * wanted);
    if frames < 2 {
        return Err(VertexBankError::Frames(frames));
    }
    let most = MOST_FRAMES.min(MOST_COORDINATES / (3 * wanted));
    if frames > most {
        return Err(VertexBankError::TooLong { frames, vertices: wanted, most });
    }
    let unit_m = template.unit_metres;
    let rest = template.positions.as_flattened();
    let mut out = Vec::with_capacity(sequence.positions.len());
    for (frame, row) in sequence.positions.chunks_exact(3 * wanted).enumerate() {
        for (i, (&x, &rest)) in row.iter().zip(rest).enumerate() {
            let d = f64::from(x) * unit_m - f64::from(rest);
            let vertex = i / 3;
            if !d.is_finite() {
                return Err(VertexBankError::NotFinite { frame, vertex, value: x });
            }
            if d.abs() > FARTHEST_M {
                let distance_mm = 1e3 * d.abs();
                return Err(VertexBankError::Far { frame, vertex, distance_mm, unit_m });
            }
            out.push(d as f32);
        }
    }
    Ok(out)
}

/// Eigenvalues, ascending, and eigenvectors of X X'. Sums are in double precision and in one order.
fn eigenvectors(
    x: &[f32],
    frames: usize,
    width: usize,
) -> Result<(Vec<f64>, Mat<f64>), VertexBankError> {
    let mut products = Mat::<f64>::zeros(frames, frames);
    let mut block = Vec::with_capacity(frames * BLOCK);
    for first in (0..width).step_by(BLOCK) {
        let columns = first..(first + BLOCK).min(width);
        block.clear();
        for row in x.chunks_exact(width) {
            block.extend(row[columns.clone()].iter().map(|x| f64::from(*x)));
        }
        let block = MatRef::from_row_major_slice(&block, frames, columns.len());
        matmul(products.as_mut(), Accum::Add, block, block.transpose(), 1.0, Par::Seq);
    }
    let found =
        products.self_adjoint_eigen(Side::Lower).map_err(|_| VertexBankError::NoEigenvectors)?;
    let values = found.S().column_vector().iter().copied().collect();
    Ok((values, found.U().to_owned()))
}

/// A shape of the bank and its weights, of an eigenvector u: the shape is X'u, the weights u, scaled so that
/// the largest is 1. What is left over of the components before is not in X'u but for rounding, which the
/// components behind make good.
fn component(residual: &[f32], u: &[f64], width: usize) -> (Vec<f32>, Vec<f64>) {
    let largest = u.iter().fold(0.0f64, |most, w| if w.abs() > most.abs() { *w } else { most });
    let mut shape = vec![0.0f64; width];
    for (row, u) in residual.chunks_exact(width).zip(u) {
        shape.iter_mut().zip(row).for_each(|(sum, x)| *sum += u * f64::from(*x));
    }
    let shape = shape.into_iter().map(|d| (d * largest) as f32).collect();
    (shape, u.iter().map(|w| w / largest).collect())
}

/// Takes a component off the residual, as the file will have it.
fn take_off(residual: &mut [f32], shape: &[f32], weights: &[f64]) {
    for (row, weight) in residual.chunks_exact_mut(shape.len()).zip(weights) {
        row.iter_mut()
            .zip(shape)
            .for_each(|(x, d)| *x = (f64::from(*x) - weight * f64::from(*d)) as f32);
    }
}

/// How far the vertices are off.
struct Error {
    largest_m: f64,
    at: (usize, usize),
    rms_m: f64,
}

impl Error {
    fn of(residual: &[f32], width: usize) -> Self {
        let (mut largest, mut at, mut sum) = (0.0f64, (0, 0), 0.0);
        for (frame, row) in residual.chunks_exact(width).enumerate() {
            for (vertex, d) in row.as_chunks::<3>().0.iter().enumerate() {
                let square: f64 = d.iter().map(|x| f64::from(*x).powi(2)).sum();
                sum += square;
                if square > largest {
                    (largest, at) = (square, (frame, vertex));
                }
            }
        }
        let count = (residual.len() / 3).max(1) as f64;
        Self { largest_m: largest.sqrt(), at, rms_m: (sum / count).sqrt() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn template() -> Template {
        let positions = (0..40).map(|v| {
            let (x, y) = ((v % 8) as f32, (v / 8) as f32);
            [0.02 * x, 0.03 * y, 0.001 * x * y]
        });
        let triangles = (0..32).filter(|v| v % 8 < 7).flat_map(|v| {
            let v = v as u32;
            [[v, v + 1, v + 9], [v, v + 9, v + 8]]
        });
        Template {
            positions: positions.collect(),
            triangles: triangles.collect(),
            unit_metres: 0.001,
        }
    }

    /// Displacements of `planted` shapes, in millimetres beside the template's metres.
    fn sequence(template: &Template, frames: usize, planted: usize) -> VertexArray {
        let wave = |i: usize| (i as f64 * 0.7).sin();
        let positions = (0..frames).flat_map(|frame| {
            template.positions.iter().enumerate().flat_map(move |(v, p)| {
                std::array::from_fn::<f32, 3, _>(|a| {
                    let moved = (0..planted).map(|k| {
                        let weight = wave(frame * (k + 1) + 11 * k).max(0.0);
                        weight * 0.004 * wave((7 * v + 3 * a + 1) * (k * k + 3))
                    });
                    ((f64::from(p[a]) + moved.sum::<f64>()) * 1e3) as f32
                })
            })
        });
        VertexArray { vertices: template.positions.len(), positions: positions.collect() }
    }

    const OPTIONS: VertexBankOptions =
        VertexBankOptions { rate_hz: 30.0, tolerance_m: 1e-5, most_shapes: 2048 };

    #[test]
    fn as_many_shapes_are_found_as_were_planted_and_the_error_is_that_of_the_pose() {
        let (template, planted) = (template(), 5);
        let sequence = sequence(&template, 60, planted);
        let bank = VertexBank::of("x", &template, &sequence, &OPTIONS).unwrap();
        assert_eq!(bank.avatar.shape_names.len(), planted);
        assert!(bank.largest_error_m <= 1e-5, "{}", bank.largest_error_m);
        assert!(bank.weights.weights.iter().all(|w| w.abs() <= 1.0 + 1e-12));
        let few = VertexBankOptions { most_shapes: 2, ..OPTIONS };
        let rough = VertexBank::of("x", &template, &sequence, &few).unwrap();
        assert!(rough.avatar.shape_names.len() == 2 && rough.largest_error_m > 1e-4);
        for bank in [bank, rough] {
            let mut largest = 0.0f64;
            let width = 3 * template.positions.len();
            for (frame, row) in sequence.positions.chunks_exact(width).enumerate() {
                let posed = bank.avatar.meshes[0].posed(bank.weights.row(frame));
                for (p, x) in posed.iter().zip(row.as_chunks::<3>().0) {
                    let square: f64 =
                        (0..3).map(|a| (f64::from(p[a]) - 1e-3 * f64::from(x[a])).powi(2)).sum();
                    largest = largest.max(square.sqrt());
                }
            }
            assert!((largest - bank.largest_error_m).abs() < 1e-6, "{largest}");
        }
    }

    #[test]
    fn what_cannot_be_compressed_is_refused() {
        let template = template();
        let whole = sequence(&template, 8, 2);
        let refused = |array: &VertexArray| {
            VertexBank::of("x", &template, array, &OPTIONS).unwrap_err().to_string()
        };
        let one = VertexArray { positions: whole.positions[..120].to_vec(), ..whole.clone() };
        assert_eq!(refused(&one), "frames: 1; give a sequence of two or more");
        let other = VertexArray { vertices: 20, ..whole.clone() };
        assert!(refused(&other).starts_with("vertices: 20 in each frame, the template has 40; "));
        let mut lost = whole.clone();
        lost.positions[123] = f32::NAN;
        assert!(refused(&lost).starts_with("frame 1, vertex 1: NaN; "));
        lost.positions[123] = 3000.0;
        assert!(refused(&lost).starts_with("frame 1, vertex 1: 29"), "{}", refused(&lost));
        let still = template.positions.iter().flatten().map(|x| x * 1e3);
        let still: Vec<f32> = still.collect::<Vec<_>>().repeat(3);
        let still = VertexArray { positions: still, ..whole };
        let said = VertexBank::of("x", &template, &still, &OPTIONS);
        // Rounding of a thousandth of a micrometre is no motion, and no more than one shape.
        assert!(said.is_err() || said.unwrap().largest_error_m < 1e-7);
    }
}
