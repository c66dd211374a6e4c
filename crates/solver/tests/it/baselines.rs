//! The baselines of other groups: optima certified by the equations of their papers, written here again.

use std::cmp::Ordering;

use mimique_geometry::Point;
use mimique_solver::{
    Fit, FrameWarning, LOOK_AHEAD, Method, MethodSpec, OperatorOptions, OperatorParts, Operators,
    TakeSolution, WINDOW_FRAMES,
};
use proptest::prelude::*;

use crate::support;

const NAMES: [&str; 9] = [
    "jawOpen",
    "jawLeft",
    "jawRight",
    "mouthSmile_L",
    "mouthSmile_R",
    "eyeLookInLeft",
    "eyeLookOutLeft",
    "cheekPuff",
    "browInnerUp",
];
const N: usize = NAMES.len();
const P: usize = 14;

/// Numbers in -1..1 of a seed.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }
}

/// Markers and shapes at random, metres; `jawRight` undoes `jawLeft`, and looking out looking in; each
/// side of the smile moves half of the markers.
fn bank(seed: u64) -> Operators {
    let mut numbers = Numbers(seed);
    for _ in 0..20 {
        numbers.next();
    }
    let mut marker_deltas = vec![0.0; 3 * P * N];
    for (at, row) in marker_deltas.chunks_exact_mut(N).enumerate() {
        for x in row.iter_mut() {
            *x = 0.006 * numbers.next();
        }
        row[2] = -0.9 * row[1] + 0.0005 * numbers.next();
        row[6] = -0.8 * row[5] + 0.001 * numbers.next();
        // The two sides of the smile move markers of their own: at random, one seed in some 1,600 has
        // them against each other, and they would be a pair that cancels.
        row[if at / 3 < P / 2 { 4 } else { 3 }] = 0.0;
    }
    let mut shell_gram = vec![0.0; N * N];
    shell_gram.iter_mut().step_by(N + 1).for_each(|x| *x = 1e-4);
    Operators::from_parts(OperatorParts {
        options: OperatorOptions::default(),
        shape_names: NAMES.map(str::to_owned).to_vec(),
        marker_labels: (0..P).map(|m| format!("M{m}")).collect(),
        marker_positions: (0..P).map(|m| Point::new(0.01 * m as f64, 0.0, 0.0)).collect(),
        vertex_count: 1000,
        marker_deltas,
        shell_gram,
        associated: None,
        regression: None,
    })
    .unwrap()
}

/// D c and noise, metres, of a course of weights that leaves the box now and then.
fn take(operators: &Operators, frames: usize, seed: u64) -> Vec<f64> {
    let mut numbers = Numbers(seed ^ 0x5eed);
    let phases: Vec<f64> = (0..N).map(|_| 3.0 * numbers.next()).collect();
    let mut d = Vec::new();
    for frame in 0..frames {
        let c: Vec<f64> =
            phases.iter().map(|p| 0.3 + 0.8 * (0.09 * frame as f64 + 2.0 * p).sin()).collect();
        for row in operators.parts().marker_deltas.chunks_exact(N) {
            let moved: f64 = row.iter().zip(&c).map(|(d, c)| d * c).sum();
            d.push(moved + 1e-3 * numbers.next());
        }
    }
    d
}

fn solve(operators: &Operators, spec: &MethodSpec, d: &[f64]) -> TakeSolution {
    Fit::new(operators, spec).unwrap().solve_take(d).unwrap()
}

/// D^T D / l^2 and D^T d / l^2.
fn normal_equations(operators: &Operators, d: &[f64]) -> ([[f64; N]; N], [f64; N]) {
    let (mut q, mut b) = ([[0.0; N]; N], [0.0; N]);
    for (row, d) in operators.parts().marker_deltas.chunks_exact(N).zip(d) {
        for i in 0..N {
            b[i] += row[i] * d / operators.data_scale();
            for j in 0..N {
                q[i][j] += row[i] * row[j] / operators.data_scale();
            }
        }
    }
    (q, b)
}

