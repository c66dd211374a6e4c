//! What JavaScript calls.

use wasm_bindgen::prelude::*;

use crate::problem::Problem;
use crate::workspace::Workspace;

/// The module's entry.
#[wasm_bindgen(start)]
pub fn start() {
    mimique_web_panics::report_panics("studio", "");
}

/// The studio's workspace.
#[wasm_bindgen]
#[derive(Debug, Default)]
pub struct Studio {
    pub(crate) workspace: Workspace,
}

pub(crate) fn text(value: serde_json::Value) -> String {
    value.to_string()
}

/// An `Error` with the English words as its message and the problem itself, as JSON, under `problem`.
pub(crate) fn error(problem: Problem) -> JsValue {
    let error = js_sys::Error::new(&problem.to_string());
    // A fresh object of our own takes a property.
    let _ = js_sys::Reflect::set(&error, &"problem".into(), &problem.json().to_string().into());
    error.into()
}

#[wasm_bindgen]
impl Studio {
    /// An empty workspace.
    #[wasm_bindgen(constructor)]
    pub fn new() -> Self {
        Self::default()
    }

    /// [`Workspace::avatar_file`].
    #[wasm_bindgen(js_name = avatarFile)]
    pub fn avatar_file(
        &mut self,
        file: &str,
        bytes: Vec<u8>,
        settings: Option<String>,
    ) -> Result<String, JsValue> {
        self.workspace.avatar_file(file, bytes, settings.as_deref()).map(text).map_err(error)
    }

    /// [`Workspace::built_in_avatar`].
    #[wasm_bindgen(js_name = builtInAvatar)]
    pub fn built_in_avatar(&mut self, seed: u32, vertices: usize) -> Result<String, JsValue> {
        self.workspace.built_in_avatar(u64::from(seed), vertices).map(text).map_err(error)
    }

    /// [`Workspace::avatar_pack`].
    #[wasm_bindgen(js_name = avatarPack)]
    pub fn avatar_pack(&self) -> Result<Vec<u8>, JsValue> {
        self.workspace.avatar_pack().map_err(error)
    }

    /// [`Workspace::take_file`].
    #[wasm_bindgen(js_name = takeFile)]
    pub fn take_file(
        &mut self,
        file: &str,
        bytes: &[u8],
        unit: Option<String>,
        rate_hz: Option<f64>,
    ) -> Result<String, JsValue> {
        self.workspace.take_file(file, bytes, unit.as_deref(), rate_hz).map(text).map_err(error)
    }

    /// [`Workspace::built_in_take`].
    #[wasm_bindgen(js_name = builtInTake)]
    pub fn built_in_take(&mut self, actor: u32) -> String {
        text(self.workspace.built_in_take(u64::from(actor)))
    }

    /// [`Workspace::training_take`].
    #[wasm_bindgen(js_name = trainingTake)]
    pub fn training_take(
        &mut self,
        file: &str,
        bytes: &[u8],
        unit: Option<String>,
        rate_hz: Option<f64>,
    ) -> Result<String, JsValue> {
        self.workspace.training_take(file, bytes, unit.as_deref(), rate_hz).map(text).map_err(error)
    }

    /// [`Workspace::training_weights`].
    #[wasm_bindgen(js_name = trainingWeights)]
    pub fn training_weights(&mut self, file: &str, bytes: &[u8]) -> Result<String, JsValue> {
        self.workspace.training_weights(file, bytes).map(text).map_err(error)
    }

    /// [`Workspace::built_in_training`].
    #[wasm_bindgen(js_name = builtInTraining)]
    pub fn built_in_training(&mut self, actor: u32) -> String {
        text(self.workspace.built_in_training(u64::from(actor)))
    }

    /// [`Workspace::set_training_neutral`].
    #[wasm_bindgen(js_name = setTrainingNeutral)]
    pub fn set_training_neutral(&mut self, first: usize, end: usize) -> Result<String, JsValue> {
        self.workspace.set_training_neutral(first, end).map(text).map_err(error)
    }

    /// [`Workspace::training_state`].
    #[wasm_bindgen(js_name = trainingState)]
    pub fn training_state(&self) -> String {
        text(self.workspace.training_state())
    }

    /// [`Workspace::rest_gaze`].
    #[wasm_bindgen(js_name = restGaze)]
    pub fn rest_gaze(&mut self) -> String {
        text(self.workspace.rest_gaze())
    }

