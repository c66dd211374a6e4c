//! The skin moved by its markers alone, without shapes (thesis eq. 2.16).

pub(crate) mod frame;
#[cfg(feature = "surface")]
pub(crate) mod response;
#[cfg(feature = "surface")]
pub(crate) mod sparse_cholesky;
