//! Votes in, a ranking out that never ranks what overlaps.
//!
//! Worths are Bradley and Terry's with Davidson's ties and a side bias, errors clustered by participant (`mimique-stats`).
//! Every two methods are compared at once: their difference has an interval at 1 - 0.05 / m of the t distribution on
//! participants less one, m being the number of pairs (Bonferroni), so that with 95 % all intervals hold together. Two
//! methods are told apart where that interval leaves 0 out. A method's rank lies, with the same 95 %, between one more
//! than the methods that are told to be better and all less those that are told to be worse. A band ends where every
//! method above is told apart from every method below; within a band nothing is ranked.

mod agreement;
mod bands;
mod document;
mod heterogeneity;
mod rows;

use std::collections::{BTreeMap, BTreeSet};

use mimique_stats::{
    BradleyTerry, BradleyTerryOptions, Chosen, Compared, NoEstimate, Outcome, PairedComparisons,
    Refusal, Undefined, Unfit, WorthContrast, WorthEstimates, bradley_terry, t_quantile_upper,
};
use serde::Serialize;

pub use agreement::Agreement;
pub use bands::Band;
pub use document::ranking_document;
pub use heterogeneity::{Heterogeneity, LaboratoryWorths};
pub use rows::{RankingRow, ranking_rows};

use crate::votes::Vote;

/// A method with fewer votes waits for its place.
pub const FEWEST_VOTES: usize = 30;
/// A method that fewer people have voted on waits for its place.
pub const FEWEST_PEOPLE: usize = 5;
/// All intervals of differences hold together with 1 less this.
const ALPHA: f64 = 0.05;
/// The difference of worths that 75 % of choices tell: ln 3.
const JND: f64 = 1.098_612_288_668_109_8;

/// How often is drawn again.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RankOptions {
    /// Draws of participants for the intervals of worths, and of units for the agreement's.
    pub rounds: usize,
    /// Permutations of participants over laboratories.
    pub permutations: usize,
    /// Seed of the draws.
    pub seed: u64,
}

impl Default for RankOptions {
    fn default() -> Self {
        Self { rounds: 2000, permutations: 1999, seed: 1 }
    }
}

/// How often a method was voted on.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct Standing {
    /// Its name.
    pub method: String,
    /// Votes on pairs with it.
    pub votes: usize,
    /// Those that chose it.
    pub chosen: usize,
    /// Those that saw no difference.
    pub same: usize,
    /// People who gave them.
    pub people: usize,
    /// The first day of them.
    pub first_day: Option<String>,
}

/// A method with its place.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct Placed {
    /// How often it was voted on.
    #[serde(flatten)]
    pub standing: Standing,
    /// Number of its band, from 1.
    pub band: usize,
    /// The best and the worst rank that the votes leave it.
    pub ranks: [usize; 2],
    /// Its worth in just noticeable differences, the mean of all being 0.
    pub worth: f64,
    /// Its interval at 95 %, of this method alone, by t with errors clustered by participant.
    pub interval: Option<[f64; 2]>,
}

/// Two methods compared.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct Difference {
    /// The method of higher worth.
    pub a: String,
    /// The other.
    pub b: String,
    /// Worth of a less that of b, in just noticeable differences.
    pub difference: f64,
    /// Its interval, which holds together with those of all pairs.
    pub interval: [f64; 2],
    /// Share of choices of a among those that choose, as the model has it.
    pub preferred: f64,
    /// Corrected for the number of pairs.
    pub p: f64,
    /// Whether they are told apart.
    pub separated: bool,
}

/// Why nothing is ranked.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(tag = "reason", rename_all = "kebab-case", rename_all_fields = "camelCase")]
pub enum NotRanked {
    /// Fewer than two methods have enough votes.
    TooFewVotes,
    /// The votes fall into parts that no pair joins.
    Disconnected {
        /// The methods of each part.
        parts: Vec<Vec<String>>,
    },
    /// Some methods never lost to others, or never won: how much they differ is not told.
    Separated {
        /// Methods that never lost.
        undefeated: Vec<String>,
        /// Methods that never won.
        winless: Vec<String>,
        /// Methods that never lost to one outside of them.
        group: Vec<String>,
    },
    /// Too few people for intervals that know that a person's votes belong together.
    TooFewPeople {
        /// How many there are.
        people: usize,
        /// How many there must be.
        wanted: usize,
    },
    /// The worths have no finite errors.
    NoErrors,
}

