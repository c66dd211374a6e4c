//! The Gaussian process: planted maps and hyper-parameters come back, the sparse form is the exact
//! one as far as its basis goes, what is far or lost is said.

use mimique_geometry::Point;
use mimique_solver::{
    ExactProcess, Fit, FitError, FrameWarning, Inference, Kernel, Learning, Method, MethodSpec,
    OperatorOptions, Operators, Regression, SkinMesh, SparseDeltas, SparseProcess, TrainingError,
    TrainingOptions, log_marginal_likelihood, maximise_likelihood,
};

use crate::support;

/// Numbers of a standard normal distribution (Box and Muller), the same on every machine.
struct Normal(u64);

impl Normal {
    fn unit(&mut self) -> f64 {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 11) as f64 + 0.5) / (1_u64 << 53) as f64
    }

    fn next(&mut self) -> f64 {
        let (a, b) = (self.unit(), self.unit());
        (-2.0 * a.ln()).sqrt() * (std::f64::consts::TAU * b).cos()
    }
}

const WIDTH: usize = 6;
const OUTPUTS: usize = 4;

/// n inputs on a curve in six dimensions with some noise, and a smooth map of them.
fn examples(n: usize, seed: u64) -> (Vec<f64>, Vec<f64>) {
    let mut normal = Normal(seed);
    let (mut x, mut y) = (Vec::new(), Vec::new());
    for i in 0..n {
        let t = i as f64 / n as f64 * 9.0 + 0.05 * normal.next();
        let point: Vec<f64> = (0..WIDTH)
            .map(|k| ((1.0 + 0.3 * k as f64) * t + k as f64).sin() + 0.3 * normal.next())
            .collect();
        y.extend((0..OUTPUTS).map(|j| smooth(&point, j)));
        x.extend(point);
    }
    (x, y)
}

fn smooth(x: &[f64], j: usize) -> f64 {
    0.5 + 0.4 * (x[j] + 0.5 * x[j + 1]).sin() * (0.4 * x[(j + 3) % WIDTH]).cos()
}

fn rms(a: &[f64], b: &[f64]) -> f64 {
    (a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>() / a.len() as f64).sqrt()
}

#[test]
fn gradient_of_the_marginal_likelihood_is_that_of_differences() {
    let (x, y) = examples(40, 3);
    for kernel in [
        Kernel { length: 1.7, signal: 0.6, noise: 0.1 },
        Kernel { length: 0.4, signal: 1.3, noise: 0.02 },
    ] {
        let (_, gradient) = log_marginal_likelihood(&x, WIDTH, &y, OUTPUTS, &kernel);
        let h: f64 = 1e-5;
        for (k, slope) in gradient.to_array().into_iter().enumerate() {
            let at = |step: f64| {
                let mut moved = [kernel.length, kernel.signal, kernel.noise];
                moved[k] *= step.exp();
                let [length, signal, noise] = moved;
                let kernel = Kernel { length, signal, noise };
                log_marginal_likelihood(&x, WIDTH, &y, OUTPUTS, &kernel).0
            };
            let difference = (at(h) - at(-h)) / (2.0 * h);
            assert!((difference / slope - 1.0).abs() < 1e-6, "{k}: {difference} {slope}");
        }
    }
}

#[test]
fn likelihood_of_one_example_is_a_normal_density() {
    // One input: y is normal with variance s_f^2 + s_n^2.
    let kernel = Kernel { length: 1.0, signal: 0.8, noise: 0.3 };
    let (value, _) = log_marginal_likelihood(&[2.0], 1, &[0.5, -0.2], 2, &kernel);
    let variance: f64 = 0.64 + 0.09;
    let density = |y: f64| -0.5 * (y * y / variance + (std::f64::consts::TAU * variance).ln());
    assert!((value - density(0.5) - density(-0.2)).abs() < 1e-14);
}

