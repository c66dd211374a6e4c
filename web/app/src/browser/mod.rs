//! What the pages ask of the browser, on web-sys and gloo; canvas and solver behind [`host`].

pub mod clock;
pub mod document;
pub mod focus;
pub mod host;
pub mod http;
pub mod random;
pub mod storage;
pub mod window;

use mimique_session::StageFailure;
use wasm_bindgen::{JsCast as _, JsValue};

/// What a script of the stage threw, with the code and the values by which the page words it
/// (`static/stage/failure.js`).
pub fn stage_failure(thrown: &JsValue) -> StageFailure {
    let part = |name: &str| js_sys::Reflect::get(thrown, &JsValue::from_str(name)).ok();
    let values = part("values").filter(JsValue::is_object);
    let code = part("code").filter(|_| values.is_some()).and_then(|code| code.as_string());
    let entries = values.map(|values| js_sys::Object::entries(values.unchecked_ref()));
    let pair = |entry: JsValue| {
        let entry = entry.dyn_into::<js_sys::Array>().ok()?;
        Some((entry.get(0).as_string()?, entry.get(1).as_string()?))
    };
    StageFailure {
        code: code.unwrap_or_else(|| "unknown".to_owned()),
        values: entries.iter().flat_map(|entries| entries.iter().filter_map(pair)).collect(),
        message: reason(thrown),
    }
}

/// What a script threw, as text.
pub fn reason(thrown: &JsValue) -> String {
    thrown
        .dyn_ref::<js_sys::Error>()
        .map(|error| String::from(error.message()))
        .or_else(|| thrown.as_string())
        .unwrap_or_else(|| format!("{thrown:?}"))
}
