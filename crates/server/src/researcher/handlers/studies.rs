//! `/researcher` and `/researcher/studies/…`: what happens, who takes part, exclusion, export, report.

use std::collections::BTreeMap;

use axum::extract::{Path, State};
use axum::http::{HeaderMap, HeaderValue, header};
use axum::response::{IntoResponse, Response};
use mimique_locale::Language;
use mimique_session::Standing;
use mimique_storage::{Exclusion, Role, SessionRecord, StorageError};
use mimique_study::Multilingual as _;
use serde::Deserialize;
use tokio_stream::StreamExt as _;

use super::inline_styles::report_policy;
use crate::accounts::audit::{self, audit};
use crate::accounts::csrf::Guarded;
use crate::accounts::identity::Researcher;
use crate::clock::now_ms;
use crate::error::Error;
use crate::export::{self, Cells, Export, Format, Options};
use crate::http::extract::Asked;
use crate::http::responses::{attachment, see, whole_address};
use crate::participant::withdrawal::withdrawal_hash;
use crate::researcher::dashboard::overview::{Notice, Overview, Person, Wanted};
use crate::researcher::pages::frame::Frame;
use crate::researcher::pages::home::{Listed, home_page};
use crate::researcher::pages::participant::{EventRow, MOST_EVENTS, Shown, participant_page};
use crate::researcher::pages::standing_words::list_word;
use crate::researcher::pages::study::{Hosting, study_page};
use crate::retention;
use crate::state::App;
use crate::state::hosted_study::HostedStudy;
use crate::uploads;

pub(crate) async fn home(State(app): State<App>, who: Researcher) -> Result<Response, Error> {
    let uploads: BTreeMap<_, _> = app
        .storage
        .uploads()
        .await?
        .into_iter()
        .map(|upload| (upload.study_id, upload.changed_ms))
        .collect();
    let counts = app.storage.session_counts().await?;
    let mut listed = Vec::new();
    for study in app.catalogue.studies() {
        if who.role_in(study.id()) == Role::Nothing {
            continue;
        }
        let own = || counts.iter().filter(|([id, ..], _)| id == study.id());
        let sessions = own().map(|(_, count)| count).sum();
        let is_completed = |[_, _, status]: &[String; 3]| {
            Standing::from_stored_word(status) == Some(Standing::Completed)
        };
        let completed = own().filter(|(of, _)| is_completed(of)).map(|(_, count)| count).sum();
        let uploaded_ms = uploads.get(study.id()).copied();
        listed.push(Listed { study, sessions, completed, uploaded_ms });
    }
    let may_upload = who.most() >= Role::Owner;
    let doubt = retention::clock_doubt(&app.storage, now_ms()).await?;
    Ok(home_page(&Frame::new(&app, &who), &listed, doubt, may_upload))
}

/// Which participants the page lists.
#[derive(Deserialize)]
pub(crate) struct ListQuery {
    /// Those who stand so alone, by the word that is stored (`abandoned` for those without a sign of life).
    standing: Option<String>,
    /// Which page of them, from 1.
    page: Option<usize>,
}

pub(crate) async fn study(
    State(app): State<App>,
    Path(id): Path<String>,
    Asked(query): Asked<ListQuery>,
    who: Researcher,
) -> Result<Response, Error> {
    let study = visible(&app, &who, &id, Role::Viewer)?;
    let standing = query.standing.as_deref().map(standing_of).transpose()?;
    let wanted = Wanted { standing, page: query.page.unwrap_or(1).saturating_sub(1) };
    let language = study.study().language_for(who.language.code());
    let overview = Overview::load(&app.storage, &study, &app.sums, language, wanted).await?;
    let is_uploaded = uploads::is_uploaded(&app, study.id()).await?;
    let overdue = app.storage.overdue(study.id()).await?;
    let hosting = Hosting { is_uploaded, overdue };
    Ok(study_page(&Frame::in_study(&app, &who, study.id()), &study, &overview, hosting))
}

/// The standing that an address names.
fn standing_of(word: &str) -> Result<Standing, Error> {
    let found = Standing::ALL.into_iter().find(|standing| list_word(*standing) == word);
    found.ok_or(Error::NotFound)
}

/// A study in which somebody may do so much.
pub(super) fn visible(
    app: &App,
    who: &Researcher,
    id: &str,
    role: Role,
) -> Result<std::sync::Arc<HostedStudy>, Error> {
    who.needs_in(id, role)?;
    app.study(id)
}

