//! Blocks of pairs in words: what is compared, and which pairs each participant is shown.

use mimique_locale::Language;
use mimique_study::{ClipShowing, Study};

use super::Text;
use crate::naming::Naming;

/// What is compared with what, and how pairs are dealt.
pub(super) fn design(text: &mut Text, study: &Study, language: Language, naming: &Naming<'_>) {
    let clips = study.clips();
    for (name, block) in study.pair_blocks() {
        let Ok(trials) = block.trials(&clips) else { continue };
        let levels = block.compared(&clips);
        let levels: Vec<String> =
            levels.iter().map(|level| naming.level(&block.compare, level)).collect();
        let (compared, levels) = (naming.factor(&block.compare), levels.join(", "));
        let within: Vec<String> = block.within.iter().map(|factor| naming.factor(factor)).collect();
        let (within, all) = (within.join(", "), trials.shown(&clips).len());
        let each = trials.trial_count(&clips);
        let how = shown(language, block.show);
        let dealt = match each == all {
            true => language.pick(
                "Each participant is shown all of them.".to_owned(),
                "Chaque participant les voit toutes.".to_owned(),
            ),
            false => language.pick(
                format!("Each participant is shown {each} of them: over participants every pair equally often, and each participant every level equally often, both to within one."),
                format!("Chaque participant en voit {each} : sur l’ensemble des participants chaque paire aussi souvent, et pour chaque participant chaque niveau aussi souvent, à un près."),
            ),
        };
        let active = block.schedule.active();
        let dealt = match active {
            0 => dealt,
            _ => language.pick(
                format!("Each participant is shown {each} pairs. The first {} are dealt so that over participants every pair comes equally often, and to each participant every level, both to within one. The other {active} follow from answers: batches of the spanning tree of greatest expected information about the worths (Bradley and Terry’s model with normal worths of standard deviation 1), under all answers that the server has when a batch is drawn; the event `pairs_drawn` keeps their number and hash.", each - active),
                format!("Chaque participant voit {each} paires. Les {} premières sont distribuées de sorte que sur l’ensemble des participants chaque paire vienne aussi souvent, et pour chaque participant chaque niveau, à un près. Les {active} autres suivent des réponses : des lots formés par l’arbre couvrant de plus grande information attendue sur les valeurs (modèle de Bradley et Terry, valeurs normales d’écart-type 1), sous toutes les réponses que le serveur a reçues quand le lot est tiré ; l’événement `pairs_drawn` en garde le nombre et l’empreinte.", each - active),
            ),
        };
        text.line(&language.pick(
            format!("Paired comparisons `{name}`: each two levels of {compared} ({levels}) that are alike in {within} are shown {how}, {all} pairs in all. {dealt} Each level stands left in half of a participant’s trials, and each pair is shown in both orders equally often over participants."),
            format!("Comparaisons par paires `{name}` : les niveaux de {compared} ({levels}) sont montrés deux à deux pour les mêmes valeurs de {within}, {how}, {all} paires en tout. {dealt} Chaque niveau est à gauche dans la moitié des essais d’un participant, et chaque paire est montrée aussi souvent dans les deux ordres sur l’ensemble des participants."),
        ));
        text.line("");
    }
}

/// How two clips are shown.
pub(crate) fn shown(language: Language, how: ClipShowing) -> &'static str {
    match how {
        ClipShowing::InStep => language.pick("side by side, in step", "côte à côte, en phase"),
        ClipShowing::InTurn => language.pick(
            "side by side, the left one first, then the right one",
            "côte à côte, celui de gauche d’abord, puis celui de droite",
        ),
    }
}
