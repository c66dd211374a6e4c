#![no_main]
//! A fuzz target: any bytes as the settings of an avatar (`avatar.json`), applied to poses.

#[allow(dead_code)]
#[path = "../../crates/avatar-files/tests/it/support/any_avatar.rs"]
mod any_avatar;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| any_avatar::consume(any_avatar::Kind::Settings, bytes));
