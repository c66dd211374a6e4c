//! `mimique deposit --upload` against mocks of the documented interfaces of Zenodo and Dataverse, which fail in the middle:
//! what was begun goes on, checksums are compared, the token goes into one header and nowhere else.

#![allow(clippy::result_large_err, reason = "answers of the mocks are both")]

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::process::{Command, Output};
use std::sync::{Arc, Mutex};

use axum::body::Bytes;
use axum::extract::{DefaultBodyLimit, Multipart, Path as Place, Query, State};
use axum::http::{HeaderMap, StatusCode};
use axum::response::{IntoResponse, Response};
use axum::routing::{get, post, put};
use axum::{Json, Router};
use md5::{Digest as _, Md5};
use mimique_test_support::repository;
use serde_json::{Value, json};

use crate::support::{files, ok, text};

const TOKEN: &str = "s3cretTokenOfNobody";

/// What a mock holds, and what it is told to do wrong.
#[derive(Default)]
struct Held {
    files: BTreeMap<String, Vec<u8>>,
    metadata: Value,
    made: usize,
    published: bool,
    requests: Vec<String>,
    /// Requests that fail, by what their line contains: how often, with which status.
    faults: Vec<(&'static str, usize, u16)>,
    /// Files whose answer says another checksum.
    damaged: Option<&'static str>,
    /// Files that are stored though the answer is an error.
    lost_answers: Vec<&'static str>,
    authorized: Vec<bool>,
}

type Mock = Arc<Mutex<Held>>;

/// Whether the request goes on; it is noted in any case.
fn asked(mock: &Mock, line: &str, headers: &HeaderMap) -> Result<(), Response> {
    let mut held = mock.lock().unwrap();
    held.requests.push(line.to_owned());
    let bearer = headers.get("authorization").map(|value| value == &format!("Bearer {TOKEN}"));
    let key = headers.get("x-dataverse-key").map(|value| value == TOKEN);
    let is_known = bearer.or(key).unwrap_or(false);
    held.authorized.push(is_known);
    if !is_known {
        let given = headers.get("authorization").map(|value| value.to_str().unwrap_or_default());
        let said = json!({ "message": format!("unknown: {given:?}") });
        return Err((StatusCode::UNAUTHORIZED, Json(said)).into_response());
    }
    let fault = held.faults.iter_mut().find(|(what, left, _)| line.contains(what) && *left > 0);
    if let Some((_, left, status)) = fault {
        *left -= 1;
        let status = StatusCode::from_u16(*status).unwrap();
        let said = Json(json!({ "message": "busy" }));
        return Err((status, [("retry-after", "0")], said).into_response());
    }
    Ok(())
}

fn md5(bytes: &[u8]) -> String {
    hex::encode(Md5::digest(bytes))
}

/// A mock that listens, its address, and what holds it open.
fn listening(router: Router<Mock>, mock: &Mock) -> (String, tokio::runtime::Runtime) {
    let runtime = tokio::runtime::Runtime::new().unwrap();
    let listener = runtime.block_on(tokio::net::TcpListener::bind("127.0.0.1:0")).unwrap();
    let address = format!("http://{}", listener.local_addr().unwrap());
    let router = router.layer(DefaultBodyLimit::disable()).with_state(Arc::clone(mock));
    runtime.spawn(async move { axum::serve(listener, router).await });
    (address, runtime)
}

fn zenodo(mock: &Mock) -> (String, tokio::runtime::Runtime) {
    async fn make(State(mock): State<Mock>, headers: HeaderMap) -> Result<Response, Response> {
        asked(&mock, "POST depositions", &headers)?;
        let mut held = mock.lock().unwrap();
        held.made += 1;
        Ok((StatusCode::CREATED, Json(deposition(&held, &headers))).into_response())
    }
    async fn look(State(mock): State<Mock>, headers: HeaderMap) -> Result<Response, Response> {
        asked(&mock, "GET deposition", &headers)?;
        let held = mock.lock().unwrap();
        Ok(Json(deposition(&held, &headers)).into_response())
    }
    async fn describe(
        State(mock): State<Mock>,
        headers: HeaderMap,
        Json(body): Json<Value>,
    ) -> Result<Response, Response> {
        asked(&mock, "PUT metadata", &headers)?;
        let mut held = mock.lock().unwrap();
        held.metadata = body["metadata"].clone();
        Ok(Json(deposition(&held, &headers)).into_response())
    }
    async fn list(State(mock): State<Mock>, headers: HeaderMap) -> Result<Response, Response> {
        asked(&mock, "GET files", &headers)?;
        let held = mock.lock().unwrap();
        let file = |(name, bytes): (&String, &Vec<u8>)| json!({ "filename": name, "filesize": bytes.len(), "checksum": md5(bytes) });
        Ok(Json(held.files.iter().map(file).collect::<Vec<_>>()).into_response())
    }
    async fn keep(
        State(mock): State<Mock>,
        Place((_, name)): Place<(String, String)>,
        headers: HeaderMap,
        bytes: Bytes,
    ) -> Result<Response, Response> {
        asked(&mock, &format!("PUT {name}"), &headers)?;
        let mut held = mock.lock().unwrap();
        let length: usize = headers["content-length"].to_str().unwrap().parse().unwrap();
        assert_eq!(length, bytes.len());
        let said = if held.damaged == Some(&*name) { md5(b"other") } else { md5(&bytes) };
        held.files.insert(name.clone(), bytes.to_vec());
        let said = json!({ "key": name, "size": length, "checksum": format!("md5:{said}") });
        Ok((StatusCode::CREATED, Json(said)).into_response())
    }
    async fn publish(State(mock): State<Mock>, headers: HeaderMap) -> Result<Response, Response> {
        asked(&mock, "POST publish", &headers)?;
        let mut held = mock.lock().unwrap();
        held.published = true;
        Ok((StatusCode::ACCEPTED, Json(deposition(&held, &headers))).into_response())
    }
    fn deposition(held: &Held, headers: &HeaderMap) -> Value {
        let host = headers["host"].to_str().unwrap();
        json!({
            "id": 42, "submitted": held.published,
            "links": {
                "bucket": format!("http://{host}/api/files/b0c4"),
                "html": format!("http://{host}/deposit/42"),
                "record_html": format!("http://{host}/records/42"),
            },
        })
    }
    let own = "/api/deposit/depositions/42";
    let router = Router::new()
        .route("/api/deposit/depositions", post(make))
        .route(own, get(look).put(describe))
        .route(&format!("{own}/files"), get(list))
        .route(&format!("{own}/actions/publish"), post(publish))
        .route("/api/files/{bucket}/{name}", put(keep));
    listening(router, mock)
}

fn dataverse(mock: &Mock) -> (String, tokio::runtime::Runtime) {
    const ID: &str = "doi:10.5072/FK2/MOCK";
    async fn make(
        State(mock): State<Mock>,
        Place(alias): Place<String>,
        headers: HeaderMap,
        Json(body): Json<Value>,
    ) -> Result<Response, Response> {
        asked(&mock, "POST dataset", &headers)?;
        if alias != "faces" {
            let said = json!({ "status": "ERROR", "message": "no such collection" });
            return Err((StatusCode::NOT_FOUND, Json(said)).into_response());
        }
        let mut held = mock.lock().unwrap();
        held.made += 1;
        held.metadata = body;
        let said = json!({ "status": "OK", "data": { "id": 7, "persistentId": ID } });
        Ok((StatusCode::CREATED, Json(said)).into_response())
    }
    async fn add(
        State(mock): State<Mock>,
        Query(query): Query<BTreeMap<String, String>>,
        headers: HeaderMap,
        mut form: Multipart,
    ) -> Result<Response, Response> {
        assert_eq!(query["persistentId"], ID);
        let (mut about, mut name, mut bytes) = (Value::Null, String::new(), Vec::new());
        while let Some(field) = form.next_field().await.unwrap() {
            if field.name() == Some("jsonData") {
                about = serde_json::from_str(&field.text().await.unwrap()).unwrap();
            } else {
                name = field.file_name().unwrap().to_owned();
                bytes = field.bytes().await.unwrap().to_vec();
            }
        }
        assert_eq!(about["tabIngest"], "false");
        let path = match about["directoryLabel"].as_str().unwrap() {
            "" => name,
            folder => format!("{folder}/{name}"),
        };
        asked(&mock, &format!("ADD {path}"), &headers)?;
        let mut held = mock.lock().unwrap();
        assert!(held.files.insert(path.clone(), bytes).is_none(), "{path} is added twice");
        if held.lost_answers.contains(&&*path) {
            return Err((StatusCode::BAD_GATEWAY, [("retry-after", "0")]).into_response());
        }
        Ok(Json(json!({ "status": "OK" })).into_response())
    }
    async fn list(State(mock): State<Mock>, headers: HeaderMap) -> Result<Response, Response> {
        asked(&mock, "GET files", &headers)?;
        let held = mock.lock().unwrap();
        let file = |(path, bytes): (&String, &Vec<u8>)| {
            let (folder, name) = path.rsplit_once('/').unwrap_or(("", path));
            let checksum = json!({ "type": "MD5", "value": md5(bytes) });
            let data = json!({ "filesize": bytes.len(), "checksum": checksum });
            json!({ "label": name, "directoryLabel": folder, "dataFile": data })
        };
        let all: Vec<Value> = held.files.iter().map(file).collect();
        Ok(Json(json!({ "status": "OK", "data": all })).into_response())
    }
    async fn look(State(mock): State<Mock>, headers: HeaderMap) -> Result<Response, Response> {
        asked(&mock, "GET dataset", &headers)?;
        let word = if mock.lock().unwrap().published { "RELEASED" } else { "DRAFT" };
        Ok(Json(json!({ "data": { "latestVersion": { "versionState": word } } })).into_response())
    }
    async fn publish(State(mock): State<Mock>, headers: HeaderMap) -> Result<Response, Response> {
        asked(&mock, "POST publish", &headers)?;
        mock.lock().unwrap().published = true;
        Ok(Json(json!({ "status": "OK" })).into_response())
    }
    let own = "/api/datasets/:persistentId";
    let router = Router::new()
        .without_v07_checks()
        .route("/api/dataverses/{alias}/datasets", post(make))
        .route(&format!("{own}/add"), post(add))
        .route(&format!("{own}/versions/:latest/files"), get(list))
        .route(&format!("{own}/"), get(look))
        .route(&format!("{own}/actions/:publish"), post(publish));
    listening(router, mock)
}

/// A place with an export of the demonstration.
struct Bench {
    place: tempfile::TempDir,
    export: PathBuf,
}

impl Bench {
    fn new() -> Self {
        let place = tempfile::tempdir().unwrap();
        let out = place.path().join("answers");
        let demo = text(&repository().join("study-config/demo.json"));
        ok(&["simulate", &demo, "-n", "2", "--out", &text(&out)]);
        Self { export: out.join("demo_responses.csv"), place }
    }

