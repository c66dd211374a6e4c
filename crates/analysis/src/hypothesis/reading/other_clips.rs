//! What is said of other clips.

use mimique_locale::Language;
use mimique_stats::Outcome;

use super::{LEVEL, difference, numbers, unit};
use crate::hypothesis::other_clips::{
    ClipModel, ClipPair, DecidingTest, LinearClipModel, LinearClipPair, OtherClips,
};
use crate::naming::Naming;
use crate::trials::measure::MeasureKind;

/// Most pairs that a reading names.
const PAIRS: usize = 3;

/// Whether the difference holds for other clips, by the linear mixed model, and by the other tests.
pub(crate) fn other_clips(
    naming: &Naming<'_>,
    found: &OtherClips,
    kind: MeasureKind,
    factors: &[String],
) -> String {
    let language = naming.language;
    let mut sentences = vec![language.pick(
        if found.decides {
            "For other clips, which decides this hypothesis:"
        } else {
            "The tests before this take the clips as they are. For other clips:"
        },
        if found.decides {
            "Pour d’autres extraits, ce qui décide de cette hypothèse :"
        } else {
            "Les tests qui précèdent prennent les extraits tels qu’ils sont. Pour d’autres extraits :"
        },
    )
    .to_owned()];
    match &found.linear_model {
        Some(Outcome::Ok(model)) => sentences.extend(linear(naming, model, kind, factors)),
        None => {}
        Some(Outcome::Undefined { reason }) => {
            let reason = reason.words(language);
            sentences.push(language.pick(
                format!("the linear mixed model gives no p ({reason})."),
                format!("le modèle linéaire mixte ne donne pas de p ({reason})."),
            ));
            if let (true, Some(DecidingTest::MinF(_))) = (found.decides, found.deciding_test()) {
                let words = language.pick("Min F' decides instead.", "Min F' décide à sa place.");
                sentences.push(words.to_owned());
            }
        }
    }
    sentences.extend(found.min_f.as_ref().map(|min_f| match min_f {
        Outcome::Ok(line) => format!("{}.", numbers(language, line)),
        Outcome::Undefined { reason } => {
            let reason = reason.words(language);
            language.pick(
                format!("Min F' is undefined ({reason})."),
                format!("Min F' n’est pas défini ({reason})."),
            )
        }
    }));
    if let Some(Outcome::Ok(model)) = &found.mixed_model {
        let factor = factors.first().map_or("", String::as_str);
        sentences.extend(
            model
                .pairs
                .first()
                .filter(|_| model.pairs.len() == 1)
                .map(|pair| odds(naming, model, pair, factor)),
        );
    }
    sentences.join(" ")
}

fn linear(
    naming: &Naming<'_>,
    model: &LinearClipModel,
    kind: MeasureKind,
    factors: &[String],
) -> Vec<String> {
    let language = naming.language;
    let numbers = format!("{}, {}", f_of(language, model), language.p(model.p));
    let name = match kind {
        MeasureKind::Choice => {
            language.pick("linear model of choices", "modèle linéaire des choix")
        }
        _ => language.pick("linear mixed model", "modèle linéaire mixte"),
    };
    let factor = factors.first().map_or("", String::as_str);
    let mut sentences = vec![match (factors, model.p < LEVEL) {
        ([a, b, ..], true) => language.pick(
            format!("by the linear mixed model the effect of {} depends on {} ({numbers}).", naming.factor(a), naming.factor(b)),
            format!("selon le modèle linéaire mixte, l’effet du facteur {} dépend du facteur {} ({numbers}).", naming.factor(a), naming.factor(b)),
        ),
        ([a, b, ..], false) => language.pick(
            format!("that the effect of {} depends on {} was not shown by the linear mixed model ({numbers}); that is no proof that it does not.", naming.factor(a), naming.factor(b)),
            format!("que l’effet du facteur {} dépende du facteur {} n’a pas été montré par le modèle linéaire mixte ({numbers}) ; cela ne prouve pas qu’il n’en dépend pas.", naming.factor(a), naming.factor(b)),
        ),
        (_, true) => language.pick(
            format!("by the {name} the levels of {} differ ({numbers}).", naming.factor(factor)),
            format!("selon le {name}, les niveaux du facteur {} diffèrent ({numbers}).", naming.factor(factor)),
        ),
        (_, false) => language.pick(
            format!("the {name} has shown no effect of {} ({numbers}); that is no proof that there is none.", naming.factor(factor)),
            format!("le {name} n’a montré aucun effet du facteur {} ({numbers}) ; cela ne prouve pas qu’il n’y en a pas.", naming.factor(factor)),
        ),
    }];
    // More pairs stand in the table of tests.
    for pair in model.pairs.iter().filter(|_| model.pairs.len() <= PAIRS) {
        let number = |value: f64| difference(language, kind, value);
        let p = match model.pairs.len() {
            1 => String::new(),
            _ => format!(", {} (Holm)", language.p(pair.p_corrected)),
        };
        if kind == MeasureKind::Choice {
            sentences.push(chosen_over(naming, pair, factor, &p));
            continue;
        }
        let [low, high] = pair.interval_95.map(number);
        let names = naming.pair(factor, &pair.a, &pair.b);
        let (estimate, unit) = (number(pair.difference), unit(language, kind));
        sentences.push(language.pick(
            format!("{names}: {estimate}{unit} [{low}; {high}]{p}."),
            format!("{names} : {estimate}{unit} [{low} ; {high}]{p}."),
        ));
    }
    sentences
}

