//! K-means clustering (Lloyd 1982; thesis 3.6.1, eq. 3.7) with the bounds of Elkan, "Using the Triangle
//! Inequality to Accelerate k-Means", ICML 2003, and the start of Arthur & Vassilvitskii, "k-means++",
//! SODA 2007.
//!
//! It is our own. `linfa-clustering` 0.8 counts the old centre as one of its rows (the mean of 0 and 1
//! from a centre at 0 is 0.333 there, where Lloyd has 0.5), and `kmeans` needs a nightly compiler. The
//! labels here are Lloyd's own: a bound only spares distances that are clearly larger, ties go to the
//! lower cluster, and all sums have one order.

use crate::layout::trajectory_rows::TrajectoryRows;
use crate::linear_algebra::dense::{axpy, widest};

/// A bound spares a distance where it is larger by this share: far above what rounding adds to bounds
/// over thousands of steps.
const CLEAR: f64 = 1e-9;
/// Steps after which a run ends that would only exchange the roundings of its centres.
const MOST_STEPS: usize = 10_000;

/// Rows in clusters.
#[derive(Debug, Clone, PartialEq)]
pub struct KMeans {
    /// K.
    pub clusters: usize,
    /// The cluster of each row.
    pub labels: Vec<usize>,
    /// K x width: the mean of each cluster's rows.
    pub centres: Vec<f64>,
    /// Steps that changed an assignment.
    pub iterations: usize,
    /// Sum of squared distances to the centres that the rows were assigned by in the last step.
    pub inertia: f64,
}

/// A step: rows assigned, centres moved.
#[derive(Debug, Clone, Copy)]
pub struct KMeansStep<'a> {
    /// The cluster of each row.
    pub labels: &'a [usize],
    /// Sum of squared distances to the centres that they were assigned by.
    pub inertia: f64,
    /// The centres after the step, K x width.
    pub centres: &'a [f64],
}

impl KMeans {
    /// Lloyd's steps from centres (K x width) until no label changes. A step assigns each row to its
    /// nearest centre, a tie to the lower cluster, and moves each centre to the mean of its rows; a cluster
    /// without rows keeps its centre.
    ///
    /// # Panics
    /// If `start` is not whole rows.
    pub fn from_centres(rows: &TrajectoryRows, start: &[f64]) -> Self {
        Self::run(rows, start, None)
    }

