//! What the dashboard counts: sessions, answers, times, where people leave; and when it changes.

pub(crate) mod distribution;
pub(crate) mod figures;
pub(crate) mod overview;
pub(crate) mod pulse;
pub(crate) mod session_view;
