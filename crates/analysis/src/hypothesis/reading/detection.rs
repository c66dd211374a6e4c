//! d' by the levels of a factor in plain words.

use super::LEVEL;
use super::pairs::oriented;
use crate::hypothesis::person_level::{Pair, PersonLevel};
use crate::hypothesis::test_line::OutcomeP as _;
use crate::naming::Naming;

/// For which categories d' differs between levels, for which no difference was shown, and for which none could be:
/// each with its tests on one value per person.
pub(crate) fn d_prime_by(
    naming: &Naming<'_>,
    factor: &str,
    categories: &[(String, &PersonLevel)],
) -> String {
    let language = naming.language;
    let p_of = |pair: &Pair| pair.wilcoxon.p_that_counts();
    let (mut differ, mut unshown, mut untold) = (Vec::new(), Vec::new(), Vec::new());
    for (category, tests) in categories {
        let shown: Vec<String> = tests
            .pairs
            .iter()
            .filter_map(|pair| {
                let p = p_of(pair).filter(|p| *p < LEVEL)?;
                let (high, low, by) = oriented(pair);
                let [high, low] = [high, low].map(|level| naming.level(factor, level));
                let (by, p) = (language.fixed(by?, 2), language.p(p));
                Some(language.pick(
                    format!("{high} over {low} by {by}, {p}"),
                    format!("{high} au-dessus de {low} de {by}, {p}"),
                ))
            })
            .collect();
        // p of too few people cannot fall to the level of the test.
        let can_be_told = |pair: &Pair| p_of(pair).is_some() && pair.least_p <= LEVEL;
        if !shown.is_empty() {
            differ.push(format!("{category} ({})", shown.join("; ")));
        } else if tests.pairs.iter().any(can_be_told) {
            unshown.push(category.as_str());
        } else {
            untold.push(category.as_str());
        }
    }
    let shown = naming.factor(factor);
    let mut sentences = Vec::new();
    if !differ.is_empty() {
        let differ = differ.join(", ");
        sentences.push(language.pick(
            format!("d′, one value per person, differs between levels of {shown} for {differ}."),
            format!("d′, une valeur par personne, diffère entre les niveaux du facteur {shown} pour {differ}."),
        ));
    }
    if !unshown.is_empty() {
        let unshown = unshown.join(", ");
        sentences.push(language.pick(
            format!("For {unshown} no difference of d′ by {shown} was shown; that is no proof that there is none."),
            format!("Pour {unshown}, aucune différence de d′ selon le facteur {shown} n’a été montrée ; cela ne prouve pas qu’il n’y en a pas."),
        ));
    }
    if !untold.is_empty() {
        let untold = untold.join(", ");
        sentences.push(language.pick(
            format!("For {untold} people are too few, or do not differ at all: nothing can be shown."),
            format!("Pour {untold}, les personnes sont trop peu nombreuses ou ne diffèrent en rien : rien ne peut être montré."),
        ));
    }
    sentences.join(" ")
}