/// How far the weight may still move from `c` against its slope, within bounds.
fn step(c: f64, slope: f64, curvature: f64, [low, high]: [f64; 2]) -> f64 {
    ((c - slope / curvature).clamp(low, high) - c).abs()
}

/// The largest such step of a frame.
fn kkt(q: &[[f64; N]; N], b: &[f64; N], c: &[f64], bounds: &[[f64; 2]; N]) -> f64 {
    (0..N).fold(0.0, |worst, i| {
        let slope = (0..N).fold(-b[i], |s, j| s + q[i][j] * c[j]);
        f64::max(worst, step(c[i], slope, q[i][i], bounds[i]))
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, ..ProptestConfig::default() })]

    #[test]
    fn sparse_meets_its_conditions(seed in 0..100_000_u64, lambda in 0.0..0.5_f64) {
        let operators = bank(seed);
        let d = take(&operators, 12, seed);
        let spec = MethodSpec { lambda: Some(lambda), ..MethodSpec::new(Method::Sparse) };
        let solved = solve(&operators, &spec, &d);
        for (d, c) in d.chunks_exact(3 * P).zip(solved.weights.chunks_exact(N)) {
            let (q, b) = normal_equations(&operators, d);
            let error = kkt(&q, &b.map(|b| b - lambda), c, &[[0.0, 1.0]; N]);
            prop_assert!(error < 1e-10, "{error:e}");
        }
    }

    #[test]
    fn audio2face_meets_its_conditions_frame_after_frame(
        seed in 0..100_000_u64,
        balanced in any::<bool>(),
        strengths in prop::array::uniform4(0.0..1.0_f64),
    ) {
        let operators = bank(seed);
        let d = take(&operators, 30, seed);
        let [l1, l2, y, t] = strengths;
        let (l1, l2, y, t) = (4.0 * l1, 8.0 * l2, 150.0 * y, 0.6 * t);
        let method = if balanced { Method::A2fBalanced } else { Method::A2f };
        let spec = MethodSpec {
            l1: Some(l1), l2: Some(l2), symmetry: Some(y), temporal: Some(t),
            ..MethodSpec::new(method)
        };
        let solved = solve(&operators, &spec, &d);
        let mut last = [0.0; N];
        for ((d, c), report) in
            d.chunks_exact(3 * P).zip(solved.weights.chunks_exact(N)).zip(&solved.reports)
        {
            // G is 2030 cm^2 on the mean diagonal of a mesh, and s is 1.
            let (mut a, mut b) = normal_equations(&operators, d);
            for i in 0..N {
                for entry in a[i].iter_mut() {
                    *entry = 2030.0 * *entry + 0.25 * l1 * l1;
                }
                a[i][i] += 10.0 * l2 + 100.0 * t;
                b[i] = 2030.0 * b[i] + if balanced { 100.0 } else { 1.0 } * t * last[i];
            }
            // The smile has two sides; of the jaw and of the eye one way goes at a time.
            a[3][3] += 10.0 * y;
            a[4][4] += 10.0 * y;
            a[3][4] -= 10.0 * y;
            a[4][3] -= 10.0 * y;
            prop_assert!(c[1] == 0.0 || c[2] == 0.0, "{c:?}");
            prop_assert!(c[5] == 0.0 || c[6] == 0.0, "{c:?}");
            // Where both rest, either may be the one that is held.
            let weaker = |[i, j]: [usize; 2]| match c[i].total_cmp(&c[j]) {
                Ordering::Less => vec![i],
                Ordering::Equal => vec![i, j],
                Ordering::Greater => vec![j],
            };
            let mut error = f64::INFINITY;
            for jaw in weaker([1, 2]) {
                for eye in weaker([5, 6]) {
                    let mut bounds = [[0.0, 1.0]; N];
                    (bounds[jaw], bounds[eye]) = ([0.0; 2], [0.0; 2]);
                    error = error.min(kkt(&a, &b, c, &bounds));
                }
            }
            prop_assert!(error < 1e-10 && report.kkt_error < 1e-10, "{error:e} {report:?}");
            prop_assert_eq!(report.warning, None);
            last.copy_from_slice(c);
        }
    }

    #[test]
    fn smooth_sparse_meets_its_conditions_over_the_window(
        seed in 0..100_000_u64,
        mu in 0.001..3.0_f64,
        lambda in 0.0..0.1_f64,
        frames in 1..60_usize,
    ) {
        let operators = bank(seed);
        let mut d = take(&operators, frames, seed);
        // A marker is lost for some frames.
        for frame in frames / 3..frames / 2 {
            d[frame * 3 * P + 7] = f64::NAN;
        }
        let spec = MethodSpec {
            mu: Some(mu), lambda: Some(lambda), ..MethodSpec::new(Method::SmoothSparse)
        };
        let solved = solve(&operators, &spec, &d);
        let error = window_kkt(&operators, &d, &solved.weights, lambda, mu);
        prop_assert!(error < 1e-10, "{error:e}");
        prop_assert!(solved.reports.iter().all(|r| r.warning.is_none() && r.kkt_error < 1e-10));
    }

    #[test]
    fn greedy_takes_one_shape_after_the_other(seed in 0..100_000_u64) {
        let operators = bank(seed);
        let d = take(&operators, 1, seed);
        let found = solve(&operators, &MethodSpec::new(Method::Greedy), &d).weights;
        let (q, mut along) = normal_equations(&operators, &d);
        let mut order: Vec<usize> = (0..N).collect();
        order.sort_by(|&i, &j| q[j][j].total_cmp(&q[i][i]));
        for k in order {
            let c = (along[k] / q[k][k]).clamp(0.0, 1.0);
            prop_assert!((found[k] - c).abs() < 1e-11, "{k}: {} {c}", found[k]);
            (0..N).for_each(|i| along[i] -= c * q[i][k]);
        }
    }

    #[test]
    fn markers_in_another_order_and_unit_change_nothing(
        seed in 0..100_000_u64,
        method in prop::sample::select(vec![
            Method::A2f, Method::A2fBalanced, Method::Sparse, Method::SmoothSparse, Method::Greedy,
        ]),
        unit in prop::sample::select(vec![1.0, 0.1, 0.001]),
        order in Just((0..P).collect::<Vec<_>>()).prop_shuffle(),
    ) {
        let operators = bank(seed);
        let d = take(&operators, 8, seed);
        let mut parts = operators.parts().clone();
        parts.marker_labels = order.iter().map(|&m| format!("M{m}")).collect();
        let rows = |m: usize| 3 * m * N..3 * (m + 1) * N;
        let old = &operators.parts().marker_deltas;
        parts.marker_deltas =
            order.iter().flat_map(|&m| old[rows(m)].iter().map(|x| unit * x)).collect();
        let other: Vec<f64> = d
            .chunks_exact(3 * P)
            .flat_map(|d| order.iter().flat_map(move |&m| d[3 * m..3 * m + 3].iter()))
            .map(|x| unit * x)
            .collect();
        let spec = MethodSpec::new(method);
        let a = solve(&operators, &spec, &d).weights;
        let b = solve(&Operators::from_parts(parts).unwrap(), &spec, &other).weights;
        prop_assert!(support::worst(&a, &b) < 1e-10);
    }
}

