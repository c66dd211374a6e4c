//! What each mesh is of a face, told from its names; and how eyeballs turn.

use crate::ReadError;
use crate::part_words::{NamedPart, Side, named_part};
use crate::settings::{AvatarSettings, fits};
use mimique_avatar::{Avatar, Eyeball, LOOK_DEGREES, Look, Part, arkit_shapes};

/// What is known of a mesh before its part is.
pub(crate) struct PartName<'a> {
    /// Names of node, mesh and material, the most telling first.
    pub names: [&'a str; 3],
    /// Its vertices, metres or not.
    pub positions: &'a [[f32; 3]],
    /// How many shapes move it.
    pub shapes: usize,
    /// How many vertex displacements its shapes have.
    pub moved: usize,
}

/// The part of each mesh, nothing for one that `settings` leave out. A mesh without a telling name
/// is skin where more shapes move it than any mesh called skin (a face called `Body`), unless
/// `settings` name the skin; where none is called skin, the one with the most displacements is.
pub(crate) fn assign_parts(
    meshes: &[PartName<'_>],
    settings: &AvatarSettings,
) -> Result<Vec<Option<Part>>, ReadError> {
    let fitting = |pattern: &str, m: &PartName<'_>| m.names.iter().any(|n| fits(pattern, n));
    for (pattern, _) in &settings.parts {
        if !meshes.iter().any(|m| fitting(pattern, m)) {
            let mut names: Vec<&str> = meshes.iter().flat_map(|m| m.names).collect();
            names.retain(|name| !name.is_empty());
            names.sort_unstable();
            names.dedup();
            return Err(ReadError::broken(
                format!("avatar.json: /parts/{pattern}"),
                "no mesh, node, group or material of that name",
                format!("the file has {}", names.join(", ")),
            ));
        }
    }
    // What the user says wins over what names say; of patterns, the one with the most letters.
    let letters = |pattern: &str| pattern.len() - pattern.matches('*').count();
    let by_user = |m: &PartName<'_>| {
        let fit = settings.parts.iter().filter(|(pattern, _)| fitting(pattern, m));
        fit.max_by_key(|(pattern, _)| letters(pattern)).map(|(_, part)| *part)
    };
    let found: Vec<Option<Option<Part>>> = meshes
        .iter()
        .map(|m| {
            let named = || m.names.iter().find_map(|name| part_of_name(name, m.positions));
            by_user(m).or_else(|| named().map(Some))
        })
        .collect();
    let called_skin = |i: &usize| found[*i] == Some(Some(Part::Skin));
    let most_of_skin = (0..meshes.len()).filter(called_skin).map(|i| meshes[i].shapes).max();
    let skin_said = meshes.iter().any(|m| by_user(m) == Some(Some(Part::Skin)));
    let more = |i: usize| most_of_skin.is_none_or(|most| !skin_said && meshes[i].shapes > most);
    let skin = (0..meshes.len())
        .filter(|&i| found[i].is_none() && more(i))
        .max_by_key(|&i| (meshes[i].moved, std::cmp::Reverse(i)));
    let rest = |i| if skin == Some(i) { Part::Skin } else { Part::Other };
    Ok((0..meshes.len()).map(|i| found[i].unwrap_or(Some(rest(i)))).collect())
}

/// What a name says; an eye whose name says no side is of the side on which its vertices lie (+X is
/// the person's left).
fn part_of_name(name: &str, positions: &[[f32; 3]]) -> Option<Part> {
    let on_the_left = || positions.iter().map(|p| f64::from(p[0])).sum::<f64>() >= 0.0;
    Some(match named_part(name)? {
        NamedPart::Part(part) => part,
        NamedPart::Eye(Some(Side::Left)) => Part::EyeLeft,
        NamedPart::Eye(Some(Side::Right)) => Part::EyeRight,
        NamedPart::Eye(None) if on_the_left() => Part::EyeLeft,
        NamedPart::Eye(None) => Part::EyeRight,
    })
}

