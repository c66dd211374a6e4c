//! The answers as a Psych-DS data set, whose data dictionary has every column that is left and none that is not.

use mimique_session::rows::{Column, Table, psych_ds_data_file, psych_ds_description};
use mimique_study::Study;
use serde_json::{Value, json};

use crate::about::About;
use crate::file::{DepositFile, NotWritten, json_bytes};
use crate::responses::Responses;

/// Its folder in the deposit.
pub const FOLDER: &str = "psych-ds";

/// Where the table of answers stands in the deposit.
pub fn data_file(study_id: &str) -> String {
    format!("{FOLDER}/{}", psych_ds_data_file(study_id))
}

/// The files of the data set.
pub(crate) fn files(
    about: &About,
    study: &Study,
    responses: &Responses,
    columns: &[Column],
) -> Result<Vec<DepositFile>, NotWritten> {
    let table = Table { columns: columns.to_vec(), rows: Vec::new() };
    let mut description = psych_ds_description(study, &table);
    description["name"] = about.title.as_str().into();
    description["description"] = about.description.as_str().into();
    description["license"] = about.data_licence.address.into();
    description["datePublished"] = about.date.as_str().into();
    description["keywords"] = about.keywords.as_slice().into();
    description["author"] = about.authors.iter().map(author).collect();
    let file = |name: &str| format!("{FOLDER}/{name}");
    Ok(vec![
        DepositFile::made(data_file(&about.study), responses.to_csv()?),
        DepositFile::made(file("dataset_description.json"), json_bytes(&description)?),
        DepositFile::made(file("README.md"), readme(about, columns).into_bytes()),
    ])
}

fn author(author: &crate::Author) -> Value {
    let mut person = json!({ "@type": "Person", "name": author.said_name() });
    if let Some(address) = author.orcid_address() {
        person["@id"] = address.into();
    }
    person
}

fn readme(about: &About, columns: &[Column]) -> String {
    let mut text = format!(
        "# {}\n\n{} participants, {} rows; one row a participant x trial x response.\n\n\
         | column | unit | meaning |\n|---|---|---|\n",
        about.title, about.participants, about.rows
    );
    for column in columns {
        let unit = column.unit.as_deref().unwrap_or_default();
        let meaning = column.description.replace(['\n', '\r'], " ").replace('|', "\\|");
        text.push_str(&format!("| `{}` | {unit} | {meaning} |\n", column.name));
    }
    text
}
