//! Arrays as NumPy writes them, and as they are not.

use super::*;
use crate::{read_weights, read_weights_file, recognise, weights_files};

fn names() -> Vec<String> {
    ["jawOpen", "browInnerUp", "odd, \"name\""].map(str::to_owned).to_vec()
}

fn options(names: &[String]) -> WeightOptions<'_> {
    WeightOptions { rate_hz: Some(60.0), shape_names: names, animation: None }
}

/// An array of 2 x 3 that holds 0.0, 0.5, 1.0, ...
fn array(version: [u8; 2], descr: &str, fortran: bool) -> Vec<u8> {
    let order = if fortran { "True" } else { "False" };
    let text = format!("{{'descr': '{descr}', 'fortran_order': {order}, 'shape': (2, 3), }}\n");
    let mut bytes = [MAGIC, &version].concat();
    match version[0] {
        1 => bytes.extend((text.len() as u16).to_le_bytes()),
        _ => bytes.extend((text.len() as u32).to_le_bytes()),
    }
    bytes.extend(text.into_bytes());
    let places: [usize; 6] = if fortran { [0, 3, 1, 4, 2, 5] } else { [0, 1, 2, 3, 4, 5] };
    for place in places {
        let w = place as f64 / 2.0;
        match descr {
            "<f4" => bytes.extend((w as f32).to_le_bytes()),
            ">f4" => bytes.extend((w as f32).to_be_bytes()),
            ">f8" => bytes.extend(w.to_be_bytes()),
            _ => bytes.extend(w.to_le_bytes()),
        }
    }
    bytes
}

#[test]
fn every_version_type_and_order_gives_the_same_weights() {
    for version in [[1, 0], [2, 0], [3, 0]] {
        for descr in ["<f4", ">f4", "<f8", ">f8"] {
            for fortran in [false, true] {
                let bytes = array(version, descr, fortran);
                assert_eq!(recognise(&bytes).map(|f| f.id), Some("npy"));
                let table = read_weights(&bytes, &options(&names())).unwrap();
                assert_eq!(table.shape_names, names());
                assert_eq!(table.weights, [0.0, 0.5, 1.0, 1.5, 2.0, 2.5]);
                assert_eq!((table.frames, table.times[1]), (vec![0, 1], 1.0 / 60.0));
            }
        }
    }
}

