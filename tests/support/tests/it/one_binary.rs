//! Each crate's integration tests are one binary, `tests/it/main.rs`: every further one would be linked with all
//! that the crate depends on.

use std::collections::BTreeSet;
use std::path::Path;
use std::process::Command;

use mimique_test_support::repository;
use serde_json::Value;

/// The modules in the folder of a `main.rs`, as files or as folders with a `mod.rs`.
fn modules_in(folder: &Path) -> BTreeSet<String> {
    let mut names = BTreeSet::new();
    for entry in std::fs::read_dir(folder).expect("the folder of the tests") {
        let path = entry.expect("an entry of the folder").path();
        let is_file = path.extension().is_some_and(|ending| ending == "rs");
        if is_file || path.join("mod.rs").is_file() {
            names.insert(path.file_stem().expect("a name").to_string_lossy().into_owned());
        }
    }
    names.remove("main");
    names
}

/// The modules that a `main.rs` declares.
fn declared_in(text: &str) -> BTreeSet<String> {
    text.lines()
        .filter_map(|line| line.strip_prefix("mod ")?.strip_suffix(';'))
        .map(str::to_owned)
        .collect()
}

#[test]
fn each_crate_has_one_integration_binary_with_all_its_modules() {
    let output = Command::new(env!("CARGO"))
        .args(["metadata", "--format-version", "1", "--locked", "--offline", "--no-deps"])
        .current_dir(repository())
        .output()
        .expect("cargo");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let metadata: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let mut crates = 0;
    let mut wrong = Vec::new();
    for package in metadata["packages"].as_array().expect("packages") {
        let tests: Vec<&Path> = package["targets"]
            .as_array()
            .expect("targets")
            .iter()
            .filter(|target| target["kind"][0] == "test")
            .map(|target| Path::new(target["src_path"].as_str().expect("a path")))
            .collect();
        for other in tests.iter().filter(|path| !path.ends_with("tests/it/main.rs")) {
            wrong.push(format!(
                "{}: a second binary; make it a module of tests/it",
                other.display()
            ));
        }
        let Some(main) = tests.iter().find(|path| path.ends_with("tests/it/main.rs")) else {
            continue;
        };
        crates += 1;
        let declared = declared_in(&std::fs::read_to_string(main).expect("the main.rs"));
        for name in modules_in(main.parent().expect("a folder")).difference(&declared) {
            wrong.push(format!("{}: no mod {name};, so its tests never run", main.display()));
        }
    }
    assert!(crates > 20, "{crates} crates with integration tests");
    assert!(wrong.is_empty(), "{wrong:#?}");
}
