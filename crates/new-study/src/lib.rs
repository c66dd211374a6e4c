//! New studies: a design of the library, instruments and stimuli in; a study file that explains itself out. The command
//! `mimique new` and the studio make studies by it, each with stimuli of its own.
//!
//! ```
//! use mimique_new_study::{Design, Stimuli, Wishes, compose};
//! use serde_json::json;
//!
//! let parts = json!({
//!     "avatars": { "head": { "builtin": { "seed": 1 } } },
//!     "captures": { "actor": { "builtin": { "actor": 7 } } },
//!     "segments": [{ "id": "joy", "capture": "actor", "performance": { "expression": "joy", "intensity": 2 } }],
//! });
//! let stimuli = Stimuli {
//!     parts: parts.as_object().unwrap().clone(),
//!     expressions: vec![["joy", "Joy", "Joie"].map(str::to_owned)],
//! };
//! let wishes = Wishes {
//!     id: "mine".to_owned(),
//!     title: None,
//!     languages: vec!["en".to_owned()],
//!     methods: Default::default(),
//! };
//! let made = compose(&wishes, &Design::named("rate-one")?, &[], Some(&stimuli))?;
//! let study = mimique_study::parse(&made.text())?;
//! assert_eq!(study["stimuli"]["methods"]["lsts"]["method"], "lsts");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod compose;
mod library;
mod readme;
mod written;

pub use compose::{Composed, NotComposed, Stimuli, Wishes, compose, study_id};
pub use library::{
    Asked, Design, Elsewhere, Instrument, LibraryError, Parts, designs, elsewhere, instruments,
};
