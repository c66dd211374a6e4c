//! The integration tests of `mimique-web-solver`, in one binary.

mod node_bits;
