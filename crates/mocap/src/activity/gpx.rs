//! GPX: track points with time, place and height, and in their extensions heart rate, power, speed.

use super::rows::{Rows, Sample};
use super::tcx::{opens_with, sport_of};
use super::xml::{Step, instant, number, place, walk, wrong};
use super::{Activity, ActivityColumn, ActivityFormat, Read, Recognise};
use crate::ReadError;
use crate::formats::source::Source;

pub(super) static FORMAT: ActivityFormat = ActivityFormat {
    id: "gpx",
    name: "GPX",
    recognised_by: "`<gpx`",
    reads: "heart rate, power, speed (or the way over 10 s), grade by height and way over 30 s",
    recognise: Recognise::Beginning(|bytes| opens_with(bytes, b"<gpx")),
    read: Read::Bytes(read),
};

/// Mean radius of the earth, m (IUGG).
const EARTH_M: f64 = 6_371_008.8;

fn read(source: &mut dyn Source) -> Result<Activity, ReadError> {
    let mut rows = Rows::default();
    let mut point: Option<(Option<f64>, Sample)> = None;
    let mut before: Option<[f64; 2]> = None;
    let mut way = 0.0;
    walk(source, |step| {
        match step {
            Step::Opened { path, attributes, byte } => {
                if path.last().is_some_and(|name| name == "trkpt") {
                    let mut sample = Sample::at(place(byte), 0.0);
                    if let Some(here) = coordinates(attributes, byte)? {
                        way += before.map_or(0.0, |before| distance_m(before, here));
                        before = Some(here);
                        sample.distance_m = way;
                    }
                    point = Some((None, sample));
                }
            }
            Step::Closed { path, text, byte } => {
                let name = path.last().map_or("", String::as_str);
                if name == "trkpt" {
                    let Some((time, mut sample)) = point.take() else { return Ok(()) };
                    sample.time_s = time.ok_or_else(|| {
                        let remedy = "give a recorded track; a planned route has no times";
                        wrong(byte, "trkpt without a time".to_owned(), remedy)
                    })?;
                    return rows.push(sample);
                }
                if name == "type" && path.iter().any(|name| name == "trk") {
                    rows.sport = rows.sport.or(sport_of(text));
                }
                let Some((time, sample)) = &mut point else { return Ok(()) };
                let column = match name {
                    "hr" | "heartrate" => ActivityColumn::HeartRate,
                    "power" | "PowerInWatts" => ActivityColumn::PowerW,
                    "speed" => ActivityColumn::Speed,
                    "time" => {
                        *time = Some(instant(text, byte)?);
                        return Ok(());
                    }
                    "ele" => {
                        sample.altitude_m = number(text, name, byte)?;
                        return Ok(());
                    }
                    _ => return Ok(()),
                };
                sample.set(column, number(text, name, byte)?);
            }
        }
        Ok(())
    })?;
    rows.of_device(&FORMAT)
}

/// Latitude and longitude, degrees.
fn coordinates(attributes: &[(String, String)], byte: u64) -> Result<Option<[f64; 2]>, ReadError> {
    let of = |key: &str, most: f64| -> Result<Option<f64>, ReadError> {
        let Some((_, text)) = attributes.iter().find(|(own, _)| own == key) else {
            return Ok(None);
        };
        let value = number(text, key, byte)?;
        if value.abs() > most {
            let what = format!("{key} {value}, where the earth has -{most} to {most} degrees");
            return Err(wrong(byte, what, "correct the place"));
        }
        Ok(Some(value))
    };
    Ok(of("lat", 90.0)?.zip(of("lon", 180.0)?).map(|(lat, lon)| [lat, lon]))
}

/// The way between two places on the ground (haversines).
fn distance_m([lat_a, lon_a]: [f64; 2], [lat_b, lon_b]: [f64; 2]) -> f64 {
    let haversine = |degrees: f64| {
        let sine = libm::sin(degrees.to_radians() / 2.0);
        sine * sine
    };
    let level = libm::cos(lat_a.to_radians()) * libm::cos(lat_b.to_radians());
    let h = haversine(lat_b - lat_a) + level * haversine(lon_b - lon_a);
    2.0 * EARTH_M * libm::asin(h.sqrt().min(1.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::read_activity_bytes;

    fn document(points: &str) -> String {
        format!(
            "<gpx version=\"1.1\"><trk><type>running</type><trkseg>{points}</trkseg></trk></gpx>\n"
        )
    }

    #[test]
    fn a_degree_of_latitude_is_111_km_everywhere_and_one_of_longitude_at_the_equator() {
        for ([a, b], want) in [
            ([[0.0, 0.0], [1.0, 0.0]], 111_195.0),
            ([[0.0, 10.0], [0.0, 11.0]], 111_195.0),
            ([[60.0, 10.0], [60.0, 11.0]], 55_597.0),
            ([[90.0, 0.0], [-90.0, 0.0]], 20_015_114.0),
        ] {
            assert!((distance_m(a, b) / want - 1.0).abs() < 1e-4, "{a:?} {b:?}");
        }
    }

    #[test]
    fn a_run_over_the_ground_has_its_speed() {
        // 3 m/s to the north, up 3 in 100.
        let points: String = (0..60)
            .map(|i| {
                let way = 3.0 * f64::from(i);
                format!(
                    "<trkpt lat=\"{:.9}\" lon=\"2\"><ele>{}</ele><time>2026-05-01T10:00:{i:02}.000Z</time>\
                     <extensions><gpxtpx:hr>120</gpxtpx:hr><power>0</power></extensions></trkpt>",
                    48.0 + (way / EARTH_M).to_degrees(),
                    0.03 * way
                )
            })
            .collect();
        let activity = read_activity_bytes(document(&points).as_bytes()).unwrap();
        assert_eq!(activity.sport, Some(crate::Sport::OnFoot));
        for (column, want) in [
            (ActivityColumn::Speed, 3.0),
            (ActivityColumn::Grade, 0.03),
            (ActivityColumn::HeartRate, 120.0),
        ] {
            let own = activity.column(column).unwrap();
            assert!(own.iter().all(|value| (value - want).abs() < 1e-4), "{column:?}: {own:?}");
        }
    }

    #[test]
    fn errors_name_byte_value_and_remedy() {
        for (points, expected) in [
            ("<trkpt lat=\"1\" lon=\"2\"></trkpt>", "trkpt without a time; give a recorded track"),
            ("<trkpt lat=\"91\" lon=\"2\"/>", "lat 91, where the earth has -90 to 90 degrees"),
            ("<trkpt lat=\"x\" lon=\"2\"/>", "lat \"x\" is no number"),
        ] {
            let said = read_activity_bytes(document(points).as_bytes()).unwrap_err().to_string();
            assert!(said.starts_with("byte ") && said.contains(expected), "{said}");
        }
    }
}
