//! `CITATION.cff`: how the data set is cited, in the Citation File Format 1.2.0.

use crate::about::{About, SOFTWARE_REPOSITORY, SOFTWARE_VERSION};
use crate::author::{Author, Name};

/// The file.
pub(crate) fn citation(about: &About) -> String {
    let mut text = String::from("cff-version: 1.2.0\n");
    let mut line = |key: &str, value: &str| text.push_str(&format!("{key}: {value}\n"));
    line("message", &quoted("If you use these data, please cite them."));
    line("type", "dataset");
    line("title", &quoted(&about.title));
    if !about.description.is_empty() {
        line("abstract", &quoted(&about.description));
    }
    line("version", &quoted(&about.version));
    line("date-released", &quoted(&about.date));
    line("license", about.data_licence.spdx);
    line("authors", "");
    let text_of = |author: &Author| in_list(&fields(author));
    about.authors.iter().for_each(|author| text.push_str(&text_of(author)));
    text.push_str("keywords:\n");
    about.keywords.iter().for_each(|word| text.push_str(&format!("  - {}\n", quoted(word))));
    text.push_str(&format!(
        "references:\n  - type: software\n    title: Mimique\n    version: {}\n    repository-code: {}\n    authors:\n      - name: {}\n",
        quoted(SOFTWARE_VERSION),
        quoted(SOFTWARE_REPOSITORY),
        quoted("The Mimique maintainers"),
    ));
    text.replace("authors: \n", "authors:\n")
}

/// What is said of an author.
fn fields(author: &Author) -> Vec<(&'static str, String)> {
    let mut fields = match &author.name {
        Name::Person { family, given } => {
            vec![("family-names", family.clone()), ("given-names", given.clone())]
        }
        Name::Whole(name) => vec![("name", name.clone())],
    };
    fields.extend(author.orcid_address().map(|address| ("orcid", address)));
    // A group has no affiliation in the format.
    let is_person = matches!(author.name, Name::Person { .. });
    let affiliation = author.affiliation.clone().filter(|_| is_person);
    fields.extend(affiliation.map(|place| ("affiliation", place)));
    fields
}

fn in_list(fields: &[(&str, String)]) -> String {
    let line = |(place, (key, value)): (usize, &(&str, String))| {
        let begin = if place == 0 { "  - " } else { "    " };
        format!("{begin}{key}: {}\n", quoted(value))
    };
    fields.iter().enumerate().map(line).collect()
}

/// A text as YAML has it between quotes: as JSON has it.
fn quoted(text: &str) -> String {
    serde_json::Value::from(text).to_string()
}
