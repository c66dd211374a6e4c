//! Participants' sessions: what is read of them, and the changes that the writer commits together.

mod append;
mod change;
mod complete;
mod deletion;
pub(crate) mod erase;
mod find;
mod gaps;
mod overdue;
mod pages;
mod read;
mod receipt;
mod row;
mod start;
mod sums;
mod write;
pub(crate) mod writer;
