//! Which pairs of items to ask about next: those whose answers are expected to tell most about the worths
//! (Lindley 1956), so joined that every item is asked about (the spanning tree of greatest information;
//! Li, Mantiuk et al. 2018, "Hybrid-MST").

use crate::psychometric::logistic;
use crate::quadrature::GaussHermite;
use crate::worths::Worths;

/// A pair that may be asked about, and what is expected of the answer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PairInformation {
    /// One item.
    pub a: usize,
    /// The other.
    pub b: usize,
    /// Expected information of the answer about the difference of their worths, in nats.
    pub nats: f64,
}

/// Points of the quadrature.
const POINTS: usize = 32;

/// H(E p) - E H(p) of each pair: p = logistic(d), d normal with the posterior's mean and variance of the
/// difference, H the entropy of a choice. In the order of the pairs.
///
/// # Panics
/// For an item that the worths do not have.
pub fn information(worths: &Worths, pairs: &[(usize, usize)]) -> Vec<PairInformation> {
    let rule = GaussHermite::new(POINTS);
    let of = |&(a, b): &(usize, usize)| {
        let mean = worths.mean[a] - worths.mean[b];
        let variance = worths.variance_of_difference(a, b).max(0.0);
        let share = rule.mean(mean, variance, logistic);
        let doubt = rule.mean(mean, variance, |d| choice_entropy(logistic(d)));
        PairInformation { a, b, nats: choice_entropy(share) - doubt }
    };
    pairs.iter().map(of).collect()
}

/// All pairs of items, in order.
pub fn all_pairs(items: usize) -> Vec<(usize, usize)> {
    (0..items).flat_map(|a| (a + 1..items).map(move |b| (a, b))).collect()
}

/// The spanning tree of greatest information (Kruskal 1956), the most informative pair first. Of pairs with
/// equal information the earlier one comes first. Where the pairs do not connect the items, a tree for each
/// part of them.
pub fn spanning_tree(items: usize, pairs: &[PairInformation]) -> Vec<PairInformation> {
    let mut order: Vec<&PairInformation> = pairs.iter().collect();
    order.sort_by(|one, other| other.nats.total_cmp(&one.nats));
    let mut part: Vec<usize> = (0..items).collect();
    let mut tree = Vec::with_capacity(items.saturating_sub(1));
    for pair in order {
        let (a, b) = (part[pair.a], part[pair.b]);
        if a != b {
            part.iter_mut().filter(|own| **own == b).for_each(|own| *own = a);
            tree.push(*pair);
        }
    }
    tree
}

/// Entropy of a choice of probability p, in nats.
fn choice_entropy(p: f64) -> f64 {
    let part = |p: f64| if p > 0.0 { -p * libm::log(p) } else { 0.0 };
    part(p) + part(1.0 - p)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::worths::Comparison;

    #[test]
    fn what_is_known_tells_less_than_what_is_not() {
        // 0 and 1 have been compared a hundred times, 2 never; 3 is known to be far above 0.
        let answers = [
            Comparison { a: 0, b: 1, wins: 50.0, answers: 100.0 },
            Comparison { a: 3, b: 0, wins: 100.0, answers: 100.0 },
        ];
        let worths = Worths::of(4, &answers, 2.0);
        let found = information(&worths, &all_pairs(4));
        let of = |a: usize, b: usize| found.iter().find(|p| (p.a, p.b) == (a, b)).unwrap().nats;
        assert!(found.iter().all(|pair| pair.nats > 0.0));
        assert!(of(0, 2) > of(0, 1) && of(0, 2) > of(0, 3), "{found:?}");
    }

    #[test]
    fn information_is_the_integral_that_it_says() {
        let worths = Worths::of(2, &[Comparison::one(0, 1, 1.0)], 1.0);
        let found = information(&worths, &[(0, 1)])[0].nats;
        let (mean, sd) =
            (worths.mean[0] - worths.mean[1], worths.variance_of_difference(0, 1).sqrt());
        let (mut share, mut doubt, mut all) = (0.0, 0.0, 0.0);
        for step in -8000..=8000 {
            let z = f64::from(step) / 1000.0;
            let (weight, p) = (libm::exp(-0.5 * z * z), logistic(mean + sd * z));
            share += weight * p;
            doubt += weight * choice_entropy(p);
            all += weight;
        }
        let literal = choice_entropy(share / all) - doubt / all;
        assert!((found - literal).abs() < 1e-10, "{found} {literal}");
    }

    #[test]
    fn the_tree_is_the_greatest_of_all_trees() {
        let mut random = mimique_test_support::Random::new(9);
        for _ in 0..20 {
            let pairs: Vec<PairInformation> = all_pairs(5)
                .into_iter()
                .map(|(a, b)| PairInformation { a, b, nats: (4.0 * random.uniform()).round() })
                .collect();
            let tree = spanning_tree(5, &pairs);
            let sum = |pairs: &[PairInformation]| pairs.iter().map(|pair| pair.nats).sum::<f64>();
            let best = (0u32..1 << 10)
                .filter(|chosen| chosen.count_ones() == 4)
                .map(|chosen| {
                    let own: Vec<PairInformation> =
                        (0..10).filter(|i| chosen >> i & 1 == 1).map(|i| pairs[i]).collect();
                    if spanning_tree(5, &own).len() == 4 { sum(&own) } else { 0.0 }
                })
                .fold(0.0, f64::max);
            assert_eq!((tree.len(), sum(&tree)), (4, best));
        }
    }

    #[test]
    fn pairs_in_parts_give_a_tree_for_each_part() {
        let pairs = [(0, 1), (2, 3)].map(|(a, b)| PairInformation { a, b, nats: 0.1 });
        assert_eq!(spanning_tree(5, &pairs).len(), 2);
        assert!(spanning_tree(0, &[]).is_empty());
    }
}
