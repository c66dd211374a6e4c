//! Whether a difference of ratings holds for other people and other clips alike: min F' and a mixed model with effects
//! of people, of people with each level, of segments and of clips.

use std::sync::Arc;

use mimique_stats::{
    Factor, Labelled, MinFPrime, MixedModel, MixedModelOptions, MixedShares, Outcome, TestResult,
    min_f_prime, mixed_model,
};
use mimique_study::Hypothesis;
use serde::Serialize;

use crate::hypothesis::call::{Call, Design};
use crate::hypothesis::test_line::TestLine;
use crate::hypothesis::undefined::{TestOutcome, Why};
use crate::trials::export::Export;
use crate::trials::measure::{Measure, MeasureKind};

/// Which tests of other clips are computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum OtherClipsTests {
    /// Min F' alone, which is quick; the mixed model too where it decides.
    MinF,
    /// Both.
    Both,
}

/// A hypothesis about other clips too.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct OtherClips {
    /// Whether the mixed model decides the hypothesis.
    pub decides: bool,
    /// Levels that are compared.
    pub levels: Vec<String>,
    /// Clark's min F'.
    pub min_f: TestOutcome,
    /// The mixed model; where it did not converge, that, and no p. None where it was not asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mixed_model: Option<Outcome<ClipModel, Why>>,
}

/// What is told of the mixed model.
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

/// Two levels in the mixed model, the second against the first.
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

impl OtherClips {
    /// p of the mixed model.
    pub(crate) fn p(&self) -> Option<f64> {
        match &self.mixed_model {
            Some(Outcome::Ok(model)) => Some(model.p),
            _ => None,
        }
    }
}

/// Whether a hypothesis, the first factor of which is one of the clips, is one that other clips are asked about:
/// ratings compared within people.
pub(crate) fn is_asked(hypothesis: &Hypothesis, measure: &Measure) -> bool {
    measure.kind == MeasureKind::Rating && hypothesis.test.compares_levels()
}

/// Both tests of ratings by the levels of a factor of the clips; none where trials have no segment.
pub(crate) fn tested(
    export: &Export,
    measure: &Measure,
    factor: &Factor,
    decides: bool,
    tests: OtherClipsTests,
) -> Option<OtherClips> {
    let of_trials = |name: &str, of: &dyn Fn(usize) -> Option<Arc<str>>| {
        let cells: Vec<Option<Arc<str>>> = measure.trial.iter().map(|trial| of(*trial)).collect();
        Factor::from_cells(name, cells.iter().map(Option::as_deref), |_| None)
    };
    let segment = of_trials("segment", &|trial| export.trials[trial].segment.clone());
    if segment.levels.is_empty() {
        return None;
    }
    let clip = of_trials("clip", &|trial| Some(Arc::clone(&export.trials[trial].stimulus)));
    let ids = measure.person.iter().map(|person| Some(export.people[*person].id.as_str()));
    let person = Factor::from_cells("participant", ids, |_| None);
    let values = measure.numbers();
    // Averages need the same segments at every level; the model contains the segments.
    let matching = measure.matching(export, factor);
    let call = Call::new(Design::PeopleAndSegments, MinFPrime::NAMES.function)
        .list(&matching.by)
        .text(&measure.id)
        .text(&factor.name)
        .list(&factor.levels);
    let rows = matching.rows();
    let (matched, level) = measure.at(factor, &rows);
    let at = |factor: &Factor| measure.at(factor, &rows).1;
    let factors = [&level, &at(&person), &at(&segment)];
    let min_f = TestLine::min_f(min_f_prime(&matched.numbers(), factors), call);
    let levels = factor.levels.clone();
    if !decides && tests == OtherClipsTests::MinF {
        return Some(OtherClips { decides, levels, min_f, mixed_model: None });
    }
    let crossed = person.crossed(factor);
    let groupings = [&person, &crossed, &segment, &clip];
    let options = MixedModelOptions { ratio_of_last: true, ..MixedModelOptions::default() };
    if measure.has_one_row_per_person() {
        let mixed_model = Some(Outcome::undefined(Why::OneRatingPerPerson));
        return Some(OtherClips { decides, levels, min_f, mixed_model });
    }
    let mixed_model = match mixed_model(&values, &[factor], &groupings, options) {
        Err(refusal) => Outcome::undefined(refusal),
        Ok(outcome) => outcome.map(told).map_reason(Why::from),
    };
    Some(OtherClips { decides, levels, min_f, mixed_model: Some(mixed_model) })
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
