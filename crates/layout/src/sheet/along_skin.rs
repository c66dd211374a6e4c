//! Distances along a skin, as a tape measures them: fast marching on triangles (Kimmel & Sethian, "Computing
//! geodesic paths on manifolds", 1998).

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use mimique_geometry::Point;
use mimique_solver::SkinMesh;

/// A vertex that may be reached at a distance; the nearest comes first.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Reached {
    distance: f64,
    vertex: usize,
}

impl Eq for Reached {}

impl Ord for Reached {
    fn cmp(&self, other: &Self) -> Ordering {
        other.distance.total_cmp(&self.distance).then(other.vertex.cmp(&self.vertex))
    }
}

impl PartialOrd for Reached {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// Distances from one vertex to others of a mesh.
pub struct AlongSkin<'a> {
    mesh: &'a SkinMesh,
    around: Vec<Vec<usize>>,
}

impl<'a> AlongSkin<'a> {
    /// On a mesh.
    pub fn new(mesh: &'a SkinMesh) -> Self {
        let mut around = vec![Vec::new(); mesh.positions.len()];
        for (number, t) in mesh.triangles.iter().enumerate() {
            t.iter().for_each(|&v| around[v as usize].push(number));
        }
        Self { mesh, around }
    }

    /// The distance of every vertex from one, metres; infinite where no way leads.
    pub fn from(&self, source: usize) -> Vec<f64> {
        self.reached_from([(source, 0.0)])
    }

    /// The distance of every vertex from a point of the skin, metres; infinite where no way leads.
    pub fn from_point(&self, point: Point) -> Vec<f64> {
        let away = |v: usize| (self.mesh.positions[v] - point).length();
        let nearest = (0..self.mesh.positions.len()).min_by(|&a, &b| away(a).total_cmp(&away(b)));
        let corners = |&triangle: &usize| self.mesh.triangles[triangle].map(|v| v as usize);
        let beside = nearest.into_iter().flat_map(|v| self.around[v].iter().flat_map(corners));
        self.reached_from(beside.map(|v| (v, away(v))))
    }

    /// The distance of every vertex from the nearest of some that are at distances themselves.
    fn reached_from(&self, sources: impl IntoIterator<Item = (usize, f64)>) -> Vec<f64> {
        let count = self.mesh.positions.len();
        let mut distance = vec![f64::INFINITY; count];
        let mut fixed = vec![false; count];
        let mut next = BinaryHeap::new();
        for (vertex, away) in sources {
            distance[vertex] = away;
            next.push(Reached { distance: away, vertex });
        }
        while let Some(Reached { vertex, .. }) = next.pop() {
            if std::mem::replace(&mut fixed[vertex], true) {
                continue;
            }
            for &triangle in &self.around[vertex] {
                let corners = self.mesh.triangles[triangle].map(|v| v as usize);
                for c in corners.into_iter().filter(|&c| !fixed[c]) {
                    let others: Vec<usize> = corners.into_iter().filter(|&o| o != c).collect();
                    let found = self.across(c, [others[0], others[1]], &distance, &fixed);
                    if found < distance[c] {
                        distance[c] = found;
                        next.push(Reached { distance: found, vertex: c });
                    }
                }
            }
        }
        distance
    }

    /// The distance of a corner from those of the two others: by a front that passes through the triangle, else
    /// along an edge.
    fn across(&self, c: usize, others: [usize; 2], distance: &[f64], fixed: &[bool]) -> f64 {
        let place = |v: usize| self.mesh.positions[v];
        let edge = |v: usize| match fixed[v] {
            true => distance[v] + (place(v) - place(c)).length(),
            false => f64::INFINITY,
        };
        let along = edge(others[0]).min(edge(others[1]));
        if !(fixed[others[0]] && fixed[others[1]]) {
            return along;
        }
        front([place(others[0]), place(others[1]), place(c)], others.map(|v| distance[v]))
            .map_or(along, |through| through.min(along))
    }
}

