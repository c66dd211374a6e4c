//! The figures of a report, each with alternative text and its data as a table.

pub(crate) mod conditions;
pub(crate) mod flow_chart;
pub(crate) mod people;
pub(crate) mod svg;

use mimique_stats::{Confusion, Outcome, Proportion, quantile_sorted};

use crate::hypothesis::person_level::Pair;
use crate::language::Language;
use crate::report::document::{DataTable, Figure};
use crate::report::figure::svg::{Anchor, Axis, Svg, WIDTH, clipped, shade};

/// Left edge of the plotting area beside row labels.
const LEFT: f64 = 116.0;
const RIGHT: f64 = WIDTH - 10.0;

/// Shown against answered: the share of each row.
pub(crate) fn confusion(
    language: Language,
    id: &str,
    of: &str,
    result: &Confusion,
    name: impl Fn(&str) -> String,
) -> Figure {
    let shown = result.shown();
    let columns = result.labels.len();
    let size = ((RIGHT - LEFT) / columns as f64).min(64.0);
    let (top, height) = (58.0, 40.0);
    let caption = language.pick(
        format!("{of}: emotion played (rows) and recognised (columns), percent of each row"),
        format!(
            "{of} : émotion jouée (lignes) et reconnue (colonnes), en pourcentage de chaque ligne"
        ),
    );
    let mut svg = Svg::new(&caption, top + height * shown.len() as f64 + 14.0);
    let mut data = DataTable::new(
        id,
        caption.clone(),
        std::iter::once(language.pick("played", "jouée").to_owned())
            .chain(result.labels.iter().map(|label| name(label)))
            .chain([language.pick("recall", "rappel").to_owned(), "95 %".to_owned()]),
    );
    svg.text(LEFT, 18.0, "soft", Anchor::Start, language.pick("recognised as", "reconnue comme"));
    for (j, label) in result.labels.iter().enumerate() {
        let x = LEFT + size * (j as f64 + 0.5);
        // Neighbouring labels take turns in height where columns are narrow.
        let y = if columns > 5 && j % 2 == 1 { 34.0 } else { 49.0 };
        svg.text(x, y, "small", Anchor::Middle, &clipped(&name(label), 11));
    }
    let mut best = Vec::new();
    for (i, label) in shown.iter().enumerate() {
        let y = top + height * i as f64;
        svg.text(LEFT - 10.0, y + height / 2.0 + 4.0, "", Anchor::End, &clipped(&name(label), 15));
        let row: u64 = result.labels.iter().map(|answer| result.count(label, answer)).sum();
        let mut cells = vec![name(label)];
        for (j, answer) in result.labels.iter().enumerate() {
            let count = result.count(label, answer);
            let share = count as f64 / row as f64;
            let x = LEFT + size * j as f64;
            svg.rect([x + 1.0, y + 1.0, size - 2.0, height - 2.0], &shade(share));
            if answer == label {
                svg.class_rect([x + 2.0, y + 2.0, size - 4.0, height - 4.0], "empty");
            }
            if count > 0 {
                let text = format!("{:.0}", share * 100.0);
                svg.text_on(x + size / 2.0, y + height / 2.0 + 4.0, share, &text);
            }
            cells.push(count.to_string());
        }
        let recall = result.recall.get(label).copied().flatten();
        let interval = result.recall_ci_wilson.get(label).copied().flatten();
        cells.push(recall.map_or_else(String::new, |recall| language.percent(recall)));
        cells.push(interval.map_or_else(String::new, |[low, high]| {
            format!("{} – {}", language.percent(low), language.percent(high))
        }));
        data.row(cells);
        if let Some(recall) = recall {
            best.push(format!("{} {}", name(label), language.percent(recall)));
        }
    }
    let alt = language.pick(
        format!(
            "Heat map of {} rows by {columns} columns. Recognised: {}.",
            shown.len(),
            best.join(", ")
        ),
        format!(
            "Carte de {} lignes par {columns} colonnes. Reconnues : {}.",
            shown.len(),
            best.join(", ")
        ),
    );
    Figure { id: id.to_owned(), caption, alt, svg: svg.finish(), data }
}

