//! A mesh by itself, without shapes: the template of a sequence of vertices.

use std::path::Path;

use mimique_avatar::Part;

use crate::read::unit_of;
use crate::settings::AvatarSettings;
use crate::{ReadError, glb, obj};

/// A mesh, its vertices in the file's order.
#[derive(Debug, Clone, PartialEq)]
pub struct Template {
    /// Positions in metres.
    pub positions: Vec<[f32; 3]>,
    /// Counter-clockwise triangles, indices into `positions`.
    pub triangles: Vec<[u32; 3]>,
    /// The unit that the file's numbers are taken to be in, by the size of the mesh, in metres (1, 0.01 or
    /// 0.001).
    pub unit_metres: f64,
}

/// Reads a mesh: an OBJ file (all its vertices), or the skin of a GLB or glTF file (its meshes one after
/// another, as `mimique solve --vertices` writes them).
///
/// # Errors
/// [`ReadError`]: the file is absent, damaged, or has no triangle.
pub fn read_template(path: &Path) -> Result<Template, ReadError> {
    let file = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let bytes =
        std::fs::read(path).map_err(|source| ReadError::Io { place: file.clone(), source })?;
    let is_obj = path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("obj"));
    let (mut positions, triangles) = match is_obj {
        true => obj::mesh_of(&file, &bytes)?,
        false => skin_of(&bytes, path.parent())?,
    };
    if triangles.is_empty() {
        return Err(ReadError::broken(&file, "no triangle", "export the mesh with its faces"));
    }
    let (mut low, mut high) = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
    for p in &positions {
        for a in 0..3 {
            (low[a], high[a]) = (low[a].min(p[a]), high[a].max(p[a]));
        }
    }
    let extent = (0..3).map(|a| f64::from(high[a] - low[a]).powi(2)).sum::<f64>().sqrt();
    if !(extent > 0.0 && extent.is_finite()) {
        let what = format!("{extent} units from one corner to the other");
        return Err(ReadError::broken(&file, what, "export the mesh again"));
    }
    let unit_metres = unit_of(extent);
    if unit_metres != 1.0 {
        positions.iter_mut().flatten().for_each(|x| *x = (f64::from(*x) * unit_metres) as f32);
    }
    Ok(Template { positions, triangles, unit_metres })
}

/// Positions in the file's unit, and triangles.
pub(crate) type Surface = (Vec<[f32; 3]>, Vec<[u32; 3]>);

/// The skin of a glTF file.
fn skin_of(bytes: &[u8], folder: Option<&Path>) -> Result<Surface, ReadError> {
    let (avatar, _) = glb::as_in_the_file(bytes, "template", folder, &AvatarSettings::default())?;
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    for mesh in avatar.meshes.into_iter().filter(|mesh| mesh.part == Part::Skin) {
        let first = positions.len() as u32;
        triangles.extend(mesh.triangles.into_iter().map(|t| t.map(|v| v + first)));
        positions.extend(mesh.positions);
    }
    Ok((positions, triangles))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn obj_and_glb_give_their_vertices_in_order() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("head.obj");
        std::fs::write(&file, "v 0 0 0\nv 100 0 0\nv 100 200 0\nv 0 200 9\nf 1 2 3 4\n").unwrap();
        let read = read_template(&file).unwrap();
        assert_eq!(read.unit_metres, 0.001);
        assert_eq!(read.triangles, [[0, 1, 2], [0, 2, 3]]);
        assert_eq!(read.positions[3], [0.0, 0.2, 0.009]);
        std::fs::write(&file, "v 0 0 0\n").unwrap();
        let error = read_template(&file).unwrap_err().to_string();
        assert_eq!(error, "head.obj: no triangle; export the mesh with its faces");

        let spec = mimique_actor::HeadSpec {
            density: mimique_actor::Density::COARSE,
            ..mimique_actor::HeadSpec::person(1)
        };
        let head = mimique_actor::build_head(&spec);
        let file = folder.path().join("head.glb");
        std::fs::write(&file, crate::write_glb(&head, &[], 60.0).unwrap()).unwrap();
        let read = read_template(&file).unwrap();
        let skin: Vec<[f32; 3]> = head
            .meshes
            .iter()
            .filter(|mesh| mesh.part == Part::Skin)
            .flat_map(|mesh| mesh.positions.clone())
            .collect();
        assert_eq!(read.positions, skin);
    }
}
