//! Places of markers: planted answers recovered, invariances, and each fast way beside the plain one.

#![allow(clippy::needless_range_loop, reason = "matrices read best by their indices")]

use mimique_geometry::{DVec3, Displacement, Point};
use mimique_solver::{
    ClusterMarkers, Criterion, FaceMoments, Greedy, KMeans, MarkerUnit, PivotedQr, SkinGradients,
    SkinMesh, SparseDeltas, StandsFor, TrajectoryRows, VertexTrajectories, WeightMotion,
    best_heads, farthest_first, head_error, spread_centres, stands_for_pairs,
};

use crate::support;

use mimique_test_support::Random;

/// Numbers between -1 and 1.
struct Numbers(Random);

impl Numbers {
    fn new(seed: u64) -> Self {
        Self(Random::new(seed))
    }

    fn next(&mut self) -> f64 {
        2.0 * self.0.uniform() - 1.0
    }
}

/// Rows of some numbers, without a pattern.
fn table(rows: usize, width: usize, seed: u64) -> TrajectoryRows {
    let mut numbers = Numbers::new(seed);
    let values = (0..rows * width).map(|_| numbers.next()).collect();
    TrajectoryRows { width, values }
}

/// Positive definite, n x n.
fn definite(n: usize, seed: u64) -> Vec<f64> {
    let root = table(2 * n, n, seed).values;
    let mut out = vec![0.0; n * n];
    for row in root.chunks_exact(n) {
        for i in 0..n {
            for j in 0..n {
                out[i * n + j] += row[i] * row[j] / n as f64;
            }
        }
    }
    out
}

fn square(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum()
}

/// Lloyd's steps without any bound.
fn plain_lloyd(rows: &TrajectoryRows, start: &[f64]) -> (Vec<usize>, usize) {
    let (width, mut centres) = (rows.width, start.to_vec());
    let clusters = start.len() / width;
    let mut labels = vec![usize::MAX; rows.len()];
    for iterations in 0.. {
        let nearest = |row: &[f64]| {
            (0..clusters)
                .map(|k| (square(row, &centres[k * width..(k + 1) * width]), k))
                .min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)))
                .map_or(0, |(_, k)| k)
        };
        let next: Vec<usize> = rows.iter().map(nearest).collect();
        if next == labels {
            return (labels, iterations);
        }
        labels = next;
        for k in 0..clusters {
            let own: Vec<&[f64]> =
                rows.iter().zip(&labels).filter(|(_, l)| **l == k).map(|(r, _)| r).collect();
            for c in 0..width {
                if !own.is_empty() {
                    centres[k * width + c] =
                        own.iter().map(|row| row[c]).sum::<f64>() / own.len() as f64;
                }
            }
        }
    }
    unreachable!()
}

#[test]
fn bounds_change_no_label() {
    for (rows, width, clusters, seed) in
        [(300, 7, 12, 1), (500, 40, 25, 2), (60, 3, 60, 3), (200, 1, 5, 4), (50, 20, 1, 5)]
    {
        let rows = table(rows, width, seed);
        let mut numbers = Numbers::new(seed + 100);
        let start = spread_centres(&rows, clusters, &mut || 0.5 * (numbers.next() + 1.0));
        let found = KMeans::from_centres(&rows, &start);
        let (labels, iterations) = plain_lloyd(&rows, &start);
        assert_eq!((&found.labels, found.iterations), (&labels, iterations), "{clusters} clusters");
        assert!(found.iterations > 0 && found.inertia >= 0.0);
    }
}

