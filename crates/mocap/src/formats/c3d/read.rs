//! From the stream of a C3D file to a recording: header and parameters reconciled, points read.

use super::header::{BLOCK, Header};
use super::parameters::Parameters;
use super::points::{Layout, Storage};
use crate::capture::unit::decide_unit;
use crate::formats::plausibility::{shortened, unique_labels, whole_or_missing, zeros_to_missing};
use crate::formats::source::{self, Prefix, Source};
use crate::{Capture, Event, LengthUnit, ReadError, ReadOptions, Recording};
use std::collections::HashSet;

/// Read a C3D file: header and parameters, then the data frames by frames.
pub(crate) fn read(file: &mut dyn Source, options: &ReadOptions) -> Result<Recording, ReadError> {
    let mut notes = Vec::new();
    let length = source::length(file)?;
    let mut prefix = Prefix::new(file, length);
    let header = Header::read(&mut prefix, &mut notes)?;
    let parameters = Parameters::read(prefix, &header)?;
    if parameters.is_empty() {
        notes.push("no parameters: labels are made up, the rest is the header's".to_owned());
    }
    let rate_hz = rate(&header, &parameters, options, &mut notes)?;
    let layout = layout(&header, &parameters, length, &mut notes)?;
    let (first_frame, frames) = frames(&header, &parameters, &layout, length, &mut notes)?;

    let labels = point_labels(&parameters, layout.points, &mut notes);
    let kept = markers_kept(&parameters, &labels, &mut notes);
    let labels: Vec<String> =
        labels.into_iter().zip(&kept).filter(|(_, k)| **k).map(|(l, _)| l).collect();
    let mut positions = layout.positions(file, header.processor, frames, &kept)?;
    whole_or_missing(&mut positions, &mut notes);

    let named = parameters.strings("POINT", "UNITS").into_iter().find(|u| !u.is_empty());
    let declared = named.as_deref().and_then(LengthUnit::from_name);
    if let (Some(name), None) = (&named, declared) {
        notes.push(format!("unit \"{name}\" in POINT:UNITS is not known"));
    }
    let unit = decide_unit(options.unit, declared, &positions, labels.len(), &mut notes);
    let labels = unique_labels(labels, &mut notes);
    zeros_to_missing(&mut positions, &labels, unit, &mut notes);
    Ok(Recording {
        system: system(&parameters),
        analog_channels: layout.analog / header.analog_samples.max(1),
        events: events(&parameters),
        format: &super::FORMAT,
        capture: Capture { labels, rate_hz, first_frame, unit, positions, notes },
    })
}

/// The rate: the caller's, POINT:RATE, else the header's.
fn rate(
    header: &Header,
    parameters: &Parameters,
    options: &ReadOptions,
    notes: &mut Vec<String>,
) -> Result<f64, ReadError> {
    let valid = |rate: &f64| rate.is_finite() && *rate > 0.0;
    let by_header = Some(f64::from(header.rate_hz)).filter(valid);
    let by_parameters = parameters.number("POINT", "RATE").filter(valid);
    if let (None, Some(header), Some(taken)) = (options.rate_hz, by_header, by_parameters)
        && (header / taken - 1.0).abs() > 1e-3
    {
        notes.push(format!(
            "the header has {header} frames per second, the parameters {taken}: the parameters' is taken"
        ));
    }
    options.rate_hz.or(by_parameters).or(by_header).filter(valid).ok_or_else(|| {
        ReadError::at_byte(
            20,
            "header",
            format!("{} frames per second", header.rate_hz),
            "give the rate of the recording (--mocap-rate)",
        )
    })
}

