//! Live Link Face CSV: a timecode, a count and a blendshape weight or rotation a column.
//!
//! The timecode is `HH:MM:SS:FF.fff`, FF counting 60ths (or 30ths) of a second, so a 30 Hz take
//! advances by 2. Frames the phone dropped leave a jump; they are filled by the line between their
//! neighbours and listed.

use super::format::{Format, Read, Recognise};
use super::text::{Delimiter, Lines, coordinate, split_fields};
use crate::{ReadError, WeightsTable};

const REMEDY: &str = "export the take again from Live Link Face";

pub(super) static FORMAT: Format = Format {
    id: "live-link-csv",
    name: "Live Link Face CSV (weights)",
    extensions: &["csv"],
    recognised_by: "`Timecode,BlendShapeCount`",
    reads: "weights; dropped frames are filled and listed",
    recognise: Recognise::FirstLine(is_header),
    read: Read::TextWeights(|lines, _| read(lines)),
    write: None,
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
    let base = if highest < 30.5 {
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
    let mut steps: Vec<f64> = ticks.windows(2).map(|w| w[1] - w[0]).collect();
    steps.sort_by(f64::total_cmp);
    let step = steps[steps.len() / 2].round().max(1.0);
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
    Ok((base / step, index))
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
