//! Hypotheses of equivalence in words: the tests, the smallest difference that matters, and why.

use mimique_locale::Language;
use mimique_stats::{EquivalenceOfGroups, EquivalenceOfPairs, TestResult as _};
use mimique_study::{Hypothesis, Study, TestName};

use super::Text;

/// The tests that decide.
pub(super) fn tests(language: Language, hypothesis: &Hypothesis, between_people: bool) -> String {
    let (names, beside) = match between_people {
        true => (
            EquivalenceOfGroups::NAMES,
            language.pick(
                "normal with corrections for ties and continuity; beside it Welch’s t",
                "approximation normale corrigée des ex æquo et de la continuité ; à côté, le t de Welch",
            ),
        ),
        false => (
            EquivalenceOfPairs::NAMES,
            language.pick(
                "exact and conditional on the observed ranks, zeros by Pratt; beside it the paired t",
                "exacts et conditionnels aux rangs observés, zéros selon Pratt ; à côté, le t apparié",
            ),
        ),
    };
    let name = names.in_words[language.pick(0, 1)];
    let least = language.number(hypothesis.smallest_effect.unwrap_or(f64::NAN));
    language.pick(
        format!("{name} on one mean a person, {beside}: whether the difference lies between −{least} and {least}; p is the larger of the two"),
        format!("{name} sur une moyenne par personne, {beside} : la différence est-elle entre −{least} et {least} ; p est le plus grand des deux"),
    )
}

/// The smallest difference that matters, with its reason, as a line below a hypothesis of equivalence.
pub(super) fn smallest_effect(text: &mut Text, language: Language, hypothesis: &Hypothesis) {
    let Some(least) = hypothesis.smallest_effect else { return };
    let least = language.number(least);
    let reason = match &hypothesis.smallest_effect_reason {
        Some(reason) => reason.in_language(language.code()).to_owned(),
        None => language.pick("no reason is given", "aucune raison n’est donnée").to_owned(),
    };
    text.line(&language.pick(
        format!("  - smallest difference that matters: {least}, because: {reason}"),
        format!("  - plus petite différence qui compte : {least}, car : {reason}"),
    ));
}

/// How verdicts are reached, where some hypothesis is of equivalence.
pub(super) fn criteria(text: &mut Text, study: &Study) {
    if study.hypotheses.iter().all(|hypothesis| hypothesis.test != TestName::Equivalence) {
        return;
    }
    text.both(
        "Equivalence is shown where both one-sided tests are significant, that is, where the 90 % interval (at α = 0.05) lies within the zone. The verdict is *equivalent* (equivalence shown, no difference shown), *different, but small* (both shown), *different* (a difference shown, equivalence not) or *undecided* (neither). The power of these hypotheses is that at a true difference of 0.",
        "L’équivalence est montrée si les deux tests unilatéraux sont significatifs, c’est-à-dire si l’intervalle à 90 % (à α = 0,05) est dans la zone. Le verdict est *équivalents* (équivalence montrée, pas de différence montrée), *différents, mais peu* (les deux montrées), *différents* (différence montrée, équivalence non) ou *indécis* (ni l’une ni l’autre). La puissance de ces hypothèses est celle d’une différence vraie de 0.",
    );
}
