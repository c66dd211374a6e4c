//! The researcher's page: who may see it, what it shows, how it is written.

mod access;
mod distribution;
mod overview;
mod page;
mod session_view;

pub(crate) use access::{admit, require};
pub(crate) use overview::{Overview, SessionViews};
pub(crate) use page::{dashboard, denied};
