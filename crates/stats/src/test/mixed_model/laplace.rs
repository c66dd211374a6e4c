//! The likelihood of a mixed model by Laplace's approximation, with its exact gradient, and its maximum.
//!
//! With b the effects in units of their standard deviations and h(b) = -ln P(answers | b) + b'b / 2, minus the log
//! likelihood is h(b̂) + ln det H(b̂) / 2 at the mode b̂ of h, H its second derivatives there. Its gradient counts that
//! b̂ moves with the parameters: db̂/dψ = -H^-1 d²h/(db dψ). Parameters are the first threshold, the logarithms of
//! the steps between thresholds, the fixed effects, and the standard deviations. The likelihood is an even function
//! of each of these, so that 0 is no bound: a sign means nothing and is dropped at the end.

use super::cumulative::Thresholds;
use super::design::Layout;
use super::effects::{Factored, Weights};
use crate::numerics::dot;

/// Newton's steps to the mode of the effects.
const MODE_STEPS: usize = 60;
/// A step to the mode after which the next one, its square, is rounding.
const LAST_STEP: f64 = 1e-6;
/// Where the standard deviations begin.
const START_SD: f64 = 0.5;

/// What a model is fitted to, answers in the order of the layout.
#[derive(Clone)]
pub(super) struct Data {
    /// Category of each answer, from 0.
    pub category: Vec<u32>,
    pub categories: usize,
    /// Answers x columns.
    pub fixed: Vec<f64>,
    pub columns: usize,
    pub layout: Layout,
}

/// The objective, with the modes that it found last: the next search for them starts there.
#[derive(Clone)]
pub(super) struct Objective<'a> {
    data: &'a Data,
    pub modes: Vec<f64>,
    system: Factored,
}

/// The answers at some effects: h, and the first two derivatives of each answer by its predictor.
struct AtEffects {
    height: f64,
    first: Vec<f64>,
    second: Vec<f64>,
}

/// Parameters of a model apart.
pub(super) struct Parameters<'p> {
    pub thresholds: Thresholds,
    pub coefficients: &'p [f64],
    pub sds: &'p [f64],
}

impl Data {
    pub(super) fn parameters(&self) -> usize {
        self.categories - 1 + self.columns + self.layout.terms.len()
    }

    pub(super) fn split<'p>(&self, at: &'p [f64]) -> Parameters<'p> {
        let (thresholds, rest) = at.split_at(self.categories - 1);
        let (coefficients, sds) = rest.split_at(self.columns);
        Parameters { thresholds: Thresholds::new(thresholds_of(thresholds)), coefficients, sds }
    }

    fn row(&self, place: usize) -> &[f64] {
        &self.fixed[place * self.columns..][..self.columns]
    }

    /// Where the search starts: thresholds of the shares of all answers, no fixed effects.
    pub(super) fn start(&self) -> Vec<f64> {
        let mut counts = vec![0.0; self.categories];
        self.category.iter().for_each(|category| counts[*category as usize] += 1.0);
        let all = self.category.len() as f64;
        let mut below = 0.0;
        let mut values: Vec<f64> = Vec::new();
        for count in &counts[..self.categories - 1] {
            below += count;
            values.push(libm::log(below / (all - below)));
        }
        let mut at = vec![values[0]];
        at.extend(values.windows(2).map(|pair| libm::log(pair[1] - pair[0])));
        at.resize(at.len() + self.columns, 0.0);
        at.resize(self.parameters(), START_SD);
        at
    }

    pub(super) fn objective(&self) -> Objective<'_> {
        let modes = vec![0.0; self.layout.size()];
        Objective { data: self, modes, system: Factored::new(&self.layout) }
    }
}

/// Thresholds of the first one and the logarithms of the steps.
fn thresholds_of(parameters: &[f64]) -> Vec<f64> {
    let mut thresholds = vec![parameters[0]];
    for step in &parameters[1..] {
        thresholds.push(thresholds[thresholds.len() - 1] + libm::exp(*step));
    }
    thresholds
}

