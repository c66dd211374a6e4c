//! The levels of adaptive blocks in the participant's browser: the answers so far in, the next level out. Studies
//! with such a block, or with one of reverse correlation, alone load this module.
//!
//! ```js
//! const levels = new Levels(JSON.stringify(request)); // what the session's effect ChooseLevel holds
//! levels.answer("left"); // or "yes": one answer after the other; undefined where there was none
//! JSON.parse(levels.next("limit/2"));                 // {type: "level_chosen", ...}
//! levels.ahead();                                     // ["joy3.lsts@alpha=0.4", ...], either of which may come next
//! ```
//!
//! And the faces of blocks of reverse correlation:
//!
//! ```js
//! const face = new Face(JSON.stringify({ ...source.face, units: source.units }));
//! face.weights(); // Float32Array, frames x shapes
//! ```
//!
//! And the pairs of active schedules:
//!
//! ```js
//! JSON.parse(nextPairs(JSON.stringify(request))); // {type: "pairs_drawn", ...}
//! ```
//!
//! It is the same [`mimique_study::ClosedLoop`] that exports replay, so that the levels have the same bits.

use mimique_study::{
    AdaptiveComponent, ClosedLoop, Draw, DrawnFace, PairRequest, ReverseCorrelationComponent,
    UnitShapes,
};
use serde::Deserialize;
use serde_json::{Value, json};
use wasm_bindgen::prelude::*;

#[cfg(target_arch = "wasm32")]
#[global_allocator]
static ALLOCATOR: rlsf::SmallGlobalTlsf = rlsf::SmallGlobalTlsf::new();

/// The module's entry.
#[wasm_bindgen(start)]
pub fn start() {
    mimique_web_panics::report_panics("adaptive", "");
}

/// A block and whose draw it is.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct Request {
    component: String,
    block: AdaptiveComponent,
    seed: u64,
    config_hash: String,
    slot: u64,
}

/// The levels of one block.
#[wasm_bindgen]
#[derive(Debug)]
pub struct Levels {
    closed_loop: ClosedLoop,
    /// The block after the difference was not seen and after it was, once they were looked at: the next level is known
    /// when it is asked for.
    after: Option<[ClosedLoop; 2]>,
}

#[wasm_bindgen]
impl Levels {
    /// A block before its first answer; `request` is what the session's effect `ChooseLevel` holds, as JSON.
    ///
    /// # Errors
    /// Throws an `Error` whose message says what is wrong with the block; the check of a study refuses it.
    #[wasm_bindgen(constructor)]
    pub fn new(request: &str) -> Result<Levels, JsError> {
        let Request { component, block, seed, config_hash, slot } = serde_json::from_str(request)?;
        let draw = Draw { seed, config_hash: &config_hash, participant: slot, condition: None };
        Ok(Self { closed_loop: ClosedLoop::new(block, &component, draw)?, after: None })
    }

    /// Takes in the answer of the next trial: `left`, `right`, an option of a yes-no question, or nothing.
    pub fn answer(&mut self, answer: Option<String>) {
        let seen = answer.as_deref().and_then(|answer| self.closed_loop.seen(answer));
        match (seen, self.after.take()) {
            (Some(seen), Some([not_seen, is_seen])) => {
                self.closed_loop = if seen { is_seen } else { not_seen };
            }
            _ => self.closed_loop.answer(answer.as_deref()),
        }
    }

    /// The event of the trial of a step, as JSON.
    pub fn next(&self, step: &str) -> String {
        let Some(chosen) = self.closed_loop.next() else {
            return json!({ "type": "levels_over", "step": step }).to_string();
        };
        let mut event = serde_json::to_value(chosen).unwrap_or_default();
        event["type"] = Value::from("level_chosen");
        event["step"] = Value::from(step);
        event.to_string()
    }

    /// The clips that may come after either answer; the level that comes then is known when it is asked for.
    pub fn ahead(&mut self) -> Vec<String> {
        let closed_loop = &self.closed_loop;
        let after =
            self.after.get_or_insert_with(|| [false, true].map(|seen| closed_loop.after(seen)));
        after.iter().flat_map(ClosedLoop::clips).collect()
    }
}

/// A trial of reverse correlation, whose draw it is, and how the avatar shows the units.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct FaceRequest {
    step: String,
    block: ReverseCorrelationComponent,
    seed: u64,
    config_hash: String,
    slot: u64,
    units: UnitShapes,
}

/// The face of one trial of reverse correlation.
#[wasm_bindgen]
#[derive(Debug)]
pub struct Face(DrawnFace);

#[wasm_bindgen]
impl Face {
    /// Draws it; `request`: what the session's `Plan::face` holds, and `units` of the clip at rest, as JSON.
    ///
    /// # Errors
    /// Throws an `Error` whose message says what is wrong with the block; the check of a study refuses it.
    #[wasm_bindgen(constructor)]
    pub fn new(request: &str) -> Result<Face, JsError> {
        let FaceRequest { step, block, seed, config_hash, slot, units } =
            serde_json::from_str(request)?;
        let draw = Draw { seed, config_hash: &config_hash, participant: slot, condition: None };
        let shown = block.trajectories(&step, draw)?;
        Ok(Self(block.face(&shown, &units)))
    }

    /// Weights, frames x shapes.
    pub fn weights(&self) -> Vec<f32> {
        self.0.weights.iter().map(|&weight| weight as f32).collect()
    }

    /// Number of frames.
    pub fn frames(&self) -> usize {
        self.0.frames
    }

    /// Frames per second.
    pub fn rate_hz(&self) -> f64 {
        self.0.rate_hz
    }

    /// SHA-256 of the weights before they became 32-bit numbers.
    pub fn weights_hash(&self) -> String {
        self.0.weights_hash.clone()
    }
}

/// The event with the next batch of pairs of an active schedule, as JSON; `request`: [`PairRequest`] as JSON.
///
/// # Errors
/// Throws an `Error` whose message says what is wrong with the request.
#[wasm_bindgen(js_name = nextPairs)]
pub fn next_pairs(request: &str) -> Result<String, JsError> {
    let request: PairRequest = serde_json::from_str(request)?;
    let mut event = serde_json::to_value(request.draw()).unwrap_or_default();
    event["type"] = Value::from("pairs_drawn");
    event["step"] = Value::from(request.step.as_str());
    event["batch"] = Value::from(request.batch);
    Ok(event.to_string())
}
