//! Files of sound, and the sound of clips: told by content, kept by hash, cut where the segment stands.

use std::fs;

use mimique_stimulus::{Places, SoundError, SoundFormat, prepare, read_sound, study_sounds};
use mimique_study::{Study, parse};
use proptest::prelude::*;
use serde_json::{Value, json};

/// 16-bit PCM, one channel, 8000 Hz.
fn wav(seconds: f64) -> Vec<u8> {
    let samples = (seconds * 8000.0).round() as u32;
    let mut bytes = b"RIFF".to_vec();
    bytes.extend((36 + 2 * samples).to_le_bytes());
    bytes.extend(b"WAVEfmt \x10\0\0\0\x01\0\x01\0");
    bytes.extend(8000_u32.to_le_bytes());
    bytes.extend(16_000_u32.to_le_bytes());
    bytes.extend(b"\x02\0\x10\0data");
    bytes.extend((2 * samples).to_le_bytes());
    bytes.extend((0..samples).flat_map(|k| ((k % 100) as i16).to_le_bytes()));
    bytes
}

/// MPEG-1 layer 3, 128 kbit/s, 44100 Hz, one channel: silent frames of 417 bytes, 1152 samples each (ISO 11172-3).
fn mp3(frames: usize) -> Vec<u8> {
    let mut frame = vec![0xff, 0xfb, 0x90, 0xc0];
    frame.resize(417, 0);
    frame.repeat(frames)
}

/// A page of an Ogg stream (RFC 3533, section 6), its sum computed.
fn ogg_page(kind: u8, granule: u64, number: u32, packet: &[u8]) -> Vec<u8> {
    let mut page = b"OggS\0".to_vec();
    page.push(kind);
    page.extend(granule.to_le_bytes());
    page.extend(7_u32.to_le_bytes());
    page.extend(number.to_le_bytes());
    page.extend([0; 4]);
    page.push(1);
    page.push(packet.len() as u8);
    page.extend(packet);
    let mut sum = 0_u32;
    for byte in &page {
        sum ^= u32::from(*byte) << 24;
        for _ in 0..8 {
            sum = (sum << 1) ^ if sum >> 31 == 1 { 0x04c1_1db7 } else { 0 };
        }
    }
    page[22..26].copy_from_slice(&sum.to_le_bytes());
    page
}

/// Opus in Ogg (RFC 7845): head, tags, one packet, 312 samples skipped at the beginning.
fn opus(seconds: f64) -> Vec<u8> {
    let head = b"OpusHead\x01\x01\x38\x01\x80\xbb\0\0\0\0\0";
    let tags = b"OpusTags\x04\0\0\0test\0\0\0\0";
    let granule = (seconds * 48_000.0) as u64 + 312;
    let mut bytes = ogg_page(2, 0, 0, head);
    bytes.extend(ogg_page(0, 0, 1, tags));
    bytes.extend(ogg_page(4, granule, 2, &[0xf8, 0xff, 0xfe]));
    bytes
}

#[test]
fn formats_are_told_by_content_with_their_durations() {
    for (bytes, format, seconds, rate) in [
        (wav(1.5), SoundFormat::Wav, 1.5, 8000),
        (mp3(100), SoundFormat::Mp3, 100.0 * 1152.0 / 44_100.0, 44_100),
        (opus(2.5), SoundFormat::OggOpus, 2.5, 48_000),
    ] {
        let facts = read_sound(&bytes).unwrap_or_else(|error| panic!("{format:?}: {error}"));
        assert_eq!((facts.format, facts.sample_rate_hz, facts.channels), (format, rate, 1));
        assert!((facts.duration_s - seconds).abs() < 0.03, "{format:?}: {}", facts.duration_s);
    }
}