/// The largest step of any weight of a take against the slope of the whole objective.
fn window_kkt(operators: &Operators, d: &[f64], c: &[f64], lambda: f64, mu: f64) -> f64 {
    let frames = c.len() / N;
    let deltas = &operators.parts().marker_deltas;
    let difference = |t: usize, k: usize| {
        let x = |t: usize| c[t * N + k];
        if t == 0 || t + 1 >= frames { 0.0 } else { x(t - 1) - 2.0 * x(t) + x(t + 1) }
    };
    let mut worst = 0.0_f64;
    for t in 0..frames {
        let (d, own) = (&d[t * 3 * P..(t + 1) * 3 * P], &c[t * N..(t + 1) * N]);
        let seen = |row: usize| d[row / 3 * 3..row / 3 * 3 + 3].iter().all(|x| x.is_finite());
        for k in 0..N {
            let (mut slope, mut curvature) = (lambda, 0.0);
            for row in (0..3 * P).filter(|&row| seen(row)) {
                let deltas = &deltas[row * N..(row + 1) * N];
                let moved: f64 = deltas.iter().zip(own).map(|(a, b)| a * b).sum();
                slope += deltas[k] * (moved - d[row]) / operators.data_scale();
                curvature += deltas[k] * deltas[k] / operators.data_scale();
            }
            // d/dc of mu times the three squares that the weight is in.
            let parts = [(t.checked_sub(1), 1.0), (Some(t), -2.0), (Some(t + 1), 1.0)];
            for (around, factor) in parts {
                let Some(around) = around.filter(|&a| a >= 1 && a + 1 < frames) else { continue };
                slope += 2.0 * mu * factor * difference(around, k);
                curvature += 2.0 * mu * factor * factor;
            }
            worst = worst.max(step(own[k], slope, curvature, [0.0, 1.0]));
        }
    }
    worst
}