#[test]
fn planted_hyper_parameters_are_recovered() {
    // 30 draws from a process over the same 150 inputs: its Gram matrix's root times normal numbers.
    let (n, outputs) = (120, 40);
    let planted = Kernel { length: 1.6, signal: 0.35, noise: 0.03 };
    let (x, _) = examples(n, 11);
    let mut gram = vec![0.0; n * n];
    for (row, x_i) in gram.chunks_exact_mut(n).zip(x.chunks_exact(WIDTH)) {
        planted.covariances(x_i, &x, row);
    }
    (0..n).for_each(|i| gram[i * n + i] += planted.noise * planted.noise);
    let mut root = vec![0.0; n * n];
    for i in 0..n {
        for j in 0..=i {
            let s: f64 = (0..j).map(|k| root[i * n + k] * root[j * n + k]).sum();
            root[i * n + j] = if i == j {
                (gram[i * n + i] - s).sqrt()
            } else {
                (gram[i * n + j] - s) / root[j * n + j]
            };
        }
    }
    let mut normal = Normal(5);
    let mut y = vec![0.0; n * outputs];
    for j in 0..outputs {
        let z: Vec<f64> = (0..n).map(|_| normal.next()).collect();
        for i in 0..n {
            y[i * outputs + j] = (0..=i).map(|k| root[i * n + k] * z[k]).sum();
        }
    }
    let (found, value) = maximise_likelihood(&x, WIDTH, &y, outputs, [None; 3]).unwrap();
    eprintln!("planted {planted:?}, found {found:?}");
    assert!((found.length / planted.length - 1.0).abs() < 0.06);
    assert!((found.signal / planted.signal - 1.0).abs() < 0.1);
    assert!((found.noise / planted.noise - 1.0).abs() < 0.06);
    let (at_planted, _) = log_marginal_likelihood(&x, WIDTH, &y, outputs, &planted);
    let (_, gradient) = log_marginal_likelihood(&x, WIDTH, &y, outputs, &found);
    assert!(value > at_planted);
    assert!(
        gradient.to_array().iter().all(|g| g.abs() < 1e-6 * (n * outputs) as f64),
        "{gradient:?}"
    );
    // What is given stays.
    let (held, _) =
        maximise_likelihood(&x, WIDTH, &y, outputs, [Some(2.5), None, Some(0.05)]).unwrap();
    assert!((held.length - 2.5).abs() < 1e-12 && (held.noise - 0.05).abs() < 1e-12);
    assert!(maximise_likelihood(&x, WIDTH, &vec![0.0; n], 1, [None; 3]).is_none());
}

/// Mean and variance of the exact process at `x`, by its definition.
fn exact_at(exact: &ExactProcess, kernel: &Kernel, inputs: &[f64], x: &[f64]) -> (Vec<f64>, f64) {
    let n = inputs.len() / WIDTH;
    let mut k = vec![0.0; n];
    kernel.covariances(x, inputs, &mut k);
    let mean = (0..OUTPUTS)
        .map(|j| (0..n).map(|i| k[i] * exact.coefficients[i * OUTPUTS + j]).sum())
        .collect();
    let taken: f64 = (0..n * n).map(|at| k[at / n] * exact.covariance[at] * k[at % n]).sum();
    (mean, kernel.signal * kernel.signal + taken)
}

fn sparse(kernel: Kernel, x: &[f64], y: &[f64], capacity: usize) -> SparseProcess {
    let mut process = SparseProcess::new(kernel, WIDTH, OUTPUTS, capacity);
    for (x, y) in x.chunks_exact(WIDTH).zip(y.chunks_exact(OUTPUTS)) {
        process.learn(x, y);
        assert!(process.len() <= capacity);
    }
    process
}

#[test]
fn sparse_form_with_room_for_all_is_the_exact_one() {
    let kernel = Kernel { length: 1.6, signal: 0.6, noise: 0.05 };
    let (x, y) = examples(120, 7);
    let exact = ExactProcess::fit(&x, WIDTH, &y, OUTPUTS, &kernel).unwrap();
    let full = sparse(kernel, &x, &y, 120);
    assert_eq!(full.len(), 120);
    let (test, _) = examples(60, 8);
    let mut mean = [0.0; OUTPUTS];
    for x_new in test.chunks_exact(WIDTH) {
        let variance = full.predict(x_new, &mut mean);
        let (expected, expected_variance) = exact_at(&exact, &kernel, &x, x_new);
        assert!(support::worst(&mean, &expected) < 1e-8);
        assert!((variance - expected_variance).abs() < 1e-8);
    }
    // The order of the examples does not matter.
    let reversed: (Vec<f64>, Vec<f64>) = (
        x.chunks_exact(WIDTH).rev().flatten().copied().collect(),
        y.chunks_exact(OUTPUTS).rev().flatten().copied().collect(),
    );
    let other = sparse(kernel, &reversed.0, &reversed.1, 120);
    let mut backwards = [0.0; OUTPUTS];
    full.predict(&test[..WIDTH], &mut mean);
    other.predict(&test[..WIDTH], &mut backwards);
    assert!(support::worst(&mean, &backwards) < 1e-8);
    // An example seen again and again takes no place, and is believed the more.
    let mut twice = full.clone();
    let before = twice.predict(&x[..WIDTH], &mut mean);
    (0..5).for_each(|_| {
        assert_eq!(twice.learn(&x[..WIDTH], &y[..OUTPUTS]), Learning::Projected);
    });
    assert_eq!(twice.len(), 120);
    assert!(twice.predict(&x[..WIDTH], &mut mean) < before);
    assert!(support::worst(&mean, &y[..OUTPUTS]) < 0.05);
}

