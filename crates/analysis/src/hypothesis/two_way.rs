//! Two factors of which at least one is something about the person.
//!
//! Everyone counts once: the factor about people is tested on each person's mean, the factor within
//! people by Friedman's test (or Wilcoxon's, of two levels) on person means, their interaction by
//! whether people's differences between two levels of the one depend on the other. Of two factors about
//! people, the means of the people are a two-way layout of independent observations.

use mimique_stats::{Adjustment, Factor, Numbers, Outcome, Term};

use crate::hypothesis::not_tested::NotTested;
use crate::hypothesis::person_level::{self, PersonLevel};
use crate::hypothesis::test_line::{OutcomeP, TestLine, Unit};
use crate::hypothesis::undefined::TestOutcome;
use crate::trials::export::Export;
use crate::trials::measure::Measure;

/// A factor, and whether it is about people rather than clips.
pub(crate) type Aspect<'a> = (&'a Factor, bool);

/// Tests of both factors and, last, of their interaction, in the order of the factors.
pub(crate) fn two_way(export: &Export, measure: &Measure, factors: [Aspect<'_>; 2]) -> PersonLevel {
    let (within, about, about_is_first) = match factors {
        [(first, false), (second, false)] => {
            return person_level::two_way(export, measure, [first, second]);
        }
        [(first, true), (second, true)] => return of_people(measure, [first, second]),
        [(about, true), (within, false)] => (within, about, true),
        [(within, false), (about, true)] => (within, about, false),
    };
    let by_clip = person_level::within(export, measure, within);
    let of_clips = match by_clip.overall.into_iter().next() {
        Some(overall) => overall,
        None => by_clip.pairs.into_iter().next().map_or_else(
            || TestOutcome::undefined(NotTested::TooFewLevels { factor: within.name.clone() }),
            |pair| pair.wilcoxon,
        ),
    };
    let named = |line: TestOutcome, term: Term| line.map(|line| line.with_term(term));
    let about_people = person_level::between(measure, about).overall.into_iter();
    let mut overall: Vec<TestOutcome> =
        about_people.map(|line| named(line, Term::factor(&about.name))).collect();
    overall.push(named(of_clips, Term::factor(&within.name)));
    if !about_is_first {
        overall.reverse();
    }
    let [first, second] = factors.map(|(factor, _)| &factor.name);
    let interaction = interaction(export, measure, within, about);
    overall.push(named(interaction, Term::interaction(first, second)));
    PersonLevel {
        people: by_clip.people,
        incomplete: by_clip.incomplete,
        overall,
        pairs: Vec::new(),
    }
}

/// Whether people's differences between levels of `within` depend on `about`: of all pairs of levels the
/// one with the smallest p, after Holm's correction over the pairs.
pub(crate) fn interaction(
    export: &Export,
    measure: &Measure,
    within: &Factor,
    about: &Factor,
) -> TestOutcome {
    let lines = person_level::differences_by_trait(export, measure, within, about);
    let p: Vec<Option<f64>> = lines.iter().map(Outcome::p).collect();
    let known = p.iter().enumerate().filter_map(|(pair, p)| Some((pair, (*p)?)));
    let smallest = known.min_by(|a, b| a.1.total_cmp(&b.1)).map_or(0, |(pair, _)| pair);
    lines.into_iter().zip(Adjustment::Holm.apply(&p)).nth(smallest).map_or_else(
        || TestOutcome::undefined(NotTested::TooFewLevels { factor: within.name.clone() }),
        |(line, p_holm)| line.map(|line| TestLine { p_holm, ..line }),
    )
}

/// Scheirer-Ray-Hare on one mean a person.
fn of_people(measure: &Measure, factors: [&Factor; 2]) -> PersonLevel {
    let means = measure.overall_person_means();
    let people = means.people.len();
    let [first, second] = factors.map(|factor| factor.rows(&means.first_rows));
    let values = Numbers { name: measure.id.clone(), values: means.means };
    let overall = TestLine::scheirer_ray_hare(&values, [&first, &second], &Unit::PersonMeans);
    PersonLevel { people, incomplete: 0, overall, pairs: Vec::new() }
}
