//! `mimique serve` on loopback, asked over HTTP.

use std::io::{Read as _, Seek as _, Write as _};
use std::net::{TcpListener, TcpStream};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use anyhow::{Context, Result, bail};

use crate::process::show;

/// So long a study may take to be prepared.
const READY: Duration = Duration::from_secs(600);

/// A running server, ended when dropped.
pub struct Server {
    child: Child,
    port: u16,
    token: &'static str,
}

impl Server {
    /// Starts `mimique serve` with these arguments on a free port; how long it took until it answered, seconds.
    pub fn start(serve: &mut Command) -> Result<(Self, f64)> {
        let port = TcpListener::bind("127.0.0.1:0")?.local_addr()?.port();
        let began = Instant::now();
        serve.args(["--listen", &format!("127.0.0.1:{port}")]);
        let mut complaints = tempfile::tempfile()?;
        serve.stdin(Stdio::null()).stdout(Stdio::null()).stderr(complaints.try_clone()?);
        let shown = show(serve);
        let child = serve.spawn().with_context(|| format!("could not start: {shown}"))?;
        let mut server = Self { child, port, token: "" };
        while server.read("/healthz").is_err() {
            if let Some(end) = server.child.try_wait()? {
                let mut said = String::new();
                complaints.rewind()?;
                complaints.read_to_string(&mut said)?;
                bail!("ended ({end}): {shown}\n{said}");
            }
            if began.elapsed() > READY {
                bail!("does not answer /healthz after {} s: {shown}", READY.as_secs());
            }
            std::thread::sleep(Duration::from_millis(2));
        }
        Ok((server, began.elapsed().as_secs_f64()))
    }

    /// The same server, asked with a bearer token from now on.
    pub fn with_token(mut self, token: &'static str) -> Self {
        self.token = token;
        self
    }

    /// The process.
    pub fn id(&self) -> u32 {
        self.child.id()
    }

    /// An answer as text, and how long it took, seconds.
    pub fn read(&self, path: &str) -> Result<(f64, String)> {
        let mut text = Vec::new();
        let seconds = self.each(path, |bytes| text.extend_from_slice(bytes))?;
        Ok((seconds, String::from_utf8_lossy(&text).into_owned()))
    }

    /// How large an answer is that is not kept.
    pub fn count(&self, path: &str) -> Result<u64> {
        let mut count = 0;
        self.each(path, |bytes| count += bytes.len() as u64)?;
        Ok(count)
    }

    /// Reads an answer with status 200 piece by piece.
    fn each(&self, path: &str, mut take: impl FnMut(&[u8])) -> Result<f64> {
        let began = Instant::now();
        let mut stream = TcpStream::connect(("127.0.0.1", self.port))?;
        let authorization = match self.token {
            "" => String::new(),
            token => format!("Authorization: Bearer {token}\r\n"),
        };
        let request = format!(
            "GET {path} HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\
             Accept: text/html\r\n{authorization}\r\n"
        );
        stream.write_all(request.as_bytes())?;
        let mut piece = vec![0; 256 * 1024];
        let mut is_first = true;
        loop {
            let read = stream.read(&mut piece)?;
            if is_first && !piece[..read].starts_with(b"HTTP/1.1 200") {
                bail!("{path}: {}", String::from_utf8_lossy(&piece[..read.min(200)]));
            }
            is_first = false;
            if read == 0 {
                return Ok(began.elapsed().as_secs_f64());
            }
            take(&piece[..read]);
        }
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
