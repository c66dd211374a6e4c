//! Figures of reverse correlation: an image of units by times, and the face that people have in mind.

use mimique_report::figure::LINES;
use mimique_report::svg::{Anchor, Axis, Svg, WIDTH, diverging};
use mimique_stats::{GroupImage, UnitCourse};

use super::played::{DrawnHead, PlayedWords};

const LEFT: f64 = 70.0;
const RIGHT: f64 = WIDTH - 12.0;
/// Height of a unit's row.
const ROW: f64 = 18.0;

/// What the labels of an image say.
pub(super) struct ImageWords {
    pub title: String,
    pub seconds: &'static str,
    /// Beside the darkest colours: less, more.
    pub ends: [&'static str; 2],
}

/// z of every unit (rows) in every time bin (columns); runs of cells whose corrected p is 0.05 or less are framed.
pub(super) fn image(words: &ImageWords, group: &GroupImage, times_s: &[f64]) -> String {
    let rows = group.units.len() as f64;
    let (top, bottom) = (30.0, 30.0 + ROW * rows);
    let mut svg = Svg::new(&words.title, bottom + 64.0);
    let z = || group.units.iter().flat_map(|unit| unit.z.iter().copied());
    let most = z().fold(group.critical_z, |most, z| most.max(z.abs()));
    let width = (RIGHT - LEFT) / times_s.len().max(1) as f64;
    for (row, unit) in group.units.iter().enumerate() {
        let y = top + ROW * row as f64;
        svg.text(LEFT - 8.0, y + ROW - 5.0, "small", Anchor::End, &unit.unit);
        for (bin, z) in unit.z.iter().enumerate() {
            let x = LEFT + width * bin as f64;
            svg.rect([x, y + 0.5, width + 0.3, ROW - 1.0], &diverging(z / most));
        }
        for [from, to] in runs(&unit.z, group.critical_z) {
            let x = LEFT + width * from as f64;
            svg.class_rect([x, y + 0.5, width * (to - from) as f64, ROW - 1.0], "outline");
        }
    }
    let lasts = times_s.first().map_or(1.0, |first| 2.0 * first) * times_s.len() as f64;
    foot(&mut svg, lasts, bottom, words.seconds);
    legend(&mut svg, words, most, bottom + 44.0);
    svg.finish()
}

/// Runs of bins above the critical |z| with the same sign: from, and the one behind.
fn runs(z: &[f64], critical: f64) -> Vec<[usize; 2]> {
    let side = |z: f64| if z.abs() > critical { z.signum() } else { 0.0 };
    let mut found: Vec<[usize; 2]> = Vec::new();
    for (bin, &value) in z.iter().enumerate() {
        let goes_on =
            found.last().is_some_and(|[_, to]| *to == bin && side(z[bin - 1]) == side(value));
        match found.last_mut() {
            _ if side(value) == 0.0 => {}
            Some(run) if goes_on => run[1] = bin + 1,
            _ => found.push([bin, bin + 1]),
        }
    }
    found
}

/// The axis of time, from the first frame on.
fn foot(svg: &mut Svg, lasts: f64, bottom: f64, seconds: &str) {
    let tick = Axis::new(0.0, lasts, LEFT, RIGHT);
    for value in tick.ticks.iter().filter(|value| **value <= lasts + 1e-9) {
        let text = format!("{value:.*}", tick.decimals);
        let x = LEFT + (RIGHT - LEFT) * value / lasts;
        svg.text(x, bottom + 14.0, "small", Anchor::Middle, &text);
    }
    svg.text(RIGHT, bottom + 28.0, "small", Anchor::End, seconds);
}

/// The colours with the z that they stand for.
fn legend(svg: &mut Svg, words: &ImageWords, most: f64, y: f64) {
    const STEPS: usize = 21;
    let width = 140.0 / STEPS as f64;
    let left = LEFT + 70.0;
    for step in 0..STEPS {
        let share = 2.0 * step as f64 / (STEPS - 1) as f64 - 1.0;
        svg.rect([left + width * step as f64, y, width + 0.3, 10.0], &diverging(share));
    }
    let [less, more] = words.ends;
    svg.text(left - 6.0, y + 9.0, "small", Anchor::End, &format!("{less}, z = −{most:.1}"));
    svg.text(left + 146.0, y + 9.0, "small", Anchor::Start, &format!("{more}, z = {most:.1}"));
}

/// The face that moves, and below it the mean course of each of its units, one line a unit.
pub(super) fn face(
    title: &str,
    (courses, lasts_s): (&[UnitCourse], f64),
    (head, id, played): (&DrawnHead, &str, &PlayedWords<'_>),
    [activation, seconds]: [&str; 2],
) -> String {
    let keys = courses.len().div_ceil(5) as f64;
    let above = DrawnHead::HEIGHT;
    let (top, bottom) = (above + 40.0 + 18.0 * keys, above + 196.0 + 18.0 * keys);
    let mut svg = Svg::new(title, bottom + 40.0);
    head.draw(&mut svg, (id, played), (courses, lasts_s), 4.0);
    svg.text(LEFT, top - 12.0, "strong", Anchor::Start, activation);
    let height = Axis::new(0.0, 1.0, bottom, top);
    for value in &height.ticks {
        let y = height.place(*value);
        svg.line([LEFT, y], [RIGHT, y], "rule");
        svg.text(LEFT - 8.0, y + 4.0, "small", Anchor::End, &format!("{value:.1}"));
    }
    for (place, course) in courses.iter().enumerate() {
        let line = LINES[place % LINES.len()];
        let bins = course.activation.len().max(1) as f64;
        let x = |bin: usize| LEFT + (RIGHT - LEFT) * (bin as f64 + 0.5) / bins;
        let points: Vec<[f64; 2]> = course
            .activation
            .iter()
            .enumerate()
            .map(|(bin, value)| [x(bin), height.place(*value)])
            .collect();
        svg.coloured_path(&points, line);
        let key = [LEFT + 72.0 * (place % 5) as f64, above + 16.0 + 18.0 * (place / 5) as f64];
        svg.coloured_path(&[[key[0], key[1] - 4.0], [key[0] + 16.0, key[1] - 4.0]], line);
        svg.text(key[0] + 21.0, key[1], "small", Anchor::Start, &course.unit);
    }
    foot(&mut svg, lasts_s, bottom, seconds);
    svg.finish()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_are_of_one_sign_above_the_critical_value() {
        assert_eq!(runs(&[0.0, 3.0, 4.0, -4.0, 1.0, 3.1], 2.0), [[1, 3], [3, 4], [5, 6]]);
        assert!(runs(&[0.0, 1.9, -2.0], 2.0).is_empty());
        assert_eq!(runs(&[5.0, 5.0], 2.0), [[0, 2]]);
    }
}
