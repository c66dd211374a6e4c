//! Results of `mimique test` as text for people.

use std::fmt::Write;

use mimique_stats::{
    AdjustedP, Adjustment, AlignedRankTransform, ChiSquare, Confusion, Description, Friedman,
    KruskalWallis, Labelled, MannWhitney, Outcome, ScheirerRayHare, Spearman, Wilcoxon,
    format_number, format_p,
};

/// A text that grows by lines.
#[derive(Default)]
struct Lines(String);

impl Lines {
    fn add(&mut self, line: impl AsRef<str>) {
        self.0.push_str(line.as_ref().trim_end());
        self.0.push('\n');
    }

    fn warnings(&mut self, warnings: &[String]) {
        for warning in warnings {
            self.add(format!("note: {warning}"));
        }
    }

    /// Rows in columns: the first flush left, the others flush right.
    fn table(&mut self, rows: &[Vec<String>]) {
        let columns = rows.iter().map(Vec::len).max().unwrap_or(0);
        let widths: Vec<usize> = (0..columns)
            .map(|c| {
                rows.iter()
                    .filter_map(|row| row.get(c))
                    .map(|s| s.chars().count())
                    .max()
                    .unwrap_or(0)
            })
            .collect();
        for row in rows {
            let mut line = String::from("  ");
            for (c, cell) in row.iter().enumerate() {
                let pad = " ".repeat(widths[c] - cell.chars().count());
                let _ = if c == 0 {
                    write!(line, "{cell}{pad}")
                } else {
                    write!(line, "  {pad}{cell}")
                };
            }
            self.add(line);
        }
    }
}

fn n(value: f64) -> String {
    format_number(value)
}

fn o(value: Option<f64>) -> String {
    value.map_or_else(|| "undefined".to_owned(), format_number)
}

fn p(p: Option<f64>) -> String {
    p.map_or_else(|| "undefined".to_owned(), |p| format_p(p, p.ln()))
}

fn dropped(rows: usize) -> String {
    match rows {
        0 => String::new(),
        1 => ", 1 row with missing values dropped".to_owned(),
        rows => format!(", {rows} rows with missing values dropped"),
    }
}

fn row(cells: impl IntoIterator<Item = impl Into<String>>) -> Vec<String> {
    cells.into_iter().map(Into::into).collect()
}

pub fn kruskal_wallis(result: &KruskalWallis, posthoc: Option<Adjustment>) -> String {
    let mut lines = Lines::default();
    lines.add(format!("Kruskal-Wallis test ({})", result.variant));
    lines.add(format!(
        "{} observations in {} groups{}",
        result.n,
        result.k,
        dropped(result.dropped)
    ));
    lines.add(format!(
        "H = {}, df = {}, p {}",
        n(result.statistic),
        result.df,
        format_p(result.p_value, result.ln_p)
    ));
    if let Some(exact) = result.exact_permutation_p {
        lines.add(format!("p over all arrangements {}", p(Some(exact))));
    }
    lines.add(format!(
        "effect: epsilon squared = {}, eta squared H = {}",
        n(result.epsilon_squared),
        o(result.eta_squared_h)
    ));
    let mut rows = vec![row(["group", "n", "median", "mean rank"])];
    for (level, count) in result.group_n.iter() {
        let of = |values: &Labelled<f64>| o(values.get(level).copied());
        rows.push(vec![
            level.to_owned(),
            count.to_string(),
            of(&result.medians),
            of(&result.mean_ranks),
        ]);
    }
    lines.table(&rows);
    if let Some(adjustment) = posthoc {
        lines.add(format!("Dunn's comparisons, {} correction", adjustment.as_str()));
        let dunn = &result.dunn;
        let mut rows = vec![row(["pair", "z", "p", "corrected"])];
        for (i, pair) in dunn.pairs.iter().enumerate() {
            rows.push(vec![
                pair.clone(),
                n(dunn.z[i]),
                p(Some(dunn.p[i])),
                p(Some(dunn.adjusted(adjustment)[i])),
            ]);
        }
        lines.table(&rows);
    }
    lines.warnings(&result.warnings);
    lines.0
}

