//! The studio's page, and the files that it opens by itself.

use std::collections::BTreeMap;

use axum::body::Bytes;
use axum::http::{HeaderMap, header};
use axum::response::{Html, IntoResponse, Response};

use crate::error::Error;
use crate::http::language::language_of;
use crate::state::App;

/// What a file is to the studio.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum StudioRole {
    /// The avatar.
    Avatar,
    /// The JSON beside it.
    Settings,
    /// The capture, or recorded weights.
    Take,
    /// The marker map.
    Map,
}

impl StudioRole {
    pub(super) fn word(self) -> &'static str {
        match self {
            Self::Avatar => "avatar",
            Self::Settings => "settings",
            Self::Take => "take",
            Self::Map => "map",
        }
    }
}

/// A file that the studio opens when its page is loaded.
#[derive(Debug, Clone)]
pub struct StudioFile {
    /// Its name, for the page.
    pub name: String,
    /// What it holds.
    pub bytes: Bytes,
}

/// The files by what they are.
pub type StudioFiles = BTreeMap<StudioRole, StudioFile>;

/// The studio's page in the language that `headers` ask for; `token` is what it sends along with a study.
pub(super) fn studio_page(app: &App, token: &str, headers: &HeaderMap) -> Result<Response, Error> {
    let named = |(role, file): (&StudioRole, &StudioFile)| (role.word(), file.name.clone());
    let names: BTreeMap<&str, String> = app.studio_files.iter().map(named).collect();
    let names = serde_json::to_string(&names).unwrap_or_default();
    let prefix = app.assets.prefix();
    let values = [
        ("assets", prefix.as_str()),
        ("files", names.as_str()),
        ("language", language_of(headers).code()),
        ("token", token),
    ];
    let page = app.assets.page("studio/studio.html", &values).ok_or(Error::NotFound)?;
    Ok(([(header::CACHE_CONTROL, "no-cache")], Html(page)).into_response())
}
