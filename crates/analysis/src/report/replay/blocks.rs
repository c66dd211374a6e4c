//! Checks of blocks that choose what is shown, and of clusters of courses over time.

use mimique_stats::{Outcome, PsychometricFit, TimeCluster};

use super::check::{Check, Family, Nearness};
use super::checks::Collector;
use crate::faces::{BINS, PERMUTATIONS};
use crate::hypothesis::call::{Call, Design};
use crate::report::results::Results;
use crate::report::section::trace_tests::PERMUTATIONS as OF_CLUSTERS;
use crate::report::section::traces::MeanTraces;
use crate::thresholds::{BlockThresholds, ShownAnswer};

/// Least width of levels that a lapse, which has no unit, is held against.
const LEAST_WIDTH: f64 = 0.01;
/// Nearer to 0 or 1 a level has no weight in a fit of some tens of answers.
const FLAT: f64 = 1e-4;

/// Levels at which the fitted function is neither at its floor nor at its ceiling. With one such level alone every spread
/// fits equally well with a threshold of its own, and another program ends at another of them.
fn levels_on_the_rise(fit: &PsychometricFit, shown: &[ShownAnswer], sign: f64) -> usize {
    let function = fit.psychometric();
    let share =
        |level: f64| (function.right(level) - fit.guess) / (1.0 - fit.guess - function.lapse);
    let mut levels: Vec<f64> = shown.iter().map(|answer| sign * answer.level).collect();
    levels.sort_by(f64::total_cmp);
    levels.dedup();
    levels.into_iter().filter(|level| (FLAT..=1.0 - FLAT).contains(&share(*level))).count()
}

impl Collector {
    /// The fitted function of each person who has one, and the mean of thresholds. Where the answers leave the spread
    /// open, the height of the likelihood alone is computed again.
    pub(super) fn thresholds(&mut self, results: &Results<'_>) {
        for block in &results.thresholds {
            let BlockThresholds { block: name, question, levels: [low, high], .. } = block;
            let nearness = Nearness::Search((high - low).max(LEAST_WIDTH));
            let sign = if block.falls { -1.0 } else { 1.0 };
            let (mut fitted, mut given) = (Vec::new(), Vec::new());
            for person in &block.people {
                let Some(fit) = &person.fit else { continue };
                let call = Call::new(Design::AnswersByLevel, "psychometric");
                let call = call.text(question).text(name).text(&person.participant);
                let mut values = vec![("loglik", fit.loglik)];
                let key = format!("threshold:{name}:{}", person.participant);
                let call = call.text(fit.function).given(sign).given(fit.guess);
                let threshold = sign * fit.level_at_half;
                if levels_on_the_rise(fit, &person.shown, sign) < 2 {
                    given.push(format!("{threshold:?}"));
                } else {
                    fitted.push(key.clone());
                    values.extend([
                        ("threshold", threshold),
                        ("scale", fit.scale_or_shape),
                        ("lapse", fit.lapse_estimate),
                    ]);
                }
                self.checks.push(Check::new(key, call, values).near(nearness));
            }
            let Some(mean) = block.mean.clone().ok() else { continue };
            let mut values = vec![("mean", mean.mean), ("n", mean.n as f64)];
            if let Some([low, high]) = mean.mean_ci_t {
                values.extend([("low", low), ("high", high)]);
            }
            let call = Call::new(Design::Found, "mean_and_interval").list(&fitted).list(&given);
            let call = call.given(*low).given(*high);
            let key = format!("threshold:{name}:mean");
            self.checks.push(Check::new(key, call, values).near(nearness));
        }
    }

    /// The perceived value of each level, with its standard error.
    pub(super) fn scalings(&mut self, results: &Results<'_>) {
        for block in &results.scalings {
            let Outcome::Ok(found) = &block.scale else { continue };
            let call = Call::new(Design::Judgements, "difference_scaling");
            let call = call.text(&block.question).text(&block.block).text(&block.second);
            let check = Check::new(
                format!("scaling:{}", block.block),
                call,
                vec![("loglik", found.loglik)],
            );
            let check = check.list("psi", &found.scale).list("se", &found.se);
            self.checks.push(check.near(Nearness::Search(1.0)));
        }
    }