pub fn wilcoxon(result: &Wilcoxon, name: &str) -> String {
    let mut lines = Lines::default();
    lines.add(format!("Wilcoxon signed rank test of {name} ({})", result.variant));
    lines.add(format!(
        "{} pairs, {} of them without difference{}",
        result.n_pairs,
        result.n_zero,
        dropped(result.dropped)
    ));
    lines.add(format!(
        "W+ = {}, W- = {} (zeros ranked: {}, {}), {}, p {}",
        n(result.W_plus),
        n(result.W_minus),
        n(result.W_plus_pratt),
        n(result.W_minus_pratt),
        result.alternative,
        format_p(result.p_value, result.ln_p)
    ));
    let interval = &result.hodges_lehmann_ci;
    lines.add(format!("effect: rank-biserial correlation = {}", n(result.rank_biserial)));
    lines.add(format!(
        "Hodges-Lehmann estimate = {}, 95 % interval {} to {}{}",
        n(interval.estimate),
        n(interval.ci_low),
        n(interval.ci_high),
        if interval.level_reached { "" } else { " (too few pairs for 95 %)" }
    ));
    lines.add("p by variant");
    let rows: Vec<Vec<String>> =
        result.p_by_semantics.iter().map(|(key, value)| vec![key.to_owned(), p(*value)]).collect();
    lines.table(&rows);
    lines.warnings(&result.warnings);
    lines.0
}

pub fn mann_whitney(result: &MannWhitney) -> String {
    let mut lines = Lines::default();
    lines.add(format!("Mann-Whitney test of {} ({})", result.pair, result.variant));
    let sizes: Vec<String> =
        result.group_n.iter().map(|(level, count)| format!("{level}: {count}")).collect();
    let elsewhere = match result.dropped {
        0 => String::new(),
        rows => format!(", {rows} rows with missing values or other levels not used"),
    };
    lines.add(format!("{} observations ({}){elsewhere}", result.n, sizes.join(", ")));
    lines.add(format!("U = {}, p {}", n(result.statistic), format_p(result.p_value, result.ln_p)));
    lines.add(format!("effect: rank-biserial correlation = {}", n(result.rank_biserial)));
    lines.add(format!(
        "Hodges-Lehmann shift = {}, 95 % interval {} to {}",
        n(result.estimate),
        n(result.ci_low),
        n(result.ci_high)
    ));
    lines.warnings(&result.warnings);
    lines.0
}

pub fn scheirer_ray_hare(result: &ScheirerRayHare) -> String {
    let mut lines = Lines::default();
    lines.add(format!("Scheirer-Ray-Hare test ({})", result.variant));
    lines.add(format!("{} observations{}", result.n, dropped(result.dropped)));
    if let Some(table) = result.chosen() {
        let mut rows = vec![row(["effect", "df", "sum of squares", "H", "p", "eta squared H"])];
        for effect in 0..4 {
            let mut cells = vec![
                result.effects[effect].clone(),
                table.df[effect].to_string(),
                n(table.ss[effect]),
            ];
            if effect < 3 {
                cells.extend([
                    o(table.H[effect]),
                    match (table.p[effect], table.ln_p[effect]) {
                        // The column's name is the other side of the equation.
                        (Some(p), Some(ln_p)) => format_p(p, ln_p).replace("= ", ""),
                        _ => "undefined".to_owned(),
                    },
                    o(table.eta_squared_H[effect]),
                ]);
            }
            rows.push(cells);
        }
        lines.table(&rows);
    }
    lines.warnings(&result.warnings);
    lines.0
}

