//! A marker, or a pair, for each cluster of trajectories (thesis 3.6.1).

use mimique_solver::{ClusterMarkers, KMeans, TrajectoryRows, spread_centres};
use rayon::prelude::*;

use super::Task;
use crate::draws::draws;

/// How a clustering is sought.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ClusterOptions {
    /// Starts of k-means++; the one with the least inertia is taken, the first of equal ones.
    pub starts: usize,
    /// The number of the first: another run has other starts.
    pub first: usize,
}

impl Default for ClusterOptions {
    fn default() -> Self {
        Self { starts: 10, first: 0 }
    }
}

/// Units in the order of their clusters' sizes.
pub(super) struct Clustered {
    pub(super) units: Vec<Vec<usize>>,
    pub(super) without_room: Vec<usize>,
}

/// Rounds in which the number of clusters is adjusted until there are as many markers as wanted.
const ROUNDS: usize = 8;

/// Units of `wanted` markers, or a few more: pairs need fewer clusters than markers.
pub(super) fn clustered(task: &Task<'_, '_>, wanted: usize, options: &ClusterOptions) -> Clustered {
    let units = task.units;
    let (vertices, stands_for) = units.clustered();
    let every = task.motion.rows(&vertices);
    let rows = if units.symmetric {
        // The mirror images have rows of their own, in the same order.
        let others: Vec<usize> = vertices.iter().map(|&v| units.face.mirror.of[v]).collect();
        every.beside(&task.motion.rows(&others))
    } else {
        every
    };
    let mut clusters = if units.symmetric { wanted.div_ceil(2) + 1 } else { wanted };
    let mut found = Clustered { units: Vec::new(), without_room: Vec::new() };
    for _ in 0..ROUNDS {
        let best = best_of_starts(&rows, clusters.min(rows.len()), options, task.seed);
        let apart = |a: usize, b: usize| units.spacing.apart(a, b);
        let chosen = ClusterMarkers::choose(&rows, &vertices, &best, &stands_for, &apart);
        let markers = chosen.vertices().len();
        found = Clustered {
            units: chosen.chosen.into_iter().map(|(_, vertices)| vertices).collect(),
            without_room: chosen.without,
        };
        if markers >= wanted || !units.symmetric || clusters >= rows.len() {
            break;
        }
        clusters += (wanted - markers).div_ceil(2);
    }
    found
}

/// The clustering of least inertia.
pub(super) fn best_of_starts(
    rows: &TrajectoryRows,
    clusters: usize,
    options: &ClusterOptions,
    seed: u64,
) -> KMeans {
    let one = |start: usize| {
        let mut draws = draws(seed, &format!("centres {start}"));
        let centres = spread_centres(rows, clusters, &mut || draws.unit());
        KMeans::from_centres(rows, &centres)
    };
    let starts = options.first..options.first + options.starts.max(1);
    let found: Vec<KMeans> = starts.into_par_iter().map(one).collect();
    let better = |best: KMeans, next: KMeans| if next.inertia < best.inertia { next } else { best };
    found.into_iter().reduce(better).unwrap_or_else(|| one(options.first))
}
