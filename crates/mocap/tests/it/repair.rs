//! Faults planted in a smooth take are found where they are, and repaired to what was there before.

use mimique_geometry::{Point, coordinates};
use mimique_mocap::{
    Capture, CaptureFacts, Format, GapFill, GapRepair, LengthUnit, LowPass, Recording, RepairPlan,
    RepairedSwap, repair, stillest,
};

const RATE: f64 = 200.0;
const HEAD: [&str; 4] = ["hat front", "hat left", "hat right", "hat top"];

/// Numbers between -1 and 1 that look random and are always the same.
struct Noise(u64);

impl Noise {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963);
        (self.0 >> 33) as f64 / f64::from(1_u32 << 30) - 1.0
    }
}

/// A talking, turning head: 20 face markers 15 mm and more apart, 4 on the head, millimetres, 1.6 m
/// up. The face is at rest from 4 s to 5.5 s, the head never.
fn take(seconds: f64, noise_mm: f64) -> Capture {
    let mut rest: Vec<[f64; 3]> = Vec::new();
    for i in 0..20 {
        let (column, row) = (f64::from(i % 5) - 2.0, f64::from(i / 5));
        rest.push([column * 24.0, 40.0 - 26.0 * row, 100.0 - 3.0 * column * column + 2.0 * row]);
    }
    rest.extend([[0.0, 120.0, 90.0], [80.0, 105.0, 20.0], [-80.0, 106.0, 22.0], [3.0, 150.0, 5.0]]);
    let mut noise = Noise(7);
    let frames = (seconds * RATE) as usize;
    let mut positions = Vec::with_capacity(frames * rest.len());
    for frame in 0..frames {
        let t = frame as f64 / RATE;
        let (s, c) = (0.25 * (1.3 * t).sin()).sin_cos();
        // Comes to rest and leaves it without a kink.
        let calm = ((t - 4.75).abs() - 0.75).clamp(0.0, 0.5) * 2.0;
        let talk = calm * calm * (3.0 - 2.0 * calm);
        for (m, p) in rest.iter().enumerate() {
            let m = m as f64;
            let amplitude = if m < 20.0 { 4.0 + m * 0.2 } else { 0.0 };
            let y = p[1] + talk * amplitude * (5.0 * t + 0.4 * m).sin();
            let z = p[2] + talk * 0.4 * amplitude * (4.0 * t + m).cos();
            let turned = [c * p[0] + s * z + 15.0 * (0.7 * t).sin(), y + 1600.0, c * z - s * p[0]];
            positions.push(Point::from(turned.map(|v| v + noise_mm * noise.next())));
        }
    }
    let mut labels: Vec<String> = (0..20).map(|m| format!("face {m}")).collect();
    labels.extend(HEAD.map(str::to_owned));
    Capture {
        labels,
        rate_hz: RATE,
        first_frame: 1,
        unit: LengthUnit::Millimetre,
        positions,
        notes: Vec::new(),
    }
}

const MARKERS: usize = 24;

fn swap(capture: &mut Capture, a: usize, b: usize, frames: std::ops::Range<usize>) {
    for frame in frames {
        capture.positions.swap(MARKERS * frame + a, MARKERS * frame + b);
    }
}

fn largest_error(a: &Capture, b: &Capture) -> f64 {
    assert_eq!(a.positions.len(), b.positions.len());
    let pairs = coordinates(&a.positions).iter().zip(coordinates(&b.positions));
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, |m, e| if e > m || e.is_nan() { e } else { m })
}

fn facts(capture: &Capture) -> CaptureFacts {
    CaptureFacts::of(&Recording {
        capture: capture.clone(),
        format: Format::by_id("c3d").unwrap(),
        system: None,
        analog_channels: 0,
        events: Vec::new(),
    })
}

#[test]
fn a_clean_take_comes_out_bit_for_bit() {
    for noise in [0.0, 0.15] {
        let clean = take(10.0, noise);
        let done = repair(clean.clone(), &RepairPlan::default()).unwrap();
        assert_eq!(done.capture.positions, clean.positions);
        assert!(done.record.changed.is_empty(), "{:?}", done.record);
    }
}

