//! The figure of a person's thresholds: the track, trial by trial, above the psychometric function.

use mimique_report::svg::{Anchor, Axis, Svg, WIDTH};
use mimique_stats::PsychometricFit;

use mimique_study::Varied;

use super::{ShownAnswer, counts, ends};

const LEFT: f64 = 52.0;
const RIGHT: f64 = WIDTH - 12.0;
const PANEL: f64 = 130.0;
const GAP: f64 = 44.0;
/// Points that a curve is drawn through.
const POINTS: usize = 80;

/// What the labels of the figure say.
pub(super) struct FigureWords {
    pub title: String,
    pub level: String,
    pub trial: &'static str,
    pub share: &'static str,
}

/// Draws the levels of a person in the order of the trials, right answers filled, and the share of right answers by
/// level with the fitted function.
pub(super) fn curve_and_track(
    words: &FigureWords,
    shown: &[ShownAnswer],
    fit: Option<&PsychometricFit>,
    vary: &Varied,
) -> String {
    let [from, to] = ends(vary);
    let mut svg = Svg::new(&words.title, 2.0 * (PANEL + GAP) + 24.0);
    let (top, bottom) = (GAP - 14.0, GAP - 14.0 + PANEL);
    let level = Axis::new(from, to, bottom, top);
    let trial = Axis::new(0.0, shown.len().max(1) as f64, LEFT, RIGHT);
    rules(&mut svg, &level);
    svg.text(LEFT, top - 10.0, "strong", Anchor::Start, &words.level);
    let mut tracks: Vec<usize> = shown.iter().map(|answer| answer.track).collect();
    tracks.sort_unstable();
    tracks.dedup();
    for track in tracks {
        let own = shown.iter().enumerate().filter(|(_, answer)| answer.track == track);
        let points: Vec<[f64; 2]> = own
            .map(|(place, answer)| [trial.place(place as f64 + 1.0), level.place(answer.level)])
            .collect();
        svg.path(&points, "course");
    }
    for (place, answer) in shown.iter().enumerate() {
        let class = if answer.right { "mark" } else { "empty" };
        svg.circle(trial.place(place as f64 + 1.0), level.place(answer.level), 3.0, class);
    }
    foot(&mut svg, &trial, bottom, words.trial);

    let (top, bottom) = (bottom + GAP, bottom + GAP + PANEL);
    let share = Axis::new(0.0, 1.0, bottom, top);
    let across = Axis::new(from, to, LEFT, RIGHT);
    rules(&mut svg, &share);
    svg.text(LEFT, top - 10.0, "strong", Anchor::Start, words.share);
    if let Some(fit) = fit {
        let function = fit.psychometric();
        let at = |point: usize| from + (to - from) * point as f64 / POINTS as f64;
        let points: Vec<[f64; 2]> = (0..=POINTS)
            .map(|point| {
                [across.place(at(point)), share.place(function.right(vary.ease(at(point))))]
            })
            .collect();
        svg.path(&points, "course");
    }
    for own in counts(shown, vary) {
        let radius = 1.5 + (own.n as f64).sqrt();
        let right = own.correct as f64 / own.n as f64;
        svg.circle(across.place(vary.ease(own.level)), share.place(right), radius.min(8.0), "dot");
    }
    foot(&mut svg, &across, bottom, &words.level);
    svg.finish()
}

fn rules(svg: &mut Svg, axis: &Axis) {
    for value in &axis.ticks {
        let y = axis.place(*value);
        svg.line([LEFT, y], [RIGHT, y], "rule");
        let text = format!("{value:.*}", axis.decimals);
        svg.text(LEFT - 8.0, y + 4.0, "small", Anchor::End, &text);
    }
}

fn foot(svg: &mut Svg, axis: &Axis, bottom: f64, label: &str) {
    for value in &axis.ticks {
        let text = format!("{value:.*}", axis.decimals);
        svg.text(axis.place(*value), bottom + 14.0, "small", Anchor::Middle, &text);
    }
    svg.text(RIGHT, bottom + 27.0, "small", Anchor::End, label);
}
