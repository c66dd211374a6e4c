//! One writer puts events into IndexedDB, one sender sends them; both go on in order, one thing at
//! a time, whatever the pages do meanwhile. At the end the receipt is asked for, or everything taken back.

use std::rc::Rc;
use std::time::Duration;

use mimique_session::flow::Input;
use mimique_session::wire::Event;
use wasm_bindgen_futures::spawn_local;

use super::{Connection, Engine};
use crate::answer::{Failure, is_gone, refusal};
use crate::browser::{clock, random};
use crate::event_store::Identity;
use crate::outbox::{Outbox, back_off};

impl Engine {
    /// Keeps events, then sends them.
    pub fn keep(self: &Rc<Self>, events: Vec<Event>) {
        self.to_store.borrow_mut().extend(events);
        self.write();
    }

    /// The header says something else.
    fn connection_is(&self, change: impl FnOnce(&mut Connection)) {
        change(&mut self.connection.borrow_mut());
        (self.changed)();
    }

    /// Sends now what waits, without the rest of a back-off.
    pub fn flush(self: &Rc<Self>) {
        self.wake.set(true);
        self.send();
    }

    fn write(self: &Rc<Self>) {
        if self.writing.replace(true) {
            return;
        }
        let engine = Rc::clone(self);
        spawn_local(async move {
            loop {
                let next = engine.to_store.borrow_mut().pop_front();
                let Some(event) = next else { break };
                if let Some(store) = &engine.store
                    && store.put(&event).await.is_err()
                {
                    engine.connection_is(|connection| connection.fleeting = true);
                }
                engine.outbox.borrow_mut().push(event);
                engine.send();
            }
            engine.writing.set(false);
        });
    }

    fn send(self: &Rc<Self>) {
        if self.sending.replace(true) {
            return;
        }
        let engine = Rc::clone(self);
        spawn_local(async move {
            let mut failures = 0;
            loop {
                let batch = engine.outbox.borrow().batch();
                if batch.is_empty() {
                    break;
                }
                let session = &engine.plan.started.session;
                match engine.service.append(session, batch.clone()).await {
                    Ok(answer) => {
                        failures = 0;
                        let gone = engine.outbox.borrow_mut().acknowledge(&batch, &answer);
                        // What cannot be forgotten here is sent again after a reload, and refused
                        // as known: no harm.
                        if let Some(store) = &engine.store {
                            let _ = store.forget(&gone).await;
                        }
                        engine.connected();
                        let stored = engine.outbox.borrow().stored();
                        engine.dispatch(Input::Acknowledged { stored });
                        if gone.is_empty() {
                            // The server took nothing of what was sent: do not run in circles.
                            clock::sleep(Duration::from_secs(1)).await;
                        }
                    }
                    Err(Failure::Unreachable(_)) => {
                        failures += 1;
                        if failures > 1 {
                            engine.connection_is(|connection| connection.offline = true);
                        }
                        engine.wait(failures).await;
                    }
                    Err(Failure::TooLarge) if engine.outbox.borrow_mut().halve(&batch) => {}
                    // Whoever withdraws has nothing left to send.
                    Err(Failure::Refused(_)) if engine.is_withdrawing() => break,
                    Err(failure) => {
                        // The events stay in IndexedDB; a reload or a retry sends them again.
                        engine.troubled(failure);
                        break;
                    }
                }
            }
            engine.sending.set(false);
        });
    }

    fn is_withdrawing(&self) -> bool {
        self.state.borrow().live.withdrawing
    }

    /// The header says what is wrong.
    fn troubled(&self, failure: Failure) {
        self.connection_is(|connection| match failure {
            Failure::Unreachable(_) => connection.offline = true,
            Failure::Refused(refusal) => connection.refused = Some(refusal),
            Failure::TooLarge => connection.refused = Some(refusal("too-large", "", "")),
        });
    }

    fn connected(self: &Rc<Self>) {
        let (offline, troubled) = {
            let connection = self.connection();
            (connection.offline, connection.offline || connection.refused.is_some())
        };
        if offline {
            self.dispatch(Input::Online);
        }
        if troubled {
            self.connection_is(|connection| {
                connection.offline = false;
                connection.refused = None;
            });
        }
    }

    /// Waits before the next try; `flush` ends the wait.
    async fn wait(&self, failures: u32) {
        self.wake.set(false);
        let mut left = back_off(failures, random::fraction());
        while !left.is_zero() && !self.wake.get() {
            let slice = left.min(Duration::from_millis(200));
            clock::sleep(slice).await;
            left -= slice;
        }
    }

    /// Asks for the receipt once everything is acknowledged.
    pub(super) fn complete(self: &Rc<Self>, events: u64) {
        if self.store.is_none() {
            return;
        }
        let engine = Rc::clone(self);
        spawn_local(async move {
            let mut failures = 0;
            loop {
                // After a reload at the end something may still be on its way.
                while engine.sending.get() {
                    clock::sleep(Duration::from_millis(100)).await;
                }
                // Whoever takes everything back needs no receipt.
                if engine.is_withdrawing() {
                    break;
                }
                match engine.service.complete(&engine.plan.started.session, events).await {
                    Ok(receipt) => {
                        engine.connected();
                        engine.dispatch(Input::ReceiptArrived(receipt));
                        break;
                    }
                    Err(failure) => {
                        failures += 1;
                        engine.troubled(failure);
                        engine.wait(failures).await;
                    }
                }
            }
        });
    }

    /// Takes everything back, on the server and here.
    pub(super) fn withdraw(self: &Rc<Self>) {
        if self.store.is_none() {
            // Nothing was kept.
            return self.dispatch(Input::WithdrawalConfirmed);
        }
        let engine = Rc::clone(self);
        spawn_local(async move {
            let started = &engine.plan.started;
            let mut failures = 0;
            loop {
                let (session, code) = (&started.session, &started.withdrawal_code);
                match engine.service.withdraw(session, code).await {
                    Ok(_) => break,
                    // It is gone already: the answer that said so was never heard here.
                    Err(Failure::Refused(refusal)) if is_gone(&refusal) => break,
                    Err(failure) => {
                        failures += 1;
                        engine.troubled(failure);
                        engine.wait(failures).await;
                    }
                }
            }
            *engine.outbox.borrow_mut() = Outbox::new(u64::MAX);
            if let Some(store) = &engine.store {
                let _ = store.clear().await;
            }
            Identity::forget(&engine.plan.study.id);
            engine.connected();
            engine.dispatch(Input::WithdrawalConfirmed);
        });
    }
}
