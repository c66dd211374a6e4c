//! Mechanics that any implementation of bodies and work must obey.

use mimique_exertion::{
    Accumulated, Body, BodyOptions, BodyWork, Convention, ExertionError, Loads, Person, PersonSpec,
    Scale, Up,
};
use mimique_geometry::{DMat3, DQuat, DVec3, Displacement, Point};
use mimique_mocap::{BodyJoint, BodyJoints, Capture, LengthUnit};
use mimique_test_support::Random;

const RATE_HZ: f64 = 50.0;

/// A person who stands, arms a little away, m, in the order of [`BodyJoint::ALL`].
const STANDING: [[f64; 3]; BodyJoint::COUNT] = [
    [0.09, 0.93, 0.0],
    [0.1, 0.5, 0.02],
    [0.1, 0.07, 0.0],
    [0.1, 0.02, 0.2],
    [-0.09, 0.93, 0.0],
    [-0.1, 0.5, 0.02],
    [-0.1, 0.07, 0.0],
    [-0.1, 0.02, 0.2],
    [0.0, 1.47, 0.0],
    [0.0, 1.75, 0.03],
    [0.2, 1.43, 0.0],
    [0.25, 1.12, 0.0],
    [0.28, 0.87, 0.05],
    [0.29, 0.7, 0.08],
    [-0.2, 1.43, 0.0],
    [-0.25, 1.12, 0.0],
    [-0.28, 0.87, 0.05],
    [-0.29, 0.7, 0.08],
];

/// A motion of the standing person, by what becomes of a place at a time.
fn motion(frames: usize, moved: impl Fn(f64, usize, Point) -> Point) -> Capture {
    let labels = BodyJoint::ALL.map(|joint| joint.name().to_owned()).to_vec();
    let positions = (0..frames).flat_map(|frame| {
        let t = frame as f64 / RATE_HZ;
        let places: Vec<Point> =
            (0..STANDING.len()).map(|k| moved(t, k, Point::from(STANDING[k]))).collect();
        places
    });
    Capture::new(labels, RATE_HZ, LengthUnit::Metre, positions)
}

/// Arms, legs and trunk all move, each in its own way.
fn dance(frames: usize) -> Capture {
    motion(frames, |t, k, place| {
        let a = 3.0 + 0.37 * k as f64;
        let way =
            [0.1 * (a * t).sin(), 0.06 * (1.3 * a * t).cos(), 0.08 * (0.7 * a * t + 1.0).sin()];
        place + Displacement::from(way)
    })
}

fn joints(capture: &Capture) -> BodyJoints {
    let own = capture.labels.iter().filter(|label| BodyJoint::by_name(label).is_some());
    let map = own.map(|label| (label.clone(), label.clone())).collect();
    BodyJoints::of_map(&map, &capture.labels).unwrap()
}

const RAW: BodyOptions =
    BodyOptions { scale: Scale::MetresPerUnit(1.0), lowpass_hz: None, up: Up::Y };

fn work_of(capture: &Capture, spec: PersonSpec, options: &BodyOptions, by: Convention) -> BodyWork {
    let person = Person::new(spec).unwrap();
    let body = Body::new(capture, &joints(capture), &person, options).unwrap();
    BodyWork::of(&body, &person, by, false).unwrap()
}

fn total(capture: &Capture, options: &BodyOptions, by: Convention) -> f64 {
    work_of(capture, PersonSpec::default(), options, by).accumulated.total()
}

#[test]
fn a_lift_is_weight_times_height_and_a_load_is_lifted_along() {
    let lift = motion(26, |t, _, place| place + Displacement::new(0.0, 0.4 * t, 0.0));
    let work = total(&lift, &RAW, Convention::Segments);
    assert!((work - 9.81 * 0.4 * 0.5).abs() < 1e-9, "{work}");
    let loads = Loads { left_hand: 3.0, right_hand: 4.0, back: 14.0 };
    let spec = PersonSpec { loads, ..PersonSpec::default() };
    let loaded = work_of(&lift, spec, &RAW, Convention::Segments).accumulated.total();
    assert!((loaded / work - 91.0 / 70.0).abs() < 1e-9, "{}", loaded / work);
}