#[test]
fn the_start_spreads_over_planted_groups() {
    // Twelve groups far apart, each of ten rows near together: k-means++ takes one of each.
    let mut numbers = Numbers::new(8);
    let values = (0..120).flat_map(|i| {
        let group = f64::from(i % 12);
        [100.0 * group + numbers.next(), numbers.next() - 70.0 * group]
    });
    let rows = TrajectoryRows { width: 2, values: values.collect() };
    let mut draws = Numbers::new(9);
    let mut draw = || 0.5 * (draws.next() + 1.0);
    let mut hits = 0;
    for _ in 0..20 {
        let start = spread_centres(&rows, 12, &mut draw);
        let found = KMeans::from_centres(&rows, &start);
        let mut groups: Vec<usize> = (0..12).map(|i| found.labels[i]).collect();
        groups.sort_unstable();
        groups.dedup();
        hits += usize::from(groups.len() == 12);
    }
    assert!(hits >= 18, "{hits} of 20");
    // Rows that are all the same, and more clusters than rows.
    let same = TrajectoryRows { width: 2, values: [1.0, 2.0].repeat(3) };
    assert_eq!(spread_centres(&same, 5, &mut draw), [1.0, 2.0].repeat(5));
    assert_eq!(KMeans::from_centres(&same, &[1.0, 2.0].repeat(5)).labels, [0, 0, 0]);
}

/// A take of `groups` groups of vertices; those of a group move alike, each scaled and placed anew.
fn grouped_take(groups: usize, members: usize, frames: usize, seed: u64) -> (usize, Vec<f64>) {
    let mut numbers = Numbers::new(seed);
    let vertices = groups * members;
    let motion: Vec<f64> = (0..groups * frames * 3).map(|_| numbers.next()).collect();
    let place: Vec<f64> = (0..6 * vertices).map(|_| numbers.next()).collect();
    let mut positions = vec![0.0; frames * vertices * 3];
    for f in 0..frames {
        for v in 0..vertices {
            for a in 0..3 {
                let size = 1e-3 * (1.5 + place[6 * v + a]);
                positions[(f * vertices + v) * 3 + a] =
                    0.1 * place[6 * v + 3 + a] + size * motion[((v % groups) * frames + f) * 3 + a];
            }
        }
    }
    (vertices, positions)
}

#[test]
fn groups_that_move_alike_get_a_marker_each_whatever_unit_place_and_order() {
    let (vertices, positions) = grouped_take(9, 14, 40, 5);
    let order: Vec<usize> = (0..vertices).collect();
    let labels = |positions: &[f64], order: &[usize]| {
        let take = [VertexTrajectories { vertices, positions }];
        let rows = TrajectoryRows::of_trajectories(&take, order);
        // A start of a vertex of each group.
        let start: Vec<f64> = (0..9)
            .flat_map(|g| rows.row(order.iter().position(|&v| v == g).unwrap()).to_vec())
            .collect();
        KMeans::from_centres(&rows, &start).labels
    };
    let found = labels(&positions, &order);
    assert!((0..vertices).all(|v| found[v] == v % 9), "{found:?}");
    let moved: Vec<f64> =
        positions.iter().enumerate().map(|(i, x)| 37.0 * x + [3.0, -8.0, 0.5][i % 3]).collect();
    assert_eq!(labels(&moved, &order), found);
    let other: Vec<usize> = (0..vertices).map(|i| (i * 47 + 11) % vertices).collect();
    let permuted = labels(&positions, &other);
    assert!(other.iter().zip(&permuted).all(|(v, label)| found[*v] == *label));

    let take = [VertexTrajectories { vertices, positions: &positions }];
    let rows = TrajectoryRows::of_trajectories(&take, &order);
    let mut draws = Numbers::new(4);
    let start = spread_centres(&rows, 9, &mut || 0.5 * (draws.next() + 1.0));
    let clusters = KMeans::from_centres(&rows, &start);
    let each: Vec<StandsFor> = order.iter().map(|&v| StandsFor::One(v)).collect();
    let markers = ClusterMarkers::choose(&rows, &order, &clusters, &each, &|_, _| true);
    let mut groups: Vec<usize> = markers.vertices().iter().map(|v| v % 9).collect();
    groups.sort_unstable();
    assert_eq!(groups, (0..9).collect::<Vec<_>>());
    assert!(markers.without.is_empty());
}

