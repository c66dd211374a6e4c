//! Power against the number of people, as a figure: a panel a hypothesis and number of clips.

use mimique_locale::Language;
use mimique_report::svg::{Anchor, Axis, Svg};

use super::{Columns, HypothesisPower, Power, PowerPoint, Rate};

const PANEL: f64 = 190.0;
const HEAD: f64 = 58.0;
const LEFT: f64 = 52.0;
const RIGHT: f64 = 424.0;
/// The power that studies are commonly planned for.
const WANTED: f64 = 0.8;

/// The figure as SVG: stands alone, readable in grey.
pub fn power_curve(power: &Power, language: Language) -> String {
    let mut panels: Vec<(usize, usize)> = Vec::new();
    let hypotheses = power.points.first().map_or(0, |point| point.hypotheses.len());
    for place in 0..hypotheses {
        for point in &power.points {
            if !panels.contains(&(place, point.clips)) {
                panels.push((place, point.clips));
            }
        }
    }
    let title = language.pick(
        "Power against the number of people, and false positives where there is no effect",
        "Puissance selon le nombre de personnes, et faux positifs en l’absence d’effet",
    );
    let mut svg = Svg::new(title, HEAD + PANEL * panels.len() as f64 + 8.0);
    legend(&mut svg, language);
    for (row, (place, clips)) in panels.into_iter().enumerate() {
        let points: Vec<(&PowerPoint, &HypothesisPower)> = power
            .points
            .iter()
            .filter(|point| point.clips == clips)
            .filter_map(|point| Some((point, point.hypotheses.get(place)?)))
            .collect();
        panel(&mut svg, language, power, HEAD + PANEL * row as f64, clips, &points);
    }
    svg.finish()
}

fn legend(svg: &mut Svg, language: Language) {
    let (first, second) = (16.0, 36.0);
    svg.line([8.0, first], [30.0, first], "whisker");
    svg.circle(19.0, first, 4.0, "mark");
    let words = language.pick("power, corrected (Holm)", "puissance, corrigée (Holm)");
    svg.text(36.0, first + 4.0, "small", Anchor::Start, words);
    svg.line([8.0, second], [30.0, second], "zero");
    svg.circle(19.0, second, 4.0, "box");
    let words = language.pick("power, as in the thesis", "puissance, comme dans la thèse");
    svg.text(36.0, second + 4.0, "small", Anchor::Start, words);
    svg.diamond(239.0, first, 5.0, "mark");
    let words = language.pick("false positives, uncorrected", "faux positifs, non corrigés");
    svg.text(252.0, first + 4.0, "small", Anchor::Start, words);
    svg.diamond(239.0, second, 5.0, "box");
    let words = language.pick("the same, as in the thesis", "faux positifs, comme la thèse");
    svg.text(252.0, second + 4.0, "small", Anchor::Start, words);
}

fn panel(
    svg: &mut Svg,
    language: Language,
    power: &Power,
    top: f64,
    clips: usize,
    points: &[(&PowerPoint, &HypothesisPower)],
) {
    let Some((_, first)) = points.first() else { return };
    let (above, below) = (top + 26.0, top + PANEL - 42.0);
    let y = |share: f64| below - share * (below - above);
    let most = points.iter().map(|(point, _)| point.participants).max().unwrap_or(1);
    let axis = Axis::new(0.0, most as f64, LEFT, RIGHT);
    let heading = language
        .pick(format!("{}, {clips} clips", first.id), format!("{}, {clips} extraits", first.id));
    svg.text(LEFT, top + 14.0, "strong", Anchor::Start, &heading);
    if !first.effect {
        let words = language.pick("no effect in the parameters", "aucun effet dans les paramètres");
        svg.text(RIGHT, top + 14.0, "small", Anchor::End, words);
    }
    for share in [0.0, 0.2, 0.4, 0.6, 0.8, 1.0] {
        svg.line([LEFT, y(share)], [RIGHT, y(share)], "rule");
        let label = language.percent(share);
        svg.text(LEFT - 6.0, y(share) + 4.0, "small", Anchor::End, &label);
    }
    svg.line([LEFT, y(WANTED)], [RIGHT, y(WANTED)], "zero");
    svg.line([LEFT, y(power.alpha)], [RIGHT, y(power.alpha)], "zero");
    for &tick in &axis.ticks {
        let x = axis.place(tick);
        if x > RIGHT + 0.5 {
            continue;
        }
        svg.line([x, below], [x, below + 4.0], "rule");
        svg.text(x, below + 17.0, "small", Anchor::Middle, &format!("{tick:.0}"));
    }
    let words = language.pick("people", "personnes");
    svg.text((LEFT + RIGHT) / 2.0, below + 32.0, "small", Anchor::Middle, words);
    let x = |point: &PowerPoint| axis.place(point.participants as f64);
    let mut curve = |of: &dyn Fn(&Columns) -> Rate, line: &str, mark: &str| {
        let places: Vec<[f64; 2]> =
            points.iter().map(|(point, h)| [x(point), y(of(&h.power).share)]).collect();
        for pair in places.windows(2) {
            svg.line(pair[0], pair[1], line);
        }
        for ((point, hypothesis), place) in points.iter().zip(&places) {
            let [low, high] = of(&hypothesis.power).interval;
            svg.line([x(point), y(low)], [x(point), y(high)], line);
            svg.circle(place[0], place[1], 4.0, mark);
        }
    };
    curve(&|columns| columns.as_in_the_thesis, "zero", "box");
    curve(&|columns| columns.deciding_holm, "whisker", "mark");
    for (point, hypothesis) in points {
        let Some(columns) = &hypothesis.false_positives else { continue };
        for (rate, class) in [(columns.as_in_the_thesis, "box"), (columns.deciding, "mark")] {
            svg.diamond(x(point), y(rate.share), 5.0, class);
        }
    }
}