#[test]
fn sparse_uses_fewer_shapes_the_more_they_cost() {
    let operators = bank(5);
    let d = take(&operators, 60, 5);
    let used = |lambda| {
        let spec = MethodSpec { lambda: Some(lambda), ..MethodSpec::new(Method::Sparse) };
        solve(&operators, &spec, &d).weights.iter().filter(|c| **c > 0.0).count()
    };
    let counts = [0.0, 0.1, 0.4, 1.5].map(used);
    assert!(counts.windows(2).all(|pair| pair[0] > pair[1]), "{counts:?}");
    // For nothing it is `box`.
    let spec = MethodSpec { lambda: Some(0.0), ..MethodSpec::new(Method::Sparse) };
    let (free, plain) = (solve(&operators, &spec, &d), MethodSpec::new(Method::Box));
    assert_eq!(free.weights, solve(&operators, &plain, &d).weights);
}

/// Going from shape to shape, as in the paper, comes to the same weights.
#[test]
fn sparse_is_what_coordinate_descent_ends_at() {
    let operators = bank(17);
    let d = take(&operators, 1, 17);
    let spec = MethodSpec::new(Method::Sparse);
    let (found, lambda) = (solve(&operators, &spec, &d).weights, spec.lambda());
    let (q, b) = normal_equations(&operators, &d);
    let mut c = [0.0; N];
    for _ in 0..20_000 {
        for k in 0..N {
            let rest = (0..N).filter(|&i| i != k).fold(0.0, |s, i| s + q[k][i] * c[i]);
            c[k] = ((b[k] - lambda - rest) / q[k][k]).clamp(0.0, 1.0);
        }
    }
    assert!(support::worst(&found, &c) < 1e-10, "{found:?} {c:?}");
}

