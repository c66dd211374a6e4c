//! The integration tests of `mimique-solver`, in one binary.

mod baselines;
mod bits;
mod blends;
mod dependent_shapes;
mod front_end;
mod layout;
mod mesh_density;
mod methods;
mod operators;
mod parameters;
mod regression;
mod support;
mod surface;
