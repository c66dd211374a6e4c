//! FIT, Garmin's binary recordings: the fields of record messages that say time, heart rate, power, speed,
//! way and height (FIT protocol 2.0, global profile).
//!
//! A file is a header, messages and a checksum, perhaps several times. Definition messages say which fields
//! the data messages of a number have, and how long each is; what is not wanted is passed over by its length.

use super::rows::{Place, Rows, Sample};
use super::{Activity, ActivityColumn, ActivityFormat, Read, Recognise, Sport};
use crate::ReadError;
use crate::formats::source::Source;

pub(super) static FORMAT: ActivityFormat = ActivityFormat {
    id: "fit",
    name: "FIT",
    recognised_by: "`.FIT` at byte 8",
    reads: "heart rate, power, speed (or the way over 10 s), grade by height and way over 30 s",
    recognise: Recognise::Beginning(|bytes| bytes.get(8..12) == Some(b".FIT")),
    read: Read::Bytes(read),
};

const REMEDY: &str = "copy the file from the device again; it may have been cut short";

/// Numbers of messages.
const SPORT: u16 = 12;
const SESSION: u16 = 18;
const RECORD: u16 = 20;
/// Number of the field that has the time in every message, s.
const TIMESTAMP: u8 = 253;

/// What a definition says of the data messages that follow.
#[derive(Clone, Default)]
struct Definition {
    message: u16,
    big_endian: bool,
    /// Number and length of each field.
    fields: Vec<(u8, u8)>,
    /// Bytes of the developers' fields behind them.
    more: usize,
}

/// A file's bytes, read one after the other.
struct Bytes<'a> {
    all: &'a [u8],
    at: usize,
    /// Where the messages end.
    end: usize,
}

impl<'a> Bytes<'a> {
    fn wrong(&self, part: &'static str, what: String) -> ReadError {
        ReadError::at_byte(self.at as u64, part, what, REMEDY)
    }

    fn take(&mut self, count: usize) -> Result<&'a [u8], ReadError> {
        match self.all.get(self.at..self.end.min(self.at.saturating_add(count))) {
            Some(bytes) if bytes.len() == count => {
                self.at += count;
                Ok(bytes)
            }
            _ => {
                Err(self.wrong("message", format!("{count} bytes wanted, the messages end before")))
            }
        }
    }

    fn byte(&mut self) -> Result<u8, ReadError> {
        Ok(self.take(1)?[0])
    }
}

fn read(source: &mut dyn Source) -> Result<Activity, ReadError> {
    let mut all = Vec::new();
    source.read_to_end(&mut all).map_err(ReadError::Read)?;
    let mut rows = Rows::default();
    let mut at = 0;
    while at < all.len() {
        at = part(&all, at, &mut rows)?;
    }
    rows.of_device(&FORMAT)
}

/// Reads a header, its messages and their checksum; gives where the next begins.
fn part(all: &[u8], start: usize, rows: &mut Rows) -> Result<usize, ReadError> {
    let mut bytes = Bytes { all, at: start, end: all.len() };
    let header = bytes.take(12).map_err(|_| bytes.wrong("header", "no whole header".to_owned()))?;
    let length = usize::from(header[0]);
    if header.get(8..12) != Some(b".FIT") || length < 12 {
        let what = format!("no header of FIT, {length} bytes long");
        return Err(ReadError::at_byte(start as u64, "header", what, REMEDY));
    }
    let size = u32::from_le_bytes([header[4], header[5], header[6], header[7]]) as usize;
    let (first, end) = (start + length, start + length + size);
    // The checksum of two bytes stands behind the messages.
    let Some(stored) = all.get(end..end + 2) else {
        let what =
            format!("messages of {size} bytes, the file has {}", all.len().saturating_sub(first));
        return Err(ReadError::at_byte(start as u64 + 4, "header", what, REMEDY));
    };
    let stored = u16::from_le_bytes([stored[0], stored[1]]);
    let found = checksum(&all[start..end]);
    if stored != found {
        let what = format!("checksum {stored:#06x}, that of the bytes is {found:#06x}");
        return Err(ReadError::at_byte(end as u64, "checksum", what, REMEDY));
    }
    let mut bytes = Bytes { all, at: first, end };
    let mut definitions: [Option<Definition>; 16] = Default::default();
    let mut clock = None;
    while bytes.at < bytes.end {
        message(&mut bytes, &mut definitions, &mut clock, rows)?;
    }
    Ok(end + 2)
}

