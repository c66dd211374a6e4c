//! The integration tests of `mimique-web-studio`, in one binary.

mod exertion;
mod labels;
mod layout;
mod node_labels;
mod one_pipeline;
mod study;
mod workspace;