#[test]
fn planted_swaps_are_put_back() {
    let clean = take(10.0, 0.1);
    let mut faulty = clean.clone();
    swap(&mut faulty, 3, 8, 500..700);
    swap(&mut faulty, 0, 1, 900..901);
    // Until the end: the shorter part is taken to be wrong.
    swap(&mut faulty, 15, 16, 1500..2000);
    // Three in a ring.
    swap(&mut faulty, 10, 11, 1100..1300);
    swap(&mut faulty, 11, 12, 1100..1300);
    assert_eq!(facts(&faulty).swaps.len(), 7);
    let done = repair(faulty, &RepairPlan::default()).unwrap();
    assert_eq!(largest_error(&done.capture, &clean), 0.0);
    let stretch = |labels: &[&str], first, end| RepairedSwap {
        labels: labels.iter().map(|l| format!("face {l}")).collect(),
        first,
        end,
        repaired: true,
    };
    assert_eq!(
        done.record.swaps,
        [
            stretch(&["3", "8"], 500, 700),
            stretch(&["0", "1"], 900, 901),
            stretch(&["10", "11", "12"], 1100, 1300),
            stretch(&["15", "16"], 1500, 2000),
        ]
    );
    assert!(done.record.spikes.is_empty() && facts(&done.capture).swaps.is_empty());
    let frames: Vec<usize> = done.record.changed.iter().map(|c| c.frame).collect();
    let planted = (500..700).chain(900..901).chain(1100..1300).chain(1500..2000);
    assert_eq!(frames, planted.collect::<Vec<_>>());
    assert_eq!(done.record.changed[0].swapped, ["face 3", "face 8"]);
}

#[test]
fn labels_that_change_places_while_both_are_hidden_are_put_back() {
    let clean = take(8.0, 0.1);
    let mut faulty = clean.clone();
    swap(&mut faulty, 6, 7, 410..1600);
    for frame in 400..410 {
        faulty.positions[MARKERS * frame + 6] = Point::UNSEEN;
        faulty.positions[MARKERS * frame + 7] = Point::UNSEEN;
    }
    let done = repair(faulty, &RepairPlan::default()).unwrap();
    // The longer part keeps its labels, so it is the first that is moved: one person's marker has
    // one label throughout.
    assert_eq!(done.record.swaps.len(), 1);
    let swapped = done.capture.positions[MARKERS * 1000 + 6];
    assert_eq!(swapped, clean.positions[MARKERS * 1000 + 7]);
    assert_eq!(done.capture.positions[MARKERS * 100 + 6], clean.positions[MARKERS * 100 + 7]);
    assert!(facts(&done.capture).swaps.is_empty());
}

#[test]
fn planted_spikes_are_taken_out_and_nothing_else() {
    let clean = take(10.0, 0.1);
    let mut faulty = clean.clone();
    let mut noise = Noise(3);
    let mut planted = Vec::new();
    for (i, frame) in (60..1960).step_by(95).enumerate() {
        let (marker, length) = (i % MARKERS, 1 + i % 6);
        let height = 6.0 + 8.0 * (i % 5) as f64;
        for f in frame..frame + length {
            let p = &mut faulty.positions[MARKERS * f + marker];
            p[i % 3] += height + noise.next();
            p[(i + 1) % 3] -= 0.5 * height;
        }
        planted.push((faulty.labels[marker].clone(), frame, frame + length));
    }
    let done = repair(faulty, &RepairPlan::default()).unwrap();
    let mut found: Vec<(String, usize, usize)> =
        done.record.spikes.iter().map(|s| (s.label.clone(), s.first, s.end)).collect();
    found.sort_by_key(|s| s.1);
    assert_eq!(found, planted);
    assert!(done.record.spikes.iter().all(|s| s.distance_m > 0.005));
    assert!(done.record.gaps.iter().all(|g| g.repair == GapRepair::Spline));
    // Noise of 0.1 mm at the ends of the spline.
    let error = largest_error(&done.capture, &clean);
    assert!(error < 0.8, "{error} mm");
    assert_eq!(done.record.changed.len(), planted.iter().map(|p| p.2 - p.1).sum::<usize>());
}

