//! Orders kept in the repository: they must never change, natively or in the browser, or an old study
//! could not be replayed. `MIMIQUE_UPDATE_GOLDEN=1` writes them anew; look at the difference before
//! you keep it. `tests/browser/order_bits.test.mjs` draws the same in WebAssembly.

use std::collections::BTreeSet;

use crate::support::golden::{NAMES, lines};

fn folder() -> String {
    format!("{}/tests/golden", env!("CARGO_MANIFEST_DIR"))
}

fn kept(name: &str) {
    let file = format!("{}/{name}.txt", folder());
    let lines = lines(name);
    if std::env::var_os("MIMIQUE_UPDATE_GOLDEN").is_some() {
        std::fs::write(&file, &lines).unwrap();
    }
    assert_eq!(lines, std::fs::read_to_string(&file).unwrap_or_default(), "{file}");
}

#[test]
fn constrained_random_order_of_the_demo() {
    kept("order");
}

#[test]
fn latin_squares() {
    kept("latin_square_even");
    kept("latin_square_odd");
}

#[test]
fn samples() {
    kept("samples");
    kept("samples_of_a_prime");
}

#[test]
fn nesting() {
    kept("nesting");
}

#[test]
fn squares_beside_squares_and_samples() {
    kept("several_squares");
}

#[test]
fn samples_under_constraints() {
    kept("samples_under_constraints");
}

#[test]
fn options() {
    kept("options");
}

#[test]
fn sides() {
    kept("sides");
}

#[test]
fn every_file_is_drawn_natively_and_in_the_browser() {
    let files: BTreeSet<String> = std::fs::read_dir(folder())
        .unwrap()
        .map(|entry| entry.unwrap().path().file_stem().unwrap().to_string_lossy().into_owned())
        .collect();
    assert_eq!(files, NAMES.iter().map(|name| (*name).to_owned()).collect());
}
