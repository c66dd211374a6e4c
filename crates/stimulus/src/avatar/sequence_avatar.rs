//! An avatar whose shapes are the principal components of a sequence of its own skin, so that what was submitted as
//! vertices is drawn on the same head, by the same stage.
//!
//! | part | follows |
//! |---|---|
//! | skin | the components |
//! | brows, hair, lashes, shells of the eye, sockets, clothes | the skin's nearest vertex |
//! | teeth, gums, tongue | their own blendshapes at the weights that come nearest to each component on the skin |
//! | eyeballs | rest: no skin tells the gaze |
//!
//! The nearest weights are least squares, min |B w - d|² + e |w|², linear in the component d, so that they add up as
//! the components do; e keeps shapes apart that move the same skin.

use faer::linalg::solvers::Solve as _;
use faer::{Mat, Side};
use mimique_avatar::{Avatar, Mesh, Part, SparseShape};
use mimique_geometry::Point;

use super::skin::AvatarSkin;
use super::surface_avatar::{LEAST_DELTA_M, posed};
use super::vertex_bank::VertexBank;

/// The share of the mean squared shape that holds weights back: shapes that move the same skin share it.
const HELD_BACK: f64 = 1e-4;

/// Why a head cannot show a sequence of its skin.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum NoSequenceAvatar {
    /// The sequence is of another mesh.
    #[error(
        "{found} vertices; the skin of the head has {wanted}: give a sequence of the same head"
    )]
    Vertices {
        /// Of the sequence.
        found: usize,
        /// Of the head.
        wanted: usize,
    },
    /// The head has no skin, or a damaged one.
    #[error("the head: {0}")]
    Skin(String),
}

/// The head with the components of a sequence as its shapes.
///
/// # Errors
/// [`NoSequenceAvatar`]: the sequence is of another mesh.
pub fn sequence_avatar(head: &Avatar, bank: &VertexBank) -> Result<Avatar, NoSequenceAvatar> {
    let skin = AvatarSkin::of(head).map_err(|error| NoSequenceAvatar::Skin(error.to_string()))?;
    let wanted = skin.welded_from_file.len();
    let components = bank.avatar.meshes.first();
    let found = components.map_or(0, |mesh| mesh.positions.len());
    if found != wanted {
        return Err(NoSequenceAvatar::Vertices { found, wanted });
    }
    let dense: Vec<Vec<[f32; 3]>> = components
        .map_or(&[][..], |mesh| &mesh.shapes)
        .iter()
        .map(|shape| dense(shape, found))
        .collect();
    let welded: Vec<Vec<[f32; 3]>> = dense.iter().map(|moved| welded(&skin, moved)).collect();
    let weights = nearest_weights(&skin, &welded);
    let mut first = 0;
    let meshes = (head.meshes.iter())
        .map(|mesh| {
            let count = mesh.positions.len();
            let shapes = match mesh.part {
                Part::Skin => {
                    let own = first..first + count;
                    first += count;
                    dense.iter().map(|all| SparseShape::from_dense(&all[own.clone()])).collect()
                }
                Part::Teeth | Part::Tongue => weights.iter().map(|w| posed(mesh, w)).collect(),
                Part::EyeLeft | Part::EyeRight => vec![SparseShape::default(); dense.len()],
                Part::EyeOverlay | Part::Lashes | Part::Hair | Part::Socket | Part::Other => {
                    let nearest: Vec<usize> = (mesh.positions.iter())
                        .map(|p| skin.nearest(Point::from(p.map(f64::from))).map_or(0, |(v, _)| v))
                        .collect();
                    welded.iter().map(|moved| following(&nearest, moved)).collect()
                }
            };
            Mesh { shapes, ..mesh.clone() }
        })
        .collect();
    let mut eyeballs = head.eyeballs.clone();
    eyeballs.iter_mut().for_each(|eye| eye.looks.clear());
    Ok(Avatar {
        meshes,
        eyeballs,
        shape_names: bank.avatar.shape_names.clone(),
        expressions: Vec::new(),
        ..head.clone()
    })
}

fn dense(shape: &SparseShape, vertices: usize) -> Vec<[f32; 3]> {
    let mut out = vec![[0.0; 3]; vertices];
    for (vertex, delta) in shape.vertices.iter().zip(&shape.deltas) {
        out[*vertex as usize] = *delta;
    }
    out
}

/// Displacements of the file's vertices as those of the welded skin.
fn welded(skin: &AvatarSkin, moved: &[[f32; 3]]) -> Vec<[f32; 3]> {
    let mut out = vec![[0.0; 3]; skin.mesh.positions.len()];
    for (own, delta) in skin.welded_from_file.iter().zip(moved) {
        out[*own as usize] = *delta;
    }
    out
}

/// A mesh whose vertices go where their nearest vertex of the skin goes.
fn following(nearest: &[usize], moved: &[[f32; 3]]) -> SparseShape {
    let ways = nearest.iter().map(|vertex| moved[*vertex]);
    let large: Vec<[f32; 3]> = ways
        .map(|d| if d.iter().any(|x| x.abs() >= LEAST_DELTA_M) { d } else { [0.0; 3] })
        .collect();
    SparseShape::from_dense(&large)
}

