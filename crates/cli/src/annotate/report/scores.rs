//! The tables of an evaluation: scores beside the majority's, by label, by person, and the thesis'
//! figure 4.4.

use mimique_annotate::evaluate::{Score, Summary};
use mimique_locale::Language;
use mimique_report::document::DataTable;

use super::words;
use crate::annotate::evaluate::Evaluation;

/// A score as people read it.
pub fn value(language: Language, value: Option<f64>) -> String {
    value.map_or_else(|| "–".to_owned(), |value| language.fixed(value, 2))
}

/// The 95 % interval of a score; empty where there is none.
pub fn interval(language: Language, summary: &Summary, score: Score) -> String {
    let intervals = summary.intervals.iter().flatten();
    let own = intervals.filter(|own| own.score == score).find_map(|own| own.ends);
    own.map_or_else(String::new, |ends| {
        let [low, high] = ends.map(|end| language.fixed(end, 2));
        format!("{low} – {high}")
    })
}

/// What always answering the commonest label would score; of segments as each candidate cuts them, which
/// of several are told one after the other.
pub fn majority(language: Language, of: &Evaluation, score: Score) -> String {
    if score == Score::SegmentsRight {
        let own = of.columns.iter().map(|column| column.summary.scores.labelled.majority);
        return own.map(|own| value(language, own)).collect::<Vec<_>>().join(" / ");
    }
    match &of.columns[0].summary.majority {
        Some((_, scores)) => value(language, score.of(scores)),
        None => String::new(),
    }
}

/// Every score: a column each candidate with its interval, and the majority's.
pub fn scores(language: Language, of: &Evaluation) -> DataTable {
    let caption = language.pick(
        "Scores with 95 % intervals, beside what always answering the commonest label would score",
        "Scores avec intervalles à 95 %, à côté de ce que donnerait toujours l’étiquette la plus fréquente",
    );
    let resampled = of.columns[0].summary.intervals.is_some();
    let mut columns = vec![String::new()];
    let mut groups = vec![(String::new(), 1)];
    for column in &of.columns {
        columns.push(language.pick("score", "score").to_owned());
        if resampled {
            columns.push("95 %".to_owned());
        }
        groups.push((words::column(language, column.kind).to_owned(), 1 + usize::from(resampled)));
    }
    let majority = of.columns[0].summary.majority.as_ref();
    if let Some((label, _)) = majority {
        let label = &of.corpus.labels[*label];
        columns.push("score".to_owned());
        groups.push((language.pick(format!("Always {label}"), format!("Toujours {label}")), 1));
    }
    let mut table = DataTable::new("scores", caption, columns);
    table.groups = groups;
    for score in Score::ALL {
        let mut row = vec![words::score(language, score).to_owned()];
        for column in &of.columns {
            row.push(value(language, score.of(&column.summary.scores)));
            if resampled {
                row.push(interval(language, &column.summary, score));
            }
        }
        if majority.is_some() {
            row.push(self::majority(language, of, score));
        }
        table.row(row);
    }
    table
}

/// Recall, precision and F1 of each label.
pub fn by_label(language: Language, of: &Evaluation) -> DataTable {
    let caption = language.pick("By label, frame by frame", "Par étiquette, image par image");
    let heading = language.pick(["label", "frames"], ["étiquette", "images"]);
    let own = language.pick(["recall", "precision", "F1"], ["rappel", "précision", "F1"]);
    let columns = heading.into_iter().chain(of.columns.iter().flat_map(|_| own));
    let mut table = DataTable::new("labels", caption, columns);
    let groups = of.columns.iter().map(|c| (words::column(language, c.kind).to_owned(), 3));
    table.groups = std::iter::once((String::new(), 2)).chain(groups).collect();
    for (place, label) in of.corpus.labels.iter().enumerate() {
        let scores = |column: &crate::annotate::evaluate::Column| {
            column.summary.counts.confusion.label_scores()[place]
        };
        let mut row = vec![label.clone(), scores(&of.columns[0]).n.to_string()];
        for column in &of.columns {
            let own = scores(column);
            row.extend([own.recall, own.precision, own.f1].map(|v| value(language, v)));
        }
        table.row(row);
    }
    table
}

/// Scores of each person.
pub fn by_person(language: Language, of: &Evaluation) -> DataTable {
    const SHOWN: [Score; 3] = [Score::Accuracy, Score::MacroF1, Score::F1At50];
    let caption = language.pick("By person", "Par personne");
    let heading = language.pick(["person", "frames"], ["personne", "images"]);
    let own = SHOWN.map(|score| words::score(language, score));
    let columns = heading.into_iter().chain(of.columns.iter().flat_map(|_| own));
    let mut table = DataTable::new("persons", caption, columns);
    let groups = of.columns.iter().map(|c| (words::column(language, c.kind).to_owned(), 3));
    table.groups = std::iter::once((String::new(), 2)).chain(groups).collect();
    for (place, (person, counts)) in of.columns[0].summary.persons.iter().enumerate() {
        let name = if person.is_empty() { "–" } else { person };
        let mut row = vec![name.to_owned(), counts.scores().frames.n.to_string()];
        for column in &of.columns {
            let scores = column.summary.persons[place].1.scores();
            row.extend(SHOWN.map(|score| value(language, score.of(&scores))));
        }
        table.row(row);
    }
    table
}

/// The thesis' figure 4.4: segments right, by classifier, on the annotator's segments and on those found.
pub fn figure_4_4(language: Language, of: &Evaluation) -> DataTable {
    let caption = language.pick(
        "Segments right, as figure 4.4 of the thesis has it, beside what always answering the commonest label would score",
        "Segments justes, comme la figure 4.4 de la thèse, à côté de ce que donnerait toujours l’étiquette la plus fréquente",
    );
    let heading = language.pick(
        ["classifier", "n", "right", "majority", "n", "right", "majority"],
        ["classifieur", "n", "justes", "majorité", "n", "justes", "majorité"],
    );
    let mut table = DataTable::new("figure-4-4", caption, heading);
    let groups = language.pick(["", "manual", "automatic"], ["", "manuels", "automatiques"]);
    table.groups = groups.into_iter().zip([1, 3, 3]).map(|(g, n)| (g.to_owned(), n)).collect();
    for row in &of.thesis {
        let mut cells = vec![words::method(language, &row.method)];
        for summary in [&row.of_true, &row.of_found] {
            let own = summary.scores.labelled;
            cells.push(own.n.to_string());
            cells.extend([own.accuracy, own.majority].map(|v| value(language, v)));
        }
        table.row(cells);
    }
    table
}

/// Calibration error and Brier's score, before and after the temperature.
pub fn calibration(language: Language, of: &Evaluation) -> DataTable {
    let caption = language.pick(
        "How far probabilities are from shares of right answers; 0 is best",
        "Écart entre probabilités et parts de réponses justes ; 0 est le mieux",
    );
    let heading = language.pick(
        ["", "calibration error", "Brier", "calibration error", "Brier"],
        ["", "erreur de calibration", "Brier", "erreur de calibration", "Brier"],
    );
    let mut table = DataTable::new("calibration", caption, heading);
    let [without, with] = words::temperature(language);
    let groups = ["", without, with];
    table.groups = groups.into_iter().zip([1, 2, 2]).map(|(g, n)| (g.to_owned(), n)).collect();
    for column in of.columns.iter().filter(|column| column.calibrated) {
        let mut row = vec![words::column(language, column.kind).to_owned()];
        for own in &column.summary.reliability {
            row.extend([own.expected_error(), own.brier()].map(|v| value(language, v)));
        }
        table.row(row);
    }
    table
}
