#![no_main]
//! A fuzz target: any bytes as an ELAN document; into what is one, tiers are written.

#[path = "../../crates/stimulus/tests/it/support/any_eaf.rs"]
mod any_eaf;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| any_eaf::read_anyhow(bytes));
