//! Built-in performances and the synthetic capture of them.

use mimique_actor::{
    Clip, Emotion, HeadSpec, Identity, Performance, SHAPE_NAMES, SyntheticTake, build_head,
    marker_sites, performance_weights, synthetic_take,
};
use mimique_avatar::Avatar;

fn names() -> Vec<String> {
    SHAPE_NAMES.iter().map(|s| s.to_string()).collect()
}

fn all_clips(seed: u64) -> Vec<Clip> {
    Emotion::ALL
        .into_iter()
        .flat_map(|emotion| (1..=3).map(move |intensity| Clip { emotion, intensity, seed }))
        .collect()
}

fn peak(p: &Performance, shape: &str) -> f64 {
    let k = SHAPE_NAMES.iter().position(|s| *s == shape).expect("shape exists");
    (0..p.frames()).map(|f| p.frame(f)[k]).fold(0.0, f64::max)
}

#[test]
fn clips_go_from_neutral_over_the_expression_to_neutral() {
    for seed in 0..20 {
        for clip in all_clips(seed) {
            let p = performance_weights(&names(), &clip, 60.0, 4.0);
            assert_eq!(p.frames(), 240);
            assert!(p.weights.iter().all(|w| (0.0..=1.0).contains(w)), "{clip:?}");
            for f in [0, 1, 2, 237, 238, 239] {
                let most = p.frame(f).iter().copied().fold(0.0, f64::max);
                assert!(most < 1e-3, "{clip:?} frame {f}: {most}");
            }
            let rest = p.head[0];
            assert!(rest.rotation.iter().chain(&rest.translation).all(|v| v.abs() < 1e-9));
        }
    }
}

#[test]
fn weights_have_no_jumps() {
    for clip in all_clips(4) {
        let p = performance_weights(&names(), &clip, 200.0, 4.0);
        for f in 1..p.frames() {
            for (name, (w, before)) in SHAPE_NAMES.iter().zip(p.frame(f).iter().zip(p.frame(f - 1)))
            {
                let step = (w - before).abs();
                // A blink shuts in 90 ms: at most 1.875 / 18 a frame of 5 ms.
                assert!(step < 0.12, "{clip:?} {name} frame {f}: {step}");
            }
        }
    }
}

#[test]
fn each_emotion_uses_its_action_units_and_grows_with_intensity() {
    let units: [(Emotion, &[&str]); 6] = [
        (Emotion::Joy, &["cheekSquintLeft", "mouthSmileLeft", "mouthSmileRight"]),
        (Emotion::Sadness, &["browInnerUp", "browDownLeft", "mouthFrownLeft"]),
        (
            Emotion::Fear,
            &[
                "browInnerUp",
                "browOuterUpLeft",
                "browDownRight",
                "eyeWideLeft",
                "mouthStretchLeft",
                "jawOpen",
            ],
        ),
        (Emotion::Anger, &["browDownLeft", "eyeWideLeft", "eyeSquintLeft", "mouthPressLeft"]),
        (
            Emotion::Disgust,
            &["noseSneerLeft", "mouthUpperUpLeft", "mouthFrownLeft", "mouthShrugLower"],
        ),
        (Emotion::Surprise, &["browInnerUp", "browOuterUpLeft", "eyeWideLeft", "jawOpen"]),
    ];
    for (emotion, shapes) in units {
        let play = |intensity| {
            performance_weights(&names(), &Clip { emotion, intensity, seed: 9 }, 60.0, 4.0)
        };
        let strong = [play(1), play(2), play(3)];
        for shape in shapes {
            let [a, b, c] = [0, 1, 2].map(|i| peak(&strong[i], shape));
            assert!(a > 0.04 && b > 1.3 * a && c > 1.2 * b, "{emotion:?} {shape}: {a} {b} {c}");
        }
    }
}