    /// The same, with a word at each step.
    ///
    /// # Panics
    /// If `start` is not whole rows.
    pub fn by_steps(
        rows: &TrajectoryRows,
        start: &[f64],
        each: &mut dyn FnMut(KMeansStep<'_>),
    ) -> Self {
        Self::run(rows, start, Some(each))
    }

    fn run(
        rows: &TrajectoryRows,
        start: &[f64],
        mut each: Option<&mut dyn FnMut(KMeansStep<'_>)>,
    ) -> Self {
        let width = rows.width;
        assert!(width > 0 && start.len().is_multiple_of(width), "centres are whole rows");
        let clusters = start.len() / width;
        let mut centres = start.to_vec();
        let mut before = centres.clone();
        let mut labels = vec![0; rows.len()];
        let mut bounds = Bounds::new(rows.len(), clusters);
        let mut iterations = 0;
        while bounds.assign(rows, &centres, &mut labels) && iterations < MOST_STEPS {
            iterations += 1;
            before.copy_from_slice(&centres);
            move_centres(rows, &labels, &mut centres);
            bounds.loosen(&before, &centres, width, &labels);
            if let Some(each) = &mut each {
                let inertia = inertia(rows, &labels, &before);
                each(KMeansStep { labels: &labels, inertia, centres: &centres });
            }
        }
        let inertia = inertia(rows, &labels, &before);
        Self { clusters, labels, centres, iterations, inertia }
    }

    /// The centre of a cluster.
    ///
    /// # Panics
    /// If there is no such cluster.
    pub fn centre(&self, cluster: usize) -> &[f64] {
        let width = self.centres.len() / self.clusters;
        &self.centres[cluster * width..(cluster + 1) * width]
    }
}

/// Centres to begin with (K x width): rows, the first of them any, each of the others with a probability
/// that grows with the square of its distance from the nearest one before (k-means++).
///
/// `draw` gives numbers in [0, 1). Of rows that are all chosen, or equal to chosen ones, the first that is
/// not chosen follows; with fewer rows than clusters the last centres are rows again.
///
/// # Panics
/// If there is no row.
pub fn spread_centres(
    rows: &TrajectoryRows,
    clusters: usize,
    draw: &mut dyn FnMut() -> f64,
) -> Vec<f64> {
    let count = rows.len();
    let first = ((draw() * count as f64) as usize).min(count - 1);
    let mut chosen = vec![first];
    // For each row the nearest centre and the square of its distance.
    let mut nearest: Vec<(usize, f64)> =
        rows.iter().map(|row| (0, squared(row, rows.row(first)))).collect();
    while chosen.len() < clusters {
        let total: f64 = nearest.iter().map(|(_, square)| square).sum();
        let next = if total > 0.0 {
            let mut left = draw() * total;
            let passed = nearest.iter().position(|(_, square)| {
                left -= square;
                left < 0.0
            });
            // Rounding may leave a little at the end.
            passed.or_else(|| nearest.iter().rposition(|(_, square)| *square > 0.0))
        } else {
            (0..count).find(|row| !chosen.contains(row))
        };
        let next = next.unwrap_or(chosen.len() % count);
        let new = rows.row(next);
        let place = chosen.len();
        // The new centre can only be nearer to rows whose own is not twice as near as it is to the new one.
        let apart: Vec<f64> = chosen.iter().map(|&row| squared(rows.row(row), new)).collect();
        for (row, (centre, square)) in rows.iter().zip(&mut nearest) {
            if apart[*centre] * (1.0 - CLEAR) > 4.0 * *square {
                continue;
            }
            let own = squared(row, new);
            if own < *square {
                (*centre, *square) = (place, own);
            }
        }
        chosen.push(next);
    }
    chosen.iter().flat_map(|&row| rows.row(row)).copied().collect()
}

/// What is known of the distances between rows and centres without computing them.
struct Bounds {
    clusters: usize,
    /// Rows x K: no centre is nearer than this.
    lower: Vec<f64>,
    /// The own centre is not farther than this.
    upper: Vec<f64>,
    /// Whether rows have labels.
    assigned: bool,
}

/// Whether a distance of at most `upper` is clearly smaller than one of at least `lower`.
fn clearly_below(upper: f64, lower: f64) -> bool {
    upper * (1.0 + CLEAR) < lower
}

impl Bounds {
    fn new(rows: usize, clusters: usize) -> Self {
        let (lower, upper) = (vec![0.0; rows * clusters], vec![0.0; rows]);
        Self { clusters, lower, upper, assigned: false }
    }

    /// Assigns each row to its nearest centre; whether a label changed.
    fn assign(&mut self, rows: &TrajectoryRows, centres: &[f64], labels: &mut [usize]) -> bool {
        let apart = Apart::of(centres, rows.width);
        let mut changed = !self.assigned;
        for (i, (row, label)) in rows.iter().zip(labels).enumerate() {
            let lower = &mut self.lower[i * self.clusters..(i + 1) * self.clusters];
            let upper = &mut self.upper[i];
            if self.assigned && clearly_below(*upper, apart.half_to_nearest[*label]) {
                continue;
            }
            let centre = |k: usize| &centres[k * rows.width..(k + 1) * rows.width];
            // The square of the distance to the own centre, once it is needed.
            let mut own = None;
            for k in (0..self.clusters).filter(|&k| k > 0 || self.assigned) {
                let spared = |upper: f64, label: usize, lower: f64| {
                    self.assigned && clearly_below(upper, lower.max(apart.half(label, k)))
                };
                if k == *label || spared(*upper, *label, lower[k]) {
                    continue;
                }
                let square = *own.get_or_insert_with(|| {
                    let square = squared(row, centre(*label));
                    *upper = square.sqrt();
                    lower[*label] = *upper;
                    square
                });
                if spared(*upper, *label, lower[k]) {
                    continue;
                }
                let other = squared(row, centre(k));
                lower[k] = other.sqrt();
                if other < square || other == square && k < *label {
                    (*label, own, *upper) = (k, Some(other), lower[k]);
                    changed = true;
                }
            }
        }
        self.assigned = true;
        changed
    }

    /// The centres have moved.
    fn loosen(&mut self, before: &[f64], after: &[f64], width: usize, labels: &[usize]) {
        let pairs = before.chunks_exact(width).zip(after.chunks_exact(width));
        let moved: Vec<f64> = pairs.map(|(from, to)| squared(from, to).sqrt()).collect();
        let rows = self.lower.chunks_exact_mut(self.clusters).zip(&mut self.upper);
        for ((lower, upper), &label) in rows.zip(labels) {
            for (bound, way) in lower.iter_mut().zip(&moved) {
                *bound -= way;
            }
            *upper += moved[label];
        }
    }
}

/// How far the centres are from each other.
struct Apart {
    clusters: usize,
    /// K x K, half the distance: a row nearer to the one is nearer to it than to the other.
    half: Vec<f64>,
    half_to_nearest: Vec<f64>,
}

impl Apart {
    fn of(centres: &[f64], width: usize) -> Self {
        let clusters = centres.len() / width;
        let centre = |k: usize| &centres[k * width..(k + 1) * width];
        let mut half = vec![f64::INFINITY; clusters * clusters];
        for i in 0..clusters {
            for j in 0..i {
                let distance = 0.5 * squared(centre(i), centre(j)).sqrt();
                half[i * clusters + j] = distance;
                half[j * clusters + i] = distance;
            }
        }
        let nearest = |row: &[f64]| row.iter().copied().fold(f64::INFINITY, f64::min);
        let half_to_nearest = half.chunks_exact(clusters).map(nearest).collect();
        Self { clusters, half, half_to_nearest }
    }

    fn half(&self, i: usize, j: usize) -> f64 {
        self.half[i * self.clusters + j]
    }
}

fn move_centres(rows: &TrajectoryRows, labels: &[usize], centres: &mut [f64]) {
    let width = rows.width;
    let mut sums = vec![0.0; centres.len()];
    let mut counts = vec![0_usize; centres.len() / width];
    for (row, &label) in rows.iter().zip(labels) {
        axpy(1.0, row, &mut sums[label * width..(label + 1) * width]);
        counts[label] += 1;
    }
    let clusters = centres.chunks_exact_mut(width).zip(sums.chunks_exact(width));
    for ((centre, sum), count) in clusters.zip(counts).filter(|(_, count)| *count > 0) {
        for (c, s) in centre.iter_mut().zip(sum) {
            *c = s / count as f64;
        }
    }
}

fn inertia(rows: &TrajectoryRows, labels: &[usize], centres: &[f64]) -> f64 {
    let centre = |label: usize| &centres[label * rows.width..(label + 1) * rows.width];
    rows.iter().zip(labels).map(|(row, &label)| squared(row, centre(label))).sum()
}

widest! {
    /// Square of the distance of two rows, in sixteen interleaved partial sums.
    fn squared(x: &[f64], y: &[f64]) -> f64 {
        let n = x.len();
        let y = &y[..n];
        let mut lanes = [0.0; 16];
        let (xs, x_rest) = x.as_chunks::<16>();
        let (ys, y_rest) = y.as_chunks::<16>();
        for (a, b) in xs.iter().zip(ys) {
            for k in 0..16 {
                let d = a[k] - b[k];
                lanes[k] += d * d;
            }
        }
        let mut sum = 0.0;
        for (a, b) in x_rest.iter().zip(y_rest) {
            sum += (a - b) * (a - b);
        }
        for width in [8, 4, 2, 1] {
            for k in 0..width {
                lanes[k] += lanes[k + width];
            }
        }
        sum + lanes[0]
    }
}
