//! Box plots.

use mimique_locale::Language;
use mimique_report::document::{DataTable, Figure};
use mimique_report::figure::{LEFT, RIGHT};
use mimique_report::svg::{Anchor, Axis, Svg, clipped};
use mimique_stats::quantile_sorted;

/// Boxes of quartiles with whiskers from the 5th to the 95th percentile.
pub(crate) fn boxes(
    language: Language,
    id: &str,
    caption: &str,
    unit: &str,
    rows: &[(String, Vec<f64>)],
) -> Figure {
    let sorted: Vec<(String, Vec<f64>)> = rows
        .iter()
        .map(|(label, values)| {
            let mut values = values.clone();
            values.sort_unstable_by(f64::total_cmp);
            (label.clone(), values)
        })
        .collect();
    let high = sorted.iter().map(|(_, v)| quantile_sorted(v, 0.95)).fold(0.0, f64::max);
    let low = sorted.iter().map(|(_, v)| quantile_sorted(v, 0.05)).fold(0.0, f64::min);
    let axis = Axis::new(low, high, LEFT, RIGHT - 6.0);
    let (top, height) = (20.0, 46.0);
    let bottom = top + height * rows.len() as f64;
    let mut svg = Svg::new(caption, bottom + 44.0);
    for &tick in &axis.ticks {
        let x = axis.place(tick);
        svg.line([x, top - 6.0], [x, bottom], "rule");
        let text = language.fixed(tick, axis.decimals);
        svg.text(x, bottom + 17.0, "small", Anchor::Middle, &text);
    }
    svg.text((LEFT + RIGHT) / 2.0, bottom + 36.0, "small", Anchor::Middle, unit);
    let headings = language.pick(
        ["", "n", "5 %", "25 %", "median", "75 %", "95 %"],
        ["", "n", "5 %", "25 %", "médiane", "75 %", "95 %"],
    );
    let mut data = DataTable::new(id, caption, headings);
    let mut spoken = Vec::new();
    for (place, (label, values)) in sorted.iter().enumerate() {
        let y = top + height * (place as f64 + 0.5);
        svg.text(LEFT - 12.0, y + 4.5, "", Anchor::End, &clipped(label, 15));
        let quantiles = [0.05, 0.25, 0.5, 0.75, 0.95].map(|q| quantile_sorted(values, q));
        let [p5, q1, median, q3, p95] = quantiles.map(|value| axis.place(value));
        svg.line([p5, y], [q1, y], "whisker");
        svg.line([q3, y], [p95, y], "whisker");
        svg.class_rect([q1, y - 12.0, q3 - q1, 24.0], "box");
        svg.line([median, y - 12.0], [median, y + 12.0], "whisker");
        let mut cells = vec![label.clone(), values.len().to_string()];
        cells.extend(quantiles.map(|value| language.fixed(value, 2)));
        data.row(cells);
        spoken.push(format!("{label} {}", language.fixed(quantiles[2], 2)));
    }
    let alt = language.pick(
        format!("Box plots. Medians: {}.", spoken.join(", ")),
        format!("Boîtes à moustaches. Médianes : {}.", spoken.join(", ")),
    );
    Figure { id: id.to_owned(), caption: caption.to_owned(), alt, svg: svg.finish(), data }
}