/// The eyeballs of an avatar: each mesh that is an eye, with its centre, and the looks that turn it.
///
/// Looks are those shapes whose name means ARKit's `eyeLookUp`, `Down`, `In` or `Out` of that eye
/// ([`mimique_avatar::arkit_shapes`]); none where such a shape already moves the eye's vertices.
pub fn find_eyeballs(avatar: &Avatar) -> Vec<Eyeball> {
    let mut out = Vec::new();
    for (index, mesh) in avatar.meshes.iter().enumerate() {
        let left = match mesh.part {
            Part::EyeLeft => true,
            Part::EyeRight => false,
            _ => continue,
        };
        let looks: Vec<(usize, Look)> = avatar
            .shape_names
            .iter()
            .enumerate()
            .filter_map(|(shape, name)| Some((shape, look_of_name(name, shape, left)?)))
            .collect();
        let baked = looks.iter().any(|(shape, _)| !mesh.shapes[*shape].vertices.is_empty());
        if let Some(centre) = sphere_centre(&mesh.positions) {
            out.push(Eyeball {
                mesh: index,
                centre,
                looks: if baked { vec![] } else { looks.into_iter().map(|(_, l)| l).collect() },
            });
        }
    }
    out
}

/// The rotation that an eye-look shape's name stands for, if it is one of this side.
fn look_of_name(name: &str, shape: usize, left: bool) -> Option<Look> {
    let side = if left { "Left" } else { "Right" };
    let (word, degrees) = arkit_shapes(name).into_iter().find_map(|meant| {
        let feature = meant.strip_suffix(side)?;
        LOOK_DEGREES.into_iter().find(|(word, _)| *word == feature)
    })?;
    // Out is away from the nose: towards +X for the left eye, which is a turn about +Y.
    let outward = if left { 1.0 } else { -1.0 };
    let axis = match word {
        "eyeLookUp" => [-1.0, 0.0, 0.0],
        "eyeLookDown" => [1.0, 0.0, 0.0],
        "eyeLookOut" => [0.0, outward, 0.0],
        _ => [0.0, -outward, 0.0],
    };
    Some(Look { shape, axis, radians: (degrees as f32).to_radians() })
}