pub fn chi_square(result: &ChiSquare) -> String {
    let mut lines = Lines::default();
    let chosen = &result.default_yates_if_2x2;
    lines.add(chosen.method);
    lines.add(format!("{} observations{}", result.n, dropped(result.dropped)));
    lines.add(format!(
        "chi-square = {}, df = {}, p {}",
        n(chosen.statistic),
        chosen.df,
        format_p(chosen.p_value, chosen.ln_p)
    ));
    if chosen.method != result.uncorrected.method {
        lines.add(format!(
            "without correction: chi-square = {}, p {}",
            n(result.uncorrected.statistic),
            format_p(result.uncorrected.p_value, result.uncorrected.ln_p)
        ));
    }
    if let Some(fisher) = result.fisher_p {
        lines.add(format!("Fisher's exact p {}", p(Some(fisher))));
    }
    lines.add(format!(
        "effect: Cramer's V = {} (bias-corrected {})",
        n(result.cramers_v),
        o(result.cramers_v_bias_corrected)
    ));
    lines.add("observed (expected, standardised residual)");
    let mut rows = Vec::new();
    for (label, counts) in result.observed.iter() {
        if rows.is_empty() {
            let header = counts.iter().map(|(column, _)| column);
            rows.push(row(std::iter::once("").chain(header)));
        }
        let mut cells = vec![label.to_owned()];
        for (column, count) in counts.iter() {
            let of = |table: &Labelled<Labelled<f64>>| {
                table.get(label).and_then(|row| row.get(column)).copied().unwrap_or(0.0)
            };
            cells.push(format!(
                "{count} ({:.1}, {:+.1})",
                of(&result.expected),
                of(&result.std_residuals)
            ));
        }
        rows.push(cells);
    }
    lines.table(&rows);
    lines.warnings(&result.warnings);
    lines.0
}

pub fn spearman(result: &Spearman) -> String {
    let mut lines = Lines::default();
    lines.add(format!("Spearman's rank correlation ({})", result.variant));
    lines.add(format!("{} pairs{}", result.n, dropped(result.dropped)));
    lines.add(format!(
        "rho = {}, p {}; t = {}, df = {}",
        n(result.rho),
        p(result.p_value),
        o(result.t),
        result.df
    ));
    if let Some([low, high]) = result.ci95_bonett_wright {
        lines.add(format!("95 % interval {} to {} (Bonett and Wright)", n(low), n(high)));
    }
    lines.add(format!("Kendall's tau-b = {}", n(result.kendall_tau_b)));
    lines.warnings(&result.warnings);
    lines.0
}

pub fn friedman(result: &Friedman) -> String {
    let mut lines = Lines::default();
    lines.add(format!("Friedman test ({})", result.variant));
    lines.add(format!(
        "{} blocks, {} groups{}",
        result.n_blocks,
        result.k,
        dropped(result.dropped)
    ));
    lines.add(format!(
        "chi-square = {}, df = {}, p {}",
        n(result.statistic),
        result.df,
        format_p(result.p_value, result.ln_p)
    ));
    if let Some(f) = &result.iman_davenport {
        lines.add(format!(
            "Iman and Davenport: F = {}, df = {} and {}, p {}",
            n(f.F),
            f.df1,
            f.df2,
            format_p(f.p_value, f.ln_p)
        ));
    }
    if let Some(quade) = &result.quade {
        lines.add(format!(
            "Quade: F = {}, df = {} and {}, p {}",
            n(quade.statistic),
            quade.df1,
            quade.df2,
            p(Some(quade.p_value))
        ));
    }
    lines.add(format!("effect: Kendall's W = {}", n(result.kendalls_w)));
    let mut rows = vec![row(["group", "mean rank", "mean"])];
    for (level, rank) in result.mean_ranks.iter() {
        rows.push(vec![level.to_owned(), n(*rank), o(result.means.get(level).copied())]);
    }
    lines.table(&rows);
    lines.add("paired comparisons: Wilcoxon, exact conditional, Pratt; Holm");
    let pairwise = &result.posthoc_exact_pratt_holm;
    let mut rows = vec![row(["pair", "p", "corrected"])];
    for (i, pair) in pairwise.pairs.iter().enumerate() {
        rows.push(vec![pair.clone(), p(pairwise.p[i]), p(pairwise.p_holm[i])]);
    }
    lines.table(&rows);
    lines.warnings(&result.warnings);
    lines.0
}

