//! `ro-crate-metadata.json`: the deposit as an RO-Crate 1.1, flattened JSON-LD whose root lists every folder and file.

use std::collections::{BTreeMap, BTreeSet};

use serde_json::{Map, Value, json};

use crate::about::{About, SOFTWARE_REPOSITORY, SOFTWARE_VERSION};
use crate::author::{Author, Name};
use crate::described::{FOLDERS, METADATA, PREVIEW, REPORT, Under, media_type, under, words};
use crate::file::DepositFile;
use crate::licence::Licence;

/// What the crate conforms to.
const VERSION: &str = "https://w3id.org/ro/crate/1.1";
/// The entity of the software.
const SOFTWARE: &str = "#mimique";
/// The entity of the analysis that made the report.
const ANALYSIS: &str = "#analysis";

/// The metadata of these files; `later` are those whose hashes are not known yet, since they are made of these.
pub(crate) fn metadata(about: &About, files: &[DepositFile], later: &[&str]) -> Value {
    let mut entities = vec![json!({
        "@id": METADATA,
        "@type": "CreativeWork",
        "about": { "@id": "./" },
        "conformsTo": { "@id": VERSION },
    })];
    let mut paths: Vec<(&str, Option<&DepositFile>)> =
        files.iter().map(|file| (&*file.path, Some(file))).collect();
    paths.extend(later.iter().map(|path| (*path, None)));
    paths.sort_unstable_by_key(|(path, _)| *path);
    let parts = parts(paths.iter().map(|(path, _)| *path));
    entities.push(root(about, &parts));
    for (folder, within) in parts.iter().filter(|(folder, _)| !folder.is_empty()) {
        entities.push(folder_entity(folder, within));
    }
    for (path, file) in paths {
        entities.push(file_entity(about, path, file));
    }
    entities.extend(about.authors.iter().map(person));
    entities.extend(about.organizations.iter().map(
        |name| json!({ "@id": organization_id(name), "@type": "Organization", "name": name }),
    ));
    entities.push(software());
    entities.push(json!({
        "@id": ANALYSIS,
        "@type": "CreateAction",
        "name": "mimique analyze",
        "instrument": { "@id": SOFTWARE },
        "object": [
            { "@id": encoded(&crate::psych_ds::data_file(&about.study)) },
            { "@id": "study/study.json" },
        ],
        "result": { "@id": format!("{REPORT}/") },
    }));
    let mut licences = vec![about.data_licence];
    if about.code_licence.address != about.data_licence.address {
        licences.push(about.code_licence);
    }
    entities.extend(licences.into_iter().map(licence));
    json!({
        "@context": [format!("{VERSION}/context"), { "sha256": "https://schema.org/sha256" }],
        "@graph": entities,
    })
}

/// Each folder (the root's name is empty) and what lies in it, folders with `/` at their end.
fn parts<'p>(paths: impl Iterator<Item = &'p str>) -> BTreeMap<String, BTreeSet<String>> {
    let mut parts: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for path in paths {
        let mut inside = path.to_owned();
        loop {
            let trimmed = inside.trim_end_matches('/');
            let folder = trimmed.rfind('/').map_or("", |at| &trimmed[..=at]).to_owned();
            parts.entry(folder.clone()).or_default().insert(inside);
            if folder.is_empty() {
                break;
            }
            inside = folder;
        }
    }
    parts
}

fn root(about: &About, parts: &BTreeMap<String, BTreeSet<String>>) -> Value {
    let mut root = json!({
        "@id": "./",
        "@type": "Dataset",
        "name": about.title,
        "description": about.description,
        "identifier": about.study,
        "version": about.version,
        "datePublished": about.date,
        "inLanguage": about.language,
        "keywords": about.keywords.join(", "),
        "license": { "@id": about.data_licence.address },
        "author": about.authors.iter().map(|own| json!({ "@id": author_id(own) })).collect::<Vec<_>>(),
        "mentions": [{ "@id": SOFTWARE }, { "@id": ANALYSIS }],
        "hasPart": references(parts.get("").into_iter().flatten()),
    });
    if root["description"] == "" {
        root["description"] = about.title.as_str().into();
    }
    if !about.organizations.is_empty() {
        let all = about.organizations.iter();
        root["sourceOrganization"] =
            all.map(|name| json!({ "@id": organization_id(name) })).collect();
    }
    root
}

fn folder_entity(folder: &str, within: &BTreeSet<String>) -> Value {
    let name = folder.trim_end_matches('/');
    let mut entity = json!({
        "@id": encoded(folder),
        "@type": "Dataset",
        "name": name,
        "hasPart": references(within.iter()),
    });
    if let Some((_, about)) = FOLDERS.iter().find(|(own, _)| *own == name) {
        entity["description"] = (*about).into();
    }
    entity
}

fn file_entity(about: &About, path: &str, file: Option<&DepositFile>) -> Value {
    let mut entity = Map::new();
    let mut put = |key: &str, value: Value| drop(entity.insert(key.to_owned(), value));
    put("@id", encoded(path).into());
    // The page is about the crate as the metadata are.
    if path == PREVIEW {
        put("@type", "CreativeWork".into());
        put("about", json!({ "@id": "./" }));
    } else {
        put("@type", "File".into());
    }
    put("name", path.into());
    if let Some(words) = words(path) {
        put("description", words.into());
    }
    put("encodingFormat", media_type(path).into());
    let licence = match under(path) {
        Under::Data => Some(about.data_licence),
        Under::Code => Some(about.code_licence),
        Under::Software => None,
    };
    if let Some(licence) = licence {
        put("license", json!({ "@id": licence.address }));
    }
    if let Some(file) = file {
        put("contentSize", file.bytes.to_string().into());
        put("sha256", file.sha256.as_str().into());
    }
    Value::Object(entity)
}

fn references<'p>(paths: impl Iterator<Item = &'p String>) -> Vec<Value> {
    paths.map(|path| json!({ "@id": encoded(path) })).collect()
}

fn author_id(author: &Author) -> String {
    author
        .orcid_address()
        .unwrap_or_else(|| format!("#author-{}", encoded(&author.sorted_name().replace(' ', "-"))))
}

fn organization_id(name: &str) -> String {
    format!("#organization-{}", encoded(&name.replace(' ', "-")))
}

fn person(author: &Author) -> Value {
    let mut entity = json!({ "@id": author_id(author), "name": author.said_name() });
    match &author.name {
        Name::Person { family, given } => {
            entity["@type"] = "Person".into();
            entity["familyName"] = family.as_str().into();
            entity["givenName"] = given.as_str().into();
        }
        Name::Whole(_) => entity["@type"] = "Organization".into(),
    }
    if let Some(affiliation) = &author.affiliation {
        entity["affiliation"] = affiliation.as_str().into();
    }
    entity
}

fn software() -> Value {
    json!({
        "@id": SOFTWARE,
        "@type": "SoftwareApplication",
        "name": "Mimique",
        "version": SOFTWARE_VERSION,
        "url": SOFTWARE_REPOSITORY,
    })
}

fn licence(licence: &Licence) -> Value {
    json!({
        "@id": licence.address,
        "@type": "CreativeWork",
        "name": licence.name,
        "identifier": licence.spdx,
    })
}

/// A path as a reference of a URI: what may not stand in one is encoded.
pub(crate) fn encoded(path: &str) -> String {
    path.split('/').map(mimique_study::percent_encoded).collect::<Vec<_>>().join("/")
}
