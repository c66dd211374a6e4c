//! TCX, Garmin's training centre: trackpoints with time, distance, height, heart rate, and in their extension
//! speed and power.

use super::rows::{Rows, Sample};
use super::xml::{Step, instant, number, place, walk, wrong};
use super::{Activity, ActivityColumn, ActivityFormat, Read, Recognise, Sport};
use crate::ReadError;
use crate::formats::source::Source;

pub(super) static FORMAT: ActivityFormat = ActivityFormat {
    id: "tcx",
    name: "TCX",
    recognised_by: "`<TrainingCenterDatabase`",
    reads: "heart rate, power, speed (or the way over 10 s), grade by height and way over 30 s",
    recognise: Recognise::Beginning(|bytes| opens_with(bytes, b"<TrainingCenterDatabase")),
    read: Read::Bytes(read),
};

/// Whether a tag stands in the beginning of a file that opens as XML does.
pub(super) fn opens_with(bytes: &[u8], tag: &[u8]) -> bool {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes).trim_ascii_start();
    bytes.starts_with(b"<") && bytes.windows(tag.len()).any(|window| window == tag)
}

fn read(source: &mut dyn Source) -> Result<Activity, ReadError> {
    let mut rows = Rows::default();
    let mut point: Option<(Option<f64>, Sample)> = None;
    walk(source, |step| {
        match step {
            Step::Opened { path, attributes, byte } => match path.last().map(String::as_str) {
                Some("Trackpoint") => point = Some((None, Sample::at(place(byte), 0.0))),
                Some("Activity") => {
                    let sport = attributes.iter().find(|(key, _)| key == "Sport");
                    rows.sport = rows.sport.or(sport.and_then(|(_, word)| sport_of(word)));
                }
                _ => {}
            },
            Step::Closed { path, text, byte } => {
                let name = path.last().map_or("", String::as_str);
                if name == "Trackpoint" {
                    let Some((time, mut sample)) = point.take() else { return Ok(()) };
                    sample.time_s = time.ok_or_else(|| {
                        wrong(byte, "Trackpoint without a Time".to_owned(), "give its time")
                    })?;
                    return rows.push(sample);
                }
                let Some((time, sample)) = &mut point else { return Ok(()) };
                let of_heart = path.iter().any(|name| name == "HeartRateBpm");
                match name {
                    "Time" => *time = Some(instant(text, byte)?),
                    "DistanceMeters" => sample.distance_m = number(text, name, byte)?,
                    "AltitudeMeters" => sample.altitude_m = number(text, name, byte)?,
                    "Watts" => sample.set(ActivityColumn::PowerW, number(text, name, byte)?),
                    "Speed" => sample.set(ActivityColumn::Speed, number(text, name, byte)?),
                    "Value" if of_heart => {
                        sample.set(ActivityColumn::HeartRate, number(text, name, byte)?);
                    }
                    _ => {}
                }
            }
        }
        Ok(())
    })?;
    rows.of_device(&FORMAT)
}

/// What a word says of a sport.
pub(super) fn sport_of(word: &str) -> Option<Sport> {
    let word = word.to_ascii_lowercase();
    let has = |parts: &[&str]| parts.iter().any(|part| word.contains(part));
    if has(&["bik", "cycl", "ride"]) {
        Some(Sport::Cycling)
    } else if has(&["run", "walk", "hik", "foot"]) {
        Some(Sport::OnFoot)
    } else {
        None
    }
}

#[cfg(test)]
mod tests {
    use crate::{ActivityColumn, Sport, read_activity_bytes};

    fn document(points: &str) -> String {
        format!(
            "<?xml version=\"1.0\"?>\n<TrainingCenterDatabase><Activities><Activity Sport=\"Biking\">\
             <Lap><Track>{points}</Track></Lap></Activity></Activities></TrainingCenterDatabase>\n"
        )
    }

    #[test]
    fn trackpoints_with_their_extensions() {
        let point = |second: u32, more: &str| {
            format!("<Trackpoint><Time>2026-05-01T10:00:{second:02}Z</Time>{more}</Trackpoint>")
        };
        let points = [
            point(0, "<HeartRateBpm><Value>91</Value></HeartRateBpm>"),
            point(
                1,
                "<HeartRateBpm><Value>0</Value></HeartRateBpm><Extensions><ns3:TPX xmlns:ns3=\"u\">\
                 <ns3:Watts>150</ns3:Watts></ns3:TPX></Extensions>",
            ),
            // A lap repeats the last instant of the lap before.
            point(1, "<AltitudeMeters>5</AltitudeMeters>"),
        ];
        let activity = read_activity_bytes(document(&points.concat()).as_bytes()).unwrap();
        assert_eq!((activity.time_s, activity.sport), (vec![0.0, 1.0], Some(Sport::Cycling)));
        let heart = activity.columns[ActivityColumn::HeartRate as usize].clone().unwrap();
        assert!(heart[0] == 91.0 && heart[1].is_nan(), "no heart stands still");
        assert_eq!(activity.columns[ActivityColumn::PowerW as usize].as_ref().unwrap()[1], 150.0);
        assert_eq!(activity.notes.len(), 2, "{:?}", activity.notes);
    }

    #[test]
    fn speed_and_grade_follow_from_way_and_height() {
        let points: String = (0..60)
            .map(|i| {
                format!(
                    "<Trackpoint><Time>2026-05-01T10:00:{i:02}Z</Time><DistanceMeters>{}</DistanceMeters>\
                     <AltitudeMeters>{}</AltitudeMeters></Trackpoint>",
                    3 * i,
                    0.15 * f64::from(i)
                )
            })
            .collect();
        let activity = read_activity_bytes(document(&points).as_bytes()).unwrap();
        for (column, want) in [(ActivityColumn::Speed, 3.0), (ActivityColumn::Grade, 0.05)] {
            let own = activity.column(column).unwrap();
            assert!(own.iter().all(|value| (value - want).abs() < 1e-9), "{column:?}: {own:?}");
        }
    }

    #[test]
    fn errors_name_byte_value_and_remedy() {
        for (points, expected) in [
            ("<Trackpoint></Trackpoint>", "Trackpoint without a Time; give its time"),
            ("<Trackpoint><Time>noon</Time></Trackpoint>", "time \"noon\" is none; write it as"),
            (
                "<Trackpoint><Time>2026-05-01T10:00:00Z</Time><DistanceMeters>far</DistanceMeters></Trackpoint>",
                "DistanceMeters \"far\" is no number; correct the number",
            ),
            ("<Trackpoint>", "; export the activity again"),
            ("", "no sample with a time; export"),
        ] {
            let said = read_activity_bytes(document(points).as_bytes()).unwrap_err().to_string();
            assert!(said.contains(expected), "{said}");
        }
    }
}
