//! The researchers' part of the server: dashboard, pages, addresses, report.

pub(crate) mod dashboard;
pub(crate) mod handlers;
pub(crate) mod pages;
pub(crate) mod replay;
pub(crate) mod reports;