#[test]
fn what_browsers_do_not_decode_is_refused() {
    assert_eq!(read_sound(b"fLaC\0\0\0\x22"), Err(SoundError::Unknown));
    assert_eq!(read_sound(b"a text"), Err(SoundError::Unknown));
    assert_eq!(read_sound(b""), Err(SoundError::Unknown));
    // A-law (format 6) in a WAV, a WAV that ends within its header, one without a sample.
    let mut a_law = wav(1.0);
    a_law[20] = 6;
    for bytes in [a_law, wav(1.0)[..30].to_vec(), wav(0.0)] {
        let error = read_sound(&bytes).unwrap_err();
        assert!(matches!(error, SoundError::Damaged { .. }), "{error}");
    }
}

proptest! {
    #[test]
    fn damaged_files_end_in_an_error_or_in_facts_that_make_sense(
        which in 0..3_usize,
        cut in 0..3000_usize,
        changes in proptest::collection::vec((0..600_usize, any::<u8>()), 0..12),
    ) {
        let mut bytes = [wav(0.1), mp3(6), opus(0.5)][which].clone();
        bytes.truncate(bytes.len().min(cut));
        for (at, byte) in changes {
            if let Some(place) = bytes.get_mut(at) {
                *place = byte;
            }
        }
        if let Ok(facts) = read_sound(&bytes) {
            prop_assert!(facts.duration_s > 0.0 && facts.channels > 0);
        }
    }
}

/// A capture of recorded weights at 50 Hz: 200 frames.
fn weights() -> String {
    let row = |frame: i32| {
        let (time_s, weight) = (f64::from(frame) / 50.0, f64::from(frame % 50) / 100.0);
        format!("{frame},{time_s:.2},{weight:.3}\n")
    };
    format!("frame,time,jawOpen\n{}", (0..200).map(row).collect::<String>())
}

fn study(stimuli: Value) -> Study {
    let text = json!({
        "id": "sound", "studyMetadata": { "title": "Sound", "version": "1" }, "languages": ["en"],
        "components": {}, "sequence": { "order": "fixed", "components": [] }, "stimuli": stimuli,
    });
    Study::from_value(&parse(&text.to_string()).unwrap()).unwrap()
}

/// Two segments of a capture with a sound of its own, and one with its own file.
fn stimuli() -> Value {
    json!({
        "avatars": { "head": { "builtin": { "seed": 1, "vertices": 2000 } } },
        "captures": { "take": { "file": "take.csv", "sound": { "file": "take.wav", "fromS": 0.5 } } },
        "segments": [
            { "id": "first", "capture": "take", "first": 0, "end": 100 },
            { "id": "second", "capture": "take", "first": 100, "end": 200 },
            { "id": "own", "capture": "take", "first": 0, "end": 50, "sound": { "file": "own.mp3", "fromS": 0.25 } },
        ],
        "methods": { "real": { "method": "recorded" } },
        "sounds": {
            "own": {}, "swapped": { "from": { "first": "second" }, "delayMs": 80 }, "none": { "silent": true },
        },
    })
}

fn folder(stimuli: Value) -> (tempfile::TempDir, Study, Places) {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("take.csv"), weights()).unwrap();
    fs::write(folder.path().join("take.wav"), wav(5.0)).unwrap();
    fs::write(folder.path().join("own.mp3"), mp3(100)).unwrap();
    let packs = folder.path().join("packs");
    let places = Places { study: folder.path().to_owned(), data: None, packs };
    (folder, study(stimuli), places)
}

