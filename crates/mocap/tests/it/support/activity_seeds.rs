//! A small activity in every format, written here.

use std::fmt::Write as _;

/// Seconds of the activity.
const SECONDS: u32 = 24;

/// Heart rate, power, speed and height of a second.
fn second(i: u32) -> (u32, u32, f64, f64) {
    let t = f64::from(i);
    (90 + i, 100 + 5 * (i % 7), 2.0 + 0.05 * t, 120.0 + 0.1 * t)
}

/// The names and bytes of the samples.
pub fn written() -> Vec<(&'static str, Vec<u8>)> {
    vec![
        ("activity-csv-00", csv(',', "power_w,heart_rate").into_bytes()),
        ("activity-csv-01", csv(';', "speed;grade;cadence").into_bytes()),
        ("activity-csv-02", csv('\t', "work").into_bytes()),
        ("tcx-00", tcx().into_bytes()),
        ("gpx-00", gpx().into_bytes()),
        ("fit-00", fit(false)),
        ("fit-01", fit(true)),
    ]
}

fn csv(separator: char, columns: &str) -> String {
    let mut text = format!("# made here\ntime{separator}{columns}\n");
    for i in 0..SECONDS {
        let (heart, power, speed, _) = second(i);
        let _ = write!(text, "{i}");
        for column in columns.split(separator) {
            let value = match column {
                "power_w" => power.to_string(),
                "heart_rate" if i % 5 == 4 => String::new(),
                "heart_rate" => heart.to_string(),
                "speed" => format!("{speed}").replace('.', ","),
                "grade" => "0,02".to_owned(),
                "work" => format!("{speed}"),
                _ => "80".to_owned(),
            };
            let _ = write!(text, "{separator}{value}");
        }
        text.push('\n');
    }
    text
}

fn tcx() -> String {
    let mut text = String::from(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<TrainingCenterDatabase xmlns=\"u\">\n\
         <Activities><Activity Sport=\"Biking\"><Lap><Track>\n",
    );
    for i in 0..SECONDS {
        let (heart, power, speed, height) = second(i);
        let _ = writeln!(
            text,
            "<Trackpoint><Time>2026-05-01T10:00:{i:02}.000Z</Time><AltitudeMeters>{height}</AltitudeMeters>\
             <DistanceMeters>{}</DistanceMeters><HeartRateBpm><Value>{heart}</Value></HeartRateBpm>\
             <Extensions><ns3:TPX><ns3:Speed>{speed}</ns3:Speed><ns3:Watts>{power}</ns3:Watts></ns3:TPX>\
             </Extensions></Trackpoint>",
            3 * i
        );
    }
    text + "</Track></Lap></Activity></Activities>\n</TrainingCenterDatabase>\n"
}

fn gpx() -> String {
    let mut text = String::from(
        "<?xml version=\"1.0\"?>\n<gpx version=\"1.1\"><trk><name>a &amp; b</name><type>running</type><trkseg>\n",
    );
    for i in 0..SECONDS {
        let (heart, _, _, height) = second(i);
        let _ = writeln!(
            text,
            "<trkpt lat=\"{:.6}\" lon=\"2.3\"><ele>{height}</ele><time>2026-05-01T10:00:{i:02}Z</time>\
             <extensions><gpxtpx:TrackPointExtension><gpxtpx:hr>{heart}</gpxtpx:hr>\
             </gpxtpx:TrackPointExtension></extensions></trkpt>",
            48.8 + 3e-5 * f64::from(i)
        );
    }
    text + "</trkseg></trk></gpx>\n"
}

/// A file of little or big end first; the latter with developers' fields and compressed times.
fn fit(big: bool) -> Vec<u8> {
    let word = |value: u16| if big { value.to_be_bytes() } else { value.to_le_bytes() };
    let long = |value: u32| if big { value.to_be_bytes() } else { value.to_le_bytes() };
    let mut messages = vec![if big { 0x60 } else { 0x40 }, 0, u8::from(big)];
    messages.extend(word(20));
    messages.extend([5, 253, 4, 0x86, 3, 1, 2, 7, 2, 0x84, 73, 4, 0x86, 5, 4, 0x86]);
    if big {
        messages.extend([1, 0, 3, 0]);
        // Heart rate alone, its time in the message's head.
        messages.extend([0x41, 0, 1]);
        messages.extend(word(20));
        messages.extend([1, 3, 1, 2]);
    }
    for i in 0..SECONDS {
        let (heart, power, speed, _) = second(i);
        let time = 1_100_000_000 + i;
        if big && i % 4 == 3 {
            messages.extend([0x80 | 1 << 5 | (time % 32) as u8, heart as u8]);
            continue;
        }
        messages.push(0);
        messages.extend(long(time));
        messages.push(heart as u8);
        messages.extend(word(power as u16));
        messages.extend(long((1000.0 * speed) as u32));
        messages.extend(long(300 * i));
        if big {
            messages.extend([1, 2, 3]);
        }
    }
    let mut all = vec![14, 0x20, 0x54, 0x08];
    all.extend((messages.len() as u32).to_le_bytes());
    all.extend(b".FIT");
    all.extend(checksum(&all).to_le_bytes());
    all.extend(messages);
    all.extend(checksum(&all).to_le_bytes());
    all
}

/// CRC-16 of polynomial 0xA001.
pub fn checksum(bytes: &[u8]) -> u16 {
    bytes.iter().fold(0, |crc: u16, byte| {
        (0..8).fold(
            crc ^ u16::from(*byte),
            |crc, _| {
                if crc & 1 == 1 { crc >> 1 ^ 0xA001 } else { crc >> 1 }
            },
        )
    })
}
