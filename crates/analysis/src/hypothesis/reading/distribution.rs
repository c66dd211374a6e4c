//! Floor and ceiling effects and unequal spreads, named.

use mimique_locale::Language;

use crate::hypothesis::reading::{difference, unit};
use crate::naming::Naming;
use crate::trials::answer_distribution::AnswerDistribution;
use crate::trials::measure::MeasureKind;

/// What to mind about the distribution of the answers; `None` where there is nothing.
pub(crate) fn distribution(
    naming: &Naming<'_>,
    found: &AnswerDistribution,
    kind: MeasureKind,
) -> Option<String> {
    let language = naming.language;
    let mut sentences = Vec::new();
    if let Some((lowest, highest)) = found.scale {
        let floor = shares(naming, found, &found.floor());
        sentences.extend(floor.map(|levels| language.pick(
            format!("Floor effect: {levels} of the answers are at the lowest point of the scale, {lowest} (more than 15 %): the end of the scale may hide differences there."),
            format!("Effet plancher : {levels} des réponses sont au point le plus bas de l’échelle, {lowest} (plus de 15 %) : la fin de l’échelle peut y cacher des différences."),
        )));
        let ceiling = shares(naming, found, &found.ceiling());
        sentences.extend(ceiling.map(|levels| language.pick(
            format!("Ceiling effect: {levels} of the answers are at the highest point of the scale, {highest} (more than 15 %): the end of the scale may hide differences there."),
            format!("Effet plafond : {levels} des réponses sont au point le plus haut de l’échelle, {highest} (plus de 15 %) : la fin de l’échelle peut y cacher des différences."),
        )));
    }
    if let Some([(wide, largest), (narrow, smallest)]) = found.unequal_spreads() {
        let [wide, narrow] = [wide, narrow].map(|level| naming.level(&found.factor, level));
        let [most, least] = [largest, smallest]
            .map(|sd| format!("{}{}", difference(language, kind, sd), unit(language, kind)));
        sentences.push(language.pick(
            format!("Unequal spreads: the standard deviation of participants’ means is {most} at {wide} and {least} at {narrow}, more than twice as large; a significant rank test may then reflect spread as well as location."),
            format!("Dispersions inégales : l’écart type des moyennes des personnes est de {most} pour {wide} et de {least} pour {narrow}, plus du double ; un test de rangs significatif peut alors refléter la dispersion autant que la position."),
        ));
    }
    (!sentences.is_empty()).then(|| sentences.join(" "))
}

/// `at box 43 % and at lsts 22 %`; `None` without levels.
fn shares(
    naming: &Naming<'_>,
    found: &AnswerDistribution,
    levels: &[(&str, f64)],
) -> Option<String> {
    let language: Language = naming.language;
    let level = |(level, share): &(&str, f64)| {
        let (name, share) = (naming.level(&found.factor, level), language.percent(*share));
        language.pick(format!("at {name} {share}"), format!("pour {name}, {share}"))
    };
    let levels: Vec<String> = levels.iter().map(level).collect();
    (!levels.is_empty()).then(|| language.list(&levels))
}
