//! What one test of a hypothesis finds: its corrected p, its estimate and its verdict.

use mimique_stats::{EquivalenceVerdict, Outcome};
use mimique_study::TestName;
use serde::Serialize;

use crate::choices::preference::Preference;
use crate::hypothesis::decision::{Decision, EffectUnit, Sought, decision_by, unit_of};
use crate::hypothesis::equivalence::OneSidedTests;
use crate::hypothesis::other_clips::DecidingTest;
use crate::hypothesis::test_line::OutcomeP;
use crate::hypothesis::{ClipScope, HypothesisResult, deciding_p, deciding_test, family};
use crate::trials::measure::MeasureKind;

/// A test that may decide a hypothesis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum TestChoice {
    /// The linear mixed model: for other people and other clips.
    LinearModel,
    /// Clark's min F': for other people and other clips.
    MinF,
    /// One value per person: for these clips.
    PersonMeans,
    /// Two one-sided t tests of the linear mixed model: for other people and other clips.
    EquivalenceOfModel,
    /// Two one-sided tests of ranks.
    EquivalenceOfRanks,
    /// Two one-sided t tests.
    EquivalenceOfMeans,
}

/// An estimate with its interval, where the test gives one.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct Estimate {
    /// Of the first level less the second in alphabetical or numeric order, or in that of the study file.
    pub value: f64,
    /// At 95 %, of a test of equivalence at 90 %.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub interval: Option<[f64; 2]>,
    /// The unit; `None` of a rank correlation.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub unit: Option<EffectUnit>,
    /// The two levels; `None` of a rank correlation.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub levels: Option<[String; 2]>,
}

/// In which direction an effect was shown.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Direction {
    /// The level that is higher, or chosen more often.
    Higher(String),
    /// One number rises with the other.
    Rising,
    /// One number falls with the other.
    Falling,
}

/// A decision, and the direction of what was shown.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub(crate) struct Verdict {
    pub decision: Decision,
    /// `None` if nothing was shown, or if there are more than two levels.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub direction: Option<Direction>,
}

/// What one test of a hypothesis finds. All fields are `None` if the test cannot be computed.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct Finding {
    /// p that supports the verdict, corrected over the hypotheses of the study.
    pub p: Option<f64>,
    /// Where two levels are compared, or two numbers are correlated.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub estimate: Option<Estimate>,
    pub verdict: Option<Verdict>,
}

impl TestChoice {
    /// The tests of a hypothesis, that of the report first.
    pub(super) fn all_of(result: &HypothesisResult) -> Vec<Self> {
        let mut tests = vec![Self::deciding(result)];
        let others: &[Self] = match (&result.equivalence, &result.other_clips) {
            (Some(_), Some(_)) => {
                &[Self::EquivalenceOfModel, Self::EquivalenceOfRanks, Self::EquivalenceOfMeans]
            }
            (Some(_), None) => &[Self::EquivalenceOfRanks, Self::EquivalenceOfMeans],
            (None, Some(found)) if found.min_f.is_some() => {
                &[Self::LinearModel, Self::MinF, Self::PersonMeans]
            }
            (None, Some(_)) => &[Self::LinearModel, Self::PersonMeans],
            (None, None) => &[Self::PersonMeans],
        };
        tests.extend(others.iter().copied().filter(|test| *test != tests[0]).collect::<Vec<_>>());
        tests
    }

    /// The test by which the report decides.
    pub(super) fn deciding(result: &HypothesisResult) -> Self {
        if result.equivalence.is_some() {
            return match result.scope {
                ClipScope::Others => Self::EquivalenceOfModel,
                ClipScope::These | ClipScope::NotTold => Self::EquivalenceOfRanks,
            };
        }
        match result.other_clips.as_ref().filter(|found| found.decides) {
            Some(found) => match found.deciding_test() {
                Some(DecidingTest::MinF(_)) => Self::MinF,
                Some(DecidingTest::LinearModel(_)) | None => Self::LinearModel,
            },
            None => Self::PersonMeans,
        }
    }

    /// p of the test, and p of any difference where equivalence is tested; not corrected.
    fn p_values(self, result: &HypothesisResult) -> [Option<f64>; 2] {
        let clips = result.other_clips.as_ref();
        match self {
            Self::LinearModel => {
                let model = clips.and_then(|found| found.linear_model.as_ref());
                let p = model.and_then(|model| match model {
                    Outcome::Ok(model) => Some(model.p),
                    Outcome::Undefined { .. } => None,
                });
                [p, None]
            }
            Self::MinF => [clips.and_then(|found| found.min_f.as_ref()?.p()), None],
            Self::PersonMeans => [deciding_p(&result.recommended), None],
            Self::EquivalenceOfModel => {
                let own = result.equivalence.as_ref().and_then(|found| found.for_other_clips);
                [own.map(|own| own.p), own.map(|own| own.p_difference)]
            }
            Self::EquivalenceOfRanks | Self::EquivalenceOfMeans => {
                let own = self.one_sided(result);
                [own.and_then(|own| own.line.p()), own.and_then(|own| own.p_difference)]
            }
        }
    }