#[test]
fn free_fall_and_constant_speed_do_no_work() {
    let fall =
        motion(40, |t, _, place| place + Displacement::new(2.0 * t, 3.0 * t - 4.905 * t * t, t));
    let straight = motion(40, |t, _, place| place + Displacement::new(2.0 * t, 0.0, -t));
    for by in [Convention::Segments, Convention::Body, Convention::Signed, Convention::Positive] {
        assert!(total(&fall, &RAW, by).abs() < 1e-9, "{by:?}");
        assert!(total(&straight, &RAW, by).abs() < 1e-9, "{by:?}");
    }
    assert!(total(&fall, &RAW, Convention::Pseudo) > 1.0, "kinds of energy are not lent here");
}

/// A turn at constant speed about the vertical through the feet: |du/dt| is the speed of turning times the
/// part of the axis that is level.
#[test]
fn turning_has_the_energy_of_a_rod() {
    let turn = motion(60, |t, _, place| Point(DMat3::from_rotation_y(1.5 * t) * place.0));
    let person = Person::new(PersonSpec::default()).unwrap();
    let body = Body::new(&turn, &joints(&turn), &person, &RAW).unwrap();
    let parts = body.energies(&person).unwrap();
    let foot = body.segment_names().iter().position(|name| *name == "leftFoot").unwrap();
    let way = Point::from(STANDING[3]) - Point::from(STANDING[2]);
    let level = (way.x * way.x + way.z * way.z).sqrt();
    let want = 0.5 * 0.0145 * 70.0 * (0.475 * level * 1.5) * (0.475 * level * 1.5);
    let got = parts[foot].rotational[30];
    // A central difference at 50 Hz sees sin(x)/x of the speed.
    assert!((got / want - 1.0).abs() < 1e-3, "{got} {want}");
}

#[test]
fn units_axes_order_of_markers_and_place_do_not_matter() {
    let dance = dance(80);
    let own = total(&dance, &BodyOptions { scale: Scale::ByStature, ..RAW }, Convention::Segments);
    let turned = |turn: DQuat, by: f64| {
        let mut other = dance.clone();
        for place in &mut other.positions {
            *place = Point(turn * place.0 * by + DVec3::new(3.0, -2.0, 5.0));
        }
        other
    };
    let same = |capture: &Capture, up: Up| {
        let options = BodyOptions { scale: Scale::ByStature, up, ..RAW };
        let other = total(capture, &options, Convention::Segments);
        assert!((other / own - 1.0).abs() < 1e-9, "{up:?}: {other} {own}");
    };
    // Inches; turned about the vertical; +Z up, found; +X up, said.
    same(&turned(DQuat::IDENTITY, 1.0 / 0.0254), Up::Found);
    same(&turned(DQuat::from_rotation_y(0.7), 1.0), Up::Y);
    let z_up = turned(DQuat::from_rotation_x(std::f64::consts::FRAC_PI_2), 100.0);
    same(&z_up, Up::Found);
    same(&turned(DQuat::from_rotation_z(-std::f64::consts::FRAC_PI_2), 1.0), Up::X);

    let width = dance.labels.len();
    let mut shuffled = dance.clone();
    let order: Vec<usize> = (0..width).map(|k| (7 * k + 3) % width).collect();
    shuffled.labels = order.iter().map(|k| dance.labels[*k].clone()).collect();
    let frames = dance.positions.chunks(width);
    shuffled.positions =
        frames.flat_map(|f| order.iter().map(|k| f[*k]).collect::<Vec<_>>()).collect();
    same(&shuffled, Up::Y);
}

#[test]
fn jitter_multiplies_work_and_the_low_pass_takes_it_away() {
    let still =
        motion(300, |t, _, place| place + Displacement::new(0.05 * (4.0 * t).sin(), 0.0, 1.2 * t));
    let mut random = Random::new(1);
    let mut jittered = still.clone();
    for place in &mut jittered.positions {
        *place += Displacement::from([0, 1, 2].map(|_| 0.002 * random.normal()));
    }
    let filtered = BodyOptions { lowpass_hz: Some(6.0), ..RAW };
    let [clean, raw, smooth] = [(&still, &RAW), (&jittered, &RAW), (&jittered, &filtered)]
        .map(|(capture, options)| total(capture, options, Convention::Segments));
    assert!(raw > 5.0 * clean, "{raw} {clean}");
    assert!(smooth < 0.2 * raw, "{smooth} {raw}");
}

