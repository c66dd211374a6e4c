//! Pages of uploading a study: the form, what the check found, how far preparing is.

use axum::response::Response;
use maud::{Markup, html};

use crate::researcher::pages::frame::Frame;
use crate::state::preparations::{Noted, Preparation, Preparing};

/// The form; `problem` is why the last upload was not taken, `issues` what the check found in it.
pub(crate) fn upload_page(frame: &Frame, problem: Option<&str>, issues: &[Noted]) -> Response {
    let title = frame.say("Upload a study", "Déposer une étude");
    let body = html! {
        p { a href="/researcher" { "← " (frame.say("Studies", "Études")) } }
        h1 { (title) }
        @if let Some(problem) = problem {
            div.notice.bad role="alert" { p { (problem) } }
        }
        @if !issues.is_empty() { (issue_list(frame, issues)) }
        div.card {
            form.stack method="post" action="/researcher/upload" enctype="multipart/form-data" {
                (frame.token())
                div.field {
                    label for="study" { (frame.say("Archive or study file", "Archive ou fichier d’étude")) }
                    p.hint #study-hint {
                        (frame.say(
                            "A ZIP archive of the study file (study.json) and every file that it names, up to 512 MiB; or a study file alone whose stimuli are built in.",
                            "Une archive ZIP du fichier d’étude (study.json) et de tous les fichiers qu’il nomme, jusqu’à 512 Mio ; ou un fichier d’étude seul, à stimuli intégrés.",
                        ))
                    }
                    input #study name="study" type="file" accept=".zip,.json" required aria-describedby="study-hint";
                }
                div.actions { button.primary type="submit" { (frame.say("Upload and check", "Déposer et vérifier")) } }
            }
            p.soft {
                (frame.say(
                    "It is checked as “mimique check” does, prepared, and hosted as a pilot.",
                    "Elle est vérifiée comme par « mimique check », préparée, puis hébergée comme pilote.",
                ))
            }
        }
    };
    frame.page(title, "/researcher/upload", &body)
}

/// How far a study is that was uploaded.
pub(crate) fn preparing_page(frame: &Frame, id: &str, known: &Preparation) -> Response {
    let title = format!("{} {id}", frame.say("Study", "Étude"));
    let body = html! {
        p { a href="/researcher" { "← " (frame.say("Studies", "Études")) } }
        div.card {
            h1 { (title) }
            @match &known.state {
                Preparing::Under { done, of } => {
                    div data-reload-s="2" {
                        p role="status" { (frame.say("The stimuli are being prepared.", "Les stimuli sont en préparation.")) }
                        @if *of > 0 {
                            div.progress-line {
                                progress max=(of) value=(done) aria-label=(frame.say("Clips ready", "Clips prêts")) {}
                                span.number { (done) "/" (of) }
                            }
                        }
                    }
                }
                Preparing::Ready { warnings } => {
                    div.notice.good role="status" {
                        p { (frame.say("The study is hosted as a pilot.", "L’étude est hébergée comme pilote.")) }
                    }
                    @for warning in warnings { p { span.tag.warn { (frame.say("warning", "avertissement")) } " " (warning) } }
                    p { a.button.primary href={ "/researcher/studies/" (id) } { (frame.say("To the study", "Vers l’étude")) } }
                }
                Preparing::Failed { problem } => {
                    div.notice.bad role="alert" { p { (problem) } }
                    p { a.button href="/researcher/upload" { (frame.say("Upload it again", "La déposer à nouveau")) } }
                }
            }
        }
        @if !known.issues.is_empty() { (issue_list(frame, &known.issues)) }
    };
    frame.page(&title, "/researcher", &body)
}

fn issue_list(frame: &Frame, issues: &[Noted]) -> Markup {
    let errors = issues.iter().filter(|issue| issue.is_error).count();
    html! {
        div.card {
            h2 { (frame.say("What the check found", "Résultat de la vérification")) }
            p {
                (errors) " " (frame.say("errors", "erreurs")) ", " (issues.len() - errors) " "
                (frame.say("warnings", "avertissements"))
            }
            ul.issues lang="en" {
                @for issue in issues {
                    li {
                        @if issue.is_error {
                            span.tag.bad { "error" }
                        } @else {
                            span.tag.warn { "warning" }
                        }
                        " " code { (issue.place) }
                        " " (issue.message) "; " (issue.remedy)
                    }
                }
            }
        }
    }
}
