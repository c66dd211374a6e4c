//! `greedy_face.json`, `slip_face.json`, `qr_face.json`, `head_face.json`: which places come first.

use mimique_geometry::Point;
use mimique_solver::{
    Criterion, FaceMoments, Greedy, MarkerUnit, PivotedQr, SkinGradients, best_heads, head_error,
};
use serde_json::{Value, json};

use super::{Deltas, EXACT, Source, apart, bare_mesh, matrix, member, points, relative};
use crate::case::{Tolerance, number, numbers};
use crate::document::Part;
use crate::{Case, VerifyError};

/// Names of the axes.
const AXES: [&str; 3] = ["x", "y", "z"];
/// Covariances, diagonals, errors of the head.
const NEAR: Tolerance = Tolerance::Absolute(1e-9);

/// A unit of a greedy run: its vertices, and what they measure.
pub(super) struct Placed {
    pub vertices: Vec<usize>,
    pub unit: MarkerUnit,
}

/// What a greedy run found.
#[derive(Default)]
pub(super) struct Run {
    pub order: Vec<usize>,
    pub gains: Vec<f64>,
    pub expected_rmse: Vec<f64>,
}

/// Chooses `count` vertices; units nearer than the minimum distance to one that is chosen are out.
pub(super) fn run(
    placed: &[Placed],
    prior: &[f64],
    criterion: Criterion,
    count: usize,
    apart: &dyn Fn(usize, usize) -> bool,
) -> Run {
    let units: Vec<MarkerUnit> = placed.iter().map(|p| p.unit.clone()).collect();
    let mut greedy = Greedy::new(&units, prior, criterion);
    let mut found = Run::default();
    while found.order.len() < count {
        let room = count - found.order.len();
        let may = |u: usize| placed[u].vertices.len() <= room;
        let Some((best, gain)) = greedy.best(&may) else { break };
        greedy.take(best);
        found.order.extend(&placed[best].vertices);
        found.gains.push(gain);
        found.expected_rmse.extend(greedy.expected_square().map(f64::sqrt));
        for (u, other) in placed.iter().enumerate() {
            let near = |&v: &usize| placed[best].vertices.iter().any(|&t| !apart(v, t));
            if other.vertices.iter().any(near) {
                greedy.leave_out(u);
            }
        }
    }
    found
}

/// A marker whose noise is alike in all directions.
pub(super) fn plain(noise: f64) -> [[f64; 3]; 3] {
    let square = noise * noise;
    [[square, 0.0, 0.0], [0.0, square, 0.0], [0.0, 0.0, square]]
}

/// The criterion of a word of the cases.
pub(super) fn criterion(
    part: &Part<'_>,
    gram: impl FnOnce() -> Vec<f64>,
) -> Result<Criterion, VerifyError> {
    match part.text()? {
        "information" => Ok(Criterion::Information),
        "expected error" => Ok(Criterion::ExpectedError(gram())),
        _ => Err(part.wrong("information, or expected error")),
    }
}

/// Units of single vertices, or with `mirror` of pairs: those with x > 0 stand for themselves and their
/// mirror images, those with x = 0 for one.
fn placed(
    deltas: &Deltas,
    candidates: &[usize],
    vertices: &[Point],
    mirror: Option<&[usize]>,
    apart: &dyn Fn(usize, usize) -> bool,
    covariance: impl Fn(usize) -> [[f64; 3]; 3],
) -> Vec<Placed> {
    let unit = |own: Vec<usize>| Placed {
        unit: MarkerUnit {
            deltas: deltas.rows(&own),
            covariances: own.iter().map(|&v| covariance(v)).collect(),
        },
        vertices: own,
    };
    let own = |&v: &usize| match mirror {
        None => Some(vec![v]),
        Some(_) if vertices[v].x == 0.0 => Some(vec![v]),
        Some(mirror) => (vertices[v].x > 0.0 && apart(v, mirror[v])).then(|| vec![v, mirror[v]]),
    };
    candidates.iter().filter_map(own).map(unit).collect()
}

/// Markers one after the other by both criteria.
pub(super) fn greedy(source: &Source<'_>, each: &mut dyn FnMut(Case)) -> Result<(), VerifyError> {
    let root = source.document.root();
    let vertices = points(&root.get("vertices")?)?;
    let deltas = Deltas::read(&root.get("deltas")?, vertices.len())?;
    let mirror = root.get("mirror")?.indices_below(vertices.len(), "a vertex")?;
    let noise = root.get("noise_mm")?.number()?;
    for (place, expected) in root.get("expected")?.list()?.into_iter().enumerate() {
        let mut case = Case::new(format!("{}/{place}", source.name));
        // The entry of a group of the file that the case names.
        let named = |group: &str| root.get(group)?.get(expected.get(group)?.text()?);
        let candidates = named("candidates")?.indices_below(vertices.len(), "a vertex")?;
        let prior = matrix(&named("prior")?, deltas.shapes, deltas.shapes)?;
        let pairs = expected.get("pairs")?.value() == &json!(true);
        let minimum = expected.get("minimum_distance_mm")?.number()?;
        let apart = apart(&vertices, minimum);
        let mirror = pairs.then_some(mirror.as_slice());
        let placed = placed(&deltas, &candidates, &vertices, mirror, &apart, |_| plain(noise));
        let criterion = criterion(&expected.get("criterion")?, || deltas.gram())?;
        let count = expected.get("count")?.index()?;
        let found = run(&placed, &prior, criterion, count, &apart);
        compare(&mut case, &expected, &found, "expected_rmse", relative(1e-9));
        each(case);
    }
    Ok(())
}

