//! A confusion matrix as a heat map.

use mimique_locale::Language;

use crate::document::{DataTable, Figure};
use crate::figure::{LEFT, RIGHT};
use crate::svg::{Anchor, Svg, clipped, shade};

/// The words of a confusion matrix.
pub struct ConfusionWords {
    /// What it shows.
    pub caption: String,
    /// Over the rows: what was there.
    pub rows: String,
    /// Over the columns: what was answered.
    pub columns: String,
    /// Headings of what its table has beside the counts.
    pub beside: Vec<String>,
}

/// A row of a confusion matrix.
pub struct ConfusionRow {
    /// Its place among the columns.
    pub label: usize,
    /// How often each was answered.
    pub counts: Vec<u64>,
    /// What its table has beside the counts.
    pub beside: Vec<String>,
}

/// A confusion matrix as a heat map: the share of each row in percent. `recognised` says in words how
/// much of each row was answered rightly.
pub fn confusion_matrix(
    language: Language,
    id: &str,
    words: &ConfusionWords,
    names: &[String],
    rows: &[ConfusionRow],
    recognised: &str,
) -> Figure {
    let ConfusionWords { caption, rows: of_rows, columns, beside } = words;
    let size = ((RIGHT - LEFT) / names.len() as f64).min(64.0);
    let (top, height) = (58.0, 40.0);
    let mut svg = Svg::new(caption, top + height * rows.len() as f64 + 14.0);
    let headings = std::iter::once(of_rows).chain(names).chain(beside);
    let mut data = DataTable::new(id, caption.clone(), headings.cloned());
    svg.text(LEFT, 18.0, "soft", Anchor::Start, columns);
    svg.text(LEFT - 10.0, 49.0, "soft", Anchor::End, &clipped(of_rows, 15));
    column_labels(&mut svg, names, size);
    for (i, ConfusionRow { label, counts, beside }) in rows.iter().enumerate() {
        let y = top + height * i as f64;
        let name = &names[*label];
        svg.text(LEFT - 10.0, y + height / 2.0 + 4.0, "", Anchor::End, &clipped(name, 15));
        let row: u64 = counts.iter().sum();
        let mut cells = vec![name.clone()];
        for (j, &count) in counts.iter().enumerate() {
            let share = count as f64 / row as f64;
            let x = LEFT + size * j as f64;
            svg.rect([x + 1.0, y + 1.0, size - 2.0, height - 2.0], &shade(share));
            if j == *label {
                svg.class_rect([x + 2.0, y + 2.0, size - 4.0, height - 4.0], "empty");
            }
            if count > 0 {
                let text = format!("{:.0}", share * 100.0);
                svg.text_on(x + size / 2.0, y + height / 2.0 + 4.0, share, &text);
            }
            cells.push(count.to_string());
        }
        cells.extend(beside.iter().cloned());
        data.row(cells);
    }
    let alt = alternative_text(language, rows.len(), names.len(), recognised);
    Figure { id: id.to_owned(), caption: caption.clone(), alt, svg: svg.finish(), data }
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

fn alternative_text(language: Language, rows: usize, columns: usize, recognised: &str) -> String {
    language.pick(
        format!("Heat map of {rows} rows by {columns} columns. Recognised: {recognised}."),
        format!("Carte de {rows} lignes par {columns} colonnes. Reconnues : {recognised}."),
    )
}