    /// The images of each category, units by times and units alone, with their corrected p.
    pub(super) fn faces(&mut self, results: &Results<'_>) {
        for block in &results.faces {
            for category in &block.images.categories {
                let Outcome::Ok(group) = &category.group else { continue };
                let key = format!("faces:{}:{}", block.block, category.category);
                let units: Vec<String> = group.units.iter().map(|unit| unit.unit.clone()).collect();
                let call = |test, bins| {
                    let call = Call::new(Design::Faces, test).text(&block.question);
                    let call = call.text(&block.block).text(&category.category).list(&units);
                    call.number(bins).given(block.duration_s)
                };
                let check = |key, test, bins| Check::new(key, call(test, bins), Vec::new());
                let mut image = check(key.clone(), "classification_image", BINS);
                let mut presence = check(format!("{key}:presence"), "classification_image", 0);
                let (mut p, mut p_presence) = (
                    check(format!("{key}:p"), "classification_p", BINS),
                    check(format!("{key}:presence p"), "classification_p", 0),
                );
                for unit in &group.units {
                    let name = |what: &str| format!("{what}.{}", unit.unit);
                    image = image.list(name("difference"), &unit.difference);
                    image = image.list(name("z"), &unit.z);
                    p = p.list(name("p"), &unit.p);
                    presence = presence.list(name("difference"), &[unit.presence.effect]);
                    presence = presence.list(name("z"), &[unit.presence.z]);
                    p_presence = p_presence.list(name("p"), &[unit.presence.p]);
                }
                let draws = Nearness::Draws { draws: PERMUTATIONS, times: 1 };
                let image = image.near(Nearness::Cancelling);
                self.checks.extend([image, presence, p.near(draws), p_presence.near(draws)]);
            }
        }
    }

    /// Clusters in which the courses of two levels differ, their p, and the smallest p of each pair corrected over pairs.
    pub(super) fn trace_pairs(&mut self, own: &MeanTraces) {
        let draws = |times| Nearness::Draws { draws: OF_CLUSTERS, times };
        let mut family = Family::empty(draws(own.pairs.len()));
        for pair in &own.pairs {
            let key = format!("trace:{}:{}:{} | {}", own.response, own.factor, pair.a, pair.b);
            let call = |test| {
                let call = Call::new(Design::Courses, test).list(&own.matched_by);
                let call = call.text(&own.response).text(&own.factor).list(&own.all_levels);
                call.text(&pair.a).text(&pair.b)
            };
            let clusters = match &pair.test {
                Outcome::Ok(found) => found.clusters.as_slice(),
                Outcome::Undefined { .. } => &[],
            };
            let list =
                |of: fn(&TimeCluster) -> f64| -> Vec<f64> { clusters.iter().map(of).collect() };
            let values = vec![("clusters", clusters.len() as f64)];
            let check = Check::new(key.clone(), call("clusters"), values);
            let check = check
                .list("first", &list(|own| own.first as f64))
                .list("last", &list(|own| own.last as f64))
                .list("mass", &list(|own| own.mass));
            self.checks.push(check);
            let smallest = |all: &mut dyn Iterator<Item = f64>| all.fold(1.0, f64::min);
            let p = smallest(&mut clusters.iter().map(|own| own.p));
            let key = format!("{key}:p");
            let check = Check::new(key.clone(), call("cluster_p"), vec![("p", p)]);
            self.checks.push(check.list("p", &list(|own| own.p)).near(draws(1)));
            family.of.push(key.clone());
            family.into.push(key);
            family.p_holm.push(smallest(&mut pair.spans.iter().map(|span| span.p_corrected)));
        }
        self.close(&mut family);
    }
}
