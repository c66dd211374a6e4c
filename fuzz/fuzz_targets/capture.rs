#![no_main]
//! A fuzz target: what the recogniser takes for the format that `FUZZ_FORMAT` names (an identifier of
//! the table of formats; any of them where it is not set), through its reader.

use std::sync::LazyLock;

use libfuzzer_sys::Corpus;

#[path = "../../crates/mocap/tests/it/support/invariants.rs"]
mod invariants;

static FORMAT: LazyLock<Option<String>> = LazyLock::new(|| std::env::var("FUZZ_FORMAT").ok());

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| -> Corpus {
    match (mimique_mocap::recognise(bytes), FORMAT.as_deref()) {
        (Some(format), Some(asked)) if format.id != asked => return Corpus::Reject,
        (Some(_), _) => {}
        (None, _) => return Corpus::Reject,
    }
    invariants::read_anyhow(bytes);
    Corpus::Keep
});
