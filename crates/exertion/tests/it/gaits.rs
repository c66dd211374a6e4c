//! The built-in walk, run and sprint are physically plausible.

use mimique_actor::{Gait, gait_bvh};
use mimique_exertion::{Body, BodyOptions, BodyWork, Convention, Person, PersonSpec};
use mimique_mocap::{BodyJoint, BodyJoints, Capture, read_bytes};

fn capture(gait: &Gait, rate_hz: f64) -> Capture {
    // Whole strides: every gait ends as it began.
    let seconds = (6.0 * gait.stride_hz).round() / gait.stride_hz;
    read_bytes(gait_bvh(gait, 1.75, seconds, rate_hz).as_bytes()).unwrap()
}

fn body(capture: &Capture, person: &Person) -> Body {
    let joints = BodyJoints::find(&capture.labels).unwrap();
    Body::new(capture, &joints, person, &BodyOptions::default()).unwrap()
}

/// Work of a second, J/kg, by a convention.
fn work(gait: &Gait, rate_hz: f64, convention: Convention) -> f64 {
    let person = Person::new(PersonSpec::default()).unwrap();
    let body = body(&capture(gait, rate_hz), &person);
    let work = BodyWork::of(&body, &person, convention, false).unwrap().accumulated;
    work.total() / work.span_s()
}

/// Public takes gave 5.5 J/kg in a second for a walk at 1.6 m/s and 14.4 for a run at 2.7 m/s; work goes
/// with the square of the speed.
#[test]
fn work_of_a_second_is_that_of_people() {
    let walk = work(&Gait::WALK, 120.0, Convention::Segments);
    let run = work(&Gait::RUN, 120.0, Convention::Segments);
    let sprint = work(&Gait::SPRINT, 120.0, Convention::Segments);
    let square = |speed: f64, of: f64| (speed / of) * (speed / of);
    let (people_walk, people_run) =
        (5.5 * square(Gait::WALK.speed, 1.6), 14.4 * square(Gait::RUN.speed, 2.7));
    assert!((walk / people_walk - 1.0).abs() < 0.15, "walk {walk}, people {people_walk}");
    assert!((run / people_run - 1.0).abs() < 0.15, "run {run}, people {people_run}");
    // Half of it is work against the next half; a sprint stays below what counts as a fault.
    assert!((40.0..100.0).contains(&sprint), "sprint {sprint}");
    for gait in Gait::ALL {
        let of = |convention| work(&gait, 120.0, convention);
        let (own, positive, pseudo) =
            (of(Convention::Segments), of(Convention::Positive), of(Convention::Pseudo));
        assert!(of(Convention::Signed).abs() < 0.05 * own, "level ground gives nothing");
        assert!((positive / own - 0.5).abs() < 0.02, "what goes up comes down");
        assert!(of(Convention::Body) < own && own < pseudo);
    }
}

#[test]
fn work_does_not_hang_on_the_rate() {
    for gait in Gait::ALL {
        let [slow, fast] = [60.0, 240.0].map(|rate| work(&gait, rate, Convention::Segments));
        assert!((slow / fast - 1.0).abs() < 0.03, "{}: {slow} {fast}", gait.name);
    }
}

#[test]
fn bodies_keep_their_lengths_and_go_at_their_speed() {
    let person = Person::new(PersonSpec::default()).unwrap();
    for gait in Gait::ALL {
        let body = body(&capture(&gait, 120.0), &person);
        assert!((body.metres_per_unit() - 0.01).abs() < 1e-6, "{}", gait.name);
        let track = |joint| body.track(joint).unwrap();
        let (hips, ankle) = (track(BodyJoint::LeftHip), track(BodyJoint::LeftAnkle));
        let (first, last) = (hips[0], hips[hips.len() - 1]);
        let seconds = (hips.len() - 1) as f64 / 120.0;
        assert!(((last.z - first.z) / seconds / gait.speed - 1.0).abs() < 0.01, "{}", gait.name);
        assert!(ankle.iter().all(|place| place.y > 0.05 && place.y < 0.9), "{}", gait.name);
        let height: f64 = hips.iter().map(|place| place.y).sum::<f64>() / hips.len() as f64;
        assert!((0.78..0.95).contains(&height), "{}: hips at {height} m", gait.name);
    }
}