/// Order, gains and expected errors.
pub(super) fn compare(
    case: &mut Case,
    expected: &Part<'_>,
    found: &Run,
    rmse: &str,
    by: Tolerance,
) {
    member(case, expected, "order", EXACT, &json!(found.order));
    member(case, expected, "gains", by, &numbers(&found.gains));
    member(case, expected, rmse, by, &numbers(&found.expected_rmse));
}

/// Markers that are put beside their vertices.
pub(super) fn slip(source: &Source<'_>, each: &mut dyn FnMut(Case)) -> Result<(), VerifyError> {
    let root = source.document.root();
    let vertices = points(&root.get("vertices")?)?;
    let deltas = Deltas::read(&root.get("deltas")?, vertices.len())?;
    let n = deltas.shapes;
    let triangle = |part: &Part<'_>| match part.indices_below(vertices.len(), "a vertex")?[..] {
        [a, b, c] => Ok([a as u32, b as u32, c as u32]),
        _ => Err(part.wrong("three vertices")),
    };
    let triangles =
        root.get("triangles")?.list()?.iter().map(triangle).collect::<Result<_, _>>()?;
    let gradients = SkinGradients::new(&bare_mesh(vertices.clone(), triangles));
    let moment = matrix(&root.get("second_moment")?, n, n)?;
    let deviations = [root.get("noise_mm")?.number()?, root.get("slip_mm")?.number()?];
    let covariance =
        |v: usize| gradients.measurement_covariance(v, &deltas.values, &moment, deviations);
    let (mut case, expected) = (Case::new(source.name), root.get("expected")?);
    for (place, wanted) in expected.get("covariances")?.list()?.iter().enumerate() {
        let vertex = wanted.get("vertex")?.index()?;
        if vertex >= vertices.len() {
            return Err(wanted.wrong("a vertex"));
        }
        let got: Value = covariance(vertex).iter().map(numbers).collect();
        let field = format!("covariances/{place}/mm2");
        case.compare(&field, wanted.get("mm2")?.value(), &got, NEAR);
    }
    let candidates = root.get("candidates")?.indices_below(vertices.len(), "a vertex")?;
    let prior = matrix(&root.get("prior")?, n, n)?;
    let minimum = root.get("minimum_distance_mm")?.number()?;
    let apart = apart(&vertices, minimum);
    let placed = placed(&deltas, &candidates, &vertices, None, &apart, covariance);
    let count = expected.get("order")?.list()?.len();
    let found = run(&placed, &prior, Criterion::ExpectedError(deltas.gram()), count, &apart);
    compare(&mut case, &expected, &found, "expected_rmse_mm", relative(1e-9));
    each(case);
    Ok(())
}

/// QR of modes with pivoting, by vertex and by coordinate.
pub(super) fn pivoted_qr(
    source: &Source<'_>,
    each: &mut dyn FnMut(Case),
) -> Result<(), VerifyError> {
    let root = source.document.root();
    let modes = root.get("modes")?;
    let vertices = modes.list()?.len();
    let width = modes.first()?.first()?.list()?.len();
    let rows = matrix(&modes, vertices, 3 * width)?;
    let candidates = root.get("candidates")?.indices_below(vertices, "a vertex")?;
    let units: Vec<Vec<f64>> =
        candidates.iter().map(|&v| rows[v * 3 * width..(v + 1) * 3 * width].to_vec()).collect();
    let (mut case, expected) = (Case::new(source.name), root.get("expected")?);
    let mut qr = PivotedQr::new(units.clone(), width);
    let mut by_vertex = Vec::new();
    while by_vertex.len() < expected.get("by_vertex")?.list()?.len() {
        let Some(best) = qr.largest(&|_| true) else { break };
        qr.take(best);
        by_vertex.push(candidates[best]);
    }
    member(&mut case, &expected, "by_vertex", EXACT, &json!(by_vertex));
    let wanted = expected.get("by_coordinate")?.list()?.len();
    let found = PivotedQr::new(units, width).by_row(wanted);
    let named = found
        .iter()
        .map(|row| json!({"vertex": candidates[row.candidate], "axis": AXES[row.axis]}));
    member(&mut case, &expected, "by_coordinate", EXACT, &named.collect());
    let diagonal: Vec<f64> = found.iter().map(|row| row.diagonal).collect();
    member(&mut case, &expected, "diagonal", NEAR, &numbers(&diagonal));
    each(case);
    Ok(())
}

/// The error on the face by the noise of head markers; the best six are found within 2 %.
pub(super) fn heads(source: &Source<'_>, each: &mut dyn FnMut(Case)) -> Result<(), VerifyError> {
    let root = source.document.root();
    let candidates = points(&root.get("candidates")?)?;
    let face = FaceMoments::of(&points(&root.get("face")?)?);
    let noise = root.get("noise_mm")?.number()?;
    let error = |heads: &[usize]| {
        let heads: Vec<Point> = heads.iter().map(|&i| candidates[i]).collect();
        head_error(&heads, &face, noise).map_or(Value::Null, number)
    };
    let below = |part: &Part<'_>| part.indices_below(candidates.len(), "a candidate");
    let (mut case, expected) = (Case::new(source.name), root.get("expected")?);
    for (place, set) in expected.get("sets")?.list()?.iter().enumerate() {
        let got = error(&below(&set.get("heads")?)?);
        let field = format!("sets/{place}/rms_mm");
        case.compare(&field, set.get("rms_mm")?.value(), &got, NEAR);
    }
    let best = expected.get("best_six_rms_mm")?;
    let six = error(&below(&expected.get("best_six")?)?);
    case.compare("best_six_rms_mm", best.value(), &six, NEAR);
    let found = best_heads(&candidates, &face, 6, &|_, _| true);
    let found = found.map_or(Value::Null, |heads| error(&heads));
    case.compare("searched_rms_mm", best.value(), &found, relative(0.02));
    each(case);
    Ok(())
}
