//! The documentation's table of formats is the table of formats.

use std::path::Path;

use mimique_mocap::{activity_formats, formats};

fn table() -> String {
    let mut table = String::from("| format | recognised by | read |\n|---|---|---|\n");
    for format in formats() {
        table += &format!("| {} | {} | {} |\n", format.name, format.recognised_by, format.reads);
    }
    table
}

/// `MIMIQUE_UPDATE_GOLDEN=1` writes the table anew.
#[test]
fn the_guide_lists_every_format() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/guide/motion-capture.md");
    let guide = std::fs::read_to_string(&file).unwrap();
    if std::env::var_os("MIMIQUE_UPDATE_GOLDEN").is_some() {
        let start = guide.find("| format | recognised by |").unwrap();
        let length = guide[start..].find("\n\n").unwrap() + 1;
        let renewed = [&guide[..start], &table(), &guide[start + length..]].concat();
        std::fs::write(&file, renewed).unwrap();
        return;
    }
    assert!(guide.contains(&table()), "docs/guide/motion-capture.md lacks:\n{}", table());
}

#[test]
fn identifiers_and_names_are_each_of_one_format() {
    for (k, format) in formats().iter().enumerate() {
        for other in &formats()[..k] {
            assert!(format.id != other.id && format.name != other.name, "{format:?} {other:?}");
        }
        assert!(!format.extensions.is_empty());
    }
}

/// `MIMIQUE_UPDATE_GOLDEN=1` writes the table anew.
#[test]
fn the_guide_lists_every_format_of_activities() {
    let mut table = String::from("| activity | recognised by | read |\n|---|---|---|\n");
    for format in activity_formats() {
        table += &format!("| {} | {} | {} |\n", format.name, format.recognised_by, format.reads);
    }
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/guide/motion-capture.md");
    let guide = std::fs::read_to_string(&file).unwrap();
    if std::env::var_os("MIMIQUE_UPDATE_GOLDEN").is_some() {
        let start = guide.find("| activity | recognised by |").unwrap();
        let length = guide[start..].find("\n\n").unwrap() + 1;
        let renewed = [&guide[..start], &table, &guide[start + length..]].concat();
        std::fs::write(&file, renewed).unwrap();
        return;
    }
    assert!(guide.contains(&table), "docs/guide/motion-capture.md lacks:\n{table}");
}
