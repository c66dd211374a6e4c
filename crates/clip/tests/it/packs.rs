//! Operators and take packs: what goes in comes out, damage is refused and never panics.

use mimique_avatar::pack::{open_pack, open_plain, seal_pack, seal_plain};
use mimique_clip::{
    SegmentMarkers, TakeContent, TakePack, decode_operators, decode_take, encode_operators,
    encode_take, solve_inflated, solve_packs,
};
use mimique_geometry::{DVec3, Point, coordinates};
use mimique_solver::{
    AssociatedRows, MarkerScales, Method, MethodSpec, OperatorOptions, OperatorParts, Operators,
    VertexAssociation,
};
use proptest::prelude::*;

/// Operators of 3 shapes and 5 markers, the numbers all different.
fn operators(associated: bool) -> Operators {
    let (n, p) = (3, 5);
    let numbers = |count: usize, phase: f64| -> Vec<f64> {
        (0..count).map(|i| 0.01 * (i as f64 * 1.7 + phase).sin()).collect()
    };
    let mut shell_gram = vec![0.0; n * n];
    (0..n).for_each(|i| shell_gram[i * n + i] = 0.1 + i as f64);
    let association = associated.then_some(VertexAssociation::Zones { sigma: 0.012 });
    Operators::from_parts(OperatorParts {
        options: OperatorOptions { association, ..OperatorOptions::default() },
        shape_names: ["jawOpen", "smile, left", "\u{e9}"].map(str::to_owned).to_vec(),
        marker_labels: (0..p).map(|m| format!("M{m}")).collect(),
        marker_positions: (0..p)
            .map(|m| Point::new(0.01 * m as f64, 0.02 * (m * m % 3) as f64, 0.03 * (m % 2) as f64))
            .collect(),
        vertex_count: 77,
        marker_deltas: numbers(3 * p * n, 0.3),
        shell_gram,
        associated: associated.then(|| AssociatedRows {
            association: VertexAssociation::Zones { sigma: 0.012 },
            vertex_count: 40,
            grams: numbers(p * n * (n + 1) / 2, 1.0),
            sums: numbers(3 * p * n, 2.0),
        }),
        regression: None,
    })
    .unwrap()
}

/// A take of the same markers that all sway, one with a gap.
fn take() -> TakePack {
    take_with_noise(0.0)
}

/// The same with every coordinate off by up to so much, metres.
fn take_with_noise(noise_m: f64) -> TakePack {
    let labels: Vec<String> = (0..5).map(|m| format!("M{m}")).collect();
    let rest = operators(false).parts().marker_positions.clone();
    let mut positions = Vec::new();
    for frame in 0..40 {
        for (m, p) in rest.iter().enumerate() {
            let sway = 0.004 * (f64::from(frame) * 0.1 + m as f64).sin();
            let hidden = m == 2 && (10..15).contains(&frame);
            positions.extend(p.to_array().map(|x| {
                let off = noise_m * (1e6 * (x + f64::from(frame) + sway)).sin();
                if hidden { f64::NAN } else { x + sway + off }
            }));
        }
    }
    TakePack {
        rate_hz: 59.94,
        first_frame: 705,
        played: 5..35,
        content: TakeContent::Markers(SegmentMarkers {
            labels,
            face: vec![0, 1, 2, 3, 4],
            head: Some(vec![0, 1, 4]),
            head_reference: vec![rest[0], rest[1], Point::UNSEEN],
            neutral: rest,
            scales: Some(MarkerScales {
                positive: vec![DVec3::new(1.0, 1.5, 0.75); 5],
                negative: vec![DVec3::new(1.0, 0.5, 1.25); 5],
            }),
            depth: None,
            driven_shapes: vec!["blink".to_owned(), "wide".to_owned()],
            driven_weights: (0..2 * positions.len() / 15).map(|i| i as f64 / 128.0 % 1.0).collect(),
            positions,
        }),
    }
}

#[test]
fn operators_keep_every_bit() {
    for associated in [false, true] {
        let operators = operators(associated);
        let bytes = encode_operators(&operators);
        assert_eq!(decode_operators(&bytes).unwrap(), operators);
        assert_eq!(encode_operators(&operators), bytes);
    }
}

/// What is in a pack, but for rounding, is what went in; answers the largest rounding, metres.
fn rounding(take: &TakePack) -> f64 {
    let back = decode_take(&encode_take(take)).unwrap();
    assert_eq!((back.rate_hz, back.first_frame, &back.played), (59.94, 705, &(5..35)));
    let (TakeContent::Markers(a), TakeContent::Markers(b)) = (&take.content, &back.content) else {
        panic!("markers became weights");
    };
    assert_eq!((&a.labels, &a.face, &a.head), (&b.labels, &b.face, &b.head));
    assert!(!b.head_reference[2].is_seen());
    assert_eq!((&a.head_reference[..2], &a.neutral), (&b.head_reference[..2], &b.neutral));
    let off = a.positions.iter().zip(&b.positions).map(|(x, y)| {
        assert_eq!(x.is_nan(), y.is_nan());
        if x.is_nan() { 0.0 } else { (x - y).abs() }
    });
    off.fold(0.0, f64::max)
}

#[test]
fn takes_keep_their_markers_to_a_two_hundredth_of_a_millimetre() {
    assert!(rounding(&take()) <= 0.500001e-5);
}

