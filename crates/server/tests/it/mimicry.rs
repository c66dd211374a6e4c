//! Studies that measure faces: what their page may use, what is served with its type, tracks exported and deleted.

use std::collections::BTreeMap;

use axum::http::StatusCode;

use mimique_server::export::{Format, Options, courses, export};
use mimique_server::{HostedStudy, Stage};
use mimique_session::flow::Plan;
use mimique_session::wire::Event;
use mimique_study::{ClipSource, MIMICRY_FILES, TRACKED_SHAPES};
use serde_json::{Value, json};

use crate::client::TestServer;
use crate::study;

/// The demonstration with a consent to measuring faces; its files are the only pack.
fn measuring() -> HostedStudy {
    let mut file = study::demo_file();
    file["mimicry"] = json!({
        "consent": { "version": "1", "heading": "Face", "text": "Why." },
        "model": "secret/face_landmarker.task", "runtime": "secret/tasks-vision",
    });
    let hash = study::sha256(&study::pack());
    let source = |media_type: &str| -> ClipSource {
        let source = json!({ "avatar": hash, "operators": "", "take": "", "method": { "method": "recorded" },
            "duration_ms": 0.0, "bytes": 9, "provenance": hash, "weights_hash": "", "video": media_type });
        serde_json::from_value(source).unwrap()
    };
    let clips: BTreeMap<String, ClipSource> =
        MIMICRY_FILES.iter().map(|file| (file.key(), source(file.media_type))).collect();
    HostedStudy::new(file, clips, Stage::Live).unwrap()
}

async fn server(plain: &TestServer) -> TestServer {
    plain.restart_with(vec![study::hosted(), measuring()]).await
}

pub async fn the_camera_is_for_pages_that_measure_alone(plain: &TestServer) {
    let hash = study::sha256(&study::pack());
    // Without such a study nothing is served as a script.
    assert_eq!(plain.get(&format!("/packs/{hash}.js")).await.status, StatusCode::NOT_FOUND);
    let server = server(plain).await;
    let policy = |answer: &crate::client::Answer| answer.header("permissions-policy").to_owned();
    assert!(policy(&server.get("/s/demo/").await).starts_with("camera=(self), microphone=()"));
    for other in ["/s/faces/", "/", "/s/demo/withdraw"] {
        assert!(policy(&server.get(other).await).starts_with("camera=()"), "{other}");
    }
    for (ending, media_type) in [("js", "text/javascript"), ("wasm", "application/wasm")] {
        let answer = server.get(&format!("/packs/{hash}.{ending}")).await;
        assert_eq!(answer.header("content-type"), media_type);
        assert_eq!(answer.text(), study::pack());
    }
    assert_eq!(
        server.get(&format!("/packs/{hash}")).await.header("content-type"),
        "application/octet-stream"
    );
    assert_eq!(server.get(&format!("/packs/{hash}.html")).await.status, StatusCode::NOT_FOUND);
    let bundle = server.get("/api/studies/demo").await;
    let told: Value = bundle.json();
    assert_eq!(told["study"]["mimicry"]["files"]["bundle"], hash);
    assert_eq!(told["study"]["mimicry"]["files"].as_object().unwrap().len(), MIMICRY_FILES.len());
    assert!(!bundle.text().contains("secret/"), "where the researcher's files are is not told");
}

pub async fn tracks_are_exported_and_deleted_with_their_session(plain: &TestServer) {
    let server = server(plain).await;
    let study = measuring();
    for nonce in [1, 2] {
        let started = server.start_in("demo", nonce).await;
        let plan = Plan::new(study.study().projection(), started.clone()).unwrap();
        let step =
            plan.steps.iter().find(|step| step.trial().is_some_and(|own| !own.training)).unwrap();
        let clip = &step.trial().unwrap().clip;
        let scores = |first: u32| [vec![first], vec![0; TRACKED_SHAPES.len() - 1]].concat();
        let frame = |at_ms: f64, first: u32| -> Vec<f64> {
            std::iter::once(at_ms).chain(scores(first).into_iter().map(f64::from)).collect()
        };
        let track = json!({ "status": "tracked", "clock": "capture", "model": "ab",
            "frames": [frame(1.25, 500), [34.0], frame(68.0, 1000)] });
        let log =
            |aborted: Value| json!({ "provenance": "p", "mimicry": track, "aborted": aborted });
        let bodies = [
            json!({ "type": "opened", "client": {}, "language": "en" }),
            json!({ "type": "trial_started", "step": step.id, "clip": clip }),
            json!({ "type": "trial_played", "step": step.id, "log": log(json!("out of view")) }),
            json!({ "type": "trial_played", "step": step.id, "log": log(Value::Null) }),
            json!({ "type": "trial_played", "step": "nowhere", "log": log(Value::Null) }),
        ];
        let events: Vec<Event> = (0..)
            .zip(bodies)
            .map(|(sequence, body)| Event { sequence, at_ms: 1e12 + sequence as f64, body })
            .collect();
        server.stored(&started.session, &events).await;
        if nonce == 1 {
            server.withdrawn(&started.session, &started.withdrawal_code).await;
        }
    }
    let exported =
        export(&server.storage, Some("demo"), Format::Tracks, Options::default()).await.unwrap();
    assert_eq!(exported.files[0].0, "demo_tracks.csv");
    let rows: Vec<BTreeMap<String, String>> =
        csv::Reader::from_reader(&*exported.files[0].1).deserialize().map(Result::unwrap).collect();
    assert_eq!(
        (exported.participants, exported.rows, rows.len()),
        (1, 6, 6),
        "who withdrew is gone, what fits no trial is out"
    );
    let cells = |name: &str| rows.iter().map(|row| row[name].as_str()).collect::<Vec<_>>();
    assert_eq!(cells("participant_id"), ["p0002"; 6]);
    assert_eq!(cells("play"), ["1", "1", "1", "2", "2", "2"]);
    assert_eq!(cells("whole"), ["false", "false", "false", "true", "true", "true"]);
    assert_eq!(cells("time_ms")[..3], ["1.25", "34.0", "68.0"]);
    assert_eq!(cells("face")[..3], ["true", "false", "true"]);
    assert_eq!(cells("_neutral")[..3], ["0.5", "", "1.0"]);
    assert_eq!(cells("jawOpen")[..3], ["0.0", "", "0.0"]);
    let (_, head) = courses(&server.storage, Some("demo")).await.unwrap();
    let head = String::from_utf8(head).unwrap();
    assert!(head.starts_with("stimulus,provenance,time_ms,browDownLeft,"), "{head}");
}
