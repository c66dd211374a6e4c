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
    let (_, missed) = missed(rehearsal, vertices);
    missed
        .into_par_iter()
        .enumerate()
        .map(|(place, missed_mm)| MarkerWorth {
            with_those_before_mm: error_mm(rehearsal, &vertices[..=place]),
            missed_mm,
        })
        .collect()
}

/// The error with all markers of a layout, and how much it rises without each, millimetres; none where too few
/// are left to tell a face.
pub fn missed(rehearsal: &Rehearsal<'_>, vertices: &[usize]) -> (Option<f64>, Vec<Option<f64>>) {
    let all = error_mm(rehearsal, vertices);
    let without = |place: usize| {
        let mut others = vertices.to_vec();
        others.remove(place);
        error_mm(rehearsal, &others).zip(all).map(|(without, all)| without - all)
    };
    (all, (0..vertices.len()).into_par_iter().map(without).collect())
}

fn error_mm(rehearsal: &Rehearsal<'_>, markers: &[usize]) -> Option<f64> {
    rehearsal.mean_square(markers).ok().map(|square| 1e3 * square.sqrt())
}
