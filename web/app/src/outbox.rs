//! What is still to be sent: the pure core of the outbox.
//!
//! Events come in as the session makes them, go out in batches as often as it takes, and leave only
//! when the server says that they are stored. `memory` keeps the same set in IndexedDB;
//! `engine` does the sending.

use std::time::Duration;

use mimique_session::wire::{Acknowledged, Event};

/// Events that the server has not acknowledged.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Outbox {
    /// In ascending order of sequence.
    waiting: Vec<Event>,
    /// Number of events that the server has without a gap.
    stored: u64,
    /// How often the number of events in a request was halved.
    halved: u32,
}

/// Most events in one request: well under the server's limit of a body.
pub const BATCH: usize = 50;

impl Outbox {
    /// An outbox of a session of which the server has `stored` events.
    pub fn new(stored: u64) -> Self {
        Self { stored, ..Self::default() }
    }

    /// An event to be sent. One that the server has already is not taken again.
    pub fn push(&mut self, event: Event) {
        if event.sequence >= self.stored {
            put(&mut self.waiting, event);
        }
    }

    /// The next events to send, the oldest first; empty when there is nothing to do.
    pub fn batch(&self) -> Vec<Event> {
        self.waiting.iter().take((BATCH >> self.halved).max(1)).cloned().collect()
    }

    /// From now on requests have half as many events. False where `sent` was one event: no request is smaller.
    pub fn halve(&mut self, sent: &[Event]) -> bool {
        self.halved = (self.halved + 1).min(BATCH.ilog2());
        sent.len() > 1
    }

    /// The server has answered the sending of `sent`. Returns the sequences that need no keeping
    /// any more.
    pub fn acknowledge(&mut self, sent: &[Event], answer: &Acknowledged) -> Vec<u64> {
        self.stored = self.stored.max(answer.stored);
        let gone: Vec<u64> = self
            .waiting
            .iter()
            .map(|event| event.sequence)
            .filter(|sequence| {
                *sequence < answer.stored
                    || (sent.iter().any(|event| event.sequence == *sequence)
                        && !answer.gaps.contains(sequence))
            })
            .collect();
        self.waiting.retain(|event| !gone.contains(&event.sequence));
        gone
    }

    /// Number of events that the server has without a gap.
    pub fn stored(&self) -> u64 {
        self.stored
    }
}

/// Puts an event where its sequence belongs; false if that is there already: then the later one holds.
pub fn put(events: &mut Vec<Event>, event: Event) -> bool {
    match events.binary_search_by_key(&event.sequence, |each| each.sequence) {
        Ok(at) => {
            events[at] = event;
            false
        }
        Err(at) => {
            events.insert(at, event);
            true
        }
    }
}

/// How long to wait after the `failures`-th failure in a row (from 1): doubling from half a second
/// to half a minute, spread by `jitter` (0..1) so that a room full of pages does not come back at
/// the same moment. There is no last try.
pub fn back_off(failures: u32, jitter: f64) -> Duration {
    let doubled = 500.0 * f64::from(1_u32 << failures.saturating_sub(1).min(6));
    Duration::from_millis((doubled.min(30_000.0) * (0.5 + 0.5 * jitter.clamp(0.0, 1.0))) as u64)
}

/// How long a request may take, whole, after `unanswered` ones in a row (from 0) that brought no
/// answer: doubling from 20 s to 160 s, so that a network that is slow but works is not given up for
/// ever. What is given up counts as lost, and is sent again after [`back_off`].
pub fn patience(unanswered: u32) -> Duration {
    Duration::from_secs(20 << unanswered.min(3))
}

#[cfg(test)]
mod tests {
    use std::collections::{BTreeMap, BTreeSet};

    use proptest::prelude::*;
    use serde_json::json;

    use super::*;

    fn event(sequence: u64) -> Event {
        Event { sequence, at_ms: sequence as f64, body: json!({ "type": "x", "n": sequence }) }
    }

