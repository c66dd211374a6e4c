//! The integration tests of `mimique-deposit`, in one binary.

mod planted;
