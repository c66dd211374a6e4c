//! Points in time as RFC 3339 writes them, and as milliseconds since 1970.

use jiff::Timestamp;

/// `2026-03-01T08:00:00+01:00` as milliseconds since 1970; `None` unless the text is a date, a time and an
/// offset (`Z` or `+HH:MM`).
pub fn instant_ms(text: &str) -> Option<i64> {
    text.parse::<Timestamp>().ok().map(Timestamp::as_millisecond)
}

/// `2026-11-21T08:30:00.250Z` for milliseconds since 1970 (UTC); nothing beyond the years that RFC 3339
/// can write.
pub fn iso_time(at_ms: f64) -> String {
    let whole = Some(at_ms.floor()).filter(|ms| ms.is_finite());
    let instant = whole.and_then(|ms| Timestamp::from_millisecond(ms as i64).ok());
    instant.map_or_else(String::new, |at| at.strftime("%Y-%m-%dT%H:%M:%S%.3fZ").to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_instants_are_read() {
        for (text, seconds) in [
            ("1970-01-01T00:00:00Z", 0),
            ("2000-02-29T12:00:00Z", 951_825_600),
            ("2026-03-01T08:00:00+01:00", 1_772_348_400),
            ("2026-03-01T02:00-05:00", 1_772_348_400),
            ("1969-12-31T23:59:59Z", -1),
            ("2100-03-01T00:00:00Z", 4_107_542_400),
        ] {
            assert_eq!(instant_ms(text), Some(seconds * 1000), "{text}");
        }
    }

    #[test]
    fn what_is_no_instant_is_refused() {
        for text in [
            "",
            "2026-03-01",
            "2026-03-01T08:00:00",
            "2026-13-01T08:00Z",
            "2026-02-29T08:00Z",
            "2100-02-29T08:00Z",
            "2026-03-01T24:00Z",
            "2026-3-1T08:00Z",
            "2026-03-01T08:00+1",
            "2026-03-01T08:00+99:00",
            "tomorrow",
            "\u{e9}T\u{e9}Z",
        ] {
            assert_eq!(instant_ms(text), None, "{text}");
        }
    }

    #[test]
    fn iso_time_knows_leap_years_and_times_before_1970() {
        // Values as `date -u -d @SECONDS` gives them.
        assert_eq!(iso_time(0.0), "1970-01-01T00:00:00.000Z");
        assert_eq!(iso_time(951_782_400_000.0), "2000-02-29T00:00:00.000Z");
        assert_eq!(iso_time(1_795_251_845_678.9), "2026-11-21T09:04:05.678Z");
        assert_eq!(iso_time(4_107_542_399_999.0), "2100-02-28T23:59:59.999Z");
        assert_eq!(iso_time(4_107_542_400_000.0), "2100-03-01T00:00:00.000Z");
        assert_eq!(iso_time(-1.0), "1969-12-31T23:59:59.999Z");
        assert_eq!(iso_time(f64::NAN), "");
    }
}
