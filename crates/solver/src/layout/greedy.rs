//! Markers one after the other, each where it tells most of what is not yet known.
//!
//! The weights of a face are Gaussian with covariance S, at first the prior; a marker p measures D_p c, three
//! numbers, with covariance R_p. After it S is S - S D^T (R + D S D^T)^-1 D S.
//!
//! | criterion | what a unit of markers gains |
//! |---|---|
//! | information | 1/2 ln det(I + R^-1 D S D^T), halved for a pair |
//! | expected error | tr((R + D S D^T)^-1 D S G S D^T), what the mean square error of all vertices tr(G S) loses, halved for a pair |
//!
//! A step would cost candidates x N^2 if D S were multiplied out again; it is kept, with D S D^T and
//! D S G S D^T, and follows S by updates of rank 3 (6 for a pair): candidates x N.

use crate::linear_algebra::dense::{axpy, dot, mul, widest};
use crate::linear_algebra::small::{MOST, Small, SmallCholesky};

/// Two gains within this share of the larger one are equal: the lower vertex wins.
const EQUAL: f64 = 1e-9;

/// What is to become small.
#[derive(Debug, Clone, PartialEq)]
pub enum Criterion {
    /// The uncertainty of the weights.
    Information,
    /// The expected square error of the vertices tr(G S); G, N x N, is the mean over the vertices of B^T B.
    ExpectedError(Vec<f64>),
}

/// Markers that are chosen together.
#[derive(Debug, Clone, PartialEq)]
pub struct MarkerUnit {
    /// D: the rows of its markers, 3 or 6, by N, row-major.
    pub deltas: Vec<f64>,
    /// R of each of its markers, 3 x 3.
    pub covariances: Vec<[[f64; 3]; 3]>,
}

/// What is known of the weights, and what each unit would add.
#[derive(Debug, Clone)]
pub struct Greedy {
    shape_count: usize,
    criterion: Criterion,
    /// S, N x N.
    covariance: Vec<f64>,
    units: Vec<Followed>,
}

/// A unit with everything that follows S.
#[derive(Debug, Clone)]
struct Followed {
    rows: usize,
    /// D, rows x N.
    deltas: Vec<f64>,
    /// R, block-diagonal.
    noise: Small,
    /// ln det R.
    noise_log: f64,
    /// D S, rows x N.
    seen: Vec<f64>,
    /// D S D^T.
    spread: Small,
    /// D S G S D^T; 0 for information.
    told: Small,
    gone: bool,
}

/// What a unit that is taken changes, from the S before: K = D S, A = R + D S D^T.
struct Taken {
    rows: usize,
    /// D, then (for the expected error) K G: rows of N numbers.
    probes: Vec<f64>,
    /// K, rows x N.
    seen: Vec<f64>,
    /// A^-1 K, rows x N.
    gain: Vec<f64>,
    factor: SmallCholesky,
    /// A^-1 K G K^T A^-1.
    told: Small,
}

impl Greedy {
    /// Of units of N shapes; `prior` is S before any marker, N x N.
    ///
    /// # Panics
    /// If sizes disagree, or a unit has more than two markers.
    pub fn new(units: &[MarkerUnit], prior: &[f64], criterion: Criterion) -> Self {
        let n = prior.len().isqrt();
        assert_eq!(prior.len(), n * n, "the prior is N x N");
        let gram = criterion.gram();
        assert!(gram.is_none_or(|gram| gram.len() == n * n), "the Gram matrix is N x N");
        let units = units.iter().map(|unit| Followed::new(unit, n, prior, gram)).collect();
        Self { shape_count: n, criterion, covariance: prior.to_vec(), units }
    }

    /// S, N x N.
    pub fn covariance(&self) -> &[f64] {
        &self.covariance
    }

    /// tr(G S), the expected mean square error of the vertices; none for information.
    pub fn expected_square(&self) -> Option<f64> {
        self.criterion.gram().map(|gram| dot(gram, &self.covariance))
    }

    /// What a unit would gain now.
    ///
    /// # Panics
    /// If there is no such unit.
    pub fn gain(&self, unit: usize) -> f64 {
        self.units[unit].gain(self.criterion.gram().is_some())
    }

