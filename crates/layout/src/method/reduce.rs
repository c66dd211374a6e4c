//! A given layout without the markers that are missed least: the thesis thinned its sets by eye (3.5.2), here
//! each marker (or pair) is taken away in simulated takes, and the one whose loss costs least goes.

use rayon::prelude::*;

use super::chosen::{Chosen, Task};
use super::greedy::ordered;
use crate::error::LayoutError;

/// Thins `start` to so many markers.
pub(super) fn reduce(
    task: &Task<'_, '_>,
    count: usize,
    start: &[usize],
) -> Result<Chosen, LayoutError> {
    if start.len() < count {
        return Err(LayoutError::Kept {
            what: format!(
                "{} markers cannot be thinned to {count}; give a map of more markers by --keep",
                start.len()
            ),
        });
    }
    let mut units = in_units(task, start);
    let markers = |units: &[Vec<usize>]| units.iter().map(Vec::len).sum::<usize>();
    task.progress.stage("reduce", (start.len() - count) as u64);
    while markers(&units) > count {
        let over = markers(&units) - count;
        let kernel = task.rehearsal.kernel(&units.concat())?;
        // A pair is worth two markers; at the end only what fits may go.
        let without = |u: usize| {
            let rest: Vec<usize> = units
                .iter()
                .enumerate()
                .filter(|(i, _)| *i != u)
                .flat_map(|(_, v)| v)
                .copied()
                .collect();
            let own = units[u].len() as f64;
            task.rehearsal.mean_square_with(&rest, kernel).map_or(f64::INFINITY, |e| e / own)
        };
        let full = task.rehearsal.mean_square_with(&units.concat(), kernel).unwrap_or(0.0);
        let costs: Vec<(f64, usize)> = (0..units.len())
            .into_par_iter()
            .filter(|&u| units[u].len() <= over)
            .map(|u| {
                let own = units[u].len() as f64;
                let cost = without(u) * own - full;
                (cost / own, u)
            })
            .collect();
        let least =
            costs.into_iter().reduce(|best, next| if next.0 < best.0 { next } else { best });
        let Some((_, unit)) = least else {
            // Only pairs are left where one marker is too many: half of the pair that costs least goes.
            let last = units.pop().unwrap_or_default();
            units.extend(last.into_iter().take(1).map(|v| vec![v]));
            task.progress.step();
            continue;
        };
        let gone = units.remove(unit);
        gone.iter().for_each(|_| task.progress.step());
    }
    Ok(Chosen { units: ordered(task, units), without_room: Vec::new() })
}

/// Markers as pairs where they are mirror images of each other, else alone.
fn in_units(task: &Task<'_, '_>, markers: &[usize]) -> Vec<Vec<usize>> {
    let mirror = &task.units.face.mirror;
    let mut units: Vec<Vec<usize>> = Vec::new();
    for &v in markers {
        if units.iter().flatten().any(|&taken| taken == v) {
            continue;
        }
        let other = mirror.of[v];
        let pair = task.units.symmetric && other != v && markers.contains(&other);
        units.push(if pair { vec![v, other] } else { vec![v] });
    }
    units
}
