//! From marker displacements to blendshape weights: operators, energies, methods. f64, no I/O, no clock.

mod method_spec;

pub use method_spec::{Method, MethodSpec};
