//! The participants' addresses: pages, studies, sessions.

pub(crate) mod pages;
pub(crate) mod panics;
pub(crate) mod sessions;
pub(crate) mod studies;
