//! Dataverse's dataset (`POST /api/dataverses/{alias}/datasets`): its citation block, and its licence where installations
//! come with it.

use serde_json::{Value, json};

use crate::about::{About, SOFTWARE_VERSION};
use crate::author::{Author, Name};

/// The body that makes a dataset. `contact` is an electronic mail address, which Dataverse asks for; `subject` is one of
/// its own list.
pub fn dataverse_dataset(about: &About, contact: &str, subject: &str) -> Value {
    let authors: Vec<Value> = about.authors.iter().map(author).collect();
    let description = if about.description.is_empty() { &about.title } else { &about.description };
    let contact_name = about.authors.first().map(Author::sorted_name).unwrap_or_default();
    let keywords: Vec<Value> = (about.keywords.iter())
        .map(|word| json!({ "keywordValue": primitive("keywordValue", word) }))
        .collect();
    let fields = vec![
        primitive("title", &about.title),
        compound("author", authors),
        compound(
            "datasetContact",
            vec![json!({
                "datasetContactName": primitive("datasetContactName", &contact_name),
                "datasetContactEmail": primitive("datasetContactEmail", contact),
            })],
        ),
        compound(
            "dsDescription",
            vec![json!({
                "dsDescriptionValue": primitive("dsDescriptionValue", description),
            })],
        ),
        json!({
            "typeName": "subject",
            "typeClass": "controlledVocabulary",
            "multiple": true,
            "value": [subject],
        }),
        compound("keyword", keywords),
        compound(
            "software",
            vec![json!({
                "softwareName": primitive("softwareName", "Mimique"),
                "softwareVersion": primitive("softwareVersion", SOFTWARE_VERSION),
            })],
        ),
    ];
    let mut version = json!({
        "metadataBlocks": {
            "citation": { "displayName": "Citation Metadata", "fields": fields },
        },
    });
    match about.data_licence.dataverse {
        Some((name, uri)) => version["license"] = json!({ "name": name, "uri": uri }),
        // None of the licences that installations come with: then it is told as terms of use.
        None => {
            version["termsOfUse"] =
                format!("{} ({})", about.data_licence.name, about.data_licence.address).into();
        }
    }
    json!({ "datasetVersion": version })
}

fn author(author: &Author) -> Value {
    let mut entry = json!({ "authorName": primitive("authorName", &author.sorted_name()) });
    if let Some(affiliation) = &author.affiliation {
        entry["authorAffiliation"] = primitive("authorAffiliation", affiliation);
    }
    if let (Some(orcid), Name::Person { .. }) = (&author.orcid, &author.name) {
        entry["authorIdentifierScheme"] = json!({
            "typeName": "authorIdentifierScheme",
            "typeClass": "controlledVocabulary",
            "multiple": false,
            "value": "ORCID",
        });
        entry["authorIdentifier"] = primitive("authorIdentifier", orcid);
    }
    entry
}

fn primitive(name: &str, value: &str) -> Value {
    json!({ "typeName": name, "typeClass": "primitive", "multiple": false, "value": value })
}

fn compound(name: &str, values: Vec<Value>) -> Value {
    json!({ "typeName": name, "typeClass": "compound", "multiple": true, "value": values })
}