    /// What the expected square error of the vertices would rise by if a unit that S already holds were taken
    /// away again: tr((R - D S D^T)^-1 D S G S D^T), exactly, since S without it is
    /// S + S D^T (R - D S D^T)^-1 D S. Of units that S does not hold it says nothing.
    ///
    /// # Panics
    /// If there is no such unit, or the criterion is not the expected error.
    pub fn loss(&self, unit: usize) -> f64 {
        assert!(self.criterion.gram().is_some(), "the criterion is the expected error");
        self.units[unit].loss()
    }

    /// The unit that gains most, among those that are neither taken nor left out and that `may` be taken
    /// (equal gains: the earlier one), and its gain.
    pub fn best(&self, may: &dyn Fn(usize) -> bool) -> Option<(usize, f64)> {
        let free = |u: &usize| !self.units[*u].gone && may(*u);
        let gains: Vec<(usize, f64)> =
            (0..self.units.len()).filter(free).map(|u| (u, self.gain(u))).collect();
        let largest = gains.iter().fold(f64::NEG_INFINITY, |most, (_, gain)| most.max(*gain));
        gains.into_iter().find(|(_, gain)| *gain >= largest - EQUAL * largest.abs())
    }

    /// Takes a unit: S and what every other would add follow.
    ///
    /// # Panics
    /// If there is no such unit.
    pub fn take(&mut self, unit: usize) {
        let n = self.shape_count;
        let taken = Taken::of(&self.units[unit], n, self.criterion.gram());
        for i in 0..n {
            let row = &mut self.covariance[i * n..(i + 1) * n];
            for (k, gain) in taken.seen.chunks_exact(n).zip(taken.gain.chunks_exact(n)) {
                axpy(-k[i], gain, row);
            }
        }
        self.units[unit].gone = true;
        self.units.iter_mut().filter(|unit| !unit.gone).for_each(|unit| unit.follow(&taken, n));
    }

    /// Leaves a unit out of all that follows.
    ///
    /// # Panics
    /// If there is no such unit.
    pub fn leave_out(&mut self, unit: usize) {
        self.units[unit].gone = true;
    }
}

impl Criterion {
    fn gram(&self) -> Option<&[f64]> {
        match self {
            Self::Information => None,
            Self::ExpectedError(gram) => Some(gram),
        }
    }
}

impl Followed {
    fn new(unit: &MarkerUnit, n: usize, prior: &[f64], gram: Option<&[f64]>) -> Self {
        let rows = 3 * unit.covariances.len();
        assert!(
            rows <= MOST && unit.deltas.len() == rows * n,
            "one or two markers of 3 x N deltas"
        );
        let mut noise = [0.0; MOST * MOST];
        for (m, covariance) in unit.covariances.iter().enumerate() {
            for (a, row) in covariance.iter().enumerate() {
                noise[(3 * m + a) * MOST + 3 * m..][..3].copy_from_slice(row);
            }
        }
        let seen = multiplied(prior, &unit.deltas, n);
        let spread = square_of_products(&seen, &unit.deltas, n);
        let told = gram.map_or([0.0; MOST * MOST], |gram| {
            square_of_products(&multiplied(gram, &seen, n), &seen, n)
        });
        Self {
            rows,
            deltas: unit.deltas.clone(),
            noise,
            noise_log: SmallCholesky::of(&noise, rows).log_determinant(),
            seen,
            spread,
            told,
            gone: false,
        }
    }

    /// R + D S D^T.
    fn measured(&self) -> SmallCholesky {
        let mut sum = self.noise;
        sum.iter_mut().zip(&self.spread).for_each(|(r, m)| *r += m);
        SmallCholesky::of(&sum, self.rows)
    }

    fn gain(&self, of_error: bool) -> f64 {
        // A pair is worth what each of its markers adds.
        let markers = (self.rows / 3) as f64;
        if !of_error {
            return 0.5 * (self.measured().log_determinant() - self.noise_log) / markers;
        }
        let mut product = self.told;
        self.measured().solve_rows(&mut product, self.rows);
        (0..self.rows).map(|i| product[i * MOST + i]).sum::<f64>() / markers
    }

    fn loss(&self) -> f64 {
        let mut left = self.noise;
        left.iter_mut().zip(&self.spread).for_each(|(r, m)| *r -= m);
        let mut product = self.told;
        SmallCholesky::of(&left, self.rows).solve_rows(&mut product, self.rows);
        (0..self.rows).map(|i| product[i * MOST + i]).sum()
    }

