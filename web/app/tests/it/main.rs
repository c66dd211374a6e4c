//! The integration tests of `mimique-app`, in one binary.

mod nothing_lost;
