//! Results in plain words. Only tests on one value a person are read; a trial-level p is never taken
//! for more than a number.

mod decision;
mod detection;
mod distribution;
mod effect_size;
mod equivalence;
mod matching;
mod other_clips;
mod pairs;
mod sensitivity;
mod versions;

use mimique_locale::Language;
use mimique_stats::{Outcome, Term};

use crate::hypothesis::HypothesisResult;
use crate::hypothesis::call::Design;
use crate::hypothesis::comparison::Comparison;
use crate::hypothesis::person_level::PersonLevel;
use crate::hypothesis::test_line::{TestLine, Unit};
use crate::hypothesis::undefined::TestOutcome;
use crate::naming::Naming;
use crate::naming::people_counted;
use crate::trials::measure::MeasureKind;
pub(crate) use decision::{deciding_p, decision_in_words, decision_of, mark, supports};
pub(crate) use detection::d_prime_by;
pub(crate) use distribution::distribution;
pub(crate) use effect_size::{effect_size, effect_size_number, effect_sizes, without_zero};
pub(crate) use equivalence::{
    equivalence, equivalence_by_model, equivalence_for_other_clips, equivalence_t, verdict,
};
pub(crate) use matching::{unequal_exclusion, unmatched};
pub(crate) use other_clips::{f_of, other_clips};
use pairs::{each_pair, many_pairs, topic};
pub(crate) use sensitivity::{dependence, influence, test_choice, test_choice_short, verdict_of};
pub(crate) use versions::other_version;

/// The level of a test.
pub(crate) const LEVEL: f64 = 0.05;

/// What a comparison within people says.
pub(crate) fn comparison(naming: &Naming<'_>, result: &Comparison, label: &str) -> String {
    person_level(naming, &result.recommended, result.kind, &result.factor, label)
}

/// What tests on one value a person say.
pub(crate) fn person_level(
    naming: &Naming<'_>,
    result: &PersonLevel,
    kind: MeasureKind,
    factor: &str,
    label: &str,
) -> String {
    let language = naming.language;
    let mut sentences = Vec::new();
    if result.people > 0 && result.incomplete * 4 > result.people {
        sentences.push(language.pick(
            format!("{} people could be used; {} have no trial at some level and could not.", result.people, result.incomplete),
            format!("{} personnes ont pu être utilisées ; {} n’ont pas d’essai à certains niveaux et n’ont pu l’être.", result.people, result.incomplete),
        ));
    }
    for overall in &result.overall {
        sentences.push(overall_sentence(naming, overall, kind, factor, label));
    }
    if result.pairs.len() <= 3 {
        // The overall test has named the question.
        let label = result.overall.is_empty().then_some(label);
        sentences.extend(each_pair(naming, &result.pairs, kind, factor, label));
    } else {
        sentences.extend(many_pairs(naming, &result.pairs, kind, factor));
    }
    sentences.join(" ")
}

/// A difference in the unit that people read: points of percent, seconds, points of the scale.
pub(crate) fn difference(language: Language, kind: MeasureKind, value: f64) -> String {
    match kind {
        MeasureKind::Recognition => language.fixed(value * 100.0, 1),
        MeasureKind::ResponseTime | MeasureKind::Rating | MeasureKind::Choice => {
            language.fixed(value, 2)
        }
    }
}

/// That unit.
fn unit(language: Language, kind: MeasureKind) -> &'static str {
    match kind {
        MeasureKind::Recognition => language.pick(" percentage points", " points de pourcentage"),
        MeasureKind::ResponseTime => " s",
        MeasureKind::Rating | MeasureKind::Choice => "",
    }
}

