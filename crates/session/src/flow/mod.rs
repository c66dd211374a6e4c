//! The flow of a session as a state machine: `update(plan, state, input, now) -> (state, effects)`.
//!
//! The page holds a [`Plan`] and a [`State`], renders what [`view`] says, hands every act of the
//! participant and every report of its own machinery to [`update`] as an [`Input`], and carries out
//! the [`Effect`]s that come back. What must not be forgotten becomes an event
//! ([`crate::EventKind`]); what a state remembers is
//! the [`crate::Record`] of its events, so [`State::replay`] of the stored
//! events is how a session goes on after a reload.
//!
//! ```text
//! first load:  POST sessions -> Plan::new -> State::new -> update(Opened)
//! reload:      GET session   -> Plan::new -> State::replay(events) -> update(Resumed)
//! then:        render view(plan, state); wait; update(input); carry out effects; again
//! ```

mod agreement;
mod allowed;
mod clock;
mod drawn_pairs;
mod effect;
mod ending;
mod faces;
mod gate;
mod input;
mod levels;
mod needs;
mod placed;
mod plays;
mod presses;
mod render;
mod render_gate;
mod render_question;
mod seen;
mod state;
mod update;
mod view;
mod view_gate;
mod view_question;

pub use crate::panel::Panel;
pub use crate::plan::{Companion, Plan, Step, StepKind, TrialStep};
pub use agreement::AgreementView;
pub use effect::Effect;
pub(crate) use gate::unmet;
pub use gate::{CARD_HEIGHT_MM, CARD_WIDTH_MM, SOUND_HEARD};
pub use input::Input;
pub use mimique_study::{ChoiceView, QuestionKindView};
pub use placed::{BESIDE_CANVAS, OWN_CANVAS, PlacedClip, canvas_of_place};
pub use plays::Plays;
pub use render::view;
pub use seen::{KeptFrames, Seen, SeenPage, SeenPlay};
pub use state::{Live, Play, State};
pub use update::update;
pub use view::{
    BesideView, ButtonView, ClockView, CodeView, ContactView, EndView, FailedView, PanelFigure,
    PanelView, Phase, ProgressView, RecordsView, SectionView, StageSize, TrialView, View,
};
pub use view_gate::{
    CalibrationView, CardView, DeviceView, DistanceView, FeedbackItem, FeedbackView, ScriptedView,
};
pub use view_question::QuestionView;
