//! Numbers of the whole way, from a motion to weights, each list as a hash of its bits: natively and in the
//! browser's module they must be the same.

use mimique_actor::{Gait, gait_bvh};
use mimique_exertion::{
    Accumulated, ActivityWork, Body, BodyOptions, BodyWork, Clip, Convention, Expression,
    ExpressionModel, Face, Feature, Heart, HeartModel, Part, Person, PersonSpec, Plan, Series,
    Start, SupportVectorParts, SupportVectors, Window,
};
use mimique_mocap::{BodyJoints, read_activity_bytes, read_bytes};

/// FNV-1a of the bits of numbers.
fn hash(numbers: &[f64]) -> u64 {
    let bytes = numbers.iter().flat_map(|number| number.to_le_bytes());
    bytes.fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
    })
}

struct Lines(String);

impl Lines {
    fn put(&mut self, name: &str, numbers: &[f64]) {
        let last = numbers.last().copied().unwrap_or(0.0);
        self.0 += &format!("{name} {} {:016x} {last}\n", numbers.len(), hash(numbers));
    }
}

fn person(level: f64) -> Person {
    let text = format!(
        "{{\"level\": {level}, \"age\": 41, \"sex\": \"female\", \"loads\": {{\"back\": 7}}}}"
    );
    PersonSpec::of_text(&text).and_then(Person::new).expect("a person")
}

/// A model of numbers that nobody taught.
fn model() -> Expression {
    let number = |i: usize| (i as f64 * 0.618_033_988_75).fract() * 2.0 - 1.0;
    let curve = |k: usize| SupportVectorParts {
        gamma: 0.2 + 0.1 * k as f64,
        b: 20.0,
        offset: vec![9.0, 11.0, 0.5],
        scale: vec![8.0, 9.0, 0.3],
        vectors: (0..40).map(|i| (0..3).map(|j| 2.0 * number(3 * i + j + k)).collect()).collect(),
        coefficients: (0..40).map(|i| 30.0 * number(i + 5 * k)).collect(),
    };
    let features = vec![Feature::W, Feature::P, Feature::Rcn];
    let curves = [0, 1, 2, 3].map(|k| SupportVectors::new(curve(k)).expect("a curve"));
    Expression::Model(Box::new(ExpressionModel::new(features, curves).expect("a model")))
}

/// A line a list.
pub fn lines() -> String {
    let mut lines = Lines(String::new());
    let person = person(6.5);
    let mut parts = vec![Part::rest(20.0)];
    for gait in Gait::ALL {
        let bvh = gait_bvh(&gait, 1.75, 3.0, 60.0);
        let capture = read_bytes(bvh.as_bytes()).expect("a motion");
        let joints = BodyJoints::find(&capture.labels).expect("a body");
        let body = Body::new(&capture, &joints, &person, &BodyOptions::default()).expect("a body");
        for (convention, name) in Convention::NAMES {
            let work = BodyWork::of(&body, &person, convention, true).expect("work");
            lines.put(&format!("{} {name}", gait.name), &work.steps);
            if convention == Convention::Segments {
                parts.push(Part { work: work.accumulated, seconds: 45.5, rcn: None });
            }
        }
    }
    let track: String = (0..40)
        .map(|i| {
            format!(
                "<trkpt lat=\"{}\" lon=\"7\"><ele>{}</ele><time>2026-05-01T10:00:{i:02}Z</time><hr>{}</hr></trkpt>",
                47.0 + 2.5e-5 * f64::from(i),
                400.0 + 0.1 * f64::from(i),
                110 + i
            )
        })
        .collect();
    let gpx = format!("<gpx><trk><trkseg>{track}</trkseg></trk></gpx>");
    let activity = read_activity_bytes(gpx.as_bytes()).expect("an activity");
    let hike = ActivityWork::of(&person, &activity).expect("work");
    lines.put("hike", &hike.w);
    let work = Accumulated::of_seconds(&hike.w).expect("work");
    parts.push(Part { seconds: work.span_s(), work, rcn: hike.rcn });
    let plan = Plan::new(parts).expect("a plan");
    for law in [HeartModel::Thesis, HeartModel::Steady] {
        let series = Series::of(&person, &plan, Heart::RecordedElse(law), Start::default());
        let series = series.expect("a series");
        let of = &series.metabolism;
        for (name, values) in [
            ("w", &series.w),
            ("p", &series.p),
            ("rcn", &series.rcn),
            ("epoc", &of.epoc),
            ("fatigue", &of.fatigue),
            ("sweat", &of.sweat),
            ("kcal", &of.kcal_min),
        ] {
            lines.put(&format!("{} {name}", law.name()), values);
        }
        for (name, expression) in [("rules", Expression::Rules), ("model", model())] {
            let face = Face { expression, breathing: true, seed: Some(5), ..Face::default() };
            let window = Window { seconds: [30.0, 190.0], rate_hz: 60.0 };
            let clip = Clip::of(&person, &plan, &series, &window, &face).expect("a clip");
            lines.put(&format!("{} {name} weights", law.name()), &clip.weights);
            let phase = clip.breathing.as_ref().map_or(&[][..], |own| &own.phase);
            lines.put(&format!("{} {name} breath", law.name()), phase);
        }
    }
    lines.0
}
