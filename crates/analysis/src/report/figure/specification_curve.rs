//! A specification curve: what every specification of a hypothesis finds, sorted, above the choices that it makes.

use mimique_locale::Language;
use mimique_report::document::{DataTable, Figure};
use mimique_report::figure::{LEFT, RIGHT};
use mimique_report::svg::{Anchor, Axis, Svg, clipped};

/// What one specification finds, and its choices.
pub(crate) struct CurvePoint {
    /// In the unit of the axis.
    pub estimate: Option<f64>,
    pub interval: Option<[f64; 2]>,
    pub p: f64,
    /// Whether something was shown: the mark is filled.
    pub shown: bool,
    /// Whether it is the specification of the study file: its mark is a diamond.
    pub of_the_study_file: bool,
    /// Whether the choice of each row of [`Choices`] is made.
    pub made: Vec<bool>,
}

/// Choices of one kind: a heading, and a row per choice.
pub(crate) struct Choices {
    pub heading: &'static str,
    pub rows: Vec<String>,
}

/// What a curve is of, in words.
pub(crate) struct CurveWords {
    pub id: String,
    pub caption: String,
    pub alt: String,
    /// Title of the axis of estimates, with their unit.
    pub estimates: String,
    /// The value of no effect.
    pub no_effect: f64,
}

const TOP: f64 = 30.0;
const ESTIMATES: f64 = 120.0;
const P_VALUES: f64 = 78.0;
const ROW: f64 = 17.0;
/// Smaller p values are drawn at this one.
const LEAST_P: f64 = 1e-4;
/// The level of a test.
const LEVEL: f64 = 0.05;

/// The curve. `points` are in the order in which they are drawn. Without any estimate p alone is drawn.
pub(crate) fn specification_curve(
    language: Language,
    words: CurveWords,
    points: &[CurvePoint],
    choices: &[Choices],
    data: DataTable,
) -> Figure {
    let has_estimates = points.iter().any(|point| point.estimate.is_some());
    let top_of_p = TOP + if has_estimates { ESTIMATES + 36.0 } else { 0.0 };
    let top_of_choices = top_of_p + P_VALUES + 14.0;
    let rows: usize = choices.iter().map(|own| 1 + own.rows.len()).sum();
    let mut svg = Svg::new(&words.caption, top_of_choices + ROW * rows as f64 + 12.0);
    let step = (RIGHT - LEFT - 10.0) / points.len().max(1) as f64;
    let columns: Vec<f64> =
        (0..points.len()).map(|place| LEFT + 5.0 + step * (place as f64 + 0.5)).collect();
    if has_estimates {
        estimates(&mut svg, language, &words, points, &columns);
    }
    p_values(&mut svg, language, top_of_p, points, &columns);
    let mut y = top_of_choices;
    let mut row = 0;
    for own in choices {
        y += ROW;
        svg.text(LEFT - 12.0, y, "small strong", Anchor::End, own.heading);
        for label in &own.rows {
            y += ROW;
            svg.text(LEFT - 12.0, y, "small", Anchor::End, &clipped(label, 19));
            svg.line([LEFT, y - 4.0], [RIGHT, y - 4.0], "rule");
            for (point, x) in points.iter().zip(&columns) {
                if point.made.get(row) == Some(&true) {
                    svg.circle(*x, y - 4.0, (0.4 * step).clamp(1.2, 3.2), "mark");
                }
            }
            row += 1;
        }
    }
    let CurveWords { id, caption, alt, .. } = words;
    Figure { id, caption, alt, svg: svg.finish(), data }
}

/// Estimates with their intervals, on an axis of their own.
fn estimates(
    svg: &mut Svg,
    language: Language,
    words: &CurveWords,
    points: &[CurvePoint],
    columns: &[f64],
) {
    let values = || {
        let ends = points.iter().flat_map(|point| point.interval.into_iter().flatten());
        ends.chain(points.iter().filter_map(|point| point.estimate)).filter(|it| it.is_finite())
    };
    let low = values().fold(words.no_effect, f64::min);
    let high = values().fold(words.no_effect, f64::max);
    let axis = Axis::new(low, high, TOP + ESTIMATES, TOP);
    svg.text(LEFT, TOP - 14.0, "small", Anchor::Start, &words.estimates);
    for &tick in &axis.ticks {
        let y = axis.place(tick);
        let is_no_effect = (tick - words.no_effect).abs() < 1e-9;
        svg.line([LEFT, y], [RIGHT, y], if is_no_effect { "zero" } else { "rule" });
        let text = language.fixed(tick, axis.decimals);
        svg.text(LEFT - 12.0, y + 4.0, "small", Anchor::End, &text);
    }
    for (point, &x) in points.iter().zip(columns) {
        if let Some([low, high]) = point.interval {
            svg.line([x, axis.place(low)], [x, axis.place(high)], "thin");
        }
        if let Some(estimate) = point.estimate {
            mark(svg, x, axis.place(estimate), point);
        }
    }
}

/// p on a logarithmic axis, with a line at the level of the tests.
fn p_values(svg: &mut Svg, language: Language, top: f64, points: &[CurvePoint], columns: &[f64]) {
    let y = |p: f64| top + P_VALUES * (p.clamp(LEAST_P, 1.0).log10() / LEAST_P.log10());
    let title = language.pick(
        "p, corrected over the hypotheses; dashed: 0.05",
        "p, corrigé sur les hypothèses ; tirets : 0,05",
    );
    svg.text(LEFT, top - 10.0, "small", Anchor::Start, title);
    for decimals in 0..=4_usize {
        let p = 0.1_f64.powi(decimals as i32);
        svg.line([LEFT, y(p)], [RIGHT, y(p)], "rule");
        let at_most = if decimals == 4 { "≤ " } else { "" };
        let text = format!("{at_most}{}", language.fixed(p, decimals));
        svg.text(LEFT - 12.0, y(p) + 4.0, "small", Anchor::End, &text);
    }
    svg.line([LEFT, y(LEVEL)], [RIGHT, y(LEVEL)], "zero");
    for (point, x) in points.iter().zip(columns) {
        mark(svg, *x, y(point.p), point);
    }
}

fn mark(svg: &mut Svg, x: f64, y: f64, point: &CurvePoint) {
    let class = if point.shown { "mark" } else { "box" };
    match point.of_the_study_file {
        true => svg.diamond(x, y, 6.0, class),
        false => svg.circle(x, y, 3.2, class),
    }
}
