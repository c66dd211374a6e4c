//! The skin: welded triangles with their shapes, the Laplacian on them, where markers sit, and what weights make of it.

pub(crate) mod laplacian;
pub(crate) mod marker_site;
pub(crate) mod skin_mesh;
pub(crate) mod symmetry;
pub(crate) mod synthesis;
