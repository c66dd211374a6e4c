//! The bits of the whole way are kept, and the module that a browser loads gives the same.
//!
//! The second needs node and the module built by `cargo xtask web --only bits` (in
//! `target/web-modules`).

use std::path::PathBuf;
use std::process::Command;

use mimique_test_support::repository;

use crate::support::bits;

fn kept() -> PathBuf {
    repository().join("crates/exertion/tests/golden/bits.txt")
}

/// `MIMIQUE_UPDATE_GOLDEN=1` keeps them anew.
#[test]
fn bits_are_those_that_are_kept() {
    let lines = bits::lines();
    if std::env::var_os("MIMIQUE_UPDATE_GOLDEN").is_some() {
        std::fs::write(kept(), &lines).unwrap();
    }
    let kept = std::fs::read_to_string(kept()).unwrap();
    for (own, kept) in lines.lines().zip(kept.lines()) {
        assert_eq!(own, kept);
    }
    assert_eq!(lines.lines().count(), kept.lines().count());
    assert!(kept.lines().count() > 35 && !kept.contains("NaN"));
}

#[test]
fn the_browser_s_module_gives_the_same_bits() {
    let target = std::env::var_os("CARGO_TARGET_DIR")
        .map_or_else(|| repository().join("target"), PathBuf::from);
    let module = target.join("web-modules/bits");
    let node = Command::new("node").arg("--version").output().is_ok_and(|o| o.status.success());
    let missing = match (node, module.join("bits_bg.wasm").is_file()) {
        (true, true) => None,
        (false, _) => Some("node is not installed".to_owned()),
        (true, false) => Some(format!("no module in {}; run cargo xtask web", module.display())),
    };
    if let Some(missing) = missing {
        let test = "the_browser_s_module_gives_the_same_bits";
        assert!(std::env::var_os("MIMIQUE_NO_SKIP").is_none_or(|v| v != "1"), "{test}: {missing}");
        eprintln!("SKIPPED {test}: {missing}");
        return;
    }
    let output = Command::new("node")
        .arg(repository().join("tests/wasm/exertion_bits.mjs"))
        .args([&module, &kept()])
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stdout);
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "run cargo xtask web if it is old\n{said}{errors}");
}
