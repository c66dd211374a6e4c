//! A hypothesis about the assigned condition: how many people are in each condition, their mean, and
//! what that means for a test between them.

use mimique_stats::Labelled;
use mimique_study::columns::ASSIGNED_CONDITION;
use mimique_study::{Hypothesis, Study};
use serde::Serialize;

use crate::naming::Naming;
use crate::naming::people_counted;
use crate::trials::export::Export;
use crate::trials::measure::{Measure, MeasureKind};

/// A test that cannot reach this is said to have too few people.
const LEVEL: f64 = 0.05;

/// The people of one condition who have a value.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub(crate) struct InCondition {
    /// How many.
    pub people: usize,
    /// Mean of their means; none of nobody.
    pub mean: Option<f64>,
    /// Each of them, by the place in [`Export::people`], with the mean of all trials.
    #[serde(skip)]
    pub means: Vec<(usize, f64)>,
}

/// The conditions that a hypothesis compares: those that it names, else all of the study.
fn compared(study: &Study, hypothesis: &Hypothesis) -> Vec<String> {
    let first = hypothesis.factors.first().is_some_and(|factor| factor == ASSIGNED_CONDITION);
    match first && !hypothesis.levels.is_empty() {
        true => hypothesis.levels.iter().map(ToString::to_string).collect(),
        false => study.conditions().into_iter().map(str::to_owned).collect(),
    }
}

/// The people of each condition that a hypothesis compares; none where it compares none.
pub(crate) fn people(
    export: &Export,
    study: &Study,
    hypothesis: &Hypothesis,
    measure: &Measure,
) -> Labelled<InCondition> {
    let about = export.about.iter().find(|(name, _)| name == ASSIGNED_CONDITION);
    let Some((_, cells)) = about.filter(|(name, _)| hypothesis.factors.contains(name)) else {
        return Labelled::default();
    };
    let means = measure.overall_person_means();
    let of_condition = |condition: &String| {
        let own = means.people.iter().zip(&means.means);
        let own = own.filter(|(person, _)| cells[**person].as_ref() == Some(condition));
        let means: Vec<(usize, f64)> = own.map(|(person, mean)| (*person, *mean)).collect();
        let mean = means.iter().map(|(_, mean)| mean).sum::<f64>() / means.len() as f64;
        InCondition { people: means.len(), mean: (!means.is_empty()).then_some(mean), means }
    };
    let conditions = compared(study, hypothesis);
    Labelled::zip(&conditions, conditions.iter().map(of_condition))
}

/// What the reader of a test between conditions must know of their people, behind its reading.
pub(crate) fn words(
    naming: &Naming<'_>,
    conditions: &Labelled<InCondition>,
    kind: MeasureKind,
) -> String {
    let language = naming.language;
    let value = |mean: f64| match kind {
        MeasureKind::Recognition => language.percent(mean),
        MeasureKind::ResponseTime => format!("{} s", language.fixed(mean, 2)),
        MeasureKind::Rating | MeasureKind::Choice => language.fixed(mean, 2),
    };
    let mut words = String::new();
    let told = conditions.iter().filter_map(|(name, own)| {
        let (people, mean) = (own.people, value(own.mean?));
        Some(language.pick(
            format!("{name} {mean} ({})", people_counted(language, people)),
            format!("{name} {mean} ({})", people_counted(language, people)),
        ))
    });
    let told: Vec<String> = told.collect();
    if !told.is_empty() {
        words += language.pick(
            " Mean of the people in each condition: ",
            " Moyenne des personnes de chaque condition : ",
        );
        words += &format!("{}.", told.join(", "));
    }
    for (name, _) in conditions.iter().filter(|(_, own)| own.people == 0) {
        words += &language.pick(
            format!(" Nobody in the analysis is in the condition {name}: it takes no part."),
            format!(" Personne, dans l’analyse, n’est dans la condition {name} : elle ne prend pas part au test."),
        );
    }
    let sizes: Vec<usize> =
        conditions.iter().map(|(_, own)| own.people).filter(|people| *people > 0).collect();
    let (fewest, most) =
        (sizes.iter().min().copied().unwrap_or(0), sizes.iter().max().copied().unwrap_or(0));
    if let [a, b] = sizes[..]
        && least_p(a, b) > LEVEL
    {
        let least = language.fixed(least_p(a, b), 3);
        words += &language.pick(
            format!(" {a} and {b} people are too few: even if all of one condition were above all of the other, p could not fall below {least}."),
            format!(" {a} et {b} personnes ne suffisent pas : même si toutes celles d’une condition étaient au-dessus de toutes celles de l’autre, p ne pourrait descendre sous {least}."),
        );
    } else if most >= 2 * fewest.max(1) && sizes.len() > 1 {
        words += language.pick(
            " One condition has at least twice as many people as another: if they also spread differently, p is not exact.",
            " Une condition compte au moins deux fois plus de personnes qu’une autre : si leur dispersion diffère aussi, p n’est pas exact.",
        );
    }
    words
}

/// The smallest p of two groups of these sizes: both orders that part them, of all ways to choose the
/// first group.
fn least_p(a: usize, b: usize) -> f64 {
    let ways: f64 = (1..=a.min(b)).map(|i| (a.max(b) + i) as f64 / i as f64).product();
    (2.0 / ways).min(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_smallest_p_is_two_of_all_ways_to_part_people() {
        for (a, b, ways) in [(3, 3, 20.0), (4, 4, 70.0), (2, 6, 28.0), (1, 5, 6.0)] {
            assert!((least_p(a, b) - 2.0 / ways).abs() < 1e-12, "{a} {b}");
        }
    }
}