/// `Box over LSTS: chosen in 62 % [54; 70].`
fn chosen_over(naming: &Naming<'_>, pair: &LinearClipPair, factor: &str, p: &str) -> String {
    let language = naming.language;
    let [low, high] = pair.interval_95;
    let (more, less, share, [low, high]) = match pair.difference >= 0.0 {
        true => (&pair.a, &pair.b, pair.difference, [low, high]),
        false => (&pair.b, &pair.a, -pair.difference, [-high, -low]),
    };
    let [more, less] = [more, less].map(|level| naming.level(factor, level));
    let percent = |share: f64| language.fixed(100.0 * (0.5 + share), 0);
    let [share, low, high] = [share, low, high].map(percent);
    language.pick(
        format!("{more} over {less}: chosen in {share} % [{low}; {high}]{p}."),
        format!("{more} plutôt que {less} : choix dans {share} % [{low} ; {high}]{p}."),
    )
}

/// `F(1, 12.3) = 4.56`.
pub(crate) fn f_of(language: Language, model: &LinearClipModel) -> String {
    let (df, denominator) = (model.df, language.fixed(model.df_denominator, 1));
    let f = language.fixed(model.f, 2);
    language.pick(format!("F({df}, {denominator}) = {f}"), format!("F({df} ; {denominator}) = {f}"))
}

/// The odds of a higher rating in the cumulative model, of the level with the higher ratings.
fn odds(naming: &Naming<'_>, model: &ClipModel, pair: &ClipPair, factor: &str) -> String {
    let language = naming.language;
    let (low, high, odds, [least, most], share) = if pair.odds_ratio >= 1.0 {
        (&pair.a, &pair.b, pair.odds_ratio, pair.interval_95, pair.higher)
    } else {
        let [least, most] = pair.interval_95;
        (&pair.b, &pair.a, 1.0 / pair.odds_ratio, [1.0 / most, 1.0 / least], 1.0 - pair.higher)
    };
    let (low, high) = (naming.level(factor, low), naming.level(factor, high));
    let [odds, least, most] = [odds, least, most].map(|value| language.fixed(value, 1));
    let share = language.percent(share);
    let p = language.p(model.p);
    language.pick(
        format!("In steps of the scale (cumulative mixed model, {p}): {high} against {low}: odds of a higher rating {odds} times ({least} to {most}); {high} is the higher of two in {share} on the model’s latent scale."),
        format!("En échelons (modèle mixte cumulatif, {p}) : {high} par rapport à {low} : chances d’une note plus haute multipliées par {odds} ({least} à {most}) ; {high} est la plus haute de deux notes dans {share} des cas sur l’échelle latente du modèle."),
    )
}
