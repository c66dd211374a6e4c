//! One set of features for the dependencies of all web modules, so that `cargo xtask web` compiles each dependency once.
//!
//! The modules are built by separate calls of cargo, and cargo chooses the features of a package for each call. All modules
//! depend on this crate, whose `Cargo.toml` lists the union of what they ask for. It has no code.