#[test]
fn what_is_written_reads_back_with_names_rate_and_first_frame() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("w.npy");
    let weights = vec![0.1, -0.0, 1.0 / 3.0, 2e-17, 1.0, -0.25];
    let table = WeightsTable::at_rate(names(), weights, 705, 50.0);
    for (path, bytes) in weights_files(&table, &path).unwrap() {
        std::fs::write(path, bytes).unwrap();
    }
    assert_eq!(read_weights_file(&path, &WeightOptions::default()).unwrap(), table);
    let faster = WeightOptions { rate_hz: Some(100.0), ..WeightOptions::default() };
    assert_eq!(read_weights_file(&path, &faster).unwrap().times[1], 0.01);
    for (text, what) in [
        ("{", "w.shapes.json"),
        (r#"{"shape_names": ["a"], "rate_hz": 60}"#, "3 columns, NAME.shapes.json has 1 names"),
        (r#"{"shape_names": ["a", "b", "a"], "rate_hz": 60}"#, "shape \"a\" empty or twice"),
        (r#"{"shape_names": ["a", "b", "c"]}"#, "no rate"),
        (r#"{"shape_names": ["a", "b", "c"], "rate_hz": 0}"#, "rate_hz: 0"),
        (r#"{"shape_names": ["a", "b", "c"], "rate": 60}"#, "unknown field `rate`"),
    ] {
        std::fs::write(Beside::path(&path), text).unwrap();
        let error = read_weights_file(&path, &WeightOptions::default()).unwrap_err().to_string();
        assert!(error.contains(what) && error.contains("; "), "{text}: {error}");
    }
}

#[test]
fn what_is_wrong_is_named_with_its_byte() {
    let whole = array([1, 0], "<f8", false);
    let changed = |from: &str, to: &str| {
        let text = whole.iter().map(|&b| char::from(b)).collect::<String>();
        assert!(text.contains(from));
        text.replacen(from, to, 1).chars().map(|c| c as u8).collect::<Vec<u8>>()
    };
    let mut nan = whole.clone();
    let last = nan.len() - 8;
    nan[last..].copy_from_slice(&f64::NAN.to_le_bytes());
    let place = format!("byte {last}, data: row 1, column 2 (odd, \"name\"): NaN");
    let cut = whole[..whole.len() - 1].to_vec();
    let longer = [&whole[..], &[0]].concat();
    for (bytes, start) in [
        (array([4, 0], "<f8", false), "byte 6, header: format 4.0"),
        (changed("<f8", "<i8"), "byte 10, header: numbers of type \"<i8\""),
        (changed("(2, 3)", "(2,3,)"), ""),
        (changed("(2, 3)", "(6,  )"), "byte 10, header: an array of shape [6]"),
        (changed("(2, 3)", "(6, 0)"), "byte 10, header: an array of shape [6, 0]"),
        (changed("(2, 3)", "(9, 9)"), "byte "),
        (changed("'descr'", "'dscr' "), "byte 10, header: \"{'dscr'"),
        (cut, "byte "),
        (longer, "byte "),
        (nan, &place),
        (whole[..9].to_vec(), "byte 9, header: the file ends after 9 bytes"),
    ] {
        match read_weights(&bytes, &options(&names())) {
            Ok(_) => assert_eq!(start, "", "{start}"),
            Err(error) => {
                let error = error.to_string();
                assert!(!start.is_empty() && error.starts_with(start), "{error}");
                assert!(error.contains("; "), "{error}");
            }
        }
    }
    let four: Vec<String> = (0..4).map(|k| k.to_string()).collect();
    for (names, what) in [(&four[..], "the avatar has 4 shapes"), (&[], "are not known")] {
        let error = read_weights(&whole, &options(names)).unwrap_err().to_string();
        assert!(error.contains(what) && error.contains("NAME.shapes.json"), "{error}");
    }
}

/// NumPy reads what is written, and what NumPy writes is read, bit for bit.
#[test]
fn numpy_and_this_reader_agree() {
    let Some(python) = mimique_test_support::python("numpy_and_this_reader_agree") else {
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let table =
        WeightsTable::at_rate(names(), vec![0.1, -0.5, 1.0 / 3.0, 2e-17, 1.0, 0.0], 0, 60.0);
    for (path, bytes) in weights_files(&table, &folder.path().join("ours.npy")).unwrap() {
        std::fs::write(path, bytes).unwrap();
    }
    let script = "
import numpy, numpy.lib.format as f, sys
a = numpy.load(sys.argv[1] + '/ours.npy')
assert a.dtype == '<f8' and a.shape == (2, 3), (a.dtype, a.shape)
n = 0
for version in [(1, 0), (2, 0), (3, 0)]:
    for descr in ['<f4', '>f4', '<f8', '>f8']:
        for order in 'CF':
            b = numpy.array(a, dtype=descr, order=order)
            with open(f'{sys.argv[1]}/theirs-{n}.npy', 'wb') as out:
                f.write_array(out, b, version=version)
            b.astype('<f8').tofile(f'{sys.argv[1]}/theirs-{n}.bits')
            n += 1
print(n)
";
    let out = std::process::Command::new(python)
        .args(["-c", script])
        .arg(folder.path())
        .output()
        .unwrap();
    assert!(out.status.success(), "{}", String::from_utf8_lossy(&out.stderr));
    assert_eq!(String::from_utf8_lossy(&out.stdout).trim(), "24");
    for n in 0..24 {
        let file = |ending: &str| folder.path().join(format!("theirs-{n}.{ending}"));
        let bits = std::fs::read(file("bits")).unwrap();
        let want: Vec<f64> =
            bits.as_chunks::<8>().0.iter().map(|b| f64::from_le_bytes(*b)).collect();
        let read = read_weights_file(&file("npy"), &options(&names())).unwrap();
        assert_eq!(read.weights, want, "{n}");
    }
}
