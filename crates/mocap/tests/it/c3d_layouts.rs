//! C3D files laid out as systems lay them out and the standard does not forbid: parameters in any
//! order, labels continued, analog data between the points, damaged or missing parameters.

use mimique_geometry::Point;
use mimique_mocap::{
    C3dOptions, C3dStorage, Capture, LengthUnit, Processor, ReadOptions, read_bytes,
    read_recording, write_c3d,
};

const PROCESSORS: [Processor; 3] = [Processor::Intel, Processor::Dec, Processor::Mips];

fn capture(markers: usize, frames: usize) -> Capture {
    Capture {
        labels: (0..markers).map(|m| format!("m{m}")).collect(),
        rate_hz: 50.0,
        first_frame: 1,
        unit: LengthUnit::Millimetre,
        positions: (0..markers * frames)
            .map(|i| Point::new(20.0 + i as f64, 0.5 * i as f64 - 40.0, 1000.0 - i as f64))
            .collect(),
        notes: Vec::new(),
    }
}

/// The entries of a parameter section: bytes without the word that leads to the next entry.
struct Entry {
    id: i8,
    name: Vec<u8>,
    content: Vec<u8>,
}

fn word(processor: Processor, bytes: [u8; 2]) -> u16 {
    if processor == Processor::Mips { u16::from_be_bytes(bytes) } else { u16::from_le_bytes(bytes) }
}

fn word_bytes(processor: Processor, value: u16) -> [u8; 2] {
    if processor == Processor::Mips { value.to_be_bytes() } else { value.to_le_bytes() }
}

/// Take the parameter section of one of our files apart.
fn entries(file: &[u8], processor: Processor) -> Vec<Entry> {
    let mut at = 516;
    let mut found = Vec::new();
    while file[at] != 0 {
        let name_length = usize::from(file[at]);
        let offset_at = at + 2 + name_length;
        let next = usize::from(word(processor, [file[offset_at], file[offset_at + 1]]));
        found.push(Entry {
            id: file[at + 1] as i8,
            name: file[at + 2..offset_at].to_vec(),
            content: file[offset_at + 2..offset_at + next].to_vec(),
        });
        at = offset_at + next;
    }
    found
}

/// Put a section together again in the place of the old one; it must not be longer.
fn with_entries(file: &[u8], processor: Processor, entries: &[Entry]) -> Vec<u8> {
    let length = 512 * usize::from(file[514]);
    let mut section = file[512..516].to_vec();
    for entry in entries {
        section.push(entry.name.len() as u8);
        section.push(entry.id as u8);
        section.extend(&entry.name);
        section.extend(word_bytes(processor, entry.content.len() as u16 + 2));
        section.extend(&entry.content);
    }
    assert!(section.len() + 2 <= length, "{} {length}", section.len());
    section.resize(length, 0);
    let mut whole = file.to_vec();
    whole[512..512 + length].copy_from_slice(&section);
    whole
}

#[test]
fn parameters_in_any_order_and_before_their_groups() {
    let capture = capture(4, 6);
    for processor in PROCESSORS {
        let options = C3dOptions { processor, storage: C3dStorage::Float };
        let file = write_c3d(&capture, &options).unwrap();
        let mut parts = entries(&file, processor);
        assert!(parts.len() > 8);
        parts.reverse();
        let read = read_bytes(&with_entries(&file, processor, &parts)).unwrap();
        assert_eq!(
            (read.positions, read.labels),
            (capture.positions.clone(), capture.labels.clone())
        );
        // Names in small letters, a locked group (negative length of the name).
        for part in &mut parts {
            part.name.make_ascii_lowercase();
        }
        let mut bytes = with_entries(&file, processor, &parts);
        bytes[516] = bytes[516].wrapping_neg();
        assert_eq!(read_bytes(&bytes).unwrap().labels, capture.labels);
    }
}

