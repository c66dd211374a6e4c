//! Whether what is found holds for other people and other clips alike, people and clips both being drawn at random: a
//! linear mixed model with effects of people and segments and of both with each level, and, where levels are
//! compared within people, min F' and, of ratings, the cumulative model of their steps.

use std::sync::Arc;

use mimique_stats::{
    EquivalenceOptions, EquivalenceT, Factor, Labelled, LinearComparisonModel, LinearMean,
    LinearMixedModel, LinearMixedModelOptions, LinearPair, MinFPrime, MixedModel,
    MixedModelOptions, MixedShares, Outcome, PairedComparisons, TestResult,
    linear_comparison_model, linear_mixed_model, min_f_prime, mixed_model,
};
use serde::Serialize;

use crate::hypothesis::call::{Call, Design};
use crate::hypothesis::test_line::TestLine;
use crate::hypothesis::undefined::{TestOutcome, Why};
use crate::trials::export::Export;
use crate::trials::measure::{Measure, MeasureKind};

/// Which tests of other clips are computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum OtherClipsTests {
    /// Those that decide, and min F'.
    Deciding,
    /// The linear mixed model, also where it does not decide, and min F'.
    Linear,
    /// Those, and the cumulative model of ratings.
    All,
}

/// A hypothesis about other clips too.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct OtherClips {
    /// Whether these tests decide the hypothesis.
    pub decides: bool,
    /// Levels of the first factor that are compared.
    pub levels: Vec<String>,
    /// The linear mixed model; where it cannot be estimated, that, and no p. None where it was not asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub linear_model: Option<Outcome<LinearClipModel, Why>>,
    /// Clark's min F', where levels are compared within people.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub min_f: Option<TestOutcome>,
    /// The cumulative mixed model of ratings; where it did not converge, that, and no p. None where it was not asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mixed_model: Option<Outcome<ClipModel, Why>>,
}

/// The estimates of the linear mixed model.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct LinearClipModel {
    pub formula: String,
    pub observations: usize,
    /// Wald's F of the factor, or of the interaction of both.
    pub f: f64,
    pub df: usize,
    /// Satterthwaite's degrees of freedom.
    pub df_denominator: f64,
    pub p: f64,
    pub ln_p: f64,
    /// Of each level of the one factor; of choices, how often it is chosen over the others.
    pub means: Labelled<LinearMean>,
    /// Every two levels of the one factor.
    pub pairs: Vec<LinearClipPair>,
    /// Standard deviation of each term, in the unit of the answers.
    pub sd: Labelled<f64>,
    pub residual_sd: f64,
    /// Terms whose standard deviation is 0.
    pub at_zero: Vec<String>,
    /// Terms that part the answers as another one does.
    pub left_out: Vec<String>,
}

/// Two levels in the linear mixed model.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct LinearClipPair {
    pub a: String,
    pub b: String,
    /// a less b; of choices, how far the share of choices of a over b is above 1/2.
    pub difference: f64,
    pub se: f64,
    pub interval_95: [f64; 2],
    pub df: f64,
    /// After Holm's correction over the pairs.
    pub p_corrected: f64,
}

/// The estimates of the cumulative mixed model.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct ClipModel {
    pub formula: String,
    pub observations: usize,
    /// The factor against the model without it: twice the difference of the log likelihoods.
    pub likelihood_ratio: f64,
    pub df: usize,
    pub p: f64,
    pub ln_p: f64,
    /// Every two levels.
    pub pairs: Vec<ClipPair>,
    /// The different ratings, ascending.
    pub ratings: Vec<f64>,
    /// Shares of these at each level.
    pub shares: Labelled<MixedShares>,
    /// Standard deviation of each term, log odds.
    pub sd: Labelled<f64>,
    /// Terms whose standard deviation is 0.
    pub at_zero: Vec<String>,
    /// Terms that part the answers as another one does.
    pub left_out: Vec<String>,
    /// Of the model without clips, half chi-square.
    pub p_of_clips: Option<f64>,
    pub loglik: f64,
}

/// Two levels in the cumulative mixed model, the second against the first.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct ClipPair {
    pub a: String,
    pub b: String,
    pub odds_ratio: f64,
    pub interval_95: [f64; 2],
    /// After Holm's correction over the pairs.
    pub p_corrected: f64,
    /// How often b is the higher of two.
    pub higher: f64,
}

