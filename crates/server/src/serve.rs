//! Runs the server until it is told to stop; then lets requests in progress end.
//!
//! Connections are counted, in all and from each address; a request's head has to arrive within its time,
//! and an answer has to be taken at some rate, so that slow callers hold no more than a place, and not for
//! ever. An idle connection is closed after the same time; browsers open another one when they need it.

use std::future::Future;
use std::io;
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::time::Duration;

use axum::Router;
use axum::extract::Request;
use hyper::body::Incoming;
use hyper::server::conn::http1;
use hyper::service::Service;
use hyper_util::rt::{TokioIo, TokioTimer};
use hyper_util::server::graceful::GracefulShutdown;
use hyper_util::service::TowerToHyperService;
use tokio::net::{TcpListener, TcpStream};

use crate::connections::{Paced, Places};
use crate::http::router;
use crate::researcher::dashboard::keeper;
use crate::retention;
use crate::state::App;
use crate::state::rate_limit::{Peer, Reserve};

/// Requests in progress have this long to end after the signal.
const LONGEST_FAREWELL: Duration = Duration::from_secs(10);
/// A request's head in bytes at most; more is refused with 431.
const LARGEST_HEAD: usize = 32 * 1024;
/// A place that is kept for questions about health is not held for longer.
const RESERVE_TIMEOUT: Duration = Duration::from_secs(2);
/// Headers in a request at most.
const MOST_HEADERS: usize = 64;

/// Studies uploaded to another server on the same database are looked for this often.
const UPLOADS_EVERY: Duration = Duration::from_secs(10);

/// The server had to stop.
#[derive(Debug, thiserror::Error)]
pub enum ServeError {
    /// Connections cannot be accepted any more.
    #[error("the listening socket failed: {0}; start the server again")]
    Socket(#[from] io::Error),
}

/// Answers requests until `stop` resolves; then takes no new connection, waits for the requests in
/// progress, commits what they changed and closes the database.
pub async fn serve(
    app: App,
    listener: TcpListener,
    stop: impl Future<Output = ()> + Send + 'static,
) -> Result<(), ServeError> {
    let following = tokio::spawn(follow_uploads(app.clone()));
    let watching = tokio::spawn(retention::watch(app.clone()));
    let keeping = tokio::spawn(keeper::keep(app.clone()));
    let router = router(app.clone());
    let graceful = GracefulShutdown::new();
    let settings = Arc::clone(&app.settings);
    let places = Places::new(settings.most_connections, settings.connections_per_address);
    let mut stop = std::pin::pin!(stop);
    let outcome = loop {
        let next = async {
            let place = places.next().await;
            (place, listener.accept().await)
        };
        let (place, accepted) = tokio::select! {
            next = next => next,
            () = &mut stop => break Ok(()),
        };
        match accepted {
            Ok((stream, address)) => {
                let peer = Peer(address.ip().to_canonical());
                let place = place.and_then(|place| match settings.is_own(peer.0) {
                    true => Some(place),
                    false => places.of(place, peer.0),
                });
                // Whoever has more than anybody needs gets no more.
                let Some(place) = place else { continue };
                let connection = connection(&app, &router, stream, peer, place.is_reserve);
                let connection = graceful.watch(connection);
                let metrics = Arc::clone(&app.metrics);
                metrics.connections.inc();
                tokio::spawn(async move {
                    // A connection that breaks is the caller's affair.
                    let _ = connection.await;
                    metrics.connections.dec();
                    drop(place);
                });
            }
            Err(error) if is_the_callers(&error) => {}
            // Out of file descriptors, most likely: connections that end make room.
            Err(error) => {
                tracing::warn!("a connection could not be taken: {error}");
                tokio::time::sleep(Duration::from_millis(200)).await;
            }
        }
    };
    app.stopping.store(true, Ordering::Relaxed);
    // An open dashboard would never end by itself.
    app.pulse.stop();
    drop(listener);
    tokio::select! {
        () = graceful.shutdown() => {}
        () = tokio::time::sleep(LONGEST_FAREWELL) => {}
    }
    watching.abort();
    following.abort();
    keeping.abort();
    app.storage.close().await;
    outcome
}

/// Hosts what other servers on the same database were given, and no more what was removed there.
async fn follow_uploads(app: App) {
    loop {
        if let Err(error) = app.host_uploads().await {
            tracing::warn!("uploaded studies cannot be looked for: {error}");
        }
        tokio::select! {
            () = tokio::time::sleep(UPLOADS_EVERY) => {}
            () = app.pulse.stopped() => break,
        }
    }
}

fn connection(
    app: &App,
    router: &Router,
    stream: TcpStream,
    peer: Peer,
    is_reserve: bool,
) -> http1::Connection<TokioIo<Paced<TcpStream>>, Caller> {
    // Answers are short: they should not wait for more to send.
    let _ = stream.set_nodelay(true);
    let service = TowerToHyperService::new(router.clone());
    let stream = Paced::new(stream, app.settings.reader_patience);
    let header_timeout = match is_reserve {
        true => app.settings.header_timeout.min(RESERVE_TIMEOUT),
        false => app.settings.header_timeout,
    };
    http1::Builder::new()
        .timer(TokioTimer::new())
        .header_read_timeout(header_timeout)
        .keep_alive(!is_reserve)
        .max_buf_size(LARGEST_HEAD)
        .max_headers(MOST_HEADERS)
        .serve_connection(TokioIo::new(stream), Caller { service, peer, is_reserve })
}

/// The router, told who is at the other end.
struct Caller {
    service: TowerToHyperService<Router>,
    peer: Peer,
    /// All places are taken: only questions about health are answered.
    is_reserve: bool,
}

impl Service<Request<Incoming>> for Caller {
    type Response = <TowerToHyperService<Router> as Service<Request<Incoming>>>::Response;
    type Error = <TowerToHyperService<Router> as Service<Request<Incoming>>>::Error;
    type Future = <TowerToHyperService<Router> as Service<Request<Incoming>>>::Future;

    fn call(&self, mut request: Request<Incoming>) -> Self::Future {
        request.extensions_mut().insert(self.peer);
        if self.is_reserve {
            request.extensions_mut().insert(Reserve);
        }
        self.service.call(request)
    }
}

fn is_the_callers(error: &io::Error) -> bool {
    use io::ErrorKind::{ConnectionAborted, ConnectionRefused, ConnectionReset};
    matches!(error.kind(), ConnectionAborted | ConnectionRefused | ConnectionReset)
}
