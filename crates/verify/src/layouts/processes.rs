//! `sogp_small.json`, `sogp_face.json`, `gp_face.json`, `curve_face.json`: Gaussian processes from markers to
//! weights, and the error over the number of markers.

use mimique_solver::{
    ExactProcess, InputScale, Kernel, Learning, SparseProcess, log_marginal_likelihood,
};
use serde_json::{Value, json};

use super::{Deltas, EXACT, Source, matrix, member, points, relative};
use crate::case::{Tolerance, number, numbers, rows};
use crate::document::Part;
use crate::{Case, VerifyError};

/// Every number of the processes.
const NEAR: Tolerance = Tolerance::Absolute(1e-8);

fn kernel(part: &Part<'_>) -> Result<Kernel, VerifyError> {
    let of = |key: &str| part.get(key)?.number();
    Ok(Kernel { length: of("length")?, signal: of("signal")?, noise: of("noise")? })
}

/// A table of numbers: the numbers, and how many a row has.
fn table(part: &Part<'_>) -> Result<(Vec<f64>, usize), VerifyError> {
    let (count, width) = (part.list()?.len(), part.first()?.list()?.len());
    if width == 0 {
        return Err(part.wrong("rows of numbers"));
    }
    Ok((matrix(part, count, width)?, width))
}

/// Predictions at some inputs: means, row after row, and variances.
fn predicted(
    inputs: &[f64],
    [width, outputs]: [usize; 2],
    predict: impl Fn(&[f64], &mut [f64]) -> f64,
) -> (Vec<f64>, Vec<f64>) {
    let mut means = Vec::new();
    let mut variances = Vec::new();
    for x in inputs.chunks_exact(width) {
        let mut mean = vec![0.0; outputs];
        variances.push(predict(x, &mut mean));
        means.extend(mean);
    }
    (means, variances)
}

/// The sparse process, state after state.
pub(super) fn sparse(source: &Source<'_>, each: &mut dyn FnMut(Case)) -> Result<(), VerifyError> {
    let root = source.document.root();
    let (inputs, width) = table(&root.get("inputs")?)?;
    let (outputs, outputs_width) = table(&root.get("outputs")?)?;
    let capacity = root.get("capacity")?.index()?;
    let mut process =
        SparseProcess::new(kernel(&root.get("kernel")?)?, width, outputs_width, capacity);
    let (mut case, expected) = (Case::new(source.name), root.get("expected")?);
    let steps = expected.get("steps")?.list()?;
    let mut basis: Vec<usize> = Vec::new();
    let (mut grown, mut exchanged, mut projected) = (0, 0, 0);
    let examples = inputs.chunks_exact(width).zip(outputs.chunks_exact(outputs_width));
    case.compare("steps/length", &json!(steps.len()), &json!(examples.len()), EXACT);
    for (example, ((x, y), wanted)) in examples.zip(&steps).enumerate() {
        let (action, removed) = match process.learn(x, y) {
            Learning::Projected => ("project", Value::Null),
            Learning::Grown => {
                basis.push(example);
                ("grow", Value::Null)
            }
            Learning::Exchanged(place) => {
                basis.push(example);
                ("grow, remove", json!(basis.remove(place)))
            }
        };
        match action {
            "project" => projected += 1,
            "grow" => grown += 1,
            _ => exchanged += 1,
        }
        let m = process.len();
        for (key, by, got) in [
            ("action", EXACT, json!(action)),
            ("removed", EXACT, removed),
            ("basis", EXACT, json!(basis)),
            ("coefficients", NEAR, rows(process.coefficients(), outputs_width)),
            ("covariance", NEAR, rows(process.covariance(), m)),
            ("inverse_gram", NEAR, rows(process.inverse_gram(), m)),
        ] {
            if let Some(wanted) = wanted.find(key) {
                case.compare(&format!("steps/{example}/{key}"), wanted.value(), &got, by);
            }
        }
    }
    let counts = json!({"grow": grown, "grow, remove": exchanged, "project": projected});
    member(&mut case, &expected, "actions", EXACT, &counts);
    let (at, _) = table(&root.get("predict_at")?)?;
    let (mean, variance) =
        predicted(&at, [width, outputs_width], |x, mean| process.predict(x, mean));
    member(&mut case, &expected, "mean", NEAR, &rows(&mean, outputs_width));
    member(&mut case, &expected, "variance", NEAR, &numbers(&variance));
    each(case);
    Ok(())
}

