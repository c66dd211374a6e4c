//! Expressions planted one after the other in long takes are found again.

use mimique_actor::{Clip, Emotion, HeadSpec, build_head, marker_sites, synthetic_take};
use mimique_geometry::coordinates;
use mimique_mocap::{Capture, LengthUnit, WeightOptions, read_weights, stabilise};
use mimique_stimulus::{
    AvatarSkin, Channels, MarkerMap, SuggestOptions, Suggestion, TakeOptions, TakeSegment, cut,
    read_segments, solve_take, suggest,
};

const EMOTIONS: [Emotion; 6] = [
    Emotion::Anger,
    Emotion::Disgust,
    Emotion::Fear,
    Emotion::Joy,
    Emotion::Sadness,
    Emotion::Surprise,
];

/// Mean and least overlap of the found segments with the planted ones, one by one.
fn overlaps(found: &[TakeSegment], truth: &[TakeSegment]) -> (f64, f64) {
    let labels = |of: &[TakeSegment]| -> Vec<_> {
        of.iter().map(|s| (s.label.clone(), s.expression.clone())).collect()
    };
    assert_eq!(found.len(), truth.len(), "{:?}\n{:?}", labels(found), labels(truth));
    let all: Vec<f64> = found.iter().zip(truth).map(|(f, t)| f.overlap(t)).collect();
    (all.iter().sum::<f64>() / all.len() as f64, all.iter().copied().fold(1.0, f64::min))
}

fn of(values: &[f64], count: usize, rate_hz: f64) -> Suggestion {
    of_named(values, count, rate_hz, &[])
}

fn of_named(values: &[f64], count: usize, rate_hz: f64, names: &[String]) -> Suggestion {
    suggest(Channels { values, count, rate_hz, names }, &SuggestOptions::default()).unwrap()
}

/// The 18 performances in one take, by the built-in head; what was planted.
fn long_take() -> (mimique_actor::SyntheticTake, Vec<TakeSegment>) {
    let clips: Vec<Clip> = EMOTIONS
        .into_iter()
        .flat_map(|emotion| (1..=3).map(move |intensity| Clip { emotion, intensity, seed: 5 }))
        .collect();
    let spec = HeadSpec::default();
    let take = synthetic_take(&build_head(&spec), &marker_sites(&spec), &clips, 11, 0.1);
    let n = take.shape_names.len();
    // The clips have neutral of their own at both ends: what is planted is where weights move.
    let truth = take
        .segments
        .iter()
        .map(|s| {
            let level =
                |f: usize| take.truth[f * n..(f + 1) * n].iter().map(|w| w.abs()).sum::<f64>();
            let most = (s.first..s.end).map(level).fold(0.0, f64::max);
            let moving: Vec<usize> = (s.first..s.end).filter(|&f| level(f) > 0.03 * most).collect();
            TakeSegment::new("planted", moving[0]..moving[moving.len() - 1] + 1)
        })
        .collect();
    (take, truth)
}

#[test]
fn eighteen_built_in_performances_in_one_take_from_weights() {
    let (take, truth) = long_take();
    let names = &take.shape_names;
    let found = of_named(&take.truth, names.len(), take.rate_hz, names);
    let (mean, least) = overlaps(&found.segments, &truth);
    eprintln!("from weights: mean overlap {mean:.3}, least {least:.3}");
    assert!(mean > 0.93 && least > 0.85, "{mean} {least}");
    let timeline = found.timeline();
    assert!(timeline.energy.len() <= 2000 && timeline.energy.len() == timeline.level.len());
    assert_eq!(timeline.segments.len(), 18);
    assert!((timeline.duration_s - take.frames() as f64 / take.rate_hz).abs() < 1e-9);
    // Every clip gets the neutral that there is before it.
    let clips = cut(&found.segments, take.frames(), take.rate_hz, 0.2, 0.2);
    for (clip, segment) in clips.iter().zip(&found.segments) {
        assert!(clip.clip.start < segment.expression.start || segment.expression.start == 0);
        assert!(clip.clip.end > segment.expression.end || segment.expression.end == take.frames());
    }
}

