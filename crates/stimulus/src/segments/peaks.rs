//! Borders of a take: the frames in which the face changes most (thesis 4.4.2).

/// How far above the lowest energies around it a border stands out, as a share of the strong ones.
const BORDER: f64 = 0.15;
/// Seconds within which two borders are one.
const BORDER_S: f64 = 0.12;

/// The middles of the changes: peaks of the energy's root that stand out and fall to half on
/// either side. A change has two peaks of acceleration about one of velocity: it is one border.
///
/// `root` is the root of [`Activity::energy`](super::Activity::energy), a number a frame; of fewer than
/// three frames there are none.
pub(super) fn peaks(root: &[f64], rate_hz: f64) -> Vec<usize> {
    let frames = root.len();
    if frames < 3 {
        return Vec::new();
    }
    let mut sorted = root.to_vec();
    sorted.sort_by(f64::total_cmp);
    let least = BORDER * nearest_quantile(&sorted, 0.95);
    let around = ((BORDER_S * rate_hz) as usize).max(2);
    // How far the curve falls on a side before it rises above the peak again.
    let fall = |peak: usize, side: &mut dyn Iterator<Item = usize>| {
        let until = side.take_while(|&g| root[g] <= root[peak]);
        root[peak] - until.map(|g| root[g]).fold(root[peak], f64::min)
    };
    let mut found: Vec<usize> = (1..frames - 1)
        .filter(|&f| root[f] > root[f - 1] && root[f] >= root[f + 1] && root[f] >= least)
        .filter(|&f| {
            let falls = fall(f, &mut (0..f).rev()).min(fall(f, &mut (f + 1..frames)));
            falls >= least.max(0.5 * root[f])
        })
        .map(|f| {
            let half = |g: &usize| root[*g] > 0.5 * root[f];
            let start = (0..f).rev().take_while(half).last().unwrap_or(f);
            let end = (f..frames).take_while(half).last().unwrap_or(f);
            let weight: f64 = (start..=end).map(|g| root[g]).sum();
            let moment: f64 = (start..=end).map(|g| root[g] * g as f64).sum();
            (moment / weight).round() as usize
        })
        .collect();
    found.dedup_by(|b, a| b.abs_diff(*a) <= around);
    found
}

/// The order statistic of ascending numbers that is nearest to a share of their way; 0 of none.
pub(super) fn nearest_quantile(sorted: &[f64], share: f64) -> f64 {
    let at = share * sorted.len().saturating_sub(1) as f64;
    sorted.get(at.round() as usize).copied().unwrap_or(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_planted_bump_is_one_border_at_its_middle() {
        let bump = |f: usize, at: f64| (-((f as f64 - at) / 6.0).powi(2)).exp();
        let root: Vec<f64> = (0..300).map(|f| bump(f, 80.0) + 0.8 * bump(f, 200.0)).collect();
        assert_eq!(peaks(&root, 100.0), [80, 200]);
        assert!(peaks(&root[..2], 100.0).is_empty() && peaks(&[], 100.0).is_empty());
    }
}
