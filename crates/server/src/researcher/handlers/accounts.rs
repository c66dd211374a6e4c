//! `/researcher/…`: logging in, links, people, tokens, the log, the language.

use axum::extract::{Extension, Path, Query, State};
use axum::http::{HeaderMap, HeaderValue, header};
use axum::response::Response;
use mimique_analysis::Language;
use mimique_storage::{LinkPurpose, Role, StudyRole};
use serde::Deserialize;

use crate::accounts::audit::audit;
use crate::accounts::csrf::{Anonymous, FormToken, Guarded};
use crate::accounts::email::normal_email;
use crate::accounts::identity::{Researcher, Visitor};
use crate::accounts::{links, login, password};
use crate::clock::now_ms;
use crate::error::Error;
use crate::http::language::LANGUAGE_COOKIE;
use crate::http::responses::{see, with_cookies};
use crate::researcher::pages::entry;
use crate::researcher::pages::frame::Frame;
use crate::researcher::pages::people::{Done, Everybody, account_page, log_page, people_page};
use crate::secret;
use crate::state::App;
use crate::state::rate_limit::Peer;

/// Where a page leads afterwards.
#[derive(Deserialize)]
pub(crate) struct Next {
    #[serde(default)]
    next: String,
}

pub(crate) async fn login_page(
    State(app): State<App>,
    Query(query): Query<Next>,
    visitor: Visitor,
    token: FormToken,
) -> Response {
    let prefix = app.assets.prefix();
    let page = entry::login_page(&prefix, visitor.language, &token.value, safe(&query.next), None);
    with_cookies(page, token.cookie)
}

#[derive(Deserialize)]
pub(crate) struct Login {
    email: String,
    password: String,
    #[serde(default)]
    next: String,
}

pub(crate) async fn login(
    State(app): State<App>,
    peer: Option<Extension<Peer>>,
    Anonymous { visitor, headers, form }: Anonymous<Login>,
) -> Result<Response, Error> {
    let peer = peer.map(|Extension(peer)| peer);
    match login::log_in(&app, &headers, peer, &form.email, &form.password).await {
        Ok(logged_in) => {
            // The address is the account's own, known to be one.
            let who = Researcher::entered(logged_in.account, visitor.language);
            audit(&app, &who, "log in", "", "").await?;
            Ok(with_cookies(see(safe(&form.next)), logged_in.cookies))
        }
        Err(error @ (Error::WrongPassword | Error::TooManyAttempts)) => {
            let text = error.sentence(visitor.language);
            let token = FormToken::of_nobody(&app, &headers)?;
            let (prefix, next) = (app.assets.prefix(), safe(&form.next));
            let language = visitor.language;
            let mut page = entry::login_page(&prefix, language, &token.value, next, Some(&text));
            *page.status_mut() = error.status();
            Ok(page)
        }
        Err(error) => Err(error),
    }
}

#[derive(Deserialize)]
pub(crate) struct Nothing {}

pub(crate) async fn logout(
    State(app): State<App>,
    headers: HeaderMap,
    Guarded { .. }: Guarded<Nothing>,
) -> Result<Response, Error> {
    let cookie = login::log_out(&app, &headers).await?;
    Ok(with_cookies(see("/researcher/login"), Some(cookie)))
}

pub(crate) async fn logout_everywhere(
    State(app): State<App>,
    headers: HeaderMap,
    Guarded { who, .. }: Guarded<Nothing>,
) -> Result<Response, Error> {
    person_only(&who)?;
    app.storage.log_out_everywhere(who.account.key).await?;
    audit(&app, &who, "log out everywhere", "", "").await?;
    let cookie = login::log_out(&app, &headers).await?;
    Ok(with_cookies(see("/researcher/login"), Some(cookie)))
}

pub(crate) async fn link_page(
    State(app): State<App>,
    Path(given): Path<String>,
    visitor: Visitor,
    token: FormToken,
) -> Result<Response, Error> {
    let link = app.storage.link(&secret::hash(&given), now_ms()).await?;
    let link = link.ok_or(Error::DeadLink)?;
    let prefix = app.assets.prefix();
    let page = entry::link_page(&prefix, visitor.language, &token.value, &given, &link, None);
    Ok(with_cookies(page, token.cookie))
}

#[derive(Deserialize)]
pub(crate) struct NewPassword {
    email: String,
    password: String,
}

pub(crate) async fn use_link(
    State(app): State<App>,
    Path(given): Path<String>,
    Anonymous { visitor, headers, form }: Anonymous<NewPassword>,
) -> Result<Response, Error> {
    match links::use_link(&app, &given, &form.email, &form.password).await {
        Ok(account) => {
            let who = Researcher::entered(account.clone(), visitor.language);
            audit(&app, &who, "use a link", "", account.role.word()).await?;
            let logged_in = login::log_in_as(&app, &headers, account).await?;
            Ok(with_cookies(see("/researcher"), logged_in.cookies))
        }
        Err(error) if error.code() == "bad-request" => {
            let link = app.storage.link(&secret::hash(&given), now_ms()).await?;
            let link = link.ok_or(Error::DeadLink)?;
            let text = error.sentence(visitor.language);
            let token = FormToken::of_nobody(&app, &headers)?;
            let prefix = app.assets.prefix();
            let (language, csrf) = (visitor.language, &token.value);
            let mut page = entry::link_page(&prefix, language, csrf, &given, &link, Some(&text));
            *page.status_mut() = error.status();
            Ok(page)
        }
        Err(error) => Err(error),
    }
}

