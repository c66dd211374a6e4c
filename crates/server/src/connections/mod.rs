//! What keeps a caller from holding more connections than a caller needs, and from holding them for ever.

mod paced;
mod places;

pub(crate) use paced::Paced;
pub(crate) use places::Places;
