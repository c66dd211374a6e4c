//! `/researcher/people`: who has an account, and what each may do.

use axum::extract::{Path, State};
use axum::http::HeaderMap;
use axum::response::Response;
use mimique_storage::{LinkPurpose, Role, StudyRole};
use serde::Deserialize;

use super::accounts::{person_only, role};
use crate::accounts::audit::audit;
use crate::accounts::csrf::Guarded;
use crate::accounts::email::normal_email;
use crate::accounts::identity::Researcher;
use crate::accounts::links;
use crate::clock::now_ms;
use crate::error::Error;
use crate::http::responses::{see, whole_address};
use crate::researcher::pages::frame::Frame;
use crate::researcher::pages::people::{Done, Everybody, people_page};
use crate::state::App;

pub(crate) async fn people(State(app): State<App>, who: Researcher) -> Result<Response, Error> {
    everybodys_page(&app, &who, None).await
}

#[derive(Deserialize)]
pub(crate) struct Invitation {
    email: String,
    role: String,
    /// The study in which the role is; empty: in all.
    #[serde(default)]
    study: String,
}

pub(crate) async fn invite(
    State(app): State<App>,
    headers: HeaderMap,
    Guarded { who, form }: Guarded<Invitation>,
) -> Result<Response, Error> {
    // A token that could make accounts, or ways into them, could not be revoked.
    person_only(&who)?;
    who.needs(Role::Owner)?;
    let role = role(&form.role)?;
    if role == Role::Nothing {
        return Err(Error::NoSuchRole);
    }
    let study = match form.study.as_str() {
        "" => None,
        id => Some(app.study(id)?.id().to_owned()),
    };
    let link = links::invite(&app, &form.email, role, study.clone()).await?;
    let whom = normal_email(&form.email).unwrap_or_default();
    let subject = format!("{whom} ({})", role.word());
    audit(&app, &who, "invite", study.as_deref().unwrap_or_default(), &subject).await?;
    let address = whole_address(&app, &headers, &link);
    everybodys_page(&app, &who, Some(Done::Link { whom, address })).await
}

#[derive(Deserialize)]
pub(crate) struct PersonAction {
    action: String,
    #[serde(default)]
    role: String,
    #[serde(default)]
    study: String,
}

pub(crate) async fn person(
    State(app): State<App>,
    Path(key): Path<i64>,
    headers: HeaderMap,
    Guarded { who, form }: Guarded<PersonAction>,
) -> Result<Response, Error> {
    person_only(&who)?;
    who.needs(Role::Owner)?;
    let accounts = app.storage.accounts().await?;
    let account = accounts.into_iter().find(|account| account.key == key);
    let account = account.ok_or(Error::NotFound)?;
    let mut done = None;
    let last = Error::LastOwner;
    let mut study = String::new();
    let subject = match form.action.as_str() {
        "role" => {
            let role = role(&form.role)?;
            if !app.storage.set_role(key, role).await? {
                return Err(last);
            }
            format!("{} ({})", account.email, role.word())
        }
        "study-role" => {
            let role = role(&form.role)?;
            study = form.study.clone();
            // A study that is hosted no more can still be taken from somebody.
            if role > Role::Nothing {
                app.study(&study)?;
            }
            let given = StudyRole { account_key: key, study_id: study.clone(), role };
            app.storage.set_study_role(&given).await?;
            format!("{} ({})", account.email, role.word())
        }
        "disable" => {
            if !app.storage.disable_account(key, now_ms()).await? {
                return Err(last);
            }
            account.email.clone()
        }
        "enable" => {
            app.storage.enable_account(key).await?;
            account.email.clone()
        }
        "reset" if account.disabled_ms.is_some() => return Err(Error::AccountDisabled),
        "reset" => {
            let purpose = LinkPurpose::Reset;
            let (email, role) = (&account.email, account.role);
            let link = links::new_link(&app.storage, purpose, email, role, None).await?;
            let address = whole_address(&app, &headers, &link);
            done = Some(Done::Link { whom: account.email.clone(), address });
            account.email.clone()
        }
        _ => return Err(Error::UnknownAction),
    };
    audit(&app, &who, &format!("account: {}", form.action), &study, &subject).await?;
    match done {
        Some(done) => everybodys_page(&app, &who, Some(done)).await,
        None => Ok(see("/researcher/people")),
    }
}

async fn everybodys_page(
    app: &App,
    who: &Researcher,
    done: Option<Done>,
) -> Result<Response, Error> {
    who.needs(Role::Owner)?;
    let accounts = app.storage.accounts().await?;
    let tokens = app.storage.tokens().await?;
    let roles = app.storage.study_roles().await?;
    let studies: Vec<String> =
        app.catalogue.studies().iter().map(|study| study.id().to_owned()).collect();
    let everybody = Everybody { accounts: &accounts, roles: &roles, studies: &studies };
    Ok(people_page(&Frame::new(app, who), &everybody, &tokens, done.as_ref()))
}
