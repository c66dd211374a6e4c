//! Builds, tests and demonstrates.
fn main() {}
