//! Differences of people between two levels.

use mimique_locale::Language;
use mimique_report::document::{DataTable, Figure};
use mimique_report::figure::{LEFT, RIGHT};
use mimique_report::svg::{Anchor, Axis, Svg, clipped};
use mimique_stats::Outcome;

use crate::hypothesis::person_level::Pair;
use crate::report::figure::differences_title;
use crate::trials::measure::MeasureKind;

/// Differences of each person, with the Hodges-Lehmann estimate and its interval.
pub(crate) fn differences(
    language: Language,
    id: &str,
    caption: &str,
    kind: MeasureKind,
    pairs: &[([String; 2], &Pair)],
) -> Figure {
    let all = || pairs.iter().flat_map(|(_, pair)| pair.differences.iter().copied());
    let ends =
        || pairs.iter().filter_map(|(_, p)| p.difference).flat_map(|d| [d.ci_low, d.ci_high]);
    let low = all().chain(ends()).fold(0.0, f64::min);
    let high = all().chain(ends()).fold(0.0, f64::max);
    let axis = Axis::new(low, high, LEFT, RIGHT - 6.0);
    let (top, height) = (26.0, 78.0);
    let bottom = top + height * pairs.len() as f64;
    let mut svg = Svg::new(caption, bottom + 44.0);
    let title = differences_title(language, kind);
    svg.text((LEFT + RIGHT) / 2.0, bottom + 35.0, "small", Anchor::Middle, title);
    for &tick in &axis.ticks {
        let x = axis.place(tick);
        let class = if tick.abs() < 1e-12 { "zero" } else { "rule" };
        svg.line([x, top - 6.0], [x, bottom], class);
        let text = match kind {
            MeasureKind::Recognition => language.fixed(100.0 * tick, 0),
            _ => language.fixed(tick, axis.decimals),
        };
        svg.text(x, bottom + 17.0, "small", Anchor::Middle, &text);
    }
    let mut data = DataTable::new(id, caption, difference_columns(language));
    let mut spoken = Vec::new();
    for (place, (levels, pair)) in pairs.iter().enumerate() {
        let y = top + height * place as f64 + height / 2.0;
        let [first, second] = levels;
        for (text, dy) in [(first.clone(), -4.0), (format!("− {second}"), 13.0)] {
            svg.text(LEFT - 12.0, y + dy, "", Anchor::End, &clipped(&text, 15));
        }
        difference_dots(&mut svg, &axis, y, &pair.differences);
        let label = levels.join(" − ");
        if let Some(estimate) = pair.difference {
            let at = y + 24.0;
            let (low, high) = (axis.place(estimate.ci_low), axis.place(estimate.ci_high));
            svg.line([low, at], [high, at], "whisker");
            svg.line([low, at - 5.0], [low, at + 5.0], "whisker");
            svg.line([high, at - 5.0], [high, at + 5.0], "whisker");
            svg.diamond(axis.place(estimate.estimate), at, 6.0, "mark");
            spoken.push(format!(
                "{label} {} ({} – {})",
                language.number(estimate.estimate),
                language.number(estimate.ci_low),
                language.number(estimate.ci_high)
            ));
        }
        data.row(difference_row(language, label, pair));
    }
    let alt = language.pick(
        format!(
            "One dot a person; diamond and bar are the estimate and its interval: {}.",
            spoken.join("; ")
        ),
        format!(
            "Un point par personne ; losange et barre : estimation et intervalle : {}.",
            spoken.join(" ; ")
        ),
    );
    Figure { id: id.to_owned(), caption: caption.to_owned(), alt, svg: svg.finish(), data }
}

/// Dots of people; those with the same difference stand beside each other, above the estimate.
pub(super) fn difference_dots(svg: &mut Svg, axis: &Axis, y: f64, differences: &[f64]) {
    let mut sorted = differences.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    let columns = ((RIGHT - LEFT) / 7.0).floor();
    let bin = |value: f64| ((axis.place(value) - LEFT) / (RIGHT - LEFT) * columns).round() as i64;
    let most = sorted.chunk_by(|a, b| bin(*a) == bin(*b)).map(<[f64]>::len).max().unwrap_or(1);
    let rise = (42.0 / most as f64).min(7.0);
    for group in sorted.chunk_by(|a, b| bin(*a) == bin(*b)) {
        for (stack, value) in group.iter().enumerate() {
            svg.circle(axis.place(*value), y + 8.0 - stack as f64 * rise, 3.2, "dot");
        }
    }
}

fn difference_columns(language: Language) -> [&'static str; 8] {
    language.pick(
        [
            "pair",
            "people",
            "first higher",
            "second higher",
            "estimate",
            "95 % low",
            "95 % high",
            "p (Holm)",
        ],
        [
            "paire",
            "personnes",
            "premier supérieur",
            "second supérieur",
            "estimation",
            "95 % bas",
            "95 % haut",
            "p (Holm)",
        ],
    )
}

fn difference_row(language: Language, label: String, pair: &Pair) -> Vec<String> {
    let mut cells = vec![label];
    cells.extend([pair.n, pair.a_higher, pair.b_higher].map(|count| count.to_string()));
    cells.extend(match pair.difference {
        Some(estimate) => [estimate.estimate, estimate.ci_low, estimate.ci_high]
            .map(|value| language.number(value)),
        None => ["", "", ""].map(str::to_owned),
    });
    cells.push(match &pair.wilcoxon {
        Outcome::Ok(line) => language.p_cell(line.p_that_counts(), line.row.ln_p),
        Outcome::Undefined { .. } => language.pick("undefined", "non défini").to_owned(),
    });
    cells
}
