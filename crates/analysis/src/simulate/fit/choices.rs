//! Choices between two clips: worths, side and ties by Bradley and Terry's model.

use mimique_stats::{BradleyTerryOptions, Outcome, bradley_terry};

use crate::choices::answers::by_factor;
use crate::simulate::parameters::{ByLevel, Compared};
use crate::trials::export::Export;

/// Worths of the levels that were compared, side and ties. Where the answers are separated the worths are penalised;
/// what has no estimate stays, and so do the spreads of people and clips.
pub(super) fn fit(export: &Export, question: &str, compared: &mut Compared) {
    let Some(data) = by_factor(export, question, &compared.factor, &[], &[]) else { return };
    let options =
        BradleyTerryOptions { rounds: 0, fit_rounds: 0, ..BradleyTerryOptions::default() };
    let Ok(found) = bradley_terry(&data, &options) else { return };
    let (worth, side, tie) = match (found.estimates, found.penalised) {
        (Outcome::Ok(own), _) => {
            let estimate = |of: Option<mimique_stats::SideOrTie>| of.map(|of| of.estimate);
            (own.worth, estimate(own.side), estimate(own.tie))
        }
        (Outcome::Undefined { .. }, Some(own)) => (own.worth, own.side, own.tie),
        (Outcome::Undefined { .. }, None) => return,
    };
    compared.worth = found.items.into_iter().zip(worth).collect::<ByLevel>();
    compared.side = side.unwrap_or(compared.side);
    compared.tie = tie.unwrap_or(compared.tie);
}
