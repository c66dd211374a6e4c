//! A server without a socket, and short words to ask it.

use std::future::Future;

use axum::Router;
use axum::body::{Body, to_bytes};
use axum::http::{HeaderMap, Method, Request, StatusCode, header};
use mimique_server::{App, HostedStudy, router};
use mimique_session::wire::{
    Acknowledged, Event, Receipt, Refusal, Resume, SessionStarted, Withdrawn,
};
use mimique_storage::Storage;
use serde::de::DeserializeOwned;
use serde_json::{Value, json};
use tower::ServiceExt;

use crate::study;

/// Runs a test's future on a runtime like the server's.
pub fn block_on<T>(future: impl Future<Output = T>) -> T {
    tokio::runtime::Builder::new_multi_thread()
        .worker_threads(2)
        .enable_all()
        .build()
        .unwrap()
        .block_on(future)
}

/// A server on a database.
pub struct TestServer {
    url: String,
    pub app: App,
    pub storage: Storage,
    router: Router,
    _folder: Option<tempfile::TempDir>,
}

/// An answer, read to its end.
pub struct Answer {
    pub status: StatusCode,
    pub headers: HeaderMap,
    pub body: Vec<u8>,
}

impl Answer {
    pub fn json<T: DeserializeOwned>(&self) -> T {
        serde_json::from_slice(&self.body)
            .unwrap_or_else(|error| panic!("{error} in {} {}", self.status, self.text()))
    }

    pub fn text(&self) -> String {
        String::from_utf8_lossy(&self.body).into_owned()
    }

    /// The refusal that this must be.
    pub fn refused(&self, status: StatusCode, code: &str) -> Refusal {
        assert_eq!(self.status, status, "{}", self.text());
        let refusal: Refusal = self.json();
        assert_eq!(refusal.code, code, "{refusal:?}");
        assert!(!refusal.message.is_empty() && !refusal.remedy.is_empty(), "{refusal:?}");
        refusal
    }

    pub fn ok<T: DeserializeOwned>(&self) -> T {
        assert_eq!(self.status, StatusCode::OK, "{}", self.text());
        self.json()
    }

    pub fn header(&self, name: impl header::AsHeaderName) -> &str {
        self.headers.get(name).map_or("", |value| value.to_str().unwrap())
    }
}

impl TestServer {
    pub async fn open(url: &str) -> Self {
        Self::open_with(url, vec![study::hosted(), study::demo()]).await
    }