/// Which test of other clips gives a p.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum DecidingTest<'r> {
    LinearModel(&'r LinearClipModel),
    /// Where the model cannot be estimated.
    MinF(&'r TestLine),
}

impl OtherClips {
    /// The test that decides: the model, or min F' where the model cannot be estimated.
    pub(crate) fn deciding_test(&self) -> Option<DecidingTest<'_>> {
        match (&self.linear_model, &self.min_f) {
            (Some(Outcome::Ok(model)), _) => Some(DecidingTest::LinearModel(model)),
            (_, Some(Outcome::Ok(line))) => Some(DecidingTest::MinF(line)),
            _ => None,
        }
    }

    /// Whether the two levels differ by less than the smallest effect that matters, by two one-sided tests of the model's
    /// difference. None where there are not two levels or the model cannot be estimated.
    pub(crate) fn equivalence(&self, smallest_effect: f64) -> Option<EquivalenceT> {
        let DecidingTest::LinearModel(model) = self.deciding_test()? else { return None };
        let [pair] = model.pairs.as_slice() else { return None };
        let options = EquivalenceOptions::smallest_effect(smallest_effect);
        EquivalenceT::of(pair.difference, pair.se, pair.df, &options).ok()?.ok()
    }

    /// Its p.
    pub(crate) fn p(&self) -> Option<f64> {
        self.deciding_test().map(|test| match test {
            DecidingTest::LinearModel(model) => model.p,
            DecidingTest::MinF(line) => line.row.p_value,
        })
    }
}

/// The trials of a measure as factors: of people, of segments, of clips.
struct Units {
    person: Factor,
    segment: Factor,
    clip: Factor,
}

impl Units {
    /// None where trials have no segment.
    fn of(export: &Export, measure: &Measure) -> Option<Self> {
        let of_trials = |name: &str, of: &dyn Fn(usize) -> Option<Arc<str>>| {
            let cells: Vec<Option<Arc<str>>> =
                measure.trial.iter().map(|trial| of(*trial)).collect();
            Factor::from_cells(name, cells.iter().map(Option::as_deref), |_| None)
        };
        let segment = of_trials("segment", &|trial| export.trials[trial].segment.clone());
        if segment.levels.is_empty() {
            return None;
        }
        let ids = measure.person.iter().map(|person| Some(export.people[*person].id.as_str()));
        Some(Self {
            person: Factor::from_cells("participant", ids, |_| None),
            segment,
            clip: of_trials("clip", &|trial| Some(Arc::clone(&export.trials[trial].stimulus))),
        })
    }
}

/// The tests of a measure by the levels of one factor or by two, each with whether it is a factor of the clips. None where trials have no segment.
pub(crate) fn tested(
    export: &Export,
    measure: &Measure,
    factors: &[(Factor, bool)],
    decides: bool,
    tests: OtherClipsTests,
) -> Option<OtherClips> {
    let units = Units::of(export, measure)?;
    let (first, _) = factors.first()?;
    let asked = decides || tests != OtherClipsTests::Deciding;
    let linear_model = asked.then(|| linear(measure, factors, &units));
    let (min_f, mixed_model) = match factors {
        [(factor, true)] => {
            let min_f = min_f(export, measure, factor, &units);
            let cumulative = measure.kind == MeasureKind::Rating && tests == OtherClipsTests::All;
            (Some(min_f), cumulative.then(|| cumulative_model(measure, factor, &units)))
        }
        _ => (None, None),
    };
    Some(OtherClips { decides, levels: first.levels.clone(), linear_model, min_f, mixed_model })
}

/// The test of choices between the levels of a factor, each with its segment. None where answers have no segment.
pub(crate) fn of_choices(
    data: &PairedComparisons,
    segment: &Factor,
    decides: bool,
    tests: OtherClipsTests,
) -> Option<OtherClips> {
    if segment.levels.is_empty() || segment.codes.contains(&Factor::MISSING) {
        return None;
    }
    let asked = decides || tests != OtherClipsTests::Deciding;
    let linear_model = asked.then(|| match linear_comparison_model(data, segment) {
        Err(refusal) => Outcome::undefined(refusal),
        Ok(outcome) => outcome.map(comparisons_told).map_reason(Why::from),
    });
    let levels = data.items.clone();
    Some(OtherClips { decides, levels, linear_model, min_f: None, mixed_model: None })
}

fn comparisons_told(found: LinearComparisonModel) -> LinearClipModel {
    let means = found.items.iter().map(|(level, own)| {
        let mean = own.share;
        let own = LinearMean { mean, se: own.se, df: own.df, interval_95: own.interval_95 };
        (level.to_owned(), own)
    });
    LinearClipModel {
        formula:
            "choice ~ left + item + (1 | participant) + (1 | participant:item) + (1 | segment:item)"
                .to_owned(),
        observations: found.answers,
        f: found.effect.f,
        df: found.effect.df,
        df_denominator: found.effect.df_denominator,
        p: found.effect.p,
        ln_p: found.effect.ln_p,
        means: Labelled(means.collect()),
        pairs: found.pairs.into_iter().map(linear_pair).collect(),
        sd: found.sd,
        residual_sd: found.residual_sd,
        at_zero: found.at_zero,
        left_out: Vec::new(),
    }
}

