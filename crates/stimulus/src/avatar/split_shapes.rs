//! Symmetric shapes of an avatar cut into their left and right halves (Kouadio 4.5): the artist
//! models one smile, the bank has two.

use mimique_avatar::{Avatar, Mesh, Part, SparseShape};
use mimique_geometry::Point;
use mimique_solver::{FALL_OFF_M, MirrorError, MirrorPlane, split_delta};

/// Why a shape cannot be split.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SplitError {
    /// There is no such shape.
    #[error("split: no shape {shape:?}; use names of {known}")]
    NoShape {
        /// The name.
        shape: String,
        /// The avatar's shapes.
        known: String,
    },
    /// A half's name is taken.
    #[error("split: {shape} would give {half}, which the avatar has already; leave it whole")]
    NameTaken {
        /// The shape.
        shape: String,
        /// The half.
        half: String,
    },
    /// A shape turns an eyeball, which cannot be cut in two.
    #[error("split: {0} turns an eyeball; leave it whole")]
    TurnsEye(String),
    /// The face has no middle plane.
    #[error("split: {0}")]
    Mirror(#[from] MirrorError),
}

/// The avatar with each of `shapes` replaced by `NAME_L` and `NAME_R` (the person's left and right),
/// in its place in the order; their sum is the shape bit for bit.
///
/// The middle plane is that of the skin; across it a shape fades over 8 mm to either side.
///
/// # Errors
/// [`SplitError`]: a name that is not there or would stand twice, an eyeball's shape, a face that is
/// not symmetric.
pub fn split_shapes(avatar: &Avatar, shapes: &[String]) -> Result<Avatar, SplitError> {
    let mut splits = vec![false; avatar.shape_names.len()];
    for shape in shapes {
        let Some(k) = avatar.shape_index(shape) else {
            let (shape, known) = (shape.clone(), avatar.shape_names.join(", "));
            return Err(SplitError::NoShape { shape, known });
        };
        if avatar.eyeballs.iter().flat_map(|e| &e.looks).any(|look| look.shape == k) {
            return Err(SplitError::TurnsEye(shape.clone()));
        }
        for half in halves(shape) {
            if avatar.shape_index(&half).is_some() {
                return Err(SplitError::NameTaken { shape: shape.clone(), half });
            }
        }
        splits[k] = true;
    }
    if !splits.contains(&true) {
        return Ok(avatar.clone());
    }
    let skin = avatar.meshes.iter().filter(|m| m.part == Part::Skin);
    let positions: Vec<Point> =
        skin.flat_map(|m| &m.positions).map(|p| Point::from(p.map(f64::from))).collect();
    let plane = MirrorPlane::find(&positions)?;

    let mut out = avatar.clone();
    out.shape_names = (avatar.shape_names.iter().zip(&splits))
        .flat_map(|(name, split)| if *split { halves(name).to_vec() } else { vec![name.clone()] })
        .collect();
    let new_index = |k: usize| k + splits[..k].iter().filter(|s| **s).count();
    for look in out.eyeballs.iter_mut().flat_map(|e| &mut e.looks) {
        look.shape = new_index(look.shape);
    }
    for mesh in &mut out.meshes {
        let whole = std::mem::take(&mut mesh.shapes);
        for (shape, split) in whole.into_iter().zip(&splits) {
            if *split {
                let both = split_shape(mesh, &shape, &plane);
                mesh.shapes.extend(both);
            } else {
                mesh.shapes.push(shape);
            }
        }
    }
    Ok(out)
}

fn halves(name: &str) -> [String; 2] {
    [format!("{name}_L"), format!("{name}_R")]
}

fn split_shape(mesh: &Mesh, shape: &SparseShape, plane: &MirrorPlane) -> [SparseShape; 2] {
    let mut both = [SparseShape::default(), SparseShape::default()];
    for (&v, &delta) in shape.vertices.iter().zip(&shape.deltas) {
        let share =
            plane.left_share(Point::from(mesh.positions[v as usize].map(f64::from)), FALL_OFF_M);
        for (half, part) in both.iter_mut().zip(split_delta(delta, share)) {
            if part != [0.0; 3] {
                half.vertices.push(v);
                half.deltas.push(part);
            }
        }
    }
    both
}
