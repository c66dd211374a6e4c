//! Every number of the results under a key, with the call that computes it again.

use mimique_stats::{
    IntraclassCorrelation, LinearMixedModel, MeasurementLevel, Outcome, TestResult as _,
};

use super::check::{Check, Family, Nearness};
use crate::hypothesis::call::{Call, Design};
use crate::hypothesis::comparison::Comparison;
use crate::hypothesis::other_clips::DecidingTest;
use crate::hypothesis::person_level::{Pair, PersonLevel};
use crate::hypothesis::test_line::TestLine;
use crate::hypothesis::trial_level::TrialLevel;
use crate::hypothesis::undefined::TestOutcome;
use crate::report::results::Results;

/// Walks the results.
#[derive(Default)]
pub(super) struct Collector {
    pub(super) checks: Vec<Check>,
    pub(super) families: Vec<Family>,
}

impl Collector {
    /// The checks and families of a report, in its order.
    pub(super) fn of(results: &Results<'_>) -> (Vec<Check>, Vec<Family>) {
        let mut all = Self::default();
        let mut decided = Family::empty(Nearness::Rounding);
        for (place, result) in results.hypotheses.iter().enumerate() {
            let key = format!("hypothesis:{}", result.id);
            all.trial_level(&key, &result.as_in_the_thesis);
            all.person_level(&key, &result.recommended);
            let mut deciding = deciding_key(&key, &result.recommended);
            if let Some(found) = &result.other_clips {
                if let Some(min_f) = &found.min_f {
                    all.line(format!("{key}:min F'"), min_f);
                }
                let decides = found.deciding_test().filter(|_| found.decides);
                deciding = match decides {
                    Some(DecidingTest::LinearModel(model)) => {
                        let key = format!("{key}:other clips");
                        let name = LinearMixedModel::NAMES.function;
                        // Of a hypothesis of equivalence p is that of two one-sided tests of the model's difference.
                        let p = result.equivalence.as_ref().and(result.p).unwrap_or(model.p);
                        let call = Call::new(Design::Given, name).given(p);
                        all.checks.push(Check::new(key.clone(), call, vec![("p", p)]));
                        Some(key)
                    }
                    Some(DecidingTest::MinF(_)) => Some(format!("{key}:min F'")),
                    None => deciding.filter(|_| !found.decides),
                };
            }
            if let Some(found) = &result.equivalence {
                all.line(format!("{key}:beside"), &found.by_t.line);
            }
            if let (Some(p_holm), Some(deciding)) = (result.p_holm_over_hypotheses, deciding) {
                decided.of.push(deciding);
                decided.into.push(format!("{key}:over hypotheses"));
                decided.p_holm.push(p_holm);
                decided.hypothesis.push(place);
            }
            let difference = result.p_difference();
            if let (Some(p), Some(p_holm)) = (difference, result.p_difference_holm_over_hypotheses)
            {
                let key = format!("{key}:difference");
                let call = Call::new(Design::Given, LinearMixedModel::NAMES.function).given(p);
                all.checks.push(Check::new(key.clone(), call, vec![("p", p)]));
                decided.into.push(format!("{key}:over hypotheses"));
                decided.of.push(key);
                decided.p_holm.push(p_holm);
                decided.hypothesis.push(place);
            }
        }
        all.families.extend((!decided.of.is_empty()).then_some(decided));
        for matrix in &results.confusion {
            let by = matrix.by.as_deref().unwrap_or_default();
            let result = &matrix.result;
            let [wilson_low, wilson_high] = result.accuracy_ci_wilson;
            let mut values = vec![
                ("n", result.n as f64),
                ("accuracy", result.accuracy),
                ("wilson_low", wilson_low),
                ("wilson_high", wilson_high),
            ];
            values.extend(result.kappa.map(|kappa| ("kappa", kappa)));
            let call = Call::new(Design::Answers, "confusion").text(&matrix.response).text(by);
            let levels = matrix.by.as_ref().map(|_| matrix.of.clone());
            let key = format!("confusion:{}:{}", matrix.response, matrix.of);
            all.checks.push(Check::new(key, call.list(levels.as_slice()), values));
        }
        for comparison in &results.comparisons {
            all.comparison(comparison);
        }
        for choices in &results.choices {
            if let (Some(factor), Some(tests)) = (&choices.by, &choices.tests) {
                let key = format!("choices:{}:{factor}", choices.response);
                all.trial_level(&key, &tests.as_in_the_thesis);
                all.person_level(&key, &tests.recommended);
            }
        }
        for panel in &results.panels {
            let key = format!("panel:{}", panel.block);
            if let Some(conditions) = &panel.conditions {
                all.trial_level(&key, &conditions.as_in_the_thesis);
                all.person_level(&key, &conditions.recommended);
            }
            if let Some(order) = &panel.order {
                all.line(format!("{key}:order"), &order.test);
            }
        }
        for two in &results.two_way {
            let key = format!("two-way:{}:{}", two.measure, two.factors.join(":"));
            all.trial_level(&key, &two.as_in_the_thesis);
            all.person_level(&key, &two.recommended);
        }
        for course in &results.course {
            all.line(format!("course:{}", course.measure), &course.trend);
        }
        all.detection(results);
        all.roc(results);
        all.traces(results);
        all.thresholds(results);
        all.scalings(results);
        all.faces(results);
        all.agreement(results);
        all.layouts(results);
        (all.checks, all.families)
    }

