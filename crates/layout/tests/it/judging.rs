//! Rehearsals, curves and checks: what they say is what the solver does.

use mimique_layout::{
    CheckOptions, Choice, Comparing, Conditions, Effort, ExpectedCurve, Face, FaceMotion, Judge,
    Layout, MapCheck, Method, NamedSet, Rehearsal, Silent, Trial, choose_heads, enough, enough_for,
    folds, mixed, worth,
};
use mimique_solver::{MarkerSite, Method as Solver, MethodSpec};

use crate::support::{self, EXACT, Ground, PUT};

fn farthest(ground: &Ground<'_>, count: usize) -> Vec<usize> {
    let units = ground.units(true, &[], 0.008);
    Method::Farthest.choose(&ground.task(&units), count, &Choice::default()).unwrap().vertices()
}

fn lsts(smoothing: f64) -> MethodSpec {
    let mut spec = MethodSpec::new(Solver::Lsts);
    spec.rbf_smoothing = Some(smoothing);
    spec
}

#[test]
fn expected_curves_fall_and_a_dragged_marker_gives_the_curve_from_scratch() {
    let skin = support::skin();
    let face = Face::of(&skin).unwrap();
    let ground = Ground::of(&face);
    let markers = farthest(&ground, 25);
    let mut curve = ExpectedCurve::new(&ground.motion, PUT.noise, PUT.slip);
    let first = curve.of(&face.gradients, &ground.motion, &markers);
    assert_eq!(first.len(), 26);
    assert!(first.windows(2).all(|pair| pair[1] <= pair[0] + 1e-15), "{first:?}");
    // The sixth marker is dragged to another place, and another is dropped.
    let mut dragged = markers.clone();
    dragged[5] = *ground.candidates.vertices.iter().find(|v| !markers.contains(v)).unwrap();
    dragged.remove(20);
    let followed = curve.of(&face.gradients, &ground.motion, &dragged);
    let fresh = |markers: &[usize]| {
        let mut curve = ExpectedCurve::new(&ground.motion, PUT.noise, PUT.slip);
        curve.of(&face.gradients, &ground.motion, markers)
    };
    let (without, fresh_curve) = (curve.without_each(), fresh(&dragged));
    assert_eq!(followed, fresh_curve, "the same bits");
    assert_eq!(first[..6], followed[..6]);
    assert_ne!(first[6], followed[6]);

    // The error without each marker is that of the curve of the others.
    for (place, without) in without.iter().enumerate() {
        let mut others = dragged.clone();
        others.remove(place);
        let error = fresh(&others)[others.len()];
        assert!((without - error).abs() < 1e-9 * error, "{place}: {without} {error}");
        assert!(*without >= followed[dragged.len()]);
    }
}

#[test]
fn more_goes_wrong_with_noise_and_with_hands_and_smoothing_helps_where_hands_were() {
    let skin = support::skin();
    let face = Face::of(&skin).unwrap();
    let ground = Ground::of(&face);
    let markers = farthest(&ground, 30);
    let error = |conditions: Conditions, smoothing: f64| {
        let effort = Effort { takes: 6, frames: 40 };
        let spec = lsts(smoothing);
        let rehearsal = Rehearsal::new(&face, &ground.motion, None, &spec, conditions, effort, 3);
        1e3 * rehearsal.mean_square(&markers).unwrap().sqrt()
    };
    let noisy = |noise: f64| Conditions { noise, ..EXACT };
    let (exact, some, much) = (error(EXACT, 0.0), error(noisy(3e-4), 0.0), error(noisy(1e-3), 0.0));
    assert!(exact < some && some < much, "{exact} {some} {much}");
    let (put, smoothed) = (error(PUT, 0.0), error(PUT, 0.1));
    assert!(put > 1.03 * exact, "hands cost something: {put} {exact}");
    assert!(smoothed < 0.99 * put, "smoothing saves some of it: {smoothed} {put}");
    let costs = error(EXACT, 0.1) / exact;
    assert!(costs < 1.05, "and costs nothing at exact places: {costs}");
}

