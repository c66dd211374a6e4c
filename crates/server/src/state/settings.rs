//! How this server stands in the world: behind TLS, behind a proxy, its limits, where packs are.

use std::time::Duration;

/// What an operator can choose; the defaults suit one machine on a local network.
#[derive(Debug, Clone)]
pub struct Settings {
    /// People reach the server by `https://`: it asks browsers to insist on it (HSTS), marks its
    /// cookies `Secure` and writes its links so. An `https` address in [`crate::Access`] says the same.
    pub behind_tls: bool,
    /// A reverse proxy stands in front and names the caller's address in `X-Real-IP`; it is used to
    /// bound the rate of requests and is never stored.
    pub behind_proxy: bool,
    /// Where browsers fetch packs instead of from here: `https://cdn.example.org/packs`.
    pub packs_address: Option<String>,
    /// Who gives this as `Authorization: Bearer …` may read `/metrics` from elsewhere than the
    /// machine itself.
    pub metrics_token: Option<String>,
    /// Connections at once; further ones wait.
    pub most_connections: usize,
    /// Requests a second from one address, in the long run; up to ten times as many at once.
    pub requests_per_second: u32,
    /// A request's head must have arrived within this time.
    pub header_timeout: Duration,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            behind_tls: false,
            behind_proxy: false,
            packs_address: None,
            metrics_token: None,
            most_connections: 20_000,
            requests_per_second: 200,
            header_timeout: Duration::from_secs(20),
        }
    }
}
