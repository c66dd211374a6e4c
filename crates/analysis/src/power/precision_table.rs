//! The precision of blocks as tables: CSV for scripts, markdown for people.

use std::fmt::Write as _;

use mimique_locale::Language;
use mimique_report::document::csv_text;

use super::{BlockPrecision, Estimand, Power};

/// One row a block, number of trials and number of people.
pub fn precision_csv(power: &Power) -> String {
    let head = [
        "block",
        "estimand",
        "trials",
        "participants",
        "runs",
        "width",
        "error",
        "found",
        "found_falsely",
    ];
    let rows = power.precision.iter().flat_map(|block| {
        block.points.iter().map(move |point| {
            let number =
                |value: Option<f64>| value.map_or_else(String::new, |it| format!("{it:.5}"));
            let estimand = match block.estimand {
                Estimand::Thresholds => "thresholds",
                Estimand::Scale => "scale",
                Estimand::Images => "images",
            };
            vec![
                block.block.clone(),
                estimand.to_owned(),
                point.trials.to_string(),
                point.participants.to_string(),
                block.runs.to_string(),
                number(point.width),
                number(point.error),
                number(Some(point.found)),
                number(point.found_falsely),
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
    let BlockPrecision { block: name, estimand, runs, points } = block;
    let what = language.pick(
        match estimand {
            Estimand::Thresholds => "width of the 95 % interval of the mean threshold (mean over studies), root mean square error of a person’s threshold, and the share of people whose threshold lies within the levels; trials are those of a track",
            Estimand::Scale => "width of a 95 % interval of ψ at the highest level (from its spread over studies), and the share of studies that have a scale",
            Estimand::Images => "share of the units of the faces in mind whose presence is found (corrected p of 0.05 or less), and share of the other pairs of unit and answer that are found as well",
        },
        match estimand {
            Estimand::Thresholds => "largeur de l’intervalle à 95 % du seuil moyen (moyenne sur les études), erreur quadratique moyenne du seuil d’une personne, et part des personnes dont le seuil est dans les niveaux\u{a0}; les essais sont ceux d’une piste",
            Estimand::Scale => "largeur d’un intervalle à 95 % de ψ au niveau le plus haut (d’après sa dispersion d’une étude à l’autre), et part des études qui ont une échelle",
            Estimand::Images => "part des unités des visages en tête dont la présence est trouvée (p corrigé de 0,05 au plus), et part des autres paires d’unité et de réponse trouvées aussi",
        },
    );
    let line = language.pick(
        format!("**{name}**: {what}; {runs} simulated studies per row."),
        format!("**{name}**\u{a0}: {what}\u{a0}; {runs} études simulées par ligne."),
    );
    let _ = writeln!(text, "{line}\n");
    let [trials, people] = language.pick(["trials", "people"], ["essais", "personnes"]);
    let names: &[&str] = language.pick(
        match estimand {
            Estimand::Thresholds => &["width", "error of a person", "within the levels"],
            Estimand::Scale => &["width", "with a scale"],
            Estimand::Images => &["found", "falsely found"],
        },
        match estimand {
            Estimand::Thresholds => &["largeur", "erreur d’une personne", "dans les niveaux"],
            Estimand::Scale => &["largeur", "avec une échelle"],
            Estimand::Images => &["trouvées", "trouvées à tort"],
        },
    );
    let _ = writeln!(text, "| {trials} | {people} | {} |", names.join(" | "));
    let _ = writeln!(text, "|{}", "---:|".repeat(2 + names.len()));
    let share = |value: f64| format!("{} %", language.fixed(100.0 * value, 1));
    let number =
        |value: Option<f64>| value.map_or_else(|| "–".to_owned(), |value| language.fixed(value, 3));
    for point in points {
        let cells = match estimand {
            Estimand::Thresholds => {
                vec![number(point.width), number(point.error), share(point.found)]
            }
            Estimand::Scale => vec![number(point.width), share(point.found)],
            Estimand::Images => {
                let falsely = point.found_falsely.map_or_else(|| "–".to_owned(), share);
                vec![share(point.found), falsely]
            }
        };
        let (trials, people) = (point.trials, point.participants);
        let _ = writeln!(text, "| {trials} | {people} | {} |", cells.join(" | "));
    }
    text.push('\n');
}
