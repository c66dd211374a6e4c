//! Adaptive blocks in words: what is varied by which rule, and how thresholds are estimated.

use mimique_locale::Language;
use mimique_study::{AdaptiveComponent, LevelRule, Study};

use super::Text;

/// What is varied by the answers.
pub(super) fn design(text: &mut Text, study: &Study, language: Language) {
    for (name, block) in study.adaptive() {
        let AdaptiveComponent { vary, method, against, trials, tracks, .. } = &block;
        let (parameter, levels) = (&vary.parameter, vary.levels);
        let [from, to] = [vary.from, vary.to].map(|level| language.number(level));
        let [asked, catch] = match block.yes {
            None => language.pick(
                [
                    "the participant says which of the two clips is the varied one (guessing: one half)",
                    "at the easiest level",
                ],
                [
                    "le participant dit lequel des deux extraits est modifié (hasard : un sur deux)",
                    "au niveau le plus facile",
                ],
            ),
            Some(_) => language.pick(
                [
                    "the participant says whether the two clips differ (yes or no; guessing: none)",
                    "at the hardest level, which show how often people say yes without a difference",
                ],
                [
                    "le participant dit si les deux extraits diffèrent (oui ou non ; hasard : aucun)",
                    "au niveau le plus difficile, qui montrent combien de fois on dit oui sans différence",
                ],
            ),
        };
        let rule = rule(&block, language);
        let mixed = match tracks {
            1 => "",
            _ => language.pick(", mixed", ", mêlées"),
        };
        let tracks = language.counted(*tracks as usize, ["track", "tracks"], ["suite", "suites"]);
        let trials = language.counted(*trials as usize, ["trial", "trials"], ["essai", "essais"]);
        let catches = language.counted(
            block.catches(),
            ["catch trial", "catch trials"],
            ["essai piège", "essais pièges"],
        );
        text.line(&language.pick(
            format!("Adaptive block `{name}`: {parameter} of {method} takes one of {levels} levels from {from} to {to}, beside {against}, and {asked}. {tracks} of {trials} at most{mixed}, {rule}; {catches} {catch}; no track counts them. Levels are solved in the browser; the weights are held against those that were solved beforehand, and every level is chosen anew from seed and answers in the export (`level_replayed`, `weights_expected`)."),
            format!("Bloc adaptatif `{name}` : {parameter} de {method} prend l’un de {levels} niveaux de {from} à {to}, à côté de {against}, et {asked}. {tracks} de {trials} au plus{mixed}, {rule} ; {catches} {catch} ; aucune suite ne les compte. Les niveaux sont résolus dans le navigateur ; leurs poids sont comparés à ceux résolus d’avance, et chaque niveau est choisi à nouveau d’après la graine et les réponses dans l’export (`level_replayed`, `weights_expected`)."),
        ));
        text.line("");
    }
}

fn rule(block: &AdaptiveComponent, language: Language) -> String {
    let stop = block.stop_sd.map_or_else(String::new, |sd| {
        let sd = language.number(sd);
        language.pick(
            format!(", ended earlier once the threshold’s standard deviation is below {sd}, not before 20 trials"),
            format!(", arrêtées plus tôt dès que l’écart-type du seuil est inférieur à {sd}, pas avant 20 essais"),
        )
    });
    match &block.rule {
        LevelRule { quest_plus: Some(_), .. } => {
            let rule = language.pick("by QUEST+ (Watson 2017)", "par QUEST+ (Watson 2017)");
            format!("{rule}{stop}")
        }
        LevelRule { staircase: Some(rule), .. } => {
            let down = rule.down;
            language.pick(
                format!("by a staircase, {down} down 1 up (Levitt 1971)"),
                format!("par un escalier, {down} en bas 1 en haut (Levitt 1971)"),
            )
        }
        LevelRule { .. } => String::new(),
    }
}

/// How thresholds are estimated.
pub(super) fn analysis(text: &mut Text, study: &Study) {
    if study.adaptive().next().is_none() {
        return;
    }
    text.both(
        "Thresholds of adaptive blocks: a psychometric function for each person over the answers of all tracks, by maximum likelihood, its lapse from 0 to 0.2 with the prior Beta(1, 10); the threshold is the level at half of its rise. Its 95 % interval runs the adaptive rule 1000 times with answers of the fitted function. A threshold outside the levels is reported as above or below them and left out of the mean, for which a 95 % t interval over people is given. Slopes are not tested. People whose levels cannot be replayed from seed and answers are left out and named.",
        "Seuils des blocs adaptatifs : une fonction psychométrique par personne sur les réponses de toutes les suites, par maximum de vraisemblance, l’inattention de 0 à 0,2 avec la loi a priori Bêta(1, 10) ; le seuil est le niveau à mi-hauteur de sa montée. Son intervalle à 95 % rejoue 1000 fois la règle adaptative avec des réponses de la fonction ajustée. Un seuil hors des niveaux est rapporté comme au-dessus ou au-dessous d’eux et écarté de la moyenne, donnée avec un intervalle t à 95 % sur les personnes. Les pentes ne sont pas testées. Les personnes dont les niveaux ne se retrouvent pas d’après la graine et les réponses sont écartées et nommées.",
    );
}