    /// [`Workspace::hold_gaze`].
    #[wasm_bindgen(js_name = holdGaze)]
    pub fn hold_gaze(
        &mut self,
        azimuth: f64,
        elevation: f64,
        vergence: f64,
    ) -> Result<String, JsValue> {
        self.workspace.hold_gaze(azimuth, elevation, vergence).map(text).map_err(error)
    }

    /// [`Workspace::gaze_at_marker`].
    #[wasm_bindgen(js_name = gazeAtMarker)]
    pub fn gaze_at_marker(&mut self, label: &str) -> Result<String, JsValue> {
        self.workspace.gaze_at_marker(label).map(text).map_err(error)
    }

    /// [`Workspace::gaze_file`].
    #[wasm_bindgen(js_name = gazeFile)]
    pub fn gaze_file(&mut self, file: &str, bytes: &[u8]) -> Result<String, JsValue> {
        self.workspace.gaze_file(file, bytes).map(text).map_err(error)
    }

    /// [`Workspace::map_file`].
    #[wasm_bindgen(js_name = mapFile)]
    pub fn map_file(&mut self, file: &str, map: &str) -> Result<String, JsValue> {
        self.workspace.map_file(file, map).map(text).map_err(error)
    }

    /// [`Workspace::suggest_map`].
    #[wasm_bindgen(js_name = suggestMap)]
    pub fn suggest_map(&mut self) -> Result<String, JsValue> {
        self.workspace.suggest_map().map(text).map_err(error)
    }

    /// [`Workspace::place`].
    pub fn place(
        &mut self,
        label: &str,
        vertex: Option<usize>,
        head: bool,
    ) -> Result<String, JsValue> {
        self.workspace.place(label, vertex, head).map(text).map_err(error)
    }

    /// [`Workspace::set_neutral`].
    #[wasm_bindgen(js_name = setNeutral)]
    pub fn set_neutral(&mut self, first: usize, end: usize) -> Result<String, JsValue> {
        self.workspace.set_neutral(first, end).map(text).map_err(error)
    }

    /// [`Workspace::map_state`].
    #[wasm_bindgen(js_name = mapState)]
    pub fn map_state(&self) -> Result<String, JsValue> {
        self.workspace.map_state().map(text).map_err(error)
    }

    /// [`Workspace::map_json`].
    #[wasm_bindgen(js_name = mapJson)]
    pub fn map_json(&self) -> String {
        self.workspace.map_json()
    }

    /// [`Workspace::solve`]; of a method with wrong parameters `{"problems": [...]}`, each with the field
    /// and the entry that it is about.
    pub fn solve(&mut self, slot: &str, method: &str) -> Result<String, JsValue> {
        if let Some(problems) = crate::method_fields::problems(method) {
            return Ok(text(problems));
        }
        self.workspace.solve(slot, method).map(text).map_err(error)
    }

    /// [`Workspace::named_method`].
    #[wasm_bindgen(js_name = namedMethod)]
    pub fn named_method(&self, method: &str) -> Result<String, JsValue> {
        self.workspace.named_method(method).map(text).map_err(error)
    }

    /// [`Workspace::forget`].
    pub fn forget(&mut self, slot: &str) {
        self.workspace.forget(slot);
    }

    /// [`Workspace::weights`].
    pub fn weights(&self, slot: &str) -> Result<Vec<f32>, JsValue> {
        self.workspace.weights(slot).map_err(error)
    }

    /// [`Workspace::series`].
    pub fn series(&self, slot: &str, name: &str) -> Result<Vec<f32>, JsValue> {
        self.workspace.series(slot, name).map_err(error)
    }

    /// [`Workspace::slot_pack`].
    #[wasm_bindgen(js_name = slotPack)]
    pub fn slot_pack(&self, slot: &str) -> Result<Vec<u8>, JsValue> {
        self.workspace.slot_pack(slot).map_err(error)
    }

    /// [`Workspace::marker_frame`].
    #[wasm_bindgen(js_name = markerFrame)]
    pub fn marker_frame(&self, slot: &str, frame: usize) -> Result<Vec<f32>, JsValue> {
        self.workspace.marker_frame(slot, frame).map_err(error)
    }

    /// [`Workspace::capture_points`] as JSON.
    #[wasm_bindgen(js_name = capturePoints)]
    pub fn capture_points(&self) -> Result<String, JsValue> {
        self.workspace.capture_points().map(text).map_err(error)
    }