    pub async fn open_with(url: &str, studies: Vec<HostedStudy>) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let storage = Storage::open(url).await.unwrap();
        let app = App::new(
            studies,
            study::packs(folder.path()),
            study::assets(folder.path()),
            storage.clone(),
        )
        .await
        .unwrap();
        let router = router(app.clone());
        Self { url: url.to_owned(), app, storage, router, _folder: Some(folder) }
    }

    /// The same server reached otherwise.
    pub fn with_router(&self, router: Router) -> Self {
        let (app, storage) = (self.app.clone(), self.storage.clone());
        Self { url: self.url.clone(), app, storage, router, _folder: None }
    }

    /// The answer as it comes, its body not read.
    pub async fn stream(&self, request: Request<Body>) -> axum::response::Response {
        self.router.clone().oneshot(request).await.unwrap()
    }

    /// This server with other settings.
    pub fn with_settings(&self, settings: mimique_server::Settings) -> Self {
        let app = self.app.clone().with_settings(settings);
        let (url, storage) = (self.url.clone(), self.storage.clone());
        let router = router(app.clone());
        Self { url, app, storage, router, _folder: None }
    }

    pub fn url(&self) -> &str {
        &self.url
    }

    /// Runs a statement on the database behind the server's back.
    pub async fn run_sql(&self, statement: &'static str) {
        use sqlx::{Connection, Executor};
        if self.url.starts_with("postgres") {
            let mut connection = sqlx::PgConnection::connect(&self.url).await.unwrap();
            connection.execute(statement).await.unwrap();
        } else {
            let mut connection = sqlx::SqliteConnection::connect(&self.url).await.unwrap();
            connection.execute(statement).await.unwrap();
        }
    }

    /// Stops this server and starts another one on the same database.
    pub async fn restart(&self) -> Self {
        self.storage.close().await;
        Self::open(&self.url).await
    }

    /// The same with other studies.
    pub async fn restart_with(&self, studies: Vec<HostedStudy>) -> Self {
        self.storage.close().await;
        Self::open_with(&self.url, studies).await
    }

    pub async fn send(&self, request: Request<Body>) -> Answer {
        let response = self.router.clone().oneshot(request).await.unwrap();
        let (parts, body) = response.into_parts();
        let body = to_bytes(body, usize::MAX).await.unwrap().to_vec();
        Answer { status: parts.status, headers: parts.headers, body }
    }

    pub async fn get(&self, path: &str) -> Answer {
        self.get_with(path, &[]).await
    }

    pub async fn get_with(&self, path: &str, headers: &[(header::HeaderName, &str)]) -> Answer {
        let mut request = Request::get(path);
        for (name, value) in headers {
            request = request.header(name, *value);
        }
        self.send(request.body(Body::empty()).unwrap()).await
    }

    pub async fn post(&self, path: &str, body: Value) -> Answer {
        let request = Request::builder()
            .method(Method::POST)
            .uri(path)
            .header(header::CONTENT_TYPE, "application/json")
            .body(Body::from(body.to_string()))
            .unwrap();
        self.send(request).await
    }

    /// Starts a session of a participant known by `nonce`.
    pub async fn start(&self, nonce: u64) -> SessionStarted {
        self.start_in("faces", nonce).await
    }

    pub async fn start_in(&self, study: &str, nonce: u64) -> SessionStarted {
        let body = json!({
            "nonce": format!("{nonce:032x}"),
            "language": "en",
            "recruitment": {"PROLIFIC_PID": format!("person {nonce}"), "utm_source": "elsewhere"},
            "client": {"browser": "Firefox", "version": "140"},
        });
        self.post(&format!("/api/studies/{study}/sessions"), body).await.ok()
    }

    pub async fn append(&self, session: &str, events: &[Event]) -> Answer {
        self.post(&format!("/api/sessions/{session}/events"), json!({"events": events})).await
    }

    pub async fn stored(&self, session: &str, events: &[Event]) -> Acknowledged {
        self.append(session, events).await.ok()
    }

    pub async fn resume(&self, session: &str) -> Resume {
        self.get(&format!("/api/sessions/{session}")).await.ok()
    }

    pub async fn complete(&self, session: &str, events: u64) -> Answer {
        self.post(&format!("/api/sessions/{session}/complete"), json!({"events": events})).await
    }

    pub async fn receipt(&self, session: &str, events: u64) -> Receipt {
        self.complete(session, events).await.ok()
    }

    pub async fn withdraw(&self, session: &str, code: &str) -> Answer {
        let body = json!({"withdrawal_code": code});
        self.post(&format!("/api/sessions/{session}/withdraw"), body).await
    }

    pub async fn withdrawn(&self, session: &str, code: &str) -> Withdrawn {
        self.withdraw(session, code).await.ok()
    }
}

/// The event with this sequence: an answer that says which it is.
pub fn event(sequence: u64) -> Event {
    Event {
        sequence,
        // Not a whole number: the time must come back bit for bit.
        at_ms: 1_700_000_000_000.1 + sequence as f64 / 3.0,
        body: json!({
            "type": "answered", "step": "how", "question": "mood",
            "value": sequence % 7 + 1, "note": "é\u{0} \"quoted\"",
        }),
    }
}

/// Events with sequences from `first` up to `end`.
pub fn events(sequences: std::ops::Range<u64>) -> Vec<Event> {
    sequences.map(event).collect()
}
