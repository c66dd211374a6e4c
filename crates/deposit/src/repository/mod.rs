//! What repositories of research data are told of a deposit, as their documented interfaces have it.

mod dataverse;
mod zenodo;

pub use dataverse::dataverse_dataset;
pub use zenodo::zenodo_metadata;
