//! How much the verdicts of a study depend on choices of the analysis, on single segments and on single participants.
//!
//! In: the tidy export and the study file. Out: [`Sensitivity`], values without words. A specification is one set of the
//! study's rules of exclusion with one test of a hypothesis; the first specification is that of the study file. All of
//! them together are a multiverse analysis (Steegen, Tuerlinckx, Gelman and Vanpaemel 2016, Perspectives on Psychological
//! Science 11, 702) and are drawn as a specification curve (Simonsohn, Simmons and Nelson 2020, Nature Human Behaviour 4,
//! 1208). Nothing here is a test of its own: exclusions are those of `trials`, tests and corrections those of
//! `hypothesis`.

mod dependence;
mod finding;
mod influence;
mod rule_sets;

use mimique_locale::Language;
use mimique_stats::Table;
use mimique_study::Study;
use rayon::iter::{IntoParallelRefIterator, ParallelIterator};
use serde::Serialize;

pub(crate) use dependence::{Change, Dependence};
pub(crate) use finding::{Direction, Finding, TestChoice};
pub(crate) use influence::{Influence, Omission, OmittedUnit};

use crate::hypothesis::other_clips::OtherClipsTests;
use crate::hypothesis::{HypothesisResult, family, test_hypothesis};
use crate::naming::Naming;
use crate::trials::error::ExportError;
use crate::trials::export::Export;
use crate::trials::measure::MeasureKind;
use crate::trials::rule::Rule;

/// The sensitivity of every hypothesis of a study.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct Sensitivity {
    /// The rules of exclusion of the study file, with those of its panels.
    pub rules: Vec<Rule>,
    /// In the order of the study file.
    pub hypotheses: Vec<HypothesisSensitivity>,
}

/// The sensitivity of one hypothesis.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct HypothesisSensitivity {
    pub id: String,
    pub kind: MeasureKind,
    /// The first factor.
    pub factor: String,
    /// All specifications. The first is that of the study file.
    pub specifications: Vec<Specification>,
    /// The smallest sets of choices that change the verdict of the study file.
    pub dependence: Vec<Dependence>,
    /// Segments, then participants, each omitted in turn. Empty where there are fewer than two.
    pub influence: Vec<Influence>,
}

/// One set of rules with one test, and what it finds.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct Specification {
    /// Whether each of [`Sensitivity::rules`] is applied.
    pub applied: Vec<bool>,
    pub test: TestChoice,
    /// Participants whom the rules retain.
    pub people: usize,
    /// Trials that the rules retain.
    pub trials: usize,
    #[serde(flatten)]
    pub finding: Finding,
}

impl HypothesisSensitivity {
    /// The specification of the study file.
    pub(crate) fn of_the_study_file(&self) -> Option<&Specification> {
        self.specifications.first()
    }

    /// The omissions whose verdict is not that of the study file; none if that cannot be computed.
    pub(crate) fn changing<'i>(
        &self,
        influence: &'i Influence,
    ) -> impl Iterator<Item = &'i Omission> + use<'i> {
        let verdict = self.of_the_study_file().and_then(|own| own.finding.verdict.clone());
        (influence.omissions.iter()).filter(move |each| {
            let own = each.finding.verdict.as_ref();
            verdict.as_ref().zip(own).is_some_and(|(study_file, own)| study_file != own)
        })
    }
}

/// The results of every hypothesis under one set of rules.
struct UnderRules {
    applied: Vec<bool>,
    people: usize,
    trials: usize,
    results: Vec<HypothesisResult>,
}

/// Repeats the tests of every hypothesis under every set of rules, and without each segment and each participant.
/// `export` is the same table under the rules of the study file. An export that can be read by the rules of the study
/// file may have a cell that only other rules read: that is the error.
pub(crate) fn sensitivity(
    table: &Table,
    study: &Study,
    export: &Export,
) -> Result<Sensitivity, ExportError> {
    let rules = &export.flow.rules;
    if study.hypotheses.is_empty() {
        return Ok(Sensitivity { rules: rules.clone(), hypotheses: Vec::new() });
    }
    let universes: Vec<UnderRules> = rule_sets::of(rules.len())
        .par_iter()
        .map(|applied| {
            let varied = rule_sets::applied_in(study, rules, applied);
            let export = Export::read(table, &varied)?;
            Ok(UnderRules {
                applied: applied.clone(),
                people: export.flow.people_used,
                trials: export.flow.trials_used,
                results: results(&export, &varied, OtherClipsTests::Linear),
            })
        })
        .collect::<Result<_, ExportError>>()?;
    let mut influence = influence::of_hypotheses(export, study).into_iter();
    let of_hypothesis = |place: usize| {
        let own = universes.first().map(|first| &first.results[place])?;
        let specifications = specifications(&universes, place, own);
        Some(HypothesisSensitivity {
            id: own.id.clone(),
            kind: own.kind,
            factor: own.factors.first().cloned().unwrap_or_default(),
            dependence: dependence::of(&specifications),
            specifications,
            influence: influence.next().unwrap_or_default(),
        })
    };
    let hypotheses = (0..study.hypotheses.len()).filter_map(of_hypothesis).collect();
    Ok(Sensitivity { rules: rules.clone(), hypotheses })
}

/// The results of all hypotheses, with p corrected over them.
fn results(export: &Export, study: &Study, tests: OtherClipsTests) -> Vec<HypothesisResult> {
    // The readings are not used: any language will do.
    let naming = Naming { language: Language::English, study };
    let mut results: Vec<HypothesisResult> = (study.hypotheses.par_iter())
        .map(|hypothesis| test_hypothesis(&naming, export, study, hypothesis, tests))
        .collect();
    family::correct(&mut results);
    results
}

/// Every set of rules with every test. `own` is the result under the rules of the study file; its test comes first.
fn specifications(
    universes: &[UnderRules],
    place: usize,
    own: &HypothesisResult,
) -> Vec<Specification> {
    let tests = TestChoice::all_of(own);
    let with = |universe: &UnderRules, test: TestChoice| Specification {
        applied: universe.applied.clone(),
        test,
        people: universe.people,
        trials: universe.trials,
        finding: Finding::of(&universe.results, place, test),
    };
    let of_universe = |universe| tests.iter().map(move |test| with(universe, *test));
    universes.iter().flat_map(of_universe).collect()
}
