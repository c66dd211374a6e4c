//! The influence of single segments and participants: every hypothesis without each of them.

use mimique_study::Study;
use rayon::iter::{IntoParallelIterator, ParallelIterator};
use serde::Serialize;

use super::{Finding, TestChoice, results};
use crate::hypothesis::other_clips::OtherClipsTests;
use crate::trials::export::Export;

/// What is omitted, one at a time.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum OmittedUnit {
    /// A segment: its clips by every method.
    Segment,
    Participant,
}

/// What the analysis of the rest finds.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct Omission {
    /// Name of the segment, or `participant_id`.
    pub omitted: String,
    #[serde(flatten)]
    pub finding: Finding,
}

/// Every unit of a kind, each omitted in turn.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct Influence {
    pub unit: OmittedUnit,
    pub omissions: Vec<Omission>,
}

/// The influence of segments and of participants on each hypothesis, in the order of the study file, by the rules and the
/// tests of the study file. A kind of unit of which there are fewer than two is absent.
pub(super) fn of_hypotheses(export: &Export, study: &Study) -> Vec<Vec<Influence>> {
    let mut of_hypotheses: Vec<Vec<Influence>> = vec![Vec::new(); study.hypotheses.len()];
    let segments: Vec<String> = export.segments().iter().map(ToString::to_string).collect();
    let without_segment = |place: usize| export.without_segment(&segments[place]);
    let people = export.answering_people();
    let ids = people.iter().map(|person| export.people[*person].id.clone()).collect();
    let without_person = |place: usize| export.without_person(people[place]);
    let units: [(OmittedUnit, Vec<String>, &(dyn Fn(usize) -> Export + Sync)); 2] = [
        (OmittedUnit::Segment, segments.clone(), &without_segment),
        (OmittedUnit::Participant, ids, &without_person),
    ];
    for (unit, names, without) in units {
        if names.len() < 2 {
            continue;
        }
        let findings: Vec<Vec<Finding>> = (0..names.len())
            .into_par_iter()
            .map(|place| findings(&without(place), study))
            .collect();
        for (hypothesis, influence) in of_hypotheses.iter_mut().enumerate() {
            let omissions = names.iter().zip(&findings).map(|(name, own)| Omission {
                omitted: name.clone(),
                finding: own[hypothesis].clone(),
            });
            influence.push(Influence { unit, omissions: omissions.collect() });
        }
    }
    of_hypotheses
}

/// What the report's tests find of each hypothesis.
fn findings(export: &Export, study: &Study) -> Vec<Finding> {
    let results = results(export, study, OtherClipsTests::Deciding);
    let tests = results.iter().map(TestChoice::deciding).enumerate();
    tests.map(|(place, test)| Finding::of(&results, place, test)).collect()
}
