//! The researchers' pages: what they show and how they are written.

mod distribution;
mod entry_pages;
mod figures;
mod frame;
mod home_page;
mod overview;
mod page;
mod participant_page;
mod people_pages;
mod pulse;
mod refusals;
mod reports;
mod session_view;
mod upload_pages;

pub(crate) use entry_pages::{link_page, login_page, refusal_page};
pub(crate) use frame::{Frame, escaped};
pub(crate) use home_page::{Listed, home_page};
pub(crate) use overview::{Overview, SessionViews};
pub(crate) use page::study_page;
pub(crate) use participant_page::{Shown, participant_page};
pub(crate) use people_pages::{Done, account_page, log_page, people_page};
pub(crate) use pulse::Pulse;
pub(crate) use refusals::in_french;
pub(crate) use reports::Reports;
pub(crate) use upload_pages::{preparing_page, upload_page};