/// The weights of the head's own shapes that come nearest to each displacement of its welded skin.
fn nearest_weights(skin: &AvatarSkin, moved: &[Vec<[f32; 3]>]) -> Vec<Vec<f64>> {
    let (shapes, width) = (&skin.mesh.shapes, 3 * skin.mesh.positions.len());
    let mut bank = Mat::<f64>::zeros(width, shapes.len());
    for (column, shape) in shapes.iter().enumerate() {
        for (vertex, delta) in shape.vertices.iter().zip(&shape.deltas) {
            for (axis, way) in delta.to_array().into_iter().enumerate() {
                bank[(3 * *vertex as usize + axis, column)] = way;
            }
        }
    }
    let target = Mat::<f64>::from_fn(width, moved.len(), |row, column| {
        f64::from(moved[column][row / 3][row % 3])
    });
    let mut normal = bank.transpose() * &bank;
    let trace: f64 = (0..shapes.len()).map(|n| normal[(n, n)]).sum();
    let held = HELD_BACK * trace / shapes.len().max(1) as f64;
    (0..shapes.len()).for_each(|n| normal[(n, n)] += held);
    let right = bank.transpose() * &target;
    // Only shapes that move no skin at all leave it singular: then nothing of the bank follows.
    let Ok(factor) = normal.llt(Side::Lower) else {
        return vec![vec![0.0; shapes.len()]; moved.len()];
    };
    let found = factor.solve(&right);
    let column = |k: usize| (0..shapes.len()).map(|n| found[(n, k)]).collect();
    (0..moved.len()).map(column).collect()
}

#[cfg(test)]
mod tests {
    use mimique_actor::{HeadSpec, build_head};
    use mimique_avatar_files::Template;
    use mimique_mocap::VertexArray;

    use super::*;
    use crate::VertexBankOptions;

    /// The skin of a head at weights of its own shapes, frame by frame.
    fn sequence(head: &Avatar, frames: &[Vec<f64>]) -> (Template, VertexArray) {
        let skins = || head.meshes.iter().filter(|mesh| mesh.part == Part::Skin);
        let positions: Vec<[f32; 3]> = skins().flat_map(|mesh| mesh.positions.clone()).collect();
        let posed: Vec<f32> = (frames.iter())
            .flat_map(|weights| skins().flat_map(|mesh| mesh.posed(weights)))
            .flatten()
            .collect();
        let vertices = positions.len();
        let triangles = vec![[0, 1, 2]];
        let template = Template { positions, triangles, unit_metres: 1.0 };
        (template, VertexArray { vertices, positions: posed })
    }

    #[test]
    fn a_sequence_of_the_heads_own_shapes_is_shown_as_the_shapes_show_it_teeth_and_all() {
        let head = build_head(&HeadSpec::person(3));
        let place = |name: &str| head.shape_names.iter().position(|own| own == name).unwrap();
        let (jaw, smile) = (place("jawOpen"), place("mouthSmileLeft"));
        let frames: Vec<Vec<f64>> = (0..12)
            .map(|frame| {
                let mut weights = vec![0.0; head.shape_names.len()];
                weights[jaw] = f64::from(frame) / 12.0;
                weights[smile] = (f64::from(frame) * 0.7).sin().abs() * 0.6;
                weights
            })
            .collect();
        let (template, array) = sequence(&head, &frames);
        let options = VertexBankOptions { rate_hz: 60.0, tolerance_m: 5e-5, most_shapes: 64 };
        let bank = VertexBank::of("head", &template, &array, &options).unwrap();
        let shown = sequence_avatar(&head, &bank).unwrap();
        let width = bank.weights.shape_names.len();
        let mut teeth_moved = 0.0f32;
        for (frame, weights) in frames.iter().enumerate() {
            let own = &bank.weights.weights[frame * width..(frame + 1) * width];
            for (mesh, as_sequence) in head.meshes.iter().zip(&shown.meshes) {
                let most = match mesh.part {
                    Part::Skin => 1e-4,
                    Part::Teeth | Part::Tongue => 1e-3,
                    _ => continue,
                };
                let (wanted, got) = (mesh.posed(weights), as_sequence.posed(own));
                for (vertex, (a, b)) in wanted.iter().zip(&got).enumerate() {
                    let off = (0..3).map(|k| (a[k] - b[k]).powi(2)).sum::<f32>().sqrt();
                    assert!(off < most, "{:?} frame {frame} vertex {vertex}: {off}", mesh.part);
                    if mesh.part == Part::Teeth {
                        let rest = mesh.positions[vertex];
                        let way = (0..3).map(|k| (b[k] - rest[k]).powi(2)).sum::<f32>().sqrt();
                        teeth_moved = teeth_moved.max(way);
                    }
                }
            }
        }
        assert!(teeth_moved > 5e-3, "the lower teeth follow the jaw: {teeth_moved}");
    }

    #[test]
    fn a_sequence_of_another_mesh_is_refused() {
        let (head, other) = (build_head(&HeadSpec::person(3)), build_head(&HeadSpec::person(4)));
        let mut weights = vec![0.0; other.shape_names.len()];
        weights[0] = 1.0;
        let (mut template, mut array) = sequence(&other, &[weights.clone(), weights]);
        template.positions.pop();
        array.vertices -= 1;
        array.positions.truncate(6 * array.vertices);
        let options = VertexBankOptions { rate_hz: 60.0, tolerance_m: 5e-5, most_shapes: 64 };
        let bank = VertexBank::of("head", &template, &array, &options).unwrap();
        let refused = sequence_avatar(&head, &bank).unwrap_err();
        assert!(matches!(refused, NoSequenceAvatar::Vertices { .. }), "{refused}");
    }
}