/// The distance of the third corner from a point in the plane that is as far from the first two as they are from
/// the source; none where the straight way does not pass between them.
fn front([a, b, c]: [Point; 3], [to_a, to_b]: [f64; 2]) -> Option<f64> {
    let base = (b - a).length();
    if base.is_nan() || base <= 0.0 {
        return None;
    }
    // a at the origin, b on the first axis; the source below, c above.
    let x = (to_a * to_a - to_b * to_b + base * base) / (2.0 * base);
    let below = to_a * to_a - x * x;
    if below < 0.0 {
        return None;
    }
    let u = (b - a) / base;
    let cx = (c - a).dot(u);
    let cy = ((c - a).length_squared() - cx * cx).max(0.0).sqrt();
    let sy = below.sqrt();
    // Where the straight way from the source to c crosses the edge.
    let crossing = x + (cx - x) * sy / (sy + cy).max(f64::MIN_POSITIVE);
    let between = crossing >= 0.0 && crossing <= base;
    between.then(|| (cx - x).hypot(cy + sy))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_plane_and_a_sphere_are_measured_to_a_hundredth() {
        // A sheet of right triangles: straight distances.
        let width = 21;
        let positions: Vec<Point> = (0..width * width)
            .map(|i| Point::new((i % width) as f64, (i / width) as f64, 0.0))
            .collect();
        let at = |x: usize, y: usize| (y * width + x) as u32;
        let triangles = (0..(width - 1) * (width - 1))
            .flat_map(|i| {
                let (x, y) = (i % (width - 1), i / (width - 1));
                let (a, b, c, d) = (at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1));
                // Diagonals both ways, in turn.
                if (x + y) % 2 == 0 { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] }
            })
            .collect();
        let sheet = SkinMesh { positions, triangles, shapes: vec![] };
        let found = AlongSkin::new(&sheet).from(10 * width + 10);
        for (p, d) in sheet.positions.iter().zip(&found) {
            let straight = (*p - Point::new(10.0, 10.0, 0.0)).length();
            assert!((d - straight).abs() <= 0.02 * straight, "{p:?}: {d} {straight}");
        }

        // Half a sphere of radius 1 by latitude and longitude.
        let (rows, columns) = (40_usize, 80_usize);
        let positions: Vec<Point> = (0..=rows * columns)
            .map(|i| {
                let (row, column) = (i.div_ceil(columns), i % columns);
                let (north, east) = (
                    std::f64::consts::FRAC_PI_2 * row as f64 / rows as f64,
                    std::f64::consts::TAU * column as f64 / columns as f64,
                );
                Point::new(north.sin() * east.cos(), north.sin() * east.sin(), north.cos())
            })
            .collect();
        let ring = |row: usize, column: usize| (1 + (row - 1) * columns + column % columns) as u32;
        let mut triangles: Vec<[u32; 3]> =
            (0..columns).map(|c| [0, ring(1, c), ring(1, c + 1)]).collect();
        for row in 1..rows {
            for c in 0..columns {
                triangles.push([ring(row, c), ring(row + 1, c), ring(row + 1, c + 1)]);
                triangles.push([ring(row, c), ring(row + 1, c + 1), ring(row, c + 1)]);
            }
        }
        let sphere = SkinMesh { positions, triangles, shapes: vec![] };
        let found = AlongSkin::new(&sphere).from(0);
        for (p, d) in sphere.positions.iter().zip(&found).skip(1 + 4 * columns) {
            let arc = p.z.clamp(-1.0, 1.0).acos();
            assert!((d - arc).abs() < 0.01 * arc, "{d} {arc}");
        }
        let alone = SkinMesh { positions: vec![Point::ORIGIN; 2], ..SkinMesh::default() };
        assert_eq!(AlongSkin::new(&alone).from(0), [0.0, f64::INFINITY]);
    }
}
