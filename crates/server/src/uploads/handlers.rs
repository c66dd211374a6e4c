//! `/researcher/upload` and what an owner does with a study.

use axum::extract::multipart::Multipart;
use axum::extract::{FromRequest, Path, Request, State};
use axum::http::StatusCode;
use axum::response::Response;
use mimique_storage::Role;
use mimique_study::Issue;
use serde::Deserialize;

use super::pages::{preparing_page, upload_page};
use crate::accounts::audit::audit;
use crate::accounts::csrf::{FormToken, Guarded, check_origin};
use crate::accounts::identity::Researcher;
use crate::error::Error;
use crate::http::responses::see;
use crate::researcher::pages::frame::Frame;
use crate::state::App;
use crate::state::hosted_study::Stage;
use crate::state::preparations::{Noted, Preparation};
use crate::uploads::{self, Incoming, Taken};

pub(crate) async fn page(State(app): State<App>, who: Researcher) -> Result<Response, Error> {
    may_upload(&who)?;
    Ok(upload_page(&Frame::new(&app, &who), None, &[]))
}

/// Owners of the server upload any study, owners of a study new versions of it.
fn may_upload(who: &Researcher) -> Result<(), Error> {
    if who.most() >= Role::Owner { Ok(()) } else { Err(Error::NotAllowed) }
}

/// The form's token comes first, so that nothing is taken in for a forged form.
pub(crate) async fn upload(State(app): State<App>, request: Request) -> Result<Response, Error> {
    let who = Researcher::of(&app, request.headers()).await?;
    may_upload(&who)?;
    let is_person = who.session().is_some();
    if is_person {
        check_origin(&app, request.headers())?;
    }
    let no_form = |_| Error::NotAnUpload;
    let mut form = Multipart::from_request(request, &app).await.map_err(no_form)?;
    let broken = |_| Error::BrokenUpload;
    let mut own = !is_person;
    while let Some(mut field) = form.next_field().await.map_err(broken)? {
        match field.name().unwrap_or_default() {
            "csrf" if is_person => {
                let sent = field.chunk().await.map_err(broken)?.unwrap_or_default();
                let sent = String::from_utf8_lossy(&sent).into_owned();
                own = FormToken::of(&app, &who).is(&sent);
            }
            "study" => {
                if !own {
                    return Err(Error::ForeignForm);
                }
                let mut incoming = Incoming::open(&app).await?;
                while let Some(chunk) = field.chunk().await.map_err(broken)? {
                    incoming.add(&chunk).await?;
                }
                let arrived = incoming.finish().await?;
                return answer(&app, &who, uploads::take(&app, Some(&who), arrived).await);
            }
            _ => {}
        }
    }
    Err(if own { Error::NoFile } else { Error::ForeignForm })
}

fn answer(app: &App, who: &Researcher, taken: Result<Taken, Error>) -> Result<Response, Error> {
    let frame = Frame::new(app, who);
    let refused = |problem: &str, issues: &[Issue]| {
        let issues: Vec<Noted> = issues.iter().map(Noted::from).collect();
        let mut page = upload_page(&frame, Some(problem), &issues);
        *page.status_mut() = StatusCode::UNPROCESSABLE_ENTITY;
        page
    };
    match taken {
        Ok(Taken::Refused(issues)) => {
            let problem = frame.say(
                "The study has errors: correct them and upload it again.",
                "L’étude contient des erreurs : corrigez-les et déposez-la à nouveau.",
            );
            Ok(refused(problem, &issues))
        }
        Ok(Taken::Accepted { study_id }) => Ok(see(&format!("/researcher/upload/{study_id}"))),
        Err(error) if matches!(error.code(), "bad-upload" | "bad-request") => {
            Ok(refused(&error.sentence(who.language), &[]))
        }
        Err(error) => Err(error),
    }
}

pub(crate) async fn preparing(
    State(app): State<App>,
    Path(id): Path<String>,
    who: Researcher,
) -> Result<Response, Error> {
    who.needs_in(&id, Role::Owner)?;
    let known = Preparation::of(&app.storage, &id).await?.ok_or(Error::NotFound)?;
    Ok(preparing_page(&Frame::in_study(&app, &who, &id), &id, &known))
}

#[derive(Deserialize)]
pub(crate) struct StageForm {
    stage: String,
}

pub(crate) async fn stage(
    State(app): State<App>,
    Path(id): Path<String>,
    Guarded { who, form }: Guarded<StageForm>,
) -> Result<Response, Error> {
    who.needs_in(&id, Role::Owner)?;
    let stage = match form.stage.as_str() {
        "pilot" => Stage::Pilot,
        "live" => Stage::Live,
        _ => return Err(Error::NoSuchPhase),
    };
    uploads::set_stage(&app, app.study(&id)?.id(), stage).await?;
    audit(&app, &who, "set the stage", &id, stage.word()).await?;
    Ok(see(&format!("/researcher/studies/{id}")))
}

#[derive(Deserialize)]
pub(crate) struct Nothing {}

pub(crate) async fn remove(
    State(app): State<App>,
    Path(id): Path<String>,
    Guarded { who, .. }: Guarded<Nothing>,
) -> Result<Response, Error> {
    who.needs_in(&id, Role::Owner)?;
    uploads::remove(&app, app.study(&id)?.id()).await?;
    audit(&app, &who, "host no more", &id, "").await?;
    Ok(see("/researcher"))
}
