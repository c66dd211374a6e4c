//! Quads of a cage in `k x k` where `k` is no power of two: the smooth surface of a finer subdivision,
//! read off at other places.

use super::vec3::Vec3;
use std::collections::BTreeMap;

/// Up to four finer vertices with their shares, which add up to 1.
type Mix = [(u32, f64); 4];

/// Where the vertices and quads of one density come from in a finer subdivision.
pub(crate) struct Resampled {
    /// Quads over the new vertices; quad `f` of the cage becomes quads `k k f .. k k (f + 1)`.
    pub quads: Vec<[u32; 4]>,
    /// A new vertex: the cage's own first, then those on the cage's edges, then those inside.
    mixes: Vec<Mix>,
}

impl Resampled {
    /// `finer`: the quads of `cage` after halving their sides until `halved` lie along each; `across`
    /// shall lie there.
    pub(crate) fn new(
        cage_vertices: usize,
        cage: &[[u32; 4]],
        finer: &[[u32; 4]],
        halved: usize,
        across: usize,
    ) -> Resampled {
        let mut out = Resampled {
            quads: Vec::with_capacity(cage.len() * across * across),
            mixes: (0..cage_vertices as u32).map(own).collect(),
        };
        let mut edges: BTreeMap<(u32, u32), u32> = BTreeMap::new();
        let row = across + 1;
        for (f, corners) in cage.iter().enumerate() {
            let grid = Grid::new(f, finer, halved);
            let mut here = vec![u32::MAX; row * row];
            let at = |i: usize, j: usize| j * row + i;
            for (place, corner) in corners_of(across).into_iter().zip(corners) {
                here[at(place[0], place[1])] = *corner;
            }
            for k in 0..4 {
                let (from, to) = (corners[k], corners[(k + 1) % 4]);
                let ends = corners_of(across);
                let (start, end) = (ends[k], ends[(k + 1) % 4]);
                // An edge has one order of its vertices, whichever of its two quads comes first.
                let (low, first, last) =
                    if from < to { ((from, to), start, end) } else { ((to, from), end, start) };
                let along = |n: usize| {
                    [0, 1].map(|axis| (first[axis] * (across - n) + last[axis] * n) / across)
                };
                let base = *edges.entry(low).or_insert_with(|| {
                    let base = out.mixes.len() as u32;
                    out.mixes.extend((1..across).map(|n| grid.at(along(n), across)));
                    base
                });
                for n in 1..across {
                    let [i, j] = along(n);
                    here[at(i, j)] = base + n as u32 - 1;
                }
            }
            for j in 1..across {
                for i in 1..across {
                    here[at(i, j)] = out.mixes.len() as u32;
                    out.mixes.push(grid.at([i, j], across));
                }
            }
            for j in 0..across {
                for i in 0..across {
                    let quad = [[i, j], [i + 1, j], [i + 1, j + 1], [i, j + 1]];
                    out.quads.push(quad.map(|[i, j]| here[at(i, j)]));
                }
            }
        }
        out
    }

    /// Number of new vertices.
    pub(crate) fn len(&self) -> usize {
        self.mixes.len()
    }

    /// A channel of the finer vertices on the new ones.
    pub(crate) fn values(&self, finer: &[Vec3]) -> Vec<Vec3> {
        let mixed = |mix: &Mix| {
            let mut sum = Vec3::default();
            for &(v, share) in mix {
                sum += finer[v as usize] * share;
            }
            sum
        };
        self.mixes.iter().map(mixed).collect()
    }
}

fn own(vertex: u32) -> Mix {
    [(vertex, 1.0), (vertex, 0.0), (vertex, 0.0), (vertex, 0.0)]
}

/// The corners of a square of that side, in the order of a quad's.
fn corners_of(side: usize) -> [[usize; 2]; 4] {
    [[0, 0], [side, 0], [side, side], [0, side]]
}

/// The finer vertices of one quad of the cage, row by row.
struct Grid {
    side: usize,
    vertices: Vec<u32>,
}

impl Grid {
    fn new(cage_quad: usize, finer: &[[u32; 4]], side: usize) -> Grid {
        let mut grid = Grid { side, vertices: vec![u32::MAX; (side + 1) * (side + 1)] };
        grid.fill(cage_quad, finer, side, corners_of(side));
        grid
    }

    /// A quad of a step becomes four of the next: corner, edge after it, middle, edge before it.
    fn fill(&mut self, quad: usize, finer: &[[u32; 4]], size: usize, corners: [[usize; 2]; 4]) {
        if size == 1 {
            for (place, vertex) in corners.into_iter().zip(finer[quad]) {
                self.vertices[place[1] * (self.side + 1) + place[0]] = vertex;
            }
            return;
        }
        let between = |a: [usize; 2], b: [usize; 2]| [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2];
        let middle = between(corners[0], corners[2]);
        for k in 0..4 {
            let after = between(corners[k], corners[(k + 1) % 4]);
            let before = between(corners[k], corners[(k + 3) % 4]);
            self.fill(4 * quad + k, finer, size / 2, [corners[k], after, middle, before]);
        }
    }

    /// What lies at `place` of a grid of `across` quads a side: bilinear between four vertices.
    fn at(&self, place: [usize; 2], across: usize) -> Mix {
        let [i, j] = place.map(|p| (p * self.side / across).min(self.side - 1));
        let [x, y] = [(place[0], i), (place[1], j)]
            .map(|(p, low)| (p * self.side) as f64 / across as f64 - low as f64);
        let vertex = |i: usize, j: usize| self.vertices[j * (self.side + 1) + i];
        [
            (vertex(i, j), (1.0 - x) * (1.0 - y)),
            (vertex(i + 1, j), x * (1.0 - y)),
            (vertex(i + 1, j + 1), x * y),
            (vertex(i, j + 1), (1.0 - x) * y),
        ]
    }
}
