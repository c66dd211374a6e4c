//! How often one address may ask. Addresses are hashed with a key of this process, held in memory
//! for as long as they matter, and neither stored nor logged.

use std::collections::HashMap;
use std::hash::{BuildHasher, RandomState};
use std::net::{IpAddr, Ipv6Addr};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

/// Requests at once, in multiples of the requests a second.
const BURST_SECONDS: u32 = 10;
/// Addresses held before those that are at rest are dropped.
const MOST_ADDRESSES: usize = 20_000;

/// The other end of a connection.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Peer(pub IpAddr);

/// Marks a request on a place that is kept for questions about health.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Reserve;

/// When each address has used up what it has asked so far (the generic cell rate algorithm, ITU-T
/// I.371: one time an address).
#[derive(Default)]
pub(crate) struct Limits {
    key: RandomState,
    paid_until: Mutex<HashMap<u64, Instant>>,
}

impl Limits {
    /// Whether an address may ask now: so often in a second in the long run.
    pub fn allow(&self, address: IpAddr, per_second: u32, now: Instant) -> bool {
        let per_second = per_second.max(1);
        let every = Duration::from_secs(1) / per_second;
        self.allow_every(address, every, BURST_SECONDS * per_second, now)
    }

    /// Whether an address may ask now: once in a while in the long run, and so often at once.
    pub fn allow_every(&self, address: IpAddr, one: Duration, at_once: u32, now: Instant) -> bool {
        let burst = one * at_once;
        let mut paid_until = self.paid_until.lock().unwrap_or_else(PoisonError::into_inner);
        if paid_until.len() >= MOST_ADDRESSES {
            paid_until.retain(|_, until| *until > now);
            // What a flood of addresses took is given back.
            paid_until.shrink_to(MOST_ADDRESSES / 10);
        }
        let until = paid_until.entry(self.key.hash_one(network(address))).or_insert(now);
        let next = (*until).max(now) + one;
        if next > now + burst {
            return false;
        }
        *until = next;
        true
    }
}

/// A household or a machine: of IPv6 the first 64 bits.
pub(crate) fn network(address: IpAddr) -> IpAddr {
    match address {
        IpAddr::V6(address) => {
            let [a, b, c, d, ..] = address.segments();
            Ipv6Addr::new(a, b, c, d, 0, 0, 0, 0).into()
        }
        address => address,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_address_may_ask_so_often_and_no_more() {
        let limits = Limits::default();
        let now = Instant::now();
        let address: IpAddr = "192.0.2.1".parse().unwrap();
        let asked = (0..100).filter(|_| limits.allow(address, 5, now)).count();
        assert_eq!(asked, 50, "ten seconds' worth at once");
        assert!(limits.allow("192.0.2.2".parse().unwrap(), 5, now), "others are not touched");
        let seldom = Limits::default();
        let asks = |at| seldom.allow_every(address, Duration::from_secs(20), 3, at);
        assert_eq!((0..10).filter(|_| asks(now)).count(), 3);
        assert!(!asks(now + Duration::from_secs(19)) && asks(now + Duration::from_secs(21)));
        let later = now + Duration::from_secs(1);
        assert_eq!((0..100).filter(|_| limits.allow(address, 5, later)).count(), 5);
    }

    #[test]
    fn what_a_flood_of_addresses_took_is_given_back() {
        let limits = Limits::default();
        let now = Instant::now();
        for number in 0..MOST_ADDRESSES as u32 {
            limits.allow(std::net::Ipv4Addr::from(0x0a00_0000 + number).into(), 5, now);
        }
        assert_eq!(limits.paid_until.lock().unwrap().len(), MOST_ADDRESSES);
        limits.allow("192.0.2.1".parse().unwrap(), 5, now + Duration::from_secs(60));
        let left = limits.paid_until.lock().unwrap();
        assert_eq!(left.len(), 1);
        assert!(left.capacity() < MOST_ADDRESSES / 2, "{}", left.capacity());
    }

    #[test]
    fn one_network_of_version_6_is_one_caller() {
        let limits = Limits::default();
        let now = Instant::now();
        let asked = (0..100_u16).filter(|last| {
            limits.allow(Ipv6Addr::new(0x2001, 0xdb8, 0, 0, 0, 0, 0, *last).into(), 1, now)
        });
        assert_eq!(asked.count(), 10);
    }
}
