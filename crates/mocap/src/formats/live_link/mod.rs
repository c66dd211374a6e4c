//! Live Link Face CSV: a timecode, a count and a blendshape weight or rotation a column.
//!
//! The timecode is `HH:MM:SS:FF.fff`, FF counting 60ths (or 30ths) of a second, so a 30 Hz take
//! advances by 2. Tools that write the format have other rates; a take lasts as long as its timecode
//! says. Frames the phone dropped leave a jump; they are filled by the line between their neighbours
//! and listed.

mod write;

use self::write::write;
use super::format::{Format, Read, Recognise, Write};
use super::text::{Delimiter, Lines, coordinate, snapped_rate, split_fields};
use super::weights_json::arkit::ARKIT;
use crate::{ReadError, WeightsTable};

const REMEDY: &str = "export the take again from Live Link Face";

/// How far the clock of the frames and that of the timecode may run apart.
const CLOCK_DRIFT: f64 = 5e-3;

pub(super) static FORMAT: Format = Format {
    id: "live-link-csv",
    name: "Live Link Face CSV (weights)",
    extensions: &["livelink.csv"],
    recognised_by: "`Timecode,BlendShapeCount`",
    reads: "weights; dropped frames are filled and listed",
    recognise: Recognise::FirstLine(is_header),
    read: Read::TextWeights(|lines, _| read(lines)),
    write: Some(Write::Weights { columns: Some(&ARKIT), write }),
};

/// Whether a line is the header of such a file.
fn is_header(line: &str) -> bool {
    line.get(..24).is_some_and(|start| start.eq_ignore_ascii_case("Timecode,BlendShapeCount"))
}

/// A timecode's parts.
#[derive(Clone, Copy)]
struct Timecode {
    second: u64,
    frame: f64,
}

/// Read the document.
fn read(lines: &mut Lines<'_>) -> Result<WeightsTable, ReadError> {
    let (header_line, header) = lines.next_filled()?.unwrap_or((1, ""));
    let fields = split_fields(header, Delimiter::Comma);
    let names: Vec<String> = fields.iter().skip(2).map(ToString::to_string).collect();
    if names.is_empty() {
        return Err(ReadError::at_line(header_line, "header", "no column of weights", REMEDY));
    }
    if let Some(k) = (0..names.len()).find(|&k| names[..k].contains(&names[k])) {
        let what = format!("shape {:?} twice", names[k]);
        return Err(ReadError::at_line(header_line, "header", what, "give every shape one column"));
    }
    let mut rows: Vec<(usize, Timecode)> = Vec::new();
    let mut values: Vec<f64> = Vec::new();
    while let Some((line, text)) = lines.next_filled()? {
        let fields = split_fields(text, Delimiter::Comma);
        if fields.len() != names.len() + 2 {
            return Err(ReadError::at_line(
                line,
                "row",
                format!("{} columns where the header has {}", fields.len(), names.len() + 2),
                "complete the row or remove it; the file may have been cut short",
            ));
        }
        let timecode = timecode(&fields[0]).ok_or_else(|| {
            ReadError::at_line(
                line,
                "column 1 (Timecode)",
                format!("\"{}\" is not hours:minutes:seconds:frames", fields[0]),
                REMEDY,
            )
        })?;
        rows.push((line, timecode));
        for (index, field) in fields.iter().enumerate().skip(2) {
            let value = coordinate(field, Delimiter::Comma).filter(|v| v.is_finite());
            values.push(value.ok_or_else(|| {
                ReadError::at_line(
                    line,
                    format!("column {} ({})", index + 1, names[index - 2]),
                    format!("\"{field}\" is not a weight"),
                    REMEDY,
                )
            })?);
        }
    }
    if rows.len() < 2 {
        return Err(ReadError::at_line(
            header_line,
            "data",
            format!("{} frames, at least 2 are needed to know the rate", rows.len()),
            REMEDY,
        ));
    }
    let (rate_hz, index) = timeline(&rows)?;
    Ok(filled(names, rate_hz, &index, &values))
}

/// Parse `HH:MM:SS:FF.fff`.
fn timecode(text: &str) -> Option<Timecode> {
    let mut parts = text.split([':', ';']);
    let mut whole = || parts.next()?.trim().parse::<u32>().ok().map(u64::from);
    let (hours, minutes, seconds) = (whole()?, whole()?, whole()?);
    let frame: f64 = parts.next()?.trim().parse().ok()?;
    let fits = hours < 24 && minutes < 60 && seconds < 60 && (0.0..240.0).contains(&frame);
    (fits && parts.next().is_none())
        .then_some(Timecode { second: 3600 * hours + 60 * minutes + seconds, frame })
}

