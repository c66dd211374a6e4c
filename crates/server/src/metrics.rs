//! What the server counts, in Prometheus' text format: numbers only, nobody's identifiers.

use std::fmt::Write as _;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

/// Upper bounds of the histogram of answer times, milliseconds.
const BOUNDS_MS: [u64; 10] = [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000];

/// Counters since the start of the process.
#[derive(Default)]
pub(crate) struct Metrics {
    /// Answers by the hundred of their status.
    answers: [AtomicU64; 6],
    /// Answers by time, the last for what took longer than every bound.
    times: [AtomicU64; BOUNDS_MS.len() + 1],
    microseconds: AtomicU64,
    /// Connections open now.
    pub connections: AtomicU64,
    /// Events acknowledged.
    pub events: AtomicU64,
}

impl Metrics {
    /// An answer was made.
    pub fn answered(&self, status: u16, took: Duration) {
        let class = usize::from(status / 100).min(self.answers.len() - 1);
        self.answers[class].fetch_add(1, Ordering::Relaxed);
        let ms = took.as_secs_f64() * 1000.0;
        let place = BOUNDS_MS.iter().take_while(|bound| ms > **bound as f64).count();
        self.times[place].fetch_add(1, Ordering::Relaxed);
        let microseconds = u64::try_from(took.as_micros()).unwrap_or(u64::MAX);
        self.microseconds.fetch_add(microseconds, Ordering::Relaxed);
    }

    /// All of it; `sessions` are counts by study, stage and status.
    pub fn text(&self, sessions: &[([String; 3], u64)]) -> String {
        let read = |counter: &AtomicU64| counter.load(Ordering::Relaxed);
        let mut text = String::new();
        text.push_str("# TYPE mimique_http_answers_total counter\n");
        for (class, count) in self.answers.iter().enumerate().skip(1) {
            let _ = writeln!(
                text,
                "mimique_http_answers_total{{status=\"{class}xx\"}} {}",
                read(count)
            );
        }
        text.push_str("# TYPE mimique_http_answer_seconds histogram\n");
        let mut below = 0;
        for (bound, count) in BOUNDS_MS.iter().zip(&self.times) {
            below += read(count);
            let seconds = *bound as f64 / 1000.0;
            let _ =
                writeln!(text, "mimique_http_answer_seconds_bucket{{le=\"{seconds}\"}} {below}");
        }
        below += read(&self.times[BOUNDS_MS.len()]);
        let sum = read(&self.microseconds) as f64 / 1e6;
        let _ = writeln!(text, "mimique_http_answer_seconds_bucket{{le=\"+Inf\"}} {below}");
        let _ = writeln!(text, "mimique_http_answer_seconds_sum {sum}");
        let _ = writeln!(text, "mimique_http_answer_seconds_count {below}");
        for (name, kind, value) in [
            ("mimique_connections", "gauge", read(&self.connections)),
            ("mimique_events_acknowledged_total", "counter", read(&self.events)),
        ] {
            let _ = writeln!(text, "# TYPE {name} {kind}\n{name} {value}");
        }
        text.push_str("# TYPE mimique_sessions gauge\n");
        for ([study, stage, status], count) in sessions {
            let _ = writeln!(
                text,
                "mimique_sessions{{study=\"{study}\",stage=\"{stage}\",status=\"{status}\"}} {count}"
            );
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_histogram_counts_what_is_below_each_bound() {
        let metrics = Metrics::default();
        for ms in [0, 1, 3, 7000] {
            metrics.answered(200, Duration::from_millis(ms));
        }
        metrics.answered(404, Duration::from_millis(4));
        let text = metrics.text(&[(["faces", "live", "started"].map(String::from), 3)]);
        for line in [
            "mimique_http_answers_total{status=\"2xx\"} 4",
            "mimique_http_answers_total{status=\"4xx\"} 1",
            "mimique_http_answer_seconds_bucket{le=\"0.001\"} 2",
            "mimique_http_answer_seconds_bucket{le=\"0.005\"} 4",
            "mimique_http_answer_seconds_bucket{le=\"1\"} 4",
            "mimique_http_answer_seconds_bucket{le=\"+Inf\"} 5",
            "mimique_http_answer_seconds_count 5",
            "mimique_sessions{study=\"faces\",stage=\"live\",status=\"started\"} 3",
        ] {
            assert!(text.lines().any(|each| each == line), "{line}\n{text}");
        }
    }
}
