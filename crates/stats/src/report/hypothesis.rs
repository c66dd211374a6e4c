//! The hypotheses of a study file, each tested as in the thesis and as recommended.

use mimique_study::responses::ASSIGNED_CONDITION;
use mimique_study::{Hypothesis, Measure as What, Study, TestName};
use serde::Serialize;

use super::assigned::{self, InCondition};
use super::comparison::without_level;
use super::export::{AskedQuestion, Export};
use super::language::Language;
use super::measure::{Measure, MeasureKind, as_numbers};
use super::mixed;
use super::naming::Naming;
use super::person_level::{self, PersonLevel};
use super::reading;
use super::test_line::TestLine;
use super::trial_level::{self, TrialLevel};
use crate::factor::Factor;
use crate::outcome::{Labelled, Outcome};

/// A hypothesis and what came out.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct HypothesisResult {
    pub id: String,
    pub statement: String,
    pub test: TestName,
    pub measure: String,
    pub kind: MeasureKind,
    pub factors: Vec<String>,
    pub as_in_the_thesis: TrialLevel,
    pub recommended: PersonLevel,
    /// Trials without a value of a factor, such as those of a method without that parameter: not used.
    pub trials_without_level: usize,
    /// The people of each condition compared, where the assigned condition is a factor.
    #[serde(skip_serializing_if = "Labelled::is_empty")]
    pub people_by_condition: Labelled<InCondition>,
    /// p of the recommended test that decides.
    pub p: Option<f64>,
    /// After Holm's correction over the study's hypotheses.
    pub p_holm_over_hypotheses: Option<f64>,
    pub reading: String,
}

/// What both kinds of test give, or why neither can be computed.
type Tested = Result<(Vec<Outcome<TestLine>>, PersonLevel), String>;

/// Tests one hypothesis.
pub(crate) fn test_hypothesis(
    naming: &Naming<'_>,
    export: &Export,
    study: &Study,
    hypothesis: &Hypothesis,
) -> HypothesisResult {
    let language = naming.language;
    let measure = measure_of(export, study, hypothesis, language);
    let tested = match &measure {
        Some(measure) => tests(export, study, hypothesis, measure, language),
        None => Err(language.pick(
            format!("\"{}\" has no answers that this test can use", hypothesis.response),
            format!("« {} » n’a pas de réponses que ce test puisse utiliser", hypothesis.response),
        )),
    };
    let factor = hypothesis.factors.first().map_or("", String::as_str);
    let trials_without_level = measure.as_ref().map_or(0, |measure| {
        let of_clips = hypothesis.factors.iter().filter(|name| export.factors.contains(name));
        let counts = of_clips.map(|name| without_level(&measure.factor(export, name, &[])));
        counts.max().unwrap_or(0)
    });
    let (trials, people, mut reading) = match (tested, &measure) {
        (Ok((trials, people)), Some(measure)) => {
            // A hypothesis of two factors is about their interaction, which stands last.
            let mut read = people.clone();
            if two_way(hypothesis.test) {
                read.overall = read.overall.split_off(read.overall.len().saturating_sub(1));
            }
            let words = reading::person_level(naming, &read, measure.kind, factor, &measure.label);
            (trials, people, words)
        }
        (Ok((trials, people)), None) => (trials, people, String::new()),
        (Err(reason), _) => {
            let reading =
                language.pick(format!("Not tested: {reason}."), format!("Non testée : {reason}."));
            let nothing = PersonLevel {
                people: 0,
                incomplete: 0,
                overall: vec![Outcome::undefined(&reason)],
                pairs: Vec::new(),
            };
            (vec![Outcome::undefined(reason)], nothing, reading)
        }
    };
    if trials_without_level > 0 {
        reading += &language.pick(
            format!(" {trials_without_level} trials have no value of the factor and take no part."),
            format!(" {trials_without_level} essais n’ont pas de valeur du facteur et ne prennent pas part au test."),
        );
    }
    let people_by_condition = measure.as_ref().map_or_else(Labelled::default, |measure| {
        assigned::people(export, study, hypothesis, measure)
    });
    let kind = measure.as_ref().map_or(MeasureKind::Rating, |measure| measure.kind);
    reading += &assigned::words(naming, &people_by_condition, kind);
    HypothesisResult {
        id: hypothesis.id.clone(),
        statement: hypothesis.statement.in_language(language.code()).to_owned(),
        test: hypothesis.test,
        kind,
        measure: measure.map_or_else(|| hypothesis.response.clone(), |measure| measure.id),
        factors: hypothesis.factors.clone(),
        trials_without_level,
        people_by_condition,
        as_in_the_thesis: TrialLevel::new(trials),
        p: deciding_p(&people),
        p_holm_over_hypotheses: None,
        recommended: people,
        reading,
    }
}

fn two_way(test: TestName) -> bool {
    matches!(test, TestName::ScheirerRayHare | TestName::AlignedRankTransform)
}

