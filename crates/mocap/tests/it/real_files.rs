//! The readers on files of real systems, found in `MIMIQUE_DATA` (default `../shared/data`).

use mimique_mocap::{
    Capture, CaptureFacts, LengthUnit, ReadOptions, Recording, WeightOptions, read, read_recording,
    read_weights,
};
use mimique_test_support::real_data;
use std::path::PathBuf;

fn recording(path: PathBuf) -> Recording {
    let bytes = std::fs::read(&path).unwrap();
    read_recording(&bytes, &ReadOptions::default()).unwrap()
}

/// Largest distance between the same markers of two captures, in metres; missing must match.
fn largest_difference(a: &Capture, b: &Capture) -> f64 {
    assert_eq!((&a.labels, a.frames()), (&b.labels, b.frames()));
    a.positions
        .iter()
        .zip(&b.positions)
        .map(|(p, q)| {
            assert_eq!(p[0].is_nan(), q[0].is_nan());
            (0..3)
                .map(|k| (p[k] * a.unit.metres() - q[k] * b.unit.metres()).abs())
                .fold(0.0, f64::max)
        })
        .fold(0.0, f64::max)
}

#[test]
fn lsts_take_is_the_same_from_csv_and_c3d() {
    let Some(data) = real_data("lsts_take_is_the_same_from_csv_and_c3d") else { return };
    let csv = read(&data.join("lsts/take_n01.csv")).unwrap();
    let c3d = read(&data.join("lsts/take_n01.c3d")).unwrap();
    for capture in [&csv, &c3d] {
        assert_eq!((capture.labels.len(), capture.frames()), (46, 5660));
        assert_eq!((capture.rate_hz, capture.unit), (200.0, LengthUnit::Millimetre));
    }
    assert_eq!((csv.first_frame, c3d.first_frame), (0, 1));
    assert_eq!(csv.positions[0], [50.1730, 1611.3685, 268.8729]);
    // Floats of 32 bits hold 1.6 m to 0.1 micrometre; the CSV has four decimals of a millimetre.
    let difference = largest_difference(&csv, &c3d);
    assert!(difference < 1.2e-7, "{difference} m");
}

#[test]
fn animface_takes_are_the_same_in_centimetres_and_millimetres() {
    let Some(data) = real_data("animface_takes_are_the_same_in_centimetres_and_millimetres") else {
        return;
    };
    for (take, frames) in [("Cheeks", 1499), ("Jaw", 1590)] {
        let csv = read(&data.join(format!("animface/{take}MoCap.csv"))).unwrap();
        let c3d = read(&data.join(format!("animface/{take}MoCap.c3d"))).unwrap();
        assert_eq!((csv.unit, c3d.unit), (LengthUnit::Centimetre, LengthUnit::Millimetre));
        assert_eq!((csv.rate_hz, c3d.rate_hz), (60.0, 60.0));
        assert_eq!((csv.labels.len(), csv.frames()), (41, frames));
        assert_eq!(csv.labels[0], "ForeHead_M");
        let difference = largest_difference(&csv, &c3d);
        assert!(difference < 1e-7, "{take}: {difference} m");
    }
}

#[test]
fn qualisys_vicon_and_motive_files_are_read() {
    let Some(data) = real_data("qualisys_vicon_and_motive_files_are_read") else { return };
    let qualisys = recording(data.join("c3d/Qualisys.c3d"));
    assert_eq!(qualisys.system.as_deref(), Some("Qualisys Track Manager 2.17.3720"));
    assert_eq!((qualisys.analog_channels, qualisys.events.len()), (69, 7));
    assert_eq!(qualisys.events[1].label, "RTO");
    assert!((qualisys.events[1].time_s - 3.685).abs() < 1e-6);
    let capture = &qualisys.capture;
    assert_eq!((capture.labels.len(), capture.frames(), capture.first_frame), (55, 340, 705));
    assert_eq!((capture.rate_hz, capture.labels[0].as_str()), (200.0, "L_IAS"));

    let vicon = recording(data.join("c3d/Vicon.c3d"));
    assert_eq!(vicon.system.as_deref(), Some("Vicon Nexus 2.4.0.91647h"));
    assert_eq!((vicon.capture.labels.len(), vicon.capture.frames()), (51, 580));
    assert_eq!((vicon.analog_channels, vicon.capture.first_frame), (38, 1));

    let motive = recording(data.join("c3d/kinematics_tennis_serve.c3d"));
    assert_eq!(motive.system.as_deref(), Some("OptiTrack Motive 2.2.0 Final"));
    assert_eq!((motive.capture.labels.len(), motive.capture.frames()), (39, 1092));
    assert_eq!(motive.capture.unit, LengthUnit::Metre);
    assert_eq!(motive.capture.labels[0], "Derrick:C7");
}

#[test]
fn live_link_takes_are_weights_at_30_hz() {
    let Some(data) = real_data("live_link_takes_are_weights_at_30_hz") else { return };
    for name in ["alex_rom_3.csv", "facial.csv"] {
        let path = data.join("livelink").join(name);
        let bytes = std::fs::read(&path).unwrap();
        let take = read_weights(&bytes, &WeightOptions::default()).unwrap();
        let rate_hz = take.rate_hz().unwrap();
        assert!(take.shape_names.len() == 61 && (rate_hz - 30.0).abs() < 1e-9);
        let dropped: usize = take.filled.iter().map(|(from, to)| to - from).sum();
        eprintln!("{name}: {} frames, {dropped} of them filled in", take.frames.len());
        let rows = bytes.iter().filter(|b| **b == b'\n').count() - 1;
        assert_eq!(take.frames.len() - dropped, rows);
        assert_eq!(
            read(&path).unwrap_err().to_string(),
            "byte 0: Live Link Face CSV (weights) holds no marker; \
             give it as weights, not as a capture"
        );
    }
}

#[test]
fn facts_of_real_takes() {
    let Some(data) = real_data("facts_of_real_takes") else { return };
    for name in ["lsts/take_n01.csv", "animface/JawMoCap.c3d", "animface/CheeksMoCap.csv"] {
        let facts = CaptureFacts::of(&recording(data.join(name)));
        assert!(facts.extent_m.is_some_and(|e| (0.1..0.4).contains(&e)), "{:?}", facts.extent_m);
        assert!(facts.presence.iter().all(|m| m.gaps == 0));
        assert!(facts.swaps.is_empty(), "{name}: {:?}", facts.swaps);
        eprintln!("{name}: {:?} {:?}", facts.stillest, facts.warnings);
    }
    let vicon = CaptureFacts::of(&recording(data.join("c3d/Vicon.c3d")));
    let missing: usize = vicon.presence.iter().map(|m| vicon.frames - m.present).sum();
    assert_eq!(missing, 305, "as ezc3d counts them");
    eprintln!("Vicon: {:?}", vicon.warnings);
}
