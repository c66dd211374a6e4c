//! The integration tests of `mimique-annotate`, in one binary.

mod hostile_models;