    /// [`Workspace::mirrored_vertex`].
    #[wasm_bindgen(js_name = mirroredVertex)]
    pub fn mirrored_vertex(&self, vertex: usize) -> Result<usize, JsValue> {
        self.workspace.mirrored_vertex(vertex).map_err(error)
    }

    /// [`Workspace::difference`] as JSON.
    pub fn difference(&self, a: &str, b: &str, frame: usize) -> Result<String, JsValue> {
        let found = self.workspace.difference(a, b, frame).map_err(error)?;
        serde_json::to_string(&found).map_err(|e| error(Problem::of("difference", e)))
    }

    /// [`Workspace::difference_over`] as JSON.
    #[wasm_bindgen(js_name = differenceOver)]
    pub fn difference_over(&self, a: &str, b: &str) -> Result<String, JsValue> {
        let found = self.workspace.difference_over(a, b).map_err(error)?;
        serde_json::to_string(&found).map_err(|e| error(Problem::of("difference", e)))
    }

    /// [`Workspace::heat_map`], RGBA.
    #[wasm_bindgen(js_name = heatMap)]
    #[allow(clippy::too_many_arguments, reason = "JavaScript has no tuples")]
    pub fn heat_map(
        &self,
        a: &str,
        b: &str,
        frame: usize,
        camera: &[f32],
        width: usize,
        height: usize,
        full_mm: f32,
    ) -> Result<Vec<u8>, JsValue> {
        let picture = self
            .workspace
            .heat_map([a, b], frame, camera, [width, height], full_mm)
            .map_err(error)?;
        Ok(picture.rgba)
    }

    /// [`Workspace::pick`].
    pub fn pick(
        &self,
        camera: &[f32],
        width: usize,
        height: usize,
        x: f32,
        y: f32,
    ) -> Result<Option<usize>, JsValue> {
        self.workspace.pick(camera, [width, height], [x, y]).map_err(error)
    }

    /// [`Workspace::suggest_expressions`].
    #[wasm_bindgen(js_name = suggestExpressions)]
    pub fn suggest_expressions(
        &mut self,
        slot: &str,
        labels: &str,
        sensitivity: f64,
    ) -> Result<String, JsValue> {
        self.workspace.suggest_expressions(slot, labels, sensitivity).map(text).map_err(error)
    }

    /// [`Workspace::set_expressions`].
    #[wasm_bindgen(js_name = setExpressions)]
    pub fn set_expressions(&mut self, segments: &str) -> Result<String, JsValue> {
        self.workspace.set_expressions(segments).map(text).map_err(error)
    }

    /// [`Workspace::expressions_file`].
    #[wasm_bindgen(js_name = expressionsFile)]
    pub fn expressions_file(&mut self, file: &str, content: &str) -> Result<String, JsValue> {
        self.workspace.expressions_file(file, content).map(text).map_err(error)
    }

    /// [`Workspace::expressions_csv`].
    #[wasm_bindgen(js_name = expressionsCsv)]
    pub fn expressions_csv(&self) -> Result<String, JsValue> {
        self.workspace.expressions_csv().map_err(error)
    }

    /// [`Workspace::expressions_eaf`].
    #[wasm_bindgen(js_name = expressionsEaf)]
    pub fn expressions_eaf(&self, document: Option<String>, date: &str) -> Result<String, JsValue> {
        self.workspace.expressions_eaf(document.as_deref(), date).map_err(error)
    }

    /// [`Workspace::label_model`].
    #[wasm_bindgen(js_name = labelModel)]
    pub fn label_model(&mut self, file: &str, model: &str) -> Result<String, JsValue> {
        self.workspace.label_model(file, model).map(text).map_err(error)
    }

    /// [`Workspace::label_model_json`].
    #[wasm_bindgen(js_name = labelModelJson)]
    pub fn label_model_json(&self) -> Result<String, JsValue> {
        self.workspace.label_model_json().map_err(error)
    }

    /// [`Workspace::suggest_labels`].
    #[wasm_bindgen(js_name = suggestLabels)]
    pub fn suggest_labels(&mut self, slot: &str) -> Result<String, JsValue> {
        self.workspace.suggest_labels(slot).map(text).map_err(error)
    }

