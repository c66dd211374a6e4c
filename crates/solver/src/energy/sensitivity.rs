//! What markers tell of each shape: how far noise moves its weight, and what the thin shell has to decide instead.

use crate::energy::operators::Operators;
use crate::linear_algebra::cholesky::Cholesky;

/// The shell's weight and the ridge's share that sensitivities are stated with, whatever the method: those of `lsts`
/// by default (METHOD), so that methods which are compared hold the same shapes.
const ALPHA: f64 = 0.3;
const KAPPA: f64 = 0.1;
/// The noise that sensitivities are stated for: 1 mm on each coordinate, of which a sensor makes a tenth and the
/// difference between an actor's face and an avatar's the rest.
const NOISE_M: f64 = 1e-3;
/// The whole range of a weight.
const RANGE: f64 = 1.0;
/// A weight whose standard error is this share of its range, while those of other shapes are unknown, is told only
/// together with theirs.
const SHARED: f64 = 0.5;

/// How a shape's weight is found.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ToldBy {
    /// By the markers.
    Markers,
    /// By the markers together with other shapes: the thin shell divides it between them.
    Shared,
    /// By nothing: noise of 1 mm moves its weight from 0 to 1 and beyond even if all others are known.
    Nothing,
}

/// What markers tell of one shape, at 1 mm of noise on each coordinate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ShapeSensitivity {
    /// The shape, in the order of the bank.
    pub shape: usize,
    /// Standard error of its weight where all other weights are known: 1 mm / |D_k|.
    pub alone: f64,
    /// Standard error of its weight where the markers alone have to tell all weights, each somewhere in its range.
    pub together: f64,
    /// Standard error of its weight where the thin shell helps.
    pub standard_error: f64,
    /// How it is found.
    pub by: ToldBy,
    /// The shape that it is confused with most, and their correlation; none of a shape that is alone.
    pub partner: Option<(usize, f64)>,
}

/// Whether markers tell a shape at all, whatever else they have to tell; `square` is |D_k|^2, square metres.
pub fn is_told(square: f64) -> bool {
    square.sqrt() * RANGE > NOISE_M
}

/// Standard error of a shape's weight at 1 mm of noise where all other weights are known; infinite where no marker
/// moves.
pub fn error_alone(square: f64) -> f64 {
    NOISE_M / square.sqrt()
}

/// What the markers tell of each of the `free` shapes, in their order.
///
/// With noise sigma on each coordinate: alone is sigma / |D_k|; together is the root of the diagonal of
/// (D^T D / sigma^2 + I)^-1, weights that are anywhere in their range of 1; with the thin shell it is that of
/// (sigma / l)^2 A^-1, A = D^T D / l^2 + alpha (H / tau + kappa I), the energy of `lsts` read as a posterior (METHOD,
/// the energy; Tarantola, *Inverse Problem Theory*, 2005, section 3.2).
pub fn shape_sensitivities(operators: &Operators, free: &[usize]) -> Vec<ShapeSensitivity> {
    let n = operators.shape_count();
    let parts = operators.parts();
    let (l2, tau) = (operators.data_scale(), operators.shell_scale());
    let gram: Vec<f64> = (free.iter())
        .flat_map(|&a| free.iter().map(move |&b| (a, b)))
        .map(|(a, b)| parts.marker_deltas.chunks_exact(n).map(|row| row[a] * row[b]).sum())
        .collect();
    let count = free.len();
    let own = |a: usize, b: usize| if a == b { 1.0 } else { 0.0 };
    let told = inverse(count, |a, b| {
        gram[a * count + b] / (NOISE_M * NOISE_M) + own(a, b) / (RANGE * RANGE)
    });
    let with_shell = inverse(count, |a, b| {
        let shell = parts.shell_gram[free[a] * n + free[b]];
        let shell = if tau > 0.0 { shell / tau } else { 0.0 };
        gram[a * count + b] / l2 + ALPHA * (shell + KAPPA * own(a, b))
    });
    (0..count)
        .map(|i| {
            let variance = told[i * count + i];
            let correlation =
                |j: usize| told[i * count + j] / (variance * told[j * count + j]).sqrt();
            let alone = error_alone(gram[i * count + i]);
            let together = variance.sqrt();
            ShapeSensitivity {
                shape: free[i],
                alone,
                together,
                standard_error: NOISE_M * (with_shell[i * count + i] / l2).sqrt(),
                by: match () {
                    () if !is_told(gram[i * count + i]) => ToldBy::Nothing,
                    () if together >= SHARED * RANGE => ToldBy::Shared,
                    () => ToldBy::Markers,
                },
                partner: (0..count)
                    .filter(|&j| j != i)
                    .map(|j| (free[j], correlation(j)))
                    .max_by(|a, b| a.1.abs().total_cmp(&b.1.abs())),
            }
        })
        .collect()
}

