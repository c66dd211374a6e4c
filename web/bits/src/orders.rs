//! The orders of `crates/study/tests/golden`, drawn by the module of a browser:
//! `tests/browser/order_bits.test.mjs` compares them with the files.

#[path = "../../../crates/study/tests/it/support/golden.rs"]
mod golden;
#[allow(dead_code)]
#[path = "../../../crates/study/tests/it/support/small.rs"]
mod small;

use wasm_bindgen::prelude::wasm_bindgen;

/// A study of the repository; a module in a browser reads no files.
fn study_text(name: &str) -> String {
    match name {
        "demo.json" => include_str!("../../../study-config/demo.json"),
        "study2b.json" => include_str!("../../../study-config/study2b.json"),
        "invalid/unsatisfiable-order.json" => {
            include_str!("../../../study-config/invalid/unsatisfiable-order.json")
        }
        other => panic!("{other} is not in the module; add it here"),
    }
    .to_owned()
}

/// The names of the stored orders.
#[wasm_bindgen]
pub fn order_names() -> Vec<String> {
    golden::NAMES.map(str::to_owned).into()
}

/// The lines of one of them.
#[wasm_bindgen]
pub fn order_lines(name: &str) -> String {
    golden::lines(name)
}
