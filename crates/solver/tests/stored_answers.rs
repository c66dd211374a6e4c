//! Weights against the stored optimum of every variant, operators built here from the avatar.

mod common;

use std::collections::BTreeMap;
use std::path::Path;

use mimique_solver::{Fit, LaplacianKind, Method, MethodSpec, OperatorOptions, Operators, Unit};
use mimique_test_support::real_data;

/// Operators are built once for each set of options.
struct Bench<'a> {
    data: &'a Path,
    built: BTreeMap<String, Operators>,
}

impl Bench<'_> {
    fn operators(&mut self, options: &OperatorOptions) -> &Operators {
        let data = self.data;
        self.built.entry(format!("{options:?}")).or_insert_with(|| common::operators(data, options))
    }
}

fn spec(method: Method, change: impl FnOnce(&mut MethodSpec)) -> MethodSpec {
    let mut spec = MethodSpec::new(method);
    change(&mut spec);
    spec
}

/// METHOD's table: file, options, tolerance on the weights.
fn stored() -> Vec<(String, MethodSpec, f64)> {
    let mut out = Vec::new();
    let mut add = |file: &str, spec: MethodSpec| out.push((file.to_owned(), spec, 1e-8));
    for a in [0.3, 0.5, 0.7] {
        add(&format!("F4_box_k0.1_a{a}"), spec(Method::Lsts, |s| s.alpha = Some(a)));
        add(&format!("F3_squared_k0.1_a{a}"), spec(Method::LstsSoft, |s| s.alpha = Some(a)));
        add(&format!("F1_thesis_normalised_a{a}"), spec(Method::LstsNorm, |s| s.alpha = Some(a)));
        add(&format!("F2_short_normalised_a{a}"), spec(Method::LstsShort, |s| s.alpha = Some(a)));
        add(
            &format!("thesis_literal_mm_a{a}"),
            spec(Method::ThesisLiteral, |s| {
                s.alpha = Some(a);
                s.unit = Some(Unit::Mm);
            }),
        );
    }
    for a in [0.1, 0.3] {
        add(
            &format!("short_literal_mm_a{a}_eps1e-3"),
            spec(Method::ShortLiteral, |s| {
                s.alpha = Some(a);
                s.unit = Some(Unit::Mm);
                s.eps = Some(1e-3);
            }),
        );
    }
    add("F3_squared_k1_a0.5", spec(Method::LstsSoft, |s| s.kappa = Some(1.0)));
    add("F3_squared_k0.1_a0.5_s0.02", spec(Method::LstsSoft, |s| s.s = Some(0.02)));
    add(
        "F3_umbrella_k0.1_a0.5",
        spec(Method::LstsSoft, |s| s.laplacian = Some(LaplacianKind::Umbrella)),
    );
    add("thesis_literal_m_a0.5", spec(Method::ThesisLiteral, |s| s.unit = Some(Unit::M)));
    add("bounds_only_sq_wb1e-3", MethodSpec::new(Method::BoundsOnly));
    add("ts_only_k0.1_a0.5", MethodSpec::new(Method::ThinShellOnly));
    add("box_no_prior_lsq_linear", MethodSpec::new(Method::Box));
    add("nnls_no_prior", MethodSpec::new(Method::Nnls));
    add("kouadio_box_sigma12mm", spec(Method::Kouadio, |s| s.sigma = Some(0.012)));
    out.push(("pinv".to_owned(), MethodSpec::new(Method::PseudoInverse), 5e-7));
    out.push((
        "F3_cotmm_k0.1_a0.5".to_owned(),
        spec(Method::LstsSoft, |s| s.laplacian = Some(LaplacianKind::CotanLiteral)),
        5e-7,
    ));
    out
}

#[test]
fn stored_optima_of_every_variant() {
    let Some(data) = real_data("stored_optima_of_every_variant") else { return };
    let mut bench = Bench { data: &data, built: BTreeMap::new() };
    let (frames, d) = common::table(&data.join("lsts/frames/_Dm_metres.csv"), 1);
    let variants = stored();
    let files = std::fs::read_dir(data.join("lsts/frames")).unwrap().count();
    assert_eq!(variants.len(), files - 1, "every stored file but the displacements has a row");
    let mut failures = Vec::new();
    for (file, spec, tolerance) in variants {
        let path = data.join(format!("lsts/frames/{file}.csv"));
        let (rows, expected) = common::table(&path, 1);
        assert_eq!(rows, frames);
        let fit = Fit::new(bench.operators(&OperatorOptions::of(&spec)), &spec).unwrap();
        let n = fit.shape_count();
        let take = fit.solve_take(&d).unwrap();
        let warm = common::worst(&take.weights, &expected);
        let mut cold: f64 = 0.0;
        for (d, expected) in d.chunks(d.len() / frames).zip(expected.chunks(n)) {
            cold = cold.max(common::worst(&fit.solve_frame(d).unwrap().weights, expected));
        }
        let kkt = take.reports.iter().fold(0.0_f64, |s, r| s.max(r.kkt_error));
        let steps: u32 = take.reports.iter().map(|r| r.iterations).sum();
        let warned = take.reports.iter().filter(|r| r.warning.is_some()).count();
        eprintln!("{file:32} warm {warm:.1e} cold {cold:.1e} kkt {kkt:.1e} steps {steps}");
        if !(warm <= tolerance && cold <= tolerance && kkt <= 1e-9 && warned == 0) {
            failures.push(format!("{file}: {warm:e}, {cold:e}, KKT {kkt:e}, {warned} warnings"));
        }
    }
    assert!(failures.is_empty(), "{failures:#?}");
}
