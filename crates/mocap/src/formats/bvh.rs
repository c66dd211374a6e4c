//! BVH skeletons: the positions of joints and of the ends of chains, as if they were markers.
//!
//! Joints that have channels become markers of their name; the end of a chain becomes `NAME_end`.
//! The format has no unit: the skeleton's size decides.

use super::format::{Format, Read, Recognise};
use super::text::{Delimiter, Lines, Table, coordinate};
use crate::capture::unit;
use crate::{LengthUnit, ReadError, ReadOptions, Recording};
use mimique_geometry::{DMat3, Displacement, Point, RigidMotion};

const REMEDY: &str = "export the take again as BVH";

pub(super) static FORMAT: Format = Format {
    id: "bvh",
    name: "BVH",
    extensions: &["bvh"],
    recognised_by: "`HIERARCHY`",
    reads: "positions of joints and ends of chains",
    recognise: Recognise::FirstLine(is_first_line),
    read: Read::Text(read),
    write: None,
};

/// Whether a line is the first of a BVH file.
fn is_first_line(line: &str) -> bool {
    line.trim() == "HIERARCHY"
}

/// What a channel moves.
#[derive(Debug, Clone, Copy)]
enum Channel {
    Position(usize),
    Rotation(usize),
}

/// A joint or the end of a chain.
#[derive(Debug)]
struct Joint {
    name: String,
    parent: Option<usize>,
    offset: Displacement,
    channels: Vec<Channel>,
    /// Whether its position becomes a marker.
    kept: bool,
    /// Whether the end of its chain was named.
    ended: bool,
    /// Whether its offset was given.
    placed: bool,
}

impl Joint {
    fn new(name: String, parent: Option<usize>, kept: bool) -> Self {
        let (offset, channels) = (Displacement::ZERO, Vec::new());
        Self { name, parent, offset, channels, kept, ended: false, placed: false }
    }
}

/// Read the document.
fn read(lines: &mut Lines<'_>, options: &ReadOptions) -> Result<Recording, ReadError> {
    let joints = hierarchy(lines)?;
    let mut table = Table {
        labels: joints.iter().filter(|j| j.kept).map(|j| j.name.clone()).collect(),
        never_missing: true,
        ..Table::default()
    };
    let channels: usize = joints.iter().map(|j| j.channels.len()).sum();
    let mut declared = None;
    let mut values = Vec::with_capacity(channels);
    let mut poses: Vec<RigidMotion> = Vec::with_capacity(joints.len());
    while let Some((line, text)) = lines.next_filled()? {
        if let Some((key, value)) = text.split_once(':') {
            let value = value.trim();
            match key.trim().to_ascii_lowercase().as_str() {
                "frames" => declared = value.parse::<usize>().ok(),
                "frame time" => {
                    let seconds: Option<f64> = value.parse().ok().filter(|s| *s > 0.0);
                    table.declared_rate = seconds.map(|s| rounded_rate(1.0 / s));
                }
                _ => {}
            }
            continue;
        }
        numbers(line, text, channels, &mut values)?;
        pose(&joints, &values, &mut poses);
        table.positions.extend(
            poses
                .iter()
                .zip(&joints)
                .filter(|(_, j)| j.kept)
                .map(|(pose, _)| pose.apply(Point::ORIGIN)),
        );
        table.lines.push(line);
    }
    table.count_frames("Frames", declared);
    if options.unit.is_none()
        && let Some(extent) = unit::marker_extent(&table.positions, table.labels.len())
    {
        // A skeleton spans 0.5 to 3 m.
        let guess = match extent {
            e if e < 4.0 => LengthUnit::Metre,
            e if e < 400.0 => LengthUnit::Centimetre,
            _ => LengthUnit::Millimetre,
        };
        table.declared_unit = Some(guess);
        table.notes.push(format!(
            "unit not in the file: {} by magnitude (the skeleton spans {extent:.3})",
            guess.symbol()
        ));
    }
    table.finish(&FORMAT, options)
}

