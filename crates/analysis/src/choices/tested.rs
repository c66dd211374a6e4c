//! Tests of choices between the levels of a factor. Of two levels: the exact sign test, of each person's choices
//! and, taken for independent, of single trials. Of more: worths by Bradley and Terry's model, tested with errors
//! clustered by participant (of few people: Friedman's test on each one's wins) and, taken for independent, by the
//! likelihood ratio.

use mimique_stats::{
    Alternative, BradleyTerry, BradleyTerryOptions, Consistency, DefaultTest, Outcome,
    PairedComparisons, Thurstone, bradley_terry, consistency, thurstone,
};
use serde::Serialize;

use super::answers::{net_of_people, net_of_trials};
use crate::hypothesis::call::{Call, Design};
use crate::hypothesis::person_level::PersonLevel;
use crate::hypothesis::test_line::{TestLine, Unit};
use crate::hypothesis::trial_level::TrialLevel;
use crate::hypothesis::undefined::TestOutcome;

/// What was found of the choices between some levels.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct ChoiceTests {
    pub levels: Vec<String>,
    /// People who chose between any of them.
    pub people: usize,
    /// People who chose each level more often than the other, of two levels.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub people_for: Option<[usize; 2]>,
    /// Answers.
    pub trials: usize,
    pub as_in_the_thesis: TrialLevel,
    pub recommended: PersonLevel,
    /// Worths; none where no answer joins some of the levels.
    pub worths: Option<BradleyTerry>,
    /// Worths on a normal scale; none where they have no estimate.
    pub thurstone: Option<Thurstone>,
    /// Circular triads and agreement; none where not everybody chose once of each pair, without ties.
    pub consistency: Option<Consistency>,
}

/// Draws of answers for the lack of fit, of a report.
pub(crate) const FIT_ROUNDS: usize = 999;

/// Tests choices between levels; `fit_rounds` are draws of answers for the lack of fit, 0 where only the tests are wanted.
pub(crate) fn tested(
    question: &str,
    factor: &str,
    data: &PairedComparisons,
    fit_rounds: usize,
) -> ChoiceTests {
    let options = BradleyTerryOptions { fit_rounds, ..BradleyTerryOptions::default() };
    let call = |design, test| Call::new(design, test).text(question).text(factor).list(&data.items);
    let worths = bradley_terry(data, &options);
    let (trials, people) = match data.items.len() {
        2 => of_two(data, call),
        _ => match &worths {
            Ok(found) => of_several(data, found, call),
            Err(why) => (TestOutcome::undefined(why.clone()), TestOutcome::undefined(why.clone())),
        },
    };
    let worths = worths.ok();
    let defined = worths.as_ref().is_some_and(|found| found.estimates.reason().is_none());
    ChoiceTests {
        levels: data.items.clone(),
        people: data.participants.len(),
        people_for: (data.items.len() == 2).then(|| {
            let net = net_of_people(data).values;
            let count = |sign: f64| net.iter().filter(|own| sign * **own > 0.0).count();
            [count(1.0), count(-1.0)]
        }),
        trials: data.answers.len(),
        as_in_the_thesis: TrialLevel::new(vec![trials]),
        recommended: PersonLevel {
            people: data.participants.len(),
            incomplete: 0,
            overall: vec![people],
            pairs: Vec::new(),
        },
        thurstone: if defined {
            thurstone(data, &options).ok().and_then(Outcome::ok)
        } else {
            None
        },
        consistency: consistency(data).ok().and_then(Outcome::ok),
        worths,
    }
}

/// Sign tests of trials and of people.
fn of_two(
    data: &PairedComparisons,
    call: impl Fn(Design, &'static str) -> Call,
) -> (TestOutcome, TestOutcome) {
    let sign = |net, unit: Unit, of: &str| {
        let call = call(Design::NetChoices, "sign_test").text(of);
        TestLine::sign(&net, Alternative::TwoSided, &unit, call)
    };
    (
        sign(net_of_trials(data), Unit::Trials, "trials"),
        sign(net_of_people(data), Unit::ChoicesOfPeople, "people"),
    )
}

/// The likelihood ratio, and the test that knows of participants.
fn of_several(
    data: &PairedComparisons,
    found: &BradleyTerry,
    call: impl Fn(Design, &'static str) -> Call,
) -> (TestOutcome, TestOutcome) {
    let (few, has_side) = match &found.estimates {
        Outcome::Ok(own) => (own.default_test == DefaultTest::FriedmanOnWins, own.side.is_some()),
        Outcome::Undefined { .. } => (false, false),
    };
    let worths = |test| call(Design::Choices, test).number(usize::from(has_side));
    let ratio = TestLine::worths_ratio(found, worths("bradley_terry_ratio"));
    let people = match data.wins().filter(|_| few) {
        Some(wins) => TestLine::friedman_on_wins(&wins, call(Design::Wins, "friedman")),
        None => TestLine::worths(found, worths("bradley_terry")),
    };
    (ratio, people)
}
