//! A file that never changes under its address, in the forms that browsers accept.

use axum::body::Bytes;
use axum::http::{HeaderMap, HeaderValue, StatusCode, header};
use axum::response::{IntoResponse, Response};

use crate::error::Error;

/// Bytes, their type, and their compressed forms; cheap to clone.
#[derive(Debug, Clone)]
pub(crate) struct StaticFile {
    pub content_type: &'static str,
    pub raw: Bytes,
    pub brotli: Option<Bytes>,
    pub gzip: Option<Bytes>,
}

impl StaticFile {
    /// The smallest form that the request accepts, or the part that it asks for; to be kept for ever.
    pub fn respond(&self, request: &HeaderMap) -> Result<Response, Error> {
        // A part is of the file as it is. What never changes needs no `If-Range`.
        let wanted = request.get(header::RANGE).and_then(|value| value.to_str().ok());
        if let Some(part) = wanted.and_then(|wanted| Part::read(wanted, self.raw.len())) {
            return self.part(part);
        }
        let accepts = |coding| accepts(request, coding);
        let (coding, body) = match (&self.brotli, &self.gzip) {
            (Some(body), _) if accepts("br") => (Some("br"), body),
            (_, Some(body)) if accepts("gzip") => (Some("gzip"), body),
            _ => (None, &self.raw),
        };
        let mut response = (StatusCode::OK, body.clone()).into_response();
        let headers = response.headers_mut();
        headers.insert(header::CONTENT_TYPE, HeaderValue::from_static(self.content_type));
        headers.insert(
            header::CACHE_CONTROL,
            HeaderValue::from_static("public, max-age=31536000, immutable"),
        );
        headers.insert(header::VARY, HeaderValue::from_static("Accept-Encoding"));
        if let Some(coding) = coding {
            headers.insert(header::CONTENT_ENCODING, HeaderValue::from_static(coding));
        } else {
            headers.insert(header::ACCEPT_RANGES, HeaderValue::from_static("bytes"));
        }
        Ok(response)
    }

    fn part(&self, part: Part) -> Result<Response, Error> {
        let Part::From { first, last } = part else { return Err(Error::NoSuchRange) };
        let range = format!("bytes {first}-{last}/{}", self.raw.len());
        let headers = [
            (header::CONTENT_TYPE, self.content_type),
            (header::CACHE_CONTROL, "public, max-age=31536000, immutable"),
            (header::VARY, "Accept-Encoding"),
            (header::ACCEPT_RANGES, "bytes"),
            (header::CONTENT_RANGE, range.as_str()),
        ];
        let body = self.raw.slice(first..=last);
        Ok((StatusCode::PARTIAL_CONTENT, headers, body).into_response())
    }
}

/// One part of a file, as `Range` asks for it (RFC 9110, section 14).
#[derive(Debug, PartialEq)]
enum Part {
    From { first: usize, last: usize },
    Beyond,
}

impl Part {
    /// `None` for several parts and for text that is not a range: then the whole file is the answer.
    fn read(wanted: &str, length: usize) -> Option<Self> {
        let (first, last) = wanted.trim().strip_prefix("bytes=")?.split_once('-')?;
        let number =
            |text: &str| text.bytes().all(|b| b.is_ascii_digit()).then(|| text.parse().ok())?;
        let end = length.checked_sub(1);
        let (first, last): (usize, usize) = match (first.trim(), last.trim()) {
            ("", "") => return None,
            ("", suffix) => (length.saturating_sub(number(suffix)?), length),
            (first, "") => (number(first)?, length),
            (first, last) => (number(first)?, number(last)?),
        };
        if last < first && first < length {
            return None;
        }
        Some(match end {
            Some(end) if first <= end => Self::From { first, last: last.min(end) },
            _ => Self::Beyond,
        })
    }
}

/// Whether `Accept-Encoding` names the coding without forbidding it by `q=0`.
fn accepts(request: &HeaderMap, coding: &str) -> bool {
    request
        .get_all(header::ACCEPT_ENCODING)
        .iter()
        .filter_map(|value| value.to_str().ok())
        .flat_map(|value| value.split(','))
        .any(|offer| {
            let (name, quality) = offer.split_once(";q=").unwrap_or((offer, "1"));
            let quality: f32 = quality.trim().parse().unwrap_or(0.0);
            name.trim().eq_ignore_ascii_case(coding) && quality > 0.0
        })
}

/// The type of a file by the end of its name.
pub(crate) fn content_type(name: &str) -> &'static str {
    match name.rsplit_once('.').map_or("", |(_, end)| end) {
        "css" => "text/css; charset=utf-8",
        "csv" => "text/csv; charset=utf-8",
        "html" => "text/html; charset=utf-8",
        "js" | "mjs" => "text/javascript; charset=utf-8",
        "json" => "application/json",
        "jsonl" => "application/x-ndjson",
        "zip" => "application/zip",
        "wasm" => "application/wasm",
        "svg" => "image/svg+xml",
        "png" => "image/png",
        "jpg" | "jpeg" => "image/jpeg",
        "webp" => "image/webp",
        "mp4" => "video/mp4",
        "webm" => "video/webm",
        "woff2" => "font/woff2",
        "txt" | "md" => "text/plain; charset=utf-8",
        _ => "application/octet-stream",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn request(accepted: &str) -> HeaderMap {
        let value = HeaderValue::from_str(accepted).unwrap();
        HeaderMap::from_iter([(header::ACCEPT_ENCODING, value)])
    }

    #[test]
    fn the_smallest_accepted_form_is_sent() {
        let file = StaticFile {
            content_type: "text/css",
            raw: Bytes::from_static(b"raw"),
            brotli: Some(Bytes::from_static(b"b")),
            gzip: Some(Bytes::from_static(b"gz")),
        };
        for (accepted, coding) in [
            ("gzip, deflate, br", Some("br")),
            ("gzip, br;q=0", Some("gzip")),
            ("identity", None),
            ("", None),
        ] {
            let response = file.respond(&request(accepted)).unwrap();
            let sent = response.headers().get(header::CONTENT_ENCODING);
            assert_eq!(sent.map(|v| v.to_str().unwrap()), coding, "{accepted}");
        }
    }

    #[test]
    fn a_part_is_cut_as_asked_for() {
        let from = |first, last| Some(Part::From { first, last });
        for (wanted, expected) in [
            ("bytes=0-3", from(0, 3)),
            ("bytes=4-", from(4, 9)),
            ("bytes=4-400", from(4, 9)),
            ("bytes=-3", from(7, 9)),
            ("bytes=-300", from(0, 9)),
            ("bytes=10-", Some(Part::Beyond)),
            ("bytes=-0", Some(Part::Beyond)),
            ("bytes=10-12", Some(Part::Beyond)),
            ("bytes=3-2", None),
            ("bytes=0-1,4-5", None),
            ("bytes=-", None),
            ("bytes=+1-2", None),
            ("bytes=99999999999999999999-", None),
            ("lines=0-3", None),
        ] {
            assert_eq!(Part::read(wanted, 10), expected, "{wanted}");
        }
        assert_eq!(Part::read("bytes=0-", 0), Some(Part::Beyond));
    }
}
