//! Quadratic programmes over a box, and the least squares without one.

pub(crate) mod box_qp;
pub(crate) mod least_norm;
pub(crate) mod pentadiagonal;