/// As pairs are told elsewhere, the first level less the second.
fn linear_pair(pair: LinearPair) -> LinearClipPair {
    let [low, high] = pair.interval_95;
    LinearClipPair {
        a: pair.a,
        b: pair.b,
        difference: -pair.difference,
        se: pair.se,
        interval_95: [-high, -low],
        df: pair.df,
        p_corrected: pair.p_holm,
    }
}

/// The linear model of all answers, with effects of people and segments, of both with each level, and of people with
/// segments. It contains what differs between segments, so that they need not be matched.
fn linear(
    measure: &Measure,
    factors: &[(Factor, bool)],
    Units { person, segment, .. }: &Units,
) -> Outcome<LinearClipModel, Why> {
    if measure.has_one_row_per_person() {
        return Outcome::undefined(Why::OneRatingPerPerson);
    }
    let mut groupings = Vec::new();
    for unit in [person, segment] {
        groupings.push(unit.clone());
        groupings.extend(factors.iter().map(|(factor, _)| unit.crossed(factor)));
        if let [(a, _), (b, _)] = factors {
            groupings.push(unit.crossed(a).crossed(b));
        }
    }
    groupings.push(person.crossed(segment));
    let groupings: Vec<&Factor> = groupings.iter().collect();
    let fixed: Vec<&Factor> = factors.iter().map(|(factor, _)| factor).collect();
    let options = LinearMixedModelOptions { interactions: factors.len() > 1 };
    match linear_mixed_model(&measure.numbers(), &fixed, &groupings, options) {
        Err(refusal) => Outcome::undefined(refusal),
        Ok(outcome) => outcome.map(linear_told).map_reason(Why::from),
    }
}

fn linear_told(found: LinearMixedModel) -> LinearClipModel {
    LinearClipModel {
        formula: found.formula,
        observations: found.observations,
        f: found.effect.f,
        df: found.effect.df,
        df_denominator: found.effect.df_denominator,
        p: found.effect.p,
        ln_p: found.effect.ln_p,
        means: found.means,
        pairs: found.pairs.into_iter().map(linear_pair).collect(),
        sd: found.sd,
        residual_sd: found.residual_sd,
        at_zero: found.at_zero,
        left_out: found.left_out,
    }
}

/// Averages need the same segments at every level; models contain the segments.
fn min_f(
    export: &Export,
    measure: &Measure,
    factor: &Factor,
    Units { person, segment, .. }: &Units,
) -> TestOutcome {
    let matching = measure.matching(export, factor);
    let call = Call::new(Design::PeopleAndSegments, MinFPrime::NAMES.function)
        .list(&matching.by)
        .text(&measure.id)
        .text(&factor.name)
        .list(&factor.levels);
    let rows = matching.rows();
    let (matched, level) = measure.at(factor, &rows);
    let at = |factor: &Factor| measure.at(factor, &rows).1;
    let factors = [&level, &at(person), &at(segment)];
    TestLine::min_f(min_f_prime(&matched.numbers(), factors), call)
}

fn cumulative_model(
    measure: &Measure,
    factor: &Factor,
    Units { person, segment, clip }: &Units,
) -> Outcome<ClipModel, Why> {
    if measure.has_one_row_per_person() {
        return Outcome::undefined(Why::OneRatingPerPerson);
    }
    let crossed = person.crossed(factor);
    let groupings = [person, &crossed, segment, clip];
    let options = MixedModelOptions { ratio_of_last: true, ..MixedModelOptions::default() };
    match mixed_model(&measure.numbers(), &[factor], &groupings, options) {
        Err(refusal) => Outcome::undefined(refusal),
        Ok(outcome) => outcome.map(told).map_reason(Why::from),
    }
}

fn told(found: MixedModel) -> ClipModel {
    let ratio = found.lr_effect.ratio;
    let pair = |pair: mimique_stats::MixedPair| ClipPair {
        a: pair.a,
        b: pair.b,
        odds_ratio: pair.odds_ratio,
        interval_95: pair.interval_95,
        p_corrected: pair.p_holm,
        higher: pair.higher,
    };
    ClipModel {
        formula: found.formula,
        observations: found.observations,
        likelihood_ratio: ratio.statistic,
        df: ratio.df,
        p: ratio.p,
        ln_p: ratio.ln_p,
        pairs: found.pairs.into_iter().map(pair).collect(),
        ratings: found.ratings,
        shares: found.shares,
        sd: found.sd,
        at_zero: found.at_zero,
        left_out: found.left_out,
        p_of_clips: found.lr_last.map(|last| last.p_half_chi_square),
        loglik: found.loglik,
    }
}
