//! The numbers of `crates/exertion/tests/golden/bits.txt`, computed by a browser's module:
//! `tests/wasm/exertion_bits.mjs` compares them with the file.

#[path = "../../../crates/exertion/tests/it/support/bits.rs"]
mod bits;

use wasm_bindgen::prelude::wasm_bindgen;

/// The lines of the file.
#[wasm_bindgen]
pub fn exertion_lines() -> String {
    bits::lines()
}
