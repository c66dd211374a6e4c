//! What a package is made of: every crate that `cargo metadata` finds under its roots for its targets, and what the
//! compiler adds.

use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;

use anyhow::{Context, Result, bail};
use serde_json::Value;

use crate::process::{cargo, output, root};

/// A crate of the workspace and the target that it is compiled for.
pub type Root = (&'static str, &'static str);

/// The crates of the pages, which the program has embedded.
pub const PAGES: [&str; 6] = [
    "mimique-app",
    "mimique-web-adaptive",
    "mimique-web-report",
    "mimique-web-solver",
    "mimique-web-stage",
    "mimique-web-studio",
];
/// The crates of the npm package.
pub const STAGE: [&str; 4] =
    ["mimique-web-adaptive", "mimique-web-solver", "mimique-web-stage", "mimique-web-studio"];
/// The target of the pages.
pub const WASM: &str = "wasm32-unknown-unknown";

/// One crate, or what the compiler adds.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Component {
    /// Its name.
    pub name: String,
    /// Its version.
    pub version: String,
    /// An SPDX expression, as the crate writes it.
    pub licence: String,
    /// Who wrote it, where the crate says so.
    pub authors: Vec<String>,
    /// Where its source is developed.
    pub repository: Option<String>,
    /// Its folder; of what the compiler adds there is none.
    pub folder: Option<PathBuf>,
    /// SHA-256 of its archive, as Cargo.lock has it.
    pub checksum: Option<String>,
    /// Whether it is a crate of this workspace.
    pub is_own: bool,
    /// The keys of what it depends on.
    pub depends: BTreeSet<String>,
}

/// Components by [`key`].
pub type Components = BTreeMap<String, Component>;

/// The package URL of a crate.
pub fn key(name: &str, version: &str) -> String {
    format!("pkg:cargo/{name}@{version}")
}

/// Everything under these roots that ends up in a program: dependencies of builds and tests do not.
pub fn of(roots: &[Root]) -> Result<Components> {
    let checksums =
        checksums(&std::fs::read_to_string(root().join("Cargo.lock")).context("Cargo.lock")?);
    let targets: BTreeSet<&str> = roots.iter().map(|(_, target)| *target).collect();
    let mut found = Components::new();
    for target in targets {
        let names = roots.iter().filter(|root| root.1 == target).map(|root| root.0);
        add(&mut found, &metadata(target)?, names, &checksums)?;
        add_of_compiler(&mut found, target)?;
    }
    Ok(found)
}

fn metadata(target: &str) -> Result<Value> {
    let ask = |offline: &[&str]| {
        let mut command = cargo();
        command.args([
            "metadata",
            "--format-version",
            "1",
            "--locked",
            "--filter-platform",
            target,
        ]);
        output(command.args(offline))
    };
    // A crate that nothing here compiles may not have been fetched yet.
    let text = ask(&["--offline"]).or_else(|| ask(&[]));
    let text = text.with_context(|| {
        format!("cargo metadata --locked --filter-platform {target} fails; run it")
    })?;
    Ok(serde_json::from_str(&text)?)
}

