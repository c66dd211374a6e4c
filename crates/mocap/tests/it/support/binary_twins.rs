//! Twins of the formats that are no lines of text: C3D, NumPy's arrays and JSON, changed where a number or
//! a name stands.

use super::twins::Twin;

/// The twins of a file.
pub fn twins(id: &str, bytes: &[u8]) -> Vec<Twin> {
    match id {
        "c3d" => c3d(bytes),
        "npy" | "npy-vertices" => npy(bytes),
        "npz" => npz(bytes),
        "arkit-json" | "audio2face-json" | "mediapipe-json" => json(bytes),
        other => panic!("no twins of {other}"),
    }
}

fn patched(bytes: &[u8], at: usize, by: &[u8]) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    bytes[at..at + by.len()].copy_from_slice(by);
    bytes
}

fn twin(benign: bool, name: impl Into<String>, bytes: Vec<u8>) -> Twin {
    Twin { name: name.into(), bytes, benign }
}

/// Where the name of a parameter ends.
fn after(bytes: &[u8], name: &str) -> usize {
    let found = bytes.windows(name.len()).position(|window| window == name.as_bytes());
    found.unwrap_or_else(|| panic!("no {name}")) + name.len()
}

/// Numbers as the file's processor writes them.
struct Numbers {
    code: u8,
}

impl Numbers {
    fn word(&self, value: u16) -> [u8; 2] {
        if self.code == 86 { value.to_be_bytes() } else { value.to_le_bytes() }
    }

    fn float(&self, value: f32) -> [u8; 4] {
        match self.code {
            84 => value.to_le_bytes(),
            86 => value.to_be_bytes(),
            _ => {
                let [a, b, c, d] = (value * 4.0).to_le_bytes();
                [c, d, a, b]
            }
        }
    }
}

fn c3d(bytes: &[u8]) -> Vec<Twin> {
    let numbers = Numbers { code: bytes[515] };
    // A scalar's data follow its offset (2 bytes), its type and the number of its dimensions.
    let scalar = |name: &str| after(bytes, name) + 4;
    let word = |at: usize, value: u16| patched(bytes, at, &numbers.word(value));
    let float = |at: usize, value: f32| patched(bytes, at, &numbers.float(value));
    let (used, frames) = (scalar("USED"), scalar("FRAMES"));
    let (scale, rate) = (scalar("SCALE"), scalar("RATE"));
    let unit = after(bytes, "UNITS") + 6;
    let label = after(bytes, "LABELS") + 6;
    let mut twins = vec![
        twin(true, "zeros at the end", [bytes, &[0; 512]].concat()),
        twin(false, "points of the header", word(2, 2)),
        twin(false, "points of the parameters", word(used, 2)),
        twin(false, "points of the parameters: more", word(used, 4)),
        twin(false, "no points", word(used, 0)),
        twin(false, "analog numbers of the header", word(4, 3)),
        twin(false, "first frame", word(6, 5)),
        twin(false, "last frame: fewer", word(8, 10)),
        twin(false, "last frame: more", word(8, 400)),
        twin(false, "last frame before the first", word(8, 1)),
        twin(false, "frames of the parameters: fewer", word(frames, 10)),
        twin(false, "frames of the parameters: more", word(frames, 40)),
        twin(false, "data elsewhere", word(16, 2)),
        twin(false, "data behind the end", word(16, 2000)),
        twin(false, "scale of the header", float(12, 0.25)),
        twin(false, "scale of the parameters", float(scale, 0.25)),
        twin(false, "scale of the parameters: floats", float(scale, -1.0)),
        twin(false, "scale 0", float(scale, 0.0)),
        twin(false, "unit unknown", patched(bytes, unit, b"xy")),
        twin(false, "unit missing", patched(bytes, unit, b"  ")),
        twin(false, "unit wrong", patched(bytes, unit, b"m ")),
        twin(false, "label missing", patched(bytes, label, b"          ")),
        twin(false, "label repeated", patched(bytes, label, b"brow right")),
        twin(false, "cut in the header", bytes[..300].to_vec()),
        twin(false, "cut in the parameters", bytes[..700].to_vec()),
        twin(false, "two files in one", bytes.repeat(2)),
        twin(
            false,
            "another processor",
            patched(bytes, 515, &[if numbers.code == 84 { 86 } else { 84 }]),
        ),
        twin(false, "no processor", patched(bytes, 515, &[7])),
    ];
    for (what, value) in
        [("0", 0.0), ("below 0", -100.0), ("NaN", f32::NAN), ("half", 50.0), ("huge", 1e9)]
    {
        twins.push(twin(false, format!("rate of the header: {what}"), float(20, value)));
        twins.push(twin(false, format!("rate of the parameters: {what}"), float(rate, value)));
        let both = patched(&float(20, value), rate, &numbers.float(value));
        // A whole file at another rate is another file; zero and what is no number are none.
        if what != "half" {
            twins.push(twin(false, format!("rate of both: {what}"), both));
        }
    }
    // Data that fill their last block to the last frame lose some.
    let data = 1024 + 16 * 3 * 2;
    twins.push(twin(false, "cut in the data", bytes[..data].to_vec()));
    twins
}

