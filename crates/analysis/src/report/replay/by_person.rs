//! Checks of what is first computed person by person: detection, and ratings that follow the clip.

use mimique_stats::{Detection, TestResult as _};
use mimique_study::TRACE_HZ;

use super::check::Check;
use super::checks::Collector;
use crate::hypothesis::call::{Call, Design};
use crate::report::results::Results;
use crate::report::section::detection::CategoryDetection;
use crate::report::section::roc::of_people;

/// Instants of a course from one check to the next: half a second.
const INSTANTS: usize = (TRACE_HZ / 2.0) as usize;

/// The answers of a level that are compared with those of the factor's other levels.
struct AtLevel<'r> {
    factor: &'r str,
    /// The level alone, as scripts take it.
    level: &'r [String; 1],
    matched_by: &'r [String],
    levels: &'r [String],
}

impl Collector {
    /// d' of each category, of all answers and by factors.
    pub(super) fn detection(&mut self, results: &Results<'_>) {
        for own in &results.detection {
            let key = format!("detection:{}", own.response);
            for category in &own.categories {
                let key = format!("{key}:{}", category.category);
                self.category(key, &own.response, None, own.people, category);
            }
            for by in &own.by {
                for category in &by.categories {
                    let key = format!("{key}:{}:{}", by.factor, category.category);
                    for (level, at) in category.at.iter() {
                        let levels = [level.to_owned()];
                        let people = at.each.0.len();
                        let of = AtLevel {
                            factor: &by.factor,
                            level: &levels,
                            matched_by: &by.matched_by,
                            levels: &by.levels,
                        };
                        let key = format!("{key}:{level}");
                        self.category(key, &own.response, Some(of), people, &at.detection);
                    }
                    if let Some(compared) = &category.compared {
                        self.person_level(&format!("{key}:d'"), &compared.d_prime);
                        self.person_level(&format!("{key}:c"), &compared.criterion);
                    }
                }
            }
        }
    }

    /// Areas below ROC curves, and the points of all answers together.
    pub(super) fn roc(&mut self, results: &Results<'_>) {
        for own in &results.roc {
            for category in &own.found.categories {
                let call = |test| {
                    let call = Call::new(Design::Confidence, test).text(&own.response);
                    call.text(&own.confidence).text(&category.category)
                };
                let key = format!("roc:{}:{}", own.response, category.category);
                if let Some(areas) = of_people(category) {
                    let mut values = vec![("mean", areas.mean), ("n", areas.n as f64)];
                    if let Some([low, high]) = areas.mean_ci_t {
                        values.extend([("low", low), ("high", high)]);
                    }
                    self.checks.push(Check::new(key.clone(), call("roc"), values));
                }
                let Some(curve) = category.pooled.clone().ok() else { continue };
                let [false_alarms, hits] = [0, 1].map(|place| -> Vec<f64> {
                    curve.points.iter().map(|point| point[place]).collect()
                });
                let values = vec![("area", curve.area)];
                let check = Check::new(format!("{key}:all"), call("roc_of_all"), values);
                let check = check.list("false_alarms", &false_alarms).list("hits", &hits);
                self.checks.push(check);
            }
        }
    }

    /// d' of one category among the answers at a level of a factor, or of all.
    fn category(
        &mut self,
        key: String,
        response: &str,
        at: Option<AtLevel<'_>>,
        all: usize,
        found: &CategoryDetection,
    ) {
        let Some((people, t)) = found.of_people.as_ref().and_then(|p| Some((p, p.t?))) else {
            return;
        };
        // The scripts have a d' of everybody.
        if people.people < all {
            return;
        }
        let call = Call::new(Design::Detection, Detection::NAMES.function);
        let call = call.text(response).text(&found.category);
        let call = match at {
            None => call.text("").list(&[]),
            Some(at) => call.text(at.factor).list(at.level).list(at.matched_by).list(at.levels),
        };
        let values = vec![
            ("statistic", t.statistic),
            ("p", t.p),
            ("effect", people.d_prime_mean),
            ("n", people.people as f64),
        ];
        self.checks.push(Check::new(key, call, values));
    }

    /// Means of ratings that follow the clip, every half a second and at the end.
    pub(super) fn traces(&mut self, results: &Results<'_>) {
        for own in &results.traces {
            for level in &own.levels {
                let last = level.mean.len().saturating_sub(1);
                let instants = (0..last).step_by(INSTANTS).chain([last]);
                for instant in instants.filter(|instant| *instant < level.mean.len()) {
                    let mut values =
                        vec![("mean", level.mean[instant]), ("n", level.people as f64)];
                    if let Some([low, high]) = level.interval_95.as_ref().map(|all| all[instant]) {
                        values.extend([("low", low), ("high", high)]);
                    }
                    let call = Call::new(Design::Course, "mean_and_interval");
                    let call = call.list(&own.matched_by).text(&own.response).text(&own.factor);
                    let call = call.list(&own.all_levels).text(&level.level);
                    let key = format!(
                        "trace:{}:{}:{}:{}",
                        own.response,
                        own.factor,
                        level.level,
                        instant + 1
                    );
                    self.checks.push(Check::new(key, call.number(instant + 1), values));
                }
            }
            self.trace_pairs(own);
        }
    }
}