    /// A server that stores by sequence, as the real one does.
    #[derive(Default)]
    struct Server {
        stored: BTreeMap<u64, Event>,
        writes: u64,
    }

    impl Server {
        fn append(&mut self, events: &[Event]) -> Acknowledged {
            for event in events {
                if self.stored.insert(event.sequence, event.clone()).is_none() {
                    self.writes += 1;
                }
            }
            let stored = (0..).take_while(|n| self.stored.contains_key(n)).count() as u64;
            let highest = self.stored.keys().next_back().copied().unwrap_or(0);
            let gaps = (stored..highest).filter(|n| !self.stored.contains_key(n)).collect();
            Acknowledged { stored, gaps }
        }
    }

    proptest! {
        /// Requests are dropped before or after they arrive, repeated, delayed; pages are reloaded.
        #[test]
        fn nothing_is_lost_or_doubled(total in 1_u64..200, fates in prop::collection::vec(0_u8..6, 1..400)) {
            let mut outbox = Outbox::new(0);
            let mut kept: BTreeMap<u64, Event> = BTreeMap::new();
            let mut server = Server::default();
            let mut late: Vec<Vec<Event>> = Vec::new();
            let mut made = 0;
            let mut fates = fates.into_iter();
            while made < total || !outbox.batch().is_empty() {
                if made < total {
                    kept.insert(made, event(made));
                    outbox.push(event(made));
                    made += 1;
                }
                let batch = outbox.batch();
                // After the drawn fates the network is well.
                match fates.next().unwrap_or(5) {
                    0 => {}
                    1 => { server.append(&batch); }
                    2 => late.push(batch),
                    3 => {
                        if let Some(old) = late.pop() { server.append(&old); }
                        let answer = server.append(&batch);
                        for gone in outbox.acknowledge(&batch, &answer) { kept.remove(&gone); }
                    }
                    4 => {
                        // A reload: what IndexedDB kept is all that is known.
                        outbox = Outbox::new(server.append(&[]).stored);
                        kept.values().cloned().for_each(|event| outbox.push(event));
                    }
                    _ => {
                        let answer = server.append(&batch);
                        for gone in outbox.acknowledge(&batch, &answer) { kept.remove(&gone); }
                    }
                }
            }
            prop_assert_eq!(server.writes, total);
            prop_assert_eq!(server.stored.keys().copied().collect::<BTreeSet<_>>(), (0..total).collect());
            for (sequence, stored) in &server.stored {
                prop_assert_eq!(stored, &event(*sequence));
            }
        }
    }

    #[test]
    fn a_limit_on_the_way_lets_smaller_requests_pass() {
        let mut outbox = Outbox::new(0);
        (0..120).for_each(|n| outbox.push(event(n)));
        let mut server = Server::default();
        // A proxy that forwards four events at a time.
        while !outbox.batch().is_empty() {
            let batch = outbox.batch();
            if batch.len() > 4 {
                assert!(outbox.halve(&batch));
                continue;
            }
            let answer = server.append(&batch);
            outbox.acknowledge(&batch, &answer);
        }
        assert_eq!(server.stored.len(), 120);
        assert!(!outbox.halve(&[event(120)]), "one event cannot be divided");
        outbox.push(event(120));
        assert_eq!(outbox.batch().len(), 1);
    }

    #[test]
    fn patience_grows_and_ends() {
        assert_eq!([0, 1, 3, u32::MAX].map(|n| patience(n).as_secs()), [20, 40, 160, 160]);
    }

    #[test]
    fn back_off_grows_and_never_ends() {
        assert_eq!(back_off(1, 1.0), Duration::from_millis(500));
        assert_eq!(back_off(2, 1.0), Duration::from_secs(1));
        assert_eq!(back_off(u32::MAX, 1.0), Duration::from_secs(30));
        assert_eq!(back_off(3, 0.0), Duration::from_secs(1));
    }
}