#[test]
fn labels_continued_in_labels2_and_3_and_too_few() {
    let many = capture(700, 2);
    let file = write_c3d(&many, &C3dOptions::default()).unwrap();
    let names: Vec<String> = entries(&file, Processor::Intel)
        .iter()
        .map(|e| String::from_utf8(e.name.clone()).unwrap())
        .filter(|n| n.starts_with("LABELS"))
        .collect();
    assert_eq!(names, ["LABELS", "LABELS2", "LABELS3"]);
    assert_eq!(read_bytes(&file).unwrap().labels, many.labels);
    let parts: Vec<Entry> =
        entries(&file, Processor::Intel).into_iter().filter(|e| e.name != b"LABELS3").collect();
    let read = read_bytes(&with_entries(&file, Processor::Intel, &parts)).unwrap();
    assert_eq!(read.labels[509], "m509");
    assert_eq!(read.labels[510], "M511", "made up by its place");
    assert!(read.notes.iter().any(|n| n == "510 labels for 700 markers"), "{:?}", read.notes);
}

#[test]
fn labels_longer_than_four_characters_and_not_of_ascii() {
    let mut capture = capture(3, 2);
    let long = "a label that goes on ".repeat(12);
    capture.labels =
        vec!["sourcil gauche intérieur".to_owned(), long.trim().to_owned(), "N".to_owned()];
    for processor in PROCESSORS {
        let options = C3dOptions { processor, storage: C3dStorage::Float };
        let read = read_bytes(&write_c3d(&capture, &options).unwrap()).unwrap();
        assert_eq!(read.labels, capture.labels);
    }
    capture.labels[1] = "x".repeat(300);
    let error = write_c3d(&capture, &C3dOptions::default()).unwrap_err().to_string();
    assert!(error.ends_with("more than 255 bytes; rename the marker"), "{error}");
}

/// Analog samples after the points of every frame, as a force plate's.
fn with_analog(
    file: &[u8],
    processor: Processor,
    markers: usize,
    bytes_a_number: usize,
) -> Vec<u8> {
    const CHANNELS: usize = 6;
    const SAMPLES: usize = 4;
    let data = 512 * (usize::from(word(processor, [file[16], file[17]])) - 1);
    let stride = 4 * markers * bytes_a_number;
    let frames = usize::from(word(processor, [file[8], file[9]]));
    let mut out = file[..data].to_vec();
    out[4..6].copy_from_slice(&word_bytes(processor, (CHANNELS * SAMPLES) as u16));
    out[18..20].copy_from_slice(&word_bytes(processor, SAMPLES as u16));
    for frame in file[data..].chunks_exact(stride).take(frames) {
        out.extend(frame);
        out.extend(vec![0x3f; CHANNELS * SAMPLES * bytes_a_number]);
    }
    out.resize(out.len().next_multiple_of(512), 0);
    out
}

#[test]
fn analog_samples_are_read_past_and_counted() {
    let capture = capture(5, 9);
    for processor in PROCESSORS {
        for (storage, bytes) in [(C3dStorage::Float, 4), (C3dStorage::Integer { scale: 0.5 }, 2)] {
            let file = write_c3d(&capture, &C3dOptions { processor, storage }).unwrap();
            let file = with_analog(&file, processor, 5, bytes);
            let read = read_recording(&file, &ReadOptions::default()).unwrap();
            assert_eq!(read.capture.positions, capture.positions, "{processor:?}");
            assert_eq!(read.analog_channels, 6);
        }
    }
}

/// The same file whose parameter ANALOG:USED says so many channels, without a rate of theirs.
fn with_analog_used(file: &[u8], processor: Processor, channels: u16) -> Vec<u8> {
    let group = 2;
    let mut parts: Vec<Entry> =
        entries(file, processor).into_iter().filter(|e| e.id != group).collect();
    // Integers of two bytes, no dimension, no description.
    let mut content = vec![2, 0];
    content.extend(word_bytes(processor, channels));
    content.push(0);
    parts.push(Entry { id: group, name: b"USED".to_vec(), content });
    with_entries(file, processor, &parts)
}

