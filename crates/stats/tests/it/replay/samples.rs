//! Random data of each kind of sample, and how its functions of R and Python are called.

use std::fmt::Display;

use mimique_stats::Sample;
use mimique_test_support::Random;

/// A table and what is done with it.
pub struct Replay {
    /// The table, as CSV.
    pub csv: String,
    /// Options of the procedure.
    pub given: Vec<(&'static str, &'static str)>,
    /// What the functions of R take, with `d` for the table: one call per row of the result.
    pub r: Vec<String>,
    /// The same in Python.
    pub python: Vec<String>,
}

/// A table from its header and rows.
fn csv<const N: usize>(header: [&str; N], rows: impl IntoIterator<Item = [String; N]>) -> String {
    let mut text = header.join(",") + "\n";
    for row in rows {
        text += &(row.join(",") + "\n");
    }
    text
}

fn cells<const N: usize>(cells: [&dyn Display; N]) -> [String; N] {
    cells.map(|cell| cell.to_string())
}

/// A rating from 1 to 7 about a mean.
fn rating(mean: f64, random: &mut Random) -> f64 {
    (mean + random.normal()).round().clamp(1.0, 7.0)
}

/// A sample whose columns need a shape of their own; none of the others.
pub fn special(sample: Sample, procedure: &str, random: &mut Random) -> Option<Replay> {
    let one = |csv: String, given, r: &str, python: &str| Replay {
        csv,
        given,
        r: vec![r.to_owned()],
        python: vec![python.to_owned()],
    };
    Some(match sample {
        Sample::Comparisons | Sample::Tournaments => one(
            comparisons(sample == Sample::Comparisons, random),
            vec![
                ("participant", "p"),
                ("left", "l"),
                ("right", "r"),
                ("answer", "a"),
                ("rounds", "0"),
            ],
            "d$p, d$l, d$r, d$a",
            "d['p'], d['l'], d['r'], d['a']",
        ),
        Sample::PeopleAndSegments => one(
            people_and_segments(random),
            vec![("rating", "y"), ("method", "m"), ("participant", "p"), ("segment", "s")],
            "d$y, d$m, d$p, d$s",
            "d['y'], d['m'], d['p'], d['s']",
        ),
        Sample::MixedModel => one(
            rated_clips(random),
            vec![("rating", "y"), ("factors", "m"), ("groups", "p,p:m,s,s:m")],
            "d$y, d$m, d$p, d$s",
            "d['y'], d['m'], d['p'], d['s']",
        ),
        Sample::LinearMixedModel => one(
            rated_clips(random),
            vec![("response", "y"), ("factors", "m"), ("groups", "p,p:m,s,s:m")],
            "d$y, d$m, d$p, d$s",
            "d['y'], d['m'], d['p'], d['s']",
        ),
        Sample::Equivalence => one(
            csv(["y"], (0..24).map(|_| cells([&((random.normal() * 10.0).round() / 10.0)]))),
            vec![("difference", "y"), ("bounds", "-0.75,0.9")],
            "d$y, -0.75, 0.9",
            "d['y'], -0.75, 0.9",
        ),
        Sample::Ratings => one(
            ratings(random),
            vec![("rating", "y"), ("clip", "c"), ("rater", "r")],
            "matrix(d$y, ncol = 4, byrow = TRUE)",
            "d['y'].reshape(-1, 4)",
        ),
        Sample::Panel => one(
            panel(random),
            vec![
                ("rating", "y"),
                ("participant", "p"),
                ("segment", "s"),
                ("condition", "c"),
                ("reference", "ref"),
                ("anchor", "anchor"),
            ],
            "d$p, d$s, d$c, d$y, \"ref\", \"anchor\"",
            "d['p'], d['s'], d['c'], d['y'], 'ref', 'anchor'",
        ),
        Sample::Answers => Replay {
            csv: answers(random),
            given: vec![("participant", "p"), ("truth", "t"), ("answer", "a")],
            r: EMOTIONS.map(|e| format!("d$p, d$t, d$a, \"{e}\"")).to_vec(),
            python: EMOTIONS.map(|e| format!("d['p'], d['t'], d['a'], '{e}'")).to_vec(),
        },
        Sample::Coefficient => coefficient(procedure, random),
        _ => return None,
    })
}

/// Choices between three items: each pair in both orders by each of ten people, with ties; or once by each of five
/// judges, without.
fn comparisons(with_ties: bool, random: &mut Random) -> String {
    let items = ["u", "v", "w"];
    let people = if with_ties { 10 } else { 5 };
    let mut rows = Vec::new();
    for person in 0..people {
        for (left, right) in [(0, 1), (1, 2), (2, 0), (1, 0), (2, 1), (0, 2)] {
            if !with_ties && left > right {
                continue;
            }
            let lead = 0.5 * (left as f64 - right as f64) + 0.3 + random.normal();
            let answer = match lead {
                lead if with_ties && lead.abs() < 0.3 => "same",
                lead if lead > 0.0 => "left",
                _ => "right",
            };
            rows.push(cells([&person, &items[left], &items[right], &answer]));
        }
    }
    csv(["p", "l", "r", "a"], rows)
}

fn people_and_segments(random: &mut Random) -> String {
    let mut rows = Vec::new();
    for person in 0..7 {
        for segment in 0..5 {
            for method in 0..3 {
                let y = rating(3.5 + 0.3 * f64::from(method), random);
                rows.push(cells([&y, &method, &person, &segment]));
            }
        }
    }
    csv(["y", "m", "p", "s"], rows)
}

