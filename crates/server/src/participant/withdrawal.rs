//! `/s/{study}/withdraw`: whoever has the withdrawal code has the answers deleted, by the code alone.
//!
//! The page needs no account, no script and no session; it is there for as long as the database knows
//! the study, also when the study is hosted no more.

use std::time::Instant;

use axum::Extension;
use axum::extract::{Path, Query, State};
use axum::http::{HeaderMap, StatusCode};
use axum::response::Response;
use mimique_locale::Language;
use mimique_storage::{StorageError, Withdrawal};
use mimique_study::Multilingual as _;
use serde::Deserialize;

use super::withdrawal_page::{Shown, Told, withdrawal_page};
use crate::accounts::csrf::{Anonymous, FormToken};
use crate::clock::now_ms;
use crate::error::Error;
use crate::http::language::language_of;
use crate::http::rate_limit::caller_of;
use crate::http::responses::with_cookies;
use crate::secret;
use crate::state::App;
use crate::state::rate_limit::Peer;

/// Wrong codes from one address a second, in the long run; ten times as many at once. A code has 80 bits.
const WRONG_PER_SECOND: u32 = 5;

/// What the database keeps of a withdrawal code, however it was typed.
pub fn withdrawal_hash(code: &str) -> String {
    secret::hash(&secret::heard(code))
}

/// The language that the reader has chosen on the page.
#[derive(Deserialize)]
pub(crate) struct Chosen {
    lang: Option<String>,
}

impl Chosen {
    fn language(&self, headers: &HeaderMap) -> Language {
        let chosen = self.lang.as_deref().and_then(Language::from_code);
        chosen.unwrap_or_else(|| language_of(headers))
    }
}

/// The form.
pub(crate) async fn page(
    State(app): State<App>,
    Path(study): Path<String>,
    Query(chosen): Query<Chosen>,
    headers: HeaderMap,
) -> Result<Response, Error> {
    answer(&app, &study, chosen.language(&headers), &headers, &Told::Nothing).await
}

/// The field of the form.
#[derive(Deserialize)]
pub(crate) struct Code {
    code: String,
}

/// Deletes the answers of the code.
pub(crate) async fn redeem(
    State(app): State<App>,
    Path(study): Path<String>,
    Query(chosen): Query<Chosen>,
    headers: HeaderMap,
    peer: Option<Extension<Peer>>,
    form: Result<Anonymous<Code>, Error>,
) -> Result<Response, Error> {
    let language = chosen.language(&headers);
    let peer = peer.map(|Extension(peer)| peer);
    let told = match deleted(&app, &study, &headers, peer, form).await {
        Ok(withdrawal) => Told::Deleted(withdrawal),
        Err(error) if error.status().is_server_error() => return Err(error),
        Err(error) => Told::Refused(error),
    };
    answer(&app, &study, language, &headers, &told).await
}

async fn deleted(
    app: &App,
    study: &str,
    headers: &HeaderMap,
    peer: Option<Peer>,
    form: Result<Anonymous<Code>, Error>,
) -> Result<Withdrawal, Error> {
    let Anonymous { form, .. } = form?;
    let hash = withdrawal_hash(&form.code);
    let who = "(participant)";
    match app.storage.withdraw_by_code(Some(study), &hash, who, now_ms()).await {
        Err(StorageError::UnknownWithdrawalCode) if !may_err(app, headers, peer) => {
            Err(Error::TooManyAttempts)
        }
        done => Ok(done?),
    }
}

/// Whether a wrong code from this address is one of few. A right one is redeemed however many wrong ones came before
/// it: in a classroom, one address is many people.
fn may_err(app: &App, headers: &HeaderMap, peer: Option<Peer>) -> bool {
    caller_of(app, headers, peer)
        .is_none_or(|address| app.code_limits.allow(address, WRONG_PER_SECOND, Instant::now()))
}

async fn answer(
    app: &App,
    study: &str,
    language: Language,
    headers: &HeaderMap,
    told: &Told,
) -> Result<Response, Error> {
    let hosted = app.study(study).ok();
    if hosted.is_none() && !app.storage.has_study(study).await? {
        return Err(Error::UnknownStudy);
    }
    let title = hosted
        .as_ref()
        .map_or(study, |hosted| hosted.title(hosted.study().language_for(language.code())));
    let token = FormToken::of_nobody(app, headers)?;
    let assets = app.assets.prefix();
    let shown = Shown { assets: &assets, study, title, language, csrf: &token.value };
    let mut page = withdrawal_page(&shown, told);
    *page.status_mut() = match told {
        Told::Refused(error) => error.status(),
        _ => StatusCode::OK,
    };
    Ok(with_cookies(page, token.cookie))
}