/// Where the data are and how a frame is stored.
fn layout(
    header: &Header,
    parameters: &Parameters,
    file_length: u64,
    notes: &mut Vec<String>,
) -> Result<Layout, ReadError> {
    let points = parameters.count("POINT", "USED").map_or(header.points, |n| n as usize);
    if points != header.points {
        notes.push(format!(
            "the header has {} points, the parameters {points}: the parameters' are taken",
            header.points
        ));
    }
    if points == 0 {
        return Err(ReadError::at_byte(
            2,
            "header",
            "no markers in the file (POINT:USED is 0)",
            "export the trajectories with the take",
        ));
    }
    let scale = parameters
        .number("POINT", "SCALE")
        .filter(|s| s.is_finite() && *s != 0.0)
        .unwrap_or(f64::from(header.scale));
    if f64::from(header.scale) * scale < 0.0 {
        let kind = |scale: f64| if scale < 0.0 { "floats" } else { "integers" };
        notes.push(format!(
            "the header says {} (scale {}), the parameters {} ({scale}): the parameters are followed",
            kind(f64::from(header.scale)),
            header.scale,
            kind(scale)
        ));
    } else if scale > 0.0 && (f64::from(header.scale) / scale - 1.0).abs() > 1e-3 {
        notes.push(format!(
            "the header has scale {}, the parameters {scale}: the parameters' is taken",
            header.scale
        ));
    }
    let storage = if scale < 0.0 { Storage::Float } else { Storage::Integer(scale) };
    if !scale.is_finite() || scale == 0.0 {
        return Err(ReadError::at_byte(
            12,
            "header",
            format!("scale {scale}: neither integers (above 0) nor floats (below 0)"),
            "export the file again",
        ));
    }
    let block = BLOCK as u64;
    let starts = |at: &u64| *at >= block && *at < file_length;
    let named = parameters.count("POINT", "DATA_START").map(|b| b.saturating_sub(1) * block);
    let Some(start) = Some(header.data_at as u64).filter(starts).or(named.filter(starts)) else {
        return Err(ReadError::at_byte(
            16,
            "header",
            format!("the data start at byte {}, the file has {file_length}", header.data_at),
            "copy or export the file again, it is cut short",
        ));
    };
    let by_header = Layout { start, points, analog: header.analog_per_frame, storage };
    let Some(by_parameters) = analog_numbers(header, parameters)
        .filter(|&analog| analog != header.analog_per_frame)
        .map(|analog| Layout { analog, ..by_header })
    else {
        return Ok(by_header);
    };
    let declared = declared_frames(header, parameters);
    let fits = |layout: &Layout| {
        let rest = |frames: u64| layout.bytes_after(frames, file_length);
        // Sections are padded to whole blocks.
        declared.counts().any(|frames| rest(frames).is_some_and(|bytes| bytes < block))
    };
    let taken = if fits(&by_parameters) && !fits(&by_header) { by_parameters } else { by_header };
    notes.push(format!(
        "the header has {} analog numbers per frame, the parameters {}: {} taken{}",
        by_header.analog,
        by_parameters.analog,
        taken.analog,
        if fits(&taken) { ", which the file's length fits" } else { "" },
    ));
    Ok(taken)
}

/// Analog numbers per frame by the parameters: ANALOG:USED channels, each as many samples as
/// ANALOG:RATE is larger than POINT:RATE (the header's samples where there is no rate).
fn analog_numbers(header: &Header, parameters: &Parameters) -> Option<usize> {
    let channels = parameters.count("ANALOG", "USED")? as usize;
    let rates = (parameters.number("ANALOG", "RATE"), parameters.number("POINT", "RATE"));
    let samples = match rates {
        (Some(analog), Some(point)) if analog >= point && point > 0.0 => {
            (analog / point).round() as usize
        }
        _ => header.analog_samples.max(1),
    };
    channels.checked_mul(samples)
}

/// The frames that a file says to have.
struct DeclaredFrames {
    /// Number of the first frame.
    first: u64,
    /// How many there are, by each place that says it.
    counts: [Option<u64>; 4],
}

impl DeclaredFrames {
    /// The counts above 0, the most trusted first.
    fn counts(&self) -> impl Iterator<Item = u64> {
        self.counts.into_iter().flatten().filter(|&n| n > 0)
    }
}

/// The header and POINT:FRAMES count in 16 bits; longer takes say their length in
/// TRIAL:ACTUAL_START_FIELD / ACTUAL_END_FIELD (two words, the lower first) or POINT:LONG_FRAMES.
fn declared_frames(header: &Header, parameters: &Parameters) -> DeclaredFrames {
    let field = |name: &str| match parameters.numbers("TRIAL", name)[..] {
        [low, high, ..] => Some((low + 65_536.0 * high) as u64),
        _ => None,
    };
    let (start, end) = (field("ACTUAL_START_FIELD"), field("ACTUAL_END_FIELD"));
    let trial = match (start, end) {
        (Some(start), Some(end)) if end >= start && end > 0 => Some((start, end - start + 1)),
        _ => None,
    };
    DeclaredFrames {
        first: trial.map_or(header.first_frame, |(start, _)| start),
        counts: [
            trial.map(|(_, count)| count),
            parameters.count("POINT", "LONG_FRAMES"),
            parameters.count("POINT", "FRAMES"),
            (header.last_frame + 1).checked_sub(header.first_frame),
        ],
    }
}