    /// Agreement about the clips, and scales.
    fn agreement(&mut self, results: &Results<'_>) {
        for own in &results.agreement {
            let key = format!("agreement:{}", own.response);
            if let Some(Outcome::Ok(icc)) = &own.icc {
                let form = icc.agreement_of_one();
                let name = IntraclassCorrelation::NAMES.function;
                let call = Call::new(Design::ClipsByPeople, name).text(&own.response);
                let values = vec![
                    ("statistic", form.F),
                    ("p", form.p),
                    ("effect", form.icc),
                    ("n", icc.clips_used as f64),
                ];
                self.checks.push(Check::new(format!("{key}:icc"), call, values));
            }
            if let Outcome::Ok(alpha) = &own.krippendorff {
                // Names are in a column of their own.
                let words = own.level == MeasurementLevel::Nominal;
                let column = format!("{}{}", own.response, if words { ".answer" } else { "" });
                let call = Call::new(Design::FirstAnswers, "krippendorff").text(&column);
                let (key, call) = (format!("{key}:alpha"), call.text(own.level.name()));
                self.checks.push(Check::new(key, call, vec![("alpha", alpha.alpha)]));
            }
        }
        for scale in &results.scales {
            let Outcome::Ok(found) = &scale.cronbach else { continue };
            let [low, high] = found.interval_95_feldt;
            let call = Call::new(Design::Items, "cronbach").list(&scale.items);
            let values = vec![("alpha", found.alpha), ("low", low), ("high", high)];
            let (key, call) = (format!("scale:{}", scale.scale), call.list(&scale.reversed));
            self.checks.push(Check::new(key, call, values));
        }
    }

    fn comparison(&mut self, comparison: &Comparison) {
        let (measure, factor) = (&comparison.measure, &comparison.factor);
        let by = &comparison.matching.by;
        let key = format!("comparison:{measure}:{factor}");
        for (level, outcome) in comparison.descriptions.iter() {
            let Outcome::Ok(d) = outcome else { continue };
            let mut values = vec![
                ("n", d.n as f64),
                ("mean", d.mean),
                ("median", d.median),
                ("q1", d.q1),
                ("q3", d.q3),
            ];
            values.extend(d.sd.map(|sd| ("sd", sd)));
            let call = Call::new(Design::Level, "describe")
                .list(by)
                .text(measure)
                .text(factor)
                .text(level)
                .list(&comparison.levels);
            self.checks.push(Check::new(format!("{key}:{level}"), call, values));
        }
        for (place, (level, mean)) in comparison.person_means.iter().enumerate() {
            let Some(mean) = mean else { continue };
            let call = Call::new(Design::PersonMean, "mean").list(by).text(measure).text(factor);
            let call = call.list(&comparison.levels).number(place + 1);
            let key = format!("{key}:{level}:people");
            self.checks.push(Check::new(key, call, vec![("mean", *mean)]));
        }
        self.trial_level(&key, &comparison.as_in_the_thesis);
        self.person_level(&key, &comparison.recommended);
    }

