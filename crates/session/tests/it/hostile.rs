//! Hostile study files: no panic on any input; what the fuzzer keeps is replayed.

use std::path::{Path, PathBuf};

use crate::support::any_study::check_anyhow;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn files(folder: &Path, all: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap_or_else(|e| panic!("{}: {e}", folder.display())) {
        let path = entry.unwrap().path();
        if path.is_dir() { files(&path, all) } else { all.push(path) }
    }
}

/// `cargo +nightly fuzz run study_file fuzz/corpus/study_file study-config` finds more; what it finds
/// belongs into the first of these folders.
#[test]
fn the_corpus_of_the_fuzzer_is_replayed() {
    let mut all = Vec::new();
    files(&root().join("fuzz/corpus/study_file"), &mut all);
    assert!(all.len() >= 10, "{} files", all.len());
    files(&root().join("study-config"), &mut all);
    for file in &all {
        check_anyhow(&std::fs::read(file).unwrap());
    }
    assert!(all.len() >= 60, "{} files", all.len());
}

/// Every beginning of a good file, in steps that are no multiple of anything in it.
#[test]
fn a_file_that_is_cut_off_is_answered() {
    let text = std::fs::read(root().join("study-config/template.json")).unwrap();
    for end in (0..text.len()).step_by(97) {
        check_anyhow(&text[..end]);
    }
}