/// Both raise brows and upper lids; fear draws the brows together, tenses the lower lids and stretches
/// the lips (AU 4, 7, 20), surprise drops the jaw (AU 26).
#[test]
fn fear_is_not_surprise() {
    let play = |emotion| {
        performance_weights(&names(), &Clip { emotion, intensity: 3, seed: 9 }, 60.0, 4.0)
    };
    let (fear, surprise) = (play(Emotion::Fear), play(Emotion::Surprise));
    for shape in ["browDownLeft", "eyeSquintLeft", "mouthStretchLeft"] {
        assert!(peak(&fear, shape) > 0.2, "{shape}: {}", peak(&fear, shape));
        assert_eq!(peak(&surprise, shape), 0.0, "{shape}");
    }
    assert!(peak(&surprise, "jawOpen") > 4.0 * peak(&fear, "jawOpen"));
    assert_eq!(peak(&fear, "mouthSmileLeft"), 0.0);
}

fn course(p: &Performance, shape: &str) -> Vec<f64> {
    let k = SHAPE_NAMES.iter().position(|s| *s == shape).expect("shape exists");
    (0..p.frames()).map(|f| p.frame(f)[k]).collect()
}

/// When a course first is above a share of its peak and when it last is, seconds.
fn above(course: &[f64], share: f64, rate_hz: f64) -> [f64; 2] {
    let most = course.iter().copied().fold(0.0, f64::max);
    let first = course.iter().position(|w| *w >= share * most).expect("a peak");
    let last = course.iter().rposition(|w| *w >= share * most).expect("a peak");
    [first, last].map(|f| f as f64 / rate_hz)
}

/// A shape of each emotion that neither blinks nor gaze touch.
const LEADING: [(Emotion, &str); 6] = [
    (Emotion::Joy, "mouthSmile"),
    (Emotion::Sadness, "mouthFrown"),
    (Emotion::Fear, "mouthStretch"),
    (Emotion::Anger, "browDown"),
    (Emotion::Disgust, "noseSneer"),
    (Emotion::Surprise, "browOuterUp"),
];

#[test]
fn faces_come_faster_than_they_go() {
    for (emotion, stem) in LEADING {
        let [mut up, mut down] = [0.0, 0.0];
        for seed in 0..20 {
            let clip = Clip { emotion, intensity: 3, seed };
            let p = performance_weights(&names(), &clip, 400.0, 4.0);
            let left = course(&p, &format!("{stem}Left"));
            let (low, high) = (above(&left, 0.1, 400.0), above(&left, 0.9, 400.0));
            let (attack, release) = (high[0] - low[0], low[1] - high[1]);
            assert!(release > attack, "{clip:?}: up in {attack} s, down in {release} s");
            assert!((0.05..0.8).contains(&attack), "{clip:?}: up in {attack} s");
            (up, down) = (up + attack / 20.0, down + release / 20.0);
        }
        assert!(down > 1.15 * up, "{emotion:?}: up in {up} s, down in {down} s on average");
    }
}

#[test]
fn one_side_leads_by_a_few_hundredths_of_a_second() {
    for (emotion, stem) in LEADING {
        let mut left_leads = 0;
        for seed in 0..20 {
            let clip = Clip { emotion, intensity: 3, seed };
            let p = performance_weights(&names(), &clip, 1000.0, 4.0);
            let begins = |side| above(&course(&p, &format!("{stem}{side}")), 0.5, 1000.0)[0];
            let lead = begins("Right") - begins("Left");
            assert!((0.004..0.045).contains(&lead.abs()), "{clip:?}: a lead of {lead} s");
            left_leads += usize::from(lead > 0.0);
        }
        assert!((4..=18).contains(&left_leads), "{emotion:?}: left leads {left_leads} of 20");
    }
}

#[test]
fn blinks_are_as_long_and_as_many_as_people_s() {
    const RATE: f64 = 200.0;
    let (mut blinks, mut seconds) = (0, 0.0);
    for seed in 0..40 {
        for clip in all_clips(seed) {
            let p = performance_weights(&names(), &clip, RATE, 4.0);
            seconds += 4.0;
            let [left, right] = ["eyeBlinkLeft", "eyeBlinkRight"].map(|lid| course(&p, lid));
            let shut = |f: &usize| left[*f] > 0.5;
            let begins = (1..p.frames()).filter(|f| shut(f) && !shut(&(f - 1)));
            for first in begins {
                let end = (first..p.frames()).find(|f| !shut(f)).expect("it opens again");
                let long = (end - first) as f64 / RATE;
                // Above half its height for half of 90 ms, 30 ms and half of 170 ms.
                assert!((0.14..0.20).contains(&long), "{clip:?}: half shut for {long} s");
                assert!((first..end).any(|f| left[f] > 0.95), "{clip:?}: it does not shut");
                let both = (first..end).all(|f| (left[f] - right[f]).abs() < 0.2);
                assert!(both, "{clip:?}: one eye blinks alone");
                blinks += 1;
            }
        }
    }
    // People blink 10 to 25 times a minute.
    let rate = f64::from(blinks) / (seconds / 60.0);
    assert!((10.0..25.0).contains(&rate), "{rate} blinks a minute");
}