#[test]
fn a_take_on_the_steps_comes_back_bit_for_bit() {
    let mut take = take();
    let TakeContent::Markers(markers) = &mut take.content else { unreachable!("it is of markers") };
    markers.positions.iter_mut().for_each(|x| *x = (*x / 1e-5).round() * 1e-5 + 0.0);
    markers.driven_weights.iter_mut().for_each(|w| *w = (*w / 1e-4).round() * 1e-4 + 0.0);
    let bits = |take: &TakePack| {
        let TakeContent::Markers(m) = &take.content else { unreachable!("it is of markers") };
        let points = coordinates(&m.head_reference).iter().chain(coordinates(&m.neutral));
        let all = points.chain(&m.positions).chain(&m.driven_weights);
        all.map(|x| x.to_bits()).collect::<Vec<u64>>()
    };
    assert_eq!(bits(&decode_take(&encode_take(&take)).unwrap()), bits(&take));
}

#[test]
fn noise_is_kept_in_steps_of_its_own_size() {
    let sizes = [0.0, 2e-5, 1e-3].map(|noise| encode_take(&take_with_noise(noise)).len());
    // Half of what is typically new in a frame, which is somewhat more than the noise itself.
    let off = rounding(&take_with_noise(2e-5));
    assert!((0.7e-5..2e-5).contains(&off), "{off}");
    // However much there is: a fortieth of a millimetre.
    let most = rounding(&take_with_noise(1e-3));
    assert!((2e-5..=2.500001e-5).contains(&most), "{most}");
    assert!(sizes[1] < sizes[2], "{sizes:?}");
}

#[test]
fn recorded_weights_keep_their_range() {
    let weights: Vec<f64> = (0..60).map(|i| 1.4 * (f64::from(i) * 0.3).sin()).collect();
    let shape_names = vec!["a".to_owned(), "b".to_owned()];
    let content = TakeContent::Weights { shape_names, weights: weights.clone() };
    let take = TakePack { rate_hz: 30.0, first_frame: 0, played: 10..30, content };
    let bytes = encode_take(&take);
    // Operators are not looked at.
    let solved = solve_packs(&[], &bytes, &MethodSpec::new(Method::Recorded)).unwrap();
    assert_eq!((solved.frames(), solved.shape_names.len()), (20, 2));
    for (x, y) in weights[20..].iter().zip(&solved.weights) {
        assert!((x - y).abs() <= 0.500001e-4);
    }
}

#[test]
fn operators_that_a_browser_has_inflated_solve_with_the_same_bits() {
    let (operators, mut take) = (encode_operators(&operators(false)), take());
    let TakeContent::Markers(markers) = &mut take.content else { unreachable!("it is of markers") };
    (markers.head, markers.head_reference) = (None, vec![]);
    let take = encode_take(&take);
    let body = open_pack("MMOP", 3, &operators).unwrap();
    let inflated = [&operators[..12], &body].concat();
    let spec = MethodSpec::new(Method::Lsts);
    let solved = solve_inflated(&inflated, &take, &spec).unwrap();
    assert_eq!(solved, solve_packs(&operators, &take, &spec).unwrap());
    let error = solve_inflated(&operators, &take, &spec).unwrap_err().to_string();
    assert!(error.contains("MMOP") && error.contains("declared"), "{error}");
}

#[test]
fn packs_that_do_not_belong_together_are_refused() {
    let (operators, mut take) = (encode_operators(&operators(false)), take());
    let spec = MethodSpec::new(Method::Lsts);
    let swapped = solve_packs(&encode_take(&take), &operators, &spec).unwrap_err().to_string();
    assert!(swapped.contains("MMTK") && swapped.contains("MMOP"), "{swapped}");
    let TakeContent::Markers(markers) = &mut take.content else { return };
    markers.labels[3] = "other".to_owned();
    let error = solve_packs(&operators, &encode_take(&take), &spec).unwrap_err().to_string();
    assert!(error.contains("marker M3"), "{error}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(500))]

    #[test]
    fn damage_is_refused_or_harmless(at in 0usize..5000, value: u8, cut: bool, associated: bool) {
        let spec = MethodSpec::new(if associated { Method::Kouadio } else { Method::Lsts });
        let packs = [("MMOP", encode_operators(&operators(associated))), ("MMTK", encode_take(&take()))];
        for (kind, whole) in &packs {
            let operators = *kind == "MMOP";
            let body = match operators {
                true => open_pack(kind, 3, whole).unwrap(),
                false => open_plain(kind, 6, whole).unwrap().to_vec(),
            };
            for (bytes, sealed) in [(whole.clone(), false), (body, true)] {
                let mut damaged = bytes;
                let at = at % damaged.len();
                if cut { damaged.truncate(at) } else { damaged[at] = value }
                let damaged = match (sealed, operators) {
                    (false, _) => damaged,
                    (true, true) => seal_pack(kind, 3, &damaged),
                    (true, false) => seal_plain(kind, 6, &damaged),
                };
                // Neither unpacking nor solving may panic, whatever comes of it.
                let [(_, operators), (_, take)] = &packs;
                let _ = match *kind {
                    "MMOP" => solve_packs(&damaged, take, &spec),
                    _ => solve_packs(operators, &damaged, &spec),
                };
            }
        }
    }
}
