//! What must hold of a reader whatever it is given; used by tests and fuzz targets.

use mimique_mocap::{ReadOptions, read_recording, read_weights};

/// Read with and without a rate, so that the paths after it are reached; a capture that comes out
/// is whole and not larger than its file allows.
pub fn read_anyhow(bytes: &[u8]) {
    if let Ok(take) = read_weights(bytes) {
        assert!(take.weights.len() <= 8 * bytes.len() + 4096 * take.names.len());
        assert!(take.frames() * take.names.len() == take.weights.len() && take.rate_hz > 0.0);
    }
    for rate_hz in [None, Some(100.0)] {
        let options = ReadOptions { rate_hz, ..ReadOptions::default() };
        match read_recording(bytes, &options) {
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