#[test]
fn eighteen_built_in_performances_in_one_take_from_markers() {
    let (take, truth) = long_take();
    let mut capture = Capture {
        labels: take.labels.clone(),
        rate_hz: take.rate_hz,
        first_frame: 0,
        unit: LengthUnit::Millimetre,
        positions: take.positions.iter().map(|&p| p.into()).collect(),
        notes: Vec::new(),
    };
    stabilise(&mut capture, &take.head_labels).unwrap();
    let values = coordinates(&capture.positions);
    let found = of(values, 3 * capture.labels.len(), take.rate_hz);
    let (mean, least) = overlaps(&found.segments, &truth);
    eprintln!("from markers: mean overlap {mean:.3}, least {least:.3}");
    assert!(mean > 0.85 && least > 0.65, "{mean} {least}");
}

#[test]
fn an_expression_that_becomes_another_without_neutral_is_two() {
    // Neutral, shape 0 held, over into shape 1 held, neutral; 100 Hz.
    let ramp = |f: f64, at: f64| ((f - at) / 25.0).clamp(0.0, 1.0);
    let smooth = |t: f64| t * t * (3.0 - 2.0 * t);
    let values: Vec<f64> = (0..600)
        .map(f64::from)
        .flat_map(|f| {
            let first = smooth(ramp(f, 100.0)) - smooth(ramp(f, 250.0));
            let second = smooth(ramp(f, 250.0)) - smooth(ramp(f, 400.0));
            [first, second, 0.0]
        })
        .collect();
    let found = of(&values, 3, 100.0);
    let truth = [TakeSegment::new("", 100..262), TakeSegment::new("", 262..425)];
    let (_, least) = overlaps(&found.segments, &truth);
    assert!(least > 0.9, "{:?}", found.segments);
    assert_eq!(found.borders.iter().filter(|b| (255..270).contains(*b)).count(), 1);
}

#[test]
fn a_still_face_has_no_expression_and_short_takes_are_refused() {
    let values: Vec<f64> = (0..400).map(|f| 0.001 * f64::from(f % 3)).collect();
    assert!(of(&values, 1, 100.0).segments.len() <= 1);
    let take = |frames: usize| Channels {
        values: &values[..frames],
        count: 1,
        rate_hz: 100.0,
        names: &[],
    };
    let error = suggest(take(50), &SuggestOptions::default()).unwrap_err().to_string();
    assert_eq!(error, "take: 50 frames of 1 channels; give a take of a second or more");
    let options = SuggestOptions { neutral: Some(390..401), ..SuggestOptions::default() };
    let error = suggest(take(400), &options).unwrap_err().to_string();
    assert_eq!(error, "neutral frames 390:401 of 400; give a range inside the take");
}

#[test]
fn the_segments_of_the_planted_capture() {
    let Some(data) = mimique_test_support::real_data("the_segments_of_the_planted_capture") else {
        return;
    };
    let text = std::fs::read_to_string(data.join("lsts/segments.csv")).unwrap();
    let truth = read_segments(&text).unwrap();
    assert_eq!(truth.len(), 18);
    let planted = read_weights(
        &std::fs::read(data.join("lsts/truth.csv")).unwrap(),
        &WeightOptions { rate_hz: Some(200.0), ..WeightOptions::default() },
    )
    .unwrap();
    let avatar =
        mimique_avatar_files::read_avatar(&data.join("lsts/avatar_skin.glb")).unwrap().avatar;
    let skin = AvatarSkin::of(&avatar).unwrap();
    let capture = mimique_mocap::read(&data.join("lsts/take_n01.csv")).unwrap();
    let map =
        MarkerMap::from_text(&std::fs::read_to_string(data.join("lsts/mapping.csv")).unwrap())
            .unwrap();
    let spec = mimique_solver::MethodSpec::new(mimique_solver::Method::Lsts);
    let options = TakeOptions::default();
    let solved = solve_take(&skin, &capture, &map, &spec, &options, &mut || 0.0).unwrap();
    // The neutral is found in one of the pauses between expressions.
    let [first, end] = solved.report.neutral;
    let middle = (first + end) / 2;
    assert!(
        truth.iter().all(|s| !s.clip.contains(&middle)),
        "neutral {first}:{end} {:?}",
        solved.report.warnings
    );
    for (name, table) in [("planted weights", &planted), ("solved weights", &solved.table)] {
        let names = &table.shape_names;
        let found = of_named(&table.weights, names.len(), 200.0, names);
        let (mean, least) = overlaps(&found.segments, &truth);
        eprintln!("{name}: mean overlap {mean:.3}, least {least:.3}");
        assert!(mean > 0.85 && least > 0.7, "{name}: {mean} {least}");
    }
}
