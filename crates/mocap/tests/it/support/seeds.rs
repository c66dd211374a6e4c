//! A small capture in every format and form that is written.

use mimique_geometry::Point;
use mimique_mocap::{
    C3dOptions, C3dStorage, Capture, LengthUnit, Processor, write_c3d, write_csv, write_trc,
};

fn capture() -> Capture {
    Capture {
        labels: ["brow left", "brow right", "nose"].map(str::to_owned).to_vec(),
        rate_hz: 100.0,
        first_frame: 3,
        unit: LengthUnit::Millimetre,
        positions: (0..60)
            .map(
                |i| {
                    if i == 7 { Point::UNSEEN } else { Point::new(f64::from(i) * 0.5, 12.0, -99.5) }
                },
            )
            .collect(),
        notes: Vec::new(),
    }
}

/// A small capture in every format and form that is written.
pub fn written() -> Vec<Vec<u8>> {
    let mut seeds = Vec::new();
    for processor in [Processor::Intel, Processor::Dec, Processor::Mips] {
        for storage in [C3dStorage::Float, C3dStorage::Integer { scale: 0.5 }] {
            seeds.push(write_c3d(&capture(), &C3dOptions { processor, storage }).unwrap());
        }
    }
    seeds.push(write_csv(&capture()).unwrap().into_bytes());
    seeds.push(write_trc(&capture(), "a.trc").unwrap().into_bytes());
    seeds
}
