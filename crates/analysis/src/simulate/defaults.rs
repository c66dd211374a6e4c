//! Default parameters of a study: effects of the size that comparable studies found.
//!
//! * Ratings: a mean at two thirds of the scale and effects of 0.4 points of 7, as C. Reverdy's thesis
//!   (2019) measured (tables 6.6 and 6.9: means 4.5-5.9; 0.29 points between two settings of one method,
//!   0.39 between two methods). Noise 1 point of 7, people 0.6, people x method 0.3, segments 0.3,
//!   clips 0.1: as in the simulation of `study-config/power`.
//! * Recognition: 62 % right on average, the thesis's precision on animations (tables 6.6, 6.9), confused
//!   as its section 6.3.3 says: anger and disgust with each other, fear with surprise, sadness with fear
//!   and surprise. The shares themselves are set here; fit them to answers of your own.
//! * Choices between two clips: worths a just noticeable difference (ln 3) apart from the first to the last level of a
//!   hypothesis, else 0; people differ by 0.5 per level, clips by 0.2; of two equal clips no difference is seen in
//!   23 %; 2 % of answers are given without looking.
//! * Everything else is what online studies commonly see; none of it decides a test.

use std::collections::BTreeMap;

use mimique_stats::{normal_quantile_upper, normal_upper};
use mimique_study::{Hypothesis, KindOfQuestion as _, Measure, Question, Scale, Simulated, Study};

use super::parameters::{
    ByLevel, Careless, Compared, Display, Dropout, Interaction, NumberAnswer, Parameters, Rating,
    Recognition, Times,
};
use super::scales::{all_scales, factor_levels, traits};
use crate::hypothesis::is_two_way;

/// Largest difference between two levels, in sixths of a scale (points of a scale of 7).
const RATING_EFFECT: f64 = 0.4;
/// The same of a recognition, in standard deviations of the noise: about 9 points of percent.
const RECOGNITION_EFFECT: f64 = 0.25;
/// The same of a time, as its logarithm.
const TIME_EFFECT: f64 = 0.1;

/// From the first to the last level of a factor that choices are tested of: ln 3, chosen in 75 %.
const WORTH_EFFECT: f64 = 1.1;

/// Answers to the six emotions, a row a right answer.
const CONFUSION: [(&str, [(&str, f64); 6]); 6] = [
    (
        "anger",
        [
            ("anger", 0.60),
            ("disgust", 0.25),
            ("fear", 0.04),
            ("joy", 0.02),
            ("sadness", 0.05),
            ("surprise", 0.04),
        ],
    ),
    (
        "disgust",
        [
            ("anger", 0.27),
            ("disgust", 0.55),
            ("fear", 0.05),
            ("joy", 0.02),
            ("sadness", 0.08),
            ("surprise", 0.03),
        ],
    ),
    (
        "fear",
        [
            ("anger", 0.04),
            ("disgust", 0.05),
            ("fear", 0.42),
            ("joy", 0.01),
            ("sadness", 0.08),
            ("surprise", 0.40),
        ],
    ),
    (
        "joy",
        [
            ("anger", 0.02),
            ("disgust", 0.02),
            ("fear", 0.01),
            ("joy", 0.87),
            ("sadness", 0.02),
            ("surprise", 0.06),
        ],
    ),
    (
        "sadness",
        [
            ("anger", 0.06),
            ("disgust", 0.08),
            ("fear", 0.15),
            ("joy", 0.02),
            ("sadness", 0.55),
            ("surprise", 0.14),
        ],
    ),
    (
        "surprise",
        [
            ("anger", 0.02),
            ("disgust", 0.02),
            ("fear", 0.12),
            ("joy", 0.08),
            ("sadness", 0.01),
            ("surprise", 0.75),
        ],
    ),
];
/// Share of right answers of anything else.
const OTHER_HIT: f64 = 0.62;
/// Share of an answer that is none of the six emotions.
const OTHER_ANSWER: f64 = 0.03;
/// Shift from one level of intensity to the next.
const INTENSITY_STEP: f64 = 0.15;

/// How far the anchor of a panel is rated below the other conditions, of 100 points.
const ANCHOR_BELOW: f64 = 30.0;

