//! Panics of the server in its log: by their place alone.

use std::panic::PanicHookInfo;

/// Has panics of this process logged from now on, instead of written to the standard error as they are: the message of
/// a panic may hold a text that a participant has sent, with line breaks.
pub fn log_panics() {
    std::panic::set_hook(Box::new(log));
}

fn log(panic: &PanicHookInfo<'_>) {
    let place = panic.location().map(ToString::to_string).unwrap_or_default();
    tracing::error!(place, "the server panicked; report it with this place");
}

#[cfg(test)]
mod tests {
    use std::io::Write;
    use std::sync::{Arc, Mutex};

    use super::*;

    #[derive(Clone, Default)]
    struct Log(Arc<Mutex<Vec<u8>>>);

    impl Write for Log {
        fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
            self.0.lock().unwrap().write(bytes)
        }

        fn flush(&mut self) -> std::io::Result<()> {
            Ok(())
        }
    }

    #[test]
    fn a_panic_is_one_line_without_its_text() {
        let written = Log::default();
        let writer = written.clone();
        let subscriber =
            tracing_subscriber::fmt().with_ansi(false).with_writer(move || writer.clone()).finish();
        tracing::subscriber::with_default(subscriber, || {
            let before = std::panic::take_hook();
            log_panics();
            let caught = std::panic::catch_unwind(|| panic!("my answer\nWARN forged"));
            std::panic::set_hook(before);
            assert!(caught.is_err());
        });
        let text = String::from_utf8(written.0.lock().unwrap().clone()).unwrap();
        assert_eq!(text.lines().count(), 1, "{text}");
        assert!(text.contains("ERROR") && text.contains("panic_hook.rs:"), "{text}");
        assert!(!text.contains("my answer") && !text.contains("forged"), "{text}");
    }
}
