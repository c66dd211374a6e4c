//! What `deny.toml` says of licences, sources and unwanted crates, checked for every dependency of
//! this machine's build and of the wasm modules. `cargo deny check` says the same of every platform,
//! and of advisories, where cargo-deny is installed. And which of our own crates must not be built of which.

use std::collections::{BTreeMap, BTreeSet};
use std::process::Command;

use mimique_test_support::repository;
use serde_json::Value;
use toml::Table;

/// The words in quotes of the list that follows `start`.
fn listed(text: &str, start: &str) -> BTreeSet<String> {
    let at = text.find(start).unwrap_or_else(|| panic!("no {start} in deny.toml")) + start.len();
    let list = &text[at..];
    let end = list.find("\n]").or_else(|| list.find("]\n")).expect("the list's end");
    list[..end].split('"').skip(1).step_by(2).map(str::to_owned).collect()
}

/// Whether an SPDX expression can be met by these licences.
fn allowed(expression: &str, licences: &BTreeSet<String>) -> bool {
    // Older packages write MIT/Apache-2.0.
    let text = expression.replace('/', " OR ").replace('(', " ( ").replace(')', " ) ");
    let words: Vec<&str> = text.split_whitespace().collect();
    let (met, used) = either(&words, licences);
    assert_eq!(used, words.len(), "{expression}");
    met
}

fn either(words: &[&str], licences: &BTreeSet<String>) -> (bool, usize) {
    let (mut met, mut at) = both(words, licences);
    while words.get(at) == Some(&"OR") {
        let (other, used) = both(&words[at + 1..], licences);
        met |= other;
        at += used + 1;
    }
    (met, at)
}

fn both(words: &[&str], licences: &BTreeSet<String>) -> (bool, usize) {
    let (mut met, mut at) = one(words, licences);
    while words.get(at) == Some(&"AND") {
        let (other, used) = one(&words[at + 1..], licences);
        met &= other;
        at += used + 1;
    }
    (met, at)
}

fn one(words: &[&str], licences: &BTreeSet<String>) -> (bool, usize) {
    if words.first() == Some(&"(") {
        let (met, used) = either(&words[1..], licences);
        return (met, used + 2);
    }
    let name = words.first().copied().unwrap_or_default();
    if words.get(1) == Some(&"WITH") {
        return (licences.contains(&words[..3].join(" ")), 3);
    }
    (licences.contains(name), 1)
}

#[test]
fn expressions_are_read() {
    let licences = BTreeSet::from(["MIT".to_owned(), "A WITH B".to_owned()]);
    for (expression, expected) in [
        ("MIT", true),
        ("GPL-3.0", false),
        ("MIT OR GPL-3.0", true),
        ("GPL-3.0/MIT", true),
        ("MIT AND GPL-3.0", false),
        ("(MIT OR GPL-3.0) AND X", false),
        ("(MIT OR GPL-3.0) AND MIT", true),
        ("GPL-3.0 OR MIT AND X", false),
        ("A WITH B", true),
        ("A", false),
    ] {
        assert_eq!(allowed(expression, &licences), expected, "{expression}");
    }
}

/// What cargo says of every package of this machine's build and of the wasm modules.
fn metadata() -> Value {
    let rustc = Command::new("rustc").arg("-vV").output().expect("rustc");
    let version = String::from_utf8_lossy(&rustc.stdout).into_owned();
    let host = version.lines().find_map(|line| line.strip_prefix("host: ")).expect("the host");
    let read = |offline: &[&str]| {
        Command::new(env!("CARGO"))
            .args(["metadata", "--format-version", "1", "--locked"])
            .args(offline)
            .args(["--filter-platform", host, "--filter-platform", "wasm32-unknown-unknown"])
            .current_dir(repository())
            .output()
            .expect("cargo")
    };
    // A crate that nothing here compiles may not have been fetched yet.
    let mut output = read(&["--offline"]);
    if !output.status.success() {
        output = read(&[]);
    }
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).expect("JSON")
}

/// Our own crates that a crate is built of, itself among them; those of its tests are left out.
fn built_of(metadata: &Value, name: &str) -> BTreeSet<String> {
    let nodes = metadata["resolve"]["nodes"].as_array().expect("nodes");
    let packages = metadata["packages"].as_array().expect("packages");
    let named: BTreeMap<&str, &str> = (packages.iter())
        .filter_map(|package| Some((package["id"].as_str()?, package["name"].as_str()?)))
        .collect();
    let needs = |id: &str| -> Vec<&str> {
        let node = nodes.iter().find(|node| node["id"] == id).expect("a package of the build");
        let is_of_build = |kind: &Value| kind["kind"].is_null();
        let needed = node["deps"].as_array().expect("dependencies").iter();
        needed
            .filter(|dep| dep["dep_kinds"].as_array().expect("kinds").iter().any(is_of_build))
            .filter_map(|dep| dep["pkg"].as_str())
            .collect()
    };
    let first = named.iter().find(|(_, own)| **own == name);
    let mut open = vec![*first.unwrap_or_else(|| panic!("no crate {name}")).0];
    let mut found = BTreeSet::new();
    while let Some(id) = open.pop() {
        if named[id].starts_with("mimique-") && found.insert(named[id].to_owned()) {
            open.extend(needs(id));
        }
    }
    found
}