impl Objective<'_> {
    fn at_effects(&self, own: &Parameters<'_>, fixed: &[f64], effects: &[f64]) -> AtEffects {
        let layout = &self.data.layout;
        let n = fixed.len();
        let mut height = dot(effects, effects) / 2.0;
        let (mut first, mut second) = (vec![0.0; n], vec![0.0; n]);
        for place in 0..n {
            let eta = fixed[place] + predictor(layout, own.sds, effects, place);
            let terms = own.thresholds.curvature(self.data.category[place] as usize, eta);
            height += terms.minus_ln_p;
            first[place] = terms.first;
            second[place] = terms.second;
        }
        AtEffects { height, first, second }
    }

    /// Finds the mode of the effects and leaves the system factored there. None where there is none.
    fn mode(&mut self, own: &Parameters<'_>, fixed: &[f64]) -> Option<(Vec<f64>, AtEffects)> {
        let layout = &self.data.layout;
        let mut effects = self.modes.clone();
        let mut here = self.at_effects(own, fixed, &effects);
        if !here.height.is_finite() {
            effects.fill(0.0);
            here = self.at_effects(own, fixed, &effects);
        }
        let mut last = layout.terms.is_empty();
        for _ in 0..MODE_STEPS {
            if !here.height.is_finite()
                || !self.system.factor(layout, own.sds, Weights::Own(&here.second))
            {
                return None;
            }
            if last {
                return Some((effects, here));
            }
            let mut step: Vec<f64> = effects.iter().map(|effect| -effect).collect();
            for (place, first) in here.first.iter().enumerate() {
                for (effect, sd) in layout.effects(place).iter().zip(own.sds) {
                    step[*effect as usize] -= sd * first;
                }
            }
            self.system.solve(layout, &mut step);
            let mut share = 1.0;
            let length = step.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
            loop {
                let next: Vec<f64> =
                    effects.iter().zip(&step).map(|(effect, step)| effect + share * step).collect();
                let there = self.at_effects(own, fixed, &next);
                // h is convex: a step that does not lower it was too long, or is rounding.
                if there.height <= here.height + 1e-12 * here.height.abs() {
                    (effects, here) = (next, there);
                    break;
                }
                share /= 2.0;
                if share < 1e-8 {
                    return None;
                }
            }
            last = share * length < LAST_STEP;
        }
        None
    }

    /// Minus the log likelihood; the gradient is written into the second argument. Not a number where it has none.
    pub(super) fn value(&mut self, at: &[f64], gradient: &mut [f64]) -> f64 {
        gradient.fill(f64::NAN);
        let data = self.data;
        let layout = &data.layout;
        let own = data.split(at);
        let n = data.category.len();
        let fixed: Vec<f64> =
            (0..n).map(|place| inner(data.row(place), own.coefficients)).collect();
        let Some((effects, here)) = self.mode(&own, &fixed) else { return f64::NAN };
        let k = layout.terms.len();
        // Each answer's terms, the variance of its predictor, and c, its slope by each standard deviation.
        let mut terms = Vec::with_capacity(n);
        for (place, fixed) in fixed.iter().enumerate() {
            let eta = fixed + predictor(layout, own.sds, &effects, place);
            terms.push(own.thresholds.terms(data.category[place] as usize, eta));
        }
        let mut variance = vec![0.0; n];
        let mut of_sds = vec![0.0; k];
        self.system.covariances(layout, |place, between| {
            let weight = here.second[place];
            for (term, row) in between.chunks_exact(k).enumerate() {
                let slope = inner(row, own.sds);
                of_sds[term] += weight * slope;
                variance[place] += own.sds[term] * slope;
            }
        });
        // s = H^-1 Λ Z' q, q the slope of ln det H / 2 by each predictor.
        let mut moved = vec![0.0; layout.size()];
        for (place, terms) in terms.iter().enumerate() {
            let slope = variance[place] * terms.by_eta[2] / 2.0;
            for (effect, sd) in layout.effects(place).iter().zip(own.sds) {
                moved[*effect as usize] += sd * slope;
            }
        }
        self.system.solve(layout, &mut moved);
        gradient.fill(0.0);
        let (by_thresholds, rest) = gradient.split_at_mut(data.categories - 1);
        let (by_coefficients, by_sds) = rest.split_at_mut(data.columns);
        by_sds.copy_from_slice(&of_sds);
        for (place, terms) in terms.iter().enumerate() {
            let [first, second, third] = terms.by_eta;
            let half = variance[place] / 2.0;
            let shift = predictor(layout, own.sds, &moved, place);
            let by_predictor = first + half * third - second * shift;
            for (slope, x) in by_coefficients.iter_mut().zip(data.row(place)) {
                *slope += x * by_predictor;
            }
            for (slope, effect) in by_sds.iter_mut().zip(layout.effects(place)) {
                let effect = *effect as usize;
                *slope += effects[effect] * by_predictor - moved[effect] * first;
            }
            let category = data.category[place] as usize;
            let of = terms.by_threshold;
            for (side, threshold) in [(0, Some(category)), (1, category.checked_sub(1))] {
                if let Some(slope) = threshold.and_then(|own| by_thresholds.get_mut(own)) {
                    *slope += of[0][side] + half * of[2][side] - shift * of[1][side];
                }
            }
        }
        // From thresholds to the first one and the logarithms of the steps.
        for j in (1..by_thresholds.len()).rev() {
            by_thresholds[j - 1] += by_thresholds[j];
        }
        for (slope, step) in by_thresholds.iter_mut().zip(at).skip(1) {
            *slope *= libm::exp(*step);
        }
        self.modes = effects;
        here.height + self.system.ln_det / 2.0
    }
}

