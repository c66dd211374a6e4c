//! Spreads of people, segments and clips from the covariances of pairs of answers.
//!
//! Two answers whose latent values correlate by ρ have the covariance (Hermite series of the bivariate
//! normal distribution, Pearson 1900)
//!
//!   Cov = Σ_{n>=1} ρ^n / n · c_n(1) c_n(2),   c_n = Σ_k φ(u_k) h_{n-1}(u_k),   u_k = τ_k - η,
//!
//! with normalised Hermite polynomials h. Summed over all pairs of a kind (same person; same person and
//! method; same clip; ...) the left side is observed and the right side is a polynomial in ρ, which is
//! solved. Sums over pairs are differences of squared sums over groups, so nothing is quadratic.

use std::collections::HashMap;

use super::ordinal::density;

/// Terms of the series: ρ^24 / 24 is below 1e-5 up to a correlation of 0.7.
const TERMS: usize = 24;

/// One answer: where it stands, its residual, its series.
pub(super) struct Item {
    pub person: usize,
    pub clip: usize,
    pub segment: usize,
    /// Levels of the factors to which people can take differently.
    pub levels: Vec<u32>,
    residual: f64,
    series: [f64; TERMS],
}

impl Item {
    /// `point` was chosen where the thresholds are `thresholds` and the latent mean is `eta`.
    pub(super) fn new(
        (person, clip, segment): (usize, usize, usize),
        levels: Vec<u32>,
        point: usize,
        thresholds: &[f64],
        eta: f64,
    ) -> Self {
        let mut expected = 0.0;
        let mut series = [0.0; TERMS];
        for threshold in thresholds {
            let u = threshold - eta;
            expected += mimique_stats::normal_upper(u).p;
            let (mut before, mut here) = (0.0, 1.0);
            for (n, term) in series.iter_mut().enumerate() {
                *term += density(u) * here;
                let degree = (n + 1) as f64;
                let next = (u * here - (n as f64).sqrt() * before) / degree.sqrt();
                (before, here) = (here, next);
            }
        }
        Self { person, clip, segment, levels, residual: point as f64 - expected, series }
    }
}

/// Sums over pairs: of residuals' products, of each term's, and the number of pairs.
#[derive(Clone, Copy)]
struct Pairs {
    residual: f64,
    series: [f64; TERMS],
    count: f64,
}

impl Pairs {
    const NONE: Self = Self { residual: 0.0, series: [0.0; TERMS], count: 0.0 };

    /// Over the pairs that share a key.
    fn within(items: &[Item], key: impl Fn(&Item) -> Vec<usize>) -> Self {
        let mut groups: HashMap<Vec<usize>, usize> = HashMap::new();
        let mut sums: Vec<(f64, [f64; TERMS], f64)> = Vec::new();
        let mut pairs = Self::NONE;
        for item in items {
            let place = *groups.entry(key(item)).or_insert_with(|| {
                sums.push((0.0, [0.0; TERMS], 0.0));
                sums.len() - 1
            });
            // Each item with those before it, in the order of the answers: the same sum each time.
            let sum = &mut sums[place];
            pairs.residual += sum.0 * item.residual;
            pairs.count += sum.2;
            for n in 0..TERMS {
                pairs.series[n] += sum.1[n] * item.series[n];
                sum.1[n] += item.series[n];
            }
            sum.0 += item.residual;
            sum.2 += 1.0;
        }
        pairs
    }

    fn plus(self, sign: f64, other: &Self) -> Self {
        let mut sum = self;
        sum.residual += sign * other.residual;
        sum.count += sign * other.count;
        for n in 0..TERMS {
            sum.series[n] += sign * other.series[n];
        }
        sum
    }

    /// The correlation of the latent values; none with too few pairs to say.
    fn correlation(&self) -> Option<f64> {
        if self.count < 30.0 {
            return None;
        }
        let excess = |rho: f64| {
            let (mut sum, mut power) = (0.0, 1.0);
            for n in 0..TERMS {
                power *= rho;
                sum += power / (n + 1) as f64 * self.series[n];
            }
            sum - self.residual
        };
        let (mut low, mut high) = (-0.5, 0.98);
        if excess(low) >= 0.0 {
            return Some(low);
        }
        if excess(high) <= 0.0 {
            return Some(high);
        }
        for _ in 0..80 {
            let middle = 0.5 * (low + high);
            if excess(middle) < 0.0 { low = middle } else { high = middle }
        }
        Some(0.5 * (low + high))
    }
}

/// Shares of the latent variance; none where the answers cannot say.
#[derive(Debug, Clone)]
pub(super) struct Components {
    pub person: Option<f64>,
    /// A factor each, in the order of [`Item::levels`].
    pub person_by: Vec<Option<f64>>,
    pub segment: Option<f64>,
    pub clip: Option<f64>,
}

impl Components {
    /// What noise is left.
    pub(super) fn noise(&self) -> f64 {
        let by: f64 = self.person_by.iter().flatten().sum();
        let others = self.person.unwrap_or(0.0)
            + by
            + self.segment.unwrap_or(0.0)
            + self.clip.unwrap_or(0.0);
        (1.0 - others).max(0.02)
    }
}

/// The components of answers with so many factors.
pub(super) fn components(items: &[Item], factors: usize) -> Components {
    // Pairs of one person that agree in exactly these factors, and not in the segment: by inclusion
    // and exclusion over what they agree in at least. Bit `factors` stands for the segment.
    let all = factors + 1;
    let at_least: Vec<Pairs> = (0..1_usize << all)
        .map(|set| {
            Pairs::within(items, |item| {
                let mut key = vec![item.person];
                for factor in 0..factors {
                    key.push(if set >> factor & 1 == 1 { item.levels[factor] as usize } else { 0 });
                }
                key.push(if set >> factors & 1 == 1 { item.segment } else { 0 });
                key
            })
        })
        .collect();
    let exactly = |wanted: usize| {
        (0..1_usize << all).filter(|set| set & wanted == wanted).fold(Pairs::NONE, |sum, set| {
            let sign = if (set ^ wanted).count_ones().is_multiple_of(2) { 1.0 } else { -1.0 };
            sum.plus(sign, &at_least[set])
        })
    };
    let person = exactly(0).correlation();
    let share = |rho: Option<f64>, of: Option<f64>| Some((rho? - of.unwrap_or(0.0)).max(0.0));
    let person_by =
        (0..factors).map(|factor| share(exactly(1 << factor).correlation(), person)).collect();
    let same = |by_person: bool, clip: bool| {
        Pairs::within(items, |item| {
            let place = if clip { item.clip } else { item.segment };
            if by_person { vec![place, item.person] } else { vec![place] }
        })
    };
    let (segments, clips) = (same(false, false), same(false, true));
    let (own_segments, own_clips) = (same(true, false), same(true, true));
    let others_clip = clips.plus(-1.0, &own_clips);
    let others_segment = segments.plus(-1.0, &own_segments).plus(-1.0, &others_clip);
    let segment = others_segment.correlation();
    let clip = share(others_clip.correlation(), segment);
    Components {
        person: person.map(|rho| rho.max(0.0)),
        person_by,
        segment: segment.map(|rho| rho.max(0.0)),
        clip,
    }
}