/// Reads one message. `clock` is the last time that a message had, s.
fn message(
    bytes: &mut Bytes<'_>,
    definitions: &mut [Option<Definition>; 16],
    clock: &mut Option<u32>,
    rows: &mut Rows,
) -> Result<(), ReadError> {
    let start = bytes.at;
    let header = bytes.byte()?;
    let (number, compressed) = match header {
        0x80.. => (usize::from(header >> 5 & 3), Some(header & 31)),
        _ => (usize::from(header & 15), None),
    };
    if compressed.is_none() && header & 0x40 != 0 {
        definitions[number] = Some(definition(bytes, header & 0x20 != 0)?);
        return Ok(());
    }
    let Some(definition) = &definitions[number] else {
        let what = format!("data of number {number}, which no definition describes");
        return Err(ReadError::at_byte(start as u64, "message", what, REMEDY));
    };
    if let (Some(offset), Some(time)) = (compressed, *clock) {
        // The last five bits of the time; where they are smaller, 32 s have begun anew.
        *clock = Some(time.wrapping_add(u32::from(offset).wrapping_sub(time) & 31));
    }
    let mut fields = Fields::default();
    for &(field, length) in &definition.fields {
        let own = bytes.take(usize::from(length))?;
        fields.put(definition.message, field, own, definition.big_endian);
    }
    bytes.take(definition.more)?;
    *clock = fields.time.or(*clock);
    rows.sport = fields.sport.or(rows.sport);
    if definition.message == RECORD
        && let Some(time) = *clock
    {
        rows.push(fields.sample(Place::Byte(start as u64, "record"), time))?;
    }
    Ok(())
}

fn definition(bytes: &mut Bytes<'_>, has_more: bool) -> Result<Definition, ReadError> {
    let [_, order, low, high] = *bytes.take(4)? else { return Ok(Definition::default()) };
    let big_endian = order == 1;
    let number = if big_endian { [high, low] } else { [low, high] };
    let count = usize::from(bytes.byte()?);
    let fields = bytes.take(3 * count)?.chunks_exact(3).map(|own| (own[0], own[1])).collect();
    let mut more = 0;
    if has_more {
        let count = usize::from(bytes.byte()?);
        let lengths = bytes.take(3 * count)?.chunks_exact(3).map(|own| usize::from(own[1]));
        more = lengths.sum();
    }
    Ok(Definition { message: u16::from_le_bytes(number), big_endian, fields, more })
}

/// What a message says.
#[derive(Default)]
struct Fields {
    time: Option<u32>,
    heart_rate: Option<f64>,
    power: Option<f64>,
    speed: Option<f64>,
    distance: Option<f64>,
    altitude: Option<f64>,
    sport: Option<Sport>,
}

impl Fields {
    /// A field of a message. Numbers that mean "invalid" have all bits set; the finer of two fields for one
    /// thing comes last in the profile and is kept.
    fn put(&mut self, message: u16, field: u8, own: &[u8], big_endian: bool) {
        let Some(value) = unsigned(own, big_endian) else { return };
        let value_f64 = f64::from(value);
        match (message, field) {
            (_, TIMESTAMP) if own.len() == 4 => self.time = Some(value),
            (RECORD, 2) => _ = self.altitude.get_or_insert(value_f64 / 5.0 - 500.0),
            (RECORD, 3) => self.heart_rate = Some(value_f64),
            (RECORD, 5) => self.distance = Some(value_f64 / 100.0),
            (RECORD, 6) => _ = self.speed.get_or_insert(value_f64 / 1000.0),
            (RECORD, 7) => self.power = Some(value_f64),
            (RECORD, 73) => self.speed = Some(value_f64 / 1000.0),
            (RECORD, 78) => self.altitude = Some(value_f64 / 5.0 - 500.0),
            (SPORT, 0) | (SESSION, 5) => self.sport = sport(value),
            _ => {}
        }
    }

    fn sample(&self, place: Place, time: u32) -> Sample {
        let or_missing = |value: Option<f64>| value.unwrap_or(f64::NAN);
        let mut sample = Sample::at(place, f64::from(time));
        for (column, value) in [
            (ActivityColumn::HeartRate, self.heart_rate),
            (ActivityColumn::PowerW, self.power),
            (ActivityColumn::Speed, self.speed),
        ] {
            sample.set(column, or_missing(value));
        }
        sample.distance_m = or_missing(self.distance);
        sample.altitude_m = or_missing(self.altitude);
        sample
    }
}

/// A number of one, two or four bytes; `None` for any other length, and for "invalid".
fn unsigned(own: &[u8], big_endian: bool) -> Option<u32> {
    if own.iter().all(|byte| *byte == 0xff) {
        return None;
    }
    let value = match *own {
        [a] => u32::from(a),
        [a, b] if big_endian => u32::from(u16::from_be_bytes([a, b])),
        [a, b] => u32::from(u16::from_le_bytes([a, b])),
        [a, b, c, d] if big_endian => u32::from_be_bytes([a, b, c, d]),
        [a, b, c, d] => u32::from_le_bytes([a, b, c, d]),
        _ => return None,
    };
    Some(value)
}

/// The sports that are told apart.
fn sport(number: u32) -> Option<Sport> {
    match number {
        1 | 11 | 17 => Some(Sport::OnFoot),
        2 | 21 => Some(Sport::Cycling),
        _ => None,
    }
}

