//! Stacked bars of shares, from the lowest answer to the highest, and their key.

use mimique_locale::Language;
use mimique_report::figure::LEFT;
use mimique_report::svg::{Anchor, Svg, shade};

/// Narrower parts have no name.
const LEAST_WIDTH: f64 = 20.0;

/// A bar (left, top, width, height) of shares that add up to 1, with the names of the wide ones.
pub(super) fn stacked_bar(
    svg: &mut Svg,
    [left, top, width, height]: [f64; 4],
    shares: &[f64],
    names: &[String],
) {
    let mut x = left;
    for (i, (share, name)) in shares.iter().zip(names).enumerate() {
        let (own, tone) = (share * width, tone(i, shares.len()));
        svg.rect([x, top, own, height], &shade(tone));
        if own > LEAST_WIDTH {
            svg.text_on(x + own / 2.0, top + height / 2.0 + 4.5, tone, name);
        }
        x += own;
    }
}

/// The answers in their shades, above the bars.
pub(super) fn answer_key(svg: &mut Svg, language: Language, names: &[String], right: f64) {
    let step = (right - LEFT) / names.len() as f64;
    for (i, name) in names.iter().enumerate() {
        let (x, tone) = (LEFT + step * i as f64, tone(i, names.len()));
        svg.rect([x, 10.0, step - 2.0, 18.0], &shade(tone));
        // Of many answers the ends are named.
        if step > LEAST_WIDTH || i == 0 || i + 1 == names.len() {
            svg.text_on(x + step / 2.0 - 1.0, 23.5, tone, name);
        }
    }
    svg.text(LEFT - 10.0, 23.0, "soft", Anchor::End, language.pick("answer", "réponse"));
}

/// Shade of an answer.
fn tone(i: usize, answers: usize) -> f64 {
    if answers > 1 { i as f64 / (answers - 1) as f64 } else { 0.5 }
}