/// The inverse of a symmetric, positive definite matrix, row by row.
fn inverse(count: usize, of: impl Fn(usize, usize) -> f64) -> Vec<f64> {
    let mut factor = Cholesky::default();
    factor.reset(count);
    for i in 0..count {
        for (place, j) in factor.row_mut(i).iter_mut().zip(i..count) {
            *place = of(i, j);
        }
    }
    factor.factor();
    let mut out = vec![0.0; count * count];
    for (i, row) in out.chunks_exact_mut(count.max(1)).enumerate() {
        row[i] = 1.0;
        factor.solve(row);
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::energy::operators::{OperatorOptions, OperatorParts};
    use mimique_geometry::Point;

    /// Markers whose coordinates move by these rows, metres; a row per coordinate.
    fn operators(rows: &[&[f64]]) -> Operators {
        let n = rows[0].len();
        let markers = rows.len() / 3;
        let mut shell = vec![0.0; n * n];
        (0..n).for_each(|k| shell[k * n + k] = 1e-4);
        Operators::from_parts(OperatorParts {
            options: OperatorOptions::default(),
            shape_names: (0..n).map(|k| format!("s{k}")).collect(),
            marker_labels: (0..markers).map(|m| format!("m{m}")).collect(),
            marker_positions: (0..markers).map(|m| Point::new(m as f64, 0.0, 0.0)).collect(),
            vertex_count: 10,
            marker_deltas: rows.concat(),
            shell_gram: shell,
            associated: None,
            regression: None,
        })
        .unwrap()
    }

    #[test]
    fn shapes_of_their_own_opposite_shapes_and_unseen_ones() {
        // 4 mm alone; 10 mm each and each the other's opposite; half a millimetre.
        let rows: [&[f64]; 6] = [
            &[0.004, 0.0, 0.0, 0.0],
            &[0.0, 0.010, -0.010, 0.0],
            &[0.0, 0.0, 0.0, 0.0005],
            &[0.0; 4],
            &[0.0; 4],
            &[0.0; 4],
        ];
        let told = shape_sensitivities(&operators(&rows), &[0, 1, 2, 3]);
        let near = |a: f64, b: f64| assert!((a - b).abs() < 1e-9, "{a} {b}");
        near(told[0].alone, 0.25);
        near(told[0].together, (1.0_f64 / 17.0).sqrt());
        assert_eq!(told[0].by, ToldBy::Markers);
        for (own, other) in [(1, 2), (2, 1)] {
            near(told[own].alone, 0.1);
            near(told[own].together, (101.0_f64 / 201.0).sqrt());
            assert_eq!(told[own].by, ToldBy::Shared);
            let (partner, correlation) = told[own].partner.unwrap();
            assert_eq!(partner, other);
            near(correlation, 100.0 / 101.0);
        }
        near(told[3].alone, 2.0);
        assert_eq!(told[3].by, ToldBy::Nothing);
        assert!(!is_told(0.0005_f64.powi(2)) && is_told(0.004_f64.powi(2)));
        // Where one of two opposite shapes is locked, the markers tell the other.
        let told = shape_sensitivities(&operators(&rows), &[3, 1]);
        assert_eq!(told.iter().map(|t| t.shape).collect::<Vec<_>>(), [3, 1]);
        assert_eq!(told[1].by, ToldBy::Markers);
        near(told[1].together, (1.0_f64 / 101.0).sqrt());
        // The thin shell makes every weight surer than its prior alone.
        assert!(told.iter().all(|t| t.standard_error > 0.0 && t.standard_error < 1.0));
        assert!(shape_sensitivities(&operators(&rows), &[]).is_empty());
    }
}
