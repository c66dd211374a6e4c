//! Noncentral t and chi-square: distribution functions, and intervals of the noncentrality by inverting them.

use crate::distributions::special::gamma_tails;
use crate::distributions::tail::normal_quantile_upper;

/// Nodes in (0, 1) and weights of Gauss and Legendre's rule of ten points on [-1, 1] (Abramowitz and Stegun, table 25.4);
/// the rule is symmetric.
const LEGENDRE: [[f64; 2]; 5] = [
    [0.148_874_338_981_631_2, 0.295_524_224_714_752_87],
    [0.433_395_394_129_247_2, 0.269_266_719_309_996_35],
    [0.679_409_568_299_024_4, 0.219_086_362_515_982_04],
    [0.865_063_366_688_984_5, 0.149_451_349_150_580_6],
    [0.973_906_528_517_171_7, 0.066_671_344_308_688_14],
];

/// Standard deviations of the scale that are integrated on each side of 1; a chi variable is farther away with a
/// probability below 1e-18.
const REACH: f64 = 9.0;

/// P(X <= x) of a standard normal variable.
fn normal_below(x: f64) -> f64 {
    0.5 * libm::erfc(-x * std::f64::consts::FRAC_1_SQRT_2)
}

/// P(T <= t) of the noncentral t with `df` > 0 degrees of freedom, by [`scale_nodes`]. Absolute error below 1e-11.
#[cfg(test)]
fn noncentral_t_below(t: f64, df: f64, ncp: f64) -> f64 {
    below_at(&scale_nodes(t, df), ncp)
}

/// The same from the nodes of t.
fn below_at(nodes: &[[f64; 2]], ncp: f64) -> f64 {
    let sum: f64 = nodes.iter().map(|[scaled, weight]| weight * normal_below(scaled - ncp)).sum();
    sum.clamp(0.0, 1.0)
}

/// Values of t s and their probabilities, over which Φ(t s - ncp) is summed in the place of its integral over the density
/// of s = sqrt(chi-square / df) (Johnson, Kotz and Balakrishnan 1995, volume 2, equation 31.10).
fn scale_nodes(t: f64, df: f64) -> Vec<[f64; 2]> {
    let half = df / 2.0;
    let ln_front = std::f64::consts::LN_2 + half * libm::log(half) - libm::lgamma(half);
    let density = |s: f64| libm::exp(ln_front + (df - 1.0) * libm::log(s) - half * s * s);
    let spread = REACH / (2.0 * df).sqrt();
    let (from, to) = ((1.0 - spread).max(0.0), 1.0 + spread);
    // Φ(t s - ncp) rises over a width of 1 / |t|: four panels per width, eight at least.
    let panels = (4.0 * (to - from) * t.abs()).clamp(8.0, 512.0).ceil();
    let width = (to - from) / panels;
    let mut nodes = Vec::with_capacity(10 * panels as usize);
    for panel in 0..panels as usize {
        let centre = from + (panel as f64 + 0.5) * width;
        for [node, weight] in LEGENDRE {
            for s in [centre - node * width / 2.0, centre + node * width / 2.0] {
                nodes.push([t * s, weight * width / 2.0 * density(s)]);
            }
        }
    }
    nodes
}

/// The noncentralities at which a t with `df` degrees of freedom is the upper and the lower 2.5 % point: a 95 % interval
/// (Steiger and Fouladi 1997; Cumming and Finch 2001, "pivoting the noncentral t").
pub(crate) fn noncentrality_of_t(t: f64, df: f64) -> [f64; 2] {
    let reach = normal_quantile_upper(0.025) * (1.0 + t * t / (2.0 * df)).sqrt();
    let nodes = scale_nodes(t, df);
    [0.975, 0.025].map(|below| {
        let towards = if below > 0.5 { t - reach } else { t + reach };
        falling_root(|ncp| below_at(&nodes, ncp) - below, towards, reach)
    })
}

/// P(X <= x) of the noncentral chi-square with `df` degrees of freedom: central ones with df + 2j degrees, weighted by
/// Poisson's probabilities of j (Johnson, Kotz and Balakrishnan 1995, equation 29.3), from the most likely j outwards.
pub(crate) fn noncentral_chi_square_below(x: f64, df: f64, ncp: f64) -> f64 {
    let below = |j: f64| libm::exp(gamma_tails(df / 2.0 + j, x / 2.0).lower);
    let half = ncp / 2.0;
    if half <= 0.0 {
        return below(0.0);
    }
    let weight = |j: f64| libm::exp(j * libm::log(half) - half - libm::lgamma(j + 1.0));
    let middle = half.floor();
    // Terms fall by more than half beyond ten standard deviations.
    let reach = 10.0 * half.sqrt() + 20.0;
    let (first, last) = ((middle - reach).max(0.0), middle + reach);
    let mut sum = 0.0;
    let mut j = first.floor();
    while j <= last {
        let own = weight(j);
        if own > 1e-18 {
            sum += own * below(j);
        }
        j += 1.0;
    }
    sum.min(1.0)
}

/// The noncentralities, 0 at least, at which a chi-square with `df` degrees of freedom is the upper and the lower 2.5 %
/// point: a 95 % interval.
pub(crate) fn noncentrality_of_chi_square(x: f64, df: f64) -> [f64; 2] {
    let reach = 2.0 * normal_quantile_upper(0.025) * (x + df).sqrt();
    [0.975, 0.025].map(|below| {
        let miss = |ncp: f64| noncentral_chi_square_below(x, df, ncp) - below;
        if miss(0.0) <= 0.0 {
            return 0.0;
        }
        let towards = if below > 0.5 { x - df - reach } else { x - df + reach };
        falling_root(|ncp| miss(ncp.max(0.0)), towards.max(0.0), reach)
    })
}

