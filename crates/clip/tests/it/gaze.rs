//! The eyes rest where no gaze is given, whatever the markers on the lids do, for every method.

use mimique_clip::{MarkerTake, SegmentMarkers, solve_markers, with_gaze_at_rest};
use mimique_geometry::{Point, coordinates};
use mimique_solver::{
    Gaze, Group, MarkerSite, Method, MethodSpec, OperatorOptions, Operators, Regression, SkinMesh,
    SparseDeltas, TrainingOptions,
};

const SIDE: usize = 9;
/// The shapes of the sheet: the last two turn the eyes, in the words of two vocabularies.
const SHAPES: [&str; 4] = ["jawOpen", "eyeBlinkLeft", "eyeLookDownLeft", "AU63_L"];
/// Gaze of the take, by shape.
const GAZE: [usize; 2] = [2, 3];
const FRAMES: usize = 40;

/// A sheet of skin; a shape is a bump of its own, those of lids and gaze over each other.
fn sheet() -> SkinMesh {
    let at = |v: usize| [(v % SIDE) as f64 * 0.01, (v / SIDE) as f64 * 0.01];
    let positions = (0..SIDE * SIDE)
        .map(|v| {
            let [x, y] = at(v);
            Point::new(x, y, 0.02 - 3.0 * (x - 0.04).powi(2) - 2.0 * (y - 0.04).powi(2))
        })
        .collect();
    let corner = |v: usize| v % SIDE + 1 < SIDE;
    let triangles = (0..SIDE * (SIDE - 1))
        .filter(|&v| corner(v))
        .flat_map(|v| [[v, v + 1, v + SIDE + 1], [v, v + SIDE + 1, v + SIDE]])
        .map(|corners| corners.map(|v| v as u32))
        .collect();
    let bumps = [
        ([0.04, 0.01], -0.02),
        ([0.03, 0.06], -0.01),
        ([0.04, 0.06], -0.006),
        ([0.03, 0.07], 0.005),
    ];
    let shapes = bumps.map(|(centre, height)| {
        let mut shape = SparseDeltas::default();
        for v in 0..SIDE * SIDE {
            let [x, y] = at(v);
            let far = (x - centre[0]).powi(2) + (y - centre[1]).powi(2);
            let pushed = height * (-far / 4e-4_f64).exp();
            shape.vertices.push(v as u32);
            shape.deltas.push([0.1 * pushed, pushed, 0.3 * pushed].into());
        }
        shape
    });
    SkinMesh { positions, triangles, shapes: shapes.to_vec() }
}

/// Weights of the take: the eyes look down and up, the jaw opens.
fn truth(frame: usize) -> [f64; 4] {
    let phase = frame as f64 / FRAMES as f64 * std::f64::consts::TAU;
    let gaze = 0.9 * phase.sin();
    [0.3 - 0.3 * phase.cos(), 0.0, gaze.max(0.0), (-gaze).max(0.0)]
}

struct Take {
    operators: Operators,
    markers: SegmentMarkers,
}

impl Take {
    fn of(spec: &MethodSpec) -> Self {
        Self::named(spec, SHAPES.map(str::to_owned), truth)
    }

    /// The same with other names of the shapes, and other weights.
    fn named(spec: &MethodSpec, names: [String; 4], truth: impl Fn(usize) -> [f64; 4]) -> Self {
        let mesh = sheet();
        let vertices = [0, 8, 22, 40, 57, 58, 66, 67, 72, 80, 13];
        let sites: Vec<MarkerSite> =
            vertices.iter().map(|&v| MarkerSite::at_vertex(format!("m{v}"), v)).collect();
        let labels: Vec<String> = sites.iter().map(|site| site.label.clone()).collect();
        let options = OperatorOptions::of(spec);
        let mut operators = Operators::build_at(&mesh, &names, &sites, &options).unwrap();
        let neutral = operators.parts().marker_positions.clone();
        let mut positions = Vec::new();
        for frame in 0..FRAMES {
            let weights = truth(frame);
            for &v in &vertices {
                for a in 0..3 {
                    let moved = (0..4).map(|k| weights[k] * mesh.shapes[k].deltas[v][a]);
                    positions.push(mesh.positions[v][a] + moved.sum::<f64>());
                }
            }
        }
        if spec.method == Method::Regression {
            let rest = coordinates(&neutral);
            let width = rest.len();
            let inputs: Vec<f64> =
                positions.iter().enumerate().map(|(i, x)| x - rest[i % width]).collect();
            let outputs: Vec<f64> = (0..FRAMES).flat_map(&truth).collect();
            let options = TrainingOptions { capacity: None, given: [None; 3] };
            let learnt = Regression::train(&inputs, width, &outputs, 4, &options).unwrap();
            operators = operators.with_regression(learnt).unwrap();
        }
        let markers = SegmentMarkers {
            face: (0..labels.len()).collect(),
            labels,
            head: None,
            head_reference: vec![],
            neutral,
            scales: None,
            depth: None,
            positions,
            driven_shapes: vec![],
            driven_weights: vec![],
        };
        Self { operators, markers }
    }

