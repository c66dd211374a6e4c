//! Dynamic reverse correlation of 40 people with 240 trials each: 40 units, 30 time bins, 7 categories, 1000 draws.
//!
//! `cargo bench -p mimique-stats --bench reverse_correlation` prints the seconds, the quickest of three, and how many
//! threads took part.
#![allow(clippy::print_stdout, missing_docs)]

use std::hint::black_box;
use std::time::Instant;

use mimique_adaptive::TrajectoryDesign;
use mimique_stats::{
    ReverseCorrelationOptions, ReverseTrial, ReverseTrials, Stream, reverse_correlation,
};

const PEOPLE: usize = 40;
const TRIALS: usize = 240;
const UNITS: usize = 40;
const CATEGORIES: usize = 7;
const RUNS: usize = 3;

fn main() {
    let design = TrajectoryDesign::of_units(UNITS);
    let mut stream = Stream::new(1, 1);
    let trials = (0..PEOPLE * TRIALS).map(|place| {
        let courses = design.draw(&mut || stream.unit()).expect("units to draw from");
        let answer = stream.below(CATEGORIES);
        ReverseTrial { person: place / TRIALS, answer, intensity: None, courses }
    });
    let trials = ReverseTrials {
        trials: trials.collect(),
        people: (0..PEOPLE).map(|person| person.to_string()).collect(),
        categories: (0..CATEGORIES).map(|category| category.to_string()).collect(),
        units: (0..UNITS).map(|unit| unit.to_string()).collect(),
        dropped: 0,
        answer_column: "answer".to_owned(),
    };
    let options = ReverseCorrelationOptions {
        bins: 30,
        duration_s: design.duration_s,
        permutations: 1000,
        seed: 1,
    };
    let mut best = f64::INFINITY;
    for _ in 0..RUNS {
        let start = Instant::now();
        black_box(reverse_correlation(&trials, options).expect("images"));
        best = best.min(start.elapsed().as_secs_f64());
    }
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    println!("{{\"seconds\": {best}, \"threads\": {threads}}}");
}
