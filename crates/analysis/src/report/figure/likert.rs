//! Ratings as stacked bars.

use mimique_stats::quantile_sorted;

use crate::language::Language;
use crate::report::document::{DataTable, Figure};
use crate::report::figure::LEFT;
use crate::report::figure::svg::{Anchor, Svg, WIDTH, clipped, shade};

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
    let mut svg = Svg::new(caption, top + (height + gap) * rows.len() as f64 + 28.0);
    answer_key(&mut svg, language, &points, right);
    let mut data = DataTable::new(id, caption, headings(language, &points));
    let mut spoken = Vec::new();
    for (place, (label, values)) in rows.iter().enumerate() {
        let y = top + (height + gap) * place as f64;
        svg.text(LEFT - 10.0, y + height / 2.0 + 4.5, "", Anchor::End, &clipped(label, 15));
        let n = values.len() as f64;
        let mut x = LEFT;
        let mut cells = vec![label.clone()];
        for (i, point) in points.iter().enumerate() {
            let count = values.iter().filter(|value| **value == *point as f64).count();
            let width = count as f64 / n * (right - LEFT);
            svg.rect([x, y, width, height], &shade(tone(i, points.len())));
            if width > 20.0 {
                svg.text_on(
                    x + width / 2.0,
                    y + height / 2.0 + 4.5,
                    tone(i, points.len()),
                    &point.to_string(),
                );
            }
            x += width;
            cells.push(count.to_string());
        }
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
    let alt = language.pick(
        format!("Stacked bars of all answers. Means: {}.", spoken.join(", ")),
        format!("Barres empilées de toutes les réponses. Moyennes : {}.", spoken.join(", ")),
    );
    Figure { id: id.to_owned(), caption: caption.to_owned(), alt, svg: svg.finish(), data }
}

/// Shade of a point of the scale.
fn tone(i: usize, points: usize) -> f64 {
    if points > 1 { i as f64 / (points - 1) as f64 } else { 0.5 }
}

/// The points of the scale in their shades, above the bars.
fn answer_key(svg: &mut Svg, language: Language, points: &[i64], right: f64) {
    let step = (right - LEFT) / points.len() as f64;
    for (i, point) in points.iter().enumerate() {
        let (x, tone) = (LEFT + step * i as f64, tone(i, points.len()));
        svg.rect([x, 10.0, step - 2.0, 18.0], &shade(tone));
        svg.text_on(x + step / 2.0 - 1.0, 23.5, tone, &point.to_string());
    }
    svg.text(LEFT - 10.0, 23.0, "soft", Anchor::End, language.pick("answer", "réponse"));
    svg.text(right + 10.0, 23.0, "soft", Anchor::Start, language.pick("mean", "moy."));
}

fn headings(language: Language, points: &[i64]) -> Vec<String> {
    let summary = language.pick(["n", "mean", "median"], ["n", "moyenne", "médiane"]);
    std::iter::once(String::new())
        .chain(points.iter().map(ToString::to_string))
        .chain(summary.map(str::to_owned))
        .collect()
}