#[test]
fn audio2face_as_shipped_draws_to_rest_and_balanced_holds_still() {
    let operators = bank(3);
    // A pose that is held: the weights of both settle, those of the balanced form at the pose without T.
    // (Which of a pair is the weaker one depends on the last frame, so none is in doubt here.)
    let planted = [0.5, 0.6, 0.0, 0.45, 0.3, 0.7, 0.0, 0.2, 0.35];
    let rows = operators.parts().marker_deltas.chunks_exact(N);
    let pose: Vec<f64> =
        rows.map(|row| row.iter().zip(&planted).map(|(d, c)| d * c).sum()).collect();
    let d: Vec<f64> = pose.iter().copied().cycle().take(pose.len() * 400).collect();
    let end = |method, temporal| {
        let spec = MethodSpec { temporal: Some(temporal), ..MethodSpec::new(method) };
        let solved = solve(&operators, &spec, &d);
        solved.weights[399 * N..].to_vec()
    };
    let without = end(Method::A2f, 0.0);
    assert_eq!(without, end(Method::A2fBalanced, 0.0));
    let balanced = end(Method::A2fBalanced, 0.5);
    assert!(support::worst(&balanced, &without) < 1e-9, "{balanced:?} {without:?}");
    let shipped = end(Method::A2f, 0.5);
    let sum = |c: &[f64]| c.iter().sum::<f64>();
    assert!(sum(&shipped) < 0.999 * sum(&without), "{shipped:?} {without:?}");
}

#[test]
fn windows_follow_one_another_without_a_seam() {
    let operators = bank(8);
    let frames = 2 * WINDOW_FRAMES + LOOK_AHEAD + 50;
    let d = take(&operators, frames, 8);
    let spec = MethodSpec { mu: Some(0.5), ..MethodSpec::new(Method::SmoothSparse) };
    let solved = solve(&operators, &spec, &d);
    assert!(solved.reports.iter().all(|r| r.warning.is_none() && r.kkt_error < 1e-10));
    // The conditions of the whole take hold at the seams but for what lies beyond the look-ahead.
    let error = window_kkt(&operators, &d, &solved.weights, spec.lambda(), spec.mu());
    assert!(error < 1e-8, "{error:e}");
    // One window where it fits, and its answer is what the first of several keeps.
    let fits = (WINDOW_FRAMES + LOOK_AHEAD) * 3 * P;
    let one = solve(&operators, &spec, &d[..fits]);
    assert!(window_kkt(&operators, &d[..fits], &one.weights, spec.lambda(), spec.mu()) < 1e-10);
    assert_eq!(one.weights[..WINDOW_FRAMES * N], solved.weights[..WINDOW_FRAMES * N]);
    // Smoother than frame by frame.
    let rough = |c: &[f64]| -> f64 {
        (2 * N..c.len()).map(|i| (c[i] - 2.0 * c[i - N] + c[i - 2 * N]).powi(2)).sum()
    };
    let alone = solve(&operators, &MethodSpec::new(Method::Sparse), &d);
    assert!(rough(&solved.weights) < 0.5 * rough(&alone.weights));
}

#[test]
fn without_second_differences_a_window_is_its_frames() {
    let operators = bank(21);
    let d = take(&operators, 40, 21);
    let spec = MethodSpec { mu: Some(0.0), ..MethodSpec::new(Method::SmoothSparse) };
    let frames = solve(&operators, &MethodSpec::new(Method::Sparse), &d);
    assert_eq!(solve(&operators, &spec, &d).weights, frames.weights);
    // A single frame has no second difference.
    let spec = MethodSpec::new(Method::SmoothSparse);
    let one = solve(&operators, &spec, &d[..3 * P]).weights;
    assert!(support::worst(&one, &frames.weights[..N]) < 1e-12);
}

#[test]
fn a_frame_that_makes_no_sums_is_said_and_harms_no_other() {
    let operators = bank(4);
    let mut d = take(&operators, 20, 4);
    let spec = MethodSpec::new(Method::SmoothSparse);
    d[10 * 3 * P..11 * 3 * P].fill(f64::MAX);
    let solved = solve(&operators, &spec, &d);
    for (frame, report) in solved.reports.iter().enumerate() {
        let expected = (frame == 10).then_some(FrameWarning::NotConverged);
        assert_eq!(report.warning, expected, "{frame}");
    }
    // It lies where its neighbours lead.
    assert!(solved.weights.iter().all(|c| (0.0..=1.0).contains(c)));
}