#[test]
fn clusters_without_room_are_named_and_largest_choose_first() {
    let rows = TrajectoryRows { width: 1, values: vec![0.0, 0.1, 0.2, 5.0, 5.1, 9.0] };
    let clusters = KMeans::from_centres(&rows, &[9.0, 0.0, 5.0, 100.0]);
    let vertices = [3, 4, 5, 0, 1, 2];
    let each: Vec<StandsFor> = vertices.iter().map(|&v| StandsFor::One(v)).collect();
    let found = ClusterMarkers::choose(&rows, &vertices, &clusters, &each, &|_, _| true);
    // 0 and 1 are as near to their mean: the lower vertex.
    assert_eq!(found.chosen, [(1, vec![4]), (2, vec![0]), (0, vec![2])]);
    assert_eq!(found.without, [3]);
    let nowhere = ClusterMarkers::choose(&rows, &vertices, &clusters, &each, &|a, b| a + b != 4);
    assert_eq!(nowhere.chosen, [(1, vec![4]), (2, vec![1]), (0, vec![2])]);
}

#[test]
fn a_bank_s_own_rows_have_the_distances_of_its_trajectories() {
    let (n, vertices, frames) = (6, 40, 70);
    let mut numbers = Numbers::new(3);
    let mut deltas: Vec<f64> = (0..vertices * 3 * n).map(|_| 1e-3 * numbers.next()).collect();
    // A vertex at rest, and one that a shape moves along one axis alone.
    deltas[..3 * n].fill(0.0);
    deltas[3 * n..5 * n].fill(0.0);
    let weights: Vec<Vec<f64>> = (0..2)
        .map(|_| (0..frames * n).map(|i| if i % n == 4 { 0.3 } else { numbers.next() }).collect())
        .collect();
    let positions: Vec<Vec<f64>> = (weights.iter())
        .map(|weights| {
            (weights.chunks_exact(n))
                .flat_map(|w| {
                    deltas.chunks_exact(n).map(move |d| d.iter().zip(w).map(|(d, w)| d * w).sum())
                })
                .collect()
        })
        .collect();
    let takes: Vec<VertexTrajectories<'_>> =
        positions.iter().map(|positions| VertexTrajectories { vertices, positions }).collect();
    let every: Vec<usize> = (0..vertices).collect();
    let dense = TrajectoryRows::of_trajectories(&takes, &every);
    let people: Vec<WeightMotion> = (weights.iter())
        .map(|weights| WeightMotion { frames, covariance: covariance(weights, n) })
        .collect();
    let own = TrajectoryRows::of_bank(&deltas, n, &people);
    for i in 0..vertices {
        for j in 0..vertices {
            let expected = square(dense.row(i), dense.row(j));
            let found = square(own.row(i), own.row(j));
            assert!((expected - found).abs() < 1e-10 * (1.0 + expected), "{i} {j}");
        }
    }
    assert!(own.row(0).iter().all(|x| *x == 0.0) && dense.row(0).iter().all(|x| *x == 0.0));
}

fn covariance(weights: &[f64], n: usize) -> Vec<f64> {
    let frames = (weights.len() / n) as f64;
    let mean: Vec<f64> =
        (0..n).map(|k| weights.iter().skip(k).step_by(n).sum::<f64>() / frames).collect();
    let mut out = vec![0.0; n * n];
    for row in weights.chunks_exact(n) {
        for i in 0..n {
            for j in 0..n {
                out[i * n + j] += (row[i] - mean[i]) * (row[j] - mean[j]) / frames;
            }
        }
    }
    out
}

