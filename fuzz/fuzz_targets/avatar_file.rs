#![no_main]
//! A fuzz target: any bytes as an avatar: GLB, glTF, a zip or tar of OBJ poses.

#[allow(dead_code)]
#[path = "../../crates/avatar-files/tests/it/support/any_avatar.rs"]
mod any_avatar;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| any_avatar::consume(any_avatar::Kind::Gltf, bytes));