/// By how much confidence is higher after a right answer, in standard deviations of its noise.
const SURER_IF_RIGHT: f64 = 1.0;

impl Parameters {
    /// The default parameters of a study.
    pub fn for_study(study: &Study) -> Self {
        let clips = study.clips();
        let levels = factor_levels(study, &clips);
        let in_trials = |id: &str| study.questions.iter().any(|question| question.id == id);
        let mut ratings = BTreeMap::new();
        for (response, scale) in all_scales(study) {
            let question = response.split('.').next().unwrap_or(&response);
            let shown = in_trials(&response) || in_trials(question);
            let mut rating = rating(study, &levels, &response, scale, shown);
            anchored(study, &mut rating, &response);
            ratings.insert(response, rating);
        }
        let mut recognition = BTreeMap::new();
        let mut choices = BTreeMap::new();
        let mut numbers = BTreeMap::new();
        let mut comparisons = BTreeMap::new();
        for question in study.all_questions() {
            let id = || question.id.clone();
            match question.kind.simulated() {
                Simulated::OneOption if question.kind.truth().is_some() => {
                    recognition.insert(id(), recognised(study, &levels, question));
                }
                Simulated::OneOption
                | Simulated::SeveralOptions { .. }
                | Simulated::Drawn { by_shares: true } => {
                    let options = question.kind.options();
                    let share = 1.0 / options.len().max(1) as f64;
                    let shares = options.iter().map(|option| (option.value.clone(), share));
                    choices.insert(id(), shares.collect());
                }
                Simulated::Number(field) => {
                    numbers.insert(id(), typed_number(field.minimum, field.maximum));
                }
                Simulated::Compared { .. } => {
                    comparisons.insert(id(), compared(study, &levels, question));
                }
                Simulated::Rated | Simulated::Drawn { by_shares: false } => {}
            }
        }
        Self {
            ratings,
            recognition,
            comparisons,
            panels: super::panels::defaults(study),
            discrimination: super::levels::defaults(study),
            scaling: super::scaling::defaults(study),
            templates: super::faces::defaults(study),
            choices,
            numbers,
            times: times(study, &levels),
            careless: Careless { share: 0.03, attention_pass: 0.5, time_share: 0.4 },
            attention_pass: 0.98,
            dropout: Dropout { declined: 0.03, per_trial: 0.001, withdrawn: 0.1 },
            display: Display {
                refresh_hz: 60.0,
                late_share: 0.002,
                slow_people: 0.05,
                slow_late_share: 0.15,
                webgl2: 0.3,
                replay: 0.08,
                cut_short: 0.004,
                focus_loss: 0.01,
                reload: 0.002,
            },
        }
    }
}

type Levels = BTreeMap<String, Vec<String>>;

/// The anchor of a panel is rated far below the rest.
fn anchored(study: &Study, rating: &mut Rating, response: &str) {
    for (_, block) in study.panel_blocks().filter(|(_, block)| block.question == response) {
        if let Some(anchor) = block.anchor {
            rating.effects.entry(block.compare).or_default().insert(anchor, -ANCHOR_BELOW);
        }
    }
}

/// A number within bounds. Most numbers that a study asks for are ages.
fn typed_number(minimum: Option<f64>, maximum: Option<f64>) -> NumberAnswer {
    let (low, high) = (minimum.unwrap_or(0.0), maximum.unwrap_or(100.0));
    let (mean, sd) = if low <= 30.0 && high >= 60.0 {
        (30.0, 10.0)
    } else {
        ((low + high) / 2.0, (high - low) / 6.0)
    };
    NumberAnswer { mean, sd }
}

/// Response times, shifted by the factors of hypotheses about them.
fn times(study: &Study, levels: &Levels) -> Times {
    let mut effects = BTreeMap::new();
    for hypothesis in study.hypotheses.iter().filter(|each| each.measure == Measure::Rt) {
        for factor in &hypothesis.factors {
            let shifts = spread(&tested(hypothesis, factor, levels), TIME_EFFECT);
            effects.insert(factor.clone(), shifts);
        }
    }
    Times { median_ms: 2500.0, sigma: 0.5, person_sigma: 0.3, effects, clip_ms: 3000.0 }
}