    fn out(&self) -> PathBuf {
        self.place.path().join("deposit")
    }

    fn deposit(&self, more: &[&str], token: Option<(&str, &str)>) -> Output {
        let packs = std::env::temp_dir().join("mimique-deposit-test-packs");
        let mut command = Command::new(env!("CARGO_BIN_EXE_mimique"));
        command.env_remove("MIMIQUE_DATA").env_remove("ZENODO_TOKEN").env_remove("DATAVERSE_TOKEN");
        command.args(["deposit", &text(&repository().join("study-config/demo.json"))]);
        command.arg(&self.export).arg("--out").arg(self.out()).arg("--packs").arg(packs);
        command.args(["--drop", "start_time,end_time", "--no-stimuli", "--date", "2026-11-27"]);
        if let Some((name, token)) = token {
            command.env(name, token);
        }
        command.args(more).output().unwrap()
    }
}

/// Standard output of a command that must succeed; the token is in nothing that it says.
fn said(output: &Output) -> String {
    let err = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(0), "{err}");
    without_token(output);
    String::from_utf8_lossy(&output.stdout).into_owned()
}

/// Standard error of a command that must refuse.
fn refusal(output: &Output) -> String {
    let err = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{err}");
    without_token(output);
    err
}

fn without_token(output: &Output) {
    for bytes in [&output.stdout, &output.stderr] {
        assert!(!String::from_utf8_lossy(bytes).contains(TOKEN));
    }
}