/// Centre of the sphere that fits the points best (least squares of |p|^2 = 2 c.p + k); the middle
/// of the bounding box where the points lie in a plane. `None` without points.
fn sphere_centre(points: &[[f32; 3]]) -> Option<[f32; 3]> {
    let n = points.len() as f64;
    let (mut low, mut high) = (*points.first()?, *points.first()?);
    let mut mean = [0f64; 3];
    for p in points {
        for a in 0..3 {
            low[a] = low[a].min(p[a]);
            high[a] = high[a].max(p[a]);
            mean[a] += f64::from(p[a]) / n;
        }
    }
    let middle: [f32; 3] = std::array::from_fn(|a| 0.5 * (low[a] + high[a]));
    // Centred points q: covariance C c' = r / 2 with r = mean of |q|^2 q.
    let mut cov = [[0f64; 3]; 3];
    let mut rhs = [0f64; 3];
    for p in points {
        let q: [f64; 3] = std::array::from_fn(|a| f64::from(p[a]) - mean[a]);
        let square = q.iter().map(|x| x * x).sum::<f64>();
        for a in 0..3 {
            rhs[a] += 0.5 * square * q[a];
            for b in 0..3 {
                cov[a][b] += q[a] * q[b];
            }
        }
    }
    let det3 = |m: &[[f64; 3]; 3]| {
        m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1])
            - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0])
            + m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0])
    };
    let det = det3(&cov);
    let trace = cov[0][0] + cov[1][1] + cov[2][2];
    // Below one part in a million of a round cloud's determinant the points lie in a plane.
    if det <= 1e-6 * (trace / 3.0).powi(3) {
        return Some(middle);
    }
    let centre: [f32; 3] = std::array::from_fn(|a| {
        let mut column = cov;
        for row in 0..3 {
            column[row][a] = rhs[row];
        }
        (mean[a] + det3(&column) / det) as f32
    });
    let inside = (0..3).all(|a| (low[a]..=high[a]).contains(&centre[a]));
    Some(if inside { centre } else { middle })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_eye_without_a_side_in_its_name_is_where_it_lies() {
        let at = |name, x| part_of_name(name, &[[x, 0.0, 0.0]]);
        assert_eq!(at("Eyeball", 0.03), Some(Part::EyeLeft));
        assert_eq!(at("Eyeball", -0.03), Some(Part::EyeRight));
        assert_eq!(at("Eye_R", 0.03), Some(Part::EyeRight));
        assert_eq!(at("Shirt", 0.03), None);
    }

    #[test]
    fn a_face_with_another_name_is_skin_beside_a_mesh_called_so() {
        let named = |name: &'static str, material: &'static str, shapes, moved| PartName {
            names: [name, "", material],
            positions: &[],
            shapes,
            moved,
        };
        let parts = |meshes: &[PartName<'_>]| {
            assign_parts(meshes, &AvatarSettings::default())
                .unwrap()
                .into_iter()
                .flatten()
                .collect()
        };
        let meshes = [
            named("Head_Scalp", "", 4, 900),
            named("Body", "", 52, 400),
            named("Shirt", "Solid", 3, 2000),
        ];
        let found: Vec<Part> = parts(&meshes);
        assert_eq!(found, [Part::Skin, Part::Skin, Part::Other]);
        // A beard or a mouth that every shape of the face moves too is none.
        let meshes = [named("Head", "", 52, 900), named("Whiskers", "", 52, 2000)];
        let found: Vec<Part> = parts(&meshes);
        assert_eq!(found, [Part::Skin, Part::Other]);
    }

    #[test]
    fn without_a_name_the_most_moved_mesh_is_the_skin() {
        let named = |name: &'static str, moved| PartName {
            names: [name, "", ""],
            positions: &[],
            shapes: moved,
            moved,
        };
        let meshes = [named("a", 3), named("b", 90), named("Teeth", 200)];
        let parts = assign_parts(&meshes, &AvatarSettings::default()).unwrap();
        assert_eq!(parts, [Part::Other, Part::Skin, Part::Teeth].map(Some));
        let parts = vec![("a".to_owned(), Some(Part::Skin)), ("T*h".to_owned(), None)];
        let settings = AvatarSettings { parts, ..AvatarSettings::default() };
        let parts = assign_parts(&meshes, &settings).unwrap();
        assert_eq!(parts, [Some(Part::Skin), Some(Part::Other), None]);
        let parts = vec![("Nose".to_owned(), None)];
        let settings = AvatarSettings { parts, ..AvatarSettings::default() };
        let error = assign_parts(&meshes, &settings).unwrap_err().to_string();
        assert!(error.contains("/parts/Nose: no mesh") && error.contains("a, b"), "{error}");
    }

    #[test]
    fn looks_turn_the_gaze_where_their_name_says() {
        for (name, left, toward) in [
            ("eyeLookUp_L", true, [0.0, 1.0]),
            ("eyeLookDownLeft", true, [0.0, -1.0]),
            ("eyeLookOut_L", true, [1.0, 0.0]),
            ("eyeLookIn_L", true, [-1.0, 0.0]),
            ("eyeLookOutRight", false, [-1.0, 0.0]),
            ("eyeLookIn_R", false, [1.0, 0.0]),
        ] {
            let look = look_of_name(name, 0, left).expect(name);
            // axis x (0, 0, 1) is where a small turn takes the gaze.
            let [x, y, _] = look.axis;
            let moved = [y, -x];
            assert!(moved[0] * toward[0] + moved[1] * toward[1] > 0.99, "{name}: {moved:?}");
            assert!(look_of_name(name, 0, !left).is_none());
        }
        assert!(look_of_name("eyeBlink_L", 0, true).is_none());
        assert!(look_of_name("jawOpen", 0, true).is_none());
    }

    #[test]
    fn sphere_centre_is_right_from_a_part_of_the_sphere() {
        let mut points = Vec::new();
        for i in 0..20 {
            for j in 0..12 {
                let (a, b) = (i as f64 * 0.31, 0.2 + j as f64 * 0.15);
                points.push(
                    [
                        0.03 + 0.012 * b.sin() * a.cos(),
                        0.02 + 0.012 * b.sin() * a.sin(),
                        0.08 + 0.012 * b.cos(),
                    ]
                    .map(|x: f64| x as f32),
                );
            }
        }
        let c = sphere_centre(&points).unwrap();
        for (found, truth) in c.iter().zip([0.03, 0.02, 0.08]) {
            assert!((found - truth).abs() < 1e-5, "{c:?}");
        }
        assert_eq!(sphere_centre(&[]), None);
        assert_eq!(sphere_centre(&[[1.0, 2.0, 3.0]]), Some([1.0, 2.0, 3.0]));
    }
}