pub(crate) async fn participant(
    State(app): State<App>,
    Path((id, number)): Path<(String, u64)>,
    who: Researcher,
) -> Result<Response, Error> {
    let study = visible(&app, &who, &id, Role::Viewer)?;
    let session = session(&app, study.id(), number).await?;
    let sums = app.sums.of_session(&app.storage, &session).await?;
    let notice = Notice::of(&app.storage, &session).await?;
    let events = first_events(&app, &session).await?;
    let mut exclusions = app.storage.exclusions(study.id()).await?;
    exclusions.retain(|change| change.session_key == session.key);
    if who.role_in(study.id()) >= Role::Analyst {
        let subject = mimique_storage::participant_id(number);
        audit(&app, &who, "read a participant’s answers", study.id(), &subject).await?;
    }
    let person = Person { session, sums, notice };
    let shown = Shown { study: &study, person: &person, events: &events, exclusions: &exclusions };
    Ok(participant_page(&Frame::in_study(&app, &who, study.id()), &shown))
}

/// The events that the page shows, and one more where there are more.
async fn first_events(app: &App, session: &SessionRecord) -> Result<Vec<EventRow>, Error> {
    let stored = app.storage.stored_events(session.key, 0..session.next_sequence);
    let mut stored = stored.take(MOST_EVENTS + 1);
    let mut events = Vec::new();
    while let Some(event) = stored.next().await {
        events.push(EventRow::of(&event?));
    }
    Ok(events)
}

#[derive(Deserialize)]
pub(crate) struct Reason {
    reason: String,
}

pub(crate) async fn exclude(
    State(app): State<App>,
    Path((id, number)): Path<(String, u64)>,
    Guarded { who, form }: Guarded<Reason>,
) -> Result<Response, Error> {
    const LONGEST: usize = 200;
    let study = visible(&app, &who, &id, Role::Analyst)?;
    let reason = form.reason.split_whitespace().collect::<Vec<_>>().join(" ");
    let reason: String = reason.chars().filter(|c| !c.is_control()).take(LONGEST).collect();
    if reason.is_empty() {
        return Err(Error::NoReason);
    }
    change_exclusion(&app, &who, &study, number, Some(reason)).await
}

#[derive(Deserialize)]
pub(crate) struct Nothing {}

pub(crate) async fn include(
    State(app): State<App>,
    Path((id, number)): Path<(String, u64)>,
    Guarded { who, .. }: Guarded<Nothing>,
) -> Result<Response, Error> {
    let study = visible(&app, &who, &id, Role::Analyst)?;
    change_exclusion(&app, &who, &study, number, None).await
}

#[derive(Deserialize)]
pub(crate) struct Confirmation {
    confirmation: String,
}

/// Deletes as the participant's withdrawal and `mimique erase` do.
pub(crate) async fn erase(
    State(app): State<App>,
    Path((id, number)): Path<(String, u64)>,
    Guarded { who, form }: Guarded<Confirmation>,
) -> Result<Response, Error> {
    let study = visible(&app, &who, &id, Role::Owner)?;
    let name =
        mimique_storage::participant_id(session(&app, study.id(), number).await?.participant);
    if !form.confirmation.trim().eq_ignore_ascii_case(&name) {
        return Err(Error::NotConfirmed { participant: name });
    }
    app.storage.erase_participant(study.id(), number, &audit::name(&who), now_ms()).await?;
    Ok(see(&format!("/researcher/studies/{}/participants/{number}", study.id())))
}

#[derive(Deserialize)]
pub(crate) struct Code {
    code: String,
}

/// Deletes the answers of whoever brought this withdrawal code to the researcher.
pub(crate) async fn withdraw(
    State(app): State<App>,
    Path(id): Path<String>,
    Guarded { who, form }: Guarded<Code>,
) -> Result<Response, Error> {
    let study = visible(&app, &who, &id, Role::Owner)?;
    let hash = withdrawal_hash(&form.code);
    let name = audit::name(&who);
    let done = app.storage.withdraw_by_code(Some(study.id()), &hash, &name, now_ms()).await?;
    Ok(see(&format!("/researcher/studies/{}/participants/{}", study.id(), done.participant)))
}

/// Keeps answers that were found to be over their time.
pub(crate) async fn keep_overdue(
    State(app): State<App>,
    Path(id): Path<String>,
    Guarded { who, .. }: Guarded<Nothing>,
) -> Result<Response, Error> {
    let study = visible(&app, &who, &id, Role::Owner)?;
    let kept = app.storage.keep_overdue(study.id()).await?;
    audit(&app, &who, "keep answers over their time", study.id(), &kept.to_string()).await?;
    Ok(see(&format!("/researcher/studies/{}", study.id())))
}

/// An owner has looked at the server's clock.
pub(crate) async fn confirm_clock(
    State(app): State<App>,
    Guarded { who, .. }: Guarded<Nothing>,
) -> Result<Response, Error> {
    who.needs(Role::Owner)?;
    let now = now_ms();
    retention::confirm_clock(&app.storage, now).await?;
    audit(&app, &who, "confirm the clock", "", &mimique_study::iso_time(now as f64)).await?;
    Ok(see("/researcher"))
}