/// What the random effects add to an answer's predictor.
#[inline(always)]
fn predictor(layout: &Layout, sds: &[f64], effects: &[f64], place: usize) -> f64 {
    let own = layout.effects(place).iter().zip(sds);
    own.map(|(effect, sd)| sd * effects[*effect as usize]).sum()
}

/// Of few numbers.
#[inline(always)]
fn inner(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::table::factor::Factor;
    use crate::test::mixed_model::search::{covariance, fit};
    use mimique_test_support::Random;

    /// Answers of people to clips of two methods, some missing.
    fn data(categories: usize, random: &mut Random) -> Data {
        let (mut category, mut fixed) = (Vec::new(), Vec::new());
        let mut codes = [const { Vec::new() }; 4];
        for (person, segment, method) in
            (0..9_u32).flat_map(|p| (0..6).flat_map(move |s| (0..2).map(move |m| (p, s, m))))
        {
            if random.uniform() < 0.9 {
                let latent =
                    f64::from(person % 3) + 0.5 * f64::from(method) + 1.5 * random.normal();
                category.push((latent.max(0.0) as u32).min(categories as u32 - 1));
                fixed.push([f64::from(method), random.normal()]);
                let own = [person, person * 2 + method, segment, segment * 2 + method];
                codes.iter_mut().zip(own).for_each(|(codes, own)| codes.push(own));
            }
        }
        let factors = codes.map(|codes| {
            let levels = (0..20).map(|level: u32| level.to_string()).collect();
            Factor { name: String::new(), levels, codes }.used()
        });
        let layout = Layout::of(&factors.each_ref(), category.len());
        let category = layout.rows.iter().map(|row| category[*row]).collect();
        let fixed = layout.rows.iter().flat_map(|row| fixed[*row]).collect();
        Data { category, categories, fixed, columns: 2, layout }
    }

    #[test]
    fn the_gradient_is_the_slope_of_the_likelihood() {
        for categories in [2, 5] {
            let data = data(categories, &mut Random::new(3));
            let mut objective = data.objective();
            let mut at = data.start();
            let size = at.len();
            at[size - 6..].copy_from_slice(&[0.3, -0.2, 0.8, 0.4, 0.0, 0.6]);
            let mut gradient = vec![0.0; size];
            let mut other = vec![0.0; size];
            objective.value(&at, &mut gradient);
            for place in 0..size {
                let mut moved = |by: f64| {
                    let mut at = at.clone();
                    at[place] += by;
                    objective.value(&at, &mut other)
                };
                // Differences of the fourth order.
                let h = 1e-3;
                let slope =
                    (8.0 * (moved(h) - moved(-h)) - moved(2.0 * h) + moved(-2.0 * h)) / (12.0 * h);
                assert!(
                    (slope - gradient[place]).abs() < 1e-8 * (1.0 + slope.abs()),
                    "{categories} categories, parameter {place}: {}, {slope}",
                    gradient[place]
                );
            }
        }
    }

    #[test]
    fn one_effect_a_group_agrees_with_the_integral_nearly_and_without_effects_exactly() {
        // Without random terms two categories and one column are a 2 x 2 table: the log odds ratio.
        let layout = Layout::of(&[], 40);
        let category: Vec<u32> =
            (0..40).map(|i| u32::from(i % 20 < if i < 20 { 5 } else { 12 })).collect();
        let fixed = (0..40).map(|i| if i < 20 { 0.0 } else { 1.0 }).collect();
        let data = Data { category, categories: 2, fixed, columns: 1, layout };
        let found = fit(&data);
        assert!(found.converged());
        let expected = (12.0_f64 / 8.0).ln() - (5.0_f64 / 15.0).ln();
        assert!((found.coefficients[0] - expected).abs() < 1e-6);
        let variance = covariance(&data, &found).unwrap()[(0, 0)];
        let expected = 1.0 / 5.0 + 1.0 / 15.0 + 1.0 / 12.0 + 1.0 / 8.0;
        assert!((variance - expected).abs() < 1e-6, "{variance}");
    }
}
