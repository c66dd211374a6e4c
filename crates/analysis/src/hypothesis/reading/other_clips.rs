//! What is said of other clips.

use mimique_stats::Outcome;

use super::{LEVEL, numbers};
use crate::hypothesis::other_clips::{ClipModel, OtherClips};
use crate::naming::Naming;

/// Whether the difference holds for other clips, by the mixed model, with min F' beside it.
pub(crate) fn other_clips(naming: &Naming<'_>, found: &OtherClips, factor: &str) -> String {
    let language = naming.language;
    let mut sentences = vec![language.pick(
        if found.decides {
            "Other clips too, which decides this hypothesis:"
        } else {
            "The tests before this take the clips as they are. Other clips too:"
        },
        if found.decides {
            "D’autres extraits aussi, ce qui décide de cette hypothèse :"
        } else {
            "Les tests qui précèdent prennent les extraits tels qu’ils sont. D’autres extraits aussi :"
        },
    )
    .to_owned()];
    match &found.mixed_model {
        Some(Outcome::Ok(model)) => sentences.extend(of_model(naming, model, factor)),
        None => {}
        Some(Outcome::Undefined { reason }) => {
            let reason = reason.words(language);
            sentences.push(language.pick(
                format!("the mixed model gives no p ({reason})."),
                format!("le modèle mixte ne donne pas de p ({reason})."),
            ));
        }
    }
    sentences.push(match &found.min_f {
        Outcome::Ok(line) => format!("{}.", numbers(language, line)),
        Outcome::Undefined { reason } => {
            let reason = reason.words(language);
            language.pick(
                format!("Min F' is undefined ({reason})."),
                format!("Min F' n’est pas défini ({reason})."),
            )
        }
    });
    sentences.join(" ")
}

fn of_model(naming: &Naming<'_>, model: &ClipModel, factor: &str) -> Vec<String> {
    let language = naming.language;
    let shown = naming.factor(factor);
    let numbers = format!(
        "χ²({}) = {}, {}",
        model.df,
        language.number(model.likelihood_ratio),
        language.p(model.p)
    );
    let mut sentences = vec![if model.p < LEVEL {
        language.pick(
            format!("by the mixed model the levels of {shown} differ ({numbers})."),
            format!("selon le modèle mixte les niveaux du facteur {shown} diffèrent ({numbers})."),
        )
    } else {
        language.pick(
            format!("the mixed model has shown no effect of {shown} ({numbers}); that is no proof that there is none."),
            format!("le modèle mixte n’a montré aucun effet du facteur {shown} ({numbers}) ; cela ne prouve pas qu’il n’y en a pas."),
        )
    }];
    // The odds of several pairs stand in the table of tests.
    if let [pair] = model.pairs.as_slice() {
        // The level that stands higher is told of the other one.
        let (low, high, odds, [least, most], share) = if pair.odds_ratio >= 1.0 {
            (&pair.a, &pair.b, pair.odds_ratio, pair.interval_95, pair.higher)
        } else {
            let [least, most] = pair.interval_95;
            (&pair.b, &pair.a, 1.0 / pair.odds_ratio, [1.0 / most, 1.0 / least], 1.0 - pair.higher)
        };
        let (low, high) = (naming.level(factor, low), naming.level(factor, high));
        let [odds, least, most] = [odds, least, most].map(|value| language.fixed(value, 1));
        let share = language.percent(share);
        let p = language.p(pair.p_corrected);
        sentences.push(language.pick(
            format!("{high} against {low}: odds of a higher rating {odds} times ({least} to {most}), {p}; {high} is the higher of two in {share}."),
            format!("{high} par rapport à {low} : chances d’une note plus haute multipliées par {odds} ({least} à {most}), {p} ; {high} est la plus haute de deux notes dans {share} des cas."),
        ));
    }
    for term in &model.at_zero {
        sentences.push(language.pick(
            format!("The standard deviation of {term} is 0, a bound."),
            format!("L’écart type de {term} est 0, une borne."),
        ));
    }
    sentences
}