/// The exact process: standardised inputs, predictions, likelihood.
pub(super) fn exact(source: &Source<'_>, each: &mut dyn FnMut(Case)) -> Result<(), VerifyError> {
    let root = source.document.root();
    let (mut inputs, width) = table(&root.get("displacements")?)?;
    let (outputs, outputs_width) = table(&root.get("weights")?)?;
    let (mut at, _) = table(&root.get("predict_at")?)?;
    let kernel = kernel(&root.get("kernel")?)?;
    let (mut case, expected) = (Case::new(source.name), root.get("expected")?);
    let Some(scale) = InputScale::of(&inputs, width) else {
        case.refused("scale", &"the markers never move");
        each(case);
        return Ok(());
    };
    member(&mut case, &expected, "centre", NEAR, &numbers(&scale.centre));
    member(&mut case, &expected, "scale", NEAR, &numbers(&scale.scale));
    inputs.chunks_exact_mut(width).chain(at.chunks_exact_mut(width)).for_each(|x| scale.apply(x));
    match ExactProcess::fit(&inputs, width, &outputs, outputs_width, &kernel) {
        None => case.refused("mean", &"the Gram matrix is singular"),
        Some(process) => {
            let (mean, variance) = predicted(&at, [width, outputs_width], |x, mean| {
                process.predict(&kernel, &inputs, x, mean)
            });
            member(&mut case, &expected, "mean", NEAR, &rows(&mean, outputs_width));
            member(&mut case, &expected, "variance", NEAR, &numbers(&variance));
        }
    }
    let (value, gradient) =
        log_marginal_likelihood(&inputs, width, &outputs, outputs_width, &kernel);
    member(&mut case, &expected, "log_marginal_likelihood", relative(1e-8), &number(value));
    let gradient = gradient.to_array();
    member(&mut case, &expected, "gradient_by_logarithms", NEAR, &numbers(&gradient));
    each(case);
    Ok(())
}

/// A case for each layout: weights and errors by the exact process that learnt from the first take.
pub(super) fn curve(source: &Source<'_>, each: &mut dyn FnMut(Case)) -> Result<(), VerifyError> {
    let root = source.document.root();
    let vertices = points(&root.get("vertices")?)?.len();
    let deltas = Deltas::read(&root.get("deltas")?, vertices)?;
    let n = deltas.shapes;
    let (learnt, own) = table(&root.get("weights")?)?;
    let (played, others) = table(&root.get("test_weights")?)?;
    if [own, others] != [n, n] {
        return Err(root.get("weights")?.wrong("a weight for every shape"));
    }
    for (place, expected) in root.get("expected")?.list()?.into_iter().enumerate() {
        let mut case = Case::new(format!("{}/{place}", source.name));
        let markers = expected.get("markers")?.indices_below(vertices, "a vertex")?;
        let kernel = kernel(&expected.get("kernel")?)?;
        match by_process(&deltas, &learnt, &played, &markers, &kernel) {
            None => case.refused("weights", &"nothing can be learnt from these markers"),
            Some(weights) => {
                let [as_printed, per_vertex] = deltas.errors(&weights, &played);
                member(&mut case, &expected, "weights", NEAR, &rows(&weights, n));
                member(&mut case, &expected, "rmse_3_5", NEAR, &number(as_printed));
                member(&mut case, &expected, "rmse_a_vertex", NEAR, &number(per_vertex));
            }
        }
        each(case);
    }
    Ok(())
}

/// The weights of a take by a process that learnt from another, both seen at some vertices.
fn by_process(
    deltas: &Deltas,
    learnt: &[f64],
    played: &[f64],
    markers: &[usize],
    kernel: &Kernel,
) -> Option<Vec<f64>> {
    let width = 3 * markers.len();
    let mut inputs = deltas.displaced(learnt, markers);
    let mut at = deltas.displaced(played, markers);
    let scale = InputScale::of(&inputs, width)?;
    inputs.chunks_exact_mut(width).chain(at.chunks_exact_mut(width)).for_each(|x| scale.apply(x));
    let process = ExactProcess::fit(&inputs, width, learnt, deltas.shapes, kernel)?;
    let predict = |x: &[f64], mean: &mut [f64]| process.predict(kernel, &inputs, x, mean);
    Some(predicted(&at, [width, deltas.shapes], predict).0)
}
