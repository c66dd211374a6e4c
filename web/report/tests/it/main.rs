//! The integration tests of `mimique-web-report`, in one binary.

mod node_report;
