//! What tests of equivalence say.

use mimique_locale::Language;
use mimique_stats::{EquivalenceT, EquivalenceVerdict, Outcome};

use super::{LEVEL, difference, unit};
use crate::hypothesis::equivalence::{Equivalence, OneSidedTests};
use crate::hypothesis::other_clips::OtherClips;
use crate::naming::{Naming, people_counted};
use crate::trials::measure::{Measure, MeasureKind};

/// The verdict on two levels, with the numbers that it rests on.
pub(crate) fn equivalence(
    naming: &Naming<'_>,
    found: &Equivalence,
    measure: &Measure,
    factor: &str,
) -> String {
    let (language, kind) = (naming.language, measure.kind);
    let [a, b] = found.levels.each_ref().map(|level| naming.level(factor, level));
    let label = &measure.label;
    let least =
        format!("{}{}", shown(language, kind, found.smallest_effect), points(language, kind));
    let people: Vec<String> = found.people.iter().map(usize::to_string).collect();
    let people = people.join(language.pick(" and ", " et "));
    let line = match &found.by_ranks.line {
        Outcome::Ok(line) => line,
        Outcome::Undefined { reason } => {
            let reason = reason.words(language);
            return language.pick(
                format!(
                    "Whether {a} and {b} are equivalent on “{label}” cannot be tested ({reason})."
                ),
                format!(
                    "L’équivalence de {a} et {b} pour « {label} » ne peut être testée ({reason})."
                ),
            );
        }
    };
    let verdict = verdict_in_words(language, found.by_ranks.verdict, [&a, &b], &least);
    let test = line.names.in_words[language.pick(0, 1)];
    let mut numbers = vec![language.pick(
        format!("equivalence by {test}, {}", language.p(line.row.p_value)),
        format!("équivalence par {test}, {}", language.p(line.row.p_value)),
    )];
    let of_difference = found.by_ranks.p_difference.map(|p| {
        let p = language.p(p);
        language.pick(format!("of any difference {p}"), format!("d’une différence quelconque {p}"))
    });
    // The p on which the verdict rests comes first.
    match found.by_ranks.verdict {
        Some(EquivalenceVerdict::Different) => numbers.splice(0..0, of_difference).for_each(drop),
        _ => numbers.extend(of_difference),
    }
    numbers.extend(estimate(language, kind, found));
    numbers.push(match found.people.as_slice() {
        [people] => people_counted(language, *people),
        _ => language.pick(format!("{people} people"), format!("{people} personnes")),
    });
    if let Some(words) = too_few(language, found, (&a, &b)) {
        numbers.push(words);
    }
    let numbers = numbers.join("; ");
    let colon = language.pick("", "\u{a0}");
    let topic = language.pick(format!("On “{label}”"), format!("Pour « {label} »"));
    let beside = beside(language, &found.by_t);
    format!("{topic}{colon}: {verdict} ({numbers}).{beside}")
}

/// The verdict on two levels, of which differences of less than `least` do not matter.
fn verdict_in_words(
    language: Language,
    verdict: Option<EquivalenceVerdict>,
    [a, b]: [&str; 2],
    least: &str,
) -> String {
    match verdict {
        Some(EquivalenceVerdict::Equivalent) => language.pick(
            format!("{a} and {b} are equivalent: they differ by less than {least}, either way"),
            format!("{a} et {b} sont équivalents : ils diffèrent de moins de {least}, dans un sens comme dans l’autre"),
        ),
        Some(EquivalenceVerdict::DifferentButSmall) => language.pick(
            format!("{a} and {b} differ, but by less than {least}, the smallest difference that matters"),
            format!("{a} et {b} diffèrent, mais de moins de {least}, la plus petite différence qui compte"),
        ),
        Some(EquivalenceVerdict::Different) => language.pick(
            format!("{a} and {b} differ, and that by less than {least} was not shown"),
            format!("{a} et {b} diffèrent, et que ce soit de moins de {least} n’a pas été montré"),
        ),
        Some(EquivalenceVerdict::Undecided) | None => language.pick(
            format!("undecided: neither that {a} and {b} differ nor that they do so by less than {least} was shown; more people would tell"),
            format!("indécis : ni que {a} et {b} diffèrent, ni que ce soit de moins de {least} n’a été montré ; davantage de personnes le diraient"),
        ),
    }
}

