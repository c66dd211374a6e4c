//! The parameters of the methods: one table, and all that follows from it.
//!
//! [`table`] has one row per parameter. From it follow the struct [`table::MethodSpec`] with its defaults,
//! its JSON ([`json`]), its JSON Schema ([`schema`]), what is wrong with it ([`check`], in the words of
//! [`problem`]), the options of `mimique solve` and the fields of the studio.

pub(crate) mod check;
pub(crate) mod choices;
pub(crate) mod group;
pub(crate) mod json;
pub(crate) mod kind;
mod patterns;
pub(crate) mod problem;
pub(crate) mod schema;
pub(crate) mod table;
pub(crate) mod value;
