//! Shares of right answers.

use mimique_locale::Language;
use mimique_report::document::{DataTable, Figure};
use mimique_report::figure::{LEFT, RIGHT};
use mimique_report::svg::{Anchor, Axis, Svg, clipped};
use mimique_stats::Proportion;

use crate::report::figure::values_title;
use crate::trials::measure::MeasureKind;

/// Shares of right answers with Wilson intervals, and the share that guessing would give.
pub(crate) fn shares(
    language: Language,
    id: &str,
    caption: &str,
    chance: Option<f64>,
    groups: &[(String, Vec<(String, Proportion)>)],
) -> Figure {
    let axis = Axis::new(0.0, 1.0, LEFT, RIGHT - 46.0);
    let (top, line, gap) = (30.0, 25.0, 26.0);
    let rows: usize = groups.iter().map(|(_, rows)| rows.len()).sum();
    let titled = groups.iter().any(|(title, _)| !title.is_empty());
    let heading = if titled { gap } else { 6.0 };
    let bottom = top + rows as f64 * line + groups.len() as f64 * heading;
    let mut svg = Svg::new(caption, bottom + 44.0);
    percent_rules(&mut svg, language, &axis, (top, bottom));
    let title = values_title(language, MeasureKind::Recognition);
    svg.text((LEFT + RIGHT - 46.0) / 2.0, bottom + 35.0, "small", Anchor::Middle, title);
    if let Some(chance) = chance {
        guessing_line(&mut svg, language, axis.place(chance), (top, bottom));
    }
    let headings = language.pick(
        ["group", "level", "right", "trials", "share", "95 % low", "95 % high"],
        ["groupe", "niveau", "justes", "essais", "part", "95 % bas", "95 % haut"],
    );
    let mut data = DataTable::new(id, caption, headings);
    let mut spoken = Vec::new();
    let mut y = top;
    for (title, rows) in groups {
        if titled {
            svg.text(LEFT - 12.0, y + 16.0, "strong", Anchor::End, &clipped(title, 15));
        }
        y += heading;
        for (label, share) in rows {
            let middle = y + line / 2.0;
            svg.text(LEFT - 12.0, middle + 4.5, "", Anchor::End, &clipped(label, 15));
            let mut cells = vec![
                title.clone(),
                label.clone(),
                share.successes.to_string(),
                share.n.to_string(),
            ];
            if let (Some(value), Some([low, high])) = (share.proportion, share.wilson) {
                svg.line([axis.place(low), middle], [axis.place(high), middle], "whisker");
                svg.circle(axis.place(value), middle, 5.0, "mark");
                let text = language.percent(value);
                svg.text(RIGHT, middle + 4.5, "strong", Anchor::End, &text);
                cells.extend([value, low, high].map(|v| language.fixed(v, 3)));
                spoken.push(format!("{} {label} {text}", title).trim().to_owned());
            }
            data.row(cells);
            y += line;
        }
    }
    let alt = language.pick(
        format!("Points with intervals: {}.", spoken.join(", ")),
        format!("Points avec intervalles : {}.", spoken.join(", ")),
    );
    Figure { id: id.to_owned(), caption: caption.to_owned(), alt, svg: svg.finish(), data }
}

/// Lines down the figure with their percentages below.
fn percent_rules(svg: &mut Svg, language: Language, axis: &Axis, (top, bottom): (f64, f64)) {
    for &tick in &axis.ticks {
        let x = axis.place(tick);
        svg.line([x, top - 4.0], [x, bottom], "rule");
        svg.text(x, bottom + 17.0, "small", Anchor::Middle, &language.percent(tick));
    }
}

/// A line where guessing would come to lie.
fn guessing_line(svg: &mut Svg, language: Language, x: f64, (top, bottom): (f64, f64)) {
    svg.line([x, top - 4.0], [x, bottom], "zero");
    let text = language.pick("guessing", "au hasard");
    svg.text(x, top - 10.0, "small", Anchor::Middle, text);
}
