//! Parameters fitted to an export: thresholds and effects by maximum likelihood, spreads of people,
//! segments and clips from covariances of pairs, worths of choices by Bradley and Terry's model, times by analysis of
//! variance.
//!
//! What an export cannot tell stays as the study's defaults: interactions, trends over trials, the share
//! of careless people, how many decline (they leave no rows), and spreads of which there are no pairs
//! (with one clip an emotion nobody can tell the emotion from its clip).

mod choices;
mod components;
mod ordinal;
mod response;
mod times;

use std::collections::BTreeMap;

use mimique_stats::Table;
use mimique_study::{KindOfQuestion as _, Scale, Study};

use super::parameters::{ByLevel, Parameters, Rating, Recognition};
use super::scales::all_scales;
use crate::trials::error::ExportError;
use crate::trials::export::{Answer, Export};
use response::Data;

impl Parameters {
    /// Fits parameters to a tidy export of the study, its exclusions applied. Refuses an export without
    /// the columns of the tidy form or without any trial.
    pub fn fit(table: &Table, study: &Study) -> Result<Self, ExportError> {
        let export = Export::read(table, study)?;
        if export.answers.is_empty() {
            return Err(ExportError::NoAnswer);
        }
        let mut parameters = Self::for_study(study);
        let clips = study.clips();
        let data = Data::new(&export, study, &clips);
        let scales: BTreeMap<String, Scale> = all_scales(study).into_iter().collect();
        for (response, rating) in &mut parameters.ratings {
            if let Some(scale) = scales.get(response) {
                fit_rating(&data, response, scale, rating);
            }
        }
        for (question, recognition) in &mut parameters.recognition {
            let asked = study.all_questions().find(|each| each.id == *question);
            if let Some(truth) = asked.and_then(|asked| asked.kind.truth()) {
                fit_recognition(&data, question, truth, recognition);
            }
        }
        for (question, compared) in &mut parameters.comparisons {
            choices::fit(&export, question, compared);
        }
        fit_about(&export, &mut parameters);
        times::fit(table, &mut parameters);
        rounded(&mut parameters);
        Ok(parameters)
    }
}

/// Thresholds, effects and spreads of a rating; what cannot be fitted stays.
fn fit_rating(data: &Data<'_>, response: &str, scale: &Scale, rating: &mut Rating) {
    let points: Vec<(usize, &Answer)> = data
        .export
        .answers_to(response)
        .iter()
        .filter_map(|answer| {
            let point = ((answer.number? - scale.start) / scale.step).round();
            let inside = point >= 0.0 && point < scale.points as f64;
            inside.then_some((point as usize, answer))
        })
        .collect();
    let tested = data.tested(response);
    let Some(fitted) = data.fit(&points, scale.points, &tested, &[]) else { return };
    // From standard deviations to points: thresholds as near half-way as a line can bring them.
    let borders = scale.borders();
    let (zero, unit) = line_through(&fitted.probit.thresholds, &borders);
    if unit.is_nan() || unit <= 0.0 {
        return;
    }
    let sd = |share: f64| unit * share.max(0.0).sqrt();
    rating.mean = zero;
    rating.thresholds =
        fitted.probit.thresholds.iter().map(|threshold| zero + unit * threshold).collect();
    rating.noise_sd = sd(fitted.components.noise());
    fitted.spreads(
        sd,
        (&mut rating.person_sd, &mut rating.segment_sd, &mut rating.clip_sd),
        &mut rating.person_by_sd,
    );
    rating.effects = fitted.effects(unit);
    rating.interactions.clear();
    rating.per_trial = 0.0;
}

/// Confusion matrices, effects and spreads of a recognition; what cannot be fitted stays.
fn fit_recognition(data: &Data<'_>, question: &str, truth: &str, recognition: &mut Recognition) {
    let mut rows: BTreeMap<(String, String), ByLevel> = BTreeMap::new();
    let mut points: Vec<(usize, &Answer)> = Vec::new();
    for answer in data.export.answers_to(question) {
        let (Some(right), Some(clip)) = (&answer.truth, data.clip(answer)) else {
            continue;
        };
        let level = data.clips[clip].factor_text(&recognition.by).unwrap_or_else(|| "*".to_owned());
        let row = rows.entry((right.to_string(), level)).or_default();
        *row.entry(answer.text.to_string()).or_insert(0.0) += 1.0;
        points.push((usize::from(answer.text == *right), answer));
    }
    fit_confusion(&rows, recognition);
    let row_of: Vec<&str> =
        [truth, recognition.by.as_str()].into_iter().filter(|factor| !factor.is_empty()).collect();
    let tested: Vec<String> = data
        .tested(question)
        .into_iter()
        .filter(|factor| !row_of.contains(&factor.as_str()))
        .collect();
    let Some(fitted) = data.fit(&points, 2, &tested, &row_of) else { return };
    // The noise has a standard deviation of 1.
    let unit = 1.0 / fitted.components.noise().sqrt();
    let sd = |share: f64| unit * share.max(0.0).sqrt();
    fitted.spreads(
        sd,
        (&mut recognition.person_sd, &mut recognition.segment_sd, &mut recognition.clip_sd),
        &mut recognition.person_by_sd,
    );
    recognition.effects = fitted.effects(unit);
    recognition.interactions.clear();
}

