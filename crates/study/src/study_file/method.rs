//! A method of the study file: the solver's parameters with factors beside them.

use mimique_solver::{Method, MethodSpec, parameter_schemas};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Serialize};

use super::{Factors, LocalText};

/// A method, its parameters, and what the analysis calls it.
///
/// In JSON the solver's parameters, `factors`, `label` and `training` stand side by side:
/// `{"method": "lsts", "alpha": 0.3, "factors": {"shell": "thin"}}`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MethodEntry {
    /// Method and parameters.
    #[serde(flatten)]
    pub spec: MethodSpec,
    /// Factors of the clips made with it. `method` (its name) and `alpha` are always there.
    #[serde(default, skip_serializing_if = "Factors::is_empty")]
    pub factors: Factors,
    /// Name for people.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub label: Option<LocalText>,
    /// What `regression` learns from.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub training: Option<MethodTraining>,
}

/// A range-of-motion take with known weights.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct MethodTraining {
    /// Key of `stimuli.captures`: a file, or a built-in actor, who then shows the whole range of
    /// motion.
    pub capture: String,
    /// CSV of the weights played in it, a row a frame; a built-in actor brings them along.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub weights: Option<String>,
}

impl MethodEntry {
    /// The word of the method: `lsts-norm`.
    pub fn word(&self) -> String {
        self.spec.method.name().to_owned()
    }
}

impl JsonSchema for MethodEntry {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "Method".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let mut properties = parameter_schemas();
        let methods: Vec<&str> = Method::ALL.iter().map(|method| method.name()).collect();
        properties.insert(
            "method".to_owned(),
            serde_json::json!({ "type": "string", "enum": methods, "description": "The method" }),
        );
        properties.insert("factors".to_owned(), generator.subschema_for::<Factors>().into());
        properties.insert("label".to_owned(), generator.subschema_for::<LocalText>().into());
        properties
            .insert("training".to_owned(), generator.subschema_for::<MethodTraining>().into());
        json_schema!({
            "type": "object",
            "description": "A method, its parameters, and the factors of the clips made with it",
            "properties": properties,
            "required": ["method"],
            "additionalProperties": false,
        })
    }
}
