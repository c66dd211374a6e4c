//! The studies that were uploaded since the server started, and how far preparing them is.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex};

use mimique_study::Issue;

/// Where preparing a study stands.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Preparing {
    /// So many clips of so many are ready.
    Under { done: usize, of: usize },
    /// It is hosted; what should be said of its stimuli.
    Ready { warnings: Vec<String> },
    /// Its stimuli cannot be prepared.
    Failed { problem: String },
}

/// A study that was uploaded since the server started.
#[derive(Debug, Clone)]
pub(crate) struct Preparation {
    pub state: Preparing,
    /// What the check found: warnings.
    pub issues: Vec<Issue>,
}

/// The studies that were uploaded since the server started, by identifier.
pub(crate) type Preparations = Arc<Mutex<BTreeMap<String, Preparation>>>;