#[test]
fn vertices_near_the_middle_stand_for_the_middle() {
    let points = [[0.0, 0.0], [0.0, 10.0], [3.0, 9.0], [6.0, 1.0], [-6.0, 1.0], [-3.0, 9.0]];
    let points = points.map(|[x, y]| Point::new(x, y, 0.0));
    let mirror = [0, 1, 5, 4, 3, 2];
    let from_middle = points.map(|p| p.x.abs());
    let found = stands_for_pairs(&[0, 1, 2, 3], &points, &from_middle, &mirror, 8.0);
    let (one, pair) = (StandsFor::One, StandsFor::Pair);
    assert_eq!(found, [one(0), one(1), one(1), pair([3, 4])]);
    let close = stands_for_pairs(&[0, 1, 2, 3], &points, &from_middle, &mirror, 6.0);
    assert_eq!(close[2], pair([2, 5]));
    let no_middle = stands_for_pairs(&[2, 3], &points, &from_middle, &mirror, 8.0);
    assert_eq!(no_middle, [StandsFor::Nothing, pair([3, 4])]);
}

/// Units of single markers and pairs with any deltas and covariances.
fn units(count: usize, n: usize, seed: u64) -> Vec<MarkerUnit> {
    let mut numbers = Numbers::new(seed);
    (0..count)
        .map(|u| {
            let markers = 1 + u % 2;
            let deltas = (0..3 * markers * n).map(|_| numbers.next()).collect();
            let covariances = (0..markers)
                .map(|_| {
                    let r = definite(3, seed + u as u64);
                    [[r[0] + 0.1, r[1], r[2]], [r[3], r[4] + 0.1, r[5]], [r[6], r[7], r[8] + 0.1]]
                })
                .collect();
            MarkerUnit { deltas, covariances }
        })
        .collect()
}

/// (A, B) -> A B of row-major matrices with the number of columns of the first.
fn product(a: &[f64], b: &[f64], inner: usize) -> Vec<f64> {
    let width = b.len() / inner;
    let entry = |row: &[f64], j: usize| (0..inner).map(|k| row[k] * b[k * width + j]).sum::<f64>();
    a.chunks_exact(inner).flat_map(|row| (0..width).map(move |j| entry(row, j))).collect()
}

fn transposed(m: &[f64], columns: usize) -> Vec<f64> {
    (0..columns).flat_map(|j| m.iter().skip(j).step_by(columns).copied()).collect()
}

/// (R + D S D^T), its inverse times D S, and the gain of a unit, all from scratch.
fn from_scratch(unit: &MarkerUnit, s: &[f64], gram: Option<&[f64]>, n: usize) -> (Vec<f64>, f64) {
    let rows = unit.deltas.len() / n;
    let ds = product(&unit.deltas, s, n);
    let mut a = product(&ds, &transposed(&unit.deltas, n), n);
    let mut noise = vec![0.0; rows * rows];
    for (m, r) in unit.covariances.iter().enumerate() {
        for i in 0..3 {
            for j in 0..3 {
                noise[(3 * m + i) * rows + 3 * m + j] = r[i][j];
            }
        }
    }
    a.iter_mut().zip(&noise).for_each(|(a, r)| *a += r);
    let mut solved = ds.clone();
    mimique_geometry::solve_linear(&a, &mut solved, rows).unwrap();
    let lost = product(&transposed(&ds, n), &solved, rows);
    let gain = match gram {
        Some(gram) => gram.iter().zip(&lost).map(|(g, l)| g * l).sum(),
        None => 0.5 * (determinant(&a, rows) / determinant(&noise, rows)).ln(),
    };
    (lost, gain / (rows / 3) as f64)
}

/// By elimination with pivoting.
fn determinant(m: &[f64], n: usize) -> f64 {
    let (mut m, mut out) = (m.to_vec(), 1.0);
    for k in 0..n {
        let p = (k..n).max_by(|&a, &b| m[a * n + k].abs().total_cmp(&m[b * n + k].abs())).unwrap();
        if p != k {
            (0..n).for_each(|j| m.swap(k * n + j, p * n + j));
            out = -out;
        }
        out *= m[k * n + k];
        for i in k + 1..n {
            let f = m[i * n + k] / m[k * n + k];
            (k..n).for_each(|j| m[i * n + j] -= f * m[k * n + j]);
        }
    }
    out
}