/// The protocol's checksum: CRC-16 of polynomial 0xA001.
fn checksum(bytes: &[u8]) -> u16 {
    bytes.iter().fold(0, |crc: u16, byte| {
        (0..8).fold(
            crc ^ u16::from(*byte),
            |crc, _| {
                if crc & 1 == 1 { crc >> 1 ^ 0xA001 } else { crc >> 1 }
            },
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::read_activity_bytes;

    /// A file of some messages.
    fn file(messages: &[u8]) -> Vec<u8> {
        let mut all = vec![14, 0x20, 0x54, 0x08];
        all.extend((messages.len() as u32).to_le_bytes());
        all.extend(b".FIT");
        let header = checksum(&all);
        all.extend(header.to_le_bytes());
        all.extend(messages);
        let whole = checksum(&all);
        all.extend(whole.to_le_bytes());
        all
    }

    /// Time, heart rate and power, little-endian.
    const DEFINITION: [u8; 15] = [0x40, 0, 0, 20, 0, 3, 253, 4, 0x86, 3, 1, 2, 7, 2, 0x84];

    fn record(time: u32, heart_rate: u8, power: u16) -> Vec<u8> {
        [&[0][..], &time.to_le_bytes(), &[heart_rate], &power.to_le_bytes()].concat()
    }

    #[test]
    fn records_with_invalid_values_and_compressed_times() {
        let mut messages = DEFINITION.to_vec();
        messages.extend(record(1_000_000_030, 91, 150));
        messages.extend(record(1_000_000_031, 0xff, 0xffff));
        // Heart rate alone, its time in the header: five bits that begin anew.
        messages.extend([0x41, 0, 0, 20, 0, 1, 3, 1, 2]);
        messages.extend([0x80 | 1 << 5 | (1_000_000_033 % 32) as u8, 95]);
        messages.extend([0x80 | 1 << 5 | (1_000_000_036 % 32) as u8, 96]);
        let activity = read_activity_bytes(&file(&messages)).unwrap();
        assert_eq!(activity.time_s, [0.0, 1.0, 3.0, 6.0]);
        let heart = activity.column(ActivityColumn::HeartRate).unwrap();
        assert!(heart[0] == 91.0 && heart[1].is_nan() && heart[2..] == [95.0, 96.0], "{heart:?}");
        assert_eq!(activity.column(ActivityColumn::PowerW).unwrap()[0], 150.0);
    }

    #[test]
    fn big_endian_developers_fields_finer_fields_and_a_second_part() {
        // Time, speed and the finer speed; a developer's field of three bytes behind them.
        let mut messages =
            vec![0x60, 0, 1, 0, 20, 3, 253, 4, 0x86, 73, 4, 0x86, 6, 2, 0x84, 1, 0, 3, 0];
        for i in 0..2u32 {
            messages.push(0);
            messages.extend((500 + i).to_be_bytes());
            messages.extend(2500u32.to_be_bytes());
            messages.extend(1000u16.to_be_bytes());
            messages.extend([1, 2, 3]);
        }
        // The sport: a run.
        messages.extend([0x40, 0, 0, 12, 0, 1, 0, 1, 0, 0, 1]);
        let mut whole = file(&messages);
        let mut later = DEFINITION.to_vec();
        later.extend(record(502, 100, 0));
        whole.extend(file(&later));
        let activity = read_activity_bytes(&whole).unwrap();
        assert_eq!(
            (activity.time_s.clone(), activity.sport),
            (vec![0.0, 1.0, 2.0], Some(Sport::OnFoot))
        );
        assert_eq!(activity.column(ActivityColumn::Speed).unwrap()[..2], [2.5, 2.5]);
    }

    #[test]
    fn errors_name_byte_part_value_and_remedy() {
        let mut messages = DEFINITION.to_vec();
        messages.extend(record(1000, 91, 150));
        let whole = file(&messages);
        let said = |bytes: &[u8]| read_activity_bytes(bytes).unwrap_err().to_string();
        assert!(
            said(&whole[..whole.len() - 5])
                .starts_with("byte 4, header: messages of 23 bytes, the file has 20; copy")
        );
        let mut damaged = whole.clone();
        damaged[33] ^= 1;
        assert!(said(&damaged).starts_with("byte 37, checksum: checksum 0x"), "{}", said(&damaged));
        let undefined = file(&[5, 1, 2, 3]);
        assert!(
            said(&undefined).starts_with("byte 14, message: data of number 5, which no definition")
        );
        let short = file(&messages[..messages.len() - 2]);
        assert!(
            said(&short).contains("message: 2 bytes wanted, the messages end before"),
            "{}",
            said(&short)
        );
        let nothing = file(&DEFINITION);
        assert!(said(&nothing).contains("no sample with a time"));
        let mut trailing = whole;
        trailing.extend([0; 3]);
        assert!(said(&trailing).contains("header: no whole header"), "{}", said(&trailing));
    }
}
