//! Results in plain words. Only tests on one value a person are read; a trial-level p is never taken
//! for more than a number.

use mimique_stats::{Outcome, Term};

use crate::hypothesis::call::Design;
use crate::hypothesis::comparison::Comparison;
use crate::hypothesis::person_level::{Pair, PersonLevel};
use crate::hypothesis::test_line::{OutcomeP, TestLine, Unit};
use crate::language::Language;
use crate::language::naming::Naming;
use crate::trials::measure::MeasureKind;

/// The level of a test.
const LEVEL: f64 = 0.05;

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
        sentences.push(overall_sentence(naming, overall, factor, label));
    }
    if result.pairs.len() <= 3 {
        sentences.extend(each_pair(naming, &result.pairs, kind, factor, label));
    } else {
        sentences.extend(many_pairs(naming, &result.pairs, kind, factor));
    }
    sentences.join(" ")
}

/// A sentence on each pair.
fn each_pair(
    naming: &Naming<'_>,
    pairs: &[Pair],
    kind: MeasureKind,
    factor: &str,
    label: &str,
) -> Vec<String> {
    let language = naming.language;
    let mut sentences = Vec::new();
    let mut unshown = false;
    for (place, pair) in pairs.iter().enumerate() {
        // Named once; the sentences after it are about the same question.
        let topic = (place == 0).then(|| topic(language, kind, label));
        let (words, shown) = pair_sentence(naming, pair, kind, factor, topic, pairs.len());
        sentences.push(words);
        unshown |= !shown;
    }
    if unshown {
        sentences.push(language.pick(
            "Where no difference was shown, that is no proof that there is none; the interval says how large it may be.",
            "Là où aucune différence n’a été montrée, cela ne prouve pas qu’il n’y en a pas ; l’intervalle dit quelle taille elle peut avoir.",
        ).to_owned());
    }
    sentences
}

/// How many pairs differ, and which.
fn many_pairs(naming: &Naming<'_>, pairs: &[Pair], kind: MeasureKind, factor: &str) -> Vec<String> {
    let (language, tested) = (naming.language, pairs.len());
    let different: Vec<&Pair> = pairs
        .iter()
        .filter(|pair| pair.wilcoxon.p_that_counts().is_some_and(|p| p < LEVEL))
        .collect();
    if different.is_empty() {
        return vec![language.pick(
            format!("None of the {tested} pairs differs after Holm’s correction."),
            format!("Aucune des {tested} paires ne diffère après correction de Holm."),
        )];
    }
    let words: Vec<String> = different
        .iter()
        .map(|pair| {
            let (high, low, observed) = oriented(pair);
            format!(
                "{} > {} ({})",
                naming.level(factor, high),
                naming.level(factor, low),
                observed.map_or_else(String::new, |d| {
                    format!("{}{}", difference(language, kind, d), unit(language, kind))
                })
            )
        })
        .collect();
    let count = language.pick(
        format!("{} of {tested} pairs differ after Holm’s correction:", different.len()),
        format!("{} paires sur {tested} diffèrent après correction de Holm :", different.len()),
    );
    vec![count, format!("{}.", words.join(", "))]
}

/// The higher level first, and by how much.
fn oriented(pair: &Pair) -> (&str, &str, Option<f64>) {
    let estimate = pair.difference.map(|difference| difference.estimate);
    let effect = match &pair.wilcoxon {
        Outcome::Ok(line) => line.row.effect.unwrap_or(0.0),
        Outcome::Undefined { .. } => 0.0,
    };
    if effect < 0.0 {
        (&pair.b, &pair.a, estimate.map(|e| -e))
    } else {
        (&pair.a, &pair.b, estimate)
    }
}

