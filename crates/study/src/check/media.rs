//! Pictures and sign-language videos of questions and their options: there, and of a kind that browsers show.

use super::FileLookup;
use super::Subject;
use super::issue::{Issues, below};
use super::problem::Problem;
use crate::question::{Choice, KindOfQuestion as _, Question};
use crate::study_file::{Component, LocalText, media_type};

pub(super) fn examine(subject: &Subject<'_>, lookup: &FileLookup<'_>, issues: &mut Issues) {
    let study = subject.study;
    let mut pages: Vec<(String, &[Question])> = Vec::new();
    if let Some(page) = &study.demographics {
        pages.push(("/demographics/questions".to_owned(), &page.questions));
    }
    pages.push(("/questions".to_owned(), &study.questions));
    for (name, component) in &study.components {
        if let Component::Questionnaire(page) = component {
            pages.push((format!("{}/questions", below("/components", name)), &page.questions));
        }
    }
    let mut named: Vec<(String, &str, &str)> = Vec::new();
    for (pointer, questions) in &pages {
        for (index, question) in questions.iter().enumerate() {
            let place = below(pointer, index);
            videos(&question.video, &below(&place, "video"), &mut named);
            choices(&question.signs, &below(&place, "signs"), &mut named);
            choices(question.kind.options(), &below(&place, "options"), &mut named);
            choices(question.kind.rows(), &below(&place, "rows"), &mut named);
        }
    }
    for (pointer, path, wanted) in named {
        if !media_type(path).is_some_and(|kind| kind.starts_with(wanted)) {
            let path = path.to_owned();
            let problem = match wanted {
                "video" => Problem::BadVideo { path },
                _ => Problem::BadImage { path },
            };
            issues.error(&pointer, problem);
        } else if let Err(problem) = lookup(path) {
            issues.error(&pointer, problem);
        }
    }
}

fn choices<'a>(
    options: &'a [Choice],
    pointer: &str,
    named: &mut Vec<(String, &'a str, &'static str)>,
) {
    for (index, option) in options.iter().enumerate() {
        let place = below(pointer, index);
        videos(&option.video, &below(&place, "video"), named);
        if let Some(path) = &option.image {
            named.push((below(&place, "image"), path, "image"));
        }
    }
}

fn videos<'a>(
    text: &'a Option<LocalText>,
    pointer: &str,
    named: &mut Vec<(String, &'a str, &'static str)>,
) {
    match text {
        None => {}
        Some(LocalText::Plain(path)) => named.push((pointer.to_owned(), path, "video")),
        Some(LocalText::Languages(paths)) => {
            named.extend(
                paths.iter().map(|(code, path)| (below(pointer, code), path.as_str(), "video")),
            );
        }
    }
}