/// The root of a function that never rises, near `guess`: bracketed by steps of `step` that double, then by regula falsi
/// with Illinois's weights (Dowell and Jarratt 1971), to 1e-12 of the bracket's scale.
fn falling_root(of: impl Fn(f64) -> f64, guess: f64, step: f64) -> f64 {
    let (mut low, mut high) = (guess, guess);
    let (mut at_low, mut at_high) = (of(low), of(high));
    let mut step = step.max(1e-3);
    for _ in 0..60 {
        if at_low >= 0.0 && at_high <= 0.0 {
            break;
        }
        if at_low < 0.0 {
            (high, at_high) = (low, at_low);
            low -= step;
            at_low = of(low);
        } else {
            (low, at_low) = (high, at_high);
            high += step;
            at_high = of(high);
        }
        step *= 2.0;
    }
    let mut last = 0;
    for _ in 0..200 {
        if high - low <= 1e-12 * (1.0 + low.abs() + high.abs()) || at_low == at_high {
            break;
        }
        let between = (low * at_high - high * at_low) / (at_high - at_low);
        let between = if between > low && between < high { between } else { (low + high) / 2.0 };
        let at_between = of(between);
        if at_between == 0.0 {
            return between;
        }
        if at_between > 0.0 {
            (low, at_low) = (between, at_between);
            at_high *= if last == 1 { 0.5 } else { 1.0 };
            last = 1;
        } else {
            (high, at_high) = (between, at_between);
            at_low *= if last == -1 { 0.5 } else { 1.0 };
            last = -1;
        }
    }
    if at_low.abs() < at_high.abs() { low } else { high }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::distributions::tail::{chi_square_upper, t_upper};

    /// R 4.2: `pt(t, df, ncp)`.
    #[test]
    fn noncentral_t_is_that_of_r() {
        for (t, df, ncp, below) in [
            (1.5, 10.0, 1.0, 0.669_516_848_215_28),
            (-0.5, 3.0, 2.0, 0.007_800_301_076_44),
            (20.0, 40.0, 18.0, 0.776_672_869_748_35),
            (2.0, 1.0, 1.5, 0.491_019_901_517_57),
        ] {
            let own = noncentral_t_below(t, df, ncp);
            assert!((own - below).abs() < 1e-11, "{t} {df} {ncp}: {own} {below}");
        }
    }

    #[test]
    fn without_noncentrality_they_are_the_central_distributions() {
        for (t, df) in [(0.3, 1.0), (-2.0, 2.0), (4.0, 7.0), (1.9, 400.0)] {
            let central = 1.0 - t_upper(t, df).p;
            assert!((noncentral_t_below(t, df, 0.0) - central).abs() < 1e-10, "{t} {df}");
        }
        for (x, df) in [(0.5, 1.0), (9.0, 4.0)] {
            let central = 1.0 - chi_square_upper(x, df).p;
            assert!((noncentral_chi_square_below(x, df, 0.0) - central).abs() < 1e-12);
        }
    }

    /// R 4.2: `pchisq(x, df, ncp)`.
    #[test]
    fn noncentral_chi_square_is_that_of_r() {
        for (x, df, ncp, below) in [
            (3.0, 2.0, 1.0, 0.620_643_653_219_54),
            (20.0, 4.0, 15.0, 0.593_195_068_442_88),
            (120.0, 2.0, 100.0, 0.817_697_004_217_47),
            (1.0, 5.0, 0.3, 0.032_893_076_645_37),
        ] {
            let own = noncentral_chi_square_below(x, df, ncp);
            assert!((own - below).abs() < 1e-11, "{x} {df} {ncp}: {own} {below}");
        }
    }

    /// R 4.2: `uniroot` on `pt(t, df, ncp)`; R's own tail is right to about 1e-9 there.
    #[test]
    fn intervals_of_the_noncentrality_of_t_are_those_of_r() {
        for (t, df, interval) in [
            (0.0, 9.0, [-1.959_963_984_540, 1.959_963_984_540]),
            (2.5, 9.0, [0.182_943_963_045, 4.715_412_291_213]),
            (-1.2, 4.0, [-3.257_254_864_239, 0.978_585_037_335]),
            (5.0, 30.0, [2.640_411_744_797, 7.300_104_274_764]),
            (12.0, 99.0, [9.407_422_045_223, 14.556_319_102_304]),
        ] {
            let own = noncentrality_of_t(t, df);
            for (own, known) in own.into_iter().zip(interval) {
                assert!((own - known).abs() < 1e-8, "{t} {df}: {own} {known}");
            }
        }
    }

    /// Far from 0 R's `pt` loses its digits; the ends must still be the points they are defined by.
    #[test]
    fn ends_are_at_their_probabilities_also_far_from_zero() {
        for (t, df) in [(60.0, 79.0), (-150.0, 20.0), (8.0, 1.0), (35.0, 3000.0)] {
            let [low, high] = noncentrality_of_t(t, df);
            assert!(
                low < high && (noncentral_t_below(t, df, low) - 0.975).abs() < 1e-9,
                "{t} {df}"
            );
            assert!((noncentral_t_below(t, df, high) - 0.025).abs() < 1e-9, "{t} {df}");
        }
    }
}
