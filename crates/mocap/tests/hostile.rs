//! No input makes a reader panic or ask for memory beyond the file's size: files of every format
//! cut anywhere, with bytes flipped, spliced and repeated, and noise.

use mimique_mocap::{
    C3dOptions, C3dStorage, Capture, LengthUnit, Processor, ReadOptions, read_recording,
    read_weights, write_c3d, write_csv, write_trc,
};
use proptest::prelude::*;

fn capture() -> Capture {
    Capture {
        labels: ["brow left", "brow right", "nose"].map(str::to_owned).to_vec(),
        rate_hz: 100.0,
        first_frame: 3,
        unit: LengthUnit::Millimetre,
        positions: (0..60)
            .map(|i| if i == 7 { [f64::NAN; 3] } else { [f64::from(i) * 0.5, 12.0, -99.5] })
            .collect(),
        notes: Vec::new(),
    }
}

/// A small valid file of every format.
fn seeds() -> Vec<Vec<u8>> {
    let mut seeds = Vec::new();
    for processor in [Processor::Intel, Processor::Dec, Processor::Mips] {
        for storage in [C3dStorage::Float, C3dStorage::Integer { scale: 0.5 }] {
            seeds.push(write_c3d(&capture(), &C3dOptions { processor, storage }).unwrap());
        }
    }
    seeds.push(write_csv(&capture()).unwrap().into_bytes());
    seeds.push(write_trc(&capture(), "a.trc").unwrap().into_bytes());
    let texts = [
        "NO_OF_FRAMES\t2\nFREQUENCY\t200\nDATA_INCLUDED\t3D\nEVENT\ta\t1\t0.5\nMARKER_NAMES\ta\tb\n\
         1\t0\t1\t2\t3\t4\t5\t6\n2\t0.005\t1\t2\t3\t\t\t\n",
        "1\t2\t3\t4\t5\t6\n1\t2\t3\t4\t5\t6\n",
        "Format Version,1.23,Capture Frame Rate,120,Length Units,Meters\n\n,Type,Marker,Marker,Marker\n\
         ,Name,a,a,a\n,ID,1,1,1\n,,Position,Position,Position\nFrame,Time,X,Y,Z\n0,0,1,2,3\n1,0.1,,,\n",
        "Trajectories\n100\n,,a,,,b,,\nFrame,Sub Frame,X,Y,Z,X,Y,Z\n,,mm,mm,mm,mm,mm,mm\n\
         1,0,1,2,3,4,5,6\n2,0,1,2,3\n",
        "frame,time,marker,x,y,z\n0,0,a,1,2,3\n0,0,b,1,2,3\n1,0.1,a,4,5,6\n",
        "Timecode,BlendShapeCount,EyeBlinkLeft,JawOpen\n01:00:00:01.000,2,0.1,0.2\n01:00:00:04.000,2,1,0\n",
        "HIERARCHY\nROOT Hips\n{\nOFFSET 0 0 0\nCHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation\n\
         JOINT Head\n{\nOFFSET 0 1 0\nCHANNELS 3 Zrotation Xrotation Yrotation\nEnd Site\n{\nOFFSET 0 1 0\n}\n}\n}\n\
         MOTION\nFrames: 2\nFrame Time: 0.01\n0 0 0 0 0 0 0 0 90\n1 0 0 0 0 0 0 0 0\n",
    ];
    seeds.extend(texts.iter().map(|t| t.as_bytes().to_vec()));
    seeds
}

/// Read with and without a rate, so that the paths after it are reached; a capture that comes out
/// is whole and not larger than its file allows.
fn read_anyhow(bytes: &[u8]) {
    if let Ok(take) = read_weights("fuzzed", bytes) {
        assert!(take.weights.len() <= 8 * bytes.len() + 4096 * take.names.len());
        assert!(take.frames() * take.names.len() == take.weights.len() && take.rate_hz > 0.0);
    }
    for rate_hz in [None, Some(100.0)] {
        let options = ReadOptions { rate_hz, ..ReadOptions::default() };
        match read_recording("fuzzed", bytes, &options) {
            Ok(recording) => {
                let capture = recording.capture;
                let markers = capture.labels.len();
                assert!(markers > 0 && capture.positions.len() % markers == 0);
                assert!(capture.rate_hz.is_finite() && capture.rate_hz > 0.0);
                assert!(capture.positions.len() <= 32 * bytes.len() + 4096);
                for p in &capture.positions {
                    assert!(p.iter().all(|v| v.is_finite()) || p.iter().all(|v| v.is_nan()));
                }
                let mut labels = capture.labels;
                labels.sort();
                labels.dedup();
                assert_eq!(labels.len(), markers, "labels are unique");
            }
            Err(error) => {
                let text = error.to_string();
                assert!(text.contains(": ") && text.contains("; "), "{text}");
            }
        }
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