fn count(mock: &Mock, what: &str) -> usize {
    mock.lock().unwrap().requests.iter().filter(|line| line.contains(what)).count()
}

const ZENODO: Option<(&str, &str)> = Some(("ZENODO_TOKEN", TOKEN));
const DATAVERSE: Option<(&str, &str)> = Some(("DATAVERSE_TOKEN", TOKEN));

#[test]
fn without_upload_every_request_is_told_and_none_is_made() {
    let bench = Bench::new();
    let mock = Mock::default();
    let (host, _runtime) = zenodo(&mock);
    let told = said(&bench.deposit(&["--to", "zenodo", "--host", &host], ZENODO));
    for words in [
        "nothing was sent",
        "POST /api/deposit/depositions",
        "PUT /api/files/{bucket}/demo.zip",
        "\"upload_type\":\"dataset\"",
    ] {
        assert!(told.contains(words), "{words}: {told}");
    }
    assert_eq!(mock.lock().unwrap().requests.len(), 0);
    let told = said(&bench.deposit(&["--to", "zenodo"], None));
    assert!(told.contains("https://sandbox.zenodo.org"), "{told}");
    let told = said(&bench.deposit(&["--to", "zenodo", "--real"], None));
    assert!(told.contains("https://zenodo.org"), "{told}");
    let told = said(&bench.deposit(&["--to", "dataverse"], None));
    assert!(
        told.contains("https://demo.dataverse.org")
            && told.contains("psych-ds/data/study-demo_data.csv"),
        "{told}"
    );
    let err = refusal(&bench.deposit(&["--to", "zenodo", "--upload"], None));
    assert!(err.contains("ZENODO_TOKEN") && err.contains("tokens/new"), "{err}");
    let err = refusal(&bench.deposit(&["--to", "zenodo", "--host", "http://example.org"], None));
    assert!(err.contains("https://data.example.org"), "{err}");
}