fn rating(study: &Study, levels: &Levels, response: &str, scale: Scale, in_trials: bool) -> Rating {
    let unit = scale.span() / 6.0;
    let mut rating = Rating {
        mean: scale.start + scale.span() * 2.0 / 3.0,
        noise_sd: if in_trials { unit } else { 1.5 * unit },
        person_sd: 0.0,
        person_by_sd: ByLevel::new(),
        segment_sd: 0.0,
        clip_sd: 0.0,
        thresholds: Vec::new(),
        effects: BTreeMap::new(),
        interactions: Vec::new(),
        per_trial: 0.0,
    };
    if in_trials {
        let of = |each: &&Hypothesis| each.response == response && each.measure != Measure::Rt;
        let tested: Vec<&Hypothesis> = study.hypotheses.iter().filter(of).collect();
        (rating.effects, rating.interactions) = effects(&tested, levels, RATING_EFFECT * unit);
        (rating.person_sd, rating.segment_sd, rating.clip_sd) =
            (0.6 * unit, 0.3 * unit, 0.1 * unit);
        rating.person_by_sd = takes_to(study, &tested, levels, 0.3 * unit);
    }
    rating
}

fn recognised(study: &Study, levels: &Levels, question: &Question) -> Recognition {
    let of = |each: &&Hypothesis| each.response == question.id && each.measure != Measure::Rt;
    let tested: Vec<&Hypothesis> = study.hypotheses.iter().filter(of).collect();
    let truth = question.kind.truth().unwrap_or_default();
    let none = Vec::new();
    let by =
        if levels.contains_key("intensity") && truth != "intensity" { "intensity" } else { "" };
    let steps = levels.get(by).unwrap_or(&none);
    let answers: Vec<&str> =
        question.kind.options().iter().map(|option| option.value.as_str()).collect();
    let mut confusion = BTreeMap::new();
    for right in
        levels.get(truth).unwrap_or(&none).iter().filter(|each| answers.contains(&each.as_str()))
    {
        let row = row(right, &answers);
        let mut rows = BTreeMap::new();
        if steps.len() < 2 {
            rows.insert("*".to_owned(), row);
        } else {
            for (place, step) in steps.iter().enumerate() {
                let shift = INTENSITY_STEP * (place as f64 - (steps.len() - 1) as f64 / 2.0);
                rows.insert(step.clone(), shifted(&row, right, shift));
            }
        }
        confusion.insert(right.clone(), rows);
    }
    let (mut effects, interactions) = effects(&tested, levels, RECOGNITION_EFFECT);
    // What the clip shows is in the matrix.
    effects.retain(|factor, _| factor != truth && factor != by);
    Recognition {
        by: if steps.len() < 2 { String::new() } else { by.to_owned() },
        confusion,
        person_sd: 0.3,
        person_by_sd: takes_to(study, &tested, levels, 0.15),
        segment_sd: 0.2,
        clip_sd: 0.05,
        effects,
        interactions,
        confidence: question.kind.confidence().map_or(0.0, |_| SURER_IF_RIGHT),
    }
}

/// Worths of the levels that a hypothesis compares, else of the methods.
fn compared(study: &Study, levels: &Levels, question: &Question) -> Compared {
    let of = |each: &&Hypothesis| each.response == question.id && each.test.is_of_choices();
    let hypothesis = study.hypotheses.iter().find(of);
    let factor = hypothesis.and_then(|each| each.factors.first()).map_or("method", String::as_str);
    let worth = hypothesis.map_or_else(ByLevel::new, |each| {
        let named = tested(each, factor, levels);
        let shown = study.levels_chosen_between(question, factor, &named);
        let shown =
            named.into_iter().filter(|level| shown.iter().flatten().any(|own| own == level));
        spread(&shown.collect::<Vec<_>>(), WORTH_EFFECT)
    });
    Compared {
        factor: factor.to_owned(),
        worth,
        person_sd: 0.5,
        segment_sd: 0.2,
        side: 0.0,
        tie: -0.5,
        lapse: 0.02,
    }
}

