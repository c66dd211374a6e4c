//! Ratings as stacked bars.

use mimique_locale::Language;
use mimique_report::document::{DataTable, Figure};
use mimique_report::figure::LEFT;
use mimique_report::svg::{Anchor, Svg, WIDTH, clipped};
use mimique_stats::quantile_sorted;

use crate::report::figure::stacked::{answer_key, stacked_bar};

/// Ratings a level as bars of all answers, from the lowest to the highest point.
pub(crate) fn likert(
    language: Language,
    id: &str,
    caption: &str,
    (first, last): (i64, i64),
    rows: &[(String, Vec<f64>)],
) -> Figure {
    let points: Vec<i64> = (first..=last).collect();
    let (top, height, gap) = (44.0, 26.0, 12.0);
    let right = WIDTH - 48.0;
    let mut svg = Svg::new(caption, top + (height + gap) * rows.len() as f64 + 42.0);
    let names: Vec<String> = points.iter().map(ToString::to_string).collect();
    answer_key(&mut svg, language, &names, right);
    svg.text(right + 10.0, 23.0, "soft", Anchor::Start, language.pick("mean", "moy."));
    let mut data = DataTable::new(id, caption, headings(language, &names));
    let mut spoken = Vec::new();
    for (place, (label, values)) in rows.iter().enumerate() {
        let y = top + (height + gap) * place as f64;
        svg.text(LEFT - 10.0, y + height / 2.0 + 4.5, "", Anchor::End, &clipped(label, 15));
        let n = values.len() as f64;
        let counts: Vec<usize> = points
            .iter()
            .map(|point| values.iter().filter(|value| **value == *point as f64).count())
            .collect();
        let shares: Vec<f64> = counts.iter().map(|count| *count as f64 / n).collect();
        stacked_bar(&mut svg, [LEFT, y, right - LEFT, height], &shares, &names);
        let mut cells = vec![label.clone()];
        cells.extend(counts.iter().map(usize::to_string));
        let mean = values.iter().sum::<f64>() / n;
        let mut sorted = values.clone();
        sorted.sort_unstable_by(f64::total_cmp);
        let mean_text = language.fixed(mean, 2);
        svg.text(right + 10.0, y + height / 2.0 + 4.5, "strong", Anchor::Start, &mean_text);
        cells.extend([
            values.len().to_string(),
            mean_text.clone(),
            language.number(quantile_sorted(&sorted, 0.5)),
        ]);
        spoken.push(format!("{label} {mean_text}"));
        data.row(cells);
    }
    let bottom = top + (height + gap) * rows.len() as f64 + 12.0;
    for share in [0.0, 0.5, 1.0] {
        let x = LEFT + share * (right - LEFT);
        svg.text(x, bottom + 4.0, "small", Anchor::Middle, &language.percent(share));
    }
    let title = language.pick("share of answers", "part des réponses");
    svg.text((LEFT + right) / 2.0, bottom + 20.0, "small", Anchor::Middle, title);
    let alt = language.pick(
        format!("Stacked bars of all answers. Means: {}.", spoken.join(", ")),
        format!("Barres empilées de toutes les réponses. Moyennes : {}.", spoken.join(", ")),
    );
    Figure { id: id.to_owned(), caption: caption.to_owned(), alt, svg: svg.finish(), data }
}

fn headings(language: Language, names: &[String]) -> Vec<String> {
    let summary = language.pick(["n", "mean", "median"], ["n", "moyenne", "médiane"]);
    std::iter::once(String::new())
        .chain(names.iter().cloned())
        .chain(summary.map(str::to_owned))
        .collect()
}