#[test]
fn a_marker_meant_for_a_place_is_put_alike_whatever_else_is_worn() {
    let skin = support::skin();
    let face = Face::of(&skin).unwrap();
    let ground = Ground::of(&face);
    let markers = farthest(&ground, 20);
    let forwards = ground.rehearsal.mean_square(&markers).unwrap();
    let mut turned = markers.clone();
    turned.reverse();
    let backwards = ground.rehearsal.mean_square(&turned).unwrap();
    assert!((forwards / backwards - 1.0).abs() < 1e-9, "{forwards} {backwards}");
}

#[test]
fn what_each_marker_is_worth_adds_up_to_errors_with_and_without_it() {
    let skin = support::skin();
    let face = Face::of(&skin).unwrap();
    let ground = Ground::of(&face);
    let markers = farthest(&ground, 12);
    let found = worth(&ground.rehearsal, &markers);
    let error = |vertices: &[usize]| 1e3 * ground.rehearsal.mean_square(vertices).unwrap().sqrt();
    let all = error(&markers);
    assert_eq!(found.len(), 12);
    assert_eq!(found[11].with_those_before_mm, Some(all));
    let mut without = markers.clone();
    without.remove(4);
    assert!((found[4].missed_mm.unwrap() - (error(&without) - all)).abs() < 1e-12);
    assert_eq!(found[0].with_those_before_mm, None, "one marker tells no face");
}

#[test]
fn takes_are_left_out_in_turn_and_a_single_one_in_five_parts() {
    let skin = support::skin();
    let face = Face::of(&skin).unwrap();
    let takes = [1, 2, 3].map(|seed| support::range(&skin, &format!("person {seed}"), seed));
    let several = folds(&FaceMotion::of(&face, &takes, &[]).unwrap());
    assert_eq!(several.len(), 3);
    for (fold, take) in several.iter().zip(&takes) {
        assert_eq!(fold.name, take.name);
        assert_eq!(fold.played.people.len(), 1);
        assert_eq!(fold.learnt.people.len(), 2);
        assert!(fold.learnt.people.iter().all(|person| person.name != take.name));
    }
    let one = FaceMotion::of(&face, &takes[..1], &[]).unwrap();
    let parts = folds(&one);
    assert_eq!(parts.len(), 5);
    let frames = |motion: &FaceMotion| motion.frames().count();
    assert_eq!(parts.iter().map(|fold| frames(&fold.played)).sum::<usize>(), frames(&one));
    assert!(parts.iter().all(|f| frames(&f.played) + frames(&f.learnt) == frames(&one)));
}

#[test]
fn a_judge_s_numbers_are_those_of_its_rehearsals() {
    let skin = support::skin();
    let face = Face::of(&skin).unwrap();
    let ground = Ground::of(&face);
    let markers = farthest(&ground, 20);
    let folds = folds(&ground.motion);
    let judge = Judge::new(&face, &folds, Effort { takes: 2, frames: 30 }, 7);
    let trial = Trial { solver: lsts(0.0), conditions: EXACT };
    let by_fold: Vec<&[usize]> = folds.iter().map(|_| markers.as_slice()).collect();
    let nothing: Vec<&[usize]> = folds.iter().map(|_| &[][..]).collect();
    let found = judge.errors(&trial, &[by_fold, nothing], &Silent);
    assert!(found[1].is_none(), "no marker is no layout");
    let errors = found[0].as_ref().unwrap();
    let vertices = face.skin.mesh.positions.len() as f64;
    assert!((errors.as_printed_mm / errors.per_vertex_mm - vertices.sqrt()).abs() < 1e-9);
    assert!(
        errors.folds_mm[0] <= errors.per_vertex_mm && errors.per_vertex_mm <= errors.folds_mm[1]
    );
    assert!(errors.of_95_percent_mm >= errors.per_vertex_mm * 0.9);
    assert!(errors.worst_part_mm > errors.per_vertex_mm);
}

#[test]
fn the_least_number_within_a_tenth_is_enough() {
    let curve = [(10, 0.5), (20, 0.3), (30, 0.21), (40, 0.2), (60, 0.195)];
    assert_eq!(enough(&curve), Some(30));
    assert_eq!(enough_for(&curve, 0.35), Some(20));
    assert_eq!(enough_for(&curve, 0.1), None);
    assert_eq!(enough(&[]), None);
}

