//! Ordered probit by maximum likelihood (McCullagh 1980): thresholds and effects of a rating, whatever
//! the dependence between answers of one person, which costs efficiency but not consistency.
//!
//! P(Y <= k) = Φ(τ_k - η), η = x β; the latent value has variance 1 over people, clips and noise.

use mimique_stats::normal_upper;
use nalgebra::{DMatrix, DVector};

/// Answers that share their effects: how often each point was chosen.
pub(super) struct Cell {
    /// Row of the design.
    pub x: Vec<f64>,
    /// Count a point.
    pub counts: Vec<f64>,
}

/// Thresholds and effects in standard deviations of the latent value.
#[derive(Debug, Clone)]
pub(super) struct OrderedProbit {
    pub thresholds: Vec<f64>,
    pub effects: Vec<f64>,
}

/// Relative to all answers, what is added to every point, so that one that nobody chose has a place.
const PSEUDO: f64 = 1e-4;

/// Density of the standard normal distribution.
pub(super) fn density(z: f64) -> f64 {
    libm::exp(-0.5 * z * z) / (2.0 * std::f64::consts::PI).sqrt()
}

/// Distribution function of the standard normal distribution.
fn below(z: f64) -> f64 {
    normal_upper(-z).p
}

/// Fisher scoring with halved steps; none where there is nothing to fit or it does not settle.
pub(super) fn fit(cells: &[Cell], points: usize) -> Option<OrderedProbit> {
    let effects = cells.first()?.x.len();
    let total: f64 = cells.iter().flat_map(|cell| &cell.counts).sum();
    if points < 2 || total < 2.0 {
        return None;
    }
    let cells: Vec<Cell> = cells
        .iter()
        .map(|cell| {
            let n: f64 = cell.counts.iter().sum();
            let counts = cell.counts.iter().map(|count| count + PSEUDO * n.max(1.0)).collect();
            Cell { x: cell.x.clone(), counts }
        })
        .collect();
    let mut parameters = marginal_thresholds(&cells, points);
    parameters.resize(points - 1 + effects, 0.0);
    let mut likelihood = log_likelihood(&cells, points, &parameters)?;
    for _ in 0..60 {
        let (score, information) = derivatives(&cells, points, &parameters);
        let step = solve(&information, &score)?;
        let mut share = 1.0;
        let next = loop {
            let next: Vec<f64> = parameters
                .iter()
                .zip(step.iter())
                .map(|(value, step)| value + share * step)
                .collect();
            match log_likelihood(&cells, points, &next) {
                Some(better) if better >= likelihood - 1e-12 * likelihood.abs() => {
                    break Some((next, better));
                }
                _ => share /= 2.0,
            }
            if share < 1e-8 {
                break None;
            }
        };
        let Some((next, better)) = next else { break };
        let gained = better - likelihood;
        (parameters, likelihood) = (next, better);
        // Beyond this nothing that is printed changes.
        if gained.abs() < 1e-10 * likelihood.abs() {
            break;
        }
    }
    let effects = parameters.split_off(points - 1);
    Some(OrderedProbit { thresholds: parameters, effects })
}

/// Thresholds of all answers together, without effects: where the scoring begins.
fn marginal_thresholds(cells: &[Cell], points: usize) -> Vec<f64> {
    let mut marginal = vec![0.0; points];
    for cell in cells {
        for (sum, count) in marginal.iter_mut().zip(&cell.counts) {
            *sum += count;
        }
    }
    let all: f64 = marginal.iter().sum();
    let mut cumulative = 0.0;
    marginal[..points - 1]
        .iter()
        .map(|count| {
            cumulative += count / all;
            -mimique_stats::normal_quantile_upper(cumulative)
        })
        .collect()
}

/// Probability of each point at a latent mean.
pub(super) fn probabilities(thresholds: &[f64], eta: f64) -> Vec<f64> {
    let mut last = 0.0;
    let mut shares: Vec<f64> = thresholds
        .iter()
        .map(|threshold| {
            let upto = below(threshold - eta);
            let share = upto - last;
            last = upto;
            share
        })
        .collect();
    shares.push(1.0 - last);
    shares
}

fn eta(x: &[f64], effects: &[f64]) -> f64 {
    x.iter().zip(effects).map(|(x, effect)| x * effect).sum()
}

/// None where thresholds do not ascend.
fn log_likelihood(cells: &[Cell], points: usize, parameters: &[f64]) -> Option<f64> {
    let (thresholds, effects) = parameters.split_at(points - 1);
    if thresholds.windows(2).any(|pair| pair[0] >= pair[1]) {
        return None;
    }
    let mut sum = 0.0;
    for cell in cells {
        let shares = probabilities(thresholds, eta(&cell.x, effects));
        for (count, share) in cell.counts.iter().zip(shares) {
            sum += count * libm::log(share.max(1e-300));
        }
    }
    sum.is_finite().then_some(sum)
}

/// The score, and the information expected of the parameters.
fn derivatives(cells: &[Cell], points: usize, parameters: &[f64]) -> (DVector<f64>, DMatrix<f64>) {
    let (thresholds, effects) = parameters.split_at(points - 1);
    let size = parameters.len();
    let mut score = DVector::zeros(size);
    let mut information = DMatrix::zeros(size, size);
    let mut gradient = vec![0.0; size];
    for cell in cells {
        let eta = eta(&cell.x, effects);
        let shares = probabilities(thresholds, eta);
        let n: f64 = cell.counts.iter().sum();
        let at: Vec<f64> = thresholds.iter().map(|threshold| density(threshold - eta)).collect();
        for point in 0..points {
            gradient.fill(0.0);
            let upper = if point + 1 < points { at[point] } else { 0.0 };
            let lower = if point > 0 { at[point - 1] } else { 0.0 };
            if point + 1 < points {
                gradient[point] = upper;
            }
            if point > 0 {
                gradient[point - 1] -= lower;
            }
            for (place, x) in cell.x.iter().enumerate() {
                gradient[points - 1 + place] = -x * (upper - lower);
            }
            let share = shares[point].max(1e-300);
            for i in 0..size {
                if gradient[i] == 0.0 {
                    continue;
                }
                score[i] += cell.counts[point] * gradient[i] / share;
                for j in 0..size {
                    information[(i, j)] += n * gradient[i] * gradient[j] / share;
                }
            }
        }
    }
    (score, information)
}

/// The solution of linear equations; none where the matrix is singular.
fn solve(matrix: &DMatrix<f64>, right: &DVector<f64>) -> Option<DVector<f64>> {
    let decomposed = matrix.clone().lu();
    // Effects that cannot be told apart leave a pivot of rounding's size.
    let least = 1e-11 * matrix.amax();
    let is_singular = decomposed.u().diagonal().iter().any(|pivot| pivot.abs() <= least);
    if is_singular { None } else { decomposed.solve(right) }
}
