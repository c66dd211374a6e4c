//! Runs the server until it is told to stop; then lets requests in progress end.

use std::future::Future;
use std::io;
use std::time::Duration;

use tokio::net::TcpListener;

use crate::app::App;
use crate::routes::router;

/// Requests in progress have this long to end after the signal.
const LONGEST_FAREWELL: Duration = Duration::from_secs(10);

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
    let server = axum::serve(listener, router(app.clone())).with_graceful_shutdown(async move {
        stop.await;
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