fn npy(bytes: &[u8]) -> Vec<Twin> {
    let replaced = |what: &str, by: &str| {
        assert_eq!(what.len(), by.len());
        let at = after(bytes, what) - what.len();
        patched(bytes, at, by.as_bytes())
    };
    let has = |what: &str| bytes.windows(what.len()).any(|window| window == what.as_bytes());
    let mut twins = vec![
        twin(false, "a byte less", bytes[..bytes.len() - 1].to_vec()),
        twin(false, "a byte more", [bytes, &[0]].concat()),
        twin(false, "cut in the header", bytes[..40].to_vec()),
        twin(false, "two files in one", bytes.repeat(2)),
        twin(false, "another version", patched(bytes, 6, &[9])),
        twin(false, "not finite", {
            let end = bytes.len();
            patched(bytes, end - 4, &[0xff; 4])
        }),
    ];
    for (name, what, by) in [
        ("frames too many", "(3, 4, 3)", "(4, 4, 3)"),
        ("vertices too few", "(3, 4, 3)", "(3, 3, 3)"),
        ("axes too few", "(3, 4, 3)", "(3, 6, 2)"),
        ("rows too many", "(2, 4)", "(3, 4)"),
        ("columns too few", "(2, 4)", "(2, 3)"),
        ("of rank 1", "(2, 4)", "(8,)  "),
        ("rows and columns change places", "(2, 4)", "(4, 2)"),
        ("integers", "<f8", "<i8"),
        ("objects", "<f8", "|O "),
        ("half of the width", "<f8", "<f4"),
        ("keys of another case", "descr", "DESCR"),
    ] {
        if has(what) {
            twins.push(twin(false, name, replaced(what, by)));
        }
    }
    if has("\"descr\"") || has("'descr'") {
        twins.push(twin(true, "other quotes", {
            let header = bytes.iter().rposition(|b| *b == b'}').map_or(0, |at| at + 1);
            let quote = |b: &u8| if *b == b'\'' { b'"' } else { *b };
            bytes[..header].iter().map(quote).chain(bytes[header..].iter().copied()).collect()
        }));
    }
    twins
}

fn json(bytes: &[u8]) -> Vec<Twin> {
    let text = std::str::from_utf8(bytes).unwrap();
    let mut twins = vec![
        twin(true, "byte order mark", [b"\xef\xbb\xbf", bytes].concat()),
        twin(true, "blanks before and after", format!("\n  {text}\n\n").into_bytes()),
        twin(true, "lines end in CRLF", text.replace('\n', "\r\n").into_bytes()),
        twin(false, "cut", bytes[..bytes.len() * 2 / 3].to_vec()),
        twin(false, "cut before the last number", {
            let last = bytes.iter().rposition(u8::is_ascii_digit).unwrap();
            bytes[..last].to_vec()
        }),
        twin(false, "two files in one", bytes.repeat(2)),
    ];
    for (benign, name, what, by) in [
        (true, "spaces left out", ": ", ":"),
        (true, "a key more", "{\"weights\"", "{\"x\": {\"y\": []}, \"weights\""),
        (true, "landmarks renamed", "\"displayName\": \"\"", "\"displayName\": \"a\""),
        (false, "shape repeated", "cheekPuff", "jawOpen"),
        (false, "shape repeated", "mouthClose", "jawOpen"),
        (
            false,
            "another shape in a frame",
            "\"categoryName\": \"jawOpen\"",
            "\"categoryName\": \"jawLeft\"",
        ),
        (false, "words for a number", "0.375", "\"much\""),
        (false, "no number", "0.375", "NaN"),
        (false, "null", "0.375", "null"),
        (false, "a number too large", "0.375", "1e999"),
        (false, "a number more", "[0.375, ", "[0.375, 0.25, "),
        (false, "a number less", "[0.375, ", "["),
        (false, "rate 0", "\"exportFps\": 60", "\"exportFps\": 0"),
        (false, "rate below 0", "\"exportFps\": 60", "\"exportFps\": -60"),
        (false, "rate missing", "\"exportFps\": 60", "\"fps\": 60"),
        (false, "frames too many", "\"numFrames\": 5", "\"numFrames\": 6"),
        (false, "shapes too many", "\"numPoses\": 3", "\"numPoses\": 4"),
        (false, "a time far off", "\"time\": 0.04", "\"time\": 4000"),
        (false, "times stand still", "\"time\": 0.04", "\"time\": 0.02"),
        (false, "times stand still", "12.54", "12.52"),
        (false, "times stand still", "\"timestampMs\": 80", "\"timestampMs\": 40"),
        (false, "a time of words", "\"timestampMs\": 80", "\"timestampMs\": \"noon\""),
        (false, "no face", "\"faceBlendshapes\": [{", "\"faces\": [{"),
    ] {
        if text.contains(what) {
            let times = if benign { usize::MAX } else { 1 };
            twins.push(twin(benign, name, text.replacen(what, by, times).into_bytes()));
        }
    }
    twins
}

/// An archive has a sum of every member.
fn npz(bytes: &[u8]) -> Vec<Twin> {
    let at = after(bytes, "NUMPY") + 20;
    let last = bytes.windows(5).rposition(|window| window == b"NUMPY").unwrap() - 1;
    vec![
        twin(false, "cut", bytes[..bytes.len() - 30].to_vec()),
        twin(false, "cut in the first array", bytes[..at].to_vec()),
        twin(false, "two files in one", bytes.repeat(2)),
        twin(false, "a letter of a header", patched(bytes, at, b"#")),
        twin(false, "a number", patched(bytes, last + 130, &[7])),
        twin(false, "no central directory", bytes[..bytes.len() - 22].to_vec()),
    ]
}