#[test]
fn of_two_analog_counts_the_one_is_taken_that_the_length_of_the_file_fits() {
    let capture = capture(5, 90);
    for processor in PROCESSORS {
        for (storage, bytes) in [(C3dStorage::Float, 4), (C3dStorage::Integer { scale: 0.5 }, 2)] {
            let file = write_c3d(&capture, &C3dOptions { processor, storage }).unwrap();
            let file = with_analog(&file, processor, 5, bytes);
            // 24 numbers per frame, 6 channels of 4 samples.
            for (in_header, channels) in [(24, 6), (12, 6), (24, 3), (0, 6)] {
                let mut file = with_analog_used(&file, processor, channels);
                file[4..6].copy_from_slice(&word_bytes(processor, in_header));
                let read = read_recording(&file, &ReadOptions::default()).unwrap();
                assert_eq!(
                    read.capture.positions, capture.positions,
                    "{processor:?}, {in_header} numbers, {channels} channels"
                );
                let said = read.capture.notes.iter().any(|note| {
                    note.contains("analog numbers per frame")
                        && note.ends_with("24 taken, which the file's length fits")
                });
                assert_eq!(said, (in_header, channels) != (24, 6), "{:?}", read.capture.notes);
            }
        }
    }
}

#[test]
fn residual_and_camera_mask_do_not_make_a_marker_missing_but_a_sign_does() {
    let capture = capture(2, 3);
    for processor in PROCESSORS {
        let options = C3dOptions { processor, storage: C3dStorage::Integer { scale: 0.5 } };
        let mut file = write_c3d(&capture, &options).unwrap();
        let data = 512 * (usize::from(word(processor, [file[16], file[17]])) - 1);
        // Seven cameras and a residual of 12 in the first, all seven and the sign in the second.
        file[data + 6..data + 8].copy_from_slice(&word_bytes(processor, 0x7f0c));
        file[data + 14..data + 16].copy_from_slice(&word_bytes(processor, 0xff0c));
        let read = read_bytes(&file).unwrap();
        assert_eq!(read.frame(0)[0], capture.frame(0)[0]);
        assert!(read.frame(0)[1].is_nan_mask().all());
        assert_eq!(read.frame(1), capture.frame(1));
    }
}

#[test]
fn a_coordinate_that_is_not_a_number_makes_the_marker_missing() {
    let capture = capture(2, 3);
    let mut file = write_c3d(&capture, &C3dOptions::default()).unwrap();
    let data = 512 * (usize::from(word(Processor::Intel, [file[16], file[17]])) - 1);
    file[data + 4..data + 8].copy_from_slice(&f32::NAN.to_le_bytes());
    let read = read_bytes(&file).unwrap();
    assert!(read.frame(0)[0].is_nan_mask().all());
    assert_eq!(read.frame(0)[1], capture.frame(0)[1]);
    assert!(read.notes.iter().any(|n| n.contains("one or two coordinates")), "{:?}", read.notes);
}

#[test]
fn without_parameters_the_header_serves() {
    let capture = capture(3, 8);
    let file = write_c3d(&capture, &C3dOptions::default()).unwrap();
    // An empty section, and none at all.
    let empty = with_entries(&file, Processor::Intel, &[]);
    let mut none = file.clone();
    none[0] = 0;
    for bytes in [empty, none] {
        let read = read_bytes(&bytes).unwrap();
        assert_eq!(read.positions, capture.positions);
        assert_eq!((read.rate_hz, read.first_frame), (50.0, 1));
        assert_eq!(read.labels, ["M001", "M002", "M003"]);
        assert!(read.notes[0].starts_with("no "), "{:?}", read.notes);
    }
}

#[test]
fn units_are_those_of_the_file_or_of_a_face() {
    for (unit, name) in
        [(LengthUnit::Metre, "m"), (LengthUnit::Centimetre, "cm"), (LengthUnit::Millimetre, "mm")]
    {
        let capture = Capture { unit, ..capture(3, 2) };
        let file = write_c3d(&capture, &C3dOptions::default()).unwrap();
        assert_eq!(read_bytes(&file).unwrap().unit, unit, "{name}");
    }
    let file = write_c3d(&capture(3, 2), &C3dOptions::default()).unwrap();
    let parts: Vec<Entry> =
        entries(&file, Processor::Intel).into_iter().filter(|e| e.name != b"UNITS").collect();
    let read = read_bytes(&with_entries(&file, Processor::Intel, &parts)).unwrap();
    assert!(read.notes.iter().any(|n| n.starts_with("unit not in the file")), "{:?}", read.notes);
    let asked = ReadOptions { unit: Some(LengthUnit::Centimetre), ..ReadOptions::default() };
    assert_eq!(read_recording(&file, &asked).unwrap().capture.unit, LengthUnit::Centimetre);
}
