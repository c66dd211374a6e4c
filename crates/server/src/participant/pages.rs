//! Pages: participant's, preview, the list of studies; readiness.

use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};

use axum::extract::{Path, Query, RawQuery, State};
use axum::http::{HeaderMap, HeaderValue, StatusCode, header};
use axum::response::{Html, IntoResponse, Redirect, Response};
use maud::{DOCTYPE, html};
use mimique_storage::{Role, StorageError};
use serde::Deserialize;

use crate::accounts::identity::Researcher;
use crate::clock::now_ms;
use crate::error::Error;
use crate::http::headers::{Embeddable, PERMISSIONS_POLICY, WITH_CAMERA, content_security_policy};
use crate::http::language::accepted;
use crate::state::App;
use mimique_study::Multilingual as _;

/// The list of studies, for those who may know it.
pub(crate) async fn index(State(app): State<App>, headers: HeaderMap) -> Response {
    if app.access.studio_alone {
        return Redirect::temporary("/studio").into_response();
    }
    let assets = app.assets.prefix();
    // Which studies there are is for those who were told.
    let who = may_look(&app, &headers).await;
    let is_open = who.is_ok();
    let mut studies = Vec::new();
    if let Ok(who) = who {
        let may_see = |id: &str| who.as_ref().is_none_or(|who| who.role_in(id) > Role::Nothing);
        studies.extend(app.catalogue.studies().into_iter().filter(|study| may_see(study.id())));
    }
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta name="robots" content="noindex";
                title { "Studies" }
                link rel="icon" href={ (assets) "/style/icon.svg" } type="image/svg+xml";
                link rel="stylesheet" href={ (assets) "/style/style.css" };
            }
            body {
                main.page {
                    h1 { "Studies" }
                    @if !is_open {
                        p { "Open the address that you were given." }
                        p lang="fr" { "Ouvrez l’adresse qui vous a été donnée." }
                    }
                    @for study in studies {
                        @let language = study.study().default_language();
                        section.card lang=(language) {
                            h2 { (study.title(language)) }
                            p { (study.study().study_metadata.description.in_language(language)) }
                            div.actions {
                                a.button.primary href={ "/s/" (study.id()) "/" } lang="en" {
                                    "Take part"
                                }
                            }
                        }
                    }
                }
            }
        }
    };
    Html(page.into_string()).into_response()
}

/// The page's addresses are relative to the slash; what recruitment appended goes along.
pub(crate) async fn participant_without_slash(
    State(app): State<App>,
    Path(study): Path<String>,
    RawQuery(query): RawQuery,
) -> Result<Response, Error> {
    let study = app.study(&study)?;
    let query = query.map(|query| format!("?{query}")).unwrap_or_default();
    let address = format!("/s/{}/{query}", study.id());
    Ok((StatusCode::PERMANENT_REDIRECT, [(header::LOCATION, address)]).into_response())
}

/// What the address of the page asks for.
#[derive(Deserialize)]
pub(crate) struct Asked {
    /// A language.
    lang: Option<String>,
}

pub(crate) async fn participant(
    State(app): State<App>,
    Path(study): Path<String>,
    Query(asked): Query<Asked>,
    headers: HeaderMap,
) -> Result<Response, Error> {
    let asked = asked.lang.as_deref();
    let page = from_template(&app, "participant/index.html", &study, asked, &headers)?;
    let triggers = app.study(&study)?.study().triggers.as_ref().map(|own| own.origin());
    let measures_faces = app.study(&study)?.study().mimicry.is_some();
    let embedding = &app.settings.embedding;
    let mut page = match embedding.is_empty() {
        true => answered(page),
        false => answered(embedded(&app, &study, &page)),
    };
    if triggers.is_some() || !embedding.is_empty() {
        let packs = app.settings.packs_address.as_deref();
        let policy = content_security_policy(packs, triggers.as_deref(), embedding);
        let policy = HeaderValue::from_str(&policy).map_err(Error::internal)?;
        page.headers_mut().insert(header::CONTENT_SECURITY_POLICY, policy);
    }
    if measures_faces {
        let permissions = HeaderValue::from_static(WITH_CAMERA);
        page.headers_mut().insert(PERMISSIONS_POLICY, permissions);
    }
    if !embedding.is_empty() {
        page.extensions_mut().insert(Embeddable);
    }
    Ok(page)
}

pub(crate) async fn preview(
    State(app): State<App>,
    Path(study): Path<String>,
    headers: HeaderMap,
) -> Result<Response, Error> {
    may_preview(&app, &study, &headers).await?;
    from_template(&app, "researcher/preview.html", &study, None, &headers).map(answered)
}

/// Lets those in who may see a study's stimuli.
pub(super) async fn may_preview(app: &App, study: &str, headers: &HeaderMap) -> Result<(), Error> {
    match may_look(app, headers).await? {
        Some(who) => who.needs_in(study, Role::Viewer),
        None => Ok(()),
    }
}

/// Lets researchers see what participants should not, or everybody (none) where the server is told so.
pub(crate) async fn may_look(app: &App, headers: &HeaderMap) -> Result<Option<Researcher>, Error> {
    if app.access.open_preview {
        return Ok(None);
    }
    Researcher::of(app, headers).await.map(Some)
}

/// The database is written to this often at most, however often somebody asks.
const LOOK_AGAIN_AFTER: Duration = Duration::from_secs(2);
/// An answer would not be stored in time either.
const LONGEST_LOOK: Duration = Duration::from_secs(5);

/// Whether answers can be stored: the database takes what is written, its schema is ours, we are not
/// stopping.
pub(crate) async fn ready(State(app): State<App>) -> Result<&'static str, Error> {
    if app.stopping.load(Ordering::Relaxed) {
        return Err(StorageError::Stopping.into());
    }
    if !app.storage.is_current().await? {
        return Err(Error::internal("the database's schema is not this binary's"));
    }
    let mut last = app.last_ready.lock().await;
    if last.is_none_or(|at| at.elapsed() > LOOK_AGAIN_AFTER) {
        *last = None;
        let trial = tokio::time::timeout(LONGEST_LOOK, app.storage.try_writing(now_ms()));
        trial.await.map_err(|_| Error::Unavailable)??;
        *last = Some(Instant::now());
    }
    Ok("ready\n")
}

fn from_template(
    app: &App,
    name: &str,
    study: &str,
    asked: Option<&str>,
    headers: &HeaderMap,
) -> Result<String, Error> {
    let study = app.study(study)?;
    let language = study.study().language_among(asked.into_iter().chain(accepted(headers)));
    let values = [
        ("assets", app.assets.prefix()),
        ("lang", language.to_owned()),
        ("title", study.title(language).to_owned()),
        ("study", study.id().to_owned()),
        ("packs", app.settings.packs_address.clone().unwrap_or_else(|| "/packs".into())),
    ];
    let values: Vec<(&str, &str)> = values.iter().map(|(name, text)| (*name, &**text)).collect();
    let page = app.assets.participant_page(name, &values, study.study(), language);
    page.ok_or(Error::NotFound)
}

fn answered(page: String) -> Response {
    let kept = [(header::CACHE_CONTROL, "no-cache"), (header::VARY, "accept-language")];
    (kept, Html(page)).into_response()
}

/// The page with what tells the page that embeds it where it stands.
fn embedded(app: &App, study: &str, page: &str) -> String {
    let script = html! {
        meta name="mimique-embedding" data-study=(study) data-origins=(app.settings.embedding.join(" "));
        script type="module" src={ (app.assets.prefix()) "/participant/embedded.js" } {}
    };
    page.replacen("</head>", &format!("{}</head>", script.into_string()), 1)
}