#[test]
fn half_the_basis_stays_near_the_exact_process() {
    let (x, y) = examples(240, 21);
    let (kernel, _) = maximise_likelihood(&x, WIDTH, &y, OUTPUTS, [None; 3]).unwrap();
    let exact = ExactProcess::fit(&x, WIDTH, &y, OUTPUTS, &kernel).unwrap();
    let (test, truth) = examples(200, 22);
    let predicted = |process: &SparseProcess| -> Vec<f64> {
        let mut mean = [0.0; OUTPUTS];
        test.chunks_exact(WIDTH)
            .flat_map(|x| {
                process.predict(x, &mut mean);
                mean
            })
            .collect()
    };
    let full: Vec<f64> =
        test.chunks_exact(WIDTH).flat_map(|t| exact_at(&exact, &kernel, &x, t).0).collect();
    let error = rms(&full, &truth);
    let half = rms(&predicted(&sparse(kernel, &x, &y, 120)), &truth);
    let tenth = rms(&predicted(&sparse(kernel, &x, &y, 24)), &truth);
    let flat = rms(&vec![0.5; truth.len()], &truth);
    eprintln!(
        "rms: exact {error:.5}, half {half:.5}, a tenth {tenth:.5}, constant {flat:.5}; {kernel:?}"
    );
    assert!(error < 0.02, "{error}");
    assert!(half < 0.03, "{half}");
    assert!(half < tenth && tenth < 0.8 * flat, "{tenth}");
}

/// A bank of three bumps and five markers, for the way through `Fit`.
fn operators() -> Operators {
    let positions: Vec<Point> =
        (0..25).map(|i| Point::new((i % 5) as f64 * 0.01, (i / 5) as f64 * 0.01, 0.0)).collect();
    let triangles = (0..16)
        .flat_map(|i| {
            let at = (i / 4 * 5 + i % 4) as u32;
            [[at, at + 1, at + 6], [at, at + 6, at + 5]]
        })
        .collect();
    let shape = |centre: usize, direction: [f64; 3]| {
        let weight = |v: usize| {
            let d = (0..2).map(|a| (positions[v][a] - positions[centre][a]).powi(2)).sum::<f64>();
            (-d / 4e-4).exp()
        };
        SparseDeltas {
            vertices: (0..25).collect(),
            deltas: (0..25).map(|v| direction.map(|d| d * weight(v)).into()).collect(),
        }
    };
    let shapes = vec![
        shape(6, [0.0, 0.002, 0.006]),
        shape(18, [0.004, 0.0, 0.003]),
        shape(12, [0.0, -0.005, 0.002]),
    ];
    let mesh = SkinMesh { positions: positions.clone(), triangles, shapes };
    let names = ["a", "b", "c"].map(String::from);
    let markers: Vec<(String, usize)> =
        [6, 8, 12, 16, 18].into_iter().enumerate().map(|(m, v)| (format!("M{m}"), v)).collect();
    Operators::build(&mesh, &names, &markers, &OperatorOptions::default()).unwrap()
}

fn displacements(operators: &Operators, c: &[f64]) -> Vec<f64> {
    let rows = operators.parts().marker_deltas.chunks_exact(c.len());
    rows.map(|row| row.iter().zip(c).map(|(d, c)| d * c).sum()).collect()
}

/// Weights that go their own ways, `n` frames.
fn range_of_motion(n: usize, phase: f64) -> Vec<f64> {
    (0..n)
        .flat_map(|f| {
            let t = f as f64 * 0.13 + phase;
            [0, 1, 2].map(|k| 0.5 + 0.5 * (t * (1.0 + 0.37 * k as f64) + k as f64).sin())
        })
        .collect()
}

fn trained(operators: &Operators, options: &TrainingOptions) -> Result<Regression, TrainingError> {
    let weights = range_of_motion(300, 0.0);
    let inputs: Vec<f64> =
        weights.chunks_exact(3).flat_map(|c| displacements(operators, c)).collect();
    Regression::train(&inputs, 15, &weights, 3, options)
}

const SPARSE: TrainingOptions = TrainingOptions { capacity: Some(80), given: [None; 3] };