#[test]
fn zenodo_gets_all_of_it_through_faults_and_once() {
    let bench = Bench::new();
    let mock = Mock::default();
    let (host, _runtime) = zenodo(&mock);
    let upload = ["--to", "zenodo", "--host", &host, "--upload"];
    // It fails in the middle, more often than is borne.
    mock.lock().unwrap().faults = vec![("PUT CITATION.cff", 5, 503), ("POST depositions", 1, 429)];
    let err = refusal(&bench.deposit(&upload, ZENODO));
    assert!(
        err.contains("CITATION.cff: 503 busy, 5 times") && err.contains("goes on where"),
        "{err}"
    );
    assert_eq!(count(&mock, "POST depositions"), 2, "once refused for its rate");
    let zip = "PUT demo.zip";
    assert_eq!(count(&mock, zip), 1);
    assert!(bench.out().with_file_name("deposit.upload.json").is_file());
    // It goes on: what is there is not sent again.
    let told = said(&bench.deposit(&upload, ZENODO));
    assert!(told.contains("3 files sent, 2 were there; every checksum is right"), "{told}");
    assert!(told.contains("/deposit/42"), "{told}");
    assert_eq!((count(&mock, zip), mock.lock().unwrap().made), (1, 1));
    assert!(!mock.lock().unwrap().published, "nothing is published unasked");
    let held = mock.lock().unwrap();
    assert_eq!(held.metadata["license"], "cc-by-4.0");
    assert_eq!(
        held.files["CITATION.cff"],
        std::fs::read(bench.out().join("CITATION.cff")).unwrap()
    );
    let mut archive =
        zip::ZipArchive::new(std::io::Cursor::new(held.files["demo.zip"].clone())).unwrap();
    assert!(archive.by_name("demo/psych-ds/data/study-demo_data.csv").is_ok());
    assert!(held.authorized.iter().all(|known| *known));
    drop((archive, held));
    let told = said(&bench.deposit(&[&upload[..], &["--publish"]].concat(), ZENODO));
    assert!(told.contains("0 files sent, 5 were there") && told.contains("/records/42"), "{told}");
    assert!(mock.lock().unwrap().published);
    // What is published is published; changed files would be another version.
    said(&bench.deposit(&[&upload[..], &["--publish"]].concat(), ZENODO));
    assert_eq!(count(&mock, "POST publish"), 1);
    let err = refusal(&bench.deposit(&[&upload[..], &["--title", "Another"]].concat(), ZENODO));
    assert!(err.contains("new version"), "{err}");
}

