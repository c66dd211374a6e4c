//! What is right in practice trials.

use crate::answer::Answers;
use crate::question::{KindOfQuestion as _, Question};
use crate::study_file::{Clip, Training};

/// The right answers to a practice clip, as far as they are known: stated, or by a question's
/// factor.
pub fn right_answers(
    training: &Training,
    clip: &str,
    clips: &[Clip],
    questions: &[Question],
) -> Answers {
    let stated = training.answers.get(clip);
    let known = clips.iter().find(|each| each.id == clip);
    let of = |question: &Question| {
        if let Some(answer) = stated.and_then(|answers| answers.get(&question.id)) {
            return Some(answer.clone());
        }
        known?.factor_text(question.kind.truth()?).map(Into::into)
    };
    let mut right = Answers::new();
    for question in questions {
        if let Some(answer) = of(question) {
            right.insert(question.id.clone(), answer);
        }
    }
    right
}
