//! A connection whose reader has to keep up: one that takes less than a modem would is closed.
//!
//! Only the time counts in which there was something to send and the other end did not take it: an idle
//! connection, or one on which little is said, is none of this.

use std::future::Future;
use std::io;
use std::pin::Pin;
use std::task::{Context, Poll, ready};
use std::time::Duration;

use tokio::io::{AsyncRead, AsyncWrite, ReadBuf};
use tokio::time::{Instant, Sleep};

/// Bytes a second at least, over the whole patience.
const SLOWEST: u64 = 1024;

/// A stream with a bound on how slowly it is read at the other end.
pub(crate) struct Paced<S> {
    stream: S,
    patience: Duration,
    /// Since when nothing could be written, and when the patience is over.
    blocked: Option<(Instant, Pin<Box<Sleep>>)>,
    /// How long nothing could be written, and how much was, since the count began.
    waited: Duration,
    written: u64,
}

impl<S> Paced<S> {
    pub fn new(stream: S, patience: Duration) -> Self {
        Self { stream, patience, blocked: None, waited: Duration::ZERO, written: 0 }
    }

    /// Counts what was written.
    fn took(&mut self, bytes: usize) {
        if let Some((since, _)) = self.blocked.take() {
            self.waited += since.elapsed();
        }
        self.written += bytes as u64;
    }

    /// Nothing can be written now; an error when that has been so for too long.
    fn wait(&mut self, context: &mut Context<'_>) -> Poll<io::Result<usize>> {
        let left = self.patience.saturating_sub(self.waited);
        let (_, over) = self
            .blocked
            .get_or_insert_with(|| (Instant::now(), Box::pin(tokio::time::sleep(left))));
        ready!(over.as_mut().poll(context));
        if self.written < SLOWEST * self.patience.as_secs().max(1) {
            let slow = "the caller reads too slowly";
            return Poll::Ready(Err(io::Error::new(io::ErrorKind::TimedOut, slow)));
        }
        // It was fast enough: the count begins anew.
        (self.blocked, self.waited, self.written) = (None, Duration::ZERO, 0);
        context.waker().wake_by_ref();
        Poll::Pending
    }
}

impl<S: AsyncWrite + Unpin> AsyncWrite for Paced<S> {
    fn poll_write(
        self: Pin<&mut Self>,
        context: &mut Context<'_>,
        bytes: &[u8],
    ) -> Poll<io::Result<usize>> {
        let own = self.get_mut();
        match Pin::new(&mut own.stream).poll_write(context, bytes) {
            Poll::Pending => own.wait(context),
            Poll::Ready(written) => {
                own.took(*written.as_ref().unwrap_or(&0));
                Poll::Ready(written)
            }
        }
    }

    fn poll_write_vectored(
        self: Pin<&mut Self>,
        context: &mut Context<'_>,
        parts: &[io::IoSlice<'_>],
    ) -> Poll<io::Result<usize>> {
        let own = self.get_mut();
        match Pin::new(&mut own.stream).poll_write_vectored(context, parts) {
            Poll::Pending => own.wait(context),
            Poll::Ready(written) => {
                own.took(*written.as_ref().unwrap_or(&0));
                Poll::Ready(written)
            }
        }
    }

    fn is_write_vectored(&self) -> bool {
        self.stream.is_write_vectored()
    }

    fn poll_flush(self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.get_mut().stream).poll_flush(context)
    }

    fn poll_shutdown(self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.get_mut().stream).poll_shutdown(context)
    }
}

impl<S: AsyncRead + Unpin> AsyncRead for Paced<S> {
    fn poll_read(
        self: Pin<&mut Self>,
        context: &mut Context<'_>,
        buffer: &mut ReadBuf<'_>,
    ) -> Poll<io::Result<()>> {
        Pin::new(&mut self.get_mut().stream).poll_read(context, buffer)
    }
}

#[cfg(test)]
mod tests {
    use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};

    use super::*;

    /// What becomes of a megabyte when the other end takes `part` bytes each ten seconds.
    async fn sent(part: usize) -> io::Result<()> {
        let (near, mut far) = tokio::io::duplex(1024);
        let mut near = Paced::new(near, Duration::from_secs(30));
        let reader = tokio::spawn(async move {
            let mut buffer = vec![0; part];
            loop {
                tokio::time::sleep(Duration::from_secs(10)).await;
                if far.read_exact(&mut buffer).await.is_err() {
                    break;
                }
            }
        });
        let outcome = near.write_all(&vec![7; 1 << 20]).await;
        drop(near);
        reader.abort();
        outcome
    }

    #[tokio::test(start_paused = true)]
    async fn who_reads_too_slowly_is_shown_out_and_who_reads_slowly_is_not() {
        let slow = sent(1000).await.unwrap_err();
        assert_eq!(slow.kind(), io::ErrorKind::TimedOut);
        sent(32 * 1024).await.unwrap();
    }

    #[tokio::test(start_paused = true)]
    async fn what_is_idle_is_not_slow() {
        let (near, mut far) = tokio::io::duplex(1024);
        let mut near = Paced::new(near, Duration::from_secs(30));
        for _ in 0..5 {
            near.write_all(b"beat").await.unwrap();
            tokio::time::sleep(Duration::from_secs(3600)).await;
            let mut buffer = [0; 4];
            far.read_exact(&mut buffer).await.unwrap();
        }
    }
}
