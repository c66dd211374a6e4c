//! Bradley and Terry's model, Thurstone's, the consistency of judges.

use mimique_adaptive::{Comparison, Worths, all_pairs, information, spanning_tree};
use mimique_stats::{
    BradleyTerry, BradleyTerryOptions, Chosen, NoEstimate, Outcome, PairedComparisons, Refusal,
    Separation, Undefined, Unfit, bradley_terry as fit,
};
use serde_json::{Value, json};

use super::{Given, Stop, defined};

/// Draws of participants: as many as the cases' own.
const ROUNDS: usize = 600;

fn comparisons(given: &Given<'_>) -> Result<PairedComparisons, Stop> {
    let table = given.table(0)?;
    let items = given.texts("items")?;
    let factor = |name: &str| table.factor(name);
    let sides = [&factor("left")?, &factor("right")?];
    Ok(PairedComparisons::of(&factor("participant")?, sides, &factor("answer")?, &items)?)
}

/// Worths, or why they have no maximum and what the penalised ones are.
pub(super) fn bradley_terry(given: &Given<'_>) -> Result<Value, Stop> {
    let options = BradleyTerryOptions {
        side: given.flag("side"),
        ties: given.flag("ties").filter(|ties| !ties),
        rounds: if given.expected.find("bootstrap_sd").is_some() { ROUNDS } else { 0 },
        fit_rounds: 0,
        seed: 1,
    };
    let found = match fit(&comparisons(given)?, &options) {
        Ok(found) => found,
        Err(Refusal::Unfit(Unfit::Disconnected { parts })) => {
            return Ok(json!({
                "maximum_likelihood": "undefined",
                "reason": "disconnected",
                "components": parts,
                "penalised": "refused: no answer compares the components",
            }));
        }
        Err(other) => return Err(other.into()),
    };
    match &found.estimates {
        Outcome::Ok(_) => Ok(json!(found)),
        Outcome::Undefined { reason: Undefined::Estimate(NoEstimate::Separated(why)) } => {
            Ok(separated(&found, why))
        }
        Outcome::Undefined { reason } => Err(Stop::refused(reason)),
    }
}

/// Separated answers as cases name them.
fn separated(found: &BradleyTerry, why: &Separation) -> Value {
    let kind = match (why.items_without_defeat.is_empty(), why.items_without_win.is_empty()) {
        (false, _) => "undefeated",
        (true, false) => "winless",
        (true, true) if !why.group.is_empty() => "undefeated group",
        (true, true) if why.side => "side",
        (true, true) => "ties",
    };
    let single = !why.items_without_defeat.is_empty() || !why.items_without_win.is_empty();
    let tied = if why.with_ties && single { " and never tied" } else { "" };
    json!({
        "maximum_likelihood": "undefined",
        "reason": format!("{kind}{tied}"),
        "items_without_defeat": why.items_without_defeat,
        "items_without_win": why.items_without_win,
        "penalised": found.penalised,
    })
}

/// Worths on a normal scale.
pub(super) fn thurstone(given: &Given<'_>) -> Result<Value, Stop> {
    let options =
        BradleyTerryOptions { side: given.flag("side"), ..BradleyTerryOptions::default() };
    Ok(json!(defined(mimique_stats::thurstone(&comparisons(given)?, &options)?)?))
}

/// Circular triads, agreement between judges.
pub(super) fn consistency(given: &Given<'_>) -> Result<Value, Stop> {
    Ok(json!(defined(mimique_stats::consistency(&comparisons(given)?)?)?))
}

/// Which pairs to ask about next.
pub(super) fn active_pairs(given: &Given<'_>) -> Result<Value, Stop> {
    let data = comparisons(given)?;
    let items = data.items.len();
    let answers: Vec<Comparison> = data
        .answers
        .iter()
        .map(|answer| {
            let share = match answer.chosen {
                Chosen::Left => 1.0,
                Chosen::Same => 0.5,
                Chosen::Right => 0.0,
            };
            Comparison::one(answer.left, answer.right, share)
        })
        .collect();
    let worths = Worths::of(items, &answers, given.options.get("prior_sd")?.number()?);
    let mut told = information(&worths, &all_pairs(items));
    let batch = spanning_tree(items, &told);
    told.sort_by(|one, other| other.nats.total_cmp(&one.nats));
    let name = |item: usize| data.items[item].as_str();
    let diagonal: Vec<f64> =
        (0..items).map(|item| worths.covariance[item * items + item]).collect();
    let pairs =
        told.iter().map(|pair| json!({ "a": name(pair.a), "b": name(pair.b), "nats": pair.nats }));
    let batch = batch.iter().map(|pair| json!([name(pair.a), name(pair.b)]));
    Ok(json!({
        "mean": worths.mean,
        "covariance_diagonal": diagonal,
        "information": pairs.collect::<Vec<_>>(),
        "batch": batch.collect::<Vec<_>>(),
    }))
}