/// A sentence on a pair, and whether it leaves nothing open: no difference that may still be there.
fn pair_sentence(
    naming: &Naming<'_>,
    pair: &Pair,
    kind: MeasureKind,
    factor: &str,
    topic: Option<String>,
    tested: usize,
) -> (String, bool) {
    let language = naming.language;
    let (a, b) = (level(naming, factor, &pair.a), level(naming, factor, &pair.b));
    let sentence = |words, begins_with_level| sentence(topic.as_deref(), words, begins_with_level);
    let line = match &pair.wilcoxon {
        Outcome::Ok(line) => line,
        Outcome::Undefined { .. } => {
            return (sentence(undefined_pair(language, pair.n, &a, &b), false), true);
        }
    };
    let observed = observed(language, kind, pair, line);
    if pair.least_p > LEVEL {
        let least = language.fixed(pair.least_p.min(1.0), 3);
        let words = language.pick(
            format!("{} people are too few to compare {a} and {b}: even if all agreed, p could not fall below {least}. Observed: {observed}.", pair.n),
            format!("{} personnes ne suffisent pas pour comparer {a} et {b} : même si toutes étaient d’accord, p ne pourrait descendre sous {least}. Observé : {observed}.", pair.n),
        );
        return (sentence(words, false), true);
    }
    let p = language.p(line.p_that_counts());
    let corrected = match (tested > 1, language) {
        (false, _) => "",
        (true, Language::English) => " after Holm’s correction",
        (true, Language::French) => " après correction de Holm",
    };
    if pair.wilcoxon.p_that_counts().is_some_and(|p| p < LEVEL) {
        let (high, low, _) = oriented(pair);
        let first_higher = high == pair.a;
        let (for_high, for_low) = if first_higher {
            (pair.a_higher, pair.b_higher)
        } else {
            (pair.b_higher, pair.a_higher)
        };
        let (high, low) = (level(naming, factor, high), level(naming, factor, low));
        let higher = higher(language, kind);
        let words = language.pick(
            format!("{high} {higher} {low}: so for {for_high} of {} people, the other way round for {for_low}; {observed}, {p}{corrected}.", pair.n),
            format!("{high} {higher} {low} : c’est le cas pour {for_high} personnes sur {}, l’inverse pour {for_low} ; {observed}, {p}{corrected}.", pair.n),
        );
        return (sentence(words, true), true);
    }
    let words = language.pick(
        format!("no difference between {a} and {b} was shown: {observed}, {p}{corrected}, {} people.", pair.n),
        format!("aucune différence entre {a} et {b} n’a été montrée : {observed}, {p}{corrected}, {} personnes.", pair.n),
    );
    (sentence(words, false), false)
}

/// Words as a sentence. A level's name keeps its letters at the start; a word begins with a capital.
fn sentence(topic: Option<&str>, words: String, begins_with_level: bool) -> String {
    match topic {
        Some(topic) => format!("{topic}, {words}"),
        None if begins_with_level => words,
        None => {
            let mut letters = words.chars();
            letters
                .next()
                .map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
        }
    }
}

/// Why `people` people's answers to two levels cannot be tested.
fn undefined_pair(language: Language, people: usize, a: &str, b: &str) -> String {
    if people == 0 {
        return language.pick(
            format!("nobody has answers for both {a} and {b}: nothing can be compared."),
            format!("personne n’a de réponses à la fois pour {a} et {b} : rien à comparer."),
        );
    }
    language.pick(
        format!("each of the {people} people has the same mean for {a} and {b}: no test is defined."),
        format!("chacune des {people} personnes a la même moyenne pour {a} et {b} : aucun test n’est défini."),
    )
}

/// The median difference with its interval.
fn observed(language: Language, kind: MeasureKind, pair: &Pair, line: &TestLine) -> String {
    let Some(d) = pair.difference else { return String::new() };
    // The higher level is named first where there is one; else a is, as in the tables.
    let named = pair.wilcoxon.p_that_counts().is_some_and(|p| p < LEVEL);
    let sign = if named && line.row.effect.unwrap_or(0.0) < 0.0 { -1.0 } else { 1.0 };
    let mut ends = [d.ci_low * sign, d.ci_high * sign];
    ends.sort_unstable_by(f64::total_cmp);
    let [estimate, low, high] =
        [d.estimate * sign, ends[0], ends[1]].map(|v| difference(language, kind, v));
    let unit = unit(language, kind);
    let interval = if d.level_reached {
        language.pick("95 % interval", "intervalle à 95 %")
    } else {
        language.pick("widest interval", "intervalle le plus large")
    };
    language.pick(
        format!("median difference {estimate}{unit} ({interval} {low} to {high})"),
        format!("différence médiane {estimate}{unit} ({interval} : {low} à {high})"),
    )
}

/// A level by its name; a number says nothing without its factor.
fn level(naming: &Naming<'_>, factor: &str, level: &str) -> String {
    let name = naming.level(factor, level);
    if level.parse::<f64>().is_ok() && name == level {
        format!("{} {name}", naming.factor(factor))
    } else {
        name
    }
}

fn topic(language: Language, kind: MeasureKind, label: &str) -> String {
    match kind {
        MeasureKind::Recognition => language.pick("In recognition", "En reconnaissance").to_owned(),
        MeasureKind::ResponseTime => {
            language.pick("In response time", "En temps de réponse").to_owned()
        }
        MeasureKind::Rating => language.pick(format!("On “{label}”"), format!("Pour « {label} »")),
    }
}

fn higher(language: Language, kind: MeasureKind) -> &'static str {
    match kind {
        MeasureKind::Recognition => {
            language.pick("was recognised more often than", "a été mieux reconnue que")
        }
        MeasureKind::ResponseTime => {
            language.pick("was answered more slowly than", "a demandé plus de temps que")
        }
        MeasureKind::Rating => language.pick("was rated higher than", "a été notée plus haut que"),
    }
}

