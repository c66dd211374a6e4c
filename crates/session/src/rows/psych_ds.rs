//! `dataset_description.json` of Psych-DS 1: what every column means.

use serde_json::{Map, Value, json};

use super::column::Table;
use mimique_study::columns::ColumnKind;
use mimique_study::{Multilingual as _, Study};

/// Where the tidy table of a study stands in the data set.
pub fn psych_ds_data_file(study_id: &str) -> String {
    format!("data/study-{}_data.csv", psych_ds_keyword(study_id))
}

/// Values of Psych-DS keywords are letters and digits.
pub fn psych_ds_keyword(study_id: &str) -> String {
    study_id.chars().filter(char::is_ascii_alphanumeric).collect()
}

/// The dataset description of an export: title, authors, and
/// `variableMeasured` for every column of the table.
pub fn psych_ds_description(study: &Study, table: &Table) -> Value {
    let language = study.default_language();
    let metadata = &study.study_metadata;
    let people = |names: &[String], kind: &str| -> Value {
        names.iter().map(|name| json!({ "@type": kind, "name": name })).collect()
    };
    let variables: Vec<Value> = table
        .columns
        .iter()
        .map(|column| {
            let mut variable = Map::new();
            variable.insert("@type".to_owned(), "PropertyValue".into());
            variable.insert("name".to_owned(), column.name.as_str().into());
            variable.insert("description".to_owned(), column.description.as_str().into());
            let kind = match column.kind {
                ColumnKind::Text | ColumnKind::Any => "string",
                ColumnKind::Integer => "integer",
                ColumnKind::Number => "number",
                ColumnKind::Boolean => "boolean",
                ColumnKind::Time => "datetime",
            };
            variable.insert("value".to_owned(), kind.into());
            if let Some(unit) = &column.unit {
                variable.insert("unitText".to_owned(), unit.as_str().into());
            }
            if !column.levels.is_empty() {
                let levels = column.levels.iter().map(|(value, meaning)| {
                    json!({ "@type": "PropertyValue", "value": value, "description": meaning })
                });
                variable.insert("valueReference".to_owned(), levels.collect());
            }
            Value::Object(variable)
        })
        .collect();
    json!({
        "@context": "https://schema.org/",
        "@type": "Dataset",
        "name": metadata.title.in_language(language),
        "description": metadata.description.in_language(language),
        "schemaVersion": "Psych-DS 1.0.0",
        "version": metadata.version,
        "identifier": study.id,
        "author": people(&metadata.authors, "Person"),
        "sourceOrganization": people(&metadata.organizations, "Organization"),
        "variableMeasured": variables,
    })
}
