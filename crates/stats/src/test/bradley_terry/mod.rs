//! Worths of items from paired comparisons: Bradley and Terry's model with Davidson's ties and a side bias.
//!
//! Estimates are by maximum likelihood. The test that counts knows that a participant's answers belong
//! together ([`EqualWorths`]); where participants are few, Friedman's test on each one's wins takes its place.
//! Where the answers are separated ([`Separation`]) the estimates are Firth's, marked penalised, and no p is
//! given.

mod clustered;
mod fit_of_model;
mod model;
mod penalised;
mod procedure;
mod resample;
mod separation;
mod wins;

use nalgebra::DMatrix;
use serde::Serialize;

use crate::distributions::tail::{Tail, chi_square_upper};
use crate::outcome::Outcome;
use crate::refusal::{Refusal, Unfit};
use crate::table::comparisons::{PairedComparisons, Presentation};
use crate::undefined::NoEstimate;
pub use clustered::{EqualWorths, WorthContrast};
pub(crate) use clustered::{clustered_of, equal_worths};
use clustered::{contrasts, interval};
pub use fit_of_model::LackOfFit;
pub(crate) use model::Model;
use model::{Maximum, Parameters};
pub use procedure::WORTHS_RATIO;
pub(crate) use procedure::{PROCEDURE, SIDE, side};
pub use resample::Resampling;
use resample::{origin, resampled};
pub use separation::Separation;
pub use wins::WinsTest;

/// What is fitted, and how often is drawn again.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BradleyTerryOptions {
    /// Whether a side bias is fitted; none: wherever the orders that were shown let it be told.
    pub side: Option<bool>,
    /// Whether ties are answers of the model; none: wherever there are any.
    pub ties: Option<bool>,
    /// Draws of participants for the standard deviations over them; 0: none.
    pub rounds: usize,
    /// Draws of answers for the p of the lack of fit where expected counts are small; 0: none.
    pub fit_rounds: usize,
    /// Seed of the draws.
    pub seed: u64,
}

impl Default for BradleyTerryOptions {
    fn default() -> Self {
        Self { side: None, ties: None, rounds: 0, fit_rounds: 999, seed: 1 }
    }
}

/// Result of [`bradley_terry`].
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct BradleyTerry {
    /// Always `bradley-terry`.
    pub test: &'static str,
    /// What was computed.
    pub variant: &'static str,
    /// The items, in the order of all lists.
    pub items: Vec<String>,
    /// Participants.
    pub participants: usize,
    /// Answers.
    pub trials: usize,
    /// Rows left out.
    pub dropped: usize,
    /// Answers that both are the same.
    pub tied: usize,
    /// For each item against each other one, the share of choices of it among those that chose one; none where
    /// nobody chose.
    pub shares: Vec<Vec<Option<f64>>>,
    /// By maximum likelihood, or why there are none.
    #[serde(flatten)]
    pub estimates: Outcome<WorthEstimates>,
    /// Where there are none: Firth's.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub penalised: Option<PenalisedWorths>,
}

/// A parameter beside the worths.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct SideOrTie {
    /// The estimate.
    pub estimate: f64,
    /// Standard error, answers independent.
    pub se_model: f64,
    /// Standard error, clustered by participant; none with one participant.
    pub se_cluster: Option<f64>,
    /// Interval at 95 %, by t on participants less one and `se_cluster`.
    pub interval: Option<[f64; 2]>,
    /// Of the tie alone: Davidson's ν, the exponential.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub nu: Option<f64>,
}

/// A likelihood-ratio test; it takes the answers for independent.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct LikelihoodRatio {
    /// Twice the difference of the log likelihoods.
    pub statistic: f64,
    /// Parameters less.
    pub df: usize,
    /// Upper chi-square tail.
    pub p: f64,
    /// Its natural logarithm.
    pub ln_p: f64,
}

impl LikelihoodRatio {
    /// Of the log likelihoods with and without so many parameters.
    pub(crate) fn of(with: f64, without: f64, df: usize) -> Self {
        let statistic = (2.0 * (with - without)).max(0.0);
        let Tail { p, ln_p } = chi_square_upper(statistic, df as f64);
        Self { statistic, df, p, ln_p }
    }
}

/// Which test of equal worths is to be read.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum DefaultTest {
    /// F on the clustered covariance.
    ClusteredF,
    /// Participants are at most twice the items less one: Friedman's test on the wins of each.
    FriedmanOnWins,
    /// Neither exists: one participant, or few who did not all compare everything.
    None,
}

