//! Zenodo's metadata of a deposition (`PUT /api/deposit/depositions/{id}`).

use serde_json::{Value, json};

use crate::about::{About, SOFTWARE_REPOSITORY, SOFTWARE_VERSION};
use crate::author::Author;

/// The body that gives a deposition its metadata.
pub fn zenodo_metadata(about: &About) -> Value {
    let creator = |author: &Author| {
        let mut creator = json!({ "name": author.sorted_name() });
        if let Some(orcid) = &author.orcid {
            creator["orcid"] = orcid.as_str().into();
        }
        if let Some(affiliation) = &author.affiliation {
            creator["affiliation"] = affiliation.as_str().into();
        }
        creator
    };
    json!({
        "metadata": {
            "upload_type": "dataset",
            "title": about.title,
            "description": paragraph(about),
            "creators": about.authors.iter().map(creator).collect::<Vec<_>>(),
            "keywords": about.keywords,
            "version": about.version,
            "publication_date": about.date,
            "access_right": "open",
            "license": about.data_licence.spdx.to_lowercase(),
            "notes": format!(
                "Made with Mimique {SOFTWARE_VERSION} ({SOFTWARE_REPOSITORY}). Study file and scripts: {}.",
                about.code_licence.spdx
            ),
        },
    })
}

/// The description as HTML, which Zenodo takes.
fn paragraph(about: &About) -> String {
    let description = if about.description.is_empty() { &about.title } else { &about.description };
    maud::html! {
        p { (description) }
        p { (about.participants) " participants, " (about.rows) " rows of answers." }
    }
    .into_string()
}
