//! The schema of `arena.json` that lies in `study-config` is that of the types.

use mimique_arena::arena_schema_text;
use mimique_test_support::study_folder;

/// `MIMIQUE_UPDATE_GOLDEN=1` writes it anew.
#[test]
fn the_schema_is_that_of_the_types() {
    let file = study_folder().join("schema/arena.schema.json");
    if std::env::var_os("MIMIQUE_UPDATE_GOLDEN").is_some() {
        std::fs::write(&file, arena_schema_text()).unwrap();
    }
    let there = std::fs::read_to_string(&file).unwrap_or_default();
    assert_eq!(there, arena_schema_text(), "write it anew with MIMIQUE_UPDATE_GOLDEN=1");
}
