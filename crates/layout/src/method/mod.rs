//! The methods that choose places.

mod chosen;
mod clusters;
mod greedy;
mod reduce;
mod rehearse;

pub use chosen::{Choice, Chosen, Method, Task};
pub use clusters::ClusterOptions;
pub use rehearse::RehearseOptions;
