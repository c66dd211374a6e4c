//! What the columns of an export mean: those of each version of the study, what the researcher decides, and what
//! else somebody keeps.

use std::collections::BTreeMap;

use mimique_session::rows::{Column, TidyForm, exclusion_columns};
use mimique_study::Study;
use mimique_study::columns::ColumnKind;

/// The columns that the exports of some versions of a study have, by name.
pub fn known_columns(versions: &[&Study]) -> BTreeMap<String, Column> {
    let mut known = BTreeMap::new();
    // The columns of a form do not depend on how its clips were prepared.
    let of = |study: &&Study| TidyForm::new(study, &BTreeMap::new()).columns().to_vec();
    for column in versions.iter().flat_map(of).chain(exclusion_columns()) {
        known.entry(column.name.clone()).or_insert(column);
    }
    known
}

/// The meaning of each of some columns, in their order. What no version of the study has is said to be so.
pub fn dictionary(known: &BTreeMap<String, Column>, names: &[String]) -> Vec<Column> {
    let meaning = |name: &String| known.get(name).cloned().unwrap_or_else(|| added(name));
    names.iter().map(meaning).collect()
}

fn added(name: &str) -> Column {
    Column {
        name: name.to_owned(),
        description: "Added to the export; no column of the study".to_owned(),
        kind: ColumnKind::Text,
        unit: None,
        levels: Vec::new(),
    }
}
