//! The participant's pages: a thin interpreter of `mimique_study::flow`.
//!
//! In: the address (`/s/{study}/?…`), the server's JSON, the participant's acts. Out: events, first
//! into IndexedDB, then to the server. What is shown is decided in `mimique_study::flow::view`; the
//! canvas and the solver live in modules of their own (`static/stage-host.js`).
//!
//! ```text
//! start -> session (resume or begin) -> engine: Input -> update -> State + Effects
//!                                          ^                          |
//!                                          +--- pages, bridge, outbox <+
//! ```

pub mod address;
pub mod answer;
pub mod outbox;

#[cfg(target_arch = "wasm32")]
mod bridge;
#[cfg(target_arch = "wasm32")]
mod controls;
#[cfg(target_arch = "wasm32")]
mod dom;
#[cfg(target_arch = "wasm32")]
mod engine;
#[cfg(target_arch = "wasm32")]
mod json;
#[cfg(target_arch = "wasm32")]
mod memory;
#[cfg(target_arch = "wasm32")]
mod network;
#[cfg(target_arch = "wasm32")]
mod page;
#[cfg(target_arch = "wasm32")]
mod pages;
#[cfg(target_arch = "wasm32")]
mod screen;
#[cfg(target_arch = "wasm32")]
mod site;
#[cfg(target_arch = "wasm32")]
mod start;

#[cfg(target_arch = "wasm32")]
#[global_allocator]
static ALLOCATOR: rlsf::SmallGlobalTlsf = rlsf::SmallGlobalTlsf::new();
