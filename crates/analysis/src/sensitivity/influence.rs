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
    let segments: Vec<String> = export.segments().iter().map(ToString::to_string).collect();
    let people = export.answering_people();
    let ids: Vec<String> = people.iter().map(|person| export.people[*person].id.clone()).collect();
    let without_segment = |place: usize| export.without_segment(&segments[place]);
    let without_person = |place: usize| export.without_person(people[place]);
    let of_segments = each_omitted(OmittedUnit::Segment, &segments, without_segment, study);
    let of_people = each_omitted(OmittedUnit::Participant, &ids, without_person, study);
    let own = |place: usize| {
        let both = [of_segments.get(place), of_people.get(place)];
        both.into_iter().flatten().cloned().collect()
    };
    (0..study.hypotheses.len()).map(own).collect()
}

/// Each unit of a kind omitted in turn, per hypothesis; `without` is the export without the unit at a place. Empty if there
/// are fewer than two units.
fn each_omitted(
    unit: OmittedUnit,
    names: &[String],
    without: impl Fn(usize) -> Export + Sync,
    study: &Study,
) -> Vec<Influence> {
    if names.len() < 2 {
        return Vec::new();
    }
    let findings: Vec<Vec<Finding>> =
        (0..names.len()).into_par_iter().map(|place| findings(&without(place), study)).collect();
    let of_hypothesis = |hypothesis: usize| {
        let omissions = names.iter().zip(&findings).map(|(name, own)| Omission {
            omitted: name.clone(),
            finding: own[hypothesis].clone(),
        });
        Influence { unit, omissions: omissions.collect() }
    };
    (0..study.hypotheses.len()).map(of_hypothesis).collect()
}

/// What the report's tests find of each hypothesis.
fn findings(export: &Export, study: &Study) -> Vec<Finding> {
    let results = results(export, study, OtherClipsTests::Deciding);
    let tests = results.iter().map(TestChoice::deciding).enumerate();
    tests.map(|(place, test)| Finding::of(&results, place, test)).collect()
}
