//! Parts driven by the face: teeth, tongue and accessories with postures of their own
//! (Kouadio 1997, 6.2).
//!
//! Every posture of a part is tied to one or more of the face's shapes, each shape to at most one
//! posture of the part: a surjective map from the shapes onto the postures. A posture's weight is
//! the sum of its shapes' weights, lambda_delta = sum over phi(delta) of lambda_xi, and the part is
//! its neutral plus the postures by their weights (eq. 6.1). Both are linear, so a posture is put
//! into each of its shapes once and for all: the avatar has then no shape more, the solver sees
//! nothing of it, and every renderer draws it.
//!
//! In an avatar's JSON: `"driven": {MESH: {POSTURE: [SHAPE, ...]}}`, where a posture is a shape of
//! the avatar that moves that mesh.

use std::collections::BTreeMap;

use mimique_avatar::{Avatar, SparseShape};

/// The postures of every driven part: mesh, posture, shapes of the face.
#[derive(Debug, Clone, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(transparent)]
pub struct Driven {
    /// By name of the mesh, then of the posture.
    pub parts: BTreeMap<String, BTreeMap<String, Vec<String>>>,
}

/// A map that does not fit the avatar.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{pointer}: {what}; {remedy}")]
pub struct DrivenError {
    /// JSON pointer below `driven`.
    pub pointer: String,
    /// What is wrong, with the value.
    pub what: String,
    /// What to do.
    pub remedy: &'static str,
}

impl Driven {
    /// Puts every posture into the shapes that drive it, and takes the postures out of the
    /// avatar's shapes where nothing else uses them.
    ///
    /// # Errors
    /// [`DrivenError`]; the avatar is then unchanged.
    pub fn apply(&self, avatar: &mut Avatar) -> Result<(), DrivenError> {
        let links = self.links(avatar)?;
        for (mesh, posture, shapes) in &links {
            let moved = std::mem::take(&mut avatar.meshes[*mesh].shapes[*posture]);
            for &shape in shapes {
                let target = &mut avatar.meshes[*mesh].shapes[shape];
                *target = sum(target, &moved);
            }
        }
        // A posture that still moves another mesh, or turns an eye, stays a shape.
        let mut gone: Vec<usize> = links.iter().map(|(_, posture, _)| *posture).collect();
        gone.sort_unstable();
        gone.dedup();
        gone.retain(|&k| {
            avatar.meshes.iter().all(|m| m.shapes[k].vertices.is_empty())
                && avatar.eyeballs.iter().flat_map(|e| &e.looks).all(|l| l.shape != k)
        });
        for &shape in gone.iter().rev() {
            avatar.shape_names.remove(shape);
            for mesh in &mut avatar.meshes {
                mesh.shapes.remove(shape);
            }
            for look in avatar.eyeballs.iter_mut().flat_map(|e| &mut e.looks) {
                look.shape -= usize::from(look.shape > shape);
            }
        }
        Ok(())
    }

    /// Indices of mesh, posture and shapes of every link, checked.
    fn links(&self, avatar: &Avatar) -> Result<Vec<(usize, usize, Vec<usize>)>, DrivenError> {
        let refuse = |parts: &[&str], what: String, remedy| {
            let pointer =
                parts.iter().map(|p| format!("/{}", p.replace('~', "~0").replace('/', "~1")));
            DrivenError { pointer: format!("/driven{}", pointer.collect::<String>()), what, remedy }
        };
        let postures: Vec<&String> = self.parts.values().flat_map(|p| p.keys()).collect();
        let mut links = Vec::new();
        for (name, part) in &self.parts {
            let Some(mesh) = avatar.meshes.iter().position(|m| m.name == *name) else {
                let names: Vec<&str> = avatar.meshes.iter().map(|m| m.name.as_str()).collect();
                let what = format!("no mesh {name:?}, the avatar has {}", names.join(", "));
                return Err(refuse(&[name], what, "name one of them"));
            };
            let mut drivers: BTreeMap<&str, &str> = BTreeMap::new();
            for (posture, shapes) in part {
                let at = [name.as_str(), posture.as_str()];
                let Some(moved) = avatar.shape_index(posture) else {
                    let what = format!("the avatar has no shape {posture:?}");
                    return Err(refuse(&at, what, "name a shape that moves the part"));
                };
                if avatar.meshes[mesh].shapes[moved].vertices.is_empty() {
                    let what = format!("{posture:?} does not move {name:?}");
                    return Err(refuse(&at, what, "name a shape that moves the part"));
                }
                if shapes.is_empty() {
                    let what = "no shape drives it".to_owned();
                    return Err(refuse(&at, what, "name the face's shapes that do"));
                }
                let mut found = Vec::with_capacity(shapes.len());
                for shape in shapes {
                    let Some(index) = avatar.shape_index(shape) else {
                        let what = format!("the avatar has no shape {shape:?}");
                        return Err(refuse(&at, what, "name a shape of the face"));
                    };
                    if postures.contains(&shape) {
                        let what = format!("{shape:?} is itself a posture");
                        return Err(refuse(&at, what, "name a shape of the face"));
                    }
                    if let Some(other) = drivers.insert(shape, posture) {
                        let what = format!("{shape:?} drives {other:?} too");
                        return Err(refuse(&at, what, "tie a shape to one posture of a part"));
                    }
                    found.push(index);
                }
                links.push((mesh, moved, found));
            }
        }
        Ok(links)
    }
}

