//! What the page has to do.

use serde_json::Value;

use super::placed::PlacedClip;
use crate::wire;

/// What the page has to do; each is carried out once, in the order given.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Effect {
    /// Put this event into the outbox (it is numbered already), to be sent and sent again until the
    /// server acknowledges it.
    Store(wire::Event),
    /// Load and solve these clips, the first one first; what begins with [`mimique_study::MEDIA_PREFIX`] is a
    /// picture or a signed video, which is loaded. Report by `ClipProgress`, `ClipPrepared`,
    /// `ClipFailed`. What is prepared already may be named again.
    PrepareClips(Vec<String>),
    /// Choose the level of a trial of an adaptive block, by `mimique_study::ClosedLoop`; report by `LevelChosen`. Holds
    /// `step`, `component`, `block`, whose draw it is (`seed`, `configHash`, `slot`), and `answers` so far: the side or
    /// null.
    ChooseLevel(Value),
    /// Make the levels of an adaptive block ready, so that its first one is chosen at once: what QUEST+ expects of every
    /// answer to every level takes its time. Holds what `ChooseLevel` holds; nothing is reported.
    ReadyLevels(Value),
    /// Draw the next batch of pairs of an active schedule, by `mimique_study::PairRequest`; report by `PairsDrawn`. Holds
    /// the request but for the answers of all others.
    DrawPairs(Value),
    /// Play these clips once from their start, in step or in turn; report by `Played`.
    PlayClips {
        /// The clips: of a trial of one or two its own first.
        clips: Vec<PlacedClip>,
        /// Whether they are played one after the other.
        in_turn: bool,
    },
    /// Measure what browser and display can do; report by `Measured`, and by `Measured` again
    /// whenever the window changes its size while the device gate stands there.
    MeasureDevice,
    /// Let the page fill the screen (the effect of a press, so that the browser allows it); report
    /// by `Fullscreen`.
    RequestFullscreen,
    /// Give the screen back, if the page fills it.
    LeaveFullscreen,
    /// Abort the play in progress, if there is one.
    StopClip,
    /// Send the outbox now.
    Flush,
    /// Everything is acknowledged: `POST complete` with this number of events; report by
    /// `ReceiptArrived`.
    Complete {
        /// How many events the session has.
        events: u64,
    },
    /// Go to this address, the way back to the recruiting site.
    GoBack(String),
    /// Send the outbox, then `POST withdraw`; report by `WithdrawalConfirmed`.
    Withdraw,
    /// A new page stands there: move the focus to its heading.
    FocusHeading,
}
