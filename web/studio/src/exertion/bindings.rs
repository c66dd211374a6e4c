//! What JavaScript calls of exertion.

use wasm_bindgen::prelude::*;

use crate::bindings::{Studio, error, text};

#[wasm_bindgen]
impl Studio {
    /// [`crate::Workspace::exertion_file`].
    #[wasm_bindgen(js_name = exertionFile)]
    pub fn exertion_file(
        &mut self,
        file: &str,
        bytes: &[u8],
        unit: Option<String>,
        rate_hz: Option<f64>,
    ) -> Result<String, JsValue> {
        self.workspace.exertion_file(file, bytes, unit.as_deref(), rate_hz).map(text).map_err(error)
    }

    /// [`crate::Workspace::exertion_model`].
    #[wasm_bindgen(js_name = exertionModel)]
    pub fn exertion_model(&mut self, file: &str, model: &str) -> Result<String, JsValue> {
        self.workspace.exertion_model(file, model).map(text).map_err(error)
    }

    /// [`crate::Workspace::exertion`].
    pub fn exertion(&mut self, settings: &str) -> Result<String, JsValue> {
        self.workspace.exertion(settings).map(text).map_err(error)
    }

    /// [`crate::Workspace::exertion_weights_csv`].
    #[wasm_bindgen(js_name = exertionWeightsCsv)]
    pub fn exertion_weights_csv(&self) -> Result<String, JsValue> {
        self.workspace.exertion_weights_csv().map_err(error)
    }

    /// [`crate::Workspace::exertion_series_csv`].
    #[wasm_bindgen(js_name = exertionSeriesCsv)]
    pub fn exertion_series_csv(&self) -> Result<String, JsValue> {
        self.workspace.exertion_series_csv().map_err(error)
    }

    /// [`crate::Workspace::exertion_plot`].
    #[wasm_bindgen(js_name = exertionPlot)]
    pub fn exertion_plot(&self) -> Result<String, JsValue> {
        self.workspace.exertion_plot().map_err(error)
    }

    /// [`crate::Workspace::exertion_study`].
    #[wasm_bindgen(js_name = exertionStudy)]
    pub fn exertion_study(&self) -> Result<String, JsValue> {
        self.workspace.exertion_study().map_err(error)
    }
}
