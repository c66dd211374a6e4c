//! What is written is read back: the same numbers for every processor, storage and format.

use mimique_geometry::Point;
use mimique_mocap::{
    C3dOptions, C3dStorage, Capture, LengthUnit, Processor, read_bytes, write_c3d, write_csv,
    write_trc,
};

const PROCESSORS: [Processor; 3] = [Processor::Intel, Processor::Dec, Processor::Mips];

/// A capture whose coordinates are whole multiples of 1/16, so that floats and integers hold them.
fn planted(markers: usize, frames: usize) -> Capture {
    let mut state = 0x2545_f491_4f6c_dd1d_u64;
    let mut coordinate = || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        ((state % 60_000) as f64 - 30_000.0) / 16.0
    };
    let positions = (0..markers * frames)
        .map(|i| {
            if i % 11 == 3 {
                Point::UNSEEN
            } else {
                Point::new(coordinate() + 0.0625, coordinate(), coordinate())
            }
        })
        .collect();
    Capture {
        labels: (0..markers).map(|m| format!("marker {m}")).collect(),
        rate_hz: 240.0,
        first_frame: 705,
        unit: LengthUnit::Millimetre,
        positions,
        notes: Vec::new(),
    }
}

/// Equality that takes missing as equal to missing.
fn assert_same(got: &Capture, want: &Capture) {
    assert_eq!(got.labels, want.labels);
    assert_eq!(
        (got.rate_hz, got.first_frame, got.unit),
        (want.rate_hz, want.first_frame, want.unit)
    );
    assert_eq!(got.positions.len(), want.positions.len());
    for (index, (g, w)) in got.positions.iter().zip(&want.positions).enumerate() {
        assert!(g == w || (w[0].is_nan() && g.is_nan_mask().all()), "{index}: {g:?} {w:?}");
    }
}

#[test]
fn c3d_in_three_byte_orders_and_two_storages_gives_the_same_numbers() {
    for (markers, frames) in [(1, 1), (5, 40), (300, 7), (700, 3)] {
        let capture = planted(markers, frames);
        for processor in PROCESSORS {
            for storage in [C3dStorage::Float, C3dStorage::Integer { scale: 0.0625 }] {
                let bytes = write_c3d(&capture, &C3dOptions { processor, storage }).unwrap();
                let read = read_bytes(&bytes).unwrap();
                assert_same(&read, &capture);
                assert!(read.notes.is_empty(), "{:?}", read.notes);
            }
        }
    }
}

#[test]
fn c3d_longer_than_a_16_bit_count() {
    let mut capture = planted(1, 70_001);
    for first_frame in [0, 1, 65_000, 100_000] {
        capture.first_frame = first_frame;
        let bytes = write_c3d(&capture, &C3dOptions::default()).unwrap();
        assert_same(&read_bytes(&bytes).unwrap(), &capture);
    }
}

#[test]
fn c3d_cut_short_is_refused_with_its_frame() {
    let bytes = write_c3d(&planted(5, 40), &C3dOptions::default()).unwrap();
    let error = read_bytes(&bytes[..bytes.len() - 700]).unwrap_err().to_string();
    assert_eq!(
        error,
        "byte 3908, data section: the file ends in frame 37 of 40; \
         copy or export the file again, it is cut short"
    );
}

#[test]
fn csv_and_trc_give_back_every_bit() {
    let mut capture = planted(7, 90);
    capture.rate_hz = 60_000.0 / 1001.0;
    capture.unit = LengthUnit::Metre;
    capture.positions[1] = Point::new(0.1 + 0.2, -1e-17, 1.0 / 3.0);
    capture.labels[2] = "with, comma; \"quoted\"".to_owned();
    for text in [write_csv(&capture).unwrap(), write_trc(&capture, "take.trc").unwrap()] {
        assert_same(&read_bytes(text.as_bytes()).unwrap(), &capture);
    }
}
