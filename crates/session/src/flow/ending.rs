//! How a session ends: what was acknowledged, the receipt and the way back, the withdrawal.

use super::effect::Effect;
use super::state::Play;
use super::update::Transition;
use crate::event::EventKind;
use crate::standing::Standing;
use crate::wire;

impl Transition<'_> {
    /// The session was over when the page was opened again: ask for the receipt anew.
    pub(super) fn resumed_at_end(&mut self) -> bool {
        self.effects.push(Effect::Flush);
        if self.state.record.standing == Standing::Withdrawn {
            self.state.live.withdrawing = true;
            self.effects.push(Effect::Withdraw);
        } else if self.state.record.standing.has_receipt() {
            self.state.live.completing = true;
            self.effects.push(Effect::Complete { events: self.state.record.events });
        }
        true
    }

    pub(super) fn withdraw(&mut self) -> bool {
        if self.state.live.withdrawing {
            return true;
        }
        // At the end, too, so that a reload goes on with it.
        if self.state.record.standing != Standing::Withdrawn {
            self.record(EventKind::Withdrawn);
        }
        self.state.live.withdrawing = true;
        self.state.live.play = Play::Still;
        self.effects.extend([Effect::StopClip, Effect::Flush, Effect::Withdraw]);
        self.effects.push(Effect::FocusHeading);
        true
    }

    pub(super) fn receipt_arrived(&mut self, receipt: &wire::Receipt) -> bool {
        let after = self.plan.study.return_after_seconds.filter(|_| receipt.redirect.is_some());
        self.state.live.return_ms = after.map(|seconds| self.now_ms + f64::from(seconds) * 1000.0);
        self.state.live.receipt = Some(receipt.clone());
        true
    }

    /// Goes back by itself when its time has come, once.
    pub(super) fn go_back(&mut self) {
        let live = &mut self.state.live;
        let address = live.receipt.as_ref().and_then(|receipt| receipt.redirect.clone());
        if live.return_ms.is_some_and(|at_ms| at_ms <= self.now_ms)
            && let Some(address) = address
        {
            live.return_ms = None;
            self.effects.push(Effect::GoBack(address));
        }
    }

    pub(super) fn acknowledged(&mut self, stored: u64) -> bool {
        self.state.live.stored = self.state.live.stored.max(stored);
        let finished = self.state.record.standing.has_receipt();
        let everything = self.state.live.stored >= self.state.record.events;
        if finished && everything && !self.state.live.completing {
            self.state.live.completing = true;
            self.effects.push(Effect::Complete { events: self.state.record.events });
        }
        true
    }
}
