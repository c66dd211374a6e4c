//! What the dashboard counts: sessions, answers, times, where people leave; and when it changes.

pub(crate) mod figures;
pub(crate) mod keeper;
pub(crate) mod kept;
pub(crate) mod overview;
pub(crate) mod pace;
pub(crate) mod pulse;
pub(crate) mod session_sums;
pub(crate) mod tally;
