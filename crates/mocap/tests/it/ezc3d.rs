//! C3D against ezc3d, the reader most laboratories use: it reads what we write, and reads the real
//! files as we do.

use std::path::{Path, PathBuf};
use std::process::Command;

use mimique_geometry::Point;
use mimique_mocap::{C3dOptions, C3dStorage, Capture, LengthUnit, Processor, read, write_c3d};
use mimique_test_support::{python, real_data};

/// Prints rate, unit, labels, then every coordinate as the bits of a double, frame by frame; a
/// point with a negative residual is missing.
const SCRIPT: &str = r#"
import sys, struct, numpy, ezc3d
c = ezc3d.c3d(sys.argv[1])
p = c["parameters"]["POINT"]
labels, n = [], 1
while True:
    name = "LABELS" + ("" if n == 1 else str(n))
    if name not in p: break
    labels += p[name]["value"]
    n += 1
points = c["data"]["points"][:3].astype(float)
residual = c["data"]["meta_points"]["residuals"][0]
points[:, residual < 0] = numpy.nan
print(repr(float(p["RATE"]["value"][0])))
print(p["UNITS"]["value"][0] if len(p["UNITS"]["value"]) else "")
print("\t".join(labels[:points.shape[1]]))
print(points.shape[2], c["header"]["points"]["first_frame"])
out = points.transpose(2, 1, 0).astype("<f8")
out.tofile(sys.argv[2])
"#;

/// What ezc3d says of a file.
struct Theirs {
    rate_hz: f64,
    unit: String,
    labels: Vec<String>,
    frames: usize,
    positions: Vec<[f64; 3]>,
}

fn theirs(python: &Path, file: &Path, folder: &Path) -> Theirs {
    let numbers = folder.join("points.f64");
    let out = Command::new(python).args(["-c", SCRIPT]).arg(file).arg(&numbers).output().unwrap();
    assert!(out.status.success(), "{}", String::from_utf8_lossy(&out.stderr));
    let text = String::from_utf8(out.stdout).unwrap();
    let lines: Vec<&str> = text.lines().collect();
    let bytes = std::fs::read(&numbers).unwrap();
    let values: Vec<f64> =
        bytes.as_chunks::<8>().0.iter().map(|b| f64::from_le_bytes(*b)).collect();
    Theirs {
        rate_hz: lines[0].parse().unwrap(),
        unit: lines[1].to_owned(),
        labels: lines[2].split('\t').map(|l| l.trim().to_owned()).collect(),
        frames: lines[3].split(' ').next().unwrap().parse().unwrap(),
        positions: values.as_chunks::<3>().0.to_vec(),
    }
}

/// The same markers in the same places; missing in both or in neither. Returns markers compared.
fn compare(ours: &Capture, theirs: &Theirs) -> usize {
    assert!((ours.rate_hz - theirs.rate_hz).abs() < 1e-3, "{} {}", ours.rate_hz, theirs.rate_hz);
    assert_eq!(ours.frames(), theirs.frames);
    let columns = theirs.positions.len() / theirs.frames;
    for (marker, label) in ours.labels.iter().enumerate() {
        let column = theirs.labels.iter().position(|l| l == label).expect(label);
        for frame in 0..ours.frames() {
            let (p, q) = (ours.frame(frame)[marker], theirs.positions[frame * columns + column]);
            let zero = q == [0.0; 3] && p[0].is_nan();
            let missing = p[0].is_nan() && q.iter().any(|v| v.is_nan());
            assert!(p == q || missing || zero, "{label}, frame {frame}: {p:?} {q:?}");
        }
    }
    ours.labels.len()
}

fn planted(markers: usize, frames: usize) -> Capture {
    let positions = (0..markers * frames).map(|i| {
        let v = i as f64;
        let missing = i % 17 == 3;
        if missing {
            Point::UNSEEN
        } else {
            Point::new(v * 0.0625 + 1.0, 900.5 - v * 0.125, (v * 0.5) % 300.0)
        }
    });
    Capture {
        labels: (0..markers).map(|m| format!("marker number {m} of the face")).collect(),
        rate_hz: 120.0,
        first_frame: 12,
        unit: LengthUnit::Millimetre,
        positions: positions.collect(),
        notes: Vec::new(),
    }
}

#[test]
fn ezc3d_reads_what_is_written() {
    let Some(python) = python("ezc3d_reads_what_is_written") else { return };
    let folder = tempfile::tempdir().unwrap();
    let integer = C3dStorage::Integer { scale: 0.0625 };
    for (markers, frames, processor, storage) in [
        (41, 60, Processor::Intel, C3dStorage::Float),
        // ezc3d reads DEC and MIPS by their own rules of byte order.
        (41, 60, Processor::Intel, integer),
        (300, 5, Processor::Intel, C3dStorage::Float),
        (520, 3, Processor::Intel, C3dStorage::Float),
    ] {
        let capture = planted(markers, frames);
        let file = folder.path().join(format!("{markers}-{frames}.c3d"));
        let options = C3dOptions { processor, storage };
        std::fs::write(&file, write_c3d(&capture, &options).unwrap()).unwrap();
        let theirs = theirs(&python, &file, folder.path());
        assert_eq!(theirs.unit, "mm");
        assert_eq!(theirs.labels, capture.labels);
        assert_eq!(compare(&capture, &theirs), markers);
    }
}

#[test]
fn real_files_are_the_same_in_ezc3d() {
    let test = "real_files_are_the_same_in_ezc3d";
    let (Some(python), Some(data)) = (python(test), real_data(test)) else { return };
    let folder = tempfile::tempdir().unwrap();
    let files = [
        "c3d/Qualisys.c3d",
        "c3d/Vicon.c3d",
        "c3d/kinematics_tennis_serve.c3d",
        "animface/CheeksMoCap.c3d",
        "animface/JawMoCap.c3d",
        "lsts/take_n01.c3d",
    ];
    for file in files {
        let path: PathBuf = data.join(file);
        let ours = read(&path).unwrap();
        let markers = compare(&ours, &theirs(&python, &path, folder.path()));
        eprintln!("{file}: {markers} markers, {} frames, equal", ours.frames());
    }
}
