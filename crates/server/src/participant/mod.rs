//! The participants' addresses: pages, studies, sessions.

pub(crate) mod first_page;
mod marks;
pub(crate) mod pages;
pub(crate) mod pairs;
pub(crate) mod panics;
pub(crate) mod previews;
mod resumed;
pub(crate) mod sessions;
pub(crate) mod studies;
pub(crate) mod withdrawal;
mod withdrawal_page;
