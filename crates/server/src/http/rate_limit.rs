//! Refuses what comes too often from one address.

use std::net::IpAddr;
use std::time::Instant;

use axum::extract::{Request, State};
use axum::http::HeaderMap;
use axum::middleware::Next;
use axum::response::{IntoResponse, Response};

use crate::error::Error;
use crate::state::App;
use crate::state::rate_limit::{Peer, Reserve};
use crate::state::settings::Settings;

/// Whose request it is: the peer's, or the one whom a proxy names that is believed.
fn caller(settings: &Settings, headers: &HeaderMap, peer: Option<Peer>) -> Option<IpAddr> {
    let is_proxy = |Peer(address): Peer| settings.is_own(address);
    let named = || headers.get("x-real-ip")?.to_str().ok()?.trim().parse().ok();
    let is_believed = settings.behind_proxy && peer.is_none_or(is_proxy);
    is_believed.then(named).flatten().or(peer.map(|peer| peer.0))
}

/// Whose request it is, as far as it is known.
pub(crate) fn caller_of(app: &App, headers: &HeaderMap, peer: Option<Peer>) -> Option<IpAddr> {
    caller(&app.settings, headers, peer)
}

/// Refuses what comes too often from one address. The machine itself is not bounded.
pub(crate) async fn limit_rate(State(app): State<App>, request: Request, next: Next) -> Response {
    // Who asks whether the server lives is told, whatever else is going on.
    if matches!(request.uri().path(), "/healthz" | "/readyz") {
        return next.run(request).await;
    }
    if request.extensions().get::<Reserve>().is_some() {
        return Error::Unavailable.into_response();
    }
    let peer = request.extensions().get::<Peer>().copied();
    let caller = caller_of(&app, request.headers(), peer);
    if let Some(address) = caller.filter(|address| !address.is_loopback()) {
        let per_second = app.settings.requests_per_second;
        if !app.limits.allow(address, per_second, Instant::now()) {
            return Error::RateLimited.into_response();
        }
    }
    next.run(request).await
}

/// Whether a request comes from this machine itself and no proxy passed it on.
pub(crate) fn is_local(headers: &HeaderMap, peer: Option<Peer>) -> bool {
    let passed_on = ["x-real-ip", "x-forwarded-for", "forwarded", "via"];
    peer.is_some_and(|peer| peer.0.is_loopback())
        && !passed_on.iter().any(|name| headers.contains_key(*name))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_proxy_is_believed_only_where_there_is_one() {
        let headers = HeaderMap::from_iter([(
            axum::http::HeaderName::from_static("x-real-ip"),
            axum::http::HeaderValue::from_static("192.0.2.9"),
        )]);
        let peer = Some(Peer("127.0.0.1".parse().unwrap()));
        let named = Some("192.0.2.9".parse().unwrap());
        let mut settings = Settings::default();
        assert_eq!(caller(&settings, &headers, peer), Some("127.0.0.1".parse().unwrap()));
        settings.behind_proxy = true;
        assert_eq!(caller(&settings, &headers, peer), named);
        // Whoever comes past the proxy is not believed, but a proxy that was named.
        let other: IpAddr = "10.1.2.3".parse().unwrap();
        assert_eq!(caller(&settings, &headers, Some(Peer(other))), Some(other));
        settings.proxies = vec!["10.1.0.0/16".parse().unwrap()];
        assert_eq!(caller(&settings, &headers, Some(Peer(other))), named);
        assert!(!is_local(&headers, peer));
        assert!(is_local(&HeaderMap::new(), peer));
        assert!(!is_local(&HeaderMap::new(), None));
    }
}
