//! What the pages ask of the browser, on web-sys and gloo; canvas and solver behind [`host`].

pub mod clock;
pub mod document;
pub mod focus;
pub mod host;
pub mod http;
pub mod random;
pub mod storage;
pub mod window;

use wasm_bindgen::{JsCast as _, JsValue};

/// What a script threw, as text.
pub fn reason(thrown: &JsValue) -> String {
    thrown
        .dyn_ref::<js_sys::Error>()
        .map(|error| String::from(error.message()))
        .or_else(|| thrown.as_string())
        .unwrap_or_else(|| format!("{thrown:?}"))
}
