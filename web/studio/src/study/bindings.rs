//! What JavaScript calls of studies.

use wasm_bindgen::prelude::*;

use crate::Workspace;
use crate::bindings::{Studio, error, text};

#[wasm_bindgen]
impl Studio {
    /// [`Workspace::study_library`] as JSON.
    #[wasm_bindgen(js_name = studyLibrary)]
    pub fn study_library(&self) -> Result<String, JsValue> {
        Workspace::study_library().map(text).map_err(error)
    }

    /// [`Workspace::study`] as JSON.
    pub fn study(&self, asked: &str) -> Result<String, JsValue> {
        self.workspace.study(asked).map(text).map_err(error)
    }
}
