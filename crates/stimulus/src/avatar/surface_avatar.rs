//! An avatar whose "shapes" are its markers: what the stage draws for `thin-shell-surface`.
//!
//! Shape LABEL.x is the whole head when that marker goes 1 cm along x and the others stay, so that
//! packs, worker and stage play the moved surface as they play a bank. The skin follows the thin
//! shell; parts that are no skin have none:
//!
//! | part | follows |
//! |---|---|
//! | brows, hair, lashes, shells of the eye, sockets, clothes | the skin's nearest vertex |
//! | teeth, gums, tongue | their own blendshapes at the weights of `thin-shell-only`, which are linear in the markers |
//! | eyeballs | rest: no marker tells the gaze |

use mimique_avatar::{Avatar, HEAD_POSE_SHAPES, Mesh, Part, SparseShape};
use mimique_geometry::{DVec3, Point};
use mimique_solver::{
    Fit, FitError, METRES_PER_WEIGHT, Method, MethodSpec, Operators, SurfaceResponse,
    surface_shape_names,
};

use crate::AvatarSkin;

/// Displacements below this at weight 1 are left out, metres: a two-thousandth of the marker's way.
pub(super) const LEAST_DELTA_M: f32 = 5e-6;

/// The avatar that a surface is shown with. `bank` are the operators of the avatar's own shapes at
/// the same markers; `response` is of `skin`.
///
/// # Errors
/// [`FitError`] where the bank's operators do not give weights.
pub fn surface_avatar(
    avatar: &Avatar,
    skin: &AvatarSkin,
    response: &SurfaceResponse,
    bank: &Operators,
) -> Result<Avatar, FitError> {
    let labels = &bank.parts().marker_labels;
    let p = labels.len();
    // Weights of the bank for each marker 1 cm along each axis.
    let fit = Fit::new(bank, &MethodSpec::new(Method::ThinShellOnly))?;
    let mut unit = vec![0.0; 3 * p];
    let mut bank_weights = Vec::with_capacity(3 * p);
    for k in 0..3 * p {
        unit[k] = METRES_PER_WEIGHT;
        bank_weights.push(fit.solve_frame(&unit)?.weights);
        unit[k] = 0.0;
    }
    let row = |welded: usize| &response.fields[welded * p..(welded + 1) * p];
    let mut first = 0;
    let meshes = (avatar.meshes.iter())
        .map(|mesh| {
            let count = mesh.positions.len();
            let shapes = match mesh.part {
                Part::Skin => {
                    let welded = &skin.welded_from_file[first..first + count];
                    first += count;
                    following(count, p, |v| row(welded[v] as usize))
                }
                Part::Teeth | Part::Tongue => {
                    bank_weights.iter().map(|weights| posed(mesh, weights)).collect()
                }
                Part::EyeLeft | Part::EyeRight => vec![SparseShape::default(); 3 * p],
                Part::EyeOverlay | Part::Lashes | Part::Hair | Part::Socket | Part::Other => {
                    let nearest: Vec<usize> = (mesh.positions.iter())
                        .map(|p| skin.nearest(Point::from(p.map(f64::from))).map_or(0, |(v, _)| v))
                        .collect();
                    following(count, p, |v| row(nearest[v]))
                }
            };
            Mesh { shapes, ..mesh.clone() }
        })
        .collect();
    let mut eyeballs = avatar.eyeballs.clone();
    eyeballs.iter_mut().for_each(|eye| eye.looks.clear());
    let turns = avatar.shape_names.iter().any(|name| HEAD_POSE_SHAPES.contains(&name.as_str()));
    let surface = Avatar {
        meshes,
        eyeballs,
        shape_names: surface_shape_names(labels.iter().map(String::as_str)),
        ..avatar.clone()
    };
    Ok(if turns { surface.with_head_pose_shapes() } else { surface })
}

/// The 3P shapes of a mesh whose vertex v follows the markers by the P numbers of `row(v)`.
fn following<'r>(count: usize, p: usize, row: impl Fn(usize) -> &'r [f64]) -> Vec<SparseShape> {
    let mut out = vec![SparseShape::default(); 3 * p];
    for v in 0..count {
        for (m, part) in row(v).iter().enumerate() {
            let way = (part * METRES_PER_WEIGHT) as f32;
            if way.abs() >= LEAST_DELTA_M {
                for a in 0..3 {
                    let mut delta = [0.0; 3];
                    delta[a] = way;
                    out[3 * m + a].vertices.push(v as u32);
                    out[3 * m + a].deltas.push(delta);
                }
            }
        }
    }
    out
}

/// What the bank does to a mesh at some weights, as one shape.
pub(super) fn posed(mesh: &Mesh, weights: &[f64]) -> SparseShape {
    let mut dense = vec![DVec3::ZERO; mesh.positions.len()];
    for (shape, w) in mesh.shapes.iter().zip(weights) {
        for (&v, d) in shape.vertices.iter().zip(&shape.deltas) {
            dense[v as usize] += *w * DVec3::from_array(d.map(f64::from));
        }
    }
    let mut out = SparseShape::default();
    for (v, d) in dense.iter().enumerate() {
        let d = d.as_vec3().to_array();
        if d.iter().any(|x| x.abs() >= LEAST_DELTA_M) {
            out.vertices.push(v as u32);
            out.deltas.push(d);
        }
    }
    out
}