/// Ratings a level as bars of all answers, from the lowest to the highest point.
pub(crate) fn likert(
    language: Language,
    id: &str,
    caption: &str,
    (first, last): (i64, i64),
    rows: &[(String, Vec<f64>)],
) -> Figure {
    let points: Vec<i64> = (first..=last).collect();
    let (top, height, gap) = (44.0, 26.0, 12.0);
    let right = WIDTH - 48.0;
    let mut svg = Svg::new(caption, top + (height + gap) * rows.len() as f64 + 28.0);
    let tone = |i: usize| {
        if points.len() > 1 { i as f64 / (points.len() - 1) as f64 } else { 0.5 }
    };
    let step = (right - LEFT) / points.len() as f64;
    for (i, point) in points.iter().enumerate() {
        let x = LEFT + step * i as f64;
        svg.rect([x, 10.0, step - 2.0, 18.0], &shade(tone(i)));
        svg.text_on(x + step / 2.0 - 1.0, 23.5, tone(i), &point.to_string());
    }
    svg.text(LEFT - 10.0, 23.0, "soft", Anchor::End, language.pick("answer", "réponse"));
    svg.text(right + 10.0, 23.0, "soft", Anchor::Start, language.pick("mean", "moy."));
    let mut data = DataTable::new(
        id,
        caption,
        std::iter::once(String::new()).chain(points.iter().map(ToString::to_string)).chain(
            [
                language.pick("n", "n"),
                language.pick("mean", "moyenne"),
                language.pick("median", "médiane"),
            ]
            .map(str::to_owned),
        ),
    );
    let mut spoken = Vec::new();
    for (place, (label, values)) in rows.iter().enumerate() {
        let y = top + (height + gap) * place as f64;
        svg.text(LEFT - 10.0, y + height / 2.0 + 4.5, "", Anchor::End, &clipped(label, 15));
        let n = values.len() as f64;
        let mut x = LEFT;
        let mut cells = vec![label.clone()];
        for (i, point) in points.iter().enumerate() {
            let count = values.iter().filter(|value| **value == *point as f64).count();
            let width = count as f64 / n * (right - LEFT);
            svg.rect([x, y, width, height], &shade(tone(i)));
            if width > 20.0 {
                svg.text_on(x + width / 2.0, y + height / 2.0 + 4.5, tone(i), &point.to_string());
            }
            x += width;
            cells.push(count.to_string());
        }
        let mean = values.iter().sum::<f64>() / n;
        let mut sorted = values.clone();
        sorted.sort_unstable_by(f64::total_cmp);
        let mean_text = language.fixed(mean, 2);
        svg.text(right + 10.0, y + height / 2.0 + 4.5, "strong", Anchor::Start, &mean_text);
        cells.extend([
            values.len().to_string(),
            mean_text.clone(),
            language.number(quantile_sorted(&sorted, 0.5)),
        ]);
        spoken.push(format!("{label} {mean_text}"));
        data.row(cells);
    }
    let bottom = top + (height + gap) * rows.len() as f64 + 12.0;
    for share in [0.0, 0.5, 1.0] {
        let x = LEFT + share * (right - LEFT);
        svg.text(x, bottom + 4.0, "small", Anchor::Middle, &language.percent(share));
    }
    let alt = language.pick(
        format!("Stacked bars of all answers. Means: {}.", spoken.join(", ")),
        format!("Barres empilées de toutes les réponses. Moyennes : {}.", spoken.join(", ")),
    );
    Figure { id: id.to_owned(), caption: caption.to_owned(), alt, svg: svg.finish(), data }
}

