//! From clusters of vertices to markers: a vertex for each, or a pair of mirrored ones (thesis 3.6.1).

use mimique_geometry::Point;

use crate::layout::kmeans::KMeans;
use crate::layout::trajectory_rows::TrajectoryRows;

/// What a row of a clustering stands for where a marker is put.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StandsFor {
    /// Nothing: no marker may sit there.
    Nothing,
    /// A marker at this vertex.
    One(usize),
    /// Two markers, at a vertex and at its mirror image.
    Pair([usize; 2]),
}

impl StandsFor {
    /// The vertices, the row's own first.
    pub fn vertices(&self) -> &[usize] {
        match self {
            Self::Nothing => &[],
            Self::One(vertex) => std::slice::from_ref(vertex),
            Self::Pair(pair) => pair,
        }
    }
}

/// The markers of a clustering.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct ClusterMarkers {
    /// Cluster and vertices, in the order in which they were chosen.
    pub chosen: Vec<(usize, Vec<usize>)>,
    /// The clusters that found no room, in the order in which they looked.
    pub without: Vec<usize>,
}

impl ClusterMarkers {
    /// The vertices in the order in which they were chosen.
    pub fn vertices(&self) -> Vec<usize> {
        self.chosen.iter().flat_map(|(_, vertices)| vertices).copied().collect()
    }

    /// Of each cluster, those of most rows first (then the lower one), the row nearest to its centre (then
    /// of the lower vertex) whose markers are all `apart` from those before. `vertices` are those of the
    /// rows.
    ///
    /// # Panics
    /// Unless `vertices` and `stands_for` have an entry for each row.
    pub fn choose(
        rows: &TrajectoryRows,
        vertices: &[usize],
        clustering: &KMeans,
        stands_for: &[StandsFor],
        apart: &dyn Fn(usize, usize) -> bool,
    ) -> Self {
        assert_eq!(
            (vertices.len(), stands_for.len()),
            (rows.len(), rows.len()),
            "one for each row"
        );
        let mut members = vec![Vec::new(); clustering.clusters];
        for (row, &cluster) in clustering.labels.iter().enumerate() {
            members[cluster].push(row);
        }
        let mut order: Vec<usize> = (0..clustering.clusters).collect();
        order.sort_by_key(|&cluster| (usize::MAX - members[cluster].len(), cluster));
        let mut found = Self::default();
        let mut taken: Vec<usize> = Vec::new();
        for cluster in order {
            let centre = clustering.centre(cluster);
            let distance = |row: usize| -> f64 {
                rows.row(row).iter().zip(centre).map(|(x, c)| (x - c) * (x - c)).sum()
            };
            let mut nearest: Vec<(f64, usize)> = (members[cluster].iter())
                .filter(|&&row| stands_for[row] != StandsFor::Nothing)
                .map(|&row| (distance(row), row))
                .collect();
            let lower = |a: usize, b: usize| vertices[a].cmp(&vertices[b]);
            nearest.sort_by(|a, b| a.0.total_cmp(&b.0).then_with(|| lower(a.1, b.1)));
            let fits = |row: usize| {
                let vertices = stands_for[row].vertices();
                vertices.iter().all(|&v| taken.iter().all(|&t| apart(v, t)))
            };
            match nearest.iter().find(|(_, row)| fits(*row)) {
                Some(&(_, row)) => {
                    let markers = stands_for[row].vertices().to_vec();
                    taken.extend(&markers);
                    found.chosen.push((cluster, markers));
                }
                None => found.without.push(cluster),
            }
        }
        found
    }
}

/// What the rows of one half of a face (x >= 0) stand for: a vertex nearer to the middle than half the
/// distance that markers keep stands for the vertex in the middle (x = 0) nearest to it, any other for
/// itself and its mirror image.
///
/// `from_middle` is the distance from the middle plane, metres, 0 for vertices in it; `mirror` the mirror
/// image of each vertex. Where no vertex of the half is in the middle, those near it stand for nothing.
///
/// # Panics
/// If a vertex has no position, distance or mirror image.
pub fn stands_for_pairs(
    half: &[usize],
    positions: &[Point],
    from_middle: &[f64],
    mirror: &[usize],
    minimum_distance: f64,
) -> Vec<StandsFor> {
    let middle: Vec<usize> = half.iter().copied().filter(|&v| from_middle[v] == 0.0).collect();
    let nearest_middle = |v: usize| {
        let square = |m: &usize| (positions[*m] - positions[v]).length_squared();
        let nearer = |a: &usize, b: &usize| square(a).total_cmp(&square(b)).then(a.cmp(b));
        middle.iter().copied().min_by(nearer)
    };
    let of = |&v: &usize| {
        if from_middle[v] == 0.0 {
            return StandsFor::One(v);
        }
        match 2.0 * from_middle[v] < minimum_distance {
            true => nearest_middle(v).map_or(StandsFor::Nothing, StandsFor::One),
            false => StandsFor::Pair([v, mirror[v]]),
        }
    };
    half.iter().map(of).collect()
}
