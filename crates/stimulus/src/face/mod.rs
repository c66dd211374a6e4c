//! Where the parts of an avatar's face are: its openings, its profile, its landmarks.

mod landmarks;
mod openings;
mod profile;

pub use landmarks::{Landmarks, NoProfile};
pub use openings::{MissingOpening, Openings, moved_by};
