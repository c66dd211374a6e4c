#![no_main]
//! A fuzz target: any bytes as a study file, checked; what passes is run.

#[path = "../../crates/session/tests/it/support/any_study.rs"]
mod any_study;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| any_study::check_anyhow(bytes));