/// Estimates by maximum likelihood.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct WorthEstimates {
    /// Log worths, sum 0.
    pub worth: Vec<f64>,
    /// Their standard errors, answers independent.
    pub se_model: Vec<f64>,
    /// Their standard errors, clustered by participant; none with one participant.
    pub se_cluster: Option<Vec<f64>>,
    /// Intervals at 95 % of the worths, by t on participants less one and `se_cluster`.
    pub worth_interval: Option<Vec<[f64; 2]>>,
    /// Standard deviations of the worths over resampled participants.
    pub bootstrap_sd: Option<Vec<f64>>,
    /// How participants were drawn.
    pub bootstrap: Option<Resampling>,
    /// Log likelihood.
    pub loglik: f64,
    /// The side bias: what being left adds.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub side: Option<SideOrTie>,
    /// ln ν of the ties.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tie: Option<SideOrTie>,
    /// Which test of equal worths is to be read.
    pub default_test: DefaultTest,
    /// Equal worths, clustered by participant; none where participants are too few.
    pub items_cluster: Option<EqualWorths>,
    /// Equal worths by Friedman's test on each participant's wins; none where not everybody compared all
    /// items equally often.
    pub friedman_on_wins: Option<WinsTest>,
    /// Equal worths, answers independent.
    pub lr_items: LikelihoodRatio,
    /// No side bias, answers independent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub lr_side: Option<LikelihoodRatio>,
    /// Whether the model describes the answers.
    pub lack_of_fit: LackOfFit,
    /// All pairs of items.
    pub contrasts: Vec<WorthContrast>,
}

/// Estimates where the maximum likelihood has none: intervals are open, no p is given.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PenalisedWorths {
    /// Always the same words: what is penalised by what.
    pub penalty: &'static str,
    /// Log worths, sum 0.
    pub worth: Vec<f64>,
    /// Their standard errors, from the information alone.
    pub se_model: Vec<f64>,
    /// The side bias.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub side: Option<f64>,
    /// ln ν of the ties.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tie: Option<f64>,
    /// Log likelihood + ln det I / 2, the worths being w_1 ... w_(k-1).
    pub penalised_loglik: f64,
}

/// Worths of the items that were compared. Refuses items that no answers join; separated answers are
/// undefined, with penalised estimates.
pub fn bradley_terry(
    data: &PairedComparisons,
    options: &BradleyTerryOptions,
) -> Result<BradleyTerry, Refusal> {
    let shown = data.presentations();
    let model = model_of(data, &shown, options)?;
    let names = &data.items;
    let (estimates, penalised) = match model.separation(&shown, names) {
        Some(why) => (Outcome::undefined(NoEstimate::Separated(why)), penalised(model, &shown)),
        None => match estimates(model, data, &shown, options) {
            Some(found) => (Outcome::Ok(found), None),
            None => (Outcome::undefined(NoEstimate::Singular), None),
        },
    };
    Ok(BradleyTerry {
        test: "bradley-terry",
        variant: match (model.ties, model.side) {
            (false, false) => "Bradley and Terry",
            (false, true) => "Bradley and Terry, with a side bias",
            (true, false) => "Bradley and Terry, with Davidson's ties",
            (true, true) => "Bradley and Terry, with Davidson's ties and a side bias",
        },
        items: names.clone(),
        participants: data.participants.len(),
        trials: data.answers.len(),
        dropped: data.dropped,
        tied: shown.iter().map(|p| p.counts[1] as usize).sum(),
        shares: shares(data.items.len(), &shown),
        estimates,
        penalised,
    })
}

/// What is fitted to these answers.
pub(crate) fn model_of(
    data: &PairedComparisons,
    shown: &[Presentation],
    options: &BradleyTerryOptions,
) -> Result<Model, Refusal> {
    let parts = data.parts();
    if parts.len() > 1 {
        let named = |part: Vec<usize>| part.into_iter().map(|i| data.items[i].clone()).collect();
        return Err(Unfit::Disconnected { parts: parts.into_iter().map(named).collect() }.into());
    }
    let has_ties = data.has_ties();
    if options.ties == Some(false) && has_ties {
        return Err(Unfit::TiesNotModelled { tied: shown.iter().map(|p| p.counts[1]).sum() }.into());
    }
    let plain = Model { items: data.items.len(), worths: true, side: false, ties: has_ties };
    let told = || plain.side_is_told(shown);
    if options.side == Some(true) && !told() {
        return Err(Unfit::SideNotTold.into());
    }
    Ok(Model { side: options.side.unwrap_or_else(told), ..plain })
}

