//! The JSON Schema of the study file, generated from the Rust types.

use serde_json::Value;

use crate::study_file::Study;

/// Where the schema lies, as the studies of `study-config` name it.
pub const SCHEMA_ADDRESS: &str = "./schema/study.schema.json";

/// The JSON Schema (2020-12) of the study file.
pub fn json_schema() -> Value {
    schemars::schema_for!(Study).to_value()
}