#[test]
fn a_comparison_has_every_layout_both_ways() {
    let skin = support::skin();
    let face = Face::of(&skin).unwrap();
    let ground = Ground::of(&face);
    let own = farthest(&ground, 14);
    let set = NamedSet { name: "laboratory".to_owned(), vertices: own };
    let thinned = mixed(&face).vertices;
    let whole = FaceMotion::of(&face, &[support::range(&skin, "range", 1)], &[]).unwrap();
    let comparing = Comparing {
        face: &face,
        candidates: &ground.candidates,
        distance: 0.008,
        symmetric: true,
        kept: &[],
        motion: &ground.motion,
        whole: &whole,
        conditions: PUT,
        smoothing: 0.1,
        solvers: &[lsts(0.0), MethodSpec::new(Solver::Ridge)],
        method: Method::Greedy,
        thinned: &thinned,
        counts: &[10, 16],
        sets: &[set],
        seed: 1,
        progress: &Silent,
    };
    let comparison = comparing.run().unwrap();
    assert_eq!(comparison.folds.len(), 5);
    let main = comparison.main_curve("greedy");
    assert_eq!(main.iter().map(|row| row.markers).collect::<Vec<_>>(), [10, 16]);
    assert!(main[1].errors.per_vertex_mm < main[0].errors.per_vertex_mm);
    assert!(main.iter().all(|row| row.trial.solver == "lsts" && row.trial.smoothing == 0.1));
    for name in ["kmeans", "random 1", "random 5", "laboratory"] {
        assert!(!comparison.main_curve(name).is_empty(), "{name}");
    }
    let solvers: std::collections::BTreeSet<&str> =
        comparison.recommended.iter().map(|row| row.trial.solver.as_str()).collect();
    assert_eq!(solvers.into_iter().collect::<Vec<_>>(), ["lsts", "ridge"]);
    let of = |solver: &str, layout: &str| {
        let rows = comparison.as_in_the_thesis.iter();
        rows.filter(|row| row.trial.solver == solver && row.layout == layout).count()
    };
    for solver in ["regression sparse", "regression exact"] {
        assert_eq!(
            (of(solver, "kmeans"), of(solver, "random 1"), of(solver, "laboratory")),
            (2, 2, 1)
        );
    }
    // Every row's numbers are finite, and none is twice.
    let all = || comparison.recommended.iter().chain(&comparison.as_in_the_thesis);
    assert!(all().all(|row| row.errors.per_vertex_mm.is_finite()));
    for (i, row) in comparison.recommended.iter().enumerate() {
        let same = |other: &&mimique_layout::CurveRow| {
            (&other.layout, other.markers, &other.trial) == (&row.layout, row.markers, &row.trial)
        };
        assert_eq!(comparison.recommended[i + 1..].iter().find(same), None);
    }
}