    /// Largest magnitude of each shape's weight, and the shapes that are said to rest.
    fn solve(&self, spec: &MethodSpec) -> ([f64; 4], Vec<String>) {
        let take = MarkerTake { markers: &self.markers, rate_hz: 100.0, played: 0..FRAMES };
        let solved = solve_markers(&self.operators, &take, spec, &mut || 0.0).unwrap();
        let most = |k: usize| {
            solved.weights.iter().skip(k).step_by(4).fold(0.0, |most: f64, w| most.max(w.abs()))
        };
        (std::array::from_fn(most), solved.gaze_at_rest)
    }
}

#[test]
fn no_method_turns_the_eyes_by_markers_on_the_lids() {
    let mut solved = 0;
    for method in Method::ALL.into_iter().filter(|method| method.uses(Group::Shapes)) {
        let spec = MethodSpec::new(method);
        let take = Take::of(&spec);
        let (most, said) = take.solve(&spec);
        assert_eq!(GAZE.map(|k| most[k].to_bits()), [0; 2], "{method}: {most:?}");
        assert_eq!(said, GAZE.map(|k| SHAPES[k]), "{method}");
        // The literal equations hardly move anything.
        assert!(most[0] > 0.0, "{method}: the jaw is solved: {most:?}");

        // Who asks for it lets the markers turn them.
        let asked = MethodSpec { gaze: Some(Gaze::Markers), ..spec.clone() };
        let (most, said) = take.solve(&asked);
        assert!(GAZE.iter().all(|&k| most[k] > 0.0), "{method}: {most:?}");
        assert!(said.is_empty(), "{method}: {said:?}");
        if method.uses(Group::Bounds) {
            let mut bounded = spec.clone();
            bounded.bounds.insert("eyeLookDownLeft".to_owned(), [0.0, 1.0]);
            let (most, said) = take.solve(&bounded);
            assert!(most[2] > 0.0 && most[3] == 0.0, "{method}: {most:?}");
            assert_eq!(said, ["AU63_L"], "{method}");
        }
        solved += 1;
    }
    assert!(solved > 10, "{solved} methods");
}

#[test]
fn what_is_locked_or_bounded_already_stays_so() {
    let names = SHAPES.map(str::to_owned);
    let mut spec = MethodSpec::new(Method::Box);
    spec.locked = vec!["AU63_L".to_owned(), "jawOpen".to_owned()];
    let held = with_gaze_at_rest(&spec, &names);
    assert_eq!(held.locked, ["AU63_L", "jawOpen", "eyeLookDownLeft"]);
    assert_eq!(with_gaze_at_rest(&held, &names), held);
    let surface = MethodSpec::new(Method::ThinShellSurface);
    assert_eq!(with_gaze_at_rest(&surface, &names), surface);
}

/// Both eyes in ARKit's names: a frame of what a method may say of them.
#[test]
fn markers_that_are_asked_for_one_gaze_never_turn_the_eyes_apart() {
    let mut spec = MethodSpec { gaze: Some(Gaze::Markers), ..MethodSpec::new(Method::Box) };
    let names = ["eyeLookOutLeft", "eyeLookOutRight", "eyeLookUpLeft", "eyeLookUpRight"];
    let take = Take::named(&spec, names.map(str::to_owned), |_| [0.4, 0.2, 0.3, 0.1]);
    let rows = |spec: &MethodSpec| {
        let marker_take = MarkerTake { markers: &take.markers, rate_hz: 100.0, played: 0..FRAMES };
        solve_markers(&take.operators, &marker_take, spec, &mut || 0.0).unwrap()
    };
    let apart = rows(&spec);
    assert!((apart.weights[0] - 0.4).abs() < 0.02 && (apart.weights[1] - 0.2).abs() < 0.02);
    spec.gaze = Some(Gaze::Together);
    let together = rows(&spec);
    // Azimuths of 12 and -6 degrees are one of 3, which no inward shape of this bank shows on the right.
    let [out, right, up, also] = [0, 1, 2, 3].map(|k| together.weights[k]);
    assert!((out - 0.1).abs() < 0.02 && right == 0.0, "{out} {right}");
    assert!((up - also).abs() < 1e-12 && (up - 0.2).abs() < 0.02, "{up} {also}");
    // What is shown is what is measured against.
    assert!(together.reports[0].residual > apart.reports[0].residual);
}