#[test]
fn greedy_gains_are_those_computed_from_scratch_and_errors_only_fall() {
    let n = 11;
    let (prior, gram) = (definite(n, 21), definite(n, 22));
    for criterion in [Criterion::Information, Criterion::ExpectedError(gram.clone())] {
        let units = units(30, n, 7);
        let of_error = matches!(criterion, Criterion::ExpectedError(_)).then_some(&gram[..]);
        let mut greedy = Greedy::new(&units, &prior, criterion);
        let mut s = prior.clone();
        let mut taken: Vec<usize> = Vec::new();
        let mut last = f64::INFINITY;
        for _ in 0..9 {
            for u in (0..units.len()).filter(|u| !taken.contains(u)) {
                let (_, gain) = from_scratch(&units[u], &s, of_error, n);
                assert!((greedy.gain(u) / gain - 1.0).abs() < 1e-9, "{u}: {gain}");
            }
            let (best, gain) = greedy.best(&|_| true).unwrap();
            assert!(
                (0..units.len())
                    .all(|u| taken.contains(&u) || greedy.gain(u) <= gain * (1.0 + 1e-9))
            );
            let (lost, _) = from_scratch(&units[best], &s, of_error, n);
            s.iter_mut().zip(&lost).for_each(|(s, l)| *s -= l);
            greedy.take(best);
            taken.push(best);
            assert!(support::worst(greedy.covariance(), &s) < 1e-11);
            let now: f64 = gram.iter().zip(greedy.covariance()).map(|(g, s)| g * s).sum();
            assert!(now < last && now > 0.0);
            last = now;
        }
        if of_error.is_some() {
            assert!((greedy.expected_square().unwrap() - last).abs() < 1e-12);
        }
        assert_eq!(greedy.best(&|u| taken.contains(&u)), None);
        greedy.leave_out((0..30).find(|u| !taken.contains(u)).unwrap());
    }
}

#[test]
fn equal_gains_go_to_the_earlier_unit() {
    let unit = units(2, 5, 3)[0].clone();
    let mut greedy =
        Greedy::new(&[unit.clone(), unit.clone(), unit], &definite(5, 2), Criterion::Information);
    assert_eq!(greedy.best(&|_| true).map(|b| b.0), Some(0));
    greedy.leave_out(0);
    assert_eq!(greedy.best(&|_| true).map(|b| b.0), Some(1));
}

/// A tilted sheet of 9 x 9 vertices whose two shapes are linear in the place.
fn sheet() -> (SkinMesh, Vec<f64>, [Vec<DVec3>; 2]) {
    let (u, v) = (DVec3::new(0.8, 0.0, 0.6), DVec3::Y);
    let positions: Vec<Point> = (0..81)
        .map(|i| {
            let (a, b) = (f64::from(i % 9), f64::from(i / 9) * 1.3 + 0.1 * f64::from(i % 3));
            Point(1e-3 * (a * u + b * v))
        })
        .collect();
    let triangles = (0..64_u32)
        .flat_map(|i| {
            let at = |x: u32, y: u32| y * 9 + x;
            let (x, y) = (i % 8, i / 8);
            [[at(x, y), at(x + 1, y), at(x + 1, y + 1)], [at(x, y), at(x + 1, y + 1), at(x, y + 1)]]
        })
        .collect();
    // The slope of each shape along u and v.
    let slopes = [
        vec![DVec3::new(0.1, -0.2, 0.3), DVec3::new(0.0, 0.5, 0.1)],
        vec![DVec3::new(0.4, 0.0, -0.1), DVec3::new(-0.3, 0.2, 0.2)],
    ];
    let shapes: Vec<SparseDeltas> = (slopes.iter())
        .map(|slope| SparseDeltas {
            vertices: (0..81).collect(),
            deltas: (positions.iter())
                .map(|p| Displacement(p.dot(u) * slope[0] + p.dot(v) * slope[1] + 0.01))
                .collect(),
        })
        .collect();
    let mut deltas = vec![0.0; 81 * 3 * 2];
    for (k, shape) in shapes.iter().enumerate() {
        for (i, d) in shape.deltas.iter().enumerate() {
            (0..3).for_each(|a| deltas[(3 * i + a) * 2 + k] = d[a]);
        }
    }
    (SkinMesh { positions, triangles, shapes }, deltas, slopes)
}