/// What the votes say.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct Ranking {
    /// All pooled votes.
    pub votes: usize,
    /// People who gave them.
    pub people: usize,
    /// First and last day of them.
    pub days: Option<[String; 2]>,
    /// Methods with a place, from the highest worth; none where nothing is ranked.
    pub placed: Vec<Placed>,
    /// Their bands, the best first.
    pub bands: Vec<Band>,
    /// Every two of them.
    pub differences: Vec<Difference>,
    /// Methods that wait for votes, or all of them where nothing is ranked.
    pub waiting: Vec<Standing>,
    /// Why nothing is ranked.
    pub not_ranked: Option<NotRanked>,
    /// The position bias: log odds that being on the left adds, with its standard error.
    pub left_bias: Option<[f64; 2]>,
    /// Votes that saw no difference.
    pub same: usize,
    /// Whether one worth per method describes the votes.
    pub lack_of_fit: Option<mimique_stats::LackOfFit>,
    /// Whether laboratories differ; none where there is one.
    pub heterogeneity: Option<Heterogeneity>,
    /// The worths in each laboratory.
    pub laboratories: Vec<LaboratoryWorths>,
    /// How far people agree.
    pub agreement: Option<Agreement>,
}

/// Ranks the methods: `methods` are all of the arena, of which some may have no votes yet. The order of votes and
/// methods does not matter.
pub fn rank(votes: &[Vote], methods: &[String], options: &RankOptions) -> Ranking {
    let mut sorted: Vec<&Vote> = votes.iter().collect();
    sorted.sort_by(|a, b| {
        (&a.laboratory, &a.session, a.place, &a.take, &a.left).cmp(&(
            &b.laboratory,
            &b.session,
            b.place,
            &b.take,
            &b.left,
        ))
    });
    let methods: BTreeSet<&str> = methods.iter().map(String::as_str).collect();
    let among = |names: &BTreeSet<&str>| -> Vec<&Vote> {
        let is = |name: &str| names.contains(name);
        sorted.iter().copied().filter(|vote| is(&vote.left) && is(&vote.right)).collect()
    };
    let known = among(&methods);
    let ready = with_enough(&methods, among);
    let counted = among(&ready);
    let standing = |method: &&str| standing_of(method, &known);
    let days = known.iter().map(|vote| &vote.day);
    let mut ranking = Ranking {
        votes: known.len(),
        people: people(&known).len(),
        days: days.clone().min().zip(days.max()).map(|(a, b)| [a.clone(), b.clone()]),
        placed: Vec::new(),
        bands: Vec::new(),
        differences: Vec::new(),
        waiting: Vec::new(),
        not_ranked: None,
        left_bias: None,
        same: known.iter().filter(|vote| vote.chosen == Chosen::Same).count(),
        lack_of_fit: None,
        heterogeneity: heterogeneity::heterogeneity(&counted, options),
        laboratories: heterogeneity::worths(&counted),
        agreement: agreement::agreement(&known, options),
    };
    match estimated(&counted, &ready, options) {
        Ok((items, found, differences)) => {
            ranking.left_bias =
                found.side.map(|side| [side.estimate, side.se_cluster.unwrap_or(side.se_model)]);
            ranking.lack_of_fit = Some(found.lack_of_fit);
            ranking.placed =
                placed(&items, &found, &differences, |method| standing_of(method, &counted));
            ranking.bands = bands::bands(&mut ranking.placed, &differences);
            ranking.differences = differences;
            let waits = methods.iter().filter(|method| !ready.contains(**method));
            ranking.waiting = waits.map(standing).collect();
        }
        Err(why) => {
            ranking.not_ranked = Some(why);
            ranking.waiting = methods.iter().map(standing).collect();
        }
    }
    ranking
}

/// The methods with enough votes, and enough people, among themselves.
fn with_enough<'a>(
    methods: &BTreeSet<&'a str>,
    among: impl Fn(&BTreeSet<&str>) -> Vec<&'a Vote>,
) -> BTreeSet<&'a str> {
    let mut ready = methods.clone();
    loop {
        let own = among(&ready);
        let few = |method: &&str| {
            let standing = standing_of(method, &own);
            standing.votes < FEWEST_VOTES || standing.people < FEWEST_PEOPLE
        };
        // The method with fewest votes goes first: without it another's may still be enough, or no longer.
        let least = ready
            .iter()
            .filter(|method| few(method))
            .min_by_key(|method| (standing_of(method, &own).votes, (**method).to_owned()));
        let Some(least) = least.copied() else { return ready };
        ready.remove(least);
    }
}

fn standing_of(method: &str, votes: &[&Vote]) -> Standing {
    let own: Vec<&&Vote> =
        votes.iter().filter(|vote| vote.left == method || vote.right == method).collect();
    let chose = |vote: &&&&Vote| match vote.chosen {
        Chosen::Left => vote.left == method,
        Chosen::Right => vote.right == method,
        Chosen::Same => false,
    };
    Standing {
        method: method.to_owned(),
        votes: own.len(),
        chosen: own.iter().filter(chose).count(),
        same: own.iter().filter(|vote| vote.chosen == Chosen::Same).count(),
        people: own.iter().map(|vote| &vote.session).collect::<BTreeSet<_>>().len(),
        first_day: own.iter().map(|vote| &vote.day).min().cloned(),
    }
}

