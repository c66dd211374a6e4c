//! Places spread over a face by distance alone: the next one is where the nearest one is farthest
//! (Gonzalez 1985).

use mimique_geometry::{Point, centroid};

/// Which of `units` (points that are chosen together, at least one) to take, in order, until there are
/// `count` points or no unit fits.
///
/// The first is the one nearest to the mean of all points, unless some points stay; each other the one that
/// is farthest from those chosen and from `stays`. Ties go to the earlier unit. `fits` says of a unit
/// whether it may stand beside those chosen before.
///
/// # Panics
/// If a unit has no point.
pub fn farthest_first(
    units: &[Vec<Point>],
    stays: &[Point],
    count: usize,
    fits: &dyn Fn(&[usize], usize) -> bool,
) -> Vec<usize> {
    let middle = centroid(units.iter().flatten().copied());
    // How far each unit is from what is chosen; from the middle as long as nothing is.
    let to_nearest = |from: &[Point], unit: &Vec<Point>| {
        let distances = unit.iter().flat_map(|p| from.iter().map(|q| (*p - *q).length()));
        distances.fold(f64::INFINITY, f64::min)
    };
    let mut worth: Vec<f64> = units
        .iter()
        .map(|unit| match stays.is_empty() {
            true => -(unit[0] - middle).length(),
            false => to_nearest(stays, unit),
        })
        .collect();
    let mut chosen: Vec<usize> = Vec::new();
    let mut points = 0;
    while points < count {
        let best = (0..units.len())
            .filter(|u| units[*u].len() <= count - points && !chosen.contains(u))
            .filter(|&u| fits(&chosen, u))
            .fold(None, |best: Option<usize>, u| match best {
                Some(b) if worth[u] <= worth[b] => Some(b),
                _ => Some(u),
            });
        let Some(best) = best else { break };
        let first = chosen.is_empty() && stays.is_empty();
        for (worth, unit) in worth.iter_mut().zip(units) {
            let distance = to_nearest(&units[best], unit);
            *worth = if first { distance } else { worth.min(distance) };
        }
        points += units[best].len();
        chosen.push(best);
    }
    chosen
}
