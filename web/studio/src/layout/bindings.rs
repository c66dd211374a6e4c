//! What JavaScript calls of layouts.

use wasm_bindgen::prelude::*;

use crate::bindings::{Studio, error, text};

#[wasm_bindgen]
impl Studio {
    /// [`crate::Workspace::make_layout`].
    #[wasm_bindgen(js_name = makeLayout)]
    pub fn make_layout(
        &mut self,
        method: &str,
        count: usize,
        heads: usize,
        symmetric: bool,
    ) -> Result<String, JsValue> {
        self.workspace.make_layout(method, count, heads, symmetric).map(text).map_err(error)
    }

    /// [`crate::Workspace::layout_file`].
    #[wasm_bindgen(js_name = layoutFile)]
    pub fn layout_file(&mut self, file: &str, map: &str) -> Result<String, JsValue> {
        self.workspace.layout_file(file, map).map(text).map_err(error)
    }

    /// [`crate::Workspace::layout_from_map`].
    #[wasm_bindgen(js_name = layoutFromMap)]
    pub fn layout_from_map(&mut self) -> Result<String, JsValue> {
        self.workspace.layout_from_map().map(text).map_err(error)
    }

    /// [`crate::Workspace::move_layout_marker`].
    #[wasm_bindgen(js_name = moveLayoutMarker)]
    pub fn move_layout_marker(
        &mut self,
        index: usize,
        vertex: usize,
        partner: bool,
        step: bool,
    ) -> Result<String, JsValue> {
        self.workspace.move_layout_marker(index, vertex, partner, step).map(text).map_err(error)
    }

    /// [`crate::Workspace::drop_layout_marker`].
    #[wasm_bindgen(js_name = dropLayoutMarker)]
    pub fn drop_layout_marker(&mut self, index: usize) -> Result<String, JsValue> {
        self.workspace.drop_layout_marker(index).map(text).map_err(error)
    }

    /// [`crate::Workspace::undo_layout`].
    #[wasm_bindgen(js_name = undoLayout)]
    pub fn undo_layout(&mut self) -> Result<String, JsValue> {
        self.workspace.undo_layout().map(text).map_err(error)
    }

    /// [`crate::Workspace::rehearse_layout`].
    #[wasm_bindgen(js_name = rehearseLayout)]
    pub fn rehearse_layout(&mut self) -> Result<String, JsValue> {
        self.workspace.rehearse_layout().map(text).map_err(error)
    }

    /// [`crate::Workspace::layout_state`].
    #[wasm_bindgen(js_name = layoutState)]
    pub fn layout_state(&mut self) -> Result<String, JsValue> {
        self.workspace.layout_state().map(text).map_err(error)
    }

    /// [`crate::Workspace::layout_json`].
    #[wasm_bindgen(js_name = layoutJson)]
    pub fn layout_json(&mut self) -> Result<String, JsValue> {
        self.workspace.layout_json().map_err(error)
    }
}
