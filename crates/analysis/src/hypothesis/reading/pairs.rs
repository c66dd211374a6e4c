//! Pairs of levels in plain words.

use mimique_locale::{Language, counted};
use mimique_stats::{Outcome, median};

use super::{LEVEL, difference, unit};
use crate::hypothesis::person_level::Pair;
use crate::hypothesis::test_line::{OutcomeP, TestLine};
use crate::naming::Naming;
use crate::naming::people_counted;
use crate::trials::measure::MeasureKind;

/// A sentence on each pair; `label` is that of the question where nothing before has named it.
pub(super) fn each_pair(
    naming: &Naming<'_>,
    pairs: &[Pair],
    kind: MeasureKind,
    factor: &str,
    label: Option<&str>,
) -> Vec<String> {
    let language = naming.language;
    let mut sentences = Vec::new();
    for (place, pair) in pairs.iter().enumerate() {
        // Named once; the sentences after it are about the same question.
        let topic = label.filter(|_| place == 0).map(|label| topic(language, kind, label));
        sentences.push(pair_sentence(naming, pair, kind, factor, topic, pairs.len()));
    }
    sentences
}

/// How many pairs differ, and which.
pub(super) fn many_pairs(
    naming: &Naming<'_>,
    pairs: &[Pair],
    kind: MeasureKind,
    factor: &str,
) -> Vec<String> {
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
        format!("Of {}, different after Holm’s correction:", counted(tested, "pair")),
        format!("Différentes après correction de Holm, sur {tested} :"),
    );
    vec![count, format!("{}.", words.join(", "))]
}

/// The higher level first, and by how much.
pub(super) fn oriented(pair: &Pair) -> (&str, &str, Option<f64>) {
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

/// A sentence on a pair.
fn pair_sentence(
    naming: &Naming<'_>,
    pair: &Pair,
    kind: MeasureKind,
    factor: &str,
    topic: Option<String>,
    tested: usize,
) -> String {
    let language = naming.language;
    let (a, b) = (level(naming, factor, &pair.a), level(naming, factor, &pair.b));
    let sentence = |words, begins_with_level| sentence(topic.as_deref(), words, begins_with_level);
    let line = match &pair.wilcoxon {
        Outcome::Ok(line) => line,
        Outcome::Undefined { .. } => {
            return sentence(undefined_pair(language, pair.n, &a, &b), false);
        }
    };
    let observed = observed(language, kind, pair, line);
    if pair.least_p > LEVEL {
        let least = language.fixed(pair.least_p.min(1.0), 3);
        let words = language.pick(
            format!("{} too few to compare {a} and {b}: even if all agreed, p could not fall below {least}. Observed: {observed}.", language.counted(pair.n, ["person is", "people are"], ["", ""])),
            format!("{} pas pour comparer {a} et {b} : même si toutes étaient d’accord, p ne pourrait descendre sous {least}. Observé : {observed}.", language.counted(pair.n, ["", ""], ["personne ne suffit", "personnes ne suffisent"])),
        );
        return sentence(words, false);
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
            format!("{high} {higher} {low}: so for {for_high} of {}, the other way round for {for_low}; {observed}, {p}{corrected}.", people_counted(language, pair.n)),
            format!("{high} {higher} {low} : c’est le cas pour {} sur {}, l’inverse pour {for_low} ; {observed}, {p}{corrected}.", people_counted(language, for_high), pair.n),
        );
        return sentence(words, true);
    }
    let words = language.pick(
        format!(
            "no difference between {a} and {b} was shown: {observed}, {p}{corrected}, {}.",
            people_counted(language, pair.n)
        ),
        format!(
            "aucune différence entre {a} et {b} n’a été montrée : {observed}, {p}{corrected}, {}.",
            people_counted(language, pair.n)
        ),
    );
    sentence(words, false)
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
        format!("every participant ({people}) has the same mean for {a} and {b}: no test is defined."),
        format!("chaque personne ({people}) a la même moyenne pour {a} et {b} : aucun test n’est défini."),
    )
}

/// Hodges and Lehmann's difference with its interval, and the median of people's differences, which is another number where
/// differences are skewed or many are 0.
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
    let median = median(&mut pair.differences.clone()) * sign;
    let median = difference(language, kind, median);
    language.pick(
        format!("Hodges-Lehmann difference {estimate}{unit} ({interval} {low} to {high}), median of the differences {median}{unit}"),
        format!("différence de Hodges-Lehmann {estimate}{unit} ({interval} : {low} à {high}), médiane des différences {median}{unit}"),
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

/// What is compared, at the start of a sentence.
pub(super) fn topic(language: Language, kind: MeasureKind, label: &str) -> String {
    match kind {
        MeasureKind::Recognition => language.pick("In recognition", "En reconnaissance").to_owned(),
        MeasureKind::ResponseTime => {
            language.pick("In response time", "En temps de réponse").to_owned()
        }
        MeasureKind::Rating | MeasureKind::Choice => {
            language.pick(format!("On “{label}”"), format!("Pour « {label} »"))
        }
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
        MeasureKind::Choice => language.pick("was chosen over", "a été préférée à"),
        MeasureKind::Rating => language.pick("was rated higher than", "a été notée plus haut que"),
    }
}