#[test]
fn gaps_are_filled_as_far_as_is_said_and_listed() {
    let clean = take(10.0, 0.0);
    let mut faulty = clean.clone();
    for (marker, frames) in [(0, 100..110), (1, 300..420), (2, 600..1000), (20, 700..780)] {
        for frame in frames {
            faulty.positions[MARKERS * frame + marker] = Point::UNSEEN;
        }
    }
    let plan =
        RepairPlan { gaps: GapFill { spline_s: 0.06, rigid_s: 1.0 }, ..RepairPlan::default() };
    let done = repair(faulty.clone(), &plan).unwrap();
    let repairs: Vec<(usize, GapRepair)> =
        done.record.gaps.iter().map(|g| (g.end - g.first, g.repair)).collect();
    assert_eq!(
        repairs,
        [
            (10, GapRepair::Spline),
            (120, GapRepair::RigidNeighbourhood),
            (400, GapRepair::LeftMissing),
            (80, GapRepair::RigidNeighbourhood),
        ]
    );
    let error = |marker: usize, frames: std::ops::Range<usize>| {
        frames
            .flat_map(|f| (0..3).map(move |k| (f, k)))
            .map(|(f, k)| {
                let at = MARKERS * f + marker;
                (done.capture.positions[at][k] - clean.positions[at][k]).abs()
            })
            .fold(0.0, f64::max)
    };
    assert!(error(0, 100..110) < 0.05, "{}", error(0, 100..110));
    // The neighbours talk too: some millimetres, not the 30 that the head moves.
    assert!(error(1, 300..420) < 6.0 && error(20, 700..780) < 6.0);
    assert!(done.capture.positions[MARKERS * 700 + 2][0].is_nan());
    let none = RepairPlan { gaps: GapFill { spline_s: 0.0, rigid_s: 0.0 }, ..plan };
    let kept = repair(faulty, &none).unwrap();
    assert!(kept.record.gaps.iter().all(|g| g.repair == GapRepair::LeftMissing));
    assert!(kept.record.changed.is_empty());
}

#[test]
fn the_head_is_held_and_the_neutral_then_found() {
    let capture = take(10.0, 0.05);
    let plan = RepairPlan {
        low_pass: Some(LowPass::Butterworth { cutoff_hz: 12.0 }),
        resample_hz: Some(100.0),
        head: HEAD.map(str::to_owned).to_vec(),
        ..RepairPlan::default()
    };
    let done = repair(capture, &plan).unwrap();
    assert_eq!((done.capture.rate_hz, done.capture.frames()), (100.0, 1000));
    let head = done.record.head.as_ref().unwrap();
    assert_eq!(head.residual_mm.len(), 1000);
    assert!(head.residual_rms_mm < 0.05 && head.residual_worst_mm < 0.2, "{head:?}");
    // At rest from 4 s to 5.5 s, whatever the head does.
    let neutral = stillest(&done.capture, 1.0).unwrap();
    assert!(neutral.frames.start >= 395 && neutral.frames.end <= 555, "{neutral:?}");
    assert!(neutral.deviation < 0.1, "{neutral:?}");
    let json = serde_json::to_string(&done.record).unwrap();
    assert_eq!(serde_json::from_str::<mimique_mocap::RepairRecord>(&json).unwrap(), done.record);
}

#[test]
fn a_plan_that_cannot_be_is_refused() {
    let capture = take(1.0, 0.0);
    let refused = |plan: RepairPlan| repair(capture.clone(), &plan).unwrap_err().to_string();
    let butterworth = |cutoff_hz| Some(LowPass::Butterworth { cutoff_hz });
    let plan = RepairPlan { low_pass: butterworth(150.0), ..RepairPlan::default() };
    assert!(refused(plan).starts_with("low-pass: cut-off 150 Hz at 200 frames per second"));
    let plan = RepairPlan { resample_hz: Some(0.0), ..RepairPlan::default() };
    assert!(refused(plan).starts_with("resample: 0 frames per second"));
    let plan = RepairPlan { head: vec!["nose".to_owned(); 3], ..RepairPlan::default() };
    assert!(refused(plan).starts_with("head marker nose: not in the capture"));
}