/// Differences of each person, with the Hodges-Lehmann estimate and its interval.
pub(crate) fn differences(
    language: Language,
    id: &str,
    caption: &str,
    pairs: &[([String; 2], &Pair)],
) -> Figure {
    let all = || pairs.iter().flat_map(|(_, pair)| pair.differences.iter().copied());
    let ends =
        || pairs.iter().filter_map(|(_, p)| p.difference).flat_map(|d| [d.ci_low, d.ci_high]);
    let low = all().chain(ends()).fold(0.0, f64::min);
    let high = all().chain(ends()).fold(0.0, f64::max);
    let axis = Axis::new(low, high, LEFT, RIGHT - 6.0);
    let (top, height) = (26.0, 78.0);
    let bottom = top + height * pairs.len() as f64;
    let mut svg = Svg::new(caption, bottom + 30.0);
    for &tick in &axis.ticks {
        let x = axis.place(tick);
        let class = if tick.abs() < 1e-12 { "zero" } else { "rule" };
        svg.line([x, top - 6.0], [x, bottom], class);
        let text = language.fixed(tick, axis.decimals);
        svg.text(x, bottom + 17.0, "small", Anchor::Middle, &text);
    }
    let mut data = DataTable::new(id, caption, difference_columns(language));
    let mut spoken = Vec::new();
    for (place, (levels, pair)) in pairs.iter().enumerate() {
        let y = top + height * place as f64 + height / 2.0;
        let [first, second] = levels;
        for (text, dy) in [(first.clone(), -4.0), (format!("− {second}"), 13.0)] {
            svg.text(LEFT - 12.0, y + dy, "", Anchor::End, &clipped(&text, 15));
        }
        difference_dots(&mut svg, &axis, y, &pair.differences);
        let label = levels.join(" − ");
        if let Some(estimate) = pair.difference {
            let at = y + 24.0;
            let (low, high) = (axis.place(estimate.ci_low), axis.place(estimate.ci_high));
            svg.line([low, at], [high, at], "whisker");
            svg.line([low, at - 5.0], [low, at + 5.0], "whisker");
            svg.line([high, at - 5.0], [high, at + 5.0], "whisker");
            svg.diamond(axis.place(estimate.estimate), at, 6.0, "mark");
            spoken.push(format!(
                "{label} {} ({} – {})",
                language.number(estimate.estimate),
                language.number(estimate.ci_low),
                language.number(estimate.ci_high)
            ));
        }
        data.row(difference_row(language, label, pair));
    }
    let alt = language.pick(
        format!(
            "One dot a person; diamond and bar are the estimate and its interval: {}.",
            spoken.join("; ")
        ),
        format!(
            "Un point par personne ; losange et barre : estimation et intervalle : {}.",
            spoken.join(" ; ")
        ),
    );
    Figure { id: id.to_owned(), caption: caption.to_owned(), alt, svg: svg.finish(), data }
}

/// Dots of people; those with the same difference stand beside each other, above the estimate.
fn difference_dots(svg: &mut Svg, axis: &Axis, y: f64, differences: &[f64]) {
    let mut sorted = differences.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    let columns = ((RIGHT - LEFT) / 7.0).floor();
    let bin = |value: f64| ((axis.place(value) - LEFT) / (RIGHT - LEFT) * columns).round() as i64;
    let most = sorted.chunk_by(|a, b| bin(*a) == bin(*b)).map(<[f64]>::len).max().unwrap_or(1);
    let rise = (42.0 / most as f64).min(7.0);
    for group in sorted.chunk_by(|a, b| bin(*a) == bin(*b)) {
        for (stack, value) in group.iter().enumerate() {
            svg.circle(axis.place(*value), y + 8.0 - stack as f64 * rise, 3.2, "dot");
        }
    }
}

fn difference_columns(language: Language) -> [&'static str; 8] {
    language.pick(
        [
            "pair",
            "people",
            "first higher",
            "second higher",
            "estimate",
            "95 % low",
            "95 % high",
            "p (Holm)",
        ],
        [
            "paire",
            "personnes",
            "premier supérieur",
            "second supérieur",
            "estimation",
            "95 % bas",
            "95 % haut",
            "p (Holm)",
        ],
    )
}

