//! Courses over time: panels below each other, with one axis of time.

use crate::svg::{Anchor, Axis, Svg, WIDTH};

/// Left edge of the plotting area beside the numbers of an axis.
pub const LEFT: f64 = 52.0;
/// Its right edge.
pub const RIGHT: f64 = WIDTH - 12.0;
/// Colours that the colour-blind tell apart, and that stand on white and on black (Okabe and Ito), each
/// with its dashes.
pub const LINES: [(&str, &str); 4] =
    [("#0072b2", "none"), ("#d55e00", "7 3"), ("#009e73", "2 3"), ("#cc79a7", "8 3 2 3")];
const PANEL: f64 = 110.0;
const GAP: f64 = 34.0;
/// Width of a line's name with its key.
const KEY: f64 = 79.0;
/// More points than a figure can show are left out.
const MOST_POINTS: usize = 600;

/// A panel of [`time_courses`].
#[derive(Debug, Clone, PartialEq)]
pub struct CoursePanel {
    /// What it shows, with the unit.
    pub label: String,
    /// Lines, at most four: the name of each (empty where there is one alone) and a value a second.
    pub lines: Vec<(String, Vec<f64>)>,
}

/// An SVG that stands alone: values of whole seconds over minutes, and on request a stretch of time marked.
pub fn time_courses(title: &str, panels: &[CoursePanel], marked: Option<[f64; 2]>) -> String {
    let seconds = panels.iter().flat_map(|panel| &panel.lines).map(|(_, line)| line.len()).max();
    let last = seconds.unwrap_or(1).saturating_sub(1).max(1) as f64;
    let time = Axis::new(0.0, last / 60.0, LEFT, RIGHT);
    let x = |second: f64| time.place(second / 60.0);
    let bottom_of = |panel: usize| GAP + (PANEL + GAP) * panel as f64 + PANEL;
    let bottom = bottom_of(panels.len().saturating_sub(1));
    let mut svg = Svg::new(title, bottom + 40.0);
    if let Some([from, to]) = marked {
        svg.class_rect([x(from), GAP, (x(to) - x(from)).max(1.0), bottom - GAP], "empty");
    }
    for (place, panel) in panels.iter().enumerate() {
        draw(&mut svg, panel, bottom_of(place), &x);
    }
    for value in &time.ticks {
        let text = format!("{value:.*}", time.decimals);
        svg.text(time.place(*value), bottom + 16.0, "small", Anchor::Middle, &text);
    }
    svg.text(RIGHT, bottom + 32.0, "small", Anchor::End, "min");
    svg.finish()
}

fn draw(svg: &mut Svg, panel: &CoursePanel, bottom: f64, x: &impl Fn(f64) -> f64) {
    let all = || panel.lines.iter().flat_map(|(_, line)| line.iter().copied());
    let (low, high) = (all().fold(0.0, f64::min), all().fold(f64::NEG_INFINITY, f64::max));
    let top = bottom - PANEL;
    let axis = Axis::new(low, high.max(low + 1e-9), bottom, top);
    for value in &axis.ticks {
        let y = axis.place(*value);
        svg.line([LEFT, y], [RIGHT, y], "rule");
        let text = format!("{value:.*}", axis.decimals);
        svg.text(LEFT - 8.0, y + 4.0, "small", Anchor::End, &text);
    }
    svg.text(LEFT, top - 8.0, "strong", Anchor::Start, &panel.label);
    for (k, (name, line)) in panel.lines.iter().enumerate().take(LINES.len()) {
        let step = line.len().div_ceil(MOST_POINTS).max(1);
        let mut points: Vec<[f64; 2]> =
            (0..line.len()).step_by(step).map(|i| [x(i as f64), axis.place(line[i])]).collect();
        if let (Some(last), true) = (line.last(), step > 1) {
            points.push([x((line.len() - 1) as f64), axis.place(*last)]);
        }
        svg.coloured_path(&points, LINES[k]);
        if !name.is_empty() {
            // The names stand in the head of the panel, from the right.
            let place = RIGHT - KEY * (panel.lines.len() - 1 - k) as f64;
            svg.coloured_path(&[[place - 70.0, top - 12.0], [place - 55.0, top - 12.0]], LINES[k]);
            svg.text(place - 51.0, top - 8.0, "small", Anchor::Start, name);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_line_and_name_is_drawn_and_long_ones_are_thinned() {
        let panels = [
            CoursePanel {
                label: "a <b>".to_owned(),
                lines: vec![(String::new(), vec![0.0; 5000])],
            },
            CoursePanel {
                label: "two".to_owned(),
                lines: vec![
                    ("up".to_owned(), vec![1.0, 2.0]),
                    ("down".to_owned(), vec![2.0, -1.0]),
                ],
            },
        ];
        let svg = time_courses("title", &panels, Some([10.0, 20.0]));
        assert!(svg.starts_with("<svg ") && svg.contains("a &lt;b&gt;"));
        assert!(svg.contains(">up</text>") && svg.contains(">down</text>"));
        // Three lines and two keys.
        assert_eq!(svg.matches("stroke-dasharray=").count(), 5);
        assert!(svg.len() < 30_000, "{}", svg.len());
        assert!(!svg.contains("NaN") && !svg.contains("inf"));
        time_courses("nothing", &[], None);
    }
}
