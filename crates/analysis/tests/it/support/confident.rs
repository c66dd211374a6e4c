//! The demonstration, whose choice of an emotion has a rating of confidence.

use mimique_study::{QuestionKind, Study};

/// The study with "believability" for the confidence of "emotion".
pub fn confident(mut study: Study) -> Study {
    let question = study.questions.iter_mut().find(|own| own.id == "emotion").unwrap();
    let QuestionKind::SingleChoice(choice) = &mut question.kind else { panic!("a choice") };
    choice.confidence = Some("believability".to_owned());
    study
}
