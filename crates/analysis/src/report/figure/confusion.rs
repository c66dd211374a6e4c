//! A confusion matrix of a study: emotions played against emotions recognised.

use mimique_locale::Language;
use mimique_report::document::Figure;
use mimique_report::figure::{ConfusionRow, ConfusionWords, confusion_matrix};
use mimique_stats::Confusion;

/// Emotions played against emotions recognised.
pub(crate) fn confusion(
    language: Language,
    id: &str,
    of: &str,
    result: &Confusion,
    name: impl Fn(&str) -> String,
) -> Figure {
    let words = ConfusionWords {
        caption: language.pick(
            format!("{of}: emotion played (rows) and recognised (columns), percent of each row"),
            format!(
                "{of} : émotion jouée (lignes) et reconnue (colonnes), en pourcentage de chaque ligne"
            ),
        ),
        rows: language.pick("played", "jouée").to_owned(),
        columns: language.pick("recognised as", "reconnue comme").to_owned(),
        beside: vec![language.pick("recall", "rappel").to_owned(), "95 %".to_owned()],
    };
    let names: Vec<String> = result.labels.iter().map(|label| name(label)).collect();
    let mut best = Vec::new();
    let mut rows = Vec::new();
    for label in result.shown() {
        let beside = recall_cells(language, result, label);
        if !beside[0].is_empty() {
            best.push(format!("{} {}", name(label), beside[0]));
        }
        rows.push(ConfusionRow {
            label: result.labels.iter().position(|own| own == label).unwrap_or(0),
            counts: result.labels.iter().map(|answer| result.count(label, answer)).collect(),
            beside: beside.to_vec(),
        });
    }
    confusion_matrix(language, id, &words, &names, &rows, &best.join(", "))
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