#[test]
fn the_slope_of_a_linear_field_is_found_at_every_vertex() {
    let (mesh, deltas, slopes) = sheet();
    let gradients = SkinGradients::new(&mesh);
    let moment = [0.5, 0.1, 0.1, 0.3];
    let (u, v) = (DVec3::new(0.8, 0.0, 0.6), DVec3::Y);
    for vertex in 0..81 {
        let tangents = gradients.tangents(vertex).unwrap();
        let normal = gradients.normal(vertex).unwrap();
        assert!(tangents.iter().all(|t| t.dot(normal).abs() < 1e-14));
        for (gradient, t) in gradients.gradients(vertex, &deltas, 2).iter().zip(tangents) {
            for k in 0..2 {
                let expected = t.0.dot(u) * slopes[k][0] + t.0.dot(v) * slopes[k][1];
                for a in 0..3 {
                    assert!((gradient[2 * a + k] - expected[a]).abs() < 1e-12, "{vertex}");
                }
            }
        }
        let r = gradients.measurement_covariance(vertex, &deltas, &moment, [2.0, 3.0]);
        // The same by the known slopes: along u and v, since any orthogonal pair gives the same.
        for a in 0..3 {
            for b in 0..3 {
                let mut expected = if a == b { 4.0 } else { 0.0 };
                for direction in 0..2 {
                    let g = |axis: usize, k: usize| slopes[k][direction][axis];
                    for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                        expected += 9.0 * g(a, i) * moment[2 * i + j] * g(b, j);
                    }
                }
                assert!((r[a][b] - expected).abs() < 1e-10, "{vertex}");
            }
        }
    }
}

#[test]
fn pivoted_rows_are_those_of_a_projection_from_scratch() {
    let n = 8;
    let units: Vec<Vec<f64>> = (0..12).map(|u| table(3, n, 50 + u).values).collect();
    let mut qr = PivotedQr::new(units.clone(), n);
    let mut basis: Vec<Vec<f64>> = Vec::new();
    let mut chosen = Vec::new();
    for _ in 0..5 {
        if basis.len() + 3 > n {
            basis.clear();
        }
        let left = |row: &[f64]| -> Vec<f64> {
            let mut row = row.to_vec();
            for b in &basis {
                let share: f64 = row.iter().zip(b).map(|(x, y)| x * y).sum();
                row.iter_mut().zip(b).for_each(|(x, y)| *x -= share * y);
            }
            row
        };
        let worth =
            |u: usize| -> f64 { units[u].chunks_exact(n).flat_map(left).map(|x| x * x).sum() };
        let free = (0..12).filter(|u| !chosen.contains(u));
        let expected = free.max_by(|&a, &b| worth(a).total_cmp(&worth(b))).unwrap();
        assert_eq!(qr.largest(&|_| true), Some(expected));
        for row in units[expected].chunks_exact(n) {
            let mut own = row.to_vec();
            for b in &basis {
                let share: f64 = own.iter().zip(b).map(|(x, y)| x * y).sum();
                own.iter_mut().zip(b).for_each(|(x, y)| *x -= share * y);
            }
            let length = own.iter().map(|x| x * x).sum::<f64>().sqrt();
            basis.push(own.iter().map(|x| x / length).collect());
        }
        qr.take(expected);
        chosen.push(expected);
    }
    assert!(qr.largest(&|u| chosen.contains(&u)).is_none());
}

