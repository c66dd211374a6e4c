//! The integration tests of `mimique-layout`, in one binary.

mod face;
mod judging;
mod methods;
mod motion;
mod sheet;
mod support;
