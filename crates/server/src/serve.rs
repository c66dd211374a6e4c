//! Runs the server until it is told to stop; then lets requests in progress end.

use std::future::Future;
use std::io;
use std::time::Duration;

use tokio::net::TcpListener;

use crate::app::App;
use crate::routes::router;

/// Requests in progress have this long to end after the signal.
const LONGEST_FAREWELL: Duration = Duration::from_secs(10);

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
    let (stopping, mut stopped) = tokio::sync::watch::channel(false);
    let pulse = app.pulse.clone();
    tokio::spawn(follow_uploads(app.clone()));
    let server = axum::serve(listener, router(app.clone())).with_graceful_shutdown(async move {
        stop.await;
        // An open dashboard would never end by itself.
        pulse.stop();
        stopping.send_replace(true);
    });
    let overdue = async {
        // An error says that the sender has gone: the server has ended by itself.
        if stopped.wait_for(|stopping| *stopping).await.is_ok() {
            tokio::time::sleep(LONGEST_FAREWELL).await;
        } else {
            std::future::pending::<()>().await;
        }
    };
    let outcome = tokio::select! {
        outcome = server => outcome.map_err(ServeError::from),
        () = overdue => Ok(()),
    };
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