/// Walks the graph from the roots.
fn add<'n>(
    found: &mut Components,
    metadata: &Value,
    roots: impl Iterator<Item = &'n str>,
    checksums: &BTreeMap<String, String>,
) -> Result<()> {
    let list = |value: &'_ Value| value.as_array().cloned().unwrap_or_default();
    let text = |value: &Value| value.as_str().unwrap_or_default().to_owned();
    let packages: BTreeMap<String, Value> = list(&metadata["packages"])
        .into_iter()
        .map(|package| (text(&package["id"]), package))
        .collect();
    let nodes: BTreeMap<String, Value> = list(&metadata["resolve"]["nodes"])
        .into_iter()
        .map(|node| (text(&node["id"]), node))
        .collect();
    let key_of = |id: &str| {
        let package =
            packages.get(id).with_context(|| format!("cargo metadata: no package {id}"))?;
        anyhow::Ok(key(&text(&package["name"]), &text(&package["version"])))
    };
    let mut open = Vec::new();
    for name in roots {
        let own = packages
            .iter()
            .find(|(_, package)| package["name"] == name && package["source"].is_null());
        let Some((id, _)) = own else {
            bail!("cargo metadata: no crate of the workspace is called {name}")
        };
        open.push(id.clone());
    }
    let mut walked = BTreeSet::new();
    while let Some(id) = open.pop() {
        if !walked.insert(id.clone()) {
            continue;
        }
        let package = &packages[&id];
        let mut depends = BTreeSet::new();
        for dependency in list(&nodes[&id]["deps"]) {
            let is_normal =
                list(&dependency["dep_kinds"]).iter().any(|kind| kind["kind"].is_null());
            if is_normal {
                let other = text(&dependency["pkg"]);
                depends.insert(key_of(&other)?);
                open.push(other);
            }
        }
        let key = key_of(&id)?;
        let component = found.entry(key.clone()).or_insert_with(|| Component {
            name: text(&package["name"]),
            version: text(&package["version"]),
            licence: text(&package["license"]),
            authors: list(&package["authors"]).iter().map(text).collect(),
            repository: package["repository"].as_str().map(str::to_owned),
            folder: PathBuf::from(text(&package["manifest_path"])).parent().map(Into::into),
            checksum: checksums.get(&key).cloned(),
            is_own: package["source"].is_null(),
            depends: BTreeSet::new(),
        });
        component.depends.append(&mut depends);
    }
    Ok(())
}

/// The standard library, and on Linux the C library: no lock file names them.
fn add_of_compiler(found: &mut Components, target: &str) -> Result<()> {
    let version = output(std::process::Command::new("rustc").arg("-vV").current_dir(root()));
    let version =
        version.context("rustc -vV fails; install the toolchain of rust-toolchain.toml")?;
    let version = version
        .lines()
        .find_map(|line| line.strip_prefix("release: "))
        .context("rustc -vV: no release")?;
    let mut insert = |name: &str, version: &str, licence: &str, author: &str, repository: &str| {
        let component = Component {
            name: name.into(),
            version: version.into(),
            licence: licence.into(),
            authors: vec![author.into()],
            repository: Some(repository.into()),
            ..Component::default()
        };
        found.insert(format!("pkg:generic/{name}@{version}"), component);
    };
    let rust = "https://github.com/rust-lang/rust";
    insert("rust-std", version, "MIT OR Apache-2.0", "The Rust Project contributors", rust);
    if target.ends_with("-musl") {
        // The one that rustc 1.93 and later brings along.
        insert(
            "musl",
            "1.2.5",
            "MIT",
            "2005-2020 Rich Felker, et al.",
            "https://git.musl-libc.org/cgit/musl",
        );
    }
    Ok(())
}

/// The checksums of a lock file by [`key`].
fn checksums(lock: &str) -> BTreeMap<String, String> {
    let value = |line: &str, name: &str| {
        let text = line.strip_prefix(name)?.strip_prefix(" = \"")?.strip_suffix('"')?;
        Some(text.to_owned())
    };
    lock.split("[[package]]")
        .filter_map(|package| {
            let find = |name: &str| package.lines().find_map(|line| value(line, name));
            Some((key(&find("name")?, &find("version")?), find("checksum")?))
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_program_is_made_of_its_crates_and_of_those_of_the_pages() {
        let linux = "x86_64-unknown-linux-musl";
        let roots: Vec<Root> =
            PAGES.iter().map(|name| (*name, WASM)).chain([("mimique", linux)]).collect();
        let found = of(&roots).unwrap();
        let named = |name: &str| found.values().find(|component| component.name == name);
        for name in
            ["mimique", "mimique-server", "sqlx-sqlite", "wgpu", "web-sys", "rust-std", "musl"]
        {
            assert!(named(name).is_some(), "{name}");
        }
        // Tests and builds alone need these.
        for name in ["trycmd", "proptest", "xtask", "cc"] {
            assert!(named(name).is_none(), "{name}");
        }
        let serde = named("serde").unwrap();
        assert_eq!(serde.checksum.as_ref().map(String::len), Some(64));
        assert!(!serde.is_own && named("mimique-server").unwrap().is_own);
        assert!(
            found
                .values()
                .all(|component| component.depends.iter().all(|key| found.contains_key(key)))
        );
    }
}
