//! Intervals of a difference in the zone of differences that do not matter.

use mimique_locale::Language;
use mimique_report::document::{DataTable, Figure};
use mimique_report::figure::{LEFT, RIGHT};
use mimique_report::svg::{Anchor, Axis, Svg};

use crate::report::figure::differences::difference_dots;
use crate::report::figure::differences_title;
use crate::trials::measure::MeasureKind;

/// An estimate and its interval at 90 %.
pub(crate) struct EquivalenceInterval {
    pub label: &'static str,
    pub estimate: f64,
    pub ends: [f64; 2],
}

/// The zone, the intervals below each other, and a dot for each person's difference above them.
pub(crate) fn equivalence_zone(
    language: Language,
    id: &str,
    caption: &str,
    kind: MeasureKind,
    smallest: f64,
    intervals: &[EquivalenceInterval],
    differences: &[f64],
) -> Figure {
    let ends = intervals.iter().flat_map(|interval| interval.ends);
    let all = || ends.clone().chain(differences.iter().copied());
    let low = all().fold(-1.2 * smallest, f64::min);
    let high = all().fold(1.2 * smallest, f64::max);
    let axis = Axis::new(low, high, LEFT, RIGHT - 6.0);
    let (top, height) = (26.0, 34.0);
    let dots = if differences.is_empty() { 0.0 } else { 62.0 };
    let bottom = top + dots + height * intervals.len() as f64;
    let mut svg = Svg::new(caption, bottom + 44.0);
    let title = differences_title(language, kind);
    svg.text((LEFT + RIGHT) / 2.0, bottom + 35.0, "small", Anchor::Middle, title);
    let (left, right) = (axis.place(-smallest), axis.place(smallest));
    svg.class_rect([left, top - 6.0, right - left, bottom - top + 6.0], "box");
    for &tick in &axis.ticks {
        let x = axis.place(tick);
        let class = if tick.abs() < 1e-12 { "zero" } else { "rule" };
        svg.line([x, top - 6.0], [x, bottom], class);
        let text = language.fixed(tick, axis.decimals);
        svg.text(x, bottom + 17.0, "small", Anchor::Middle, &text);
    }
    if !differences.is_empty() {
        difference_dots(&mut svg, &axis, top + 42.0, differences);
        let people = language.pick("people", "personnes");
        svg.text(LEFT - 12.0, top + 46.0, "", Anchor::End, people);
    }
    let columns = language.pick(
        ["", "estimate", "90 % low", "90 % high", "zone low", "zone high"],
        ["", "estimation", "90 % bas", "90 % haut", "zone bas", "zone haut"],
    );
    let mut data = DataTable::new(id, caption, columns);
    let mut spoken = Vec::new();
    for (place, interval) in intervals.iter().enumerate() {
        let y = top + dots + height * (place as f64 + 0.5);
        svg.text(LEFT - 12.0, y + 4.0, "small", Anchor::End, interval.label);
        let [low, high] = interval.ends.map(|end| axis.place(end));
        svg.line([low, y], [high, y], "whisker");
        svg.line([low, y - 5.0], [low, y + 5.0], "whisker");
        svg.line([high, y - 5.0], [high, y + 5.0], "whisker");
        svg.diamond(axis.place(interval.estimate), y, 6.0, "mark");
        let [low, high] = interval.ends;
        let numbers =
            [interval.estimate, low, high, -smallest, smallest].map(|value| language.number(value));
        spoken.push(format!("{} {} ({} – {})", interval.label, numbers[0], numbers[1], numbers[2]));
        let mut row = vec![interval.label.to_owned()];
        row.extend(numbers);
        data.row(row);
    }
    let least = language.number(smallest);
    let alt = language.pick(
        format!("The zone reaches from −{least} to {least}. Diamonds and bars are estimates with 90 % intervals: {}.", spoken.join("; ")),
        format!("La zone va de −{least} à {least}. Losanges et barres : estimations et intervalles à 90 % : {}.", spoken.join(" ; ")),
    );
    Figure { id: id.to_owned(), caption: caption.to_owned(), alt, svg: svg.finish(), data }
}