#[test]
fn clips_have_the_sound_of_their_segment_of_another_or_none() {
    let (_folder, study, places) = folder(stimuli());
    let prepared = prepare(&study, &places, &mut |_| ()).unwrap();
    let sound = |id: &str| prepared.clips[id].sound.clone();
    let first = sound("first.real.own").unwrap();
    assert_eq!((first.from_s, first.length_s, first.delay_ms), (0.5, Some(2.0), 0.0));
    assert_eq!(first.media_type, "audio/wav");
    assert_eq!(fs::read(places.packs.join(&first.file)).unwrap(), wav(5.0), "served by its hash");
    let swapped = sound("first.real.swapped").unwrap();
    assert_eq!((swapped.from_s, swapped.length_s, swapped.delay_ms), (2.5, Some(2.0), 80.0));
    let own = sound("own.real.own").unwrap();
    assert_eq!((own.from_s, own.length_s), (0.25, None));
    assert_eq!(own.media_type, "audio/mpeg");
    assert_eq!(sound("first.real.none"), None);
    // The sound is a part of what a clip is made of, of its bytes and of its packs.
    let [with, without] =
        ["own", "none"].map(|rule| &prepared.clips[&format!("first.real.{rule}")]);
    assert_ne!(with.provenance, without.provenance);
    assert_eq!(with.bytes, without.bytes + wav(5.0).len() as u64);
    assert!(with.packs().any(|hash| hash == first.file));
    // What is known is not made anew, and is the same.
    assert_eq!(prepare(&study, &places, &mut |_| ()).unwrap(), prepared);
    let listed = study_sounds(&study, &places);
    let files: Vec<&str> = listed.iter().map(|sound| sound.file.as_str()).collect();
    assert_eq!(files, ["take.wav", "own.mp3"]);
    assert_eq!(listed[1].pointer, "/stimuli/segments/2/sound/file");
}

#[test]
fn a_sound_that_begins_past_its_end_or_is_none_names_place_and_remedy() {
    let mut late = stimuli();
    late["captures"]["take"]["sound"]["fromS"] = json!(4.0);
    let (_folder, study, places) = folder(late);
    let error = prepare(&study, &places, &mut |_| ()).unwrap_err().remove(0);
    assert_eq!(error.pointer, "/stimuli/captures/take/sound/fromS");
    assert!(error.message.contains("begins at 6.000 s, and the sound lasts 5.000 s"), "{error}");
    let mut text = stimuli();
    text["segments"][2]["sound"]["file"] = json!("take.csv");
    let (_folder, study, places) = folder(text);
    let error = prepare(&study, &places, &mut |_| ()).unwrap_err().remove(0);
    assert_eq!(error.pointer, "/stimuli/segments/2/sound/file");
    assert!(error.message.contains("neither WAV, MP3 nor Ogg Opus; export"), "{error}");
}

/// A tone whose pitch goes from one frequency to another within two seconds, then nothing: 8-bit PCM, one channel,
/// 8000 Hz, 5 s.
fn gliding(from_hz: f64, to_hz: f64) -> Vec<u8> {
    let (rate, sounding, samples) = (8000.0, 16_000, 40_000_u32);
    let mut bytes = b"RIFF".to_vec();
    bytes.extend((36 + samples).to_le_bytes());
    bytes.extend(b"WAVEfmt \x10\0\0\0\x01\0\x01\0\x40\x1f\0\0\x40\x1f\0\0\x01\0\x08\0data");
    bytes.extend(samples.to_le_bytes());
    let mut phase = 0.0_f64;
    for k in 0..samples {
        let part = f64::from(k) / f64::from(sounding);
        phase = (phase + (from_hz + (to_hz - from_hz) * part) / rate).fract();
        // A triangle, louder and softer within an eighth of its time.
        let triangle = 4.0 * (phase - 0.5).abs() - 1.0;
        let level = (8.0 * part.min(1.0 - part)).clamp(0.0, 1.0);
        bytes.push((128.0 + 40.0 * level * triangle) as u8);
    }
    bytes
}

/// `MIMIQUE_UPDATE_GOLDEN=1` writes the files anew.
#[test]
fn the_sounds_of_the_repository_are_made_by_code() {
    let folder = mimique_test_support::study_folder().join("sounds");
    for (name, bytes) in
        [("rising.wav", gliding(180.0, 420.0)), ("falling.wav", gliding(260.0, 110.0))]
    {
        if std::env::var_os("MIMIQUE_UPDATE_GOLDEN").is_some() {
            fs::create_dir_all(&folder).unwrap();
            fs::write(folder.join(name), &bytes).unwrap();
        }
        assert_eq!(fs::read(folder.join(name)).unwrap(), bytes, "{name}");
        assert_eq!(read_sound(&bytes).unwrap().duration_s, 5.0);
    }
}
