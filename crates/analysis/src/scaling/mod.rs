//! Blocks of difference scaling in the report: how a perceived difference grows with the parameter.

mod figure;
mod section;

use std::collections::HashMap;

use mimique_stats::{DifferenceJudgement, DifferenceScale, Outcome, difference_scaling};
use mimique_study::{Choice, KindOfQuestion as _, ScalingComponent, ScalingRule, Study};
use serde::Serialize;

use crate::trials::export::{Answer, Export};

/// Draws of people for the intervals.
pub(crate) const ROUNDS: usize = 2000;

/// The scale of a block.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct BlockScale {
    /// Name of the component.
    pub block: String,
    /// Its question.
    #[serde(skip)]
    pub question: String,
    /// The answer that the second pair differs more.
    #[serde(skip)]
    pub second: String,
    /// The parameter.
    pub parameter: String,
    /// Of all people together.
    pub scale: Outcome<DifferenceScale>,
}

/// The scale of every block of difference scaling whose question was answered about three levels or more; intervals by
/// `rounds` draws of people.
pub(crate) fn scales(export: &Export, study: &Study, rounds: usize) -> Vec<BlockScale> {
    let of = |(name, block): (&str, ScalingComponent)| {
        let question = study.questions.iter().find(|question| question.id == block.question)?;
        let options: &[Choice; 2] = question.kind.options().try_into().ok()?;
        let judgements = judgements(export, name, &block, options);
        let scale = difference_scaling(&judgements, rounds, study.seed).ok()?;
        let ScalingComponent { question, parameter, .. } = block;
        let second = options[1].value.clone();
        Some(BlockScale { block: name.to_owned(), question, second, parameter, scale })
    };
    study.scalings().filter_map(of).collect()
}

fn judgements(
    export: &Export,
    name: &str,
    block: &ScalingComponent,
    [first, second]: &[Choice; 2],
) -> Vec<DifferenceJudgement> {
    let mut places: HashMap<usize, usize> = HashMap::new();
    let mut judged = |answer: &Answer| {
        let (own, levels) = export.trials[answer.trial].scaled.as_ref()?;
        let levels = ScalingRule::pairs(levels).filter(|_| &**own == name)?;
        let second_differs_more = match &*answer.text {
            text if *text == *second.value => true,
            text if *text == *first.value => false,
            _ => return None,
        };
        let next = places.len();
        let participant = *places.entry(answer.person).or_insert(next);
        Some(DifferenceJudgement { participant, levels, second_differs_more })
    };
    export.answers_to(&block.question).iter().filter_map(&mut judged).collect()
}
