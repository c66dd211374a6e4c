//! Where markers should sit, in numbers: trajectories of vertices in, vertices in the order of their
//! worth out. What a face is, which of its vertices may have a marker and what a layout is worth in a
//! take are not known here.

pub(crate) mod cluster_markers;
pub(crate) mod farthest;
pub(crate) mod greedy;
pub(crate) mod head_spread;
pub(crate) mod kmeans;
pub(crate) mod pivoted_qr;
pub(crate) mod slip;
#[cfg(feature = "surface")]
pub(crate) mod surface_greedy;
pub(crate) mod trajectory_rows;