/// People and segments differ, and so do people's tastes and clips: no standard deviation is 0.
fn rated_clips(random: &mut Random) -> String {
    let mut draw = |count: usize| (0..count).map(|_| random.normal()).collect::<Vec<_>>();
    let (people, tastes, segments, clips) = (draw(10), draw(20), draw(8), draw(16));
    let mut rows = Vec::new();
    for person in 0..10 {
        for segment in 0..8 {
            for method in 0..2 {
                let mean = 2.8
                    + 0.4 * method as f64
                    + 0.7 * people[person]
                    + 0.5 * tastes[2 * person + method]
                    + 0.6 * segments[segment]
                    + 0.5 * clips[2 * segment + method];
                let y = (mean + random.normal()).round().clamp(1.0, 5.0);
                rows.push(cells([&y, &method, &person, &segment]));
            }
        }
    }
    csv(["y", "m", "p", "s"], rows)
}

fn ratings(random: &mut Random) -> String {
    let mut rows = Vec::new();
    for clip in 0..9 {
        let level = 4.0 + 1.5 * random.normal();
        for rater in 0..4 {
            rows.push(cells([&clip, &rater, &rating(level, random)]));
        }
    }
    csv(["c", "r", "y"], rows)
}

fn panel(random: &mut Random) -> String {
    let mut rows = Vec::new();
    for person in 0..9 {
        for segment in 0..6 {
            for (condition, mean) in
                [("ref", 99.0), ("anchor", 60.0), ("a", 50.0), ("b", 51.0), ("c", 53.0)]
            {
                let y = (mean + 5.0 * random.normal()).round().clamp(0.0, 100.0);
                rows.push(cells([&person, &segment, &condition, &y]));
            }
        }
    }
    csv(["p", "s", "c", "y"], rows)
}

const EMOTIONS: [&str; 3] = ["anger", "fear", "joy"];

fn answers(random: &mut Random) -> String {
    let mut rows = Vec::new();
    for person in 0..8 {
        for truth in EMOTIONS {
            for _ in 0..6 {
                let told = random.uniform() < 0.6;
                let other = EMOTIONS[(random.uniform() * 3.0) as usize];
                rows.push(cells([&person, &truth, if told { &truth } else { &other }]));
            }
        }
    }
    csv(["p", "t", "a"], rows)
}

fn coefficient(procedure: &str, random: &mut Random) -> Replay {
    let (csv, given, r, python) = match procedure {
        "cronbach" => {
            let row = |_| {
                let own = 4.0 + random.normal();
                [0; 4].map(|_| rating(own, random).to_string())
            };
            let rows: Vec<_> = (0..20).map(row).collect();
            (
                csv(["q1", "q2", "q3", "q4"], rows),
                vec![("questions", "q1,q2,q3,q4")],
                "as.matrix(d)",
                "np.column_stack([d[q] for q in d.dtype.names])",
            )
        }
        "krippendorff" => (
            ratings(random),
            vec![
                ("value", "y"),
                ("clip", "c"),
                ("rater", "r"),
                ("level", "ordinal"),
                ("rounds", "0"),
            ],
            "matrix(d$y, ncol = 4, byrow = TRUE), \"ordinal\"",
            "d['y'].reshape(-1, 4).astype(float), 'ordinal'",
        ),
        "difference-scaling" => {
            let mut rows = Vec::new();
            for a in 0..5 {
                for b in a + 1..5 {
                    for c in b + 1..5 {
                        for _ in 0..8 {
                            let scale = |level: i32| 3.0 * f64::from(level).sqrt();
                            let lead = scale(c) - 2.0 * scale(b) + scale(a) + random.normal();
                            rows.push(cells([&a, &b, &c, &u8::from(lead > 0.0)]));
                        }
                    }
                }
            }
            (
                csv(["a", "b", "c", "y"], rows),
                vec![("levels", "a,b,c"), ("answer", "y")],
                "as.matrix(d[, 1:3]), d$y",
                "np.column_stack([d['a'], d['b'], d['c']]), d['y']",
            )
        }
        "psychometric" => {
            let row = |step: i32| {
                let level = f64::from(step) / 10.0;
                let seen = 0.5 + 0.48 / (1.0 + (-(level - 0.5) / 0.12).exp());
                let right = (0..40).filter(|_| random.uniform() < seen).count();
                cells([&level, &40, &right])
            };
            let rows: Vec<_> = (1..10).map(row).collect();
            (
                csv(["x", "n", "y"], rows),
                vec![
                    ("level", "x"),
                    ("n", "n"),
                    ("correct", "y"),
                    ("lapse", "0.02"),
                    ("rounds", "0"),
                ],
                "d$x, d$n, d$y",
                "d['x'], d['n'], d['y']",
            )
        }
        other => unreachable!("{other} has no data"),
    };
    Replay { csv, given, r: vec![r.to_owned()], python: vec![python.to_owned()] }
}

/// What the functions of a coefficient give, and where it stands in the procedure's result.
pub fn told(procedure: &str) -> &'static [(&'static str, &'static str)] {
    match procedure {
        "cronbach" => &[
            ("alpha", "/alpha"),
            ("low", "/interval_95_feldt/0"),
            ("high", "/interval_95_feldt/1"),
        ],
        "krippendorff" => &[("alpha", "/levels/ordinal/alpha")],
        "difference-scaling" => &[
            ("psi.5", "/scale/4"),
            ("psi.3", "/scale/2"),
            ("se.3", "/se/2"),
            ("loglik", "/loglik"),
        ],
        "psychometric" => {
            &[("location", "/location"), ("scale", "/scale_or_shape"), ("loglik", "/loglik")]
        }
        other => unreachable!("{other} tells nothing"),
    }
}