#[test]
fn a_check_names_what_markers_cannot_see() {
    let skin = support::skin();
    let face = Face::of(&skin).unwrap();
    let gaze = mimique_layout::gaze_shapes(&face);
    let motion = FaceMotion::of(&face, &[], &gaze).unwrap();
    let ground = Ground::of(&face);
    let options =
        CheckOptions { noise: 1e-4, slip: 1.5e-3, head_noise: 3e-4, smoothing: 0.1, seed: 1 };
    let check = |vertices: &[usize], heads: &[mimique_geometry::Point]| {
        let sites: Vec<MarkerSite> =
            vertices.iter().map(|&v| MarkerSite::at_vertex(format!("m{v}"), v)).collect();
        MapCheck::of(&face, &motion, &sites, heads, &options).unwrap()
    };
    let all = farthest(&ground, 40);
    let layout =
        choose_heads(&face, &ground.units(true, &[], 0.008).spacing, &all, 6, 3e-4).unwrap();
    let heads: Vec<_> = layout.vertices.iter().map(|&v| face.place(v)).collect();
    let whole = check(&all, &heads);
    // Without the mouth's markers.
    let above: Vec<usize> =
        all.iter().copied().filter(|&v| face.place(v).y > face.landmarks.subnasale.y).collect();
    let blind = check(&above, &heads[..3]);
    assert!(blind.unknown_mm > 1.5 * whole.unknown_mm);
    assert!(blind.hardly_told.iter().any(|s| s.shape == "mouthPucker" || s.shape == "mouthFunnel"));
    assert!(!whole.hardly_told.iter().any(|s| s.shape == "jawOpen"));
    assert!(
        blind.hardly_told.iter().all(|s| !s.shape.starts_with("eyeLook")),
        "the gaze is told apart"
    );
    assert!(blind.gaze.iter().any(|name| name == "eyeLookUpLeft"));
    let part = |check: &MapCheck, name: &str| {
        check.parts.iter().find(|p| p.part.name() == name).unwrap().clone()
    };
    assert!(part(&blind, "Chin").farthest_mm > part(&whole, "Chin").farthest_mm + 10.0);
    assert_eq!(part(&blind, "Mouth").markers, 0);
    assert!(part(&whole, "Mouth").unknown_mm < part(&blind, "Mouth").unknown_mm);
    let nearest = whole.nearest.as_ref().unwrap();
    assert!(nearest.at_rest_mm >= 8.0);
    // Fewer rules at fewer markers; the engine is the bank's diagnosis.
    let (rank, blind_rank) = (
        whole.bank.at_markers.as_ref().unwrap().rank,
        blind.bank.at_markers.as_ref().unwrap().rank,
    );
    assert!(blind_rank < rank);
    // Six spread head markers are the best ones; three of them on one side are told of.
    let (best, few) = (whole.head.as_ref().unwrap(), blind.head.as_ref().unwrap());
    assert!(!best.one_sided && best.error_mm.unwrap() <= 1.05 * best.best_mm.unwrap());
    assert!(few.error_mm.unwrap() > best.error_mm.unwrap());
    let placement = whole.placement.unwrap();
    assert!(placement.exact_mm < placement.smoothed_mm && placement.smoothed_mm < placement.put_mm);
}

#[test]
fn a_regression_is_rehearsed_with_and_its_kernel_is_found_once() {
    let skin = support::skin();
    let face = Face::of(&skin).unwrap();
    let ground = Ground::of(&face);
    let markers = farthest(&ground, 20);
    let spec = MethodSpec::new(Solver::Regression);
    let effort = Effort { takes: 2, frames: 30 };
    let rehearsal =
        Rehearsal::new(&face, &ground.motion, Some(&ground.motion), &spec, EXACT, effort, 1);
    let kernel = rehearsal.kernel(&markers).unwrap();
    let [length, signal, noise] = kernel.unwrap();
    assert!(length > 0.0 && signal > 0.0 && noise > 0.0);
    assert_eq!(
        rehearsal.mean_square(&markers).unwrap(),
        rehearsal.mean_square_with(&markers, kernel).unwrap()
    );
    // It learnt this very motion: less is left than half of it.
    let moved = rehearsal.mean_square(&markers).unwrap().sqrt();
    let basis = &ground.motion.basis;
    let moment = ground.motion.second_moment();
    let all: f64 = basis.gram.iter().zip(&moment).map(|(g, m)| g * m).sum();
    assert!(moved < 0.5 * all.sqrt(), "{moved} of {}", all.sqrt());
    let other = Rehearsal::new(&face, &ground.motion, None, &lsts(0.0), EXACT, effort, 1);
    assert_eq!(other.kernel(&markers).unwrap(), None);
}

#[test]
fn a_thin_shell_surface_is_rehearsed_with() {
    let skin = support::skin();
    let face = Face::of(&skin).unwrap();
    let ground = Ground::of(&face);
    let spec = MethodSpec::new(Solver::ThinShellSurface);
    let effort = Effort { takes: 1, frames: 20 };
    let rehearsal = Rehearsal::new(&face, &ground.motion, None, &spec, EXACT, effort, 1);
    let error = |count: usize| rehearsal.mean_square(&farthest(&ground, count)).unwrap().sqrt();
    let (few, many) = (error(12), error(48));
    assert!(many < few, "{many} {few}");
    let layout = Layout::named(&face, &[vec![farthest(&ground, 12)[0]]], &[]);
    assert_eq!(layout.markers.len(), 1);
}
