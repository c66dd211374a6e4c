//! What every answer says to browsers: what a page may load, and what is kept.

use std::sync::Arc;

use axum::extract::{Request, State};
use axum::http::{HeaderName, HeaderValue, header};
use axum::middleware::Next;
use axum::response::Response;

use crate::state::settings::Settings;

/// What a page may use of the device.
pub(crate) const PERMISSIONS_POLICY: HeaderName = HeaderName::from_static("permissions-policy");
/// Of the page of a study that measures faces: the camera too, which browsers let nobody use unasked.
pub(crate) const WITH_CAMERA: &str =
    "camera=(self), microphone=(), geolocation=(), payment=(), usb=()";

/// An answer that pages of other origins may embed: its policy says which.
#[derive(Clone)]
pub(crate) struct Embeddable;

/// Scripts and styles only from here; nothing inline, nothing from elsewhere but packs, where they
/// are named, and a program on the participant's machine that the page of a study tells of what it shows. `embedding`
/// are the origins of pages that may embed it.
pub(crate) fn content_security_policy(
    packs: Option<&str>,
    program: Option<&str>,
    embedding: &[String],
) -> String {
    let ancestors = if embedding.is_empty() { "'none'".to_owned() } else { embedding.join(" ") };
    let packs = packs.map(|packs| format!(" {}", origin(packs))).unwrap_or_default();
    let program = program.map(|program| format!(" {program}")).unwrap_or_default();
    format!(
        "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; style-src 'self'; \
         img-src 'self' data: blob:; connect-src 'self'{packs}{program}; worker-src 'self'; \
         media-src 'self' blob:{packs}; form-action 'self'; frame-ancestors {ancestors}; \
         base-uri 'none'; object-src 'none'"
    )
}

/// Scheme, host and port of an address.
fn origin(address: &str) -> &str {
    let host = address.find("://").map_or(0, |at| at + 3);
    let end =
        address[host..].find(['/', '?', '#', ';', ',', ' ']).map_or(address.len(), |at| host + at);
    &address[..end]
}

/// What every answer says to browsers.
#[derive(Clone)]
pub(super) struct Headers(Arc<[(HeaderName, HeaderValue)]>);

impl Headers {
    pub fn of(settings: &Settings, encrypted: bool) -> Self {
        let policy = content_security_policy(settings.packs_address.as_deref(), None, &[]);
        let fixed = HeaderValue::from_static;
        let mut headers = vec![
            // An address with characters that no header takes is left out by falling back.
            (
                header::CONTENT_SECURITY_POLICY,
                HeaderValue::from_str(&policy).unwrap_or(fixed("default-src 'none'")),
            ),
            (header::X_CONTENT_TYPE_OPTIONS, fixed("nosniff")),
            (header::REFERRER_POLICY, fixed("no-referrer")),
            (header::X_FRAME_OPTIONS, fixed("DENY")),
            (HeaderName::from_static("cross-origin-opener-policy"), fixed("same-origin")),
            (
                PERMISSIONS_POLICY,
                fixed("camera=(), microphone=(), geolocation=(), payment=(), usb=()"),
            ),
        ];
        if encrypted {
            let year = fixed("max-age=31536000; includeSubDomains");
            headers.push((header::STRICT_TRANSPORT_SECURITY, year));
        }
        Self(headers.into())
    }
}

pub(super) async fn settled_headers(
    State(Headers(fixed)): State<Headers>,
    request: Request,
    next: Next,
) -> Response {
    let mut response = next.run(request).await;
    // Browsers that know the policy's ancestors pass over the older header, others would not embed it.
    let embeddable = response.extensions().get::<Embeddable>().is_some();
    let headers = response.headers_mut();
    for (name, value) in fixed.iter() {
        if embeddable && name == header::X_FRAME_OPTIONS {
            continue;
        }
        // A page that needs another policy has said so.
        headers.entry(name.clone()).or_insert(value.clone());
    }
    // What is not said to be kept is not kept.
    headers.entry(header::CACHE_CONTROL).or_insert(HeaderValue::from_static("no-store"));
    response
}