    /// [`Workspace::learn_labels`].
    #[wasm_bindgen(js_name = learnLabels)]
    pub fn learn_labels(&mut self, slot: &str) -> Result<String, JsValue> {
        self.workspace.learn_labels(slot).map(text).map_err(error)
    }

    /// [`Workspace::confirm_label`].
    #[wasm_bindgen(js_name = confirmLabel)]
    pub fn confirm_label(&mut self, index: usize) -> Result<String, JsValue> {
        self.workspace.confirm_label(index).map(text).map_err(error)
    }

    /// [`Workspace::release_label`].
    #[wasm_bindgen(js_name = releaseLabel)]
    pub fn release_label(&mut self, index: usize) -> Result<String, JsValue> {
        self.workspace.release_label(index).map(text).map_err(error)
    }

    /// [`Workspace::relabel`].
    pub fn relabel(&mut self, index: usize, name: &str) -> Result<String, JsValue> {
        self.workspace.relabel(index, name).map(text).map_err(error)
    }

    /// [`Workspace::move_label`].
    #[wasm_bindgen(js_name = moveLabel)]
    pub fn move_label(
        &mut self,
        index: usize,
        first: usize,
        end: usize,
    ) -> Result<String, JsValue> {
        self.workspace.move_label(index, first, end).map(text).map_err(error)
    }

    /// [`Workspace::keep_labels`].
    #[wasm_bindgen(js_name = keepLabels)]
    pub fn keep_labels(&mut self) -> usize {
        self.workspace.keep_labels()
    }

    /// [`Workspace::restore_labels`] as JSON.
    #[wasm_bindgen(js_name = restoreLabels)]
    pub fn restore_labels(&mut self, kept: usize) -> Result<String, JsValue> {
        self.workspace.restore_labels(kept).map(text).map_err(error)
    }

    /// [`Workspace::labels_state`].
    #[wasm_bindgen(js_name = labelsState)]
    pub fn labels_state(&self) -> String {
        text(self.workspace.labels_state())
    }

    /// [`Workspace::label_probabilities`].
    #[wasm_bindgen(js_name = labelProbabilities)]
    pub fn label_probabilities(&self, label: usize) -> Vec<f32> {
        self.workspace.label_probabilities(label)
    }

    /// [`Workspace::labels_from_expressions`].
    #[wasm_bindgen(js_name = labelsFromExpressions)]
    pub fn labels_from_expressions(&mut self, rest_is_neutral: bool) -> Result<String, JsValue> {
        self.workspace.labels_from_expressions(rest_is_neutral).map(text).map_err(error)
    }

    /// [`Workspace::labels_to_expressions`].
    #[wasm_bindgen(js_name = labelsToExpressions)]
    pub fn labels_to_expressions(&mut self, confirmed_only: bool) -> Result<String, JsValue> {
        self.workspace.labels_to_expressions(confirmed_only).map(text).map_err(error)
    }

    /// [`Workspace::labels_csv`].
    #[wasm_bindgen(js_name = labelsCsv)]
    pub fn labels_csv(&self) -> Result<String, JsValue> {
        self.workspace.labels_csv().map_err(error)
    }

    /// [`Workspace::labels_eaf`].
    #[wasm_bindgen(js_name = labelsEaf)]
    pub fn labels_eaf(&self, document: Option<String>, date: &str) -> Result<String, JsValue> {
        self.workspace.labels_eaf(document.as_deref(), date).map_err(error)
    }

    /// [`Workspace::study_segments`].
    #[wasm_bindgen(js_name = studySegments)]
    pub fn study_segments(&self) -> Result<String, JsValue> {
        self.workspace.study_segments().map_err(error)
    }

    /// [`Workspace::weights_csv`].
    #[wasm_bindgen(js_name = weightsCsv)]
    pub fn weights_csv(&self, slot: &str) -> Result<String, JsValue> {
        self.workspace.weights_csv(slot).map_err(error)
    }

    /// [`Workspace::animated_glb`].
    #[wasm_bindgen(js_name = animatedGlb)]
    pub fn animated_glb(&self, slot: &str, first: usize, end: usize) -> Result<Vec<u8>, JsValue> {
        self.workspace.animated_glb(slot, first, end).map_err(error)
    }
}

/// Every method with the names of its parameters, as JSON:
/// `[{"name": "lsts", "parameters": ["alpha", ...]}, ...]`.
#[wasm_bindgen]
pub fn methods() -> String {
    text(crate::method_fields::methods())
}