/// The row of one right answer: shares add up to 1.
fn row(right: &str, answers: &[&str]) -> ByLevel {
    let known = CONFUSION.iter().find(|(emotion, _)| *emotion == right);
    let mut row: ByLevel = answers
        .iter()
        .map(|answer| {
            let share = match known {
                Some((_, shares)) => shares
                    .iter()
                    .find(|(each, _)| each == answer)
                    .map_or(OTHER_ANSWER, |(_, share)| *share),
                None if *answer == right => OTHER_HIT,
                None => (1.0 - OTHER_HIT) / (answers.len().max(2) - 1) as f64,
            };
            ((*answer).to_owned(), share)
        })
        .collect();
    let sum: f64 = row.values().sum();
    row.values_mut().for_each(|share| *share = rounded(*share / sum));
    row
}

fn shifted(row: &ByLevel, right: &str, shift: f64) -> ByLevel {
    let hit = row.get(right).copied().unwrap_or(0.0).clamp(1e-6, 1.0 - 1e-6);
    let new = normal_upper(normal_quantile_upper(hit) - shift).p;
    let scale = (1.0 - new) / (1.0 - hit);
    row.iter()
        .map(|(answer, share)| {
            (answer.clone(), rounded(if answer == right { new } else { share * scale }))
        })
        .collect()
}

/// Three decimals: the file is for people.
fn rounded(value: f64) -> f64 {
    (value * 1000.0).round() / 1000.0
}

/// How people take to the factors that are tested within them, to methods where none is.
fn takes_to(study: &Study, tested: &[&Hypothesis], levels: &Levels, sd: f64) -> ByLevel {
    let about = traits(study);
    let within = tested.iter().flat_map(|each| &each.factors);
    let mut by: ByLevel = within
        .filter(|factor| levels.contains_key(*factor) && !about.contains_key(*factor))
        .map(|factor| (factor.clone(), rounded(sd)))
        .collect();
    if by.is_empty() && levels.contains_key("method") {
        by.insert("method".to_owned(), rounded(sd));
    }
    by
}

/// The effects that hypotheses look for: levels evenly spread over `size`; of two factors a pattern
/// that no single factor explains.
fn effects(
    tested_by: &[&Hypothesis],
    levels: &Levels,
    size: f64,
) -> (BTreeMap<String, ByLevel>, Vec<Interaction>) {
    let (mut effects, mut interactions) = (BTreeMap::new(), Vec::new());
    for hypothesis in tested_by {
        match (hypothesis.factors.as_slice(), is_two_way(hypothesis.test)) {
            ([a, b, ..], true) => {
                let (of_a, of_b) =
                    (tested(hypothesis, a, levels), levels.get(b).cloned().unwrap_or_default());
                for (i, level_a) in of_a.iter().enumerate() {
                    for (j, level_b) in of_b.iter().enumerate() {
                        // Alternating signs, centred: rows and columns add up to about nothing.
                        let sign = if (i + j) % 2 == 0 { 0.5 } else { -0.5 };
                        interactions.push(Interaction {
                            levels: BTreeMap::from([
                                (a.clone(), level_a.clone()),
                                (b.clone(), level_b.clone()),
                            ]),
                            shift: rounded(sign * size),
                        });
                    }
                }
            }
            ([factor, ..], _) => {
                effects
                    .entry(factor.clone())
                    .or_insert_with(|| spread(&tested(hypothesis, factor, levels), size));
            }
            ([], _) => {}
        }
    }
    (effects, interactions)
}

fn tested(hypothesis: &Hypothesis, factor: &str, levels: &Levels) -> Vec<String> {
    let named: Vec<String> = hypothesis.levels.iter().map(ToString::to_string).collect();
    if hypothesis.factors.first().is_some_and(|first| first == factor) && !named.is_empty() {
        return named;
    }
    levels.get(factor).cloned().unwrap_or_default()
}

fn spread(levels: &[String], size: f64) -> ByLevel {
    let steps = (levels.len().max(2) - 1) as f64;
    let shift = |place: usize| rounded(size * (0.5 - place as f64 / steps));
    levels.iter().enumerate().map(|(place, level)| (level.clone(), shift(place))).collect()
}