/// The rate and each row's frame number from 0.
fn timeline(rows: &[(usize, Timecode)]) -> Result<(f64, Vec<usize>), ReadError> {
    // Frames of a second by the highest FF seen: 30 or 60.
    let highest = rows.iter().map(|(_, t)| t.frame).fold(0.0, f64::max);
    let base = if highest < 30.5 && !(within_a_second(rows) && steps_of_two(rows)) {
        30.0
    } else if highest < 60.5 {
        60.0
    } else {
        240.0
    };
    let day = 86_400.0 * base;
    let mut previous = f64::NEG_INFINITY;
    let mut past_midnight = 0.0;
    let mut ticks = Vec::with_capacity(rows.len());
    for &(line, timecode) in rows {
        let mut tick = timecode.second as f64 * base + timecode.frame + past_midnight;
        if tick + day / 2.0 < previous {
            past_midnight += day;
            tick += day;
        }
        if tick <= previous {
            return Err(ReadError::at_line(
                line,
                "column 1 (Timecode)",
                "the timecode stands still or goes back",
                "give one take a file, frames in order",
            ));
        }
        previous = tick;
        ticks.push(tick);
    }
    let span_s = (ticks[ticks.len() - 1] - ticks[0]) / base;
    // As many rows as the span has frames: none was dropped, however unevenly the ticks are written.
    let frames = (rows.len() - 1) as f64;
    if let Some(rate) = [base, base / 2.0].into_iter().find(|r| (r * span_s - frames).abs() < 0.5) {
        return Ok((rate, (0..rows.len()).collect()));
    }
    let step = frame_interval(&ticks);
    // Each interval is rounded on its own: the clock's drift does not add up to a lost frame.
    let mut index = vec![0_usize];
    for (row, pair) in ticks.windows(2).enumerate() {
        let advance = ((pair[1] - pair[0]) / step).round().max(1.0) as usize;
        let next = index[row].saturating_add(advance);
        // Bounded by the file, as dropped frames are.
        if next > 2 * rows.len() + 1000 {
            return Err(ReadError::at_line(
                rows[row + 1].0,
                "column 1 (Timecode)",
                format!("frame {next} of a take of {} rows", rows.len()),
                "give one take a file",
            ));
        }
        index.push(next);
    }
    Ok((rate(index[index.len() - 1], span_s, base), index))
}

/// Whether a take is too short to tell how many frames a second has.
fn within_a_second(rows: &[(usize, Timecode)]) -> bool {
    rows.windows(2).all(|pair| pair[0].1.second == pair[1].1.second)
}

/// Whether rows advance by two frames or more: 30 Hz on 60ths of a second. No phone records 15 Hz.
fn steps_of_two(rows: &[(usize, Timecode)]) -> bool {
    rows.windows(2).all(|pair| pair[1].1.frame - pair[0].1.frame > 1.5)
}

/// Timecode frames between two rows that follow each other: the mean of the intervals without a
/// dropped frame. A take of 24 Hz on 60ths of a second advances by 2.5, or by 2 and 3 in turns.
fn frame_interval(ticks: &[f64]) -> f64 {
    let mut intervals: Vec<f64> = ticks.windows(2).map(|w| w[1] - w[0]).collect();
    intervals.sort_by(f64::total_cmp);
    let median = intervals[intervals.len() / 2];
    let single: Vec<f64> = intervals.into_iter().filter(|d| *d <= 1.5 * median + 1e-9).collect();
    single.iter().sum::<f64>() / single.len() as f64
}

/// The rate at which so many frames take the timecode's span. One within a share of
/// [`CLOCK_DRIFT`] of what a phone records, a whole fraction of the base, is that.
fn rate(frames: usize, span_s: f64, base: f64) -> f64 {
    let raw = frames as f64 / span_s;
    let nominal = base / (base / raw).round().max(1.0);
    if (raw - nominal).abs() <= CLOCK_DRIFT * nominal { nominal } else { snapped_rate(raw, span_s) }
}

/// Rows at their frames, the dropped ones on the line between their neighbours.
fn filled(names: Vec<String>, rate_hz: f64, index: &[usize], values: &[f64]) -> WeightsTable {
    let columns = names.len();
    let frames = index.last().map_or(0, |last| last + 1);
    let mut weights = Vec::with_capacity(frames * columns);
    let mut filled = Vec::new();
    let rows: Vec<&[f64]> = values.chunks_exact(columns).collect();
    for (pair, rows) in index.windows(2).zip(rows.windows(2)) {
        weights.extend_from_slice(rows[0]);
        let span = pair[1] - pair[0];
        if span > 1 {
            filled.push((pair[0] + 1, pair[1]));
        }
        for step in 1..span {
            let t = step as f64 / span as f64;
            weights.extend(rows[0].iter().zip(rows[1]).map(|(a, b)| a + t * (b - a)));
        }
    }
    if let Some(last) = rows.last() {
        weights.extend_from_slice(last);
    }
    WeightsTable { filled, ..WeightsTable::at_rate(names, weights, 0, rate_hz) }
}

#[cfg(test)]
mod tests {
    use crate::{ReadError, WeightOptions, WeightsTable};

    fn read_weights(bytes: &[u8]) -> Result<WeightsTable, ReadError> {
        crate::read_weights(bytes, &WeightOptions::default())
    }

    fn take(rows: &[(&str, f64)]) -> String {
        let rows: String = rows.iter().map(|(t, w)| format!("{t},2,{w},0\n")).collect();
        format!("Timecode,BlendShapeCount,JawOpen,HeadYaw\n{rows}")
    }

