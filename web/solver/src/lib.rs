//! The solver's worker: operators and a take in, weights out.
//!
//! ```js
//! const solved = solve(operators, take, clip.method);
//! solved.weights();       // Float32Array, frames x shapes
//! solved.weights_hash();  // compare with clip.weights_hash
//! ```
//!
//! It is the function that the server has called before ([`mimique_stimulus::solve_packs`]), so the
//! weights have the same bits; they leave here in single precision, which is what is drawn.

use mimique_solver::MethodSpec;
use mimique_stimulus::{FrameStatistics, SolvedTake, solve_packs};
use serde::Serialize;
use wasm_bindgen::prelude::*;

#[cfg(target_arch = "wasm32")]
#[global_allocator]
static ALLOCATOR: rlsf::SmallGlobalTlsf = rlsf::SmallGlobalTlsf::new();

/// The weights of one clip.
#[wasm_bindgen]
#[derive(Debug)]
pub struct Solved {
    take: SolvedTake,
}

/// Solves the take pack with the operators pack; `method` is a `MethodSpec`, as the object that its JSON
/// is. It is the browser that reads and writes JSON here: our own way would be a fifth of the module.
///
/// # Errors
/// Throws an `Error` whose message says place, what and remedy: a damaged pack, packs that do not
/// belong together, a method that does not solve with these operators.
#[wasm_bindgen]
pub fn solve(operators: &[u8], take: &[u8], method: JsValue) -> Result<Solved, JsError> {
    let spec: MethodSpec = serde_wasm_bindgen::from_value(method)
        .map_err(|e| JsError::new(&format!("method: {e}")))?;
    let take = solve_packs(operators, take, &spec)?;
    Ok(Solved { take })
}

/// What the worker says of a clip besides its weights.
#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Report<'a> {
    shape_names: &'a [String],
    statistics: &'a Option<FrameStatistics>,
    warnings: &'a [String],
}

#[wasm_bindgen]
impl Solved {
    /// Frame-major weights, frames x shapes.
    pub fn weights(&self) -> Vec<f32> {
        self.take.weights.iter().map(|&w| w as f32).collect()
    }

    /// Number of frames.
    pub fn frames(&self) -> usize {
        self.take.frames()
    }

    /// Number of shapes.
    pub fn shapes(&self) -> usize {
        self.take.shape_names.len()
    }

    /// Frames a second.
    pub fn rate_hz(&self) -> f64 {
        self.take.rate_hz
    }

    /// SHA-256 of the weights in double precision, hexadecimal.
    pub fn weights_hash(&self) -> String {
        self.take.weights_hash.clone()
    }

    /// `{"shapeNames": [...], "statistics": {...} or null, "warnings": [...]}`.
    ///
    /// # Errors
    /// None that is known: everything in it is numbers and texts.
    pub fn report(&self) -> Result<JsValue, JsError> {
        let report = Report {
            shape_names: &self.take.shape_names,
            statistics: &self.take.statistics,
            warnings: &self.take.warnings,
        };
        Ok(report.serialize(&serde_wasm_bindgen::Serializer::json_compatible())?)
    }
}
