//! Answers about two clips that are shown together: which factors of the clips they can be told of.

use std::borrow::Cow;
use std::collections::BTreeSet;

use crate::question::{KindOfQuestion as _, Question};
use crate::study_file::{Clip, Measure, Study, TrialsComponent};

/// Why the answers to a question cannot be told of the levels of a factor: they are about two clips.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum AnswerOfPair {
    /// The answer says which of two clips, not how one of them is.
    Choice {
        /// Identifier of the question.
        question: String,
        /// The factor.
        factor: String,
    },
    /// The answer is given to a clip and its companion together, and either may be why.
    Rating {
        /// Identifier of the question.
        question: String,
        /// The factor in which the two clips differ.
        factor: String,
        /// A clip that is shown so.
        clip: String,
        /// The clip beside it.
        beside: String,
    },
}

/// A clip of a trial, and what is played in step beside it.
type Shown<'c> = (&'c Clip, Option<&'c Clip>);

impl Study {
    /// The levels of `factor` that stand beside each other where `question` chooses between two clips, each two
    /// once, of the `levels` that are compared; all of them if there are none.
    pub fn levels_chosen_between(
        &self,
        question: &Question,
        factor: &str,
        levels: &[String],
    ) -> BTreeSet<[String; 2]> {
        let clips = self.clips();
        let mut pairs = BTreeSet::new();
        for block in &self.blocks_asking(question) {
            for (clip, other) in block.shown(&clips) {
                let other = other.and_then(|other| other.factor_text(factor));
                let (Some(one), Some(other)) = (clip.factor_text(factor), other) else { continue };
                let is_compared = |level| levels.is_empty() || levels.contains(level);
                if one != other && is_compared(&one) && is_compared(&other) {
                    pairs.insert(if one < other { [one, other] } else { [other, one] });
                }
            }
        }
        pairs
    }

    /// The blocks of trials that ask a question.
    fn blocks_asking(&self, question: &Question) -> Vec<Cow<'_, TrialsComponent>> {
        let blocks = self.trial_blocks().into_iter().map(|(_, block)| block);
        blocks.filter(|block| block.questions.contains(&question.id)).collect()
    }

    /// Why answers to `question` cannot be told of the levels of `factor`; `None` where they can be, as in
    /// trials of one clip. `levels` are those that are compared, all of them if there are none.
    ///
    /// Two clips that agree in the factor (the emotion of their segment) have its level together. Where they
    /// differ, an answer is about the clip alone only if every clip stands beside the same level of the
    /// factor, a reference that is not compared itself, such as the recorded performance.
    pub fn answer_of_pair(
        &self,
        question: &Question,
        measure: Measure,
        factor: &str,
        levels: &[String],
    ) -> Option<AnswerOfPair> {
        let blocks = self.blocks_asking(question);
        if !blocks.iter().any(|block| block.shows_two()) {
            return None;
        }
        let clips = self.clips();
        let level = |clip: &Clip| clip.factor_text(factor);
        let is_compared = |clip: &Clip| {
            let own = level(clip);
            own.is_some_and(|own| levels.is_empty() || levels.contains(&own))
        };
        let shown = blocks.iter().flat_map(|block| block.shown(&clips));
        let shown: Vec<Shown<'_>> = shown.filter(|(clip, _)| is_compared(clip)).collect();
        if shown.is_empty() {
            // The factor is about people.
            return None;
        }
        if question.kind.compares_clips() && measure == Measure::Answer {
            let (question, factor) = (question.id.clone(), factor.to_owned());
            return Some(AnswerOfPair::Choice { question, factor });
        }
        let (clip, beside) = ambiguous(&shown, level)?;
        Some(AnswerOfPair::Rating {
            question: question.id.clone(),
            factor: factor.to_owned(),
            clip: clip.id.clone(),
            beside: beside.id.clone(),
        })
    }
}

/// A clip and its companion either of which an answer may be about, as far as their levels say.
fn ambiguous<'c>(
    shown: &[Shown<'c>],
    level: impl Fn(&Clip) -> Option<String>,
) -> Option<(&'c Clip, &'c Clip)> {
    let both = |&(clip, beside): &Shown<'c>| beside.map(|beside| (clip, beside));
    let differs = |(clip, beside): &(&Clip, &Clip)| level(clip) != level(beside);
    let first = shown.iter().filter_map(both).find(differs)?;
    let reference = level(first.1);
    let is_compared = shown.iter().any(|(clip, _)| level(clip) == reference);
    let is_reference = |pair: &Shown<'_>| pair.1.is_some_and(|it| level(it) == reference);
    (is_compared || !shown.iter().all(is_reference)).then_some(first)
}