#[test]
fn damage_on_the_way_and_a_wrong_token_are_told() {
    let bench = Bench::new();
    let mock = Mock::default();
    let (host, _runtime) = zenodo(&mock);
    let upload = ["--to", "zenodo", "--host", &host, "--upload"];
    let err = refusal(&bench.deposit(&upload, Some(("ZENODO_TOKEN", "another"))));
    assert!(err.contains("401") && err.contains("make one at this very host"), "{err}");
    assert!(!err.contains("Bearer another"), "who says the token back is not repeated: {err}");
    mock.lock().unwrap().damaged = Some("README.md");
    let err = refusal(&bench.deposit(&upload, ZENODO));
    assert!(err.contains("README.md: MD5") && err.contains("arrived where"), "{err}");
    mock.lock().unwrap().damaged = None;
    // Something else in the draft is not published along.
    mock.lock().unwrap().files.insert("mine.txt".into(), b"mine".to_vec());
    let err = refusal(&bench.deposit(&[&upload[..], &["--publish"]].concat(), ZENODO));
    assert!(err.contains("mine.txt") && !mock.lock().unwrap().published, "{err}");
    let other = Mock::default();
    let (elsewhere, _runtime) = zenodo(&other);
    let err =
        refusal(&bench.deposit(&["--to", "zenodo", "--host", &elsewhere, "--upload"], ZENODO));
    assert!(err.contains("was begun from this folder"), "{err}");
    assert_eq!(other.lock().unwrap().requests.len(), 0);
}

#[test]
fn dataverse_gets_each_file_in_its_folder_through_faults_and_once() {
    let bench = Bench::new();
    let mock = Mock::default();
    let (host, _runtime) = dataverse(&mock);
    let upload = ["--to", "dataverse", "--host", &host, "--upload", "--collection", "faces"];
    let err =
        refusal(&bench.deposit(&["--to", "dataverse", "--host", &host, "--upload"], DATAVERSE));
    assert!(err.contains("no collection \"root\""), "{err}");
    {
        let mut held = mock.lock().unwrap();
        held.faults = vec![("ADD report/report.html", 5, 500), ("ADD bids/README.md", 1, 503)];
        held.lost_answers = vec!["LICENSE.md"];
    }
    let err = refusal(&bench.deposit(&upload, DATAVERSE));
    assert!(err.contains("500 busy, 5 times"), "{err}");
    let before = mock.lock().unwrap().files.len();
    assert!(before > 5, "{before}");
    let told = said(&bench.deposit(&[&upload[..], &["--publish"]].concat(), DATAVERSE));
    assert!(told.contains(&format!("{before} were there")), "{told}");
    let held = mock.lock().unwrap();
    assert_eq!(held.made, 1);
    assert!(held.published);
    let local = files(&bench.out());
    assert_eq!(held.files, local, "every file, in its folder");
    let fields =
        held.metadata["datasetVersion"]["metadataBlocks"]["citation"]["fields"].as_array().unwrap();
    let names: Vec<&str> = fields.iter().map(|field| field["typeName"].as_str().unwrap()).collect();
    for name in ["title", "author", "datasetContact", "dsDescription", "subject"] {
        assert!(names.contains(&name), "Dataverse asks for {name}: {names:?}");
    }
    assert_eq!(held.metadata["datasetVersion"]["license"]["name"], "CC BY 4.0");
}
