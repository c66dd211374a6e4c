//! What must hold of a reader whatever it is given; used by tests and fuzz targets.

use mimique_geometry::coordinates;
use mimique_mocap::{
    CaptureFile, ReadError, ReadOptions, Recording, WeightOptions, WeightsTable, read_recording,
    read_weights,
};
use std::io::{BufReader, Cursor};

/// Read with and without a rate, so that the paths after it are reached; a capture that comes out
/// is whole and not larger than its file allows.
pub fn read_anyhow(bytes: &[u8]) {
    let names: Vec<String> = (0..4).map(|k| format!("shape{k}")).collect();
    for options in [
        WeightOptions::default(),
        WeightOptions { rate_hz: Some(60.0), shape_names: &names, animation: None },
    ] {
        weights_are_whole(bytes, &read_weights(bytes, &options));
    }
    for rate_hz in [None, Some(100.0)] {
        let options = ReadOptions { rate_hz, ..ReadOptions::default() };
        let read = read_recording(bytes, &options);
        if rate_hz.is_some() {
            same_in_pieces(bytes, &options, &read);
        }
        match read {
            Ok(recording) => {
                let capture = recording.capture;
                let markers = capture.labels.len();
                assert!(markers > 0 && capture.positions.len() % markers == 0);
                assert!(capture.rate_hz.is_finite() && capture.rate_hz > 0.0);
                assert!(capture.positions.len() <= 32 * bytes.len() + 4096);
                for p in &capture.positions {
                    assert!(p.is_finite() || p.is_nan_mask().all());
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

/// A table of weights that comes out is whole and not larger than its file allows.
fn weights_are_whole(bytes: &[u8], read: &Result<WeightsTable, ReadError>) {
    match read {
        Ok(table) => {
            let (frames, shapes) = (table.frames.len(), table.shape_names.len());
            assert!(shapes > 0 && frames * shapes == table.weights.len());
            assert!(table.weights.len() <= 8 * bytes.len() + 4096 * shapes);
            assert!(table.times.len() == frames && table.weights.iter().all(|w| w.is_finite()));
        }
        Err(error) => {
            let text = error.to_string();
            assert!(text.contains(": ") && text.contains("; "), "{text}");
        }
    }
}

/// A stream that gives a few bytes at a time must read as the bytes at once do.
fn same_in_pieces(bytes: &[u8], options: &ReadOptions, read: &Result<Recording, ReadError>) {
    let stream = BufReader::with_capacity(61, Cursor::new(bytes));
    let streamed = CaptureFile::of_stream(stream).and_then(|mut file| file.recording(options));
    match (read, &streamed) {
        (Ok(a), Ok(b)) => assert!(same(a, b), "a stream in pieces gives another capture"),
        (Err(a), Err(b)) => assert_eq!(a.to_string(), b.to_string()),
        _ => panic!("bytes: {read:?}, stream: {streamed:?}"),
    }
}

/// Whether two recordings are the same, bit for bit.
fn same(a: &Recording, b: &Recording) -> bool {
    let bits = |r: &Recording| -> Vec<u64> {
        coordinates(&r.capture.positions).iter().map(|v| v.to_bits()).collect()
    };
    let (c, d) = (&a.capture, &b.capture);
    let said = |r: &Recording| {
        format!("{:?} {:?} {} {:?}", r.format, r.system, r.analog_channels, r.events)
    };
    said(a) == said(b)
        && (&c.labels, c.rate_hz.to_bits(), c.first_frame, c.unit, &c.notes)
            == (&d.labels, d.rate_hz.to_bits(), d.first_frame, d.unit, &d.notes)
        && bits(a) == bits(b)
}
