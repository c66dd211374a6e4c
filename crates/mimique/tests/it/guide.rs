//! The guide says what the binary prints: every `console` block of its pages is run, in the order of the
//! page, in a folder of its own that has the repository's study files and the guide's data.
//!
//! `TRYCMD=overwrite cargo nextest run --release -p mimique --test it guide::` writes what is printed into the
//! pages; look at the difference before you keep it. `[..]` stands for what differs from run to run.

use std::path::{Path, PathBuf};

use mimique_test_support::real_file;

use crate::support::copied;

/// What a page's commands may name, from the repository's root.
const THERE: [&str; 2] = ["study-config", "docs/guide/data"];

/// Public files that a page's commands may name, from the folder of the real data: they stand in the page's folder
/// `public`.
const PUBLIC: [&str; 3] =
    ["ict-facekit/ict-facekit.glb", "animface/JawMoCap.c3d", "animface/markers-ict-facekit.json"];

fn repository() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// The pages of `docs/guide` that have commands: name and text.
fn pages_with_commands() -> Vec<(String, String)> {
    let pages = std::fs::read_dir(repository().join("docs/guide")).unwrap();
    let read = pages.filter_map(|page| {
        let page = page.unwrap().path();
        let is_page = page.extension().is_some_and(|ending| ending == "md");
        let text = is_page.then(|| std::fs::read_to_string(&page).unwrap())?;
        Some((page.file_stem()?.to_string_lossy().into_owned(), text))
    });
    read.filter(|(_, text)| text.contains("```console")).collect()
}

#[test]
fn pages_say_what_is_printed() {
    let folder = tempfile::tempdir().unwrap();
    let mut pages = pages_with_commands();
    assert!(!pages.is_empty(), "docs/guide has no commands");
    pages
        .retain(|(name, text)| !text.contains("public/") || gets_public_files(name, folder.path()));
    for (name, text) in &pages {
        std::fs::write(folder.path().join(format!("{name}.md")), text).unwrap();
        for part in THERE {
            let there = folder.path().join(format!("{name}.in")).join(part);
            copied(&repository().join(part), &there);
        }
    }
    let outcome = std::panic::catch_unwind(|| {
        trycmd::TestCases::new()
            .register_bin("mimique", Path::new(env!("CARGO_BIN_EXE_mimique")))
            .env("COLUMNS", "100")
            .case(folder.path().join("*.md"))
            .run();
    });
    if std::env::var_os("TRYCMD").is_some_and(|mode| mode == "overwrite") {
        for (name, _) in &pages {
            let page = format!("{name}.md");
            std::fs::copy(folder.path().join(&page), repository().join("docs/guide").join(&page))
                .unwrap();
        }
    }
    if let Err(failure) = outcome {
        std::panic::resume_unwind(failure);
    }
}

/// Puts the public files into a page's folder; whether they are there to be put.
fn gets_public_files(name: &str, folder: &Path) -> bool {
    let there = folder.join(format!("{name}.in/public"));
    std::fs::create_dir_all(&there).unwrap();
    PUBLIC.iter().all(|file| {
        let found = real_file(&format!("docs/guide/{name}.md"), file);
        found.is_some_and(|from| {
            let to = there.join(from.file_name().unwrap());
            // Not as a copy, which could not be written where the original cannot.
            std::fs::write(&to, std::fs::read(&from).unwrap()).unwrap();
            true
        })
    })
}

/// Whether a quoted text is the path of a file from the repository's root.
fn is_path(quoted: &str) -> bool {
    let path = Path::new(quoted);
    let plain = quoted.chars().all(|c| c.is_ascii_alphanumeric() || "/_.-".contains(c));
    let top = quoted.split_once('/').is_some_and(|(top, _)| {
        top.starts_with(|c: char| c.is_ascii_alphabetic()) && repository().join(top).is_dir()
    });
    plain && top && !path.starts_with("target") && path.extension().is_some_and(|e| !e.is_empty())
}

/// Every link to a file and every quoted path, in the top pages and in everything in `docs`, leads somewhere.
#[test]
fn links_between_documents_lead_somewhere() {
    let mut pages = vec![];
    for top in ["README.md", "ARCHITECTURE.md", "CONTRIBUTING.md"] {
        pages.push(repository().join(top));
    }
    let mut folders = vec![repository().join("docs")];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|ending| ending == "md") {
                pages.push(path);
            }
        }
    }
    let mut lost = Vec::new();
    for page in pages {
        let text = std::fs::read_to_string(&page).unwrap();
        for path in text.split('`').skip(1).step_by(2).filter(|quoted| is_path(quoted)) {
            if !repository().join(path).exists() {
                lost.push(format!("{}: {path}", page.display()));
            }
        }
        for link in text.split("](").skip(1).filter_map(|rest| rest.split(')').next()) {
            let file = link.split('#').next().unwrap_or(link);
            let elsewhere = file.is_empty() || file.contains("://") || file.contains(' ');
            if !elsewhere && !page.parent().unwrap().join(file).exists() {
                lost.push(format!("{}: {link}", page.display()));
            }
        }
    }
    assert!(lost.is_empty(), "{lost:#?}");
}
