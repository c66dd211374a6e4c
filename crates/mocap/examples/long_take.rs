//! Ten minutes of 50 markers at 200 frames per second, as C3D, CSV and TRC: read, repaired,
//! stabilised. Prints the seconds of each step and the peak memory: `long_take [c3d|csv|trc]
//! [FOLDER]`.
#![allow(clippy::print_stdout)] // what it is for

use std::path::PathBuf;
use std::time::Instant;

use mimique_geometry::Point;
use mimique_mocap::{
    C3dOptions, Capture, LengthUnit, RepairPlan, read, repair, write_c3d, write_csv, write_trc,
};

const MARKERS: usize = 50;
const HEAD: usize = 4;
const FRAMES: usize = 120_000;

/// A face that talks on a head that turns, with gaps, swaps and spikes now and then; millimetres.
fn take() -> Capture {
    let mut state = 1_u64;
    let mut random = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        (state >> 33) as f64 / f64::from(1_u32 << 31)
    };
    let rest: Vec<[f64; 3]> = (0..MARKERS)
        .map(|m| {
            let (column, row) = ((m % 7) as f64 - 3.0, (m / 7) as f64 - 3.0);
            [22.0 * column, 24.0 * row, 90.0 - 3.0 * column * column - row * row]
        })
        .collect();
    let mut positions = Vec::with_capacity(MARKERS * FRAMES);
    for frame in 0..FRAMES {
        let t = frame as f64 / 200.0;
        let (s, c) = (0.3 * (0.9 * t).sin()).sin_cos();
        for (m, p) in rest.iter().enumerate() {
            let lift = if m < MARKERS - HEAD { 4.0 * (4.0 * t + m as f64).sin() } else { 0.0 };
            let [x, y, z] = [p[0], p[1] + lift, p[2]];
            let turned = [c * x + s * z, y + 1600.0, c * z - s * x];
            // Four decimals, as systems write them.
            positions.push(Point::from(turned.map(|v| ((v + 0.1 * random()) * 1e4).round() / 1e4)));
        }
    }
    for _ in 0..400 {
        let (marker, first) = ((random() * 46.0) as usize, (random() * 119_000.0) as usize);
        for frame in first..first + 4 + (random() * 150.0) as usize {
            positions[frame * MARKERS + marker] = Point::UNSEEN;
        }
    }
    for _ in 0..60 {
        let (marker, first) = ((random() * 45.0) as usize, (random() * 119_000.0) as usize);
        for frame in first..first + 3 {
            positions[frame * MARKERS + marker][1] += 25.0;
        }
    }
    for i in 0..10 {
        for frame in 10_000 * i + 500..10_000 * i + 900 {
            positions.swap(frame * MARKERS + 3 * i, frame * MARKERS + 3 * i + 1);
        }
    }
    Capture {
        labels: (0..MARKERS).map(|m| format!("M{m:02}")).collect(),
        rate_hz: 200.0,
        first_frame: 0,
        unit: LengthUnit::Millimetre,
        positions,
        notes: Vec::new(),
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let kind = arguments.next().unwrap_or_else(|| "c3d".to_owned());
    let folder = arguments.next().map_or_else(std::env::temp_dir, PathBuf::from);
    let file = folder.join(format!("mimique-long-take.{kind}"));
    if !file.is_file() {
        let take = take();
        match kind.as_str() {
            "c3d" => std::fs::write(&file, write_c3d(&take, &C3dOptions::default())?)?,
            "trc" => std::fs::write(&file, write_trc(&take, "long.trc")?)?,
            _ => std::fs::write(&file, write_csv(&take)?)?,
        }
        println!(
            "{} written; run again to measure, so that memory is the reader's own",
            file.display()
        );
        return Ok(());
    }
    let size = std::fs::metadata(&file)?.len();
    let start = Instant::now();
    let capture = read(&file)?;
    let after_read = start.elapsed().as_secs_f64();
    let peak_read = peak_bytes();
    let head = capture.labels[MARKERS - HEAD..].to_vec();
    let (frames, markers) = (capture.frames(), capture.labels.len());
    let done = repair(capture, &RepairPlan { head, ..RepairPlan::default() })?;
    let total = start.elapsed().as_secs_f64();
    println!(
        "{kind}: {frames} frames of {markers} markers, {:.0} MB; read {after_read:.2} s, repaired \
         and stabilised {:.2} s, together {total:.2} s{}",
        size as f64 / 1e6,
        total - after_read,
        processor_seconds().map_or(String::new(), |s| format!(" ({s:.2} s of one processor)"))
    );
    let own = (24 * frames * markers) as f64;
    let told = |bytes: u64| {
        let (bytes, size) = (bytes as f64, size as f64);
        let (file, capture) = (bytes / size, bytes / own);
        format!("{:.0} MB ({file:.2} times the file, {capture:.2} the capture)", bytes / 1e6)
    };
    if let (Some(read), Some(all)) = (peak_read, peak_bytes()) {
        println!("peak memory: reading {}, in all {}", told(read), told(all));
    }
    println!("{}", done.record.summary());
    Ok(())
}

/// Seconds that the process has computed, where the system says it: on a busy machine these, not
/// the clock's, tell what the work costs.
fn processor_seconds() -> Option<f64> {
    let stat = std::fs::read_to_string("/proc/self/stat").ok()?;
    let fields: Vec<&str> = stat.rsplit(')').next()?.split_whitespace().collect();
    let ticks: u64 = fields.get(11)?.parse::<u64>().ok()? + fields.get(12)?.parse::<u64>().ok()?;
    Some(ticks as f64 / 100.0)
}

/// Highest resident memory of the process so far, where the system says it.
fn peak_bytes() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|l| l.starts_with("VmHWM:"))?;
    Some(1024 * line.split_whitespace().nth(1)?.parse::<u64>().ok()?)
}
