//! How far probabilities hold: share of right answers against probability.

use mimique_annotate::calibration::{Reliability, ReliabilityBin};
use mimique_locale::Language;
use mimique_report::document::{DataTable, Figure, slug};
use mimique_report::svg::{Anchor, Axis, Svg};

use super::scores::value;
use super::words;
use crate::annotate::evaluate::Column;

const LEFT: f64 = 92.0;

/// Share of right answers against probability, without and with the temperature.
pub fn reliability(language: Language, column: &Column) -> Figure {
    let name = words::column(language, column.kind);
    let caption = language.pick(
        format!(
            "{name}: share of frames labelled rightly against the probability of their label; on the dashed line both \
             agree, and larger dots are more frames"
        ),
        format!(
            "{name} : part d’images justes selon la probabilité de leur étiquette ; sur la ligne en tirets les deux \
             concordent, et les points plus grands sont plus d’images"
        ),
    );
    let (top, bottom) = (16.0, 246.0);
    let right = LEFT + (bottom - top);
    let mut svg = Svg::new(&caption, bottom + 84.0);
    let axes = [Axis::new(0.0, 1.0, LEFT, right), Axis::new(0.0, 1.0, bottom, top)];
    rules(&mut svg, language, &axes, [top, bottom, right]);
    let kinds = words::temperature(language);
    let headings = language.pick(
        ["", "frames", "mean probability", "share right"],
        ["", "images", "probabilité moyenne", "part juste"],
    );
    let id = format!("reliability-{}", slug(name));
    let mut data = DataTable::new(&id, caption.clone(), headings);
    for (place, (own, kind)) in column.summary.reliability.iter().zip(kinds).enumerate() {
        let style = STYLES[place];
        curve(&mut svg, own, &axes, style);
        let y = bottom + 54.0 + 19.0 * place as f64;
        svg.line([LEFT, y], [LEFT + 26.0, y], style.0);
        svg.circle(LEFT + 13.0, y, 4.0, style.1);
        svg.text(LEFT + 34.0, y + 4.0, "small", Anchor::Start, kind);
        for bin in filled(own) {
            let shares = shares(bin).map(|share| language.fixed(share, 3));
            data.row([kind.to_owned(), bin.n.to_string()].into_iter().chain(shares));
        }
    }
    let [raw, tempered] =
        column.summary.reliability.each_ref().map(|own| value(language, own.expected_error()));
    let alt = language.pick(
        format!("Two curves about the diagonal. Calibration error {raw} without temperature, {tempered} with it."),
        format!("Deux courbes autour de la diagonale. Erreur de calibration {raw} sans température, {tempered} avec."),
    );
    Figure { id, caption, alt, svg: svg.finish(), data }
}

/// Styles of line and dots: without, then with the temperature.
const STYLES: [(&str, &str); 2] = [("person", "soft"), ("course", "mark")];

/// Both axes, and the line on which probability and share agree.
fn rules(svg: &mut Svg, language: Language, [x, y]: &[Axis; 2], [top, bottom, right]: [f64; 3]) {
    for &tick in &x.ticks {
        let text = language.fixed(tick, 1);
        svg.line([x.place(tick), top], [x.place(tick), bottom], "rule");
        svg.line([LEFT, y.place(tick)], [right, y.place(tick)], "rule");
        svg.text(x.place(tick), bottom + 16.0, "small", Anchor::Middle, &text);
        svg.text(LEFT - 8.0, y.place(tick) + 4.0, "small", Anchor::End, &text);
    }
    svg.line([x.place(0.0), y.place(0.0)], [x.place(1.0), y.place(1.0)], "zero");
    let words = language.pick("probability", "probabilité");
    svg.text((LEFT + right) / 2.0, bottom + 33.0, "small", Anchor::Middle, words);
    let words = language.pick("right", "justes");
    svg.text(LEFT - 34.0, (top + bottom) / 2.0 + 4.0, "small", Anchor::End, words);
}

/// The bins that hold frames.
fn filled(own: &Reliability) -> impl Iterator<Item = &ReliabilityBin> {
    own.bins().iter().filter(|bin| bin.n > 0)
}

/// Mean probability and share right of a bin.
fn shares(bin: &ReliabilityBin) -> [f64; 2] {
    let n = bin.n as f64;
    [bin.probability / n, bin.right as f64 / n]
}

fn curve(svg: &mut Svg, own: &Reliability, [x, y]: &[Axis; 2], (line, dot): (&str, &str)) {
    let point = |bin: &ReliabilityBin| {
        let [probability, right] = shares(bin);
        [x.place(probability), y.place(right)]
    };
    let points: Vec<[f64; 2]> = filled(own).map(point).collect();
    if points.len() > 1 {
        svg.path(&points, line);
    }
    for ([px, py], bin) in points.into_iter().zip(filled(own)) {
        svg.circle(px, py, 2.0 + 5.0 * (bin.n as f64 / own.n() as f64).sqrt(), dot);
    }
}
