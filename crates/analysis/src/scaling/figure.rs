//! The figure of a scale: the perceived value by level, with its band.

use mimique_report::svg::{Anchor, Axis, Svg, WIDTH};
use mimique_stats::DifferenceScale;

const LEFT: f64 = 52.0;
const RIGHT: f64 = WIDTH - 12.0;
const TOP: f64 = 34.0;
const BOTTOM: f64 = 244.0;

/// Draws the scale over the levels, with its 95 % intervals as a band.
pub(super) fn scale(
    title: &str,
    of_scale: &str,
    of_level: &str,
    found: &DifferenceScale,
) -> String {
    let mut svg = Svg::new(title, BOTTOM + 40.0);
    let ends = || found.interval.iter().flatten().flatten();
    let all = || found.scale.iter().chain(ends()).copied();
    let (low, high) = (all().fold(0.0, f64::min), all().fold(f64::NEG_INFINITY, f64::max));
    let y = Axis::new(low, high.max(low + 1e-9), BOTTOM, TOP);
    let [first, last] =
        [found.levels.first(), found.levels.last()].map(|end| end.copied().unwrap_or(0.0));
    let x = Axis::new(first, last, LEFT, RIGHT);
    for value in &y.ticks {
        let place = y.place(*value);
        svg.line([LEFT, place], [RIGHT, place], "rule");
        let text = format!("{value:.*}", y.decimals);
        svg.text(LEFT - 8.0, place + 4.0, "small", Anchor::End, &text);
    }
    for value in &x.ticks {
        let text = format!("{value:.*}", x.decimals);
        svg.text(x.place(*value), BOTTOM + 16.0, "small", Anchor::Middle, &text);
    }
    svg.text(LEFT, TOP - 12.0, "strong", Anchor::Start, of_scale);
    svg.text(RIGHT, BOTTOM + 32.0, "small", Anchor::End, of_level);
    let levels = || found.levels.iter().map(|level| x.place(*level));
    if let Some(band) = &found.interval {
        let lower = levels().zip(band).map(|(x, ends)| [x, y.place(ends[0])]);
        let upper = levels().zip(band).rev().map(|(x, ends)| [x, y.place(ends[1])]);
        let outline: Vec<[f64; 2]> = lower.chain(upper).collect();
        svg.band(&outline, "#0072b2");
    }
    let points: Vec<[f64; 2]> =
        levels().zip(&found.scale).map(|(x, psi)| [x, y.place(*psi)]).collect();
    svg.path(&points, "course");
    for [x, y] in points {
        svg.circle(x, y, 3.5, "mark");
    }
    svg.finish()
}
