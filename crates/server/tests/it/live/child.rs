//! The server's process: this test's own program, started again.

use std::io::{BufRead, BufReader};
use std::process::{Child, Command, Stdio};
use std::time::Duration;

use mimique_server::{App, Settings};
use mimique_storage::Storage;

use crate::client::block_on;
use crate::study;

/// Set in the server's process: the database's address.
const DATABASE: &str = "MIMIQUE_LIVE_TEST_DATABASE";
/// The address to listen on.
const LISTEN: &str = "MIMIQUE_LIVE_TEST_LISTEN";
/// How many connections there may be.
pub const CONNECTIONS: &str = "MIMIQUE_LIVE_TEST_CONNECTIONS";
const NAME: &str = "live::child::serve_when_told_to";

/// Serves until it is told to stop, in the process that [`Server::start`] makes; nothing otherwise.
#[test]
fn serve_when_told_to() {
    let Ok(url) = std::env::var(DATABASE) else { return };
    block_on(async {
        let folder = tempfile::tempdir().unwrap();
        let storage = Storage::open(&url).await.unwrap();
        let (assets, packs) = (study::assets(folder.path()), study::packs(folder.path()));
        let settings = Settings {
            // Where connections are counted, none of them is shown out meanwhile.
            header_timeout: match std::env::var(CONNECTIONS) {
                Ok(_) => Duration::from_secs(20),
                Err(_) => Duration::from_millis(700),
            },
            reader_patience: Duration::from_millis(900),
            most_connections: std::env::var(CONNECTIONS)
                .map_or(1000, |count| count.parse().expect("a number")),
            behind_tls: true,
            ..Settings::default()
        };
        let app = App::new(vec![study::hosted()], packs, assets, storage).await.unwrap();
        let listen = std::env::var(LISTEN).unwrap();
        let listener = tokio::net::TcpListener::bind(listen).await.unwrap();
        eprintln!("port {}", listener.local_addr().unwrap().port());
        let mut told =
            tokio::signal::unix::signal(tokio::signal::unix::SignalKind::terminate()).unwrap();
        let stop = async move {
            told.recv().await;
        };
        mimique_server::serve(app.with_settings(settings), listener, stop).await.unwrap();
    });
}

/// A server in a process; gone when dropped, also where the test fails.
pub struct Server {
    child: Child,
    pub port: u16,
}

impl Server {
    /// On a port of its own.
    pub fn start(url: &str) -> Self {
        Self::start_with(url, 0, "")
    }

    /// On this port (any if 0), after a line of shell that bounds what the process may do.
    pub fn start_with(url: &str, port: u16, before: &str) -> Self {
        let child = Command::new("sh")
            .args(["-c", &format!("{before}\nexec \"$0\" \"$@\"")])
            .arg(std::env::current_exe().unwrap())
            .args(["--exact", NAME, "--nocapture"])
            .env(DATABASE, url)
            .env(LISTEN, format!("127.0.0.1:{port}"))
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let mut server = Self { child, port: 0 };
        let mut stderr = BufReader::new(server.child.stderr.take().unwrap());
        let mut said = String::new();
        loop {
            let mut line = String::new();
            if stderr.read_line(&mut line).unwrap_or(0) == 0 {
                panic!("the server did not start: {said}");
            }
            if let Some(port) = line.strip_prefix("port ") {
                // Somebody has to listen to what it says from now on.
                std::thread::spawn(move || std::io::copy(&mut stderr, &mut std::io::sink()));
                server.port = port.trim().parse().unwrap();
                return server;
            }
            said.push_str(&line);
        }
    }

    /// The process's number.
    pub fn id(&self) -> u32 {
        self.child.id()
    }

    /// Asks it to stop and waits until it has.
    pub fn stop(self) {
        self.ask_to_stop();
        assert!(self.wait(), "it ends by itself, all well");
    }

    /// `kill -9`.
    pub fn kill(mut self) {
        self.child.kill().unwrap();
    }

    /// Asks it to stop, as systemd does.
    pub fn ask_to_stop(&self) {
        let pid = self.child.id().to_string();
        assert!(Command::new("kill").args(["-TERM", &pid]).status().unwrap().success());
    }

    /// Waits for its end; whether all was well.
    pub fn wait(mut self) -> bool {
        self.child.wait().unwrap().success()
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
