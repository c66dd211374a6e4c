//! Blocks of difference scaling in words: which levels are shown, and how the scale is estimated.

use mimique_locale::Language;
use mimique_study::{ScalingRule, Study};

use super::Text;
use crate::scaling::ROUNDS;

/// Which levels are shown.
pub(super) fn design(text: &mut Text, study: &Study, language: Language) {
    for (name, block) in study.scalings() {
        let levels: Vec<String> =
            block.levels.iter().map(|level| language.number(*level)).collect();
        let (levels, trials) = (levels.join(", "), block.trials);
        let (parameter, method, question) = (&block.parameter, &block.method, &block.question);
        let each = match block.rule {
            ScalingRule::Triads => language.pick("three", "trois"),
            ScalingRule::Quadruples => language.pick("four", "quatre"),
        };
        text.line(&language.pick(
            format!("Block of difference scaling `{name}`: {trials} trials, each of the same segment at {each} levels of {parameter} of {method} ({levels}), ascending or descending at random, in step. All sets of levels and segments are shown before one comes again. Asked: `{question}`, whether the first two or the last two differ more."),
            format!("Bloc de mise à l’échelle des différences `{name}` : {trials} essais, chacun du même segment à {each} niveaux de {parameter} de {method} ({levels}), en ordre croissant ou décroissant au hasard, en phase. Tous les ensembles de niveaux et de segments sont montrés avant qu’un ne revienne. Question : `{question}`, si les deux premiers ou les deux derniers diffèrent davantage."),
        ));
        text.line("");
    }
}

/// How the scale is estimated.
pub(super) fn analysis(text: &mut Text, study: &Study) {
    if study.scalings().next().is_none() {
        return;
    }
    let seed = study.seed;
    text.both(
        &format!("Scales of differences: maximum likelihood difference scaling (Maloney and Yang 2003) over all people, a probit of the difference of differences; the lowest level has 0, the unit is the standard deviation of a judgement. 95 % percentile intervals resample people {ROUNDS} times (seed {seed}). Where answers are separated there is no scale, which is said."),
        &format!("Échelles de différences : mise à l’échelle par maximum de vraisemblance (Maloney et Yang 2003) sur toutes les personnes, un probit de la différence des différences ; le niveau le plus bas vaut 0, l’unité est l’écart-type d’un jugement. Les intervalles à 95 % (percentiles) rééchantillonnent les personnes {ROUNDS} fois (graine {seed}). Si les réponses sont séparées, il n’y a pas d’échelle, ce qui est dit."),
    );
}
