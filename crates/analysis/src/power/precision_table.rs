//! The precision of blocks as tables: CSV for scripts, markdown for people.

use std::fmt::Write as _;

use super::{BlockPrecision, Power, Told};
use crate::language::Language;
use crate::report::document::csv_text;

/// One row a block, number of trials and number of people.
pub fn precision_csv(power: &Power) -> String {
    let head =
        ["block", "tells", "trials", "participants", "runs", "width", "error", "told", "falsely"];
    let rows = power.precision.iter().flat_map(|block| {
        block.points.iter().map(move |point| {
            let number =
                |value: Option<f64>| value.map_or_else(String::new, |it| format!("{it:.5}"));
            let tells = match block.tells {
                Told::Thresholds => "thresholds",
                Told::Scale => "scale",
                Told::Images => "images",
            };
            vec![
                block.block.clone(),
                tells.to_owned(),
                point.trials.to_string(),
                point.participants.to_string(),
                block.runs.to_string(),
                number(point.width),
                number(point.error),
                number(Some(point.told)),
                number(point.falsely),
            ]
        })
    });
    csv_text(std::iter::once(head.map(str::to_owned).to_vec()).chain(rows))
}

/// A table a block; nothing in a study without such blocks.
pub fn precision_markdown(power: &Power, language: Language) -> String {
    let mut text = String::new();
    for block in &power.precision {
        table(&mut text, block, language);
    }
    text
}

fn table(text: &mut String, block: &BlockPrecision, language: Language) {
    let BlockPrecision { block: name, tells, runs, points } = block;
    let what = language.pick(
        match tells {
            Told::Thresholds => "width of the 95 % interval of the mean threshold (mean over studies), root mean square error of a person’s threshold, and the share of people whose threshold lies within the levels; trials are those of a track",
            Told::Scale => "width of a 95 % interval of ψ at the highest level (from its spread over studies), and the share of studies that have a scale",
            Told::Images => "share of the units of the faces in mind whose presence is found (corrected p of 0.05 or less), and share of the other pairs of unit and answer that are found as well",
        },
        match tells {
            Told::Thresholds => "largeur de l’intervalle à 95 % du seuil moyen (moyenne sur les études), erreur quadratique moyenne du seuil d’une personne, et part des personnes dont le seuil est dans les niveaux\u{a0}; les essais sont ceux d’une piste",
            Told::Scale => "largeur d’un intervalle à 95 % de ψ au niveau le plus haut (d’après sa dispersion d’une étude à l’autre), et part des études qui ont une échelle",
            Told::Images => "part des unités des visages en tête dont la présence est trouvée (p corrigé de 0,05 au plus), et part des autres paires d’unité et de réponse trouvées aussi",
        },
    );
    let line = language.pick(
        format!("**{name}**: {what}; {runs} simulated studies per row."),
        format!("**{name}**\u{a0}: {what}\u{a0}; {runs} études simulées par ligne."),
    );
    let _ = writeln!(text, "{line}\n");
    let [trials, people] = language.pick(["trials", "people"], ["essais", "personnes"]);
    let names: &[&str] = language.pick(
        match tells {
            Told::Thresholds => &["width", "error of a person", "within the levels"],
            Told::Scale => &["width", "with a scale"],
            Told::Images => &["found", "falsely found"],
        },
        match tells {
            Told::Thresholds => &["largeur", "erreur d’une personne", "dans les niveaux"],
            Told::Scale => &["largeur", "avec une échelle"],
            Told::Images => &["trouvées", "trouvées à tort"],
        },
    );
    let _ = writeln!(text, "| {trials} | {people} | {} |", names.join(" | "));
    let _ = writeln!(text, "|{}", "---:|".repeat(2 + names.len()));
    let share = |value: f64| format!("{} %", language.fixed(100.0 * value, 1));
    let number =
        |value: Option<f64>| value.map_or_else(|| "–".to_owned(), |value| language.fixed(value, 3));
    for point in points {
        let cells = match tells {
            Told::Thresholds => {
                vec![number(point.width), number(point.error), share(point.told)]
            }
            Told::Scale => vec![number(point.width), share(point.told)],
            Told::Images => {
                let falsely = point.falsely.map_or_else(|| "–".to_owned(), share);
                vec![share(point.told), falsely]
            }
        };
        let (trials, people) = (point.trials, point.participants);
        let _ = writeln!(text, "| {trials} | {people} | {} |", cells.join(" | "));
    }
    text.push('\n');
}