#[test]
fn eyes_move_together_and_little() {
    let mut moved = 0;
    for seed in 0..20 {
        for clip in all_clips(seed) {
            let p = performance_weights(&names(), &clip, 60.0, 4.0);
            for (left, right) in
                [("eyeLookOutLeft", "eyeLookInRight"), ("eyeLookInLeft", "eyeLookOutRight")]
            {
                assert_eq!(course(&p, left), course(&p, right), "{clip:?}: {left}, {right}");
                let most = peak(&p, left);
                // A weight of 1 is a turn of 32 degrees: 0.2 is a glance at the other eye of a face.
                assert!(most < 0.2, "{clip:?}: {left} {most}");
                moved += usize::from(most > 0.01);
            }
        }
    }
    // Of 720 courses.
    assert!(moved > 500, "{moved} gazes move");
}

#[test]
fn the_head_sways_within_its_amplitudes() {
    // 6 degrees of sadness and 8 mm of fear, 1.2 times as large at most, and waves of 1.3 times
    // 0.014 radians and 1.4 mm on top of them.
    for seed in 0..20 {
        for clip in all_clips(seed) {
            let p = performance_weights(&names(), &clip, 60.0, 4.0);
            let most = |value: &dyn Fn(&mimique_actor::HeadPose) -> [f64; 3]| {
                let all = p.head.iter().flat_map(value);
                all.fold(0.0, |m: f64, v| m.max(v.abs()))
            };
            let (turn, shift) = (most(&|h| h.rotation).to_degrees(), most(&|h| h.translation));
            assert!((0.3..8.5).contains(&turn), "{clip:?}: turns by {turn} degrees");
            assert!((0.4..11.5).contains(&shift), "{clip:?}: shifts by {shift} mm");
            // Only disgust turns aside: in the others it is the sway alone.
            let aside = most(&|h| [h.rotation[1], 0.0, 0.0]).to_degrees();
            let alone = clip.emotion == Emotion::Disgust || (0.1..1.1).contains(&aside);
            assert!(alone, "{clip:?}: sways by {aside} degrees");
            let end = p.head[p.frames() - 1];
            let left = end.rotation.iter().chain(&end.translation).map(|v| v.abs());
            assert!(left.fold(0.0, f64::max) < 0.01, "{clip:?} ends at {end:?}");
        }
    }
}

#[test]
fn seeds_vary_the_timing_and_repeat_exactly() {
    let clip = |seed| Clip { emotion: Emotion::Joy, intensity: 3, seed };
    let play = |seed| performance_weights(&names(), &clip(seed), 60.0, 4.0);
    assert_eq!(play(5), play(5));
    assert_ne!(play(5).weights, play(6).weights);
    // One side leads.
    let p = play(5);
    let k = |name: &str| SHAPE_NAMES.iter().position(|s| *s == name).expect("shape exists");
    let (l, r) = (k("mouthSmileLeft"), k("mouthSmileRight"));
    let apart = (0..p.frames()).map(|f| (p.frame(f)[l] - p.frame(f)[r]).abs()).fold(0.0, f64::max);
    assert!(apart > 0.02 && apart < 0.3, "{apart}");
}

#[test]
fn short_clips_still_end_at_rest() {
    for duration in [0.5, 1.0, 2.0] {
        for clip in all_clips(1) {
            let p = performance_weights(&names(), &clip, 120.0, duration);
            let last = p.frame(p.frames() - 1).iter().copied().fold(0.0, f64::max);
            assert!(last < 5e-3, "{clip:?} of {duration} s ends at {last}");
        }
    }
}

#[test]
fn emotions_are_lowercase_words_in_files() {
    for emotion in Emotion::ALL {
        let word = serde_json::to_string(&emotion).expect("serialises");
        assert_eq!(word, format!("\"{}\"", emotion.name()));
        assert_eq!(serde_json::from_str::<Emotion>(&word).expect("reads"), emotion);
    }
}

