//! Confusion matrices: labels of the annotator against suggested ones.

use mimique_locale::Language;
use mimique_report::document::{Figure, slug};
use mimique_report::figure::{ConfusionRow, ConfusionWords, confusion_matrix};

use super::scores::value;
use super::words;
use crate::annotate::evaluate::{Column, Evaluation};

/// Frames by true label and suggested label.
pub fn confusion(language: Language, of: &Evaluation, column: &Column) -> Figure {
    let name = words::column(language, column.kind);
    let confusion = &column.summary.counts.confusion;
    let labels = confusion.label_scores();
    let rows: Vec<ConfusionRow> = confusion
        .rows()
        .enumerate()
        .filter(|(_, counts)| counts.iter().sum::<u64>() > 0)
        .map(|(label, counts)| ConfusionRow {
            label,
            counts: counts.to_vec(),
            beside: vec![value(language, labels[label].recall)],
        })
        .collect();
    let words = ConfusionWords {
        caption: language.pick(
            format!("{name}: label of the annotator (rows) and suggested (columns), percent of each row’s frames"),
            format!("{name} : étiquette de l’annotateur (lignes) et suggérée (colonnes), en pourcentage des images de chaque ligne"),
        ),
        rows: language.pick("annotator", "annotateur").to_owned(),
        columns: language.pick("suggested", "suggérée").to_owned(),
        beside: vec![language.pick("recall", "rappel").to_owned()],
    };
    let names = &of.corpus.labels;
    let told: Vec<String> =
        rows.iter().map(|row| format!("{} {}", names[row.label], row.beside[0])).collect();
    let id = format!("confusion-{}", slug(name));
    confusion_matrix(language, &id, &words, names, &rows, &told.join(", "))
}