pub(crate) async fn account(State(app): State<App>, who: Researcher) -> Result<Response, Error> {
    own_page(&app, &who, None).await
}

#[derive(Deserialize)]
pub(crate) struct Passwords {
    old: String,
    new: String,
}

pub(crate) async fn password(
    State(app): State<App>,
    Guarded { who, form }: Guarded<Passwords>,
) -> Result<Response, Error> {
    password::change_password(&app, &who, &form.old, &form.new).await?;
    audit(&app, &who, "change password", "", "").await?;
    own_page(&app, &who, Some(Done::Password)).await
}

#[derive(Deserialize)]
pub(crate) struct NewToken {
    name: String,
    role: String,
}

pub(crate) async fn new_token(
    State(app): State<App>,
    Guarded { who, form }: Guarded<NewToken>,
) -> Result<Response, Error> {
    // A token that could make tokens could not be revoked.
    person_only(&who)?;
    let role = role(&form.role)?;
    if role == Role::Nothing {
        return Err(Error::NoSuchRole);
    }
    if role > who.most() {
        return Err(Error::NotAllowed);
    }
    let name: String = form.name.trim().chars().filter(|c| !c.is_control()).take(60).collect();
    if name.is_empty() {
        return Err(Error::NamelessToken);
    }
    let random = secret::random::<16>().map_err(Error::internal)?;
    let token = format!("mimique_{random}");
    let hash = secret::hash(&token);
    app.storage.add_token(&hash, who.account.key, &name, role, now_ms()).await?;
    audit(&app, &who, "make a token", "", &name).await?;
    own_page(&app, &who, Some(Done::Token(token))).await
}

pub(crate) async fn revoke_token(
    State(app): State<App>,
    Path(key): Path<i64>,
    Guarded { who, .. }: Guarded<Nothing>,
) -> Result<Response, Error> {
    person_only(&who)?;
    let tokens = app.storage.tokens().await?;
    let token = tokens.iter().find(|token| token.key == key).ok_or(Error::NotFound)?;
    if token.email != who.account.email {
        who.needs(Role::Owner)?;
    }
    app.storage.revoke_token(key, now_ms()).await?;
    audit(&app, &who, "revoke a token", "", &token.name).await?;
    Ok(see("/researcher/account"))
}

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

#[derive(Deserialize)]
pub(crate) struct Before {
    before: Option<i64>,
}

pub(crate) async fn log(
    State(app): State<App>,
    Query(query): Query<Before>,
    who: Researcher,
) -> Result<Response, Error> {
    const ON_A_PAGE: u32 = 200;
    who.needs(Role::Owner)?;
    let before = query.before.unwrap_or(i64::MAX);
    let entries = app.storage.audit_entries(before, ON_A_PAGE).await?;
    let older = entries.last().filter(|_| entries.len() == ON_A_PAGE as usize);
    let older = older.map(|entry| entry.key);
    Ok(log_page(&Frame::new(&app, &who), &entries, older))
}

pub(crate) async fn language(
    Path(code): Path<String>,
    Query(query): Query<Next>,
) -> Result<Response, Error> {
    let language = Language::from_code(&code).ok_or(Error::NotFound)?;
    let text =
        format!("{LANGUAGE_COOKIE}={}; Path=/; Max-Age=31536000; SameSite=Lax", language.code());
    let cookie = HeaderValue::from_str(&text).map_err(Error::internal)?;
    Ok(with_cookies(see(safe(&query.next)), Some(cookie)))
}

async fn own_page(app: &App, who: &Researcher, done: Option<Done>) -> Result<Response, Error> {
    let tokens = app.storage.tokens().await?;
    let own: Vec<_> = tokens.iter().filter(|token| token.email == who.account.email).collect();
    Ok(account_page(&Frame::new(app, who), who, &own, done.as_ref()))
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

fn person_only(who: &Researcher) -> Result<(), Error> {
    who.session().map(|_| ()).ok_or(Error::NotAllowed)
}

fn role(word: &str) -> Result<Role, Error> {
    Role::from_word(word).ok_or(Error::NoSuchRole)
}

/// The address as people open it.
fn whole_address(app: &App, headers: &HeaderMap, path: &str) -> String {
    if let Some(url) = &app.access.public_url {
        return format!("{}{path}", url.trim_end_matches('/'));
    }
    let host = headers.get(header::HOST).and_then(|host| host.to_str().ok()).unwrap_or_default();
    let scheme = if app.is_encrypted() { "https" } else { "http" };
    format!("{scheme}://{host}{path}")
}

/// A page of this server for researchers; never an address elsewhere.
fn safe(next: &str) -> &str {
    let inside = ["/researcher", "/preview/"].iter().any(|start| next.starts_with(start));
    let plain = next.bytes().all(|byte| byte.is_ascii_graphic() && byte != b'\\');
    if inside && plain && !next.contains("//") { next } else { "/researcher" }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nobody_is_led_elsewhere() {
        assert_eq!(safe("/researcher/studies/demo?x=1"), "/researcher/studies/demo?x=1");
        assert_eq!(safe("/preview/demo"), "/preview/demo");
        for wrong in [
            "",
            "//evil.example",
            "https://evil.example/researcher",
            "/researcher//evil.example",
            "/researcher\\evil",
            "/researcher\r\nSet-Cookie: a=b",
            "/s/demo/",
        ] {
            assert_eq!(safe(wrong), "/researcher", "{wrong}");
        }
    }
}
