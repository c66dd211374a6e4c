//! The operators pack (`MMOP`): what the solver needs of avatar and marker map, and no mesh.
//!
//! Body: options (Laplacian, k_s, k_b, association, sigma), shape names, marker labels, S, marker
//! positions, D, H as f64, then Kouadio's associated rows where they were asked for, then what
//! `regression` has learnt where it has. l^2 and tau follow from D and H. A surface's operators are
//! of the same form. It is deflated; a browser inflates it before its solver reads it.

use mimique_avatar::pack::{PackError, PackReader, PackWriter, open_pack, open_plain, seal_pack};
use mimique_geometry::{Point, coordinates};
use mimique_solver::{
    AssociatedRows, Kernel, LaplacianKind, OperatorOptions, OperatorParts, Operators, Regression,
    VertexAssociation,
};

const KIND: &str = "MMOP";
const VERSION: u32 = 3;

const LAPLACIANS: [LaplacianKind; 4] = [
    LaplacianKind::Uniform,
    LaplacianKind::Umbrella,
    LaplacianKind::CotanClamped,
    LaplacianKind::CotanLiteral,
];

/// Packs operators. Every bit of every number is kept.
pub fn encode_operators(operators: &Operators) -> Vec<u8> {
    let parts = operators.parts();
    let mut w = PackWriter::new();
    let kind = LAPLACIANS.iter().position(|k| *k == parts.options.laplacian);
    w.u8(kind.unwrap_or(0) as u8);
    w.f64(parts.options.k_s);
    w.f64(parts.options.k_b);
    let (association, sigma) = match parts.options.association {
        None => (0, 0.0),
        Some(VertexAssociation::Points) => (1, 0.0),
        Some(VertexAssociation::Zones { sigma }) => (2, sigma),
        Some(VertexAssociation::Triangles) => (3, 0.0),
    };
    w.u8(association);
    w.f64(sigma);
    w.texts(&parts.shape_names);
    w.texts(&parts.marker_labels);
    w.u64(parts.vertex_count as u64);
    let mut all = |numbers: &[f64]| numbers.iter().for_each(|&x| w.f64(x));
    all(coordinates(&parts.marker_positions));
    all(&parts.marker_deltas);
    all(&parts.shell_gram);
    w.u8(u8::from(parts.associated.is_some()) | u8::from(parts.regression.is_some()) << 1);
    if let Some(associated) = &parts.associated {
        w.u64(associated.vertex_count as u64);
        associated.grams.iter().chain(&associated.sums).for_each(|&x| w.f64(x));
    }
    if let Some(model) = &parts.regression {
        w.u64(model.training_frames as u64);
        w.varint(model.basis_count() as u32);
        let Kernel { length, signal, noise } = model.kernel;
        [length, signal, noise, model.log_likelihood].into_iter().for_each(|x| w.f64(x));
        let all = [&model.centre, &model.scale, &model.basis, &model.coefficients];
        all.into_iter().chain([&model.covariance]).flatten().for_each(|&x| w.f64(x));
    }
    seal_pack(KIND, VERSION, &w.into_bytes())
}

/// Unpacks operators: the same bits as were packed.
///
/// # Errors
/// [`PackError`] for anything that [`encode_operators`] does not write.
pub fn decode_operators(bytes: &[u8]) -> Result<Operators, PackError> {
    operators_in(&open_pack(KIND, VERSION, bytes)?)
}

/// The same of a pack whose body is inflated already: its first twelve bytes as they were.
///
/// # Errors
/// As [`decode_operators`].
pub fn decode_inflated_operators(bytes: &[u8]) -> Result<Operators, PackError> {
    operators_in(open_plain(KIND, VERSION, bytes)?)
}

fn operators_in(body: &[u8]) -> Result<Operators, PackError> {
    let mut r = PackReader::new(KIND, body);
    let kind = r.u8()?;
    let Some(&laplacian) = LAPLACIANS.get(usize::from(kind)) else {
        return r.refuse(format!("Laplacian {kind}"));
    };
    let (k_s, k_b) = (r.f64()?, r.f64()?);
    let association = match (r.u8()?, r.f64()?) {
        (0, _) => None,
        (1, _) => Some(VertexAssociation::Points),
        (2, sigma) => Some(VertexAssociation::Zones { sigma }),
        (3, _) => Some(VertexAssociation::Triangles),
        (other, _) => return r.refuse(format!("association {other}")),
    };
    let options = OperatorOptions { laplacian, k_s, k_b, association };
    let shape_names = r.texts()?;
    let marker_labels = r.texts()?;
    let (n, p) = (shape_names.len(), marker_labels.len());
    let vertex_count = r.u64()? as usize;
    let positions = numbers(&mut r, 3, p)?;
    let marker_deltas = numbers(&mut r, 3 * p, n)?;
    let shell_gram = numbers(&mut r, n, n)?;
    let more = r.u8()?;
    if more > 3 {
        return r.refuse(format!("flags {more}"));
    }
    let associated = match (more & 1, association) {
        (0, _) => None,
        (_, Some(association)) => Some(AssociatedRows {
            association,
            vertex_count: r.u64()? as usize,
            grams: numbers(&mut r, p, n.saturating_mul(n + 1) / 2)?,
            sums: numbers(&mut r, 3 * p, n)?,
        }),
        (_, None) => return r.refuse("associated rows without an association".to_owned()),
    };
    let regression = if more & 2 == 0 { None } else { Some(regression(&mut r, 3 * p, n)?) };
    let left = r.left();
    if left > 0 {
        return r.refuse(format!("{left} bytes too many"));
    }
    let marker_positions =
        positions.chunks_exact(3).map(|c| Point::new(c[0], c[1], c[2])).collect();
    Operators::from_parts(OperatorParts {
        options,
        shape_names,
        marker_labels,
        marker_positions,
        vertex_count,
        marker_deltas,
        shell_gram,
        associated,
        regression,
    })
    .or_else(|e| r.refuse(e.to_string()))
}

fn regression(
    r: &mut PackReader<'_>,
    width: usize,
    shape_count: usize,
) -> Result<Regression, PackError> {
    let training_frames = r.u64()? as usize;
    let m = r.varint()? as usize;
    let kernel = Kernel { length: r.f64()?, signal: r.f64()?, noise: r.f64()? };
    Ok(Regression {
        kernel,
        log_likelihood: r.f64()?,
        training_frames,
        shape_count,
        centre: numbers(r, 1, width)?,
        scale: numbers(r, 1, width)?,
        basis: numbers(r, m, width)?,
        coefficients: numbers(r, m, shape_count)?,
        covariance: numbers(r, m, m)?,
    })
}

/// `rows` x `columns` numbers, if the pack has that many.
fn numbers(r: &mut PackReader<'_>, rows: usize, columns: usize) -> Result<Vec<f64>, PackError> {
    let count = rows.saturating_mul(columns);
    if count.saturating_mul(8) > r.left() {
        return r.refuse(format!("{count} numbers, {} bytes left", r.left()));
    }
    (0..count).map(|_| r.f64()).collect()
}
