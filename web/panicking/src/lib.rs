//! A solver that panics over a value: `tests/browser/panics.test.mjs` puts it in the place of the solver's
//! module and reads the server's log.

use wasm_bindgen::JsValue;
use wasm_bindgen::prelude::wasm_bindgen;

/// The module's entry.
#[wasm_bindgen(start)]
pub fn start() {
    mimique_web_panics::report_panics("solver", "");
}

/// Panics where the solver's module solves.
#[wasm_bindgen]
pub fn solve(_operators: &[u8], _take: &[u8], _method: &JsValue) {
    answer().expect("a planted panic");
}

fn answer() -> Result<(), &'static str> {
    Err("my-secret-answer")
}