fn estimates(
    model: Model,
    data: &PairedComparisons,
    shown: &[Presentation],
    options: &BradleyTerryOptions,
) -> Option<WorthEstimates> {
    let Maximum { at, log_likelihood } = model.maximise(&origin(model), shown);
    let inverse = model.factor(&at, shown)?.inverse();
    let worth = model.worth(&at);
    let clustered = clustered_of(model, data, &inverse, |answer| {
        model.score_of(&at, &worth, (answer.left, answer.right), answer.chosen as usize)
    });
    let participants = data.participants.len();
    let drawn = (options.rounds > 0 && participants > 1)
        .then(|| resampled(model, &at, data, options.rounds, options.seed));
    let covariance = clustered.as_ref();
    let items_cluster = covariance.and_then(|c| equal_worths(model.items, participants, &worth, c));
    let friedman_on_wins = wins::test(data);
    let enough = participants > 2 * (model.items - 1);
    let default_test = match (&items_cluster, &friedman_on_wins) {
        (Some(_), _) if enough => DefaultTest::ClusteredF,
        (_, Some(_)) => DefaultTest::FriedmanOnWins,
        _ => DefaultTest::None,
    };
    let without = |model: Model| model.maximise(&origin(model), shown).log_likelihood;
    let ratio = |reduced: Model| {
        let df = model.parameters() - reduced.parameters();
        LikelihoodRatio::of(log_likelihood, without(reduced), df)
    };
    let beside = Beside { at: &at, inverse: &inverse, covariance, participants };
    let se_cluster = covariance.map(|covariance| model.worth_errors(covariance));
    let worth_interval = se_cluster.as_ref().and_then(|errors| {
        worth.iter().zip(errors).map(|(own, se)| interval(*own, *se, participants)).collect()
    });
    Some(WorthEstimates {
        se_model: model.worth_errors(&inverse),
        se_cluster,
        worth_interval,
        bootstrap_sd: drawn
            .as_ref()
            .and_then(|drawn| (0..model.items).map(|item| drawn.sd(|draw| draw[item])).collect()),
        bootstrap: drawn.as_ref().map(|drawn| drawn.how),
        loglik: log_likelihood,
        side: beside.side(model),
        tie: beside.tie(model),
        default_test,
        items_cluster,
        friedman_on_wins,
        lr_items: ratio(Model { worths: false, ..model }),
        lr_side: model.side.then(|| ratio(Model { side: false, ..model })),
        lack_of_fit: LackOfFit::of(model, &at, shown, options.fit_rounds, options.seed),
        contrasts: contrasts(&data.items, &worth, covariance, participants),
        worth,
    })
}

/// What the parameters beside the worths are made of.
struct Beside<'a> {
    at: &'a Parameters,
    inverse: &'a DMatrix<f64>,
    covariance: Option<&'a DMatrix<f64>>,
    participants: usize,
}

impl Beside<'_> {
    fn of(&self, place: usize, estimate: f64) -> SideOrTie {
        let se = |covariance: &DMatrix<f64>| covariance[(place, place)].max(0.0).sqrt();
        let se_cluster = self.covariance.map(se);
        SideOrTie {
            estimate,
            se_model: se(self.inverse),
            se_cluster,
            interval: se_cluster.and_then(|se| interval(estimate, se, self.participants)),
            nu: None,
        }
    }

    fn side(&self, model: Model) -> Option<SideOrTie> {
        let place = model.items - 1;
        model.side.then(|| self.of(place, model.side_bias(self.at)))
    }

    fn tie(&self, model: Model) -> Option<SideOrTie> {
        let estimate = model.tie(self.at);
        let nu = Some(libm::exp(estimate));
        let of = || self.of(model.parameters() - 1, estimate);
        model.ties.then(|| SideOrTie { nu, ..of() })
    }
}

fn penalised(model: Model, shown: &[Presentation]) -> Option<PenalisedWorths> {
    let found = model.maximise_penalised(shown)?;
    Some(PenalisedWorths {
        penalty: "half the log determinant of the information (Firth 1993)",
        worth: model.worth(&found.at),
        se_model: model.worth_errors(&found.covariance),
        side: model.side.then(|| model.side_bias(&found.at)),
        tie: model.ties.then(|| model.tie(&found.at)),
        penalised_loglik: found.height,
    })
}

fn shares(items: usize, shown: &[Presentation]) -> Vec<Vec<Option<f64>>> {
    let mut wins = vec![vec![0; items]; items];
    for p in shown {
        wins[p.left][p.right] += p.counts[0];
        wins[p.right][p.left] += p.counts[2];
    }
    let share = |a: usize, b: usize| {
        let decided = wins[a][b] + wins[b][a];
        (decided > 0).then(|| wins[a][b] as f64 / decided as f64)
    };
    (0..items).map(|a| (0..items).map(|b| share(a, b)).collect()).collect()
}
