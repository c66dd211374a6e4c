//! `/researcher/…`: logging in, links, people, tokens, the log, the language.

use axum::extract::{Extension, Path, Query, State};
use axum::http::{HeaderMap, HeaderValue};
use axum::response::Response;
use mimique_locale::Language;
use mimique_storage::Role;
use serde::Deserialize;

use crate::accounts::audit::audit;
use crate::accounts::csrf::{Anonymous, FormToken, Guarded};
use crate::accounts::identity::{Researcher, Visitor};
use crate::accounts::{links, login, password};
use crate::clock::now_ms;
use crate::error::Error;
use crate::http::language::LANGUAGE_COOKIE;
use crate::http::responses::{see, with_cookies};
use crate::researcher::pages::entry;
use crate::researcher::pages::frame::Frame;
use crate::researcher::pages::people::{Done, account_page, log_page};
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

pub(super) fn person_only(who: &Researcher) -> Result<(), Error> {
    who.session().map(|_| ()).ok_or(Error::NotAllowed)
}

pub(super) fn role(word: &str) -> Result<Role, Error> {
    Role::from_word(word).ok_or(Error::NoSuchRole)
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
