//! The solver's worker: operators and a take in, weights out.
//!
//! ```js
//! const solved = solve(await inflated(operators), take, JSON.stringify(clip.method)); // stage/inflated.js
//! solved.weights();       // Float32Array, frames x shapes
//! solved.weights_hash();  // compare with clip.weights_hash
//! ```
//!
//! It is the function that the server has called before ([`mimique_clip::solve_inflated`]), so the
//! weights have the same bits; they leave here in single precision, which is what is drawn.

use mimique_clip::{SolvedTake, solve_inflated};
use mimique_solver::MethodSpec;
use serde_json::json;
use wasm_bindgen::prelude::*;

#[cfg(target_arch = "wasm32")]
#[global_allocator]
static ALLOCATOR: rlsf::SmallGlobalTlsf = rlsf::SmallGlobalTlsf::new();

/// The module's entry.
#[wasm_bindgen(start)]
pub fn start() {
    mimique_web_panics::report_panics("solver", "");
}

/// The weights of one clip.
#[wasm_bindgen]
#[derive(Debug)]
pub struct Solved {
    take: SolvedTake,
}

/// Solves the take pack with the operators pack, whose body the browser has inflated; `method` is a
/// `MethodSpec` as JSON.
///
/// # Errors
/// Throws an `Error` whose message says place, what and remedy: a damaged pack, packs that do not
/// belong together, a method that is none or does not solve with these operators.
#[wasm_bindgen]
pub fn solve(operators: &[u8], take: &[u8], method: &str) -> Result<Solved, JsError> {
    let spec: MethodSpec = serde_json::from_str(method)?;
    let take = solve_inflated(operators, take, &spec)?;
    Ok(Solved { take })
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

    /// Frames per second.
    pub fn rate_hz(&self) -> f64 {
        self.take.rate_hz
    }

    /// SHA-256 of the weights in double precision, hexadecimal.
    pub fn weights_hash(&self) -> String {
        self.take.weights_hash.clone()
    }

    /// JSON: `{"shapeNames": [...], "gazeAtRest": [...], "statistics": {...} or null, "warnings": [...]}`.
    pub fn report(&self) -> String {
        let SolvedTake { shape_names, gaze_at_rest, statistics, warnings, .. } = &self.take;
        json!({
            "shapeNames": shape_names,
            "gazeAtRest": gaze_at_rest,
            "statistics": statistics,
            "warnings": warnings.iter().map(ToString::to_string).collect::<Vec<_>>(),
        })
        .to_string()
    }
}
