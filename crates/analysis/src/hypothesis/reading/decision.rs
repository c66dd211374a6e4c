//! What a hypothesis comes to, in two or three words.

use mimique_locale::Language;

use super::verdict;
use crate::hypothesis::decision::{
    Decision, Sought, Supports, deciding_p_values, decision as decided,
};
use crate::hypothesis::{ClipScope, HypothesisResult};

/// A shape that says the same as the words, without colour: filled where something was shown.
pub(crate) fn mark(decision: Decision) -> &'static str {
    use mimique_stats::EquivalenceVerdict as Verdict;
    match decision {
        Decision::Shown(_) | Decision::Equivalence(Verdict::Different) => "●",
        Decision::Equivalence(Verdict::Equivalent) => "■",
        Decision::Equivalence(Verdict::DifferentButSmall) => "◐",
        Decision::NotShown(_) | Decision::Equivalence(Verdict::Undecided) => "○",
        Decision::NotTested | Decision::NotForOtherClips => "–",
    }
}

/// What a p supports, in brackets behind it; nothing where there is one test.
pub(crate) fn supports(language: Language, supports: Supports) -> &'static str {
    match supports {
        Supports::TheDecision => "",
        Supports::Equivalence => language.pick(" (equivalence)", " (équivalence)"),
        Supports::Difference => language.pick(" (difference)", " (différence)"),
    }
}

/// The p values on which a decision rests.
pub(crate) fn deciding_p(language: Language, result: &HypothesisResult) -> Vec<String> {
    let values = deciding_p_values(result).into_iter();
    values.map(|(of, p)| format!("{}{}", language.p(p), supports(language, of))).collect()
}

/// The decision in words.
pub(crate) fn decision_in_words(language: Language, decision: Decision) -> &'static str {
    match decision {
        Decision::Shown(Sought::Difference) => language.pick(
            "null hypothesis of no difference rejected",
            "hypothèse nulle d’absence de différence rejetée",
        ),
        Decision::NotShown(Sought::Difference) => language.pick(
            "null hypothesis of no difference not rejected",
            "hypothèse nulle d’absence de différence non rejetée",
        ),
        Decision::Shown(Sought::Interaction) => language.pick(
            "null hypothesis of no interaction rejected",
            "hypothèse nulle d’absence d’interaction rejetée",
        ),
        Decision::NotShown(Sought::Interaction) => language.pick(
            "null hypothesis of no interaction not rejected",
            "hypothèse nulle d’absence d’interaction non rejetée",
        ),
        Decision::Shown(Sought::Relation) => language.pick(
            "null hypothesis of no correlation rejected",
            "hypothèse nulle d’absence de corrélation rejetée",
        ),
        Decision::NotShown(Sought::Relation) => language.pick(
            "null hypothesis of no correlation not rejected",
            "hypothèse nulle d’absence de corrélation non rejetée",
        ),
        Decision::Equivalence(found) => verdict(language, found),
        Decision::NotTested => language.pick("not tested", "non testée"),
        Decision::NotForOtherClips => {
            language.pick("not decided for other clips", "non décidée pour d’autres extraits")
        }
    }
}

/// The decision of a hypothesis, and of which clips it is where these are not others, too.
pub(crate) fn decision_of(language: Language, result: &HypothesisResult) -> String {
    let found = decided(result);
    let words = decision_in_words(language, found);
    match (result.scope, found) {
        (ClipScope::These, found) if found != Decision::NotTested => {
            format!("{words}{}", language.pick(", for these clips", ", pour ces extraits"))
        }
        _ => words.to_owned(),
    }
}
