//! Blocks of panels in words: which conditions stand on a page, and whom BS.1534 leaves out.

use mimique_locale::Language;
use mimique_study::{ClipShowing, Study};

use super::Text;
use crate::naming::Naming;

/// What stands on a page, how it is shown, and who is left out.
pub(super) fn design(text: &mut Text, study: &Study, language: Language, naming: &Naming<'_>) {
    let clips = study.clips();
    for (name, block) in study.panel_blocks() {
        let Ok(trials) = block.trials(&clips) else { continue };
        let level = |level: &String| naming.level(&block.compare, level);
        let conditions = block.conditions(&clips);
        let conditions: Vec<String> = conditions.iter().map(level).collect();
        let (compared, conditions) = (naming.factor(&block.compare), conditions.join(", "));
        let within: Vec<String> = block.within.iter().map(|factor| naming.factor(factor)).collect();
        let (within, pages) = (within.join(", "), trials.trial_count(&clips));
        let how = match block.show {
            ClipShowing::InStep => language.pick("in step", "en phase"),
            ClipShowing::InTurn => language.pick("one after the other", "l’un après l’autre"),
        };
        text.line(&language.pick(
            format!("Panels `{name}`: the clips of all levels of {compared} ({conditions}) that are alike in {within} stand on one page and are played {how}; each is rated on a scale from 0 to 100, {pages} pages in all. Places are drawn for each page and participant, and every clip is seen whole before an answer can be given."),
            format!("Panels `{name}` : les extraits de tous les niveaux de {compared} ({conditions}) ayant les mêmes valeurs de {within} sont sur une même page et joués {how} ; chacun est noté de 0 à 100, {pages} pages en tout. Les places sont tirées au sort pour chaque page et chaque participant, et chaque extrait est vu en entier avant toute réponse."),
        ));
        if let Some(reference) = &block.reference {
            let reference = level(reference);
            text.line(&language.pick(
                format!("{reference} is the reference: it stands on the page as such, and once more hidden among the others."),
                format!("{reference} est la référence : elle est sur la page en tant que telle, et une fois de plus cachée parmi les autres."),
            ));
        }
        if let Some(anchor) = &block.anchor {
            let anchor = level(anchor);
            text.line(
                &language
                    .pick(format!("{anchor} is the anchor."), format!("{anchor} est l’ancre.")),
            );
        }
        if block.exclude.is_some() {
            text.line(language.pick(
                "People are left out by ITU-R BS.1534-3 (section 4.1.2): those who rate the hidden reference below 90, or the anchor above 90, on more than 15 % of the pages; pages whose anchor over 25 % of people put above 90 do not count for the anchor.",
                "Des personnes sont écartées selon l’UIT-R BS.1534-3 (section 4.1.2) : celles qui notent la référence cachée au-dessous de 90, ou l’ancre au-dessus de 90, sur plus de 15 % des pages ; les pages dont plus de 25 % des personnes mettent l’ancre au-dessus de 90 ne comptent pas pour l’ancre.",
            ));
        }
        text.line("");
    }
}
