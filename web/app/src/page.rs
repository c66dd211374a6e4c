//! The border to the browser (`static/page.js`): elements, requests, storage, time.

use js_sys::{Array, Function};
use wasm_bindgen::JsValue;
use wasm_bindgen::prelude::wasm_bindgen;

use crate::address::Address;

#[wasm_bindgen(raw_module = "./page.js")]
extern "C" {
    /// The place of the pages, emptied.
    pub fn root() -> JsValue;
    /// An element.
    pub fn element(tag: &str) -> JsValue;
    /// A piece of text.
    pub fn text(words: &str) -> JsValue;
    /// Other words for a piece of text.
    #[wasm_bindgen(js_name = setText)]
    pub fn set_text(node: &JsValue, words: &str);
    /// Puts a node before another (undefined: last).
    pub fn insert(parent: &JsValue, node: &JsValue, before: &JsValue);
    /// Takes a node out.
    pub fn remove(node: &JsValue);
    /// Sets an attribute, a `.property` or a `--style`.
    pub fn set(node: &JsValue, name: &str, value: &str);
    /// Takes it off again.
    pub fn unset(node: &JsValue, name: &str);
    /// Calls back with value and state of a field.
    pub fn listen(node: &JsValue, name: &str, call: &Function);
    /// Opens or closes the dialog of the page.
    pub fn dialog(open: bool);
    /// Language and title of the document.
    pub fn describe(language: &str, title: &str);
    /// Writes what went wrong into the console.
    pub fn report(words: &str);
    /// The document's language.
    pub fn language() -> String;

    /// The focus on the first of the selectors `a|b` that is there.
    pub fn focus(selectors: &str);
    /// The focus, after the next frame, on the first of `a|b` that is there.
    #[wasm_bindgen(js_name = focusLater)]
    pub fn focus_later(selectors: &str);
    /// The same, if the element that had the focus has gone.
    #[wasm_bindgen(js_name = focusRescue)]
    pub fn focus_rescue(selectors: &str);
    /// The focus on the heading of a new page.
    #[wasm_bindgen(js_name = focusHeading)]
    pub fn focus_heading();

    /// Calls back with what happens to the window.
    pub fn watch(call: &Function);
    /// The page's clock: milliseconds since 1970, never running backwards within one load.
    pub fn now() -> f64;
    /// Waits.
    pub async fn sleep(ms: f64);
    /// Waits for the first paint of what stands there now.
    pub async fn painted();
    /// Device pixels per CSS pixel.
    #[wasm_bindgen(js_name = pixelRatio)]
    pub fn pixel_ratio() -> f64;
    /// 0..1, for waits.
    pub fn random() -> f64;
    /// So many random bytes, hexadecimal.
    pub fn nonce(bytes: u32) -> String;
    /// Path, query, languages, the site's file and study.
    pub fn place() -> Array;
    /// The number that a text says; NaN if it says none.
    pub fn number(words: &str) -> f64;
    /// Loads the page again.
    pub fn reload();
    /// Percent-encoded.
    pub fn encode(words: &str) -> String;
    /// Width, height, device pixels per CSS pixel.
    pub fn viewport() -> Array;

    /// Status and text of an answer; throws where none has come in so many milliseconds.
    #[wasm_bindgen(catch)]
    pub async fn request(
        method: &str,
        address: &str,
        content_type: &str,
        body: Option<String>,
        patience: f64,
    ) -> Result<JsValue, JsValue>;

    /// A value of the browser's storage.
    pub fn load(key: &str) -> Option<String>;
    /// Keeps a value, or forgets it; false where the browser keeps nothing.
    pub fn save(key: &str, value: Option<String>) -> bool;
    /// Opens the database.
    #[wasm_bindgen(js_name = openDatabase, catch)]
    pub async fn open_database() -> Result<JsValue, JsValue>;
    /// Puts a value; done when it is written.
    #[wasm_bindgen(catch)]
    pub async fn put(store: &str, key: &str, value: &str) -> Result<JsValue, JsValue>;
    /// Forgets values.
    #[wasm_bindgen(catch)]
    pub async fn forget(store: &str, keys: Array) -> Result<JsValue, JsValue>;
    /// Forgets the values of a range of keys.
    #[wasm_bindgen(catch)]
    pub async fn clear(store: &str, first: &str, last: &str) -> Result<JsValue, JsValue>;
    /// The values of a range of keys.
    #[wasm_bindgen(catch)]
    pub async fn all(store: &str, first: &str, last: &str) -> Result<JsValue, JsValue>;
}

/// The parameters with which the participant arrived.
pub fn arrival() -> Address {
    Address::of_study("", &place().get(1).as_string().unwrap_or_default())
}