    fn one_sided(self, result: &HypothesisResult) -> Option<&OneSidedTests> {
        let found = result.equivalence.as_ref()?;
        match self {
            Self::EquivalenceOfRanks => Some(&found.by_ranks),
            Self::EquivalenceOfMeans => Some(&found.by_t),
            Self::LinearModel | Self::MinF | Self::PersonMeans | Self::EquivalenceOfModel => None,
        }
    }

    /// The difference of two levels, or a correlation, by this test.
    fn estimate(self, result: &HypothesisResult) -> Option<Estimate> {
        let of = |value, interval, [a, b]: [&String; 2]| Estimate {
            value,
            interval,
            unit: Some(unit_of(result.kind)),
            levels: Some([a.clone(), b.clone()]),
        };
        match self {
            Self::LinearModel => {
                let Outcome::Ok(model) = result.other_clips.as_ref()?.linear_model.as_ref()? else {
                    return None;
                };
                let [pair] = model.pairs.as_slice() else { return None };
                if result.kind == MeasureKind::Choice {
                    let [low, high] = pair.interval_95;
                    // As the estimates of the other tests of choices.
                    let (difference, ends, levels) = match pair.a <= pair.b {
                        true => (pair.difference, [low, high], [&pair.a, &pair.b]),
                        false => (-pair.difference, [-high, -low], [&pair.b, &pair.a]),
                    };
                    let own = of(0.5 + difference, Some(ends.map(|end| 0.5 + end)), levels);
                    return Some(Estimate { unit: Some(EffectUnit::Chosen), ..own });
                }
                Some(of(pair.difference, Some(pair.interval_95), [&pair.a, &pair.b]))
            }
            Self::MinF => {
                let [pair] = result.recommended.pairs.as_slice() else { return None };
                let n = pair.differences.len();
                let mean = pair.differences.iter().sum::<f64>() / n as f64;
                (n > 0).then(|| of(mean, None, [&pair.a, &pair.b]))
            }
            Self::PersonMeans if result.test == TestName::Spearman => {
                let Outcome::Ok(line) = deciding_test(&result.recommended)? else { return None };
                let value = line.row.effect?;
                Some(Estimate { value, interval: None, unit: None, levels: None })
            }
            Self::PersonMeans => match (&result.preference, result.recommended.pairs.as_slice()) {
                (Some(Preference::OneOfTwo(own)), _) => {
                    // The order of the levels must not depend on the answers.
                    let [a, b] = &own.levels;
                    let ends = own.interval;
                    let estimate = |value, interval, levels| Estimate {
                        unit: Some(EffectUnit::Chosen),
                        ..of(value, interval, levels)
                    };
                    Some(match a <= b {
                        true => estimate(own.share, ends, [a, b]),
                        false => {
                            let ends = ends.map(|[low, high]| [1.0 - high, 1.0 - low]);
                            estimate(1.0 - own.share, ends, [b, a])
                        }
                    })
                }
                (None, [pair]) => {
                    let found = pair.difference?;
                    let ends = [found.ci_low, found.ci_high];
                    Some(of(found.estimate, Some(ends), [&pair.a, &pair.b]))
                }
                _ => None,
            },
            Self::EquivalenceOfModel => {
                let found = result.equivalence.as_ref()?;
                let ([a, b], own) = (&found.levels, found.for_other_clips?);
                Some(of(own.difference, Some(own.interval_90), [a, b]))
            }
            Self::EquivalenceOfRanks | Self::EquivalenceOfMeans => {
                let [a, b] = &result.equivalence.as_ref()?.levels;
                let own = self.one_sided(result)?;
                Some(of(own.estimate?, own.interval_90, [a, b]))
            }
        }
    }
}

impl Estimate {
    /// Which level is higher, or whether a correlation is positive; `None` if there is no difference.
    fn direction(&self) -> Option<Direction> {
        let value = self.unit.map_or(self.value, |unit| unit.drawn(self.value));
        let is_positive = value > 0.0;
        (value != 0.0).then(|| match &self.levels {
            Some([a, b]) => Direction::Higher(if is_positive { a } else { b }.clone()),
            None if is_positive => Direction::Rising,
            None => Direction::Falling,
        })
    }
}

impl Finding {
    /// What a test of a hypothesis finds; the other hypotheses of the family are decided as the report does.
    pub(super) fn of(results: &[HypothesisResult], place: usize, test: TestChoice) -> Self {
        let result = &results[place];
        let mut family: Vec<[Option<f64>; 2]> = results.iter().map(family::p_values).collect();
        family[place] = test.p_values(result);
        let [p, p_difference] = family::corrected(&family)[place];
        let Some(p) = p else { return Self { p: None, estimate: None, verdict: None } };
        let decision = decision_by(result, p, p_difference);
        let estimate = test.estimate(result);
        let direction = estimate.as_ref().filter(|_| has_direction(decision));
        let supports = match decision {
            Decision::Equivalence(EquivalenceVerdict::Different) => p_difference.unwrap_or(p),
            _ => p,
        };
        Self {
            p: Some(supports),
            verdict: Some(Verdict { decision, direction: direction.and_then(Estimate::direction) }),
            estimate,
        }
    }
}

/// Whether a decision says that something differs in one direction.
fn has_direction(decision: Decision) -> bool {
    use EquivalenceVerdict::{Different, DifferentButSmall};
    matches!(
        decision,
        Decision::Shown(Sought::Difference | Sought::Relation)
            | Decision::Equivalence(Different | DifferentButSmall)
    )
}
