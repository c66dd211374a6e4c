//! Hostile files: no reader panics, asks for memory that the file does not warrant, or gives a
//! capture that is not whole; what fuzzing keeps is replayed.

use std::path::{Path, PathBuf};

use mimique_mocap::{formats, recognise};
use proptest::prelude::*;

use crate::support::invariants::read_anyhow;
use crate::support::seeds::written;

fn corpus() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz/corpus")
}

/// The files of the formats' folders of the corpus, each with its folder's name.
fn files() -> impl Iterator<Item = (String, PathBuf)> {
    formats().iter().flat_map(|format| {
        let folder = corpus().join(format.id);
        let files = std::fs::read_dir(&folder)
            .unwrap_or_else(|e| panic!("{}: {e}; every format has samples", folder.display()));
        files.map(|file| (format.id.to_owned(), file.unwrap().path())).collect::<Vec<_>>()
    })
}

/// A small valid file of every format: those of the corpus that are called `seed-...`.
fn seeds() -> Vec<Vec<u8>> {
    let is_seed = |file: &PathBuf| {
        file.file_name().is_some_and(|n| n.as_encoded_bytes().starts_with(b"seed-"))
    };
    let mut seeds: Vec<PathBuf> = files().map(|(_, file)| file).filter(is_seed).collect();
    seeds.sort();
    seeds.iter().map(|file| std::fs::read(file).unwrap()).collect()
}

/// Seeds and what fuzzing found are committed; each runs as it would in the fuzzer.
#[test]
fn the_corpus_of_the_fuzzer_is_replayed() {
    for folder in std::fs::read_dir(corpus()).unwrap().map(|e| e.unwrap().path()) {
        for file in std::fs::read_dir(&folder).unwrap().map(|e| e.unwrap().path()) {
            read_anyhow(&std::fs::read(&file).unwrap());
        }
    }
}

#[test]
fn every_format_has_seeds_that_are_recognised_as_its_own() {
    let seeds: Vec<(String, Vec<u8>)> = files()
        .filter(|(_, file)| file.to_string_lossy().contains("seed-"))
        .map(|(id, file)| (id, std::fs::read(file).unwrap()))
        .collect();
    for format in formats() {
        let mut own = seeds.iter().filter(|(id, _)| id == format.id).peekable();
        assert!(own.peek().is_some(), "{format:?}: no seed in fuzz/corpus");
        for (_, bytes) in own {
            assert_eq!(recognise(bytes), Some(*format));
        }
    }
}

/// What the writers write is in the corpus; `MIMIQUE_UPDATE_GOLDEN=1` writes it anew.
#[test]
fn the_corpus_holds_what_is_written() {
    for (number, seed) in written().into_iter().enumerate() {
        let Some(format) = recognise(&seed) else { panic!("seed {number} is of no format") };
        let file = corpus().join(format.id).join(format!("seed-{number:02}"));
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
        seed in 0_usize..64,
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