    fn layouts(&mut self, results: &Results<'_>) {
        let mut family = Family::empty(Nearness::Rounding);
        let mut row = None;
        for cell in &results.layouts {
            let key = format!("table:{}:{}:{}", cell.table, cell.row, cell.column);
            // The pairs of a row are corrected together.
            if row.replace((&cell.table, &cell.row)) != Some((&cell.table, &cell.row)) {
                self.close(&mut family);
            }
            if let Some(outcome) = &cell.as_in_the_thesis {
                self.line(format!("{key}:thesis"), outcome);
            }
            if let Some(outcome) = &cell.recommended {
                let key = format!("{key}:recommended");
                self.line(key.clone(), outcome);
                if let Outcome::Ok(TestLine { p_holm: Some(p), call, .. }) = outcome
                    && call.design == Design::People
                {
                    family.of.push(key.clone());
                    family.into.push(key);
                    family.p_holm.push(*p);
                }
            }
        }
        self.close(&mut family);
    }

    pub(super) fn close(&mut self, family: &mut Family) {
        let whole = std::mem::replace(family, Family::empty(family.nearness));
        self.families.extend((!whole.of.is_empty()).then_some(whole));
    }

    fn trial_level(&mut self, key: &str, trials: &TrialLevel) {
        for (place, outcome) in trials.tests.iter().enumerate() {
            self.line(format!("{key}:thesis {}", place + 1), outcome);
        }
    }

    pub(super) fn person_level(&mut self, key: &str, people: &PersonLevel) {
        for (place, outcome) in people.overall.iter().enumerate() {
            self.line(overall_key(key, place), outcome);
        }
        let mut family = Family::empty(Nearness::Rounding);
        for pair in &people.pairs {
            let key = pair_key(key, pair);
            self.line(key.clone(), &pair.wilcoxon);
            let (Outcome::Ok(line), Some(check)) = (&pair.wilcoxon, self.checks.last_mut()) else {
                continue;
            };
            if let Some(difference) = pair.difference {
                check.values.extend([
                    ("estimate", difference.estimate),
                    ("low", difference.ci_low),
                    ("high", difference.ci_high),
                ]);
            }
            if let Some(p_holm) = line.p_holm {
                family.of.push(key.clone());
                family.into.push(key);
                family.p_holm.push(p_holm);
            }
        }
        self.close(&mut family);
    }

    fn line(&mut self, key: String, outcome: &TestOutcome) {
        let Outcome::Ok(line) = outcome else { return };
        let mut values = vec![
            ("statistic", line.row.statistic),
            ("p", line.row.p_value),
            ("n", line.row.n as f64),
        ];
        values.extend(line.row.effect.map(|effect| ("effect", effect)));
        if line.call.design == Design::DifferencesByTrait {
            values.extend(line.p_holm.map(|p| ("p_holm", p)));
        }
        self.checks.push(Check::new(key, line.call.clone(), values));
    }
}

fn overall_key(key: &str, place: usize) -> String {
    format!("{key}:recommended {}", place + 1)
}

fn pair_key(key: &str, pair: &Pair) -> String {
    format!("{key}:{} | {}", pair.a, pair.b)
}

/// The check whose p decides a hypothesis.
fn deciding_key(key: &str, people: &PersonLevel) -> Option<String> {
    match (people.overall.len(), people.pairs.as_slice()) {
        (0, [one]) => Some(pair_key(key, one)),
        (0, _) => None,
        (several, _) => Some(overall_key(key, several - 1)),
    }
}