/// The numbers of a line of motion, one per channel.
fn numbers(
    line: usize,
    text: &str,
    channels: usize,
    values: &mut Vec<f64>,
) -> Result<(), ReadError> {
    values.clear();
    for (index, field) in text.split_whitespace().enumerate() {
        let value = coordinate(field, Delimiter::Comma).filter(|value| value.is_finite());
        values.push(value.ok_or_else(|| {
            ReadError::at_line(
                line,
                format!("value {}", index + 1),
                format!("\"{field}\" is not a number"),
                REMEDY,
            )
        })?);
    }
    if values.len() != channels {
        return Err(ReadError::at_line(
            line,
            "MOTION",
            format!("{} values for {channels} channels", values.len()),
            "export the take again; the file may have been cut short",
        ));
    }
    Ok(())
}

/// Frame times are printed with few digits: a rate within 0.1 % of a whole one is that.
fn rounded_rate(rate: f64) -> f64 {
    if rate >= 1.0 && (rate - rate.round()).abs() < 1e-3 * rate { rate.round() } else { rate }
}

/// Read up to the line `MOTION`.
fn hierarchy(lines: &mut Lines<'_>) -> Result<Vec<Joint>, ReadError> {
    let mut joints: Vec<Joint> = Vec::new();
    let mut open: Vec<usize> = Vec::new();
    let mut last = 1;
    while let Some((line, text)) = lines.next_filled()? {
        last = line;
        let words: Vec<&str> = text.split_whitespace().filter(|w| *w != "{").collect();
        let damaged = |what: String| ReadError::at_line(line, "HIERARCHY", what, REMEDY);
        match words.as_slice() {
            [] | ["HIERARCHY"] => {}
            ["MOTION"] => {
                if let Some(&joint) = open.last() {
                    return Err(damaged(format!("{} is not closed", joints[joint].name)));
                }
                if let Some(joint) = joints.iter().find(|joint| !joint.placed) {
                    return Err(damaged(format!("{} has no OFFSET", joint.name)));
                }
                return Ok(joints);
            }
            ["ROOT" | "JOINT", name @ ..] => {
                let parent = open.last().copied();
                open.push(joints.len());
                joints.push(Joint::new(name.join(" "), parent, false));
            }
            ["End", ..] => {
                let Some(&parent) = open.last() else {
                    return Err(damaged("an end without a joint".to_owned()));
                };
                // One end a joint: the output stays in proportion to the channels.
                let kept = joints[parent].kept && !joints[parent].ended;
                joints[parent].ended = true;
                open.push(joints.len());
                let name = format!("{}_end", joints[parent].name);
                joints.push(Joint::new(name, Some(parent), kept));
            }
            ["}"] => {
                if open.pop().is_none() {
                    return Err(damaged("\"}\" closes nothing".to_owned()));
                }
            }
            ["OFFSET", x, y, z] => {
                let Some(&joint) = open.last() else {
                    return Err(damaged("an offset without a joint".to_owned()));
                };
                joints[joint].placed = true;
                for (axis, word) in [x, y, z].into_iter().enumerate() {
                    joints[joint].offset[axis] =
                        word.parse().map_err(|_| damaged(format!("\"{word}\" is not a number")))?;
                }
            }
            ["CHANNELS", _, names @ ..] => {
                let Some(&joint) = open.last() else {
                    return Err(damaged("channels without a joint".to_owned()));
                };
                for name in names {
                    let channel = channel(name)
                        .ok_or_else(|| damaged(format!("\"{name}\" is not a channel")))?;
                    joints[joint].channels.push(channel);
                }
                joints[joint].kept = !names.is_empty();
            }
            _ => return Err(damaged(format!("\"{}\" is not understood", text.trim()))),
        }
    }
    Err(ReadError::at_line(last, "HIERARCHY", "the file ends before MOTION", REMEDY))
}

fn channel(name: &str) -> Option<Channel> {
    let axis = match name.chars().next()?.to_ascii_uppercase() {
        'X' => 0,
        'Y' => 1,
        'Z' => 2,
        _ => return None,
    };
    match name.get(1..)?.to_ascii_lowercase().as_str() {
        "position" => Some(Channel::Position(axis)),
        "rotation" => Some(Channel::Rotation(axis)),
        _ => None,
    }
}