/// Shares of the answers in each row (right answer and level) that was seen, from counts by answer.
fn fit_confusion(rows: &BTreeMap<(String, String), ByLevel>, recognition: &mut Recognition) {
    for (right, levels) in &mut recognition.confusion {
        for (level, shares) in levels {
            let Some(counts) = rows.get(&(right.clone(), level.clone())) else { continue };
            // One answer's worth of the default keeps what was never seen possible.
            let sum: f64 = shares.values().sum();
            let n = counts.values().sum::<f64>() + 1.0;
            for (answer, share) in shares.iter_mut() {
                let seen = counts.get(answer).copied().unwrap_or(0.0);
                *share = (seen + *share / sum.max(1e-12)) / n;
            }
        }
    }
}

/// The line that takes thresholds to borders, weighted by how well each is known.
fn line_through(thresholds: &[f64], borders: &[f64]) -> (f64, f64) {
    let weights: Vec<f64> = thresholds.iter().map(|&t| ordinal::density(t).powi(2)).collect();
    let sum: f64 = weights.iter().sum();
    let mean = |of: &[f64]| of.iter().zip(&weights).map(|(v, w)| v * w).sum::<f64>() / sum;
    let (x, y) = (mean(thresholds), mean(borders));
    let (mut xy, mut xx) = (0.0, 0.0);
    for ((t, b), w) in thresholds.iter().zip(borders).zip(&weights) {
        xy += w * (t - x) * (b - y);
        xx += w * (t - x) * (t - x);
    }
    // Two points only: a threshold alone has no distance to go by.
    let unit = if thresholds.len() > 1 { xy / xx } else { 1.0 };
    (y - unit * x, unit)
}

/// Answers about the participant.
fn fit_about(export: &Export, parameters: &mut Parameters) {
    for (question, cells) in &export.about {
        let used = cells.iter().zip(&export.people).filter(|(_, who)| who.excluded.is_none());
        let told: Vec<&str> = used.filter_map(|(cell, _)| cell.as_deref()).collect();
        if told.is_empty() {
            continue;
        }
        if let Some(shares) = parameters.choices.get_mut(question) {
            for (option, share) in shares.iter_mut() {
                let chosen = told.iter().filter(|cell| *cell == option).count() as f64;
                *share = (chosen + 0.5) / (told.len() as f64 + 1.0);
            }
        }
        let numbers: Vec<f64> = told.iter().filter_map(|cell| cell.parse().ok()).collect();
        let n = numbers.len() as f64;
        if n < 2.0 {
            continue;
        }
        let mean = numbers.iter().sum::<f64>() / n;
        let sd = (numbers.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / (n - 1.0)).sqrt();
        if let Some(number) = parameters.numbers.get_mut(question) {
            (number.mean, number.sd) = (mean, sd);
        }
        if let Some(rating) = parameters.ratings.get_mut(question) {
            (rating.mean, rating.noise_sd) = (mean, sd);
        }
    }
}

/// Four decimals are more than any study can tell, and the file is for people.
fn rounded(parameters: &mut Parameters) {
    let short = |value: &mut f64| *value = (*value * 1e4).round() / 1e4;
    for rating in parameters.ratings.values_mut() {
        let parts = [
            &mut rating.mean,
            &mut rating.noise_sd,
            &mut rating.person_sd,
            &mut rating.segment_sd,
            &mut rating.clip_sd,
        ];
        parts.into_iter().for_each(short);
        rating.thresholds.iter_mut().for_each(short);
        rating.person_by_sd.values_mut().for_each(short);
        rating.effects.values_mut().flat_map(BTreeMap::values_mut).for_each(short);
    }
    for recognition in parameters.recognition.values_mut() {
        let parts =
            [&mut recognition.person_sd, &mut recognition.segment_sd, &mut recognition.clip_sd];
        parts.into_iter().for_each(short);
        recognition.person_by_sd.values_mut().for_each(short);
        recognition.effects.values_mut().flat_map(BTreeMap::values_mut).for_each(short);
        let rows = recognition.confusion.values_mut().flat_map(BTreeMap::values_mut);
        rows.flat_map(BTreeMap::values_mut).for_each(short);
    }
    for compared in parameters.comparisons.values_mut() {
        compared.worth.values_mut().for_each(short);
        short(&mut compared.side);
        short(&mut compared.tie);
    }
    parameters.choices.values_mut().flat_map(BTreeMap::values_mut).for_each(short);
    for number in parameters.numbers.values_mut() {
        short(&mut number.mean);
        short(&mut number.sd);
    }
    let (times, display) = (&mut parameters.times, &mut parameters.display);
    for part in [
        &mut times.median_ms,
        &mut times.sigma,
        &mut times.person_sigma,
        &mut times.clip_ms,
        &mut parameters.dropout.per_trial,
        &mut display.refresh_hz,
        &mut display.late_share,
        &mut display.slow_people,
        &mut display.slow_late_share,
        &mut display.replay,
        &mut display.cut_short,
        &mut display.focus_loss,
        &mut display.reload,
    ] {
        short(part);
    }
}