fn difference_row(language: Language, label: String, pair: &Pair) -> Vec<String> {
    let mut cells = vec![label];
    cells.extend([pair.n, pair.a_higher, pair.b_higher].map(|count| count.to_string()));
    cells.extend(match pair.difference {
        Some(estimate) => [estimate.estimate, estimate.ci_low, estimate.ci_high]
            .map(|value| language.number(value)),
        None => ["", "", ""].map(str::to_owned),
    });
    cells.push(match &pair.wilcoxon {
        Outcome::Ok(line) => language.p_cell(line.p_that_counts(), line.row.ln_p),
        Outcome::Undefined { .. } => language.pick("undefined", "non défini").to_owned(),
    });
    cells
}

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
    let mut svg = Svg::new(caption, bottom + 30.0);
    for &tick in &axis.ticks {
        let x = axis.place(tick);
        svg.line([x, top - 4.0], [x, bottom], "rule");
        svg.text(x, bottom + 17.0, "small", Anchor::Middle, &language.percent(tick));
    }
    if let Some(chance) = chance {
        let x = axis.place(chance);
        svg.line([x, top - 4.0], [x, bottom], "zero");
        let text = language.pick("guessing", "au hasard");
        svg.text(x, top - 10.0, "small", Anchor::Middle, text);
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

/// Boxes of quartiles with whiskers from the 5th to the 95th percentile.
pub(crate) fn boxes(
    language: Language,
    id: &str,
    caption: &str,
    unit: &str,
    rows: &[(String, Vec<f64>)],
) -> Figure {
    let sorted: Vec<(String, Vec<f64>)> = rows
        .iter()
        .map(|(label, values)| {
            let mut values = values.clone();
            values.sort_unstable_by(f64::total_cmp);
            (label.clone(), values)
        })
        .collect();
    let high = sorted.iter().map(|(_, v)| quantile_sorted(v, 0.95)).fold(0.0, f64::max);
    let low = sorted.iter().map(|(_, v)| quantile_sorted(v, 0.05)).fold(0.0, f64::min);
    let axis = Axis::new(low, high, LEFT, RIGHT - 6.0);
    let (top, height) = (20.0, 46.0);
    let bottom = top + height * rows.len() as f64;
    let mut svg = Svg::new(caption, bottom + 44.0);
    for &tick in &axis.ticks {
        let x = axis.place(tick);
        svg.line([x, top - 6.0], [x, bottom], "rule");
        let text = language.fixed(tick, axis.decimals);
        svg.text(x, bottom + 17.0, "small", Anchor::Middle, &text);
    }
    svg.text((LEFT + RIGHT) / 2.0, bottom + 36.0, "small", Anchor::Middle, unit);
    let headings = language.pick(
        ["", "n", "5 %", "25 %", "median", "75 %", "95 %"],
        ["", "n", "5 %", "25 %", "médiane", "75 %", "95 %"],
    );
    let mut data = DataTable::new(id, caption, headings);
    let mut spoken = Vec::new();
    for (place, (label, values)) in sorted.iter().enumerate() {
        let y = top + height * (place as f64 + 0.5);
        svg.text(LEFT - 12.0, y + 4.5, "", Anchor::End, &clipped(label, 15));
        let quantiles = [0.05, 0.25, 0.5, 0.75, 0.95].map(|q| quantile_sorted(values, q));
        let [p5, q1, median, q3, p95] = quantiles.map(|value| axis.place(value));
        svg.line([p5, y], [q1, y], "whisker");
        svg.line([q3, y], [p95, y], "whisker");
        svg.class_rect([q1, y - 12.0, q3 - q1, 24.0], "box");
        svg.line([median, y - 12.0], [median, y + 12.0], "whisker");
        let mut cells = vec![label.clone(), values.len().to_string()];
        cells.extend(quantiles.map(|value| language.fixed(value, 2)));
        data.row(cells);
        spoken.push(format!("{label} {}", language.fixed(quantiles[2], 2)));
    }
    let alt = language.pick(
        format!("Box plots. Medians: {}.", spoken.join(", ")),
        format!("Boîtes à moustaches. Médianes : {}.", spoken.join(", ")),
    );
    Figure { id: id.to_owned(), caption: caption.to_owned(), alt, svg: svg.finish(), data }
}