pub fn aligned_rank_transform(result: &AlignedRankTransform) -> String {
    let mut lines = Lines::default();
    lines.add(format!("Aligned rank transform ({})", result.variant));
    lines.add(format!(
        "{} observations, {} blocks{}",
        result.n,
        result.n_blocks,
        dropped(result.dropped)
    ));
    let mut rows = vec![row(["effect", "F", "df1", "df2", "p"])];
    for effect in &result.effects {
        rows.push(vec![
            effect.term.clone(),
            o(effect.F),
            effect.df1.to_string(),
            effect.df2.to_string(),
            p(effect.p_value),
        ]);
    }
    lines.table(&rows);
    lines.warnings(&result.warnings);
    lines.0
}

pub fn describe(groups: &[(&str, &Description)]) -> String {
    let mut lines = Lines::default();
    let named = groups.iter().any(|(name, _)| !name.is_empty());
    let heading = row([
        "",
        "n",
        "missing",
        "mean",
        "sd",
        "se",
        "95 % interval",
        "min",
        "q1",
        "median",
        "q3",
        "max",
        "MAD",
    ]);
    let mut rows = vec![heading];
    for (name, d) in groups {
        rows.push(vec![
            (*name).to_owned(),
            d.n.to_string(),
            d.missing.to_string(),
            n(d.mean),
            o(d.sd),
            o(d.se),
            d.mean_ci_t.map_or_else(
                || "undefined".to_owned(),
                |[low, high]| format!("{} to {}", n(low), n(high)),
            ),
            n(d.min),
            n(d.q1),
            n(d.median),
            n(d.q3),
            n(d.max),
            n(d.mad_raw),
        ]);
    }
    if named {
        lines.table(&rows);
    } else {
        // One sample reads better from top to bottom.
        let sample: Vec<Vec<String>> = rows[0]
            .iter()
            .zip(&rows[1])
            .skip(1)
            .map(|(name, value)| vec![name.clone(), value.clone()])
            .collect();
        lines.table(&sample);
    }
    lines.0
}

pub fn described_groups(groups: &Labelled<Outcome<Description>>) -> String {
    let defined: Vec<(&str, &Description)> = groups
        .iter()
        .filter_map(|(level, outcome)| match outcome {
            Outcome::Ok(description) => Some((level, description)),
            Outcome::Undefined { .. } => None,
        })
        .collect();
    let mut text = if defined.is_empty() { String::new() } else { describe(&defined) };
    for (level, outcome) in groups.iter() {
        if let Some(reason) = outcome.reason() {
            let _ = writeln!(text, "note: {level}: {reason}");
        }
    }
    text
}

pub fn confusion(result: &Confusion) -> String {
    let mut lines = Lines::default();
    lines.add("Confusion matrix: shown in rows, answered in columns");
    let heading = result.labels.iter().map(String::as_str).chain(["recall"]);
    let mut rows = vec![row(std::iter::once("").chain(heading))];
    for (label, counts) in result.matrix.iter() {
        let mut cells = vec![label.to_owned()];
        cells.extend(counts.iter().map(|(_, count)| count.to_string()));
        cells.push(o(result.recall.get(label).copied().flatten()));
        rows.push(cells);
    }
    let mut precision = vec!["precision".to_owned()];
    precision.extend(result.precision.iter().map(|(_, share)| o(*share)));
    rows.push(precision);
    lines.table(&rows);
    let [low, high] = result.accuracy_ci_wilson;
    lines.add(format!(
        "accuracy = {} of {} trials, 95 % interval {} to {} (Wilson){}",
        n(result.accuracy),
        result.n,
        n(low),
        n(high),
        dropped(result.dropped)
    ));
    lines.add(format!("Cohen's kappa = {}", o(result.kappa)));
    lines.0
}

pub fn adjusted(result: &AdjustedP) -> String {
    let mut lines = Lines::default();
    lines.add(format!("{} p-values, {} missing", result.n, result.missing));
    let mut rows = vec![row(["p", "holm", "bonferroni", "BH", "BY", "hochberg"])];
    let cell = |value: Option<f64>| value.map_or_else(|| "NA".to_owned(), format_number);
    for i in 0..result.p.len() {
        rows.push(vec![
            cell(result.p[i]),
            cell(result.holm[i]),
            cell(result.bonferroni[i]),
            cell(result.BH[i]),
            cell(result.BY[i]),
            cell(result.hochberg[i]),
        ]);
    }
    lines.table(&rows);
    lines.0
}
