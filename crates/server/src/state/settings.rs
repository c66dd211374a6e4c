//! How this server stands in the world: behind TLS, behind a proxy, its limits, where packs are.

use std::net::IpAddr;
use std::time::Duration;

use super::network::Network;

/// What an operator can choose; the defaults suit one machine on a local network.
#[derive(Debug, Clone)]
pub struct Settings {
    /// People reach the server by `https://`: it asks browsers to insist on it (HSTS), marks its
    /// cookies `Secure` and writes its links so. An `https` address in [`crate::Access`] says the same.
    pub behind_tls: bool,
    /// A reverse proxy stands in front and names the caller's address in `X-Real-IP`; it is used to
    /// bound the rate of requests and is never stored. The machine itself is believed, and [`Self::proxies`].
    pub behind_proxy: bool,
    /// Proxies on other machines: where `behind_proxy`, their `X-Real-IP` is believed and nobody else's.
    pub proxies: Vec<Network>,
    /// Where browsers fetch packs instead of from here: `https://cdn.example.org/packs`.
    pub packs_address: Option<String>,
    /// Origins of pages that may embed the participants' pages, such as `https://survey.example`.
    pub embedding: Vec<String>,
    /// Who gives this as `Authorization: Bearer …` may read `/metrics` from elsewhere than the
    /// machine itself.
    pub metrics_token: Option<String>,
    /// Connections at once; further ones wait. Some more are kept for `/healthz` and `/readyz`.
    pub most_connections: usize,
    /// Connections of one address at once; further ones are closed. The machine itself and the proxies
    /// that are named have as many as there are.
    pub connections_per_address: usize,
    /// A caller that takes less than a kilobyte a second over so long, while there is something to send,
    /// is shown out.
    pub reader_patience: Duration,
    /// Requests a second from one address, in the long run; up to ten times as many at once.
    pub requests_per_second: u32,
    /// Sessions that begin from one address in a minute.
    pub starts_per_minute: u32,
    /// Attempts to log in from one address at once; one more every twenty seconds.
    pub logins_per_address: u32,
    /// A request's head must have arrived within this time.
    pub header_timeout: Duration,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            behind_tls: false,
            behind_proxy: false,
            proxies: Vec::new(),
            packs_address: None,
            embedding: Vec::new(),
            metrics_token: None,
            most_connections: 20_000,
            connections_per_address: 1000,
            reader_patience: Duration::from_secs(30),
            requests_per_second: 200,
            starts_per_minute: 60,
            logins_per_address: 30,
            header_timeout: Duration::from_secs(20),
        }
    }
}

impl Settings {
    /// Whether an address is the machine's own or that of a proxy that is named.
    pub(crate) fn is_own(&self, address: IpAddr) -> bool {
        address.is_loopback() || self.proxies.iter().any(|proxy| proxy.holds(address))
    }
}