/// Both displacements together.
fn sum(a: &SparseShape, b: &SparseShape) -> SparseShape {
    let mut all: BTreeMap<u32, [f32; 3]> = BTreeMap::new();
    for (&v, d) in a.vertices.iter().zip(&a.deltas).chain(b.vertices.iter().zip(&b.deltas)) {
        let at = all.entry(v).or_default();
        (0..3).for_each(|k| at[k] += d[k]);
    }
    SparseShape { vertices: all.keys().copied().collect(), deltas: all.into_values().collect() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use mimique_avatar::{Eyeball, Look, Mesh};

    /// Skin with smile, pucker, open; teeth with two postures, one of which the tongue has too.
    fn avatar() -> Avatar {
        let names = ["smile", "teethWide", "pucker", "open", "teethDown"];
        let shape = |moves: &[(u32, f32)]| SparseShape {
            vertices: moves.iter().map(|m| m.0).collect(),
            deltas: moves.iter().map(|m| [m.1, 0.0, 0.5 * m.1]).collect(),
        };
        let mesh = |name: &str, shapes: [&[(u32, f32)]; 5]| Mesh {
            name: name.to_owned(),
            positions: vec![[0.0; 3]; 4],
            shapes: shapes.map(shape).to_vec(),
            ..Mesh::default()
        };
        Avatar {
            name: "a".to_owned(),
            shape_names: names.map(str::to_owned).to_vec(),
            meshes: vec![
                mesh("skin", [&[(0, 1.0)], &[], &[(1, 2.0)], &[(2, 4.0)], &[]]),
                mesh("teeth", [&[(0, 0.25)], &[(0, 1.0), (1, 3.0)], &[], &[], &[(3, 7.0)]]),
                mesh("tongue", [&[], &[], &[], &[], &[(2, 5.0)]]),
            ],
            eyeballs: vec![Eyeball {
                mesh: 0,
                centre: [0.0; 3],
                looks: vec![Look { shape: 3, axis: [1.0, 0.0, 0.0], radians: 0.1 }],
            }],
            ..Avatar::default()
        }
    }

    fn driven(text: &str) -> Driven {
        serde_json::from_str(text).unwrap()
    }

    #[test]
    fn postures_follow_the_sum_of_their_shapes() {
        let before = avatar();
        let mut after = avatar();
        driven(r#"{"teeth": {"teethWide": ["smile", "pucker"], "teethDown": ["open"]}}"#)
            .apply(&mut after)
            .unwrap();
        // teethDown still moves the tongue, which nothing drives.
        assert_eq!(after.shape_names, ["smile", "pucker", "open", "teethDown"]);
        assert_eq!(after.eyeballs[0].looks[0].shape, 2);
        for [smile, pucker, open] in [[1.0, 0.0, 0.0], [0.3, 0.5, 0.2], [0.0, 0.0, 1.0]] {
            // Equation 6.1 with the sums of 6.2, drawn the long way.
            let long = [smile, smile + pucker, pucker, open, open];
            let want = before.meshes[1].posed(&long);
            let got = after.meshes[1].posed(&[smile, pucker, open, 0.0]);
            for (g, w) in got.iter().flatten().zip(want.iter().flatten()) {
                assert!((g - w).abs() < 1e-6, "{got:?} {want:?}");
            }
            let skin = before.meshes[0].posed(&long);
            assert_eq!(after.meshes[0].posed(&[smile, pucker, open, 0.0]), skin);
        }
        assert_eq!(after.meshes[2].posed(&[0.0, 0.0, 1.0, 0.0]), before.meshes[2].positions);
    }

    #[test]
    fn what_does_not_fit_is_named_and_changes_nothing() {
        for (text, message) in [
            (r#"{"hat": {}}"#, "/driven/hat: no mesh \"hat\", the avatar has skin, teeth, tongue"),
            (r#"{"teeth": {"up": ["open"]}}"#, "/driven/teeth/up: the avatar has no shape \"up\""),
            (
                r#"{"tongue": {"teethWide": ["open"]}}"#,
                "/driven/tongue/teethWide: \"teethWide\" does not move \"tongue\"",
            ),
            (r#"{"teeth": {"teethWide": []}}"#, "/driven/teeth/teethWide: no shape drives it"),
            (
                r#"{"teeth": {"teethWide": ["shut"]}}"#,
                "/driven/teeth/teethWide: the avatar has no shape \"shut\"",
            ),
            (
                r#"{"teeth": {"teethDown": ["teethWide"], "teethWide": ["open"]}}"#,
                "/driven/teeth/teethDown: \"teethWide\" is itself a posture",
            ),
            (
                r#"{"teeth": {"teethWide": ["open"], "teethDown": ["open"]}}"#,
                "/driven/teeth/teethWide: \"open\" drives \"teethDown\" too",
            ),
        ] {
            let mut tried = avatar();
            let error = driven(text).apply(&mut tried).unwrap_err().to_string();
            assert_eq!(tried, avatar());
            assert!(error.starts_with(message), "{error}");
        }
    }
}
