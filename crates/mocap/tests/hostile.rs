//! Hostile files: no reader panics, asks for memory that the file does not warrant, or gives a
//! capture that is not whole; what fuzzing keeps is replayed.

#[path = "support/invariants.rs"]
mod invariants;
#[path = "support/seeds.rs"]
mod seeds;

use std::path::{Path, PathBuf};

use invariants::read_anyhow;
use mimique_mocap::{Format, recognise};
use proptest::prelude::*;
use seeds::seeds;

/// The folder of `fuzz/corpus` that a file of that format belongs in.
fn target(format: Format) -> &'static str {
    match format {
        Format::C3d => "c3d",
        Format::WideCsv => "wide_csv",
        Format::LongCsv => "long_csv",
        Format::Trc => "trc",
        Format::QtmTsv => "qtm_tsv",
        Format::MotiveCsv => "motive_csv",
        Format::ViconCsv => "vicon_csv",
        Format::Bvh => "bvh",
        Format::LiveLinkCsv => "live_link",
    }
}

fn corpus() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz/corpus")
}

/// Seeds and what fuzzing found are committed; each runs as it would in the fuzzer.
#[test]
fn the_corpus_of_the_fuzzer_is_replayed() {
    let mut formats = std::collections::BTreeSet::new();
    for folder in std::fs::read_dir(corpus()).unwrap().map(|e| e.unwrap().path()) {
        for file in std::fs::read_dir(&folder).unwrap().map(|e| e.unwrap().path()) {
            let bytes = std::fs::read(&file).unwrap();
            read_anyhow(&bytes);
            formats.extend(recognise(&bytes).map(target));
        }
    }
    assert_eq!(formats.len(), 9, "a seed of every format: {formats:?}");
}

/// `MIMIQUE_UPDATE_GOLDEN=1` writes the corpus anew from the seeds.
#[test]
fn the_corpus_holds_every_seed() {
    for (number, seed) in seeds().into_iter().enumerate() {
        let Some(format) = recognise(&seed) else { panic!("seed {number} is of no format") };
        let file = corpus().join(target(format)).join(format!("seed-{number:02}"));
        if std::env::var_os("MIMIQUE_UPDATE_GOLDEN").is_some() {
            std::fs::create_dir_all(file.parent().unwrap()).unwrap();
            std::fs::write(&file, &seed).unwrap();
        }
        assert!(std::fs::read(&file).unwrap() == seed, "{}", file.display());
    }
}

#[test]
fn every_seed_is_read_whole() {
    for seed in seeds() {
        read_anyhow(&seed);
    }
}

#[test]
fn files_cut_at_every_byte() {
    for seed in seeds() {
        for end in 0..seed.len().min(2500) {
            read_anyhow(&seed[..end]);
        }
    }
}

#[test]
fn every_byte_of_headers_and_parameters_changed() {
    for seed in seeds() {
        let mut bytes = seed.clone();
        for at in 0..seed.len().min(1400) {
            for value in [0, 1, 0x7f, 0x80, 0xff, b',', b'\t', b'9', b'\n', b'-', b'e'] {
                bytes[at] = value;
                read_anyhow(&bytes);
            }
            bytes[at] = seed[at];
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 4000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn flipped_spliced_and_repeated_bytes(
        seed in 0_usize..15,
        flips in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 0..12),
        piece in any::<(prop::sample::Index, prop::sample::Index, prop::sample::Index)>(),
        spliced in any::<bool>(),
        cut in any::<prop::sample::Index>(),
        whole in any::<bool>(),
    ) {
        let seeds = seeds();
        let mut bytes = seeds[seed % seeds.len()].clone();
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
        read_anyhow(&bytes);
    }

    #[test]
    fn noise(bytes in prop::collection::vec(any::<u8>(), 0..2000), c3d in any::<bool>()) {
        let mut bytes = bytes;
        if c3d && bytes.len() > 1 {
            bytes[0] = 2;
            bytes[1] = 0x50;
        }
        read_anyhow(&bytes);
    }
}
