//! A confusion matrix as a heat map.

use mimique_stats::Confusion;

use crate::language::Language;
use crate::report::document::{DataTable, Figure};
use crate::report::figure::svg::{Anchor, Svg, clipped, shade};
use crate::report::figure::{LEFT, RIGHT};

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
    let names: Vec<String> = result.labels.iter().map(|label| name(label)).collect();
    let mut data = DataTable::new(
        id,
        caption.clone(),
        std::iter::once(language.pick("played", "jouée").to_owned())
            .chain(names.iter().cloned())
            .chain([language.pick("recall", "rappel").to_owned(), "95 %".to_owned()]),
    );
    svg.text(LEFT, 18.0, "soft", Anchor::Start, language.pick("recognised as", "reconnue comme"));
    column_labels(&mut svg, &names, size);
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
        let [recall, interval] = recall_cells(language, result, label);
        if !recall.is_empty() {
            best.push(format!("{} {recall}", name(label)));
        }
        cells.extend([recall, interval]);
        data.row(cells);
    }
    let alt = alternative_text(language, shown.len(), columns, &best.join(", "));
    Figure { id: id.to_owned(), caption, alt, svg: svg.finish(), data }
}

/// The names of the answers above their columns.
fn column_labels(svg: &mut Svg, names: &[String], size: f64) {
    for (j, name) in names.iter().enumerate() {
        let x = LEFT + size * (j as f64 + 0.5);
        // Neighbouring labels take turns in height where columns are narrow.
        let y = if names.len() > 5 && j % 2 == 1 { 34.0 } else { 49.0 };
        svg.text(x, y, "small", Anchor::Middle, &clipped(name, 11));
    }
}

/// Recall of a row and its interval; empty where there is none.
fn recall_cells(language: Language, result: &Confusion, label: &str) -> [String; 2] {
    let recall = result.recall.get(label).copied().flatten();
    let interval = result.recall_ci_wilson.get(label).copied().flatten();
    [
        recall.map_or_else(String::new, |recall| language.percent(recall)),
        interval.map_or_else(String::new, |[low, high]| {
            format!("{} – {}", language.percent(low), language.percent(high))
        }),
    ]
}

fn alternative_text(language: Language, rows: usize, columns: usize, recognised: &str) -> String {
    language.pick(
        format!("Heat map of {rows} rows by {columns} columns. Recognised: {recognised}."),
        format!("Carte de {rows} lignes par {columns} colonnes. Reconnues : {recognised}."),
    )
}
