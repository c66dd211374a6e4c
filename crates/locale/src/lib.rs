//! What depends on the language of a reader alone: which language it is, plurals, and numbers as people read them.
//!
//! ```
//! use mimique_locale::{Language, counted};
//!
//! let language = Language::from_code("fr-BE").expect("a report can be in French");
//! assert_eq!(language.pick("yes", "oui"), "oui");
//! assert_eq!(language.fixed(0.5, 2), "0,50");
//! assert_eq!(counted(2, "error"), "2 errors");
//! ```

mod counted;
mod language;
mod numbers;

pub use counted::{counted, counted_as, counted_in_french};
pub use language::{Language, primary_language};
pub use numbers::{format_number, format_p};
