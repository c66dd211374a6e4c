//! A mixed model: its shares of each rating beside those of the answers, and the standard deviations of its random
//! effects.

use mimique_locale::Language;
use mimique_report::document::{DataTable, Figure};
use mimique_report::figure::{LEFT, RIGHT};
use mimique_report::svg::{Anchor, Axis, Svg, clipped};
use mimique_stats::MixedShares;

use crate::report::figure::stacked::{answer_key, stacked_bar};

/// Left edge beside the names of random terms, which are long.
const NAMES: f64 = 146.0;

/// Two stacked bars for each level: of the model, and of the answers.
pub(crate) fn model_shares(
    language: Language,
    id: &str,
    caption: &str,
    ratings: &[f64],
    levels: &[(String, &MixedShares)],
) -> Figure {
    let (top, heading, height, gap) = (44.0, 20.0, 22.0, 4.0);
    let right = RIGHT - 16.0;
    let bottom = top + (heading + 2.0 * (height + gap)) * levels.len() as f64 + 4.0;
    let mut svg = Svg::new(caption, bottom + 40.0);
    let names: Vec<String> = ratings.iter().map(|rating| language.number(*rating)).collect();
    answer_key(&mut svg, language, &names, right);
    let axis = Axis::new(0.0, 1.0, LEFT, right);
    for &tick in &axis.ticks {
        let x = axis.place(tick);
        svg.line([x, top], [x, bottom], "rule");
        svg.text(x, bottom + 16.0, "small", Anchor::Middle, &language.percent(tick));
    }
    let title = language.pick("share of answers", "part des réponses");
    svg.text((LEFT + right) / 2.0, bottom + 34.0, "small", Anchor::Middle, title);
    let columns = language.pick(["level", "shares"], ["niveau", "parts"]).map(str::to_owned);
    let mut data = DataTable::new(id, caption, columns.into_iter().chain(names.iter().cloned()));
    let mut spoken = Vec::new();
    let mut y = top;
    for (label, own) in levels {
        svg.text(LEFT, y + 15.0, "strong", Anchor::Start, &clipped(label, 45));
        y += heading;
        let words = language.pick(["model", "observed"], ["modèle", "observées"]);
        for (word, shares) in words.into_iter().zip([&own.model, &own.observed]) {
            svg.text(LEFT - 10.0, y + height / 2.0 + 4.5, "", Anchor::End, word);
            stacked_bar(&mut svg, [LEFT, y, right - LEFT, height], shares, &names);
            let cells = shares.iter().map(|share| language.fixed(*share, 3));
            data.row([label.clone(), word.to_owned()].into_iter().chain(cells));
            y += height + gap;
        }
        if let (Some(share), Some(name)) = (own.model.last(), names.last()) {
            spoken.push(format!("{label} {name}: {}", language.percent(*share)));
        }
    }
    let spoken = spoken.join(", ");
    let alt = language.pick(
        format!("Two stacked bars for each level, of the model and of the answers. Share of the highest rating by the model: {spoken}."),
        format!("Deux barres empilées par niveau, du modèle et des réponses. Part de la note la plus haute selon le modèle : {spoken}."),
    );
    Figure { id: id.to_owned(), caption: caption.to_owned(), alt, svg: svg.finish(), data }
}

/// A horizontal bar for each random term.
pub(crate) fn deviations(
    language: Language,
    id: &str,
    caption: &str,
    terms: &[(String, f64)],
) -> Figure {
    let headings = language.pick(
        ["random effects", "standard deviation (log odds)"],
        ["effets aléatoires", "écart type (log des chances)"],
    );
    let (top, height, gap) = (14.0, 20.0, 12.0);
    let bottom = top + (height + gap) * terms.len() as f64;
    // Where all are 0 there is still an axis.
    let most = terms.iter().map(|(_, sd)| *sd).fold(0.1, f64::max);
    let axis = Axis::new(0.0, most, NAMES, RIGHT - 40.0);
    let mut svg = Svg::new(caption, bottom + 42.0);
    for &tick in &axis.ticks {
        let x = axis.place(tick);
        svg.line([x, top - 6.0], [x, bottom], "rule");
        let text = language.fixed(tick, axis.decimals);
        svg.text(x, bottom + 16.0, "small", Anchor::Middle, &text);
    }
    svg.text((NAMES + RIGHT) / 2.0, bottom + 34.0, "small", Anchor::Middle, headings[1]);
    let mut data = DataTable::new(id, caption, headings);
    let mut spoken = Vec::new();
    for (place, (name, sd)) in terms.iter().enumerate() {
        let y = top + (height + gap) * place as f64;
        let text = language.fixed(*sd, 2);
        svg.text(NAMES - 10.0, y + height / 2.0 + 4.5, "small", Anchor::End, &clipped(name, 22));
        svg.class_rect([NAMES, y, axis.place(*sd) - NAMES, height], "box");
        let beside = axis.place(*sd) + 6.0;
        svg.text(beside, y + height / 2.0 + 4.5, "strong", Anchor::Start, &text);
        spoken.push(format!("{name} {text}"));
        data.row([name.clone(), text]);
    }
    let spoken = spoken.join(", ");
    let alt = language.pick(
        format!("A bar for each kind of random effect, standard deviations in log odds: {spoken}."),
        format!(
            "Une barre par type d’effet aléatoire, écarts types en log des chances : {spoken}."
        ),
    );
    Figure { id: id.to_owned(), caption: caption.to_owned(), alt, svg: svg.finish(), data }
}
