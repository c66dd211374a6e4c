#![no_main]
//! A fuzz target: what the recogniser takes for this format, through its reader.

#[path = "../../crates/mocap/tests/support/invariants.rs"]
mod invariants;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| -> libfuzzer_sys::Corpus {
    if mimique_mocap::recognise(bytes) != Some(mimique_mocap::Format::ViconCsv) {
        return libfuzzer_sys::Corpus::Reject;
    }
    invariants::read_anyhow(bytes);
    libfuzzer_sys::Corpus::Keep
});