fn overall_sentence(
    naming: &Naming<'_>,
    outcome: &TestOutcome,
    kind: MeasureKind,
    factor: &str,
    label: &str,
) -> String {
    let language = naming.language;
    let topic = topic(language, kind, label);
    let line = match outcome {
        Outcome::Undefined { reason } => {
            let reason = reason.words(language);
            return language.pick(
                format!("“{label}”: no test is defined ({reason})."),
                format!("« {label} » : aucun test n’est défini ({reason})."),
            );
        }
        Outcome::Ok(line) => line,
    };
    let interaction = match &line.row.term {
        Term::Effect(factors) => match factors.as_slice() {
            [first, second, ..] => Some((first, second)),
            _ => None,
        },
        _ => None,
    };
    let what = compared(naming, factor, &line.row.term);
    let numbers = numbers(language, line);
    let significant = line.p_that_counts() < LEVEL;
    if interaction.is_some() && line.call.design != Design::Combinations {
        return acting_together(language, line, [&topic, &what], &numbers, significant);
    }
    if significant {
        if interaction.is_some() {
            return language.pick(
                format!("{topic}, the two factors seem to act together ({what}): {numbers}: a hint, to be checked."),
                format!("{topic}, les deux facteurs semblent agir ensemble ({what}) : {numbers} : un indice, à vérifier."),
            );
        }
        return language.pick(
            format!(
                "{topic}, the levels of {what} differ: {numbers}, {}.",
                people_counted(language, line.row.n)
            ),
            format!(
                "{topic}, les niveaux du facteur {what} diffèrent : {numbers}, {} personnes.",
                line.row.n
            ),
        );
    }
    if let Some((first, second)) = interaction {
        let (first, second) = (naming.factor(first), naming.factor(second));
        return language.pick(
            format!("{topic}, that the effect of {first} depends on {second} was not shown: {numbers}, {}; that is no proof that it does not.", people_counted(language, line.row.n)),
            format!("{topic}, que l’effet du facteur {first} dépende du facteur {second} n’a pas été montré : {numbers}, {} ; cela ne prouve pas qu’il n’en dépend pas.", people_counted(language, line.row.n)),
        );
    }
    language.pick(
        format!("{topic}, no effect of {what} was shown: {numbers}, {}; that is no proof that there is none.", people_counted(language, line.row.n)),
        format!("{topic}, aucun effet du facteur {what} n’a été montré : {numbers}, {} ; cela ne prouve pas qu’il n’y en a pas.", people_counted(language, line.row.n)),
    )
}

/// What a test compares.
fn compared(naming: &Naming<'_>, factor: &str, term: &Term) -> String {
    match term {
        Term::Whole => naming.factor(factor),
        pair @ Term::Pair(_) => format!("{} ({pair})", naming.factor(factor)),
        Term::Effect(factors) => naming.interaction(factors),
        term @ (Term::Differences(_) | Term::Relation(_)) => term.to_string(),
    }
}

/// Statistic, p and effect of a test.
fn numbers(language: Language, line: &TestLine) -> String {
    format!(
        "{}{} = {}, {}, {} = {}",
        line.names.statistic,
        line.degrees_in_brackets(),
        language.number(line.row.statistic),
        language.p(line.p_that_counts()),
        line.names.effect_symbol,
        line.row.effect.map_or_else(|| "–".to_owned(), |effect| language.fixed(effect, 2))
    )
}

/// Whether two factors act together, one of which at least is about people.
fn acting_together(
    language: Language,
    line: &TestLine,
    [topic, what]: [&str; 2],
    numbers: &str,
    significant: bool,
) -> String {
    let test = line.names.test;
    let how = match &line.unit {
        Unit::DifferencesOfPeople(pair) => language.pick(
            format!("{test} of each person’s difference {pair}, the smallest p of all pairs of levels after Holm’s correction: {numbers}, {}", people_counted(language, line.row.n)),
            format!("{test} sur la différence {pair} de chaque personne, le plus petit p de toutes les paires de niveaux après correction de Holm : {numbers}, {}", people_counted(language, line.row.n)),
        ),
        _ => language.pick(
            format!("{test} on one mean a person: {numbers}, {}", people_counted(language, line.row.n)),
            format!("{test} sur une moyenne par personne : {numbers}, {}", people_counted(language, line.row.n)),
        ),
    };
    if significant {
        language.pick(
            format!("{topic}, the two factors act together ({what}). {how}."),
            format!("{topic}, les deux facteurs agissent ensemble ({what}). {how}."),
        )
    } else {
        language.pick(
            format!("{topic}, that the two factors act together ({what}) was not shown. {how}; that is no proof that they do not."),
            format!("{topic}, que les deux facteurs agissent ensemble ({what}) n’a pas été montré. {how} ; cela ne prouve pas qu’ils ne le font pas."),
        )
    }
}