/// A difference in the unit that people read: points of percent, seconds, points of the scale.
pub(crate) fn difference(language: Language, kind: MeasureKind, value: f64) -> String {
    match kind {
        MeasureKind::Recognition => language.fixed(value * 100.0, 1),
        MeasureKind::ResponseTime | MeasureKind::Rating => language.fixed(value, 2),
    }
}

/// That unit.
fn unit(language: Language, kind: MeasureKind) -> &'static str {
    match kind {
        MeasureKind::Recognition => language.pick(" percentage points", " points de pourcentage"),
        MeasureKind::ResponseTime => " s",
        MeasureKind::Rating => "",
    }
}

fn overall_sentence(
    naming: &Naming<'_>,
    outcome: &Outcome<TestLine>,
    factor: &str,
    label: &str,
) -> String {
    let language = naming.language;
    let line = match outcome {
        Outcome::Undefined { reason } => {
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
        return acting_together(language, line, &what, &numbers, significant);
    }
    if significant {
        if interaction.is_some() {
            return language.pick(
                format!("The two factors seem to act together ({what}): {numbers}. On ratings of few steps this transform is not reliable; check it with a mixed model before relying on it."),
                format!("Les deux facteurs semblent agir ensemble ({what}) : {numbers}. Sur des notes à peu d’échelons cette transformation n’est pas fiable ; vérifiez par un modèle mixte avant de vous y fier."),
            );
        }
        return language.pick(
            format!("The levels of {what} differ: {numbers}, {} people.", line.row.n),
            format!(
                "Les niveaux du facteur {what} diffèrent : {numbers}, {} personnes.",
                line.row.n
            ),
        );
    }
    if let Some((first, second)) = interaction {
        let (first, second) = (naming.factor(first), naming.factor(second));
        return language.pick(
            format!("That the effect of {first} depends on {second} was not shown: {numbers}, {} people; that is no proof that it does not.", line.row.n),
            format!("Que l’effet du facteur {first} dépende du facteur {second} n’a pas été montré : {numbers}, {} personnes ; cela ne prouve pas qu’il n’en dépend pas.", line.row.n),
        );
    }
    language.pick(
        format!("No effect of {what} was shown: {numbers}, {} people; that is no proof that there is none.", line.row.n),
        format!("Aucun effet du facteur {what} n’a été montré : {numbers}, {} personnes ; cela ne prouve pas qu’il n’y en a pas.", line.row.n),
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
    what: &str,
    numbers: &str,
    significant: bool,
) -> String {
    let test = line.names.test;
    let how = match &line.unit {
        Unit::DifferencesOfPeople(pair) => language.pick(
            format!("{test} of each person’s difference {pair}, the smallest p of all pairs of levels after Holm’s correction: {numbers}, {} people", line.row.n),
            format!("{test} sur la différence {pair} de chaque personne, le plus petit p de toutes les paires de niveaux après correction de Holm : {numbers}, {} personnes", line.row.n),
        ),
        _ => language.pick(
            format!("{test} on one mean a person: {numbers}, {} people", line.row.n),
            format!("{test} sur une moyenne par personne : {numbers}, {} personnes", line.row.n),
        ),
    };
    if significant {
        language.pick(
            format!("The two factors act together ({what}). {how}."),
            format!("Les deux facteurs agissent ensemble ({what}). {how}."),
        )
    } else {
        language.pick(
            format!("That the two factors act together ({what}) was not shown. {how}; that is no proof that they do not."),
            format!("Que les deux facteurs agissent ensemble ({what}) n’a pas été montré. {how} ; cela ne prouve pas qu’ils ne le font pas."),
        )
    }
}

/// What the correction for all hypotheses of the study leaves of one.
pub(crate) fn over_hypotheses(language: Language, p: f64, p_holm: f64, tested: usize) -> String {
    let corrected = language.p(p_holm);
    let lost = p < LEVEL && p_holm >= LEVEL;
    if lost {
        return language.pick(
            format!("Corrected for the {tested} hypotheses of this study: {corrected}, no longer below 0.05."),
            format!("Corrigé pour les {tested} hypothèses de cette étude : {corrected}, qui n’est plus sous 0,05."),
        );
    }
    language.pick(
        format!("Corrected for the {tested} hypotheses of this study: {corrected}."),
        format!("Corrigé pour les {tested} hypothèses de cette étude : {corrected}."),
    )
}

/// Said wherever trial-level tests stand.
pub(crate) fn trial_level_caution(language: Language) -> &'static str {
    language.pick(
        "The columns “as in the thesis” treat every trial as if it came from another person, although each person answered many. Their p counts one opinion several times: it is printed for comparison with the thesis and supports no conclusion here.",
        "Les colonnes « comme dans la thèse » traitent chaque essai comme s’il venait d’une autre personne, alors que chacune en a fait plusieurs. Leur p compte une même opinion plusieurs fois : il est imprimé pour comparaison avec la thèse et n’autorise ici aucune conclusion.",
    )
}
