//! How many connections there are: in all, and from each address; and some kept free for those who ask
//! whether the server lives, since a server that does not say so is killed.

use std::collections::HashMap;
use std::net::IpAddr;
use std::sync::{Arc, Mutex, PoisonError};

use tokio::sync::{OwnedSemaphorePermit, Semaphore};

use crate::state::rate_limit::network;

/// Places for questions about the server's health when all others are taken.
const RESERVE: usize = 32;

/// The places of a server's connections.
pub(crate) struct Places {
    all: Arc<Semaphore>,
    reserve: Arc<Semaphore>,
    most_of_one: usize,
    taken: Taken,
}

/// How many places each address has.
type Taken = Arc<Mutex<HashMap<IpAddr, usize>>>;

/// A connection's place, given back when dropped.
pub(crate) struct Place {
    _permit: OwnedSemaphorePermit,
    /// It is one of the reserve: for questions about health alone.
    pub is_reserve: bool,
    of: Option<(IpAddr, Taken)>,
}

impl Places {
    pub fn new(most: usize, most_of_one: usize) -> Self {
        let [all, reserve] = [most.max(1), RESERVE].map(|count| Arc::new(Semaphore::new(count)));
        Self { all, reserve, most_of_one, taken: Arc::default() }
    }

    /// The next free place, of the reserve when all others are taken; waits where there is none at all.
    pub async fn next(&self) -> Option<Place> {
        let free = Arc::clone(&self.all).try_acquire_owned().ok();
        let is_reserve = free.is_none();
        let permit = match free {
            Some(permit) => permit,
            None => {
                // Whichever is free first.
                let (all, reserve) = (Arc::clone(&self.all), Arc::clone(&self.reserve));
                return tokio::select! {
                    biased;
                    permit = all.acquire_owned() => {
                        Some(Place { _permit: permit.ok()?, is_reserve: false, of: None })
                    }
                    permit = reserve.acquire_owned() => {
                        Some(Place { _permit: permit.ok()?, is_reserve, of: None })
                    }
                };
            }
        };
        Some(Place { _permit: permit, is_reserve, of: None })
    }

    /// The place as one of this address; none where it has as many as one may have.
    pub fn of(&self, mut place: Place, address: IpAddr) -> Option<Place> {
        let address = network(address);
        let mut taken = self.taken.lock().unwrap_or_else(PoisonError::into_inner);
        let own = taken.entry(address).or_insert(0);
        if *own >= self.most_of_one {
            return None;
        }
        *own += 1;
        place.of = Some((address, Arc::clone(&self.taken)));
        Some(place)
    }
}

impl Drop for Place {
    fn drop(&mut self) {
        let Some((address, taken)) = self.of.take() else { return };
        let mut taken = taken.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(own) = taken.get_mut(&address) {
            *own -= 1;
            if *own == 0 {
                taken.remove(&address);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[tokio::test]
    async fn an_address_has_so_many_places_and_gives_them_back() {
        let places = Places::new(10, 2);
        let address: IpAddr = "192.0.2.1".parse().unwrap();
        let take =
            async |address: &str| places.of(places.next().await.unwrap(), address.parse().unwrap());
        let (first, second) = (take("192.0.2.1").await, take("192.0.2.1").await);
        assert!(first.is_some() && second.is_some() && take("192.0.2.1").await.is_none());
        assert!(take("192.0.2.2").await.is_some(), "others are not touched");
        drop(first);
        assert!(take("192.0.2.1").await.is_some());
        drop(second);
        let taken = places.taken.lock().unwrap();
        assert!(!taken.contains_key(&address), "nobody is remembered: {taken:?}");
    }

    #[tokio::test]
    async fn what_is_kept_free_is_for_health() {
        let places = Places::new(2, 10);
        let mut held = Vec::new();
        for _ in 0..2 {
            held.push(places.next().await.unwrap());
        }
        assert!(held.iter().all(|place| !place.is_reserve));
        let reserve = places.next().await.unwrap();
        assert!(reserve.is_reserve);
        held.pop();
        assert!(!places.next().await.unwrap().is_reserve);
    }
}
