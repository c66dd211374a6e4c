//! Lids that follow the gaze vertically, where an avatar's own eye-look shapes leave them where they are.

use mimique_avatar::{Avatar, SparseShape, arkit_shapes};

/// A shape moves lids that moves a vertex beside the eyeballs by more, metres.
const MOVES_M: f32 = 1e-3;

/// Which shape of an eye follows a look, and how much of it at the look's weight 1.
///
/// The upper lid goes with the eye nearly degree for degree (Becker and Fuchs, Lid-eye co-ordination during vertical
/// gaze changes in man and monkey, 1988). A look downwards is 30 degrees and a lid that shuts travels some 50; a look
/// upwards takes the lid about as high as wide eyes.
const FOLLOWS: [(&str, &str, f32); 2] =
    [("eyeLookDown", "eyeBlink", 0.6), ("eyeLookUp", "eyeWide", 1.0)];

/// Adds what lids do to vertical looks of eyes that turn and whose lids stay. Answers what was done, a sentence
/// each.
pub(crate) fn let_lids_follow(avatar: &mut Avatar) -> Vec<String> {
    let mut notes = Vec::new();
    if avatar.eyeballs.iter().all(|eye| eye.looks.is_empty()) {
        return notes;
    }
    for side in ["Left", "Right"] {
        for (look, lid, share) in FOLLOWS {
            let shape = |feature: &str| {
                let wanted = format!("{feature}{side}");
                avatar.shape_names.iter().position(|name| arkit_shapes(name) == [wanted.as_str()])
            };
            let (Some(look), Some(lid)) = (shape(look), shape(lid)) else { continue };
            if moves(avatar, look) || !moves(avatar, lid) {
                continue;
            }
            for mesh in &mut avatar.meshes {
                if !mesh.part.is_eye() {
                    mesh.shapes[look] = with_share(&mesh.shapes[look], &mesh.shapes[lid], share);
                }
            }
            let names = &avatar.shape_names;
            notes.push(format!(
                "{} moves no lid: the lid follows the eye by {share} of {}",
                names[look], names[lid]
            ));
        }
    }
    notes
}

/// Whether a shape moves anything but eyeballs.
fn moves(avatar: &Avatar, shape: usize) -> bool {
    let far = |d: &[f32; 3]| d.iter().any(|x| x.abs() > MOVES_M);
    avatar
        .meshes
        .iter()
        .any(|mesh| !mesh.part.is_eye() && mesh.shapes[shape].deltas.iter().any(far))
}

/// `own` and a share of `other`.
fn with_share(own: &SparseShape, other: &SparseShape, share: f32) -> SparseShape {
    let mut sum: std::collections::BTreeMap<u32, [f32; 3]> =
        own.vertices.iter().copied().zip(own.deltas.iter().copied()).collect();
    for (&vertex, delta) in other.vertices.iter().zip(&other.deltas) {
        let at = sum.entry(vertex).or_default();
        (0..3).for_each(|a| at[a] += share * delta[a]);
    }
    let (vertices, deltas) = sum.into_iter().unzip();
    SparseShape { vertices, deltas }
}

#[cfg(test)]
mod tests {
    use mimique_avatar::{Eyeball, Look, Mesh, Part};

    use super::*;

    fn avatar(look: [f32; 3]) -> Avatar {
        let shape = |delta: [f32; 3]| SparseShape { vertices: vec![0], deltas: vec![delta] };
        let still = SparseShape::default();
        let skin = Mesh {
            part: Part::Skin,
            positions: vec![[0.0; 3]; 3],
            triangles: vec![[0, 1, 2]],
            shapes: vec![shape([0.0, -0.01, 0.0]), shape(look)],
            ..Mesh::default()
        };
        let eye = Mesh { part: Part::EyeLeft, shapes: vec![still.clone(), still], ..skin.clone() };
        let look = Look { shape: 1, axis: [1.0, 0.0, 0.0], radians: 0.5 };
        Avatar {
            shape_names: vec!["eyeBlink_L".to_owned(), "eyeLookDown_L".to_owned()],
            meshes: vec![skin, eye],
            eyeballs: vec![Eyeball { mesh: 1, centre: [0.0; 3], looks: vec![look] }],
            ..Avatar::default()
        }
    }

    #[test]
    fn a_lid_that_stays_follows_and_one_that_moves_is_left_alone() {
        let mut stays = avatar([0.0, -0.0005, 0.0]);
        let said = let_lids_follow(&mut stays);
        assert_eq!(
            said,
            ["eyeLookDown_L moves no lid: the lid follows the eye by 0.6 of eyeBlink_L"]
        );
        assert_eq!(stays.meshes[0].shapes[1].deltas, [[0.0, -0.0065, 0.0]]);
        assert!(stays.meshes[1].shapes[1].deltas.is_empty(), "the eyeball turns");
        let mut moves = avatar([0.0, -0.004, 0.0]);
        let before = moves.clone();
        assert!(let_lids_follow(&mut moves).is_empty());
        assert_eq!(moves, before);
        let mut blind = avatar([0.0; 3]);
        blind.eyeballs.clear();
        assert!(let_lids_follow(&mut blind).is_empty());
    }
}
