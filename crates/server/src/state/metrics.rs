//! What the server counts, in the text format of OpenMetrics: numbers only, nobody's identifiers.

use std::fmt;
use std::time::Duration;

use prometheus_client::encoding::text::{encode_eof, encode_registry};
use prometheus_client::metrics::counter::Counter;
use prometheus_client::metrics::family::Family;
use prometheus_client::metrics::gauge::Gauge;
use prometheus_client::metrics::histogram::Histogram;
use prometheus_client::registry::Registry;

/// The type of [`Metrics::text`].
pub(crate) const MEDIA_TYPE: &str = "application/openmetrics-text; version=1.0.0; charset=utf-8";

/// Upper bounds of the histogram of answer times, seconds.
const BOUNDS: [f64; 10] = [0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0];

/// Names and values.
type Labels = Vec<(&'static str, String)>;

/// Counters since the start of the process.
pub(crate) struct Metrics {
    registry: Registry,
    /// Answers by the hundred of their status.
    answers: Family<Labels, Counter>,
    /// Answers by time, seconds.
    times: Histogram,
    /// Connections open now.
    pub connections: Gauge,
    /// Events acknowledged.
    pub events: Counter,
}

impl Default for Metrics {
    fn default() -> Self {
        let mut registry = Registry::default();
        let answers: Family<Labels, Counter> = Family::default();
        let times = Histogram::new(BOUNDS);
        let (connections, events) = (Gauge::default(), Counter::default());
        for hundred in 1..=5 {
            let _ = answers.get_or_create(&class(hundred));
        }
        registry.register("mimique_http_answers", "Answers by status", answers.clone());
        registry.register("mimique_http_answer_seconds", "Times of answers", times.clone());
        registry.register("mimique_connections", "Open connections", connections.clone());
        registry.register("mimique_events_acknowledged", "Events kept", events.clone());
        Self { registry, answers, times, connections, events }
    }
}

/// The label of the statuses of a hundred: `2xx`.
fn class(hundred: u16) -> Labels {
    vec![("status", format!("{hundred}xx"))]
}

impl Metrics {
    /// An answer was made.
    pub fn answered(&self, status: u16, took: Duration) {
        self.answers.get_or_create(&class((status / 100).clamp(1, 5))).inc();
        self.times.observe(took.as_secs_f64());
    }

    /// All of it; `sessions` are counts by study, stage and status.
    pub fn text(&self, sessions: &[([String; 3], u64)]) -> Result<String, fmt::Error> {
        let counts: Family<Labels, Gauge> = Family::default();
        for (of, count) in sessions {
            let names = ["study", "stage", "status"].into_iter();
            let labels = names.zip(of.iter().cloned()).collect();
            counts.get_or_create(&labels).set(i64::try_from(*count).unwrap_or(i64::MAX));
        }
        let mut of_sessions = Registry::default();
        of_sessions.register("mimique_sessions", "Sessions by standing", counts);
        let mut text = String::new();
        encode_registry(&mut text, &self.registry)?;
        encode_registry(&mut text, &of_sessions)?;
        encode_eof(&mut text)?;
        Ok(text)
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
        let text = metrics.text(&[(["faces", "live", "started"].map(String::from), 3)]).unwrap();
        for line in [
            "mimique_http_answers_total{status=\"2xx\"} 4",
            "mimique_http_answers_total{status=\"4xx\"} 1",
            "mimique_http_answers_total{status=\"5xx\"} 0",
            "mimique_http_answer_seconds_bucket{le=\"0.001\"} 2",
            "mimique_http_answer_seconds_bucket{le=\"0.005\"} 4",
            "mimique_http_answer_seconds_bucket{le=\"1.0\"} 4",
            "mimique_http_answer_seconds_bucket{le=\"+Inf\"} 5",
            "mimique_http_answer_seconds_count 5",
            "mimique_sessions{study=\"faces\",stage=\"live\",status=\"started\"} 3",
            "# EOF",
        ] {
            assert!(text.lines().any(|each| each == line), "{line}\n{text}");
        }
    }
}
