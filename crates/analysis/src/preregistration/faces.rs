//! Blocks of reverse correlation in words: what is drawn, and how images are made of the answers.

use mimique_locale::Language;
use mimique_study::Study;

use super::Text;
use crate::faces::{BINS, PERMUTATIONS};

/// What is drawn at random.
pub(super) fn design(text: &mut Text, study: &Study, language: Language) {
    for (name, block) in study.reverse_correlations() {
        let drawn = block.design();
        let (units, count, trials) = (block.units.join(", "), block.units.len(), block.trials);
        let number = |value: f64| language.number(value);
        let [low, high] = drawn.amplitude.map(number);
        let (mean, most) = (number(drawn.mean_units), drawn.most_units);
        let (lasts, least) = (number(drawn.duration_s), number(drawn.least_s));
        let [from, to] = drawn.bend.map(number);
        let asked = match &block.intensity {
            Some(intensity) => format!("`{}`, `{intensity}`", block.question),
            None => format!("`{}`", block.question),
        };
        text.line(&language.pick(
            format!("Block of dynamic reverse correlation `{name}`: {trials} trials of {lasts} s, in each of which one and a binomial number of further action units of {count} move the face ({mean} on average, {most} at most): {units}. Onset, peak and offset of each are uniform over all times that leave a rise and a fall of {least} s; the amplitude is uniform from {low} to {high}; half of the height is passed at a share from {from} to {to} of the rise, and of the fall. All is drawn from the study’s seed and the participant, and drawn again in the export (`trajectories`, `weights_expected`). Asked: {asked}."),
            format!("Bloc de corrélation inverse dynamique `{name}` : {trials} essais de {lasts} s, dans chacun desquels une unité d’action et un nombre binomial d’autres, parmi {count}, font bouger le visage ({mean} en moyenne, {most} au plus) : {units}. Le début, le sommet et la fin de chacune sont uniformes sur tous les moments qui laissent une montée et une descente de {least} s ; l’amplitude est uniforme de {low} à {high} ; la moitié de la hauteur est passée à une part de {from} à {to} de la montée, et de la descente. Tout est tiré de la graine de l’étude et du participant, et tiré à nouveau dans l’export (`trajectories`, `weights_expected`). Questions : {asked}."),
        ));
        text.line("");
    }
}

/// How images are made.
pub(super) fn analysis(text: &mut Text, study: &Study) {
    if study.reverse_correlations().next().is_none() {
        return;
    }
    let seed = study.seed;
    text.both(
        &format!("Images of reverse correlation: for each person, category, unit and each of {BINS} time bins the correlation of the unit’s activation with the answer, z = r √(N − 1), summed over people and divided by the root of their number. Each person’s answers are dealt anew over that person’s trials {PERMUTATIONS} times (seed {seed}); p is corrected over all units and times by the largest |z|, presence of a unit and slopes of intensity likewise over units; categories are not corrected for one another. Trials whose weights the seed does not give again are left out and counted."),
        &format!("Images de la corrélation inverse : pour chaque personne, catégorie, unité et chacun des {BINS} intervalles de temps, la corrélation de l’activation de l’unité avec la réponse, z = r √(N − 1), sommée sur les personnes et divisée par la racine de leur nombre. Les réponses de chaque personne sont redistribuées {PERMUTATIONS} fois sur ses essais (graine {seed}) ; p est corrigé sur toutes les unités et tous les moments par le plus grand |z|, de même la présence d’une unité et les pentes d’intensité sur les unités ; les catégories ne sont pas corrigées entre elles. Les essais dont la graine ne redonne pas les poids sont écartés et comptés."),
    );
}
