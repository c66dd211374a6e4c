//! A cumulative link mixed model of 54 people's 100 ratings each, with effects of people, of people with each
//! method, of segments and of clips.
//!
//! `cargo bench -p mimique-stats --bench mixed_model -- FILE` writes the ratings to FILE and prints the seconds of
//! the model with its likelihood ratio test (two fits and the standard errors), the quickest of three.
//! `cargo xtask bench --stats` holds it against R (`mixed_model.R` beside it) on the same file.
#![allow(clippy::print_stdout, missing_docs)]

use std::hint::black_box;
use std::time::Instant;

use mimique_stats::{Factor, MixedModelOptions, Stream, Table, mixed_model, normal_quantile_upper};

const PEOPLE: usize = 54;
const SEGMENTS: usize = 25;
const METHODS: usize = 4;
const RUNS: usize = 3;

fn main() {
    let path = std::env::args().skip(1).find(|argument| !argument.starts_with("--"));
    let text = ratings();
    if let Some(path) = path {
        std::fs::write(path, &text).expect("the file of ratings can be written");
    }
    let table = Table::parse(text.as_bytes()).expect("ratings are a table");
    let factor = |name: &str| table.factor(name).expect("a column");
    let (person, method, segment) = (factor("person"), factor("method"), factor("segment"));
    let groups = [&person.clone(), &person.crossed(&method), &segment, &segment.crossed(&method)];
    let groups: Vec<&Factor> = groups.to_vec();
    let rating = table.numbers("rating").expect("a column");
    let options = MixedModelOptions::default();
    let mut best = f64::INFINITY;
    for _ in 0..RUNS {
        let start = Instant::now();
        black_box(mixed_model(&rating, &[&method], &groups, options).expect("a model"));
        best = best.min(start.elapsed().as_secs_f64());
    }
    println!("{{\"seconds\": {best}}}");
}

/// Ratings from 1 to 7, as CSV.
fn ratings() -> String {
    let mut stream = Stream::new(1, 1);
    let mut normal = || normal_quantile_upper(stream.unit().max(1e-12));
    let mut draw = |count: usize, sd: f64| (0..count).map(|_| sd * normal()).collect::<Vec<f64>>();
    let people = draw(PEOPLE, 0.9);
    let tastes = draw(PEOPLE * METHODS, 0.4);
    let segments = draw(SEGMENTS, 0.6);
    let clips = draw(SEGMENTS * METHODS, 0.4);
    let noise = draw(PEOPLE * SEGMENTS * METHODS, 1.6);
    let mut text = String::from("person,segment,method,rating\n");
    let mut answer = 0;
    for person in 0..PEOPLE {
        for segment in 0..SEGMENTS {
            for method in 0..METHODS {
                let latent = 4.0
                    + 0.15 * method as f64
                    + people[person]
                    + tastes[person * METHODS + method]
                    + segments[segment]
                    + clips[segment * METHODS + method]
                    + noise[answer];
                answer += 1;
                let rating = latent.round().clamp(1.0, 7.0);
                text += &format!("p{person},s{segment},m{method},{rating}\n");
            }
        }
    }
    text
}
