//! What must not change a test: monotone transformations, names of labels, order of groups and rows.

use mimique_stats::{
    Alternative, Blocks, Factor, Numbers, SumsOfSquares, WilcoxonOptions, friedman, kruskal_wallis,
    mann_whitney, scheirer_ray_hare, spearman, wilcoxon,
};
use proptest::prelude::*;

fn numbers(values: Vec<f64>) -> Numbers {
    Numbers { name: "y".to_owned(), values }
}

fn factor(codes: &[u32], label: impl Fn(u32) -> String) -> Factor {
    let labels: Vec<String> = codes.iter().map(|&code| label(code)).collect();
    Factor::from_cells("g", labels.iter().map(|label| Some(label.as_str())), |_| None)
}

fn close(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-9 * a.abs().max(b.abs()) + 1e-12
}

/// Ratings with many ties, and a group a rating; every group occurs.
fn ratings(groups: u32) -> impl Strategy<Value = (Vec<f64>, Vec<u32>)> {
    let one = (1..=7i32, 0..groups);
    prop::collection::vec(one, 8..60).prop_map(move |rows| {
        let mut values: Vec<f64> = rows.iter().map(|(value, _)| f64::from(*value)).collect();
        let mut codes: Vec<u32> = rows.iter().map(|(_, code)| *code).collect();
        for group in 0..groups {
            values.extend([f64::from(group as i32 + 1), 7.0]);
            codes.extend([group, group]);
        }
        (values, codes)
    })
}

