//! What each marker of a layout is worth.

use rayon::prelude::*;
use serde::Serialize;

use crate::rehearsal::Rehearsal;

/// What the markers of a layout are worth in simulated takes.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct MarkerWorth {
    /// Error with the markers up to this one, millimetres; null where so few tell no face.
    pub with_those_before_mm: Option<f64>,
    /// How much the error rises without it, millimetres.
    pub missed_mm: Option<f64>,
}

/// The worth of each marker of a layout, in its order.
pub fn worth(rehearsal: &Rehearsal<'_>, vertices: &[usize]) -> Vec<MarkerWorth> {
    let error =
        |markers: &[usize]| rehearsal.mean_square(markers).ok().map(|square| 1e3 * square.sqrt());
    let all = error(vertices);
    (0..vertices.len())
        .into_par_iter()
        .map(|place| {
            let mut others = vertices.to_vec();
            others.remove(place);
            let without = error(&others);
            MarkerWorth {
                with_those_before_mm: error(&vertices[..=place]),
                missed_mm: without.zip(all).map(|(without, all)| without - all),
            }
        })
        .collect()
}
