//! `ro-crate-preview.html`: the deposit as a page that needs no network.

use maud::{DOCTYPE, Markup, PreEscaped, html};

use crate::about::About;
use crate::described::{FOLDERS, words};
use crate::file::DepositFile;

/// Readable on a phone, in the dark, and on paper.
const STYLE: &str = "
:root { color-scheme: light dark; --line: #ccc; --soft: #555; }
@media (prefers-color-scheme: dark) { :root { --line: #555; --soft: #b5b5b5; } }
body { font: 1rem/1.5 system-ui, sans-serif; max-width: 52rem; margin: 0 auto; padding: 1.5rem 1rem 4rem; }
h1 { font-size: 1.6rem; line-height: 1.25; }
h2 { font-size: 1.15rem; margin: 2rem 0 .25rem; }
dd { margin: 0; overflow-wrap: anywhere; }
dl { display: grid; grid-template-columns: max-content 1fr; gap: .25rem 1rem; }
@media (max-width: 36rem) { dl { display: block; } dd { margin-bottom: .5rem; } }
dt { color: var(--soft); }
p.about { color: var(--soft); margin: 0 0 .5rem; }
details { border-top: 1px solid var(--line); padding: .5rem 0; }
summary { cursor: pointer; }
li { overflow-wrap: anywhere; margin: .2rem 0; }
li small { color: var(--soft); }
ul { padding-left: 1.2rem; }
";

/// Most files of a folder that are shown without being asked for.
const FEW: usize = 12;

/// The page.
pub(crate) fn preview(about: &About, files: &[DepositFile]) -> String {
    let of = |folder: &str| -> Vec<&DepositFile> {
        let begin = format!("{folder}/");
        files.iter().filter(|file| file.path.starts_with(&begin)).collect()
    };
    let top: Vec<&DepositFile> = files.iter().filter(|file| !file.path.contains('/')).collect();
    let page = html! {
        (DOCTYPE)
        html lang=(about.language) {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                title { (about.title) }
                style { (PreEscaped(STYLE)) }
            }
            body {
                main {
                    h1 { (about.title) }
                    p { (about.description) }
                    (facts(about))
                    ul { @for file in &top { (item(file)) } }
                    @for (folder, words) in FOLDERS {
                        (section(folder, words, &of(folder)))
                    }
                }
            }
        }
    };
    page.into_string()
}

fn facts(about: &About) -> Markup {
    html! {
        dl lang="en" {
            dt { "Authors" }
            dd {
                @for (place, author) in about.authors.iter().enumerate() {
                    @if place > 0 { ", " }
                    @match author.orcid_address() {
                        Some(address) => a href=(address) { (author.said_name()) },
                        None => (author.said_name()),
                    }
                }
            }
            dt { "Answers" }
            dd { (about.participants) " participants, " (about.rows) " rows" }
            dt { "Version" }
            dd { (about.version) ", deposited " (about.date) }
            dt { "Licence of the data" }
            dd { a href=(about.data_licence.address) { (about.data_licence.name) } }
            dt { "Licence of study file and scripts" }
            dd { a href=(about.code_licence.address) { (about.code_licence.name) } }
        }
    }
}

fn section(folder: &str, words: &str, files: &[&DepositFile]) -> Markup {
    let bytes: u64 = files.iter().map(|file| file.bytes).sum();
    let count = mimique_locale::counted(files.len(), "file");
    html! {
        section lang="en" {
            h2 { (folder) }
            p.about { (words) }
            details open[files.len() <= FEW] {
                summary { (count) ", " (size(bytes)) }
                ul { @for file in files { (item(file)) } }
            }
        }
    }
}

fn item(file: &DepositFile) -> Markup {
    html! {
        li lang="en" {
            a href=(crate::ro_crate::encoded(&file.path)) { (file.path) }
            " " small {
                (size(file.bytes))
                @if let Some(words) = words(&file.path) { " · " (words) }
            }
        }
    }
}

/// A size for people.
fn size(bytes: u64) -> String {
    match bytes {
        0..1_000 => mimique_locale::counted(bytes as usize, "byte"),
        1_000..1_000_000 => format!("{:.1} KB", bytes as f64 / 1e3),
        _ => format!("{:.1} MB", bytes as f64 / 1e6),
    }
}