#[test]
fn a_bank_is_learnt_and_what_is_far_or_lost_is_said() {
    let operators = operators();
    for options in [SPARSE, TrainingOptions { capacity: None, ..SPARSE }] {
        let model = trained(&operators, &options).unwrap();
        match options.capacity {
            Some(capacity) => assert!((10..=capacity).contains(&model.basis_count())),
            None => assert_eq!(model.basis_count(), 300),
        }
        let ready = operators.clone().with_regression(model).unwrap();
        let mut spec = MethodSpec::new(Method::Regression);
        let fit = Fit::new(&ready, &spec).unwrap();
        let truth = range_of_motion(200, 0.7);
        let d: Vec<f64> =
            truth.chunks_exact(3).flat_map(|c| displacements(&operators, c)).collect();
        let solved = fit.solve_take(&d).unwrap();
        let error = rms(&solved.weights, &truth);
        let worst = solved.reports.iter().fold(0.0_f64, |m, r| m.max(r.deviation.unwrap()));
        eprintln!("rms {error:.5}, largest deviation {worst:.4}, {options:?}");
        assert!(error < 0.004, "{error}");
        assert!(solved.reports.iter().all(|r| r.warning.is_none()));
        assert!(solved.weights.iter().all(|w| (0.0..=1.0).contains(w)));

        // Far away: the face is neutral, the deviation the prior's, and it is said.
        let far: Vec<f64> = d[..15].iter().map(|x| x + 0.3).collect();
        let found = fit.solve_frame(&far).unwrap();
        assert_eq!(found.report.warning, Some(FrameWarning::FarFromTraining));
        assert_eq!(found.weights, [0.0; 3]);
        let signal = ready.parts().regression.as_ref().unwrap().kernel.signal;
        assert!((found.report.deviation.unwrap() - signal).abs() < 1e-9);

        // A lost marker is filled in from the others, far better than by 0.
        let (mut lost, mut zeroed) = (d.clone(), d.clone());
        for frame in 0..200 {
            lost[15 * frame + 7] = f64::NAN;
            zeroed[15 * frame + 6..15 * frame + 9].fill(0.0);
        }
        let filled = fit.solve_take(&lost).unwrap();
        assert!(filled.reports.iter().all(|r| r.missing_markers == 1));
        let (with, without) =
            (rms(&filled.weights, &truth), rms(&fit.solve_take(&zeroed).unwrap().weights, &truth));
        eprintln!("marker lost: rms {with:.4}, taken for resting {without:.4}");
        assert!(with < 0.03 && with < 0.3 * without, "{with} {without}");

        spec.locked = vec!["b".into()];
        spec.bounds.insert("a".into(), [0.2, 0.4]);
        let bounded = Fit::new(&ready, &spec).unwrap().solve_take(&d).unwrap();
        assert!(
            bounded.weights.chunks_exact(3).all(|c| c[1] == 0.0 && (0.2..=0.4).contains(&c[0]))
        );
    }
}

#[test]
fn units_and_places_do_not_matter() {
    let operators = operators();
    let weights = range_of_motion(150, 0.0);
    let metres: Vec<f64> =
        weights.chunks_exact(3).flat_map(|c| displacements(&operators, c)).collect();
    let moved: Vec<f64> = metres.iter().map(|x| 1000.0 * x + 3.0).collect();
    let train = |inputs: &[f64]| Regression::train(inputs, 15, &weights, 3, &SPARSE).unwrap();
    let (a, b) = (train(&metres), train(&moved));
    assert!((a.kernel.length / b.kernel.length - 1.0).abs() < 1e-6);
    assert!((a.kernel.noise / b.kernel.noise - 1.0).abs() < 1e-6);
    assert_eq!(a.basis_count(), b.basis_count());
}

#[test]
fn training_is_the_same_every_time() {
    let operators = operators();
    assert_eq!(trained(&operators, &SPARSE).unwrap(), trained(&operators, &SPARSE).unwrap());
}

#[test]
fn bad_training_is_refused() {
    let train = |frames: usize, weights: &[f64], options: &TrainingOptions| {
        let inputs: Vec<f64> = (0..15 * frames).map(|i| (i as f64 * 0.37).sin()).collect();
        Regression::train(&inputs, 15, weights, 3, options)
    };
    let moving = range_of_motion(40, 0.0);
    assert_eq!(train(41, &moving, &SPARSE), Err(TrainingError::Frames { inputs: 41, outputs: 40 }));
    assert_eq!(train(20, &moving[..60], &SPARSE), Err(TrainingError::TooShort(20)));
    assert_eq!(train(40, &[0.0; 120], &SPARSE), Err(TrainingError::Still("the weights")));
    assert_eq!(
        Regression::train(&[0.5; 600], 15, &moving, 3, &SPARSE),
        Err(TrainingError::Still("the markers"))
    );
    let long = range_of_motion(2501, 0.0);
    let exact = TrainingOptions { capacity: None, ..SPARSE };
    assert_eq!(train(2501, &long, &exact), Err(TrainingError::TooLong(2501)));

    let operators = operators();
    let spec = MethodSpec::new(Method::Regression);
    assert_eq!(Fit::new(&operators, &spec).err(), Some(FitError::NotTrained));
    let mut model = trained(&operators, &SPARSE).unwrap();
    model.covariance.pop();
    assert!(operators.clone().with_regression(model).is_err());
    let both = MethodSpec {
        inference: Some(Inference::Exact),
        basis_vectors: Some(50),
        ..MethodSpec::new(Method::Regression)
    };
    assert!(both.validate().unwrap_err().to_string().starts_with("basisVectors: "));
}
