//! Hostile files of activities: no reader panics or gives an activity that is not whole; what fuzzing keeps
//! is replayed.

use std::path::{Path, PathBuf};

use mimique_mocap::{
    ActivityColumn, activity_formats, read_activity_bytes, recognise, recognise_activity,
};
use proptest::prelude::*;

use crate::support::activity_invariants::read_activity_anyhow;
use crate::support::activity_seeds::{checksum, written};

fn corpus() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz/corpus/activity")
}

#[test]
fn the_corpus_of_the_fuzzer_is_replayed() {
    let mut count = 0;
    for file in std::fs::read_dir(corpus()).unwrap() {
        read_activity_anyhow(&std::fs::read(file.unwrap().path()).unwrap());
        count += 1;
    }
    assert!(count >= written().len());
}

/// `MIMIQUE_UPDATE_GOLDEN=1` writes the samples anew.
#[test]
fn the_corpus_holds_what_is_written_and_every_format_is_recognised() {
    let seeds = written();
    for (name, bytes) in &seeds {
        let file = corpus().join(format!("seed-{name}"));
        if std::env::var_os("MIMIQUE_UPDATE_GOLDEN").is_some() {
            std::fs::create_dir_all(corpus()).unwrap();
            std::fs::write(&file, bytes).unwrap();
        }
        assert!(std::fs::read(&file).unwrap() == *bytes, "{}", file.display());
        let format = recognise_activity(bytes).unwrap_or_else(|| panic!("{name}: of no format"));
        assert!(name.starts_with(format.id), "{name}: taken for {format:?}");
        assert_eq!(recognise(bytes), None, "{name}: taken for a capture, too");
    }
    for format in activity_formats() {
        assert!(seeds.iter().any(|(name, _)| name.starts_with(format.id)), "{format:?}: no sample");
    }
}

#[test]
fn every_sample_is_read_whole() {
    for (name, bytes) in written() {
        let activity = read_activity_bytes(&bytes).unwrap_or_else(|e| panic!("{name}: {e}"));
        assert_eq!(activity.time_s, (0..24).map(f64::from).collect::<Vec<_>>(), "{name}");
        if let Some(heart) = activity.column(ActivityColumn::HeartRate) {
            let seen = heart.iter().enumerate().filter(|(_, rate)| !rate.is_nan());
            assert!(seen.clone().count() > 15, "{name}");
            for (i, rate) in seen {
                assert_eq!(*rate, (90 + i) as f64, "{name}");
            }
        }
    }
}

/// The samples, and those of FIT without a checksum to hold damage back.
fn seeds() -> Vec<(bool, Vec<u8>)> {
    written().into_iter().map(|(name, bytes)| (name.starts_with("fit"), bytes)).collect()
}

/// Reads damaged bytes; of FIT also with a checksum that fits, so that the damage gets in.
fn read_damaged(is_fit: bool, bytes: &[u8]) {
    read_activity_anyhow(bytes);
    if !is_fit || bytes.len() < 16 {
        return;
    }
    let mut bytes = bytes.to_vec();
    let end = bytes.len() - 2;
    let size = (end as u32).saturating_sub(u32::from(bytes[0]));
    bytes[4..8].copy_from_slice(&size.to_le_bytes());
    let whole = checksum(&bytes[..end]);
    bytes[end..].copy_from_slice(&whole.to_le_bytes());
    read_activity_anyhow(&bytes);
}

#[test]
fn files_cut_at_every_byte() {
    for (is_fit, seed) in seeds() {
        for end in 0..seed.len().min(2500) {
            read_damaged(is_fit, &seed[..end]);
        }
    }
}

#[test]
fn every_byte_changed() {
    for (is_fit, seed) in seeds() {
        let mut bytes = seed.clone();
        for at in 0..seed.len().min(700) {
            for value in [0, 1, 0x7f, 0x80, 0xff, b',', b'<', b'9', b'\n', b'-', b'e'] {
                bytes[at] = value;
                read_damaged(is_fit, &bytes);
            }
            bytes[at] = seed[at];
        }
    }
}

#[test]
fn elements_in_each_other_without_end_are_refused() {
    let deep = format!("<gpx>{}", "<a>".repeat(100_000));
    let said = read_activity_bytes(deep.as_bytes()).unwrap_err().to_string();
    assert!(said.contains("more than 64 elements in each other"), "{said}");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 3000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn flipped_spliced_and_repeated_bytes(
        seed in 0_usize..64,
        flips in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 0..12),
        piece in any::<(prop::sample::Index, prop::sample::Index, prop::sample::Index)>(),
        spliced in any::<bool>(),
        cut in any::<prop::sample::Index>(),
        whole in any::<bool>(),
    ) {
        let seeds = seeds();
        let (is_fit, mut bytes) = seeds[seed % seeds.len()].clone();
        for (at, value) in flips {
            let at = at.index(bytes.len());
            bytes[at] = value;
        }
        if spliced {
            let (a, b) = (piece.0.index(bytes.len()), piece.1.index(bytes.len()));
            let part = bytes[a.min(b)..a.max(b)].to_vec();
            let at = piece.2.index(bytes.len());
            bytes.splice(at..at, part);
        }
        if !whole {
            bytes.truncate(cut.index(bytes.len() + 1));
        }
        read_damaged(is_fit, &bytes);
    }
}