#[test]
fn repeated_work_goes_on_and_the_jump_back_is_no_work() {
    // The body ends a metre from where it began.
    let walk = motion(51, |t, _, place| {
        place + Displacement::new(0.03 * (6.0 * t).sin(), 0.02 * (12.0 * t).sin(), t)
    });
    let work = work_of(&walk, PersonSpec::default(), &RAW, Convention::Segments).accumulated;
    let (total, span) = (work.total(), work.span_s());
    assert_eq!(span, 1.0);
    let again = work.repeated(true);
    for t in [0.2, 0.77, 1.0] {
        for turns in [1.0, 5.0, 300.0] {
            let want = again.at(t) + turns * total;
            assert!((again.at(t + turns * span) - want).abs() < 1e-9 * want, "{t} {turns}");
        }
    }
    assert!((again.w(57.3) - total).abs() < 1e-9, "every second holds the whole of it");
}

#[test]
fn w_and_p_of_constant_work_are_that_work() {
    let work = Accumulated::of_phases(&[(8.0, 10.0), (0.0, 5.0)]).unwrap();
    assert_eq!((work.w(0.0), work.at(-1.0), work.span_s()), (0.0, 0.0, 15.0));
    for t in [0.3, 1.0, 4.5, 10.0] {
        assert!((work.w(t) - 8.0).abs() < 1e-12, "{t}");
    }
    assert!((work.w(10.25) - 6.0).abs() < 1e-12, "a quarter of the second was rest");
    assert!((work.p(10.0) - 4.0).abs() < 1e-12 && (work.p(0.0) - 8.0).abs() < 1e-12);
    assert_eq!((work.w(20.0), work.p(20.0)), (0.0, 0.0));
}

#[test]
fn what_cannot_be_a_body_is_refused_with_its_place() {
    let dance = dance(20);
    let person = Person::new(PersonSpec::default()).unwrap();
    let refused = |capture: &Capture, options: &BodyOptions| -> ExertionError {
        let body = Body::new(capture, &joints(capture), &person, options);
        body.and_then(|body| body.energies(&person)).unwrap_err()
    };
    let mut other = dance.clone();
    other.rate_hz = 9.9;
    assert_eq!(refused(&other, &RAW).place(), "rateHz");
    let mut other = dance.clone();
    other.positions.truncate(2 * 18);
    assert_eq!(refused(&other, &RAW).place(), "frames");
    let mut other = dance.clone();
    other.positions[3 * 18 + BodyJoint::RightElbow as usize] = Point::UNSEEN;
    let error = refused(&other, &RAW);
    assert_eq!((error.place(), error.to_string().contains("frame 3")), ("joints/rightElbow", true));
    let mut other = dance.clone();
    for frame in 0..20 {
        let at = |joint: BodyJoint| frame * 18 + joint as usize;
        other.positions[at(BodyJoint::LeftKnee)] = other.positions[at(BodyJoint::LeftHip)];
    }
    assert_eq!(refused(&other, &RAW).place(), "joints/leftThigh");
    for cutoff in [0.0, -1.0, 25.0, f64::NAN] {
        let options = BodyOptions { lowpass_hz: Some(cutoff), ..RAW };
        assert_eq!(refused(&dance, &options).place(), "lowpassHz", "{cutoff}");
    }
    let options = BodyOptions { scale: Scale::MetresPerUnit(0.0), ..RAW };
    assert_eq!(refused(&dance, &options).place(), "metresPerUnit");
}

#[test]
fn a_hand_whose_end_lies_on_the_wrist_goes_with_the_forearm() {
    let mut dance = dance(20);
    for frame in 0..20 {
        let at = |joint: BodyJoint| frame * 18 + joint as usize;
        dance.positions[at(BodyJoint::LeftHandEnd)] = dance.positions[at(BodyJoint::LeftWrist)];
    }
    let person = Person::new(PersonSpec::default()).unwrap();
    let body = Body::new(&dance, &joints(&dance), &person, &RAW).unwrap();
    let names = body.segment_names();
    assert!(!names.contains(&"leftHand") && names.contains(&"rightHand"), "{names:?}");
}
