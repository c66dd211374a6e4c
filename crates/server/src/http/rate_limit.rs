//! Refuses what comes too often from one address.

use std::net::IpAddr;
use std::time::Instant;

use axum::extract::{Request, State};
use axum::http::HeaderMap;
use axum::middleware::Next;
use axum::response::{IntoResponse, Response};

use crate::error::Error;
use crate::state::App;
use crate::state::rate_limit::Peer;

/// Whose request it is: the peer's, or the one whom a trusted proxy names.
fn caller(behind_proxy: bool, headers: &HeaderMap, peer: Option<Peer>) -> Option<IpAddr> {
    let named = || headers.get("x-real-ip")?.to_str().ok()?.trim().parse().ok();
    behind_proxy.then(named).flatten().or(peer.map(|peer| peer.0))
}

/// Refuses what comes too often from one address. The machine itself is not bounded.
pub(crate) async fn limit_rate(State(app): State<App>, request: Request, next: Next) -> Response {
    let peer = request.extensions().get::<Peer>().copied();
    let caller = caller(app.settings.behind_proxy, request.headers(), peer);
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
        assert_eq!(caller(true, &headers, peer), Some("192.0.2.9".parse().unwrap()));
        assert_eq!(caller(false, &headers, peer), Some("127.0.0.1".parse().unwrap()));
        assert!(!is_local(&headers, peer));
        assert!(is_local(&HeaderMap::new(), peer));
        assert!(!is_local(&HeaderMap::new(), None));
    }
}
