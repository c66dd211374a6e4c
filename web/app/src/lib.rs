//! The participant's pages: a thin interpreter of `mimique_session::flow`.
//!
//! In: the address (`/s/{study}/?…`), the server's JSON, the participant's acts. Out: events, first
//! into IndexedDB, then to the server. What is shown is decided in `mimique_session::flow::view`; the
//! canvas and the solver live in modules of their own (`static/stage/host.js`).
//!
//! ```text
//! app: begin -> start (resume or begin) -> engine: Input -> update -> State + Effects
//!  ^    draw -> pages -> dom                        |                          |
//!  |            acts                                +-- service, event store, host
//!  +-------------+
//! ```
//!
//! Files know those below them alone: `app`, `pages` and `controls`, `engine`, `service` (`server` or
//! `site`), `event_store` and `requests`, `browser`; `dom` and `act` stand beside the engine.

pub mod address;
pub mod answer;
pub mod outbox;

#[cfg(target_arch = "wasm32")]
mod act;
#[cfg(target_arch = "wasm32")]
mod app;
#[cfg(target_arch = "wasm32")]
mod browser;
#[cfg(target_arch = "wasm32")]
mod client;
#[cfg(target_arch = "wasm32")]
mod controls;
#[cfg(target_arch = "wasm32")]
mod dom;
#[cfg(target_arch = "wasm32")]
mod engine;
#[cfg(target_arch = "wasm32")]
mod event_store;
#[cfg(target_arch = "wasm32")]
#[cfg(target_arch = "wasm32")]
mod pages;
#[cfg(target_arch = "wasm32")]
mod requests;
#[cfg(target_arch = "wasm32")]
mod server;
#[cfg(target_arch = "wasm32")]
mod service;
#[cfg(target_arch = "wasm32")]
mod site;
#[cfg(target_arch = "wasm32")]
mod start;

#[cfg(target_arch = "wasm32")]
#[global_allocator]
static ALLOCATOR: rlsf::SmallGlobalTlsf = rlsf::SmallGlobalTlsf::new();
