//! The researchers' addresses: a file a group.

pub(crate) mod accounts;
mod inline_styles;
pub(crate) mod people;
pub(crate) mod replays;
pub(crate) mod streams;
pub(crate) mod studies;
