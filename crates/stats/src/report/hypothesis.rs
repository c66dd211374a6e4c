//! The hypotheses of a study file, each tested as in the thesis and as recommended.

use mimique_study::{Hypothesis, Measure as What, Study, TestName};
use serde::Serialize;

use super::comparison::{
    PersonLevel, TestLine, TrialLevel, between, correlation, correlation_within_people,
    person_level, person_level_two_way, trial_level_chi_square, trial_level_mann_whitney,
    trial_level_overall, trial_level_two_way, trial_level_wilcoxon,
};
use super::export::{AskedQuestion, Export};
use super::language::Language;
use super::measure::{Measure, MeasureKind};
use super::naming::Naming;
use super::reading;
use crate::factor::Factor;
use crate::kruskal_wallis::kruskal_wallis;
use crate::outcome::Outcome;
use crate::table::Numbers;

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
        Some(measure) => tests(export, hypothesis, measure, language),
        None => Err(language.pick(
            format!("\"{}\" has no answers that this test can use", hypothesis.response),
            format!("« {} » n’a pas de réponses que ce test puisse utiliser", hypothesis.response),
        )),
    };
    let factor = hypothesis.factors.first().map_or("", String::as_str);
    let (trials, people, reading) = match (tested, &measure) {
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
    HypothesisResult {
        id: hypothesis.id.clone(),
        statement: hypothesis.statement.in_language(language.code()).to_owned(),
        test: hypothesis.test,
        kind: measure.as_ref().map_or(MeasureKind::Rating, |measure| measure.kind),
        measure: measure.map_or_else(|| hypothesis.response.clone(), |measure| measure.id),
        factors: hypothesis.factors.clone(),
        as_in_the_thesis: TrialLevel { assumes: "independent observations", tests: trials },
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
            (factor, false)
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
        [(first, _), (second, _), ..] if two_way(hypothesis.test) => {
            let both = [first, second];
            Ok((trial_level_two_way(measure, both), person_level_two_way(export, measure, both)))
        }
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
    let mut people = person_level(&measure.person_means(export, factor));
    let trials = match hypothesis.test {
        TestName::Wilcoxon if measure.kind != MeasureKind::Recognition => {
            if factor.levels.len() == 2 {
                vec![trial_level_wilcoxon(export, measure, factor)]
            } else {
                all_pairs(factor)
                    .into_iter()
                    .filter_map(|levels| factor.restricted(&levels).ok())
                    .map(|pair| trial_level_wilcoxon(export, measure, &pair))
                    .collect()
            }
        }
        TestName::MannWhitney => vec![trial_level_mann_whitney(measure, factor)],
        TestName::Spearman => {
            let x = as_numbers(factor);
            people.overall = vec![correlation_within_people(&x.values, measure)];
            people.pairs.clear();
            vec![correlation(&x, &measure.numbers(), "Spearman of trials")]
        }
        TestName::KruskalWallis if measure.kind == MeasureKind::Recognition => {
            let result = kruskal_wallis(&measure.numbers(), factor);
            vec![match result {
                Ok(Outcome::Ok(result)) => Outcome::Ok(TestLine {
                    test: "Kruskal-Wallis of trials".to_owned(),
                    term: String::new(),
                    statistic_name: "H",
                    statistic: result.statistic,
                    df: result.df.to_string(),
                    p_value: result.p_value,
                    ln_p: result.ln_p,
                    p_holm: None,
                    effect_name: "epsilon squared",
                    effect: Some(result.epsilon_squared),
                    n: result.n,
                }),
                Ok(Outcome::Undefined { reason }) => Outcome::Undefined { reason },
                Err(refusal) => Outcome::undefined(refusal.to_string()),
            }]
        }
        TestName::ChiSquare if measure.kind != MeasureKind::Recognition => {
            let answers: Vec<String> = measure.values.iter().map(ToString::to_string).collect();
            let answers = Factor::from_cells(
                &measure.id,
                answers.iter().map(|answer| Some(answer.as_str())),
                |answer| answer.parse().ok(),
            );
            vec![trial_level_chi_square(factor, &answers)]
        }
        _ => vec![trial_level_overall(measure, factor)],
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
        let means = measure.overall_person_means();
        let values = |of: &dyn Fn(usize, f64) -> f64| Numbers {
            name: measure.id.clone(),
            values: means.iter().map(|(&person, &mean)| of(person, mean)).collect(),
        };
        let first_row = measure.first_rows();
        let trait_of =
            |person: usize| first_row.get(&person).map_or(f64::NAN, |&row| x.values[row]);
        let mut trait_values = values(&|person, _| trait_of(person));
        trait_values.name.clone_from(&factor.name);
        let people = PersonLevel {
            people: means.len(),
            incomplete: 0,
            overall: vec![correlation(
                &trait_values,
                &values(&|_, mean| mean),
                "Spearman of person means",
            )],
            pairs: Vec::new(),
        };
        return (vec![correlation(&x, &measure.numbers(), "Spearman of trials")], people);
    }
    let people = between(measure, factor);
    let trials = match hypothesis.test {
        TestName::MannWhitney => trial_level_mann_whitney(measure, factor),
        _ => trial_level_overall(measure, factor),
    };
    (vec![trials], people)
}

/// The p that a hypothesis stands or falls by: the interaction if there is one, the overall test of
/// several levels, or the one pair.
fn deciding_p(people: &PersonLevel) -> Option<f64> {
    let p = |outcome: &Outcome<TestLine>| match outcome {
        Outcome::Ok(line) => Some(line.p_value),
        Outcome::Undefined { .. } => None,
    };
    match (people.overall.last(), people.pairs.as_slice()) {
        (Some(last), _) => p(last),
        (None, [one]) => p(&one.wilcoxon),
        (None, _) => None,
    }
}

fn all_pairs(factor: &Factor) -> Vec<Vec<String>> {
    let levels = &factor.levels;
    (0..levels.len())
        .flat_map(|a| {
            (a + 1..levels.len()).map(move |b| vec![levels[a].clone(), levels[b].clone()])
        })
        .collect()
}

/// A factor's levels as numbers; if they are words, their places in order.
fn as_numbers(factor: &Factor) -> Numbers {
    let numbers: Option<Vec<f64>> = factor.levels.iter().map(|level| level.parse().ok()).collect();
    let numbers = numbers.unwrap_or_else(|| (1..=factor.levels.len()).map(|i| i as f64).collect());
    let values =
        factor.codes.iter().map(|&code| numbers.get(code as usize).copied().unwrap_or(f64::NAN));
    Numbers { name: factor.name.clone(), values: values.collect() }
}
