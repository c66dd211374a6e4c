#![no_main]
//! A fuzz target: any bytes as a recorded activity: FIT, TCX, GPX, CSV.

#[path = "../../crates/mocap/tests/it/support/activity_invariants.rs"]
mod activity_invariants;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| activity_invariants::read_activity_anyhow(bytes));