async fn change_exclusion(
    app: &App,
    who: &Researcher,
    study: &HostedStudy,
    number: u64,
    reason: Option<String>,
) -> Result<Response, Error> {
    let session = session(app, study.id(), number).await?;
    let action = if reason.is_some() { "exclude" } else { "take an exclusion back" };
    let at_ms = now_ms();
    let by = who.account.email.clone();
    let exclusion = Exclusion { session_key: session.key, reason, who: by, at_ms };
    app.storage.add_exclusion(&exclusion).await?;
    audit(app, who, action, study.id(), &mimique_storage::participant_id(number)).await?;
    Ok(see(&format!("/researcher/studies/{}/participants/{number}", study.id())))
}

pub(super) async fn session(app: &App, study: &str, number: u64) -> Result<SessionRecord, Error> {
    match app.storage.participant_session(study, number).await {
        Err(StorageError::UnknownSession) => Err(Error::NotFound),
        found => Ok(found?),
    }
}

/// What may be asked of an export.
#[derive(Deserialize)]
pub(crate) struct ExportQuery {
    #[serde(default)]
    with_identifiers: bool,
    #[serde(default)]
    neutralised: bool,
}

pub(crate) async fn export(
    State(app): State<App>,
    Path((id, word)): Path<(String, String)>,
    Asked(query): Asked<ExportQuery>,
    who: Researcher,
) -> Result<Response, Error> {
    let study = visible(&app, &who, &id, Role::Analyst)?.id().to_owned();
    let subject =
        if query.with_identifiers { format!("{word}, identifiers") } else { word.clone() };
    let cells = if query.neutralised { Cells::Neutralised } else { Cells::AsTheyAre };
    let options = Options { with_identifiers: query.with_identifiers, cells };
    let (name, bytes) = match (Format::from_word(&word), word.as_str()) {
        (Some(format), _) => {
            let export = Export::open(&app.storage, Some(&study), format, options).await?;
            audit(&app, &who, "export", &study, &subject).await?;
            return attachment(&export.download_name(), export.into_body());
        }
        (None, "dictionary") => {
            let bytes = export::dictionary(&app.storage, &study).await?;
            (format!("{study}_dictionary.csv"), bytes)
        }
        (None, "stimuli") => {
            let (id, bytes) = export::stimuli(&app.storage, Some(&study)).await?;
            (format!("{id}_stimuli.csv"), bytes)
        }
        (None, "courses") => {
            let (id, bytes) = export::courses(&app.storage, Some(&study)).await?;
            (format!("{id}_courses.csv"), bytes)
        }
        (None, "study") => {
            (format!("{study}.json"), export::study_file(&app.storage, &study).await?)
        }
        _ => return Err(Error::NotFound),
    };
    audit(&app, &who, "export", &study, &subject).await?;
    attachment(&name, bytes)
}

/// A file of the report, or all of them as `report.zip`.
pub(crate) async fn report(
    State(app): State<App>,
    Path((id, code, name)): Path<(String, String, String)>,
    headers: HeaderMap,
    who: Researcher,
) -> Result<Response, Error> {
    let study = visible(&app, &who, &id, Role::Analyst)?;
    let language = Language::from_code(&code).ok_or(Error::NotFound)?;
    let mut preview = format!("/preview/{}", study.id());
    if name != "report.html" {
        // A report that is saved leads here, too.
        preview = whole_address(&app, &headers, &preview);
    }
    let report = app.reports.get(&app.storage, &study, language, &preview).await?;
    if name == "report.zip" {
        let files = tokio::task::spawn_blocking(move || {
            mimique_figure_pdf::with_pdfs(&report.files, |told| tracing::warn!("{told}"))
        });
        let files = files.await.map_err(Error::internal)?;
        audit(&app, &who, "export", study.id(), "report").await?;
        let folder = format!("{}_report", study.id());
        return attachment(&format!("{folder}.zip"), export::zip(&folder, &files)?);
    }
    let file = report.files.iter().find(|file| file.path == name).ok_or(Error::NotFound)?;
    if name == "report.html" {
        audit(&app, &who, "read the report", study.id(), "").await?;
        let policy = HeaderValue::from_str(&report_policy(&file.text)).map_err(Error::internal)?;
        let kind = HeaderValue::from_static("text/html; charset=utf-8");
        let headers = [(header::CONTENT_TYPE, kind), (header::CONTENT_SECURITY_POLICY, policy)];
        return Ok((headers, file.text.clone()).into_response());
    }
    let name = name.rsplit('/').next().unwrap_or_default().to_owned();
    attachment(&name, file.text.clone().into_bytes())
}
