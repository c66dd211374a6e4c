//! Holm's correction over the hypotheses of a study, where a hypothesis may have two p.
//!
//! A hypothesis of equivalence has the p of its two one-sided tests and the p of any difference. Whatever the true
//! difference is, at most one of both null hypotheses is true. By Shaffer (1986, Journal of the American Statistical
//! Association 81, 826) the smallest p is therefore multiplied by the number of hypotheses, not of p values, and each
//! following one by the number of hypotheses with a p that is not smaller.

use crate::hypothesis::HypothesisResult;

/// Corrects the p of every result over all of them.
pub(crate) fn correct(results: &mut [HypothesisResult]) {
    let p: Vec<[Option<f64>; 2]> = results.iter().map(p_values).collect();
    for (result, [of_test, of_difference]) in results.iter_mut().zip(corrected(&p)) {
        result.p_holm_over_hypotheses = of_test;
        result.p_difference_holm_over_hypotheses = of_difference;
    }
}

/// The p that tests a hypothesis, and the p of any difference where equivalence is tested.
pub(crate) fn p_values(result: &HypothesisResult) -> [Option<f64>; 2] {
    [result.p, result.p_difference()]
}

/// The corrected p of each hypothesis: the p that tests it, and the second p of a hypothesis of equivalence.
pub(crate) fn corrected(p: &[[Option<f64>; 2]]) -> Vec<[Option<f64>; 2]> {
    let mut known: Vec<(f64, usize, usize)> = Vec::new();
    for (hypothesis, both) in p.iter().enumerate() {
        let own = both.iter().enumerate();
        known.extend(own.filter_map(|(which, p)| Some(((*p)?, hypothesis, which))));
    }
    known.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut corrected = vec![[None; 2]; p.len()];
    let mut largest = 0.0_f64;
    for (place, &(own, hypothesis, which)) in known.iter().enumerate() {
        let mut open: Vec<usize> = known[place..].iter().map(|(_, of, _)| *of).collect();
        open.sort_unstable();
        open.dedup();
        largest = largest.max(open.len() as f64 * own).min(1.0);
        corrected[hypothesis][which] = Some(largest);
    }
    corrected
}

#[cfg(test)]
mod tests {
    use mimique_stats::Adjustment;

    use super::corrected;

    #[test]
    fn one_p_per_hypothesis_is_holm() {
        let p = [0.02, 0.5, 0.01, 0.04];
        let single: Vec<[Option<f64>; 2]> = p.iter().map(|p| [Some(*p), None]).collect();
        let expected = Adjustment::Holm.apply(&p.map(Some));
        let found: Vec<Option<f64>> = corrected(&single).into_iter().map(|own| own[0]).collect();
        assert_eq!(found, expected);
    }

    #[test]
    fn the_two_p_of_one_hypothesis_do_not_count_twice() {
        assert_eq!(corrected(&[[Some(0.03), Some(0.4)]]), [[Some(0.03), Some(0.4)]]);
        let found = corrected(&[[Some(0.01), Some(0.02)], [Some(0.03), None]]);
        assert_eq!(found, [[Some(0.02), Some(0.04)], [Some(0.04), None]]);
    }
}
