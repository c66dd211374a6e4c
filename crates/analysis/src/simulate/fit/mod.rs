//! Parameters fitted to an export: thresholds and effects by maximum likelihood, spreads of people,
//! segments and clips from covariances of pairs, times by analysis of variance.
//!
//! What an export cannot tell stays as the study's defaults: interactions, trends over trials, the share
//! of careless people, how many decline (they leave no rows), and spreads of which there are no pairs
//! (with one clip an emotion nobody can tell the emotion from its clip).

mod components;
mod ordinal;
mod times;

use std::collections::{BTreeMap, HashMap};

use mimique_stats::{Refusal, Table};
use mimique_study::{Clip, Hypothesis, KindOfQuestion as _, Measure, Scale, Study};

use super::parameters::{ByLevel, Parameters};
use super::scales::{all_scales, factor_levels, segment_places, traits};
use crate::trials::export::{Answer, Export};
use components::{Components, Item, components};
use ordinal::{Cell, OrderedProbit};

/// Most factors to which people are fitted to take differently: pairs are counted for every subset.
const MOST_FACTORS: usize = 3;

impl Parameters {
    /// Fits parameters to a tidy export of the study, its exclusions applied. Refuses an export without
    /// the columns of the tidy form or without any trial.
    pub fn fit(table: &Table, study: &Study) -> Result<Self, Refusal> {
        let export = Export::read(table, study)?;
        if export.answers.is_empty() {
            return Err(Refusal::column(
                "answer",
                "no answer of a trial is left after the study's exclusions",
                "give an export with answers",
            ));
        }
        let mut parameters = Self::for_study(study);
        let clips = study.clips();
        let data = Data::new(&export, study, &clips);
        let scales: BTreeMap<String, Scale> = all_scales(study).into_iter().collect();
        for (response, rating) in &mut parameters.ratings {
            let Some(scale) = scales.get(response) else { continue };
            let points: Vec<(usize, &Answer)> = export
                .answers_to(response)
                .iter()
                .filter_map(|answer| {
                    let point = ((answer.number? - scale.start) / scale.step).round();
                    let inside = point >= 0.0 && point < scale.points as f64;
                    inside.then_some((point as usize, answer))
                })
                .collect();
            let tested = data.tested(response);
            let Some(fitted) = data.fit(&points, scale.points, &tested, &[]) else { continue };
            // From standard deviations to points: thresholds as near half-way as a line can bring them.
            let borders = scale.borders();
            let (zero, unit) = line_through(&fitted.probit.thresholds, &borders);
            if unit.is_nan() || unit <= 0.0 {
                continue;
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
        for (question, recognition) in &mut parameters.recognition {
            let asked = study.all_questions().find(|each| each.id == *question);
            let Some(truth) = asked.and_then(|asked| asked.kind.truth()) else { continue };
            let mut rows: BTreeMap<(String, String), ByLevel> = BTreeMap::new();
            let mut points: Vec<(usize, &Answer)> = Vec::new();
            for answer in export.answers_to(question) {
                let (Some(right), Some(clip)) = (&answer.truth, data.clip(answer)) else {
                    continue;
                };
                let level =
                    clips[clip].factor_text(&recognition.by).unwrap_or_else(|| "*".to_owned());
                let row = rows.entry((right.to_string(), level)).or_default();
                *row.entry(answer.text.to_string()).or_insert(0.0) += 1.0;
                points.push((usize::from(answer.text == *right), answer));
            }
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
            let row_of: Vec<&str> = [truth, recognition.by.as_str()]
                .into_iter()
                .filter(|factor| !factor.is_empty())
                .collect();
            let tested: Vec<String> = data
                .tested(question)
                .into_iter()
                .filter(|factor| !row_of.contains(&factor.as_str()))
                .collect();
            let Some(fitted) = data.fit(&points, 2, &tested, &row_of) else { continue };
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
        fit_about(&export, &mut parameters);
        times::fit(table, &mut parameters);
        rounded(&mut parameters);
        Ok(parameters)
    }
}

/// The answers and where they stand.
struct Data<'e> {
    export: &'e Export,
    study: &'e Study,
    clips: &'e [Clip],
    places: HashMap<&'e str, usize>,
    segments: Vec<usize>,
    levels: BTreeMap<String, Vec<String>>,
    traits: BTreeMap<String, Vec<String>>,
}

/// One fitted response.
struct Fitted {
    probit: OrderedProbit,
    components: Components,
    /// Factors to which people can take differently.
    by: Vec<String>,
    /// Factor, its levels: the effects stand in this order, the last level of each left out.
    tested: Vec<(String, Vec<String>)>,
}

impl<'e> Data<'e> {
    fn new(export: &'e Export, study: &'e Study, clips: &'e [Clip]) -> Self {
        let places = clips.iter().enumerate().map(|(i, clip)| (clip.id.as_str(), i)).collect();
        let segments = segment_places(clips);
        let levels = factor_levels(study, clips);
        Self { export, study, clips, places, segments, levels, traits: traits(study) }
    }

    fn clip(&self, answer: &Answer) -> Option<usize> {
        self.places.get(&*self.export.trials[answer.trial].stimulus).copied()
    }

    /// Factors that hypotheses of one factor name for this response.
    fn tested(&self, response: &str) -> Vec<String> {
        let mut factors: Vec<String> = Vec::new();
        let about = |each: &&Hypothesis| each.response == response && each.measure != Measure::Rt;
        for hypothesis in self.study.hypotheses.iter().filter(about) {
            for factor in &hypothesis.factors {
                if !factors.contains(factor) && self.levels.get(factor).is_some_and(|l| l.len() > 1)
                {
                    factors.push(factor.clone());
                }
            }
        }
        factors
    }

    fn level(&self, answer: &Answer, clip: usize, factor: &str) -> Option<usize> {
        let text = if self.traits.contains_key(factor) {
            let (_, cells) = self.export.about.iter().find(|(name, _)| name == factor)?;
            cells.get(answer.person)?.clone()?
        } else {
            self.clips[clip].factor_text(factor)?
        };
        self.levels.get(factor)?.iter().position(|level| *level == text)
    }

    /// Fits one response: `points` are the chosen points, `rows` factors whose combinations have a mean
    /// of their own that is no effect.
    fn fit(
        &self,
        points: &[(usize, &Answer)],
        count: usize,
        tested: &[String],
        rows: &[&str],
    ) -> Option<Fitted> {
        let mut combinations: BTreeMap<Vec<Option<usize>>, usize> = BTreeMap::new();
        let mut tested: Vec<(String, Vec<String>)> = tested
            .iter()
            .filter_map(|factor| Some((factor.clone(), self.levels.get(factor)?.clone())))
            .collect();
        let placed: Vec<(usize, usize, &Answer)> = points
            .iter()
            .filter_map(|(point, answer)| Some((*point, self.clip(answer)?, *answer)))
            .collect();
        // Only levels that were answered; a factor with one of them has no effect to fit.
        for (factor, levels) in &mut tested {
            let mut seen = vec![false; levels.len()];
            for (_, clip, answer) in &placed {
                if let Some(level) = self.level(answer, *clip, factor) {
                    seen[level] = true;
                }
            }
            *levels =
                levels.iter().zip(seen).filter(|(_, seen)| *seen).map(|(l, _)| l.clone()).collect();
        }
        tested.retain(|(_, levels)| levels.len() > 1);
        for (_, clip, answer) in &placed {
            let key: Vec<_> = rows.iter().map(|row| self.level(answer, *clip, row)).collect();
            let next = combinations.len();
            combinations.entry(key).or_insert(next);
        }
        let row_columns = combinations.len().saturating_sub(1);
        let design = |clip: usize, answer: &Answer| -> Option<Vec<f64>> {
            let mut x = Vec::new();
            for (factor, levels) in &tested {
                let name = &self.levels[factor][self.level(answer, clip, factor)?];
                let level = levels.iter().position(|level| level == name)?;
                // Effects add up to nothing over the levels.
                let last = levels.len() - 1;
                x.extend((0..last).map(|column| match level {
                    _ if level == last => -1.0,
                    _ if level == column => 1.0,
                    _ => 0.0,
                }));
            }
            let key: Vec<_> = rows.iter().map(|row| self.level(answer, clip, row)).collect();
            let row = *combinations.get(&key)?;
            x.extend((0..row_columns).map(|column| f64::from(u8::from(row == column + 1))));
            Some(x)
        };
        let mut cells: BTreeMap<Vec<u64>, Cell> = BTreeMap::new();
        let mut used = Vec::new();
        for (point, clip, answer) in placed {
            let Some(x) = design(clip, answer) else { continue };
            let key = x.iter().map(|value| value.to_bits()).collect();
            let cell =
                cells.entry(key).or_insert_with(|| Cell { x: x.clone(), counts: vec![0.0; count] });
            cell.counts[point] += 1.0;
            used.push((point, clip, answer, x));
        }
        let cells: Vec<Cell> = cells.into_values().collect();
        let mut probit = ordinal::fit(&cells, count)?;
        let by = self.taken_differently(&tested);
        let items: Vec<Item> = used
            .iter()
            .map(|(point, clip, answer, x)| {
                let eta: f64 = x.iter().zip(&probit.effects).map(|(x, effect)| x * effect).sum();
                let level = |factor: &String| {
                    self.level(answer, *clip, factor).map_or(u32::MAX, |level| level as u32)
                };
                let levels = by.iter().map(level).collect();
                let place = (answer.person, *clip, self.segments[*clip]);
                Item::new(place, levels, *point, &probit.thresholds, eta)
            })
            .collect();
        let components = components(&items, by.len());
        // Where rows have means of their own, a threshold is that of the first row: none is used.
        let effects = tested.iter().map(|(_, levels)| levels.len() - 1).sum();
        probit.effects.truncate(effects);
        Some(Fitted { probit, components, by, tested })
    }

    /// Tested factors of clips, and methods.
    fn taken_differently(&self, tested: &[(String, Vec<String>)]) -> Vec<String> {
        let mut by: Vec<String> = tested
            .iter()
            .map(|(factor, _)| factor.clone())
            .filter(|factor| !self.traits.contains_key(factor))
            .collect();
        let several = self.levels.get("method").is_some_and(|levels| levels.len() > 1);
        if several && !by.iter().any(|factor| factor == "method") {
            by.insert(0, "method".to_owned());
        }
        by.truncate(MOST_FACTORS);
        by
    }
}

impl Fitted {
    /// Puts the spreads that the answers tell; the others keep what they have.
    fn spreads(
        &self,
        sd: impl Fn(f64) -> f64,
        (person, segment, clip): (&mut f64, &mut f64, &mut f64),
        by: &mut ByLevel,
    ) {
        for (place, share) in [
            (person, self.components.person),
            (segment, self.components.segment),
            (clip, self.components.clip),
        ] {
            if let Some(share) = share {
                *place = sd(share);
            }
        }
        for (factor, share) in self.by.iter().zip(&self.components.person_by) {
            if let Some(share) = share {
                by.insert(factor.clone(), sd(*share));
            }
        }
    }

    fn effects(&self, unit: f64) -> BTreeMap<String, ByLevel> {
        let mut rest = self.probit.effects.as_slice();
        let mut effects = BTreeMap::new();
        for (factor, levels) in &self.tested {
            let (own, others) = rest.split_at(levels.len() - 1);
            rest = others;
            let last = -own.iter().sum::<f64>();
            let shifts = own.iter().copied().chain([last]).map(|shift| unit * shift);
            effects.insert(factor.clone(), levels.iter().cloned().zip(shifts).collect());
        }
        effects
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
