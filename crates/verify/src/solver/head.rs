//! The head of the stored answers: its operators, built once for each kind, held against the stored ones.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use mimique_solver::{
    Laplacian, LaplacianKind, MarkerSite, OperatorError, OperatorOptions, Operators, SkinMesh,
    apply_shell,
};
use mimique_stimulus::{AvatarSkin, MarkerMap};
use serde_json::{Value, json};

use super::{CONSTANTS, OPERATORS};
use crate::case::{Tolerance, number, rows};
use crate::document::{Document, Part, text};
use crate::{Case, VerifyError};

/// The avatar, welded when it is read.
const AVATAR: &str = "avatar_skin.glb";
/// Which marker belongs to which vertex.
const MAP: &str = "mapping.csv";
/// Stored matrices: every entry, as a share of the largest.
const SHARE: f64 = 1e-12;

/// The head, its markers, and operators by their options.
pub(super) struct Head {
    pub skin: AvatarSkin,
    pub map: MarkerMap,
    sites: Vec<MarkerSite>,
    built: BTreeMap<String, Operators>,
}

impl Head {
    pub fn read(folder: &Path) -> Result<Self, VerifyError> {
        let file: PathBuf = folder.join(AVATAR);
        let avatar = mimique_avatar_files::read_avatar(&file)
            .map_err(|error| VerifyError::file(&file, &error))?
            .avatar;
        let skin = AvatarSkin::of(&avatar).map_err(|error| VerifyError::file(&file, &error))?;
        let file = folder.join(MAP);
        let map = MarkerMap::from_text(&text(&file)?);
        let map = map.map_err(|error| VerifyError::file(&file, &error))?;
        let sites = map.resolve(&skin).map_err(|error| VerifyError::file(&file, &error))?;
        Ok(Self { skin, map, sites, built: BTreeMap::new() })
    }

    /// D, H and what else a method needs.
    pub fn operators(&mut self, options: &OperatorOptions) -> Result<&Operators, OperatorError> {
        let key = format!("{options:?}");
        if !self.built.contains_key(&key) {
            let (mesh, names) = (&self.skin.mesh, &self.skin.shape_names);
            let operators = Operators::build_at(mesh, names, &self.sites, options)?;
            self.built.insert(key.clone(), operators);
        }
        Ok(&self.built[&key])
    }
}

/// Compares a matrix: every entry may be off by 1e-12 of the largest that is expected.
pub(super) fn near_largest(
    case: &mut Case,
    field: &str,
    expected: &Part<'_>,
    got: &Value,
) -> Result<(), VerifyError> {
    let largest = expected.numbers()?.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    case.compare(field, expected.value(), got, Tolerance::Absolute(SHARE * largest));
    Ok(())
}

/// Rows of A B, k_s = k_b = 1: x, y, z of each vertex, a column a shape.
pub(super) fn shell_rows(mesh: &SkinMesh, laplacian: &Laplacian, vertices: &[usize]) -> Vec<f64> {
    let count = mesh.shapes.len();
    let mut out = vec![0.0; vertices.len() * 3 * count];
    for (k, shape) in mesh.shapes.iter().enumerate() {
        for axis in 0..3 {
            let mut field = vec![0.0; mesh.positions.len()];
            for (&vertex, delta) in shape.vertices.iter().zip(&shape.deltas) {
                field[vertex as usize] = delta[axis];
            }
            let applied = apply_shell(laplacian, 1.0, 1.0, &field);
            for (at, &vertex) in vertices.iter().enumerate() {
                out[(3 * at + axis) * count + k] = applied[vertex];
            }
        }
    }
    out
}

/// The stored operators and constants.
pub(super) fn operators(
    head: &mut Head,
    folder: &Path,
    each: &mut dyn FnMut(Case),
) -> Result<(), VerifyError> {
    let document = Document::read(&folder.join(OPERATORS))?;
    let stored = document.root();
    for (kind, h, tau) in [
        (LaplacianKind::Uniform, "H_uniform", "tau_uniform"),
        (LaplacianKind::Umbrella, "H_umbrella", "tau_umbrella"),
        (LaplacianKind::CotanLiteral, "H_cot", "tau_cot"),
    ] {
        if let Some(gram) = stored.find(h) {
            let mut case = Case::new(format!("operators/{}", kind.word()));
            of_kind(&mut case, head, kind, &stored, [(h, &gram), (tau, &stored.get(tau)?)])?;
            each(case);
        }
    }
    if let Some(expected) = stored.find("ABrows_uniform") {
        let mut case = Case::new("operators/AB");
        let mesh = &head.skin.mesh;
        let count = mesh.positions.len();
        let vertices = stored.get("check_rows")?.indices_below(count, "a vertex of the skin")?;
        let laplacian = Laplacian::new(&mesh.positions, &mesh.triangles, LaplacianKind::Uniform);
        let applied = shell_rows(mesh, &laplacian, &vertices);
        let shapes = mesh.shapes.len();
        let got = applied.chunks(3 * shapes).map(|vertex| rows(vertex, shapes)).collect();
        near_largest(&mut case, "ABrows_uniform", &expected, &got)?;
        each(case);
    }
    let file = folder.join(CONSTANTS);
    if file.is_file() {
        each(constants(head, &Document::read(&file)?)?);
    }
    Ok(())
}

/// D, H, l^2 and tau of a Laplacian.
fn of_kind(
    case: &mut Case,
    head: &mut Head,
    kind: LaplacianKind,
    stored: &Part<'_>,
    [(h, gram), (tau, scale)]: [(&str, &Part<'_>); 2],
) -> Result<(), VerifyError> {
    let options = OperatorOptions { laplacian: kind, ..OperatorOptions::default() };
    let operators = match head.operators(&options) {
        Ok(operators) => operators,
        Err(why) => {
            case.refused("operators", &why);
            return Ok(());
        }
    };
    let (parts, count) = (operators.parts(), operators.shape_count());
    near_largest(case, "D", &stored.get("D")?, &rows(&parts.marker_deltas, count))?;
    near_largest(case, h, gram, &rows(&parts.shell_gram, count))?;
    let relative = Tolerance::Relative { share: SHARE, floor: 0.0 };
    case.compare("ell2", stored.get("ell2")?.value(), &number(operators.data_scale()), relative);
    case.compare(tau, scale.value(), &number(operators.shell_scale()), relative);
    Ok(())
}

/// How many vertices, markers and shapes there are, and their names.
fn constants(head: &mut Head, document: &Document) -> Result<Case, VerifyError> {
    let stored = document.root();
    let mut case = Case::new("constants");
    for (key, got) in [
        ("S", json!(head.skin.mesh.positions.len())),
        ("P", json!(head.sites.len())),
        ("N", json!(head.skin.shape_names.len())),
        ("names", json!(head.skin.shape_names)),
    ] {
        if let Some(expected) = stored.find(key) {
            case.compare(key, expected.value(), &got, Tolerance::Exact);
        }
    }
    let Some(variants) = stored.find("variants") else { return Ok(case) };
    for (name, variant) in variants.members()? {
        let Some(expected) = variant.find("linked_vertices") else { continue };
        let field = format!("variants/{name}/linked_vertices");
        let found = super::variants::spec(name).and_then(|spec| {
            let operators = head.operators(&OperatorOptions::of(&spec));
            let operators = operators.map_err(|why| why.to_string())?;
            let linked = operators.parts().associated.as_ref();
            Ok(linked.map_or(Value::Null, |linked| json!(linked.vertex_count)))
        });
        case.compare_outcome(&field, expected.value(), found, Tolerance::Exact, |count| count);
    }
    Ok(case)
}
