//! The researchers' pages as HTML, in English and French: a file a page.

pub(crate) mod entry;
pub(crate) mod frame;
pub(crate) mod home;
pub(crate) mod participant;
pub(crate) mod people;
pub(crate) mod replay;
pub(crate) mod standing_words;
pub(crate) mod study;
mod study_roles;