/// What the correction for all hypotheses of the study leaves of one; what follows it is without that correction.
pub(crate) fn over_hypotheses(
    language: Language,
    result: &HypothesisResult,
    tested: usize,
) -> String {
    let corrected = deciding_p(language, result).join(", ");
    let words = decision_of(language, result);
    language.pick(
        format!("Corrected for the {tested} hypotheses of this study: {words}, {corrected}; this p decides. Before that correction:"),
        format!("Après correction pour les {tested} hypothèses de cette étude : {words}, {corrected} ; c’est ce p qui décide. Avant cette correction :"),
    )
}

/// Trials of a method that does not have a parameter take no part in a comparison of its values.
pub(crate) fn trials_without_level(language: Language, trials: usize) -> String {
    let trials = language.counted(trials, ["trial", "trials"], ["essai", "essais"]);
    language.pick(
        format!("Without a value of the factor (their method has no such parameter), and left out here: {trials}."),
        format!("Sans valeur du facteur (leur méthode n’a pas ce paramètre), et écartés ici : {trials}."),
    )
}

/// Said wherever trial-level tests stand.
pub(crate) fn trial_level_caution(language: Language) -> &'static str {
    language.pick(
        "The columns “as in the thesis” treat every trial as if it came from another person, although each person answered many. Their p counts one opinion several times: it is printed for comparison with the thesis and supports no conclusion here.",
        "Les colonnes « comme dans la thèse » traitent chaque essai comme s’il venait d’une autre personne, alors que chacune en a fait plusieurs. Leur p compte une même opinion plusieurs fois : il est imprimé pour comparaison avec la thèse et n’autorise ici aucune conclusion.",
    )
}

/// Said wherever interactions are tested by ranks.
pub(crate) fn interaction_caution(language: Language) -> &'static str {
    language.pick(
        "Of these clips, interactions of factors of the clips are tested by the aligned rank transform, which is not reliable on ratings of few steps: where clips differ by chance, it finds an interaction that is none far more often than in 5 % of studies. Take what it shows for a hint. The linear mixed model decides unless a hypothesis is about these clips.",
        "Pour ces extraits, les interactions de facteurs des extraits sont testées par la transformation des rangs alignés, qui n’est pas fiable sur des notes à peu d’échelons : là où des extraits diffèrent par hasard, elle trouve une interaction qui n’en est pas bien plus souvent que dans 5 % des études. Prenez ce qu’elle montre pour un indice. Le modèle linéaire mixte décide, sauf si une hypothèse porte sur ces extraits.",
    )
}

/// Said where differences are not shown.
pub(crate) fn no_proof(language: Language) -> &'static str {
    language.pick(
        "Where nothing was shown, that is no proof that there is nothing; the interval says how large it may be.",
        "Là où rien n’a été montré, cela ne prouve pas qu’il n’y a rien ; l’intervalle dit quelle taille cela peut avoir.",
    )
}

/// Said wherever tests of person means stand.
pub(crate) fn these_clips_caution(language: Language) -> &'static str {
    language.pick(
        "The columns “recommended, of these clips” take the clips as they are. Where clips differ by chance beyond their method, such tests find differences that other clips would not show, the more people there are the more often: with 80 people an interaction that is none in about 21 % of studies. The linear mixed model takes people and clips as drawn at random; it decides unless a hypothesis is about these clips.",
        "Les colonnes « recommandé, pour ces extraits » prennent les extraits tels qu’ils sont. Là où des extraits diffèrent par hasard au-delà de leur méthode, ces tests trouvent des différences que d’autres extraits ne montreraient pas, d’autant plus souvent qu’il y a de personnes : avec 80 personnes, une interaction qui n’en est pas dans environ 21 % des études. Le modèle linéaire mixte prend personnes et extraits comme tirés au hasard ; il décide, sauf si une hypothèse porte sur ces extraits.",
    )
}
