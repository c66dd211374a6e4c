//! The practice trials, with the pages that say what was right.

use mimique_study::{ClipShowing, StudyProjection, Training, right_answers};

use super::{Companion, Step, StepKind, TrialStep, questions};

/// Adds the practice trials of every round, with the pages that say what was right; returns where
/// each round ends.
pub(super) fn practice(
    study: &StudyProjection,
    training: &Training,
    steps: &mut Vec<Step>,
) -> Vec<usize> {
    let rounds = training.criterion.as_ref().map_or(1, |rule| rule.maximum_rounds.max(1));
    let mut ends = Vec::new();
    for round in 1..=rounds {
        let again = if round > 1 { format!("#{round}") } else { String::new() };
        for (index, clip) in training.clips.iter().enumerate() {
            let questions = questions(study, &training.questions);
            let right = right_answers(training, clip, &study.clips, &questions);
            let asked = !right.is_empty();
            let trial = TrialStep {
                clip: clip.clone(),
                questions,
                instruction: training.instruction.clone(),
                maximum_replays: None,
                training: true,
                number: index + 1,
                condition: "training".to_owned(),
                beside: training.beside.get(clip).map(|beside| Companion {
                    clip: beside.clone(),
                    left: false,
                    caption: None,
                    clip_caption: None,
                    in_turn: training.show == ClipShowing::InTurn,
                }),
                panel: None,
                face: None,
                active: None,
                right,
            };
            let id = format!("training/{}/{clip}{again}", index + 1);
            let time_limit = training.time_limit.clone();
            steps.push(Step { id, kind: StepKind::Trial(trial), time_limit });
            if training.feedback && asked {
                let of = steps.len() - 1;
                let id = format!("feedback/{}/{clip}{again}", index + 1);
                steps.push(Step::new(id, StepKind::Feedback { of }));
            }
        }
        ends.push(steps.len());
    }
    ends
}
