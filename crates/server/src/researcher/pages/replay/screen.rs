//! What stood on a screen: heading, text and questions of a view of the participant's page.

use mimique_session::flow::{AgreementView, FeedbackView, QuestionView, TrialView, View};

use super::Asked;
use crate::researcher::pages::frame::Frame;

/// What stood on a screen.
pub(super) struct Screen {
    pub heading: String,
    pub text: Vec<String>,
    pub questions: Vec<Asked>,
}

/// That of a view. What the page says at its end is no page of the plan.
pub(super) fn screen(frame: &Frame, view: &View) -> Screen {
    match view {
        View::Consent { agreement, .. } => consent(agreement),
        View::Questions { title, text, questions, .. } => Screen {
            heading: title.clone(),
            text: text.clone(),
            questions: questions.iter().map(asked).collect(),
        },
        View::Page { heading, text, .. } => page(heading, text.clone()),
        View::Device(device) => {
            let text = device.problems.iter().map(|(lack, remedy)| format!("{lack} {remedy}"));
            page(&device.heading, std::iter::once(device.text.clone()).chain(text).collect())
        }
        View::Calibration(calibration) => page(&calibration.heading, calibration.text.clone()),
        View::Scripted(sound) => page(&sound.heading, sound.text.clone()),
        View::Feedback(feedback) => self::feedback(feedback),
        View::Trial(trial) => self::trial(trial),
        View::ReceiptPending { heading, text, .. }
        | View::Declined { heading, text }
        | View::Withdrawn { heading, text, .. } => page(heading, vec![text.clone()]),
        View::End(_) => page(frame.say("End", "Fin"), Vec::new()),
    }
}

fn page(heading: &str, text: Vec<String>) -> Screen {
    let text = text.into_iter().filter(|each| !each.is_empty()).collect();
    Screen { heading: heading.to_owned(), text, questions: Vec::new() }
}

fn consent(agreement: &AgreementView) -> Screen {
    let sections = agreement.sections.iter().flat_map(|section| {
        std::iter::once(section.heading.clone()).chain(section.text.iter().cloned())
    });
    page(&agreement.title, std::iter::once(agreement.description.clone()).chain(sections).collect())
}

fn feedback(feedback: &FeedbackView) -> Screen {
    let items = feedback.items.iter().map(|item| {
        let right = item.right.as_deref().unwrap_or_default();
        format!("{} {} {right}", item.prompt, item.given).trim_end().to_owned()
    });
    page(&feedback.heading, items.chain(feedback.text.clone()).collect())
}

fn trial(trial: &TrialView) -> Screen {
    let panel = trial.panel.as_ref().map(|panel| panel.prompt.clone());
    Screen {
        heading: trial.heading.clone(),
        text: trial.instruction.iter().cloned().chain(panel).collect(),
        questions: trial.keys.iter().chain(&trial.questions).map(asked).collect(),
    }
}

fn asked(question: &QuestionView) -> Asked {
    Asked {
        id: question.id.clone(),
        prompt: question.prompt.clone(),
        kind: question.kind.clone(),
        value: question.value.clone(),
    }
}