    /// With C = D S D_t^T and F = D S (K G)^T: D S -= C A^-1 K, D S D^T -= C A^-1 C^T, and
    /// D S G S D^T += C A^-1 K G K^T A^-1 C^T - C A^-1 F^T - F A^-1 C^T.
    fn follow(&mut self, taken: &Taken, n: usize) {
        let (own, other) = (self.rows, taken.rows);
        let mut crossed = [0.0; MOST * MOST];
        let mut told = [0.0; MOST * MOST];
        let mut products = [0.0; 2 * MOST];
        let probes = taken.probes.len() / n;
        for (i, row) in self.seen.chunks_exact(n).enumerate() {
            mul(&taken.probes, row, &mut products[..probes]);
            crossed[i * MOST..i * MOST + other].copy_from_slice(&products[..other]);
            if probes > other {
                told[i * MOST..i * MOST + other].copy_from_slice(&products[other..probes]);
            }
        }
        let mut weights = crossed;
        taken.factor.solve_rows(&mut weights, own);
        let of_error = probes > other;
        for i in 0..own {
            for j in 0..own {
                let mut spread = 0.0;
                for k in 0..other {
                    spread += weights[i * MOST + k] * crossed[j * MOST + k];
                }
                self.spread[i * MOST + j] -= spread;
                if of_error {
                    self.told[i * MOST + j] += told_change(&crossed, &weights, &told, taken, i, j);
                }
            }
        }
        for (row, weights) in self.seen.chunks_exact_mut(n).zip(weights.chunks_exact(MOST)) {
            subtract_rows(&weights[..other], &taken.seen, row);
        }
    }
}

/// Entry i, j of C T C^T - W F^T - F W^T with T = A^-1 K G K^T A^-1 and W = C A^-1.
fn told_change(
    crossed: &Small,
    weights: &Small,
    told: &Small,
    taken: &Taken,
    i: usize,
    j: usize,
) -> f64 {
    let mut change = 0.0;
    for k in 0..taken.rows {
        let mut square = 0.0;
        for l in 0..taken.rows {
            square += taken.told[k * MOST + l] * crossed[j * MOST + l];
        }
        change += crossed[i * MOST + k] * square
            - weights[i * MOST + k] * told[j * MOST + k]
            - told[i * MOST + k] * weights[j * MOST + k];
    }
    change
}

impl Taken {
    fn of(unit: &Followed, n: usize, gram: Option<&[f64]>) -> Self {
        let (factor, rows) = (unit.measured(), unit.rows);
        let seen = unit.seen.clone();
        let mut gain = seen.clone();
        factor.solve_wide(&mut gain);
        let mut probes = unit.deltas.clone();
        let mut told = [0.0; MOST * MOST];
        if let Some(gram) = gram {
            let through = multiplied(gram, &seen, n);
            // K G K^T is symmetric: its rows, then its columns are solved for.
            told = square_of_products(&through, &seen, n);
            factor.solve_rows(&mut told, rows);
            transpose(&mut told);
            factor.solve_rows(&mut told, rows);
            probes.extend(through);
        }
        Self { rows, probes, seen, gain, factor, told }
    }
}

/// For each row of N numbers its product with a symmetric matrix.
fn multiplied(symmetric: &[f64], rows: &[f64], n: usize) -> Vec<f64> {
    let mut out = vec![0.0; rows.len()];
    rows.chunks_exact(n).zip(out.chunks_exact_mut(n)).for_each(|(x, y)| mul(symmetric, x, y));
    out
}

/// A B^T of two matrices of the same few rows of N numbers.
fn square_of_products(a: &[f64], b: &[f64], n: usize) -> Small {
    let mut out = [0.0; MOST * MOST];
    for (i, row) in a.chunks_exact(n).enumerate() {
        for (j, other) in b.chunks_exact(n).enumerate() {
            out[i * MOST + j] = dot(row, other);
        }
    }
    out
}

fn transpose(m: &mut Small) {
    for i in 0..MOST {
        for j in 0..i {
            m.swap(i * MOST + j, j * MOST + i);
        }
    }
}

widest! {
    /// row -= sum of the weights times the rows of a matrix.
    fn subtract_rows(weights: &[f64], rows: &[f64], row: &mut [f64]) {
        for (w, other) in weights.iter().zip(rows.chunks_exact(row.len())) {
            axpy(-*w, other, row);
        }
    }
}
