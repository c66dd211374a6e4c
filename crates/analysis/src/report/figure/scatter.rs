//! Mean answers against measures of the stimuli: a panel per measure, a dot per stimulus.

use mimique_locale::Language;
use mimique_report::document::{DataTable, Figure};
use mimique_report::svg::{Anchor, Axis, Svg, WIDTH, clipped};

use crate::report::preview::Preview;

/// Panels beside each other.
const COLUMNS: usize = 2;
/// Left edge of the first panel: the answers' ticks stand before it.
const LEFT: f64 = 38.0;
/// Between panels.
const GAP: f64 = 30.0;
/// Height of a panel's area.
const HEIGHT: f64 = 110.0;
/// From one row of panels to the next.
const ROW: f64 = HEIGHT + 56.0;

/// A measure and the stimuli: name, what was measured, mean answer.
pub(crate) struct ScatterPanel<'a> {
    /// What is measured, with its unit.
    pub title: String,
    /// A dot each.
    pub points: &'a [(String, f64, f64)],
}

/// A panel per measure over one scale of answers. Where there is a preview, each dot leads to its clip there.
pub(crate) fn scatter(
    language: Language,
    id: &str,
    caption: &str,
    answer: &str,
    panels: &[ScatterPanel<'_>],
    preview: Option<Preview<'_>>,
) -> Figure {
    let width = (WIDTH - LEFT - GAP * (COLUMNS - 1) as f64 - 10.0) / COLUMNS as f64;
    let rows = panels.len().div_ceil(COLUMNS);
    let mut svg = Svg::new(caption, 30.0 + ROW * rows as f64);
    svg.text(4.0, 14.0, "small", Anchor::Start, &clipped(answer, (WIDTH / 6.0) as usize));
    let answers = || panels.iter().flat_map(|panel| panel.points.iter().map(|point| point.2));
    let (low, high) = ends(answers());
    for (place, panel) in panels.iter().enumerate() {
        let left = LEFT + (place % COLUMNS) as f64 * (width + GAP);
        let top = 40.0 + ROW * (place / COLUMNS) as f64;
        let bottom = top + HEIGHT;
        // The axis of answers grows upwards.
        let y = Axis::new(low, high, bottom, top);
        for &tick in &y.ticks {
            svg.line([left, y.place(tick)], [left + width, y.place(tick)], "rule");
            if place % COLUMNS == 0 {
                let text = language.fixed(tick, y.decimals);
                svg.text(left - 6.0, y.place(tick) + 4.0, "small", Anchor::End, &text);
            }
        }
        let (least, most) = ends(panel.points.iter().map(|point| point.1));
        let x = Axis::new(least, most, left, left + width);
        let ends = [(x.ticks.first(), Anchor::Start), (x.ticks.last(), Anchor::End)];
        for (tick, anchor) in ends {
            let Some(&tick) = tick else { continue };
            let text = language.fixed(tick, x.decimals);
            svg.text(x.place(tick), bottom + 15.0, "small", anchor, &text);
        }
        let title = clipped(&panel.title, (width / 5.4) as usize);
        svg.text(left + width / 2.0, bottom + 30.0, "small", Anchor::Middle, &title);
        for (stimulus, measured, mean) in panel.points {
            let link = preview.map(|preview| preview.of_clip(language, stimulus));
            let [x, y] = [x.place(*measured), y.place(*mean)];
            svg.linked(link.as_ref(), |svg| svg.circle(x, y, 3.5, "dot"));
        }
    }
    let columns = language.pick(
        ["measure", "stimulus", "measured", "mean answer"],
        ["mesure", "stimulus", "mesuré", "réponse moyenne"],
    );
    let mut data = DataTable::new(id, caption, columns);
    for panel in panels {
        for (stimulus, measured, mean) in panel.points {
            let [measured, mean] = [language.fixed(*measured, 4), language.fixed(*mean, 3)];
            data.row([panel.title.clone(), stimulus.clone(), measured, mean]);
        }
    }
    let titles: Vec<&str> = panels.iter().map(|panel| &*panel.title).collect();
    let alt = language.pick(
        format!("A dot per stimulus, its mean answer over {}.", titles.join("; ")),
        format!("Un point par stimulus, sa réponse moyenne selon {}.", titles.join(" ; ")),
    );
    Figure { id: id.to_owned(), caption: caption.to_owned(), alt, svg: svg.finish(), data }
}

/// The lowest and the highest of some values.
fn ends(values: impl Iterator<Item = f64>) -> (f64, f64) {
    values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_dot_per_stimulus_and_the_higher_answer_stands_higher() {
        let points =
            [("a".to_owned(), 0.5, 2.0), ("b".to_owned(), 1.5, 5.5), ("c".to_owned(), 1.0, 4.0)];
        let titles = ["Jerk (m/s³)", "RMSE (mm)", "Range (mm)"];
        let panels = titles.map(|title| ScatterPanel { title: title.to_owned(), points: &points });
        let figure =
            scatter(Language::English, "f", "Answers and measures", "How real?", &panels, None);
        assert_eq!(figure.svg.matches("class=\"dot\"").count(), 9);
        assert!(figure.svg.contains("role=\"img\"") && !figure.svg.contains("<a "));
        assert_eq!(figure.data.rows.len(), 9);
        assert!(figure.alt.contains("Jerk (m/s³); RMSE (mm)"));
        let heights: Vec<f64> = (figure.svg.split("cy=\"").skip(1))
            .map(|rest| rest.split('"').next().unwrap().parse().unwrap())
            .collect();
        assert!(heights[1] < heights[2] && heights[2] < heights[0], "{heights:?}");
    }
    #[test]
    fn each_dot_leads_to_its_clip_where_there_is_a_preview() {
        let points = [("joy1.box".to_owned(), 0.5, 2.0), ("a b&c".to_owned(), 1.5, 5.5)];
        let panels = [ScatterPanel { title: "Jerk (m/s³)".to_owned(), points: &points }];
        let preview = Some(Preview("https://lab.example/preview/study"));
        let figure = scatter(Language::French, "f", "Réponses", "Réel ?", &panels, preview);
        for link in [
            r#"<a href="https://lab.example/preview/study?clip=joy1.box" class="clip" aria-label="Aperçu de joy1.box"><title>Aperçu de joy1.box</title>"#,
            r#"<a href="https://lab.example/preview/study?clip=a%20b%26c" class="clip" aria-label="Aperçu de a b&amp;c">"#,
        ] {
            assert!(figure.svg.contains(link), "{}", figure.svg);
        }
        // What can be pressed is no picture, whose parts a screen reader does not tell.
        assert!(figure.svg.contains("role=\"group\""));
    }
}
