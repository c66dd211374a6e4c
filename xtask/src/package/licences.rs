//! The licences of what a package is made of: held against the list of `deny.toml`, and their texts gathered. The text
//! of a crate is the one that it brings along; of a crate that brings none, SPDX's, with the authors that it names.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::path::Path;

use anyhow::{Context, Result, anyhow, bail};
use spdx::{Expression, Licensee, ParseMode};

use super::dependencies::{Component, Components};
use crate::process::root;

/// How names of licence files begin, in capitals.
const FILES: [&str; 6] = ["LICENSE", "LICENCE", "COPYING", "COPYRIGHT", "NOTICE", "UNLICENSE"];

/// An expression as SPDX writes it: older crates write `MIT/Apache-2.0`.
pub fn canonical(expression: &str) -> Result<String> {
    let words = Expression::canonicalize(expression)
        .map_err(|error| anyhow!("licence {expression:?}: {error}"))?;
    let text = words.unwrap_or_else(|| expression.to_owned());
    parsed(&text)?;
    Ok(text)
}

/// The licences that `deny.toml` allows, in its order.
pub fn allowed() -> Result<Vec<Licensee>> {
    let rules = std::fs::read_to_string(root().join("deny.toml")).context("deny.toml")?;
    let list = rules.split_once("allow = [").and_then(|(_, rest)| rest.split_once("\n]"));
    let (list, _) = list.context("deny.toml: no list `allow = [`; write one")?;
    list.split('"')
        .skip(1)
        .step_by(2)
        .map(|name| {
            Licensee::parse(name).map_err(|error| anyhow!("deny.toml: allow: {name:?}: {error}"))
        })
        .collect()
}

/// Names, versions, licences and all texts, each once; an error names every component that may not be passed on.
pub fn texts(components: &Components) -> Result<String> {
    let allowed = allowed()?;
    let mut table = String::new();
    let mut texts: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    let mut refused = Vec::new();
    for component in components.values().filter(|component| !component.is_own) {
        let name = format!("{} {}", component.name, component.version);
        let expression = canonical(&component.licence).with_context(|| name.clone())?;
        writeln!(table, "{name}: {expression}")?;
        match of(component, &parsed(&expression)?, &allowed).with_context(|| name.clone())? {
            Some(own) => own.into_iter().for_each(|text| {
                texts.entry(text).or_default().insert(name.clone());
            }),
            None => refused.push(format!("{name}: {expression}")),
        }
    }
    if !refused.is_empty() {
        bail!(
            "deny.toml: allow: these licences are not allowed: {}; leave the dependency out, or allow it with a reason",
            refused.join("; ")
        );
    }
    let mut whole =
        format!("This package is made of the following, beside its own code.\n\n{table}");
    for (text, names) in &texts {
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        write!(whole, "\n{}\n{}:\n\n{}\n", "-".repeat(80), names.join(", "), text)?;
    }
    Ok(whole)
}

/// The texts of one component; none where its licence is not allowed.
fn of(
    component: &Component,
    expression: &Expression,
    allowed: &[Licensee],
) -> Result<Option<Vec<String>>> {
    let Ok(needed) = expression.minimized_requirements(allowed) else { return Ok(None) };
    let own = component.folder.as_deref().map(brought_along).transpose()?.unwrap_or_default();
    if !own.is_empty() {
        return Ok(Some(own));
    }
    let authors = match component.authors.as_slice() {
        [] => format!("The authors of {}", component.name),
        authors => authors.join(", "),
    };
    let standard = needed.iter().map(|licence| {
        let id = licence.license.id().with_context(|| format!("SPDX has no text of {licence}"))?;
        Ok(format!("Copyright (c) {authors}\n\n{}", tidy(id.text())))
    });
    standard.collect::<Result<Vec<String>>>().map(Some)
}

/// The licence files of a crate's folder.
fn brought_along(folder: &Path) -> Result<Vec<String>> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder).with_context(|| folder.display().to_string())? {
        let path = entry?.path();
        let name =
            path.file_name().map(|name| name.to_string_lossy().to_uppercase()).unwrap_or_default();
        if path.is_file() && FILES.iter().any(|file| name.starts_with(file)) {
            found.push(tidy(&String::from_utf8_lossy(&std::fs::read(&path)?)));
        }
    }
    found.sort();
    Ok(found)
}

/// One text whatever its line ends and its spaces at the end.
fn tidy(text: &str) -> String {
    let lines: Vec<&str> = text.lines().map(str::trim_end).collect();
    lines.join("\n").trim_matches('\n').to_owned()
}

fn parsed(expression: &str) -> Result<Expression> {
    Expression::parse_mode(expression, ParseMode::LAX)
        .map_err(|error| anyhow!("licence {expression:?}: {error}"))
}

#[cfg(test)]
mod tests {
    use super::super::dependencies::{self, PAGES, WASM, key};
    use super::*;

    fn component(name: &str, licence: &str) -> (String, Component) {
        let version = "1.0.0".to_owned();
        (
            key(name, "1.0.0"),
            Component {
                name: name.into(),
                version,
                licence: licence.into(),
                ..Component::default()
            },
        )
    }

    #[test]
    fn what_is_not_allowed_is_named() {
        let components = Components::from([
            component("good", "MIT/Apache-2.0"),
            component("strict", "GPL-3.0-only"),
            component("either", "GPL-3.0-only OR Zlib"),
        ]);
        let refused = texts(&components).unwrap_err().to_string();
        assert!(refused.contains("strict 1.0.0: GPL-3.0-only;"), "{refused}");
        assert!(!refused.contains("good") && !refused.contains("either"), "{refused}");
    }

    #[test]
    fn a_crate_without_a_file_gets_the_text_of_spdx() {
        let text = texts(&Components::from([component("a", "MIT/Apache-2.0")])).unwrap();
        assert!(text.contains("a 1.0.0: MIT OR Apache-2.0"), "{text}");
        assert!(
            text.contains("Copyright (c) The authors of a")
                && text.contains("Permission is hereby granted")
        );
        assert!(!text.contains("Apache License"), "one of two is enough: {text}");
    }

    #[test]
    fn everything_in_the_program_may_be_passed_on() {
        let roots: Vec<_> = PAGES
            .iter()
            .map(|name| (*name, WASM))
            .chain([("mimique", "x86_64-unknown-linux-musl")])
            .collect();
        let text = texts(&dependencies::of(&roots).unwrap()).unwrap();
        assert!(text.contains("serde 1.") && text.contains("ring 0."));
    }
}
