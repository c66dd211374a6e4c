//! The solver's worker: operators and a take in, weights out.
//!
//! ```js
//! const solved = solve(await inflated(operators), take, clip.method); // inflated.js
//! solved.weights();       // Float32Array, frames x shapes
//! solved.weights_hash();  // compare with clip.weights_hash
//! ```
//!
//! It is the function that the server has called before ([`mimique_stimulus::solve_inflated`]), so the
//! weights have the same bits; they leave here in single precision, which is what is drawn.

mod report;
mod spec_reader;
mod tree;

use mimique_stimulus::{SolvedTake, solve_inflated};
use wasm_bindgen::prelude::*;

use crate::tree::Tree;

#[cfg(target_arch = "wasm32")]
#[global_allocator]
static ALLOCATOR: rlsf::SmallGlobalTlsf = rlsf::SmallGlobalTlsf::new();

/// The weights of one clip.
#[wasm_bindgen]
#[derive(Debug)]
pub struct Solved {
    take: SolvedTake,
}

/// Solves the take pack with the operators pack, whose body is inflated already; `method` is a
/// `MethodSpec`, as the object that its JSON is. It is the browser that inflates, and reads and writes
/// JSON: our own ways would be a third of the module.
///
/// # Errors
/// Throws an `Error` whose message says place, what and remedy: a damaged pack, packs that do not
/// belong together, a method that is none or does not solve with these operators.
#[wasm_bindgen]
pub fn solve(operators: &[u8], take: &[u8], method: &JsValue) -> Result<Solved, JsError> {
    let spec = spec_reader::read_spec(&Tree::from(method)).map_err(|e| JsError::new(&e))?;
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

    /// Frames a second.
    pub fn rate_hz(&self) -> f64 {
        self.take.rate_hz
    }

    /// SHA-256 of the weights in double precision, hexadecimal.
    pub fn weights_hash(&self) -> String {
        self.take.weights_hash.clone()
    }

    /// `{"shapeNames": [...], "statistics": {...} or null, "warnings": [...]}`.
    pub fn report(&self) -> JsValue {
        JsValue::from(&report::report(&self.take))
    }
}
