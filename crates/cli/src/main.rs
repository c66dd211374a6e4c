//! The mimique command.
fn main() {}
