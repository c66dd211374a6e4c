//! The methods: a file a method or family of methods, and a line of [`list`] for each.

pub(crate) mod definition;
#[macro_use]
mod list;
pub(crate) mod names;
mod registry;

mod a2f;
pub(crate) mod greedy;
mod kouadio;
mod least_squares;
mod literal;
mod lsts;
mod lsts_norm;
mod lsts_soft;
mod recorded;
mod regression;
mod ridge;
mod shape_pairs;
mod smooth_sparse;
mod sparse;
mod thin_shell_surface;
