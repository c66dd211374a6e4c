//! What the reader's scripts say; `{…}` stand for values.

use mimique_locale::Language;
use serde_json::json;

/// The words as JSON.
pub fn script_words(language: Language) -> String {
    let say = |english: &'static str, french: &'static str| language.pick(english, french);
    json!({
        "draw": say("Draw", "Dessiner"),
        "drawTrial": say("Draw trial {order} of {participant}: {stimulus}", "Dessiner l’essai {order} de {participant} : {stimulus}"),
        "drawn": say("{participant}, trial {order}: {stimulus}, as it was seen", "{participant}, essai {order} : {stimulus}, tel qu’il a été vu"),
        "allTrials": say("{count} trials", "{count} essais"),
        "someTrials": say("{shown} of {count} trials; choose a person or a clip", "{shown} essais sur {count} ; choisissez une personne ou un clip"),
        "otherVersion": say(
            "This session is of another version of the study ({hash}), whose clips are not in this capsule.",
            "Cette session est d’une autre version de l’étude ({hash}), dont les clips ne sont pas dans cette capsule.",
        ),
        "computing": say("Computing …", "Calcul en cours…"),
        "computed": say("Computed in this browser.", "Calculé dans ce navigateur."),
        "notComputed": say("Not computed: {problem}", "Pas de calcul : {problem}"),
        "hypothesis": say("Hypothesis", "Hypothèse"),
        "published": say("As published", "Publié"),
        "changed": say("Under these rules", "Avec ces règles"),
        "unchanged": say("the same", "identique"),
        "readings": say("Readings of the hypotheses", "Lectures des hypothèses"),
        "used": say(
            "{people} of {all} people and {trials} trials are used; as published {peopleBefore} people and {trialsBefore} trials.",
            "{people} personnes sur {all} et {trials} essais sont retenus ; publié : {peopleBefore} personnes et {trialsBefore} essais.",
        ),
        "save": say("Save:", "Enregistrer :"),
        "publishedReport": say("The report as it was published.", "Le rapport tel qu’il a été publié."),
        "changedReport": say("The report under the rules below, not as it was published.", "Le rapport avec les règles ci-dessous, non celui qui a été publié."),
    })
    .to_string()
}
