//! How many sessions one address may begin: places of a study are held by people, not by whoever asks for them.
//!
//! A session whose page has not been heard of holds its place for a minute
//! ([`FIRST_SIGN_OF_LIFE_MS`](mimique_storage::FIRST_SIGN_OF_LIFE_MS)); of these one address has few at the same
//! time, and so many begin from it in a minute. A page that is refused so waits and asks again. As with rates
//! of requests, addresses are hashed in memory and kept nowhere.

use std::collections::HashMap;
use std::net::IpAddr;
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use super::rate_limit::{Limits, network};

/// Sessions of one address whose pages have not been heard of: those of a class that begins together pass in
/// some seconds, since each of them is heard of at once.
const MOST_UNHEARD: usize = 8;
/// After so long such a session holds no place any more.
const UNHEARD: Duration = Duration::from_millis(mimique_storage::FIRST_SIGN_OF_LIFE_MS as u64);

/// The starts of the last minute.
#[derive(Default)]
pub(crate) struct Starts {
    rates: Limits,
    /// Sessions whose pages have not been heard of, by token hash: who began them, and when.
    unheard: Mutex<HashMap<String, (IpAddr, Instant)>>,
}

impl Starts {
    /// Whether an address may begin one more session; if it may, that is counted.
    pub fn allow(&self, address: IpAddr, per_minute: u32, now: Instant) -> bool {
        let address = network(address);
        let mut unheard = self.unheard.lock().unwrap_or_else(PoisonError::into_inner);
        unheard.retain(|_, (_, began)| now.duration_since(*began) < UNHEARD);
        if unheard.values().filter(|(of, _)| *of == address).count() >= MOST_UNHEARD {
            return false;
        }
        drop(unheard);
        let per_minute = per_minute.max(1);
        let every = Duration::from_secs(60) / per_minute;
        self.rates.allow_every(address, every, per_minute, now)
    }

    /// A session has begun.
    pub fn begun(&self, token_hash: &str, address: IpAddr, now: Instant) {
        let mut unheard = self.unheard.lock().unwrap_or_else(PoisonError::into_inner);
        unheard.insert(token_hash.to_owned(), (network(address), now));
    }

    /// A session's page has been heard of.
    pub fn heard(&self, token_hash: &str) {
        let mut unheard = self.unheard.lock().unwrap_or_else(PoisonError::into_inner);
        if unheard.remove(token_hash).is_some() && unheard.is_empty() {
            unheard.shrink_to_fit();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_address_begins_few_sessions_that_nobody_is_heard_of() {
        let (starts, now) = (Starts::default(), Instant::now());
        let (one, other): (IpAddr, IpAddr) =
            ("192.0.2.1".parse().unwrap(), "192.0.2.2".parse().unwrap());
        let begin = |number: u32, address, at| {
            let may = starts.allow(address, 60, at);
            if may {
                starts.begun(&number.to_string(), address, at);
            }
            may
        };
        assert_eq!((0..19).filter(|number| begin(*number, one, now)).count(), MOST_UNHEARD);
        assert!(begin(100, other, now), "others are not touched");
        // One that is heard of makes room for one more; after a minute they all have gone.
        starts.heard("3");
        assert!(begin(20, one, now) && !begin(21, one, now));
        let later = now + UNHEARD;
        assert_eq!((30..60).filter(|number| begin(*number, one, later)).count(), MOST_UNHEARD);
    }

    #[test]
    fn an_address_begins_so_many_in_a_minute() {
        let (starts, now) = (Starts::default(), Instant::now());
        let address: IpAddr = "2001:db8::1".parse().unwrap();
        let begun = (0..100).filter(|number| {
            let token = number.to_string();
            let may = starts.allow(address, 30, now);
            if may {
                starts.begun(&token, address, now);
                starts.heard(&token);
            }
            may
        });
        assert_eq!(begun.count(), 30);
    }
}
