//! An hour of a body's motion at 120 Hz with 30 joints to a face's weights at 60 Hz, one thread.
//!
//! `cargo bench -p mimique-exertion`. The motion is the built-in run, stride after stride.
#![allow(missing_docs)]

use std::hint::black_box;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use mimique_actor::{Gait, gait_bvh};
use mimique_exertion::{
    Accumulated, Body, BodyOptions, BodyWork, Clip, Convention, Expression, ExpressionModel, Face,
    Feature, Heart, Part, Person, PersonSpec, Plan, Series, Start, SupportVectorParts,
    SupportVectors, Window,
};
use mimique_geometry::{Displacement, Point};
use mimique_mocap::{BodyJoints, Capture, read_bytes};

const RATE_HZ: f64 = 120.0;
const HOUR_S: f64 = 3600.0;
const JOINTS: usize = 30;

/// The run for an hour, with markers that are no joints of the table to make 30.
fn hour() -> Capture {
    let strides = read_bytes(gait_bvh(&Gait::RUN, 1.75, 10.0, RATE_HZ).as_bytes()).unwrap();
    let (own, frames) = (strides.labels.len(), strides.frames());
    let mut labels = strides.labels.clone();
    labels.extend((own..JOINTS).map(|k| format!("extra{k}")));
    let ahead = strides.frame(frames - 1)[0] - strides.frame(0)[0];
    let total = (HOUR_S * RATE_HZ) as usize;
    let positions = (0..total).flat_map(|frame| {
        let (turn, at) = (frame / frames, frame % frames);
        let way = Displacement(ahead.0 * turn as f64);
        let places: Vec<Point> = strides.frame(at).iter().map(|place| *place + way).collect();
        (0..JOINTS).map(move |k| places[k % own])
    });
    Capture::new(labels, RATE_HZ, strides.unit, positions)
}

/// A model of as many vectors as one taught by rules has.
fn model() -> Expression {
    let number = |i: usize| (i as f64 * 0.754_877).fract() * 2.0 - 1.0;
    let curve = |k: usize| {
        let vectors: Vec<Vec<f64>> =
            (0..200).map(|i| (0..4).map(|j| number(4 * i + j + k)).collect()).collect();
        let coefficients = (0..200).map(|i| 50.0 * number(i + 7 * k)).collect();
        let (offset, scale) = (vec![10.0, 10.0, 0.5, 5.0], vec![15.0, 15.0, 0.3, 5.0]);
        SupportVectorParts { gamma: 0.1, b: 30.0, offset, scale, vectors, coefficients }
    };
    let features = Feature::ALL.map(|(feature, ..)| feature).to_vec();
    let curves = [0, 1, 2, 3].map(|k| SupportVectors::new(curve(k)).unwrap());
    Expression::Model(Box::new(ExpressionModel::new(features, curves).unwrap()))
}

fn work(capture: &Capture, person: &Person) -> Accumulated {
    let joints = BodyJoints::find(&capture.labels).unwrap();
    let body = Body::new(capture, &joints, person, &BodyOptions::default()).unwrap();
    BodyWork::of(&body, person, Convention::Segments, false).unwrap().accumulated
}

fn weights(work: Accumulated, person: &Person, face: &Face) -> Vec<f64> {
    let seconds = work.span_s();
    let plan = Plan::of(Part { work, seconds, rcn: None }).unwrap();
    let series = Series::of(person, &plan, Heart::default(), Start::default()).unwrap();
    let window = Window { seconds: [0.0, seconds], rate_hz: 60.0 };
    Clip::of(person, &plan, &series, &window, face).unwrap().weights
}

fn exertion(c: &mut Criterion) {
    let capture = hour();
    let person = Person::new(PersonSpec::default()).unwrap();
    let rules = Face { breathing: true, ..Face::default() };
    let learnt = Face { breathing: true, expression: model(), ..Face::default() };
    let done = work(&capture, &person);

    let mut group = c.benchmark_group("hour");
    group.sample_size(10).throughput(Throughput::Elements(capture.frames() as u64));
    group.bench_function("motion to work", |b| b.iter(|| black_box(work(&capture, &person))));
    group.bench_function("work to weights, rules", |b| {
        b.iter(|| black_box(weights(done.clone(), &person, &rules)));
    });
    group.bench_function("work to weights, model", |b| {
        b.iter(|| black_box(weights(done.clone(), &person, &learnt)));
    });
    group.bench_function("motion to weights, rules", |b| {
        b.iter(|| black_box(weights(work(&capture, &person), &person, &rules)));
    });
    group.finish();
}

criterion_group!(benches, exertion);
criterion_main!(benches);