fn measure_of(
    export: &Export,
    study: &Study,
    hypothesis: &Hypothesis,
    language: Language,
) -> Option<Measure> {
    let asked = export
        .questions(study)
        .into_iter()
        .find(|asked: &AskedQuestion<'_>| asked.id == hypothesis.response)?;
    match hypothesis.measure {
        What::Rt => Measure::response_time(export, &asked, language),
        What::Answer | What::Correct => Measure::of_question(export, &asked, language),
    }
}

fn tests(
    export: &Export,
    study: &Study,
    hypothesis: &Hypothesis,
    measure: &Measure,
    language: Language,
) -> Tested {
    let levels: Vec<String> = hypothesis.levels.iter().map(ToString::to_string).collect();
    let mut factors = Vec::new();
    for (place, name) in hypothesis.factors.iter().enumerate() {
        let chosen = if place == 0 { levels.as_slice() } else { &[] };
        factors.push(if export.factors.contains(name) {
            (measure.factor(export, name, chosen), true)
        } else {
            let factor = measure.trait_factor(export, name).ok_or_else(|| {
                language.pick(
                    format!("there is no factor \"{name}\" in the export"),
                    format!("l’export n’a pas de facteur « {name} »"),
                )
            })?;
            // Whoever is in a condition that the study no longer has is compared with nobody.
            let known = |level: &&String| {
                name != ASSIGNED_CONDITION || study.conditions().contains(&level.as_str())
            };
            let wanted = if chosen.is_empty() { factor.levels.as_slice() } else { chosen };
            let wanted: Vec<String> = wanted
                .iter()
                .filter(|level| factor.levels.contains(level))
                .filter(known)
                .cloned()
                .collect();
            (factor.restricted(&wanted).unwrap_or(factor), false)
        });
    }
    for (factor, _) in &factors {
        if let [] | [_] = factor.levels.as_slice() {
            return Err(language.pick(
                format!("\"{}\" has fewer than two levels in the answers", factor.name),
                format!("« {} » a moins de deux niveaux dans les réponses", factor.name),
            ));
        }
    }
    match factors.as_slice() {
        [(first, first_within), (second, second_within), ..] if two_way(hypothesis.test) => Ok((
            TestLine::scheirer_ray_hare(&measure.numbers(), [first, second], "trials"),
            mixed::two_way(export, measure, [(first, !first_within), (second, !second_within)]),
        )),
        [(factor, true), ..] => Ok(within_people(export, hypothesis, measure, factor)),
        [(factor, false), ..] => Ok(between_people(hypothesis, measure, factor)),
        [] => Err(language.pick("no factor is named", "aucun facteur n’est nommé").to_owned()),
    }
}

fn within_people(
    export: &Export,
    hypothesis: &Hypothesis,
    measure: &Measure,
    factor: &Factor,
) -> (Vec<Outcome<TestLine>>, PersonLevel) {
    let mut people = person_level::within(export, measure, factor);
    let rating = measure.kind != MeasureKind::Recognition;
    let trials = match hypothesis.test {
        TestName::Wilcoxon if rating => {
            trial_level::pairs(export, measure, factor).into_iter().map(|(.., line)| line).collect()
        }
        TestName::MannWhitney => {
            vec![TestLine::mann_whitney(&measure.numbers(), factor, "trials")]
        }
        TestName::Spearman => {
            let x = as_numbers(factor);
            people.overall = vec![person_level::correlation_within_people(&x, measure)];
            people.pairs.clear();
            vec![TestLine::spearman(&x, &measure.numbers(), "trials")]
        }
        TestName::KruskalWallis => {
            vec![TestLine::kruskal_wallis(&measure.numbers(), factor, "trials")]
        }
        TestName::ChiSquare => vec![trial_level::chi_square(measure, factor)],
        _ => vec![trial_level::overall(measure, factor)],
    };
    (trials, people)
}

fn between_people(
    hypothesis: &Hypothesis,
    measure: &Measure,
    factor: &Factor,
) -> (Vec<Outcome<TestLine>>, PersonLevel) {
    if hypothesis.test == TestName::Spearman {
        let x = as_numbers(factor);
        let people = person_level::correlation(&x, measure);
        return (vec![TestLine::spearman(&x, &measure.numbers(), "trials")], people);
    }
    let trials = match hypothesis.test {
        TestName::MannWhitney => TestLine::mann_whitney(&measure.numbers(), factor, "trials"),
        TestName::KruskalWallis => TestLine::kruskal_wallis(&measure.numbers(), factor, "trials"),
        _ => trial_level::overall(measure, factor),
    };
    (vec![trials], person_level::between(measure, factor))
}

/// The p that a hypothesis stands or falls by: the interaction if there is one, the overall test of
/// several levels, or the one pair.
fn deciding_p(people: &PersonLevel) -> Option<f64> {
    match (people.overall.last(), people.pairs.as_slice()) {
        (Some(last), _) => last.p_that_counts(),
        (None, [one]) => one.wilcoxon.p(),
        (None, _) => None,
    }
}