/// The verdict for other clips, with the numbers that it rests on.
pub(crate) fn equivalence_for_other_clips(
    naming: &Naming<'_>,
    found: &Equivalence,
    clips: &OtherClips,
    measure: &Measure,
    factors: &[String],
) -> String {
    let (language, kind) = (naming.language, measure.kind);
    let Some(own) = &found.for_other_clips else {
        return match &clips.linear_model {
            Some(Outcome::Undefined { reason }) => {
                let reason = reason.words(language);
                language.pick(
                    format!("Equivalence for other clips cannot be tested: the linear mixed model gives no p ({reason})."),
                    format!("L’équivalence pour d’autres extraits ne peut être testée : le modèle linéaire mixte ne donne pas de p ({reason})."),
                )
            }
            _ => String::new(),
        };
    };
    let factor = factors.first().map_or("", String::as_str);
    let [a, b] = found.levels.each_ref().map(|level| naming.level(factor, level));
    let least =
        format!("{}{}", shown(language, kind, found.smallest_effect), points(language, kind));
    let verdict = verdict_in_words(language, Some(own.verdict), [&a, &b], &least);
    let name = equivalence_by_model(language);
    let of_equivalence = format!("{name}, {}, {}", equivalence_t(language, own), language.p(own.p));
    let p = language.p(own.p_difference);
    let of_difference =
        language.pick(format!("of any difference {p}"), format!("d’une différence quelconque {p}"));
    let mut numbers = match own.verdict {
        EquivalenceVerdict::Different => vec![of_difference, of_equivalence],
        _ => vec![of_equivalence, of_difference],
    };
    let [estimate, low, high] = [own.difference, own.interval_90[0], own.interval_90[1]]
        .map(|value| difference(language, kind, value));
    let unit = unit(language, kind);
    numbers.push(language.pick(
        format!("difference of means {estimate}{unit}, 90 % interval {low} to {high}"),
        format!("différence des moyennes {estimate}{unit}, intervalle à 90 % de {low} à {high}"),
    ));
    let numbers = numbers.join("; ");
    let label = &measure.label;
    language.pick(
        format!("For other clips, on “{label}”: {verdict} ({numbers})."),
        format!("Pour d’autres extraits, pour « {label} » : {verdict} ({numbers})."),
    )
}

/// The tests of equivalence that hold for other clips.
pub(crate) fn equivalence_by_model(language: Language) -> &'static str {
    language.pick(
        "two one-sided t tests of the linear mixed model",
        "deux tests t unilatéraux du modèle linéaire mixte",
    )
}

/// Of two one-sided t tests, the t with the larger p: `t(12.3) = -1.23`.
pub(crate) fn equivalence_t(language: Language, tests: &EquivalenceT) -> String {
    let t = if tests.p_lower > tests.p_upper { tests.t_lower } else { tests.t_upper };
    format!("t({}) = {}", language.fixed(tests.df, 1), language.fixed(t, 2))
}

/// What too few people cannot show, whatever they answer: the smaller of both one-sided p is at least that of the exact
/// test in which everybody's difference is on the same side of a bound.
fn too_few(language: Language, found: &Equivalence, (a, b): (&str, &str)) -> Option<String> {
    let least = least_p(found.within_people, &found.people)?;
    if least <= LEVEL {
        return None;
    }
    let least = language.fixed(least, 4);
    Some(language.pick(
        format!("too few people to show that {a} and {b} are equivalent: whatever they answered, p could not fall below {least}"),
        format!("trop peu de personnes pour montrer que {a} et {b} sont équivalents : quelles que soient leurs réponses, p ne pourrait descendre sous {least}"),
    ))
}

/// The smallest p that the one-sided signed rank test of so many pairs can give, or of so many people in two groups the
/// rank sum test.
fn least_p(within_people: bool, people: &[usize]) -> Option<f64> {
    match *people {
        [pairs] if within_people => Some(0.5_f64.powi(pairs.min(1000) as i32)),
        [a, b] => {
            let ways = (1..=a.min(b)).map(|i| (a.max(b) + i) as f64 / i as f64);
            Some(1.0 / ways.product::<f64>())
        }
        _ => None,
    }
}

/// The verdict in a word.
pub(crate) fn verdict(language: Language, verdict: EquivalenceVerdict) -> &'static str {
    match verdict {
        EquivalenceVerdict::Equivalent => language.pick("equivalent", "équivalents"),
        EquivalenceVerdict::Different => language.pick("different", "différents"),
        EquivalenceVerdict::DifferentButSmall => {
            language.pick("different, but small", "différents, mais peu")
        }
        EquivalenceVerdict::Undecided => language.pick("undecided", "indécis"),
    }
}

/// The estimate with its interval: by ranks where they give one, else by t.
fn estimate(language: Language, kind: MeasureKind, found: &Equivalence) -> Option<String> {
    let ranks = found.by_ranks.interval_90.is_some();
    let own = if ranks { &found.by_ranks } else { &found.by_t };
    let (estimate, [low, high]) = (own.estimate?, own.interval_90?);
    let [estimate, low, high] = [estimate, low, high].map(|v| difference(language, kind, v));
    let unit = unit(language, kind);
    let of = match ranks {
        true => language.pick("Hodges-Lehmann difference", "différence de Hodges-Lehmann"),
        false => language.pick("difference of means", "différence des moyennes"),
    };
    Some(language.pick(
        format!("{of} {estimate}{unit}, 90 % interval {low} to {high}"),
        format!("{of} {estimate}{unit}, intervalle à 90 % de {low} à {high}"),
    ))
}

fn beside(language: Language, tests: &OneSidedTests) -> String {
    let (Outcome::Ok(line), Some(found)) = (&tests.line, tests.verdict) else {
        return String::new();
    };
    let test = line.names.in_words[language.pick(0, 1)];
    let (p, found) = (language.p(line.row.p_value), verdict(language, found));
    language.pick(
        format!(" Beside it {test}: {p}, {found}."),
        format!(" À côté, {test} : {p}, {found}."),
    )
}

/// The smallest effect as it was written.
fn shown(language: Language, kind: MeasureKind, value: f64) -> String {
    match kind {
        MeasureKind::Recognition => language.number(value * 100.0),
        _ => language.number(value),
    }
}

fn points(language: Language, kind: MeasureKind) -> &'static str {
    match kind {
        MeasureKind::Rating | MeasureKind::Choice => {
            language.pick(" points of the scale", " points de l’échelle")
        }
        _ => unit(language, kind),
    }
}