fn people<'a>(votes: &[&'a Vote]) -> BTreeSet<&'a str> {
    votes.iter().map(|vote| vote.session.as_str()).collect()
}

/// The votes as paired comparisons of the methods that they are of, in the order of their names.
fn comparisons(votes: &[&Vote]) -> PairedComparisons {
    let items: BTreeSet<&str> =
        votes.iter().flat_map(|vote| [vote.left.as_str(), vote.right.as_str()]).collect();
    let item = |name: &str| items.iter().position(|own| *own == name).unwrap_or(0);
    let mut places: BTreeMap<&str, usize> = BTreeMap::new();
    let mut participants = Vec::new();
    let answers = votes.iter().map(|vote| {
        let participant = *places.entry(&vote.session).or_insert_with(|| {
            participants.push(vote.session.clone());
            participants.len() - 1
        });
        Compared {
            participant,
            left: item(&vote.left),
            right: item(&vote.right),
            chosen: vote.chosen,
        }
    });
    let answers = answers.collect();
    let items = items.into_iter().map(str::to_owned).collect();
    PairedComparisons { items, participants, answers, dropped: 0 }
}

/// Worths and differences, or why there are none.
type Estimated = (Vec<String>, WorthEstimates, Vec<Difference>);

fn estimated(
    votes: &[&Vote],
    ready: &BTreeSet<&str>,
    options: &RankOptions,
) -> Result<Estimated, NotRanked> {
    if ready.len() < 2 {
        return Err(NotRanked::TooFewVotes);
    }
    let data = comparisons(votes);
    let options = BradleyTerryOptions { seed: options.seed, ..BradleyTerryOptions::default() };
    let found = match bradley_terry(&data, &options) {
        Ok(BradleyTerry { estimates: Outcome::Ok(found), .. }) => found,
        Ok(BradleyTerry { estimates: Outcome::Undefined { reason }, .. }) => {
            return Err(undefined(reason));
        }
        Err(Refusal::Unfit(Unfit::Disconnected { parts })) => {
            return Err(NotRanked::Disconnected { parts });
        }
        Err(_) => return Err(NotRanked::NoErrors),
    };
    let (people, items) = (data.participants.len(), data.items.len());
    // As `WorthEstimates::default_test`: below this the clustered errors are too small.
    let wanted = 2 * (items - 1) + 1;
    if people < wanted {
        return Err(NotRanked::TooFewPeople { people, wanted });
    }
    let m = found.contrasts.len();
    let quantile = t_quantile_upper(ALPHA / (2.0 * m as f64), (people - 1) as f64);
    let differences: Option<Vec<Difference>> =
        found.contrasts.iter().map(|contrast| difference(contrast, quantile, m)).collect();
    Ok((data.items, found, differences.ok_or(NotRanked::NoErrors)?))
}

fn undefined(why: Undefined) -> NotRanked {
    match why {
        Undefined::Estimate(NoEstimate::Separated(own)) => NotRanked::Separated {
            undefeated: own.items_without_defeat,
            winless: own.items_without_win,
            group: own.group,
        },
        _ => NotRanked::NoErrors,
    }
}

/// A contrast with its interval, the higher worth first.
fn difference(contrast: &WorthContrast, quantile: f64, pairs: usize) -> Option<Difference> {
    let se = contrast.se_cluster.filter(|se| *se > 0.0 && se.is_finite())?;
    let p = (contrast.p? * pairs as f64).min(1.0);
    let (mut a, mut b) = (contrast.a.clone(), contrast.b.clone());
    let (mut value, mut preferred) = (contrast.difference, contrast.preferred);
    if value < 0.0 {
        std::mem::swap(&mut a, &mut b);
        (value, preferred) = (-value, 1.0 - preferred);
    }
    let interval = [value - quantile * se, value + quantile * se].map(|end| end / JND);
    let separated = interval[0] > 0.0;
    Some(Difference { a, b, difference: value / JND, interval, preferred, p, separated })
}

/// The methods from the highest worth, with the ranks that are left to each.
fn placed(
    items: &[String],
    found: &WorthEstimates,
    differences: &[Difference],
    standing: impl Fn(&str) -> Standing,
) -> Vec<Placed> {
    let told = |better: bool, method: &str| {
        let is = |d: &&Difference| d.separated && (if better { &d.b } else { &d.a }) == method;
        differences.iter().filter(is).count()
    };
    let mut all: Vec<Placed> = (items.iter().enumerate())
        .map(|(place, method)| Placed {
            standing: standing(method),
            band: 0,
            ranks: [1 + told(true, method), items.len() - told(false, method)],
            worth: found.worth[place] / JND,
            interval: (found.worth_interval.as_ref()).map(|all| all[place].map(|end| end / JND)),
        })
        .collect();
    all.sort_by(|a, b| {
        b.worth.total_cmp(&a.worth).then_with(|| a.standing.method.cmp(&b.standing.method))
    });
    all
}