/// Number of the first frame and how many there are. A count that saturated (65,535) gives way to what
/// the file holds.
fn frames(
    header: &Header,
    parameters: &Parameters,
    layout: &Layout,
    file_length: u64,
    notes: &mut Vec<String>,
) -> Result<(u64, usize), ReadError> {
    let present = layout.frames_present(file_length);
    let frames = declared_frames(header, parameters);
    let first_frame = frames.first;
    // The first count that the file can hold; blocks are padded, so it may hold a few more.
    let named: Vec<u64> = frames.counts().collect();
    let saturated = named.iter().all(|&n| n >= 65_535);
    let Some(&declared) = named.iter().find(|&&n| n <= present).or(named.first()) else {
        return Err(ReadError::at_byte(
            6,
            "header",
            format!("frames {} to {}: no frame", header.first_frame, header.last_frame),
            "export the take again with its frames",
        ));
    };
    if declared <= present {
        if named.iter().any(|&n| n != declared && n < 65_535) {
            notes.push(format!("frame counts differ in the file: {named:?}; {declared} taken"));
        }
        if declared == 65_535 && saturated && present > declared {
            notes.push(format!("frame count stops at 65535; the file holds {present} frames"));
            return Ok((first_frame, present as usize));
        }
        return Ok((first_frame, declared as usize));
    }
    if saturated && present > 0 {
        notes.push(format!("{declared} frames declared; the file holds {present}"));
        return Ok((first_frame, present as usize));
    }
    Err(ReadError::at_byte(
        file_length,
        "data section",
        format!("the file ends in frame {} of {declared}", present + 1),
        "copy or export the file again, it is cut short",
    ))
}

/// One label a point, made up (empty) where the file has too few.
fn point_labels(parameters: &Parameters, points: usize, notes: &mut Vec<String>) -> Vec<String> {
    let mut labels = parameters.strings_continued("POINT", "LABELS");
    if labels.len() > points {
        labels.truncate(points);
    } else if labels.len() < points {
        if !parameters.is_empty() {
            notes.push(format!("{} labels for {points} markers", labels.len()));
        }
        labels.resize(points, String::new());
    }
    labels
}

/// Which points are markers: Vicon stores angles, forces, moments, powers and scalars as points
/// and lists their labels in parameters of those names.
fn markers_kept(parameters: &Parameters, labels: &[String], notes: &mut Vec<String>) -> Vec<bool> {
    let mut other: HashSet<String> = HashSet::new();
    for name in ["ANGLES", "FORCES", "MOMENTS", "POWERS", "SCALARS"] {
        other.extend(
            parameters.strings_continued("POINT", name).into_iter().filter(|l| !l.is_empty()),
        );
    }
    let kept: Vec<bool> = labels.iter().map(|label| !other.contains(label)).collect();
    let left_out: Vec<String> =
        labels.iter().zip(&kept).filter(|(_, k)| !**k).map(|(l, _)| l.clone()).collect();
    if left_out.is_empty() || left_out.len() == labels.len() {
        return vec![true; labels.len()];
    }
    notes.push(format!(
        "{} points that are not markers left out: {}",
        left_out.len(),
        shortened(&left_out)
    ));
    kept
}

/// The recording system, from the MANUFACTURER group.
fn system(parameters: &Parameters) -> Option<String> {
    let text = |name| parameters.strings("MANUFACTURER", name).into_iter().find(|s| !s.is_empty());
    let version = text("VERSION_LABEL").or_else(|| {
        let numbers = parameters.numbers("MANUFACTURER", "VERSION");
        (!numbers.is_empty())
            .then(|| numbers.iter().map(f64::to_string).collect::<Vec<_>>().join("."))
    });
    let company = text("COMPANY");
    let software = text("SOFTWARE");
    let parts: Vec<String> = match (company, software) {
        (Some(company), Some(software)) if software.starts_with(&company) => vec![software],
        (company, software) => company.into_iter().chain(software).collect(),
    }
    .into_iter()
    .chain(version)
    .collect();
    (!parts.is_empty()).then(|| parts.join(" "))
}

/// Events: EVENT:LABELS with EVENT:TIMES (minutes and seconds, two floats an event).
fn events(parameters: &Parameters) -> Vec<Event> {
    let labels = parameters.strings_continued("EVENT", "LABELS");
    let times = parameters.numbers("EVENT", "TIMES");
    labels
        .into_iter()
        .zip(times.as_chunks::<2>().0)
        .map(|(label, [minutes, seconds])| Event { label, time_s: 60.0 * minutes + seconds })
        .collect()
}
