//! Weights as Live Link Face writes them: the header of the application, ARKit's 52 shapes and nine rotations,
//! which are 0, in 60ths of a second whatever the rate. Weights have ten decimals. Unreal, Faceit and Blender's
//! add-ons open it.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use crate::WeightsTable;
use crate::capture::ROTATIONS;
use crate::formats::weights_json::arkit::ARKIT;

/// Ticks of a second of what is written.
const TICKS: f64 = 60.0;
/// A take that ends before this tick would be taken for 30ths of a second: its last row stands there.
const SURELY_SIXTIETHS: f64 = 31.0;

/// The document of weights under ARKit's names.
pub(super) fn write(table: &WeightsTable, path: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    let mut text = String::from("Timecode,BlendShapeCount");
    for name in ARKIT {
        let (first, rest) = name.split_at(1);
        let _ = write!(text, ",{}{rest}", first.to_ascii_uppercase());
    }
    for name in ROTATIONS {
        let _ = write!(text, ",{name}");
    }
    text.push('\n');
    let ticks = |time: f64| (time * TICKS * 1e3).round() / 1e3;
    let last = table.times.last().map_or(0.0, |t| ticks(*t));
    let start = if last < SURELY_SIXTIETHS { SURELY_SIXTIETHS - last.floor() } else { 0.0 };
    for (row, time) in table.times.iter().enumerate() {
        let tick = ticks(*time) + start;
        let second = (tick / TICKS).floor();
        let (minute, hour) = ((second / 60.0).floor(), (second / 3600.0).floor());
        let _ = write!(
            text,
            "{:02}:{:02}:{:02}:{:06.3},{}",
            hour % 24.0,
            minute % 60.0,
            second % 60.0,
            tick - second * TICKS,
            ARKIT.len() + ROTATIONS.len()
        );
        for weight in table.row(row) {
            // Negative zero would read as a change.
            let _ = write!(text, ",{:.10}", if *weight == 0.0 { 0.0 } else { *weight });
        }
        text.push_str(&",0.0000000000".repeat(ROTATIONS.len()));
        text.push('\n');
    }
    vec![(path.to_owned(), text.into_bytes())]
}

#[cfg(test)]
mod tests {
    use crate::{WeightOptions, WeightsTable, read_weights};

    #[test]
    fn what_is_written_reads_back_at_every_rate() {
        let names: Vec<String> = super::ARKIT.map(str::to_owned).to_vec();
        for frames in [2_u32, 3, 20, 40, 300] {
            let weights: Vec<f64> =
                (0..frames * 52).map(|i| (f64::from(i) / 7.0).sin() - 0.25).collect();
            for rate_hz in [24.0, 25.0, 30.0, 50.0, 60.0, 100.0, 120.0, 200.0] {
                // Of a few rows no timecode tells 24 Hz from a phone's 30 with uneven ticks.
                if frames < 20 && ![30.0, 60.0].contains(&rate_hz) {
                    continue;
                }
                let table = WeightsTable::at_rate(names.clone(), weights.clone(), 0, rate_hz);
                let files = crate::weights_files(&table, "a.livelink.csv".as_ref()).unwrap();
                let back = read_weights(&files[0].1, &WeightOptions::default()).unwrap();
                let found = back.rate_hz().unwrap();
                assert!((found / rate_hz - 1.0).abs() < 2e-3, "{found} for {rate_hz}, {frames}");
                assert_eq!((back.frames.len(), back.filled.len()), (frames as usize, 0));
                assert_eq!(back.shape_names.len(), 61);
                for (row, wanted) in weights.chunks(52).enumerate() {
                    for (w, v) in back.row(row).iter().zip(wanted) {
                        assert!((w - v).abs() <= 0.5e-10, "{w} {v}");
                    }
                }
            }
        }
    }
}
