//! The figures of a report on layouts.

use mimique_report::svg::{Anchor, Axis, Svg, WIDTH};

const LEFT: f64 = 52.0;
const RIGHT: f64 = WIDTH - 14.0;
const PLOT: f64 = 250.0;
const LINE: f64 = 18.0;

/// How a series is drawn, so that it is told apart in grey.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Look {
    /// A strong line with filled marks.
    Main,
    /// A broken line with open marks.
    Second,
    /// A thin line with small marks.
    Third,
    /// Marks with numbers and no line.
    Numbered,
}

/// Points with a name.
pub(super) struct Series {
    pub(super) name: String,
    pub(super) look: Look,
    /// Markers, and error in millimetres, in ascending order of markers.
    pub(super) points: Vec<[f64; 2]>,
}

/// Errors over numbers of markers.
pub(super) fn curves(title: &str, series: &[Series]) -> String {
    let named = series.iter().filter(|s| !s.points.is_empty());
    let rows = named.clone().count() as f64;
    let head = 14.0 + LINE * rows;
    let mut svg = Svg::new(title, head + PLOT + 46.0);
    let all = || series.iter().flat_map(|s| &s.points);
    let most = |axis: usize| all().map(|p| p[axis]).fold(0.0, f64::max);
    let across = Axis::new(0.0, most(0).max(1.0), LEFT, RIGHT);
    let (top, bottom) = (head + 24.0, head + PLOT);
    let up = Axis::new(0.0, most(1).max(1e-3), bottom, top);
    for &tick in &up.ticks {
        let y = up.place(tick);
        svg.line([LEFT, y], [RIGHT, y], "rule");
        svg.text(LEFT - 6.0, y + 4.0, "small", Anchor::End, &format!("{tick:.*}", up.decimals));
    }
    for &tick in &across.ticks {
        let x = across.place(tick);
        svg.line([x, bottom], [x, bottom + 4.0], "rule");
        svg.text(x, bottom + 17.0, "small", Anchor::Middle, &format!("{tick:.0}"));
    }
    svg.text((LEFT + RIGHT) / 2.0, bottom + 33.0, "small", Anchor::Middle, "markers");
    svg.text(4.0, head + 8.0, "small", Anchor::Start, "mm a vertex");
    let mut number = 0;
    for (row, s) in named.enumerate() {
        let y = 12.0 + LINE * row as f64;
        let places: Vec<[f64; 2]> =
            s.points.iter().map(|p| [across.place(p[0]), up.place(p[1])]).collect();
        let label = match s.look {
            Look::Numbered => {
                number += 1;
                number.to_string()
            }
            _ => String::new(),
        };
        draw(&mut svg, s.look, &places, &label);
        match s.look {
            Look::Numbered => draw(&mut svg, s.look, &[[25.0, y]], &label),
            _ => draw(&mut svg, s.look, &[[14.0, y], [36.0, y]], &label),
        }
        svg.text(48.0, y + 4.0, "small", Anchor::Start, &s.name);
    }
    svg.finish()
}

fn draw(svg: &mut Svg, look: Look, places: &[[f64; 2]], label: &str) {
    let line = match look {
        Look::Main => Some("whisker"),
        Look::Second => Some("zero"),
        Look::Third => Some("thin"),
        Look::Numbered => None,
    };
    if let Some(class) = line {
        places.windows(2).for_each(|pair| svg.line(pair[0], pair[1], class));
    }
    for &[x, y] in places {
        match look {
            Look::Main => svg.circle(x, y, 4.0, "mark"),
            Look::Second => svg.circle(x, y, 4.0, "box"),
            Look::Third => svg.circle(x, y, 2.0, "mark"),
            Look::Numbered => {
                svg.circle(x, y, 8.0, "box");
                svg.text(x, y + 4.0, "small", Anchor::Middle, label);
            }
        }
    }
}

/// What is lost with each marker, as bars, the largest first.
pub(super) fn bars(title: &str, values: &[(String, f64)]) -> String {
    const ROW: f64 = 15.0;
    const LABELS: f64 = 108.0;
    let mut svg = Svg::new(title, 40.0 + ROW * values.len() as f64);
    let most = values.iter().map(|(_, value)| *value).fold(1e-6, f64::max);
    let axis = Axis::new(0.0, most, LABELS, RIGHT);
    let bottom = 14.0 + ROW * values.len() as f64;
    for &tick in &axis.ticks {
        let x = axis.place(tick);
        svg.line([x, 8.0], [x, bottom], "rule");
        svg.text(x, bottom + 16.0, "small", Anchor::Middle, &format!("{tick:.*}", axis.decimals));
    }
    for (row, (label, value)) in values.iter().enumerate() {
        let y = 10.0 + ROW * row as f64;
        let x = axis.place(value.max(0.0));
        svg.class_rect([LABELS, y + 2.0, x - LABELS, ROW - 5.0], "mark");
        svg.text(LABELS - 6.0, y + 11.0, "small", Anchor::End, label);
    }
    svg.finish()
}