#[test]
fn no_crate_is_built_of_what_it_must_not_know() {
    let metadata = metadata();
    let all = |names: &[&str]| -> BTreeSet<String> {
        names.iter().map(|name| format!("mimique-{name}")).collect()
    };
    assert_eq!(built_of(&metadata, "mimique-locale"), all(&["locale"]));
    assert_eq!(built_of(&metadata, "mimique-report"), all(&["locale", "report"]));
    assert_eq!(built_of(&metadata, "mimique-figure-pdf"), all(&["figure-pdf", "locale", "report"]));
    assert!(built_of(&metadata, "mimique-server").contains("mimique-analysis"));
    for name in ["web-studio", "arena", "layout", "annotate"] {
        let own = built_of(&metadata, &format!("mimique-{name}"));
        for other in ["analysis", "session", "server"] {
            assert!(!own.contains(&format!("mimique-{other}")), "{name} is built of {other}");
        }
    }
}

#[test]
fn every_dependency_is_one_that_we_may_use() {
    let rules = std::fs::read_to_string(repository().join("deny.toml")).expect("deny.toml");
    let licences = listed(&rules, "allow = [");
    let banned = listed(&rules, "deny = [");
    assert!(licences.contains("MIT") && banned.contains("openssl"), "{licences:?} {banned:?}");
    let metadata = metadata();
    let packages = metadata["packages"].as_array().expect("packages");
    let mut seen = 0;
    let mut wrong = Vec::new();
    for package in packages {
        let name = package["name"].as_str().unwrap_or_default();
        // Our own have no source.
        let Some(source) = package["source"].as_str() else { continue };
        seen += 1;
        let licence = package["license"].as_str().unwrap_or_default();
        if licence.is_empty() || !allowed(licence, &licences) {
            wrong.push(format!("{name}: licence {licence:?}"));
        }
        if source != "registry+https://github.com/rust-lang/crates.io-index" {
            wrong.push(format!("{name}: from {source}"));
        }
        if banned.contains(name) {
            wrong.push(format!("{name}: banned"));
        }
    }
    assert!(seen > 100, "{seen} dependencies");
    assert!(wrong.is_empty(), "{wrong:#?}\nchange the dependency, or deny.toml with a reason");
}

/// The names of the dependencies that a manifest takes from the workspace's table, those of single targets included.
fn taken_from_workspace(manifest: &Table) -> BTreeSet<String> {
    let mut names = BTreeSet::new();
    for (key, value) in manifest {
        let Some(value) = value.as_table() else { continue };
        if matches!(key.as_str(), "dependencies" | "dev-dependencies" | "build-dependencies") {
            let inherited = |spec: &toml::Value| {
                spec.get("workspace").and_then(toml::Value::as_bool).unwrap_or_default()
            };
            names.extend(value.iter().filter(|(_, spec)| inherited(spec)).map(|own| own.0.clone()));
        } else {
            names.extend(taken_from_workspace(value));
        }
    }
    names
}

/// The manifests of the workspace's members.
fn member_manifests(workspace: &Table) -> Vec<Table> {
    let members = workspace["workspace"]["members"].as_array().expect("members");
    let mut folders = Vec::new();
    for member in members.iter().filter_map(toml::Value::as_str) {
        match member.strip_suffix("/*") {
            Some(parent) => {
                let entries = std::fs::read_dir(repository().join(parent)).expect(parent);
                folders.extend(entries.map(|entry| entry.expect(parent).path()));
            }
            None => folders.push(repository().join(member)),
        }
    }
    let texts =
        folders.iter().filter_map(|dir| std::fs::read_to_string(dir.join("Cargo.toml")).ok());
    texts.map(|text| text.parse().expect("a manifest")).collect()
}

#[test]
fn dependencies_of_all_kinds_and_targets_are_found() {
    let manifest = r#"
        [dependencies]
        a.workspace = true
        b = "1"
        c = { workspace = true, optional = true }
        [dev-dependencies]
        d.workspace = true
        [target.'cfg(unix)'.dependencies]
        e = { workspace = true, features = ["f"] }
        [lints]
        workspace = true
    "#;
    let found = taken_from_workspace(&manifest.parse().expect("a manifest"));
    assert_eq!(found, BTreeSet::from(["a", "c", "d", "e"].map(str::to_owned)));
}

#[test]
fn every_dependency_of_the_workspace_has_a_user() {
    let text = std::fs::read_to_string(repository().join("Cargo.toml")).expect("Cargo.toml");
    let workspace: Table = text.parse().expect("a manifest");
    let listed = workspace["workspace"]["dependencies"].as_table().expect("dependencies");
    let manifests = member_manifests(&workspace);
    assert!(manifests.len() > 30 && listed.len() > 50, "{} {}", manifests.len(), listed.len());
    let used: BTreeSet<String> = manifests.iter().flat_map(taken_from_workspace).collect();
    let unused: Vec<&String> = listed.keys().filter(|name| !used.contains(*name)).collect();
    assert!(unused.is_empty(), "{unused:?}: remove them from [workspace.dependencies]");
}