    #[test]
    fn thirty_hertz_on_a_sixty_base_with_a_dropped_frame_over_midnight() {
        let text = take(&[
            ("23:59:59:55.652", 0.0),
            ("23:59:59:57.651", 0.25),
            ("00:00:00:01.650", 1.25),
            ("00:00:00:03.650", 1.0),
        ]);
        let take = read_weights(text.as_bytes()).unwrap();
        assert_eq!((take.rate_hz(), take.frames.len()), (Some(30.0), 5));
        assert_eq!(take.filled, [(2, 3)]);
        let jaw: Vec<f64> = (0..5).map(|f| take.row(f)[0]).collect();
        assert_eq!(jaw, [0.0, 0.25, 0.75, 1.25, 1.0], "weights above 1 are kept");
    }

    /// Files made by tools: 24 Hz on 60ths of a second, as fractions or as whole numbers in turns, and
    /// 25 Hz on 30ths, which leaves no telling from dropped frames but for the duration.
    #[test]
    fn a_take_lasts_as_long_as_its_timecode_says() {
        let made = |rate: f64, base: f64, whole: bool| {
            let rows: Vec<String> = (0..241)
                .map(|f| {
                    let ticks = f64::from(f) * base / rate;
                    let ticks = if whole { (ticks + 1e-9).floor() } else { ticks };
                    let second = (ticks / base).floor();
                    format!("01:00:{second:02}:{:06.3}", ticks - second * base)
                })
                .collect();
            let rows: Vec<(&str, f64)> = rows.iter().map(|row| (row.as_str(), 0.5)).collect();
            let take = read_weights(take(&rows).as_bytes()).unwrap();
            let rate_hz = take.rate_hz().unwrap();
            (rate_hz, (take.frames.len() - 1) as f64 / rate_hz)
        };
        for (rate, base, whole) in [
            (24.0, 60.0, false),
            (24.0, 60.0, true),
            (25.0, 60.0, false),
            (25.0, 60.0, true),
            (48.0, 60.0, false),
            (60.0, 60.0, true),
            (30.0, 60.0, true),
            (24.0, 30.0, true),
            (25.0, 30.0, true),
        ] {
            let (found, duration) = made(rate, base, whole);
            let off = duration / (240.0 / rate) - 1.0;
            assert!(off.abs() < 0.005, "{rate} Hz on {base}: {found} Hz, {duration} s");
        }
        assert_eq!(made(24.0, 60.0, false).0, 24.0);
        assert_eq!(made(25.0, 60.0, false).0, 25.0);
        assert_eq!(made(24.0, 60.0, true).0, 24.0);
    }

    /// A tool that writes 60 Hz in ticks of 0.017, 1.017 and 2.017 has dropped nothing.
    #[test]
    fn uneven_ticks_of_as_many_rows_as_the_span_has_frames_are_even() {
        let (mut tick, mut rows) = (0.0, Vec::new());
        for step in [1.0, 1.967, 0.033].into_iter().cycle().take(301) {
            rows.push(format!("00:00:{:02}:{:06.3}", (tick / 60.0) as u32, tick % 60.0));
            tick += step;
        }
        let rows: Vec<(&str, f64)> = rows.iter().map(|row| (row.as_str(), 0.5)).collect();
        let read = read_weights(take(&rows).as_bytes()).unwrap();
        assert_eq!((read.rate_hz(), read.frames.len()), (Some(60.0), 301));
        assert!(read.filled.is_empty(), "{:?}", read.filled);
    }

    #[test]
    fn a_take_of_a_part_of_a_second_is_at_a_rate_that_phones_have() {
        let rows: Vec<String> = (0..8).map(|f| format!("01:00:00:{:02}.000", 2 * f)).collect();
        let rows: Vec<(&str, f64)> = rows.iter().map(|row| (row.as_str(), 0.5)).collect();
        assert_eq!(read_weights(take(&rows).as_bytes()).unwrap().rate_hz(), Some(30.0));
        let rows: Vec<String> = (0..8).map(|f| format!("01:00:00:{f:02}.000")).collect();
        let rows: Vec<(&str, f64)> = rows.iter().map(|row| (row.as_str(), 0.5)).collect();
        assert_eq!(read_weights(take(&rows).as_bytes()).unwrap().rate_hz(), Some(30.0));
    }

    #[test]
    fn errors_name_the_line() {
        let message =
            |rows: &[(&str, f64)]| read_weights(take(rows).as_bytes()).unwrap_err().to_string();
        assert_eq!(
            message(&[("01:00:00:59.0", 0.0), ("01:00:00:58.0", 0.0)]),
            "line 3, column 1 (Timecode): the timecode stands still or goes back; \
             give one take a file, frames in order"
        );
        assert_eq!(
            message(&[("01:00:61:59.0", 0.0)]),
            "line 2, column 1 (Timecode): \"01:00:61:59.0\" is not hours:minutes:seconds:frames; \
             export the take again from Live Link Face"
        );
    }
}