fn actor() -> (Avatar, mimique_actor::MarkerSites) {
    let spec = HeadSpec { identity: Identity::from_seed(21), ..HeadSpec::default() };
    (build_head(&spec), marker_sites(&spec))
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    ((a[0] - b[0]).powi(2) + (a[1] - b[1]).powi(2) + (a[2] - b[2]).powi(2)).sqrt()
}

#[test]
fn take_has_forty_face_and_six_head_markers_and_its_truth() {
    let (actor, sites) = actor();
    let clips = [
        Clip { emotion: Emotion::Surprise, intensity: 3, seed: 1 },
        Clip { emotion: Emotion::Disgust, intensity: 2, seed: 2 },
    ];
    let take = synthetic_take(&actor, &sites, &clips, 77, 0.1);
    assert_eq!((take.labels.len(), take.head_labels.len()), (46, 6));
    assert_eq!(take.rate_hz, 200.0);
    assert!(take.neutral[1] - take.neutral[0] >= 80);
    assert_eq!(take.frames(), take.neutral[1] + 2 * 800);
    assert_eq!(take.truth.len(), take.frames() * 51);
    assert_eq!(take.positions.len(), take.frames() * 46);
    let found: Vec<_> = take.segments.iter().map(|s| (s.name.as_str(), s.first, s.end)).collect();
    assert_eq!(found, [("surprise3", 100, 900), ("disgust2", 900, 1700)]);
    assert!(take.truth[..take.neutral[1] * 51].iter().all(|&w| w == 0.0));
}

/// Largest change of any distance between head markers, against the neutral frames' mean, mm.
fn head_deformation(take: &SyntheticTake) -> f64 {
    let m = take.labels.len();
    let head: Vec<usize> = take
        .head_labels
        .iter()
        .map(|l| take.labels.iter().position(|k| k == l).expect("a label"))
        .collect();
    let mut worst: f64 = 0.0;
    for (i, &a) in head.iter().enumerate() {
        for &b in &head[i + 1..] {
            let apart = |f: usize| distance(take.positions[f * m + a], take.positions[f * m + b]);
            let rest = (0..take.neutral[1]).map(apart).sum::<f64>() / take.neutral[1] as f64;
            for f in 0..take.frames() {
                worst = worst.max((apart(f) - rest).abs());
            }
        }
    }
    worst
}

#[test]
fn head_markers_move_rigidly_within_the_noise() {
    let (actor, sites) = actor();
    let clips = all_clips(3);
    let clean = synthetic_take(&actor, &sites, &clips, 5, 0.0);
    assert!(head_deformation(&clean) < 1e-3, "{} mm", head_deformation(&clean));
    // They do move: the head sways.
    let m = clean.labels.len();
    let top = clean.labels.iter().position(|l| l == "head_top").expect("a label");
    let travel = (0..clean.frames())
        .map(|f| distance(clean.positions[f * m + top], clean.positions[top]))
        .fold(0.0, f64::max);
    assert!(travel > 3.0, "{travel} mm");
    let noisy = synthetic_take(&actor, &sites, &clips[..2], 5, 0.1);
    let worst = head_deformation(&noisy);
    // Two ends of 0.1 mm each: 0.14 mm; the largest of some 25,000 stays within 6 of them.
    assert!(worst > 0.1 && worst < 0.85, "{worst} mm");
}

#[test]
fn noise_is_of_the_size_that_was_asked_for() {
    let (actor, sites) = actor();
    let clips = [Clip { emotion: Emotion::Joy, intensity: 2, seed: 8 }];
    let clean = synthetic_take(&actor, &sites, &clips, 5, 0.0);
    let noisy = synthetic_take(&actor, &sites, &clips, 5, 0.1);
    let squares: f64 = clean
        .positions
        .iter()
        .zip(&noisy.positions)
        .map(|(a, b)| distance(*a, *b).powi(2))
        .sum::<f64>();
    let deviation = (squares / (3.0 * clean.positions.len() as f64)).sqrt();
    assert!((deviation - 0.1).abs() < 0.002, "{deviation} mm");
    assert_eq!(clean.truth, noisy.truth);
}