#[test]
fn the_error_of_a_head_is_that_of_its_six_numbers() {
    let mut numbers = Numbers::new(77);
    let mut points = |count: usize, size: f64| -> Vec<Point> {
        (0..count)
            .map(|_| {
                Point::from([numbers.next(), numbers.next(), numbers.next()].map(|x| size * x))
            })
            .collect()
    };
    let (heads, face) = (points(7, 90.0), points(25, 60.0));
    let found = head_error(&heads, &FaceMoments::of(&face), 0.3).unwrap();
    // J^T J and J M^-1 J^T written out.
    let centre = mimique_geometry::centroid(heads.iter().copied());
    let jacobian = |p: &Point| -> Vec<f64> {
        let [x, y, z] = (*p - centre).to_array();
        vec![1.0, 0.0, 0.0, 0.0, z, -y, 0.0, 1.0, 0.0, -z, 0.0, x, 0.0, 0.0, 1.0, y, -x, 0.0]
    };
    let mut m = vec![0.0; 36];
    for p in &heads {
        let j = jacobian(p);
        for (i, x) in product(&transposed(&j, 6), &j, 3).iter().enumerate() {
            m[i] += x;
        }
    }
    let mut sum = 0.0;
    for p in &face {
        let j = jacobian(p);
        let mut solved = transposed(&j, 6);
        mimique_geometry::solve_linear(&m, &mut solved, 6).unwrap();
        let covariance = product(&j, &solved, 6);
        sum += covariance[0] + covariance[4] + covariance[8];
    }
    let expected = 0.3 * (sum / 25.0).sqrt();
    assert!((found / expected - 1.0).abs() < 1e-12, "{found} {expected}");

    let line: Vec<Point> = (0..4).map(|i| Point::new(f64::from(i), 0.0, 0.0)).collect();
    assert_eq!(head_error(&line, &FaceMoments::of(&face), 0.3), None);
    assert_eq!(head_error(&heads[..2], &FaceMoments::of(&face), 0.3), None);
}

#[test]
fn the_heads_found_are_within_two_percent_of_the_best() {
    let mut numbers = Numbers::new(5);
    for _ in 0..5 {
        let mut point = || Point::from([0, 1, 2].map(|_| 90.0 * numbers.next()));
        let candidates: Vec<Point> = (0..11).map(|_| point()).collect();
        let face = FaceMoments::of(&(0..30).map(|_| point()).collect::<Vec<_>>());
        let error = |set: &[usize]| {
            let points: Vec<Point> = set.iter().map(|&i| candidates[i]).collect();
            head_error(&points, &face, 1.0).unwrap_or(f64::INFINITY)
        };
        let mut best = f64::INFINITY;
        for bits in 0..1_u32 << 11 {
            if bits.count_ones() == 4 {
                let set: Vec<usize> = (0..11).filter(|i| bits >> i & 1 == 1).collect();
                best = best.min(error(&set));
            }
        }
        let found = best_heads(&candidates, &face, 4, &|_, _| true).unwrap();
        assert!(error(&found) <= 1.02 * best, "{} {best}", error(&found));
    }
    let face = FaceMoments::of(&[Point::ORIGIN]);
    assert_eq!(best_heads(&[Point::ORIGIN; 5], &face, 3, &|_, _| true), None);
}

#[test]
fn farthest_points_begin_in_the_middle_and_keep_to_what_fits() {
    let units: Vec<Vec<Point>> =
        (0..11).map(|i| vec![Point::new(f64::from(i), 0.0, 0.0)]).collect();
    let any = |_: &[usize], _: usize| true;
    assert_eq!(farthest_first(&units, &[], 5, &any), [5, 0, 10, 2, 7]);
    assert_eq!(farthest_first(&units, &[Point::ORIGIN], 2, &any), [10, 5]);
    let apart = |chosen: &[usize], u: usize| chosen.iter().all(|c| c.abs_diff(u) > 4);
    assert_eq!(farthest_first(&units, &[], 9, &apart), [5, 0, 10]);
    // A pair needs two places.
    let pair = vec![vec![Point::new(9.0, 0.0, 0.0), Point::new(-9.0, 0.0, 0.0)], units[0].clone()];
    assert_eq!(farthest_first(&pair, &[], 1, &any), [1]);
}