/// The motion of every joint into the world, parents first.
fn pose(joints: &[Joint], values: &[f64], poses: &mut Vec<RigidMotion>) {
    poses.clear();
    let mut values = values.iter().copied();
    for joint in joints {
        let mut own = RigidMotion { translation: joint.offset, ..RigidMotion::IDENTITY };
        for channel in &joint.channels {
            let value = values.next().unwrap_or(0.0);
            match *channel {
                Channel::Position(axis) => own.translation[axis] += value,
                Channel::Rotation(axis) => own.rotation *= about(axis, value.to_radians()),
            }
        }
        poses.push(joint.parent.map_or(own, |parent| poses[parent].after(&own)));
    }
}

/// Rotation about an axis, right-handed. Sine and cosine are `libm`'s: the browser places the joints
/// where the native program does, bit for bit.
fn about(axis: usize, angle: f64) -> DMat3 {
    let (sine, cosine) = libm::sincos(angle);
    let mut turn = DMat3::IDENTITY;
    let (j, k) = ((axis + 1) % 3, (axis + 2) % 3);
    turn.col_mut(j)[j] = cosine;
    turn.col_mut(j)[k] = sine;
    turn.col_mut(k)[j] = -sine;
    turn.col_mut(k)[k] = cosine;
    turn
}

#[cfg(test)]
mod tests {
    use mimique_geometry::Point;

    use crate::{LengthUnit, read_bytes};

    const HEAD: &str = "HIERARCHY\nROOT Hips\n{\n OFFSET 0 0 0\n CHANNELS 6 Xposition Yposition \
        Zposition Zrotation Xrotation Yrotation\n JOINT Head\n {\n  OFFSET 0 60 0\n  CHANNELS 3 \
        Zrotation Xrotation Yrotation\n  End Site\n  {\n   OFFSET 0 0 10\n  }\n }\n}\nMOTION\n";

    #[test]
    fn the_head_turns_on_the_hips() {
        let rows =
            "Frames: 2\nFrame Time: 0.008333\n10 100 0 0 0 0 0 0 90\n10 100 0 90 0 0 0 0 0\n";
        let capture = read_bytes(format!("{HEAD}{rows}").as_bytes()).unwrap();
        assert_eq!(capture.labels, ["Hips", "Head", "Head_end"]);
        assert_eq!((capture.rate_hz, capture.unit), (120.0, LengthUnit::Centimetre));
        let want = [
            [[10.0, 100.0, 0.0], [10.0, 160.0, 0.0], [20.0, 160.0, 0.0]],
            [[10.0, 100.0, 0.0], [-50.0, 100.0, 0.0], [-50.0, 100.0, 10.0]],
        ];
        for (frame, want) in want.iter().enumerate() {
            for (got, want) in capture.frame(frame).iter().zip(want) {
                let off = (*got - Point::from(*want)).abs().max_element();
                assert!(off < 1e-12, "{:?}", capture.frame(frame));
            }
        }
    }

    /// A skeleton is computed: a joint at the origin is there, in a frame as in a whole take.
    #[test]
    fn a_joint_at_the_origin_is_there() {
        let rows = "Frames: 3\nFrame Time: 0.01\n0 0 0 0 0 0 0 0 0\n0 0 0 0 0 0 0 0 0\n50 90 0 0 0 0 0 0 0\n";
        let capture = read_bytes(format!("{HEAD}{rows}").as_bytes()).unwrap();
        let hips: Vec<Point> = (0..3).map(|frame| capture.frame(frame)[0]).collect();
        assert_eq!(hips, [Point::ORIGIN, Point::ORIGIN, Point::new(50.0, 90.0, 0.0)]);
        assert!(capture.notes.iter().all(|note| !note.contains("missing")), "{:?}", capture.notes);
    }

    #[test]
    fn errors_name_the_line() {
        let rows = "Frames: 2\nFrame Time: 0.01\n10 100 0\n";
        assert_eq!(
            read_bytes(format!("{HEAD}{rows}").as_bytes()).unwrap_err().to_string(),
            "line 19, MOTION: 3 values for 9 channels; \
             export the take again; the file may have been cut short"
        );
    }
}
