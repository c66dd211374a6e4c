//! Curves of exertion learnt from people: support vector regression from a body's state to a face's
//! weights (Boukhalfi 2012, 3.3.2).
//!
//! The solver is linfa's; its answers are held against the optimality conditions here. It runs natively
//! alone: what foretells is [`mimique_exertion::SupportVectors`], the same in the browser.

pub mod cross_validation;
mod error;
mod regression;

pub use error::TrainingError;
pub use regression::{EpsilonSvr, Fitted, ROWS};