proptest! {
    #[test]
    fn kruskal_wallis_knows_only_order((values, codes) in ratings(4)) {
        let base = kruskal_wallis(&numbers(values.clone()), &factor(&codes, |c| format!("l{c}")))
            .unwrap().ok().unwrap();
        let curved = values.iter().map(|v| (v * 0.7).exp() - 100.0).collect();
        let renamed = kruskal_wallis(&numbers(curved), &factor(&codes, |c| format!("l{}", 9 - c)))
            .unwrap().ok().unwrap();
        prop_assert!(close(base.statistic, renamed.statistic));
        prop_assert!(close(base.ln_p, renamed.ln_p));
        prop_assert!(close(base.epsilon_squared, renamed.epsilon_squared));
        let mirrored = values.iter().map(|v| -v).collect();
        let mirrored = kruskal_wallis(&numbers(mirrored), &factor(&codes, |c| format!("l{c}")))
            .unwrap().ok().unwrap();
        prop_assert!(close(base.statistic, mirrored.statistic));
        for (z, minus_z) in base.dunn.z.iter().zip(&mirrored.dunn.z) {
            prop_assert!(close(*z, -minus_z));
        }
        prop_assert!(base.dunn.p_holm.iter().all(|p| (0.0..=1.0).contains(p)));
    }

    #[test]
    fn two_groups_of_kruskal_wallis_are_mann_whitney((values, codes) in ratings(2)) {
        let (y, g) = (numbers(values), factor(&codes, |c| format!("l{c}")));
        let three = kruskal_wallis(&y, &g).unwrap().ok().unwrap();
        let two = mann_whitney(&y, &g).unwrap().ok().unwrap();
        prop_assert!(close(three.p_value, two.p_asymptotic_nocc));
        prop_assert!(two.ci_low <= two.estimate && two.estimate <= two.ci_high);
        let swapped = mann_whitney(&y, &factor(&codes, |c| format!("l{}", 5 - c)))
            .unwrap().ok().unwrap();
        prop_assert!(close(two.rank_biserial, -swapped.rank_biserial));
        prop_assert!(close(two.p_value, swapped.p_value));
        prop_assert!(close(two.estimate, -swapped.estimate));
    }

    #[test]
    fn wilcoxon_mirrors(values in prop::collection::vec(-6..=6i32, 3..40)) {
        prop_assume!(values.iter().any(|v| *v != 0));
        let differences: Vec<f64> = values.iter().map(|v| f64::from(*v) / 3.0).collect();
        let mirrored = numbers(differences.iter().map(|d| -d).collect());
        let noisy = numbers(differences.iter().map(|d| d + 1e-14).collect());
        let differences = numbers(differences);
        let run = |d: &Numbers, alternative| {
            let options = WilcoxonOptions { alternative, ..WilcoxonOptions::default() };
            wilcoxon(d, options).unwrap().ok().unwrap()
        };
        let base = run(&differences, Alternative::TwoSided);
        let mirror = run(&mirrored, Alternative::TwoSided);
        prop_assert_eq!(base.W_plus, mirror.W_minus);
        for ((key, p), (_, q)) in base.p_by_semantics.iter().zip(mirror.p_by_semantics.iter()) {
            prop_assert!(close(p.unwrap(), q.unwrap()), "{}", key);
        }
        prop_assert!(close(base.rank_biserial, -mirror.rank_biserial));
        prop_assert!(close(base.hodges_lehmann_ci.ci_low, -mirror.hodges_lehmann_ci.ci_high));
        // rounding takes away what is only noise
        prop_assert_eq!(base.p_value, run(&noisy, Alternative::TwoSided).p_value);
        let greater = run(&differences, Alternative::Greater).p_value;
        let less = run(&mirrored, Alternative::Less).p_value;
        prop_assert!(close(greater, less));
    }

    #[test]
    fn scheirer_ray_hare_is_symmetric_in_its_factors(
        rows in prop::collection::vec((1..=7i32, 0..3u32, 0..2u32), 12..60)
    ) {
        let mut rows = rows;
        for a in 0..3 {
            for b in 0..2 {
                rows.push((1 + a as i32 + b as i32, a, b));
            }
        }
        let y = numbers(rows.iter().map(|row| f64::from(row.0)).collect());
        let a = factor(&rows.iter().map(|r| r.1).collect::<Vec<_>>(), |c| format!("l{c}"));
        let b = factor(&rows.iter().map(|r| r.2).collect::<Vec<_>>(), |c| format!("l{c}"));
        let ab = scheirer_ray_hare(&y, [&a, &b], SumsOfSquares::Two).unwrap().ok().unwrap();
        let ba = scheirer_ray_hare(&y, [&b, &a], SumsOfSquares::Two).unwrap().ok().unwrap();
        let scale = ab.type2.ms_total * y.values.len() as f64;
        for (one, two) in [(&ab.type2, &ba.type2), (ab.type3.as_ref().unwrap(), ba.type3.as_ref().unwrap())] {
            prop_assert!((one.ss[0] - two.ss[1]).abs() < 1e-9 * scale);
            prop_assert!((one.ss[1] - two.ss[0]).abs() < 1e-9 * scale);
            prop_assert!((one.ss[2] - two.ss[2]).abs() < 1e-9 * scale);
            prop_assert!((one.ss[3] - two.ss[3]).abs() < 1e-9 * scale);
        }
        // Type I adds up to the total sum of squares.
        let total: f64 = ab.type1.ss.iter().sum();
        prop_assert!((total - ab.type1.ms_total * (y.values.len() - 1) as f64).abs() < 1e-9 * scale);
        prop_assert_eq!(ab.type1.df.iter().sum::<usize>(), y.values.len() - 1);
    }

    #[test]
    fn spearman_knows_only_order(pairs in prop::collection::vec((0..9i32, 0..9i32), 4..40)) {
        let x: Vec<f64> = pairs.iter().map(|p| f64::from(p.0)).collect();
        let y: Vec<f64> = pairs.iter().map(|p| f64::from(p.1)).collect();
        prop_assume!(x.iter().any(|v| *v != x[0]) && y.iter().any(|v| *v != y[0]));
        let base = spearman(&numbers(x.clone()), &numbers(y.clone())).unwrap().ok().unwrap();
        let curved = numbers(x.iter().map(|v| v.powi(3) + 2.0).collect());
        let down = numbers(y.iter().map(|v| -v).collect());
        let turned = spearman(&down, &curved).unwrap().ok().unwrap();
        prop_assert!(close(base.rho, -turned.rho));
        prop_assert!(close(base.kendall_tau_b, -turned.kendall_tau_b));
        prop_assert_eq!(base.p_value.is_some(), turned.p_value.is_some());
        prop_assert!(close(base.p_value.unwrap_or(1.0), turned.p_value.unwrap_or(1.0)));
    }

    #[test]
    fn friedman_knows_only_order_within_blocks(
        rows in prop::collection::vec(prop::collection::vec(1..=7i32, 3), 2..20)
    ) {
        let blocks = |change: &dyn Fn(usize, f64) -> f64| Blocks {
            groups: vec!["a".into(), "b".into(), "c".into()],
            blocks: (0..rows.len()).map(|i| i.to_string()).collect(),
            responses: rows
                .iter()
                .enumerate()
                .map(|(i, row)| row.iter().map(|v| change(i, f64::from(*v))).collect())
                .collect(),
            incomplete: 0,
            dropped: 0,
        };
        let base = friedman(&blocks(&|_, v| v)).ok();
        let shifted = friedman(&blocks(&|i, v| v * 2.0 + 10.0 * i as f64)).ok();
        prop_assert_eq!(base.is_some(), shifted.is_some());
        if let (Some(base), Some(shifted)) = (base, shifted) {
            prop_assert!(close(base.statistic, shifted.statistic));
            prop_assert!((0.0..=1.0 + 1e-12).contains(&base.kendalls_w));
        }
    }
}

#[test]
fn what_is_undefined_is_said_and_carries_no_number() {
    let equal = numbers(vec![4.0; 6]);
    let groups = factor(&[0, 0, 1, 1, 2, 2], |c| format!("l{c}"));
    let outcome = kruskal_wallis(&equal, &groups).unwrap();
    let json = serde_json::to_value(&outcome).unwrap();
    assert_eq!(json["status"], "undefined");
    assert!(json["reason"].as_str().unwrap().contains("all 6 values are equal (4)"));
    assert_eq!(json.as_object().unwrap().len(), 2);
    let nothing = numbers(vec![f64::NAN; 6]);
    let refusal = kruskal_wallis(&nothing, &groups).unwrap_err().to_string();
    assert!(refusal.contains("column \"y\"") && refusal.contains("no row is left"), "{refusal}");
}
