//! Marks by which a second participation of one person, or from one browser, is known.

use std::collections::BTreeMap;

use axum::http::HeaderMap;
use mimique_study::RepeatPrevention;

use super::sessions::TOKEN_DIGITS;
use crate::http::cookies;
use crate::secret;
use crate::state::App;
use crate::state::hosted_study::{HostedStudy, Stage};

/// What the browser keeps where the study takes each browser once. A pilot may be repeated.
pub(super) fn browser_mark(app: &App, study: &HostedStudy, token: &str) -> Option<String> {
    let wanted = study.study().recruitment.repeat_prevention == RepeatPrevention::Browser
        && study.stage() == Stage::Live;
    wanted.then(|| hex::encode(&secret::derive(&app.token_key, &["browser", token])[..16]))
}

pub(super) fn cookie_name(study: &HostedStudy) -> String {
    format!("mimique-{}", study.id())
}

/// The keyed hashes that must not be there yet; `None` when the identifier is missing by which the
/// study recognises people.
pub(super) fn marks(
    app: &App,
    study: &HostedStudy,
    recruitment: &BTreeMap<String, String>,
    browser_mark: Option<&str>,
    headers: &HeaderMap,
) -> Option<Vec<String>> {
    let keyed = |kind: &str, value: &str| {
        hex::encode(secret::derive(&app.token_key, &["mark", kind, study.id(), value]))
    };
    let rules = &study.study().recruitment;
    if rules.repeat_prevention == RepeatPrevention::RecruitmentIdentifier
        && study.stage() == Stage::Live
    {
        let name = rules.url_parameters.first()?;
        let value = recruitment.get(name).map(|value| value.trim()).filter(|v| !v.is_empty())?;
        return Some(vec![keyed("identifier", value)]);
    }
    let Some(own) = browser_mark else { return Some(Vec::new()) };
    let mut marks = vec![keyed("browser", own)];
    let held = cookies::find(headers, &cookie_name(study));
    if let Some(value) = held.filter(|value| secret::is_hex(value, TOKEN_DIGITS) && *value != own) {
        marks.push(keyed("browser", value));
    }
    Some(marks)
}
