//! The one error of the HTTP interface: it owns the status codes and the words of a refusal.
//!
//! A 5xx keeps its detail in the log; neither holds answers or identifiers.

use axum::Json;
use axum::extract::rejection::{BytesRejection, JsonRejection};
use axum::http::{StatusCode, header};
use axum::response::{IntoResponse, Response};
use mimique_study::wire::Refusal;

use crate::export::ExportError;
use crate::storage::StorageError;

/// Why a request is refused.
#[derive(Debug, thiserror::Error)]
pub(crate) enum Error {
    #[error("nothing is at this address; check it, or start again from the study's address")]
    NotFound,
    #[error("this address does not take this method; see the list of routes")]
    MethodNotAllowed,
    #[error("no study is called so on this server; check the address")]
    UnknownStudy,
    #[error("no pack has this hash; reload the page")]
    UnknownPack,
    #[error("{what}; {remedy}")]
    BadRequest { what: String, remedy: &'static str },
    #[error("the request is too large; send fewer events in one request")]
    TooLarge,
    #[error("the body is not JSON by its Content-Type; send application/json")]
    NotJson,
    #[error("the request took too long to arrive; send it again")]
    Timeout,
    #[error("{} events differ from what is stored under their sequence; reload the page", .0.len())]
    EventConflict(Vec<u64>),
    #[error("this page is the researcher's; open the address that `mimique serve` printed")]
    AccessDenied,
    #[error(transparent)]
    Storage(#[from] StorageError),
    #[error("the server failed: {0}")]
    Internal(String),
}

impl Error {
    pub fn bad_request(what: impl Into<String>, remedy: &'static str) -> Self {
        Self::BadRequest { what: what.into(), remedy }
    }

    fn status(&self) -> StatusCode {
        match self {
            Self::NotFound
            | Self::UnknownStudy
            | Self::UnknownPack
            | Self::Storage(StorageError::UnknownSession) => StatusCode::NOT_FOUND,
            Self::MethodNotAllowed => StatusCode::METHOD_NOT_ALLOWED,
            Self::BadRequest { .. } => StatusCode::BAD_REQUEST,
            Self::TooLarge => StatusCode::PAYLOAD_TOO_LARGE,
            Self::NotJson => StatusCode::UNSUPPORTED_MEDIA_TYPE,
            Self::Timeout => StatusCode::REQUEST_TIMEOUT,
            Self::EventConflict(_) | Self::Storage(StorageError::MissingEvents { .. }) => {
                StatusCode::CONFLICT
            }
            Self::AccessDenied | Self::Storage(StorageError::WrongWithdrawalCode) => {
                StatusCode::FORBIDDEN
            }
            Self::Storage(StorageError::Withdrawn) => StatusCode::GONE,
            Self::Storage(StorageError::Unavailable | StorageError::Stopping) => {
                StatusCode::SERVICE_UNAVAILABLE
            }
            Self::Storage(_) | Self::Internal(_) => StatusCode::INTERNAL_SERVER_ERROR,
        }
    }

    /// The stable word that programs read.
    fn code(&self) -> &'static str {
        match self {
            Self::NotFound => "not-found",
            Self::MethodNotAllowed => "method-not-allowed",
            Self::UnknownStudy => "unknown-study",
            Self::UnknownPack => "unknown-pack",
            Self::BadRequest { .. } | Self::NotJson => "bad-request",
            Self::TooLarge => "too-large",
            Self::Timeout => "timeout",
            Self::EventConflict(_) => "event-conflict",
            Self::AccessDenied => "access-denied",
            Self::Storage(StorageError::UnknownSession) => "unknown-session",
            Self::Storage(StorageError::Withdrawn) => "withdrawn",
            Self::Storage(StorageError::MissingEvents { .. }) => "missing-events",
            Self::Storage(StorageError::WrongWithdrawalCode) => "wrong-withdrawal-code",
            Self::Storage(StorageError::Unavailable | StorageError::Stopping) => "unavailable",
            Self::Storage(_) | Self::Internal(_) => "internal",
        }
    }

    fn refusal(self) -> Refusal {
        let status = self.status();
        let code = self.code().to_owned();
        let text = if status.is_server_error() {
            "the server could not do it; nothing that was acknowledged is lost, try again".into()
        } else {
            self.to_string()
        };
        let (message, remedy) = text.rsplit_once("; ").unwrap_or((&text, ""));
        let (message, remedy) = (message.to_owned(), remedy.to_owned());
        let sequences = match self {
            Self::EventConflict(sequences) => sequences,
            Self::Storage(StorageError::MissingEvents { missing }) => missing,
            _ => Vec::new(),
        };
        Refusal { code, message, remedy, sequences }
    }
}

impl IntoResponse for Error {
    fn into_response(self) -> Response {
        let status = self.status();
        if status.is_server_error() {
            tracing::error!("{status}: {self}");
        }
        let mut response = (status, Json(self.refusal())).into_response();
        let headers = response.headers_mut();
        headers.insert(header::CACHE_CONTROL, header::HeaderValue::from_static("no-store"));
        if status == StatusCode::SERVICE_UNAVAILABLE {
            headers.insert(header::RETRY_AFTER, header::HeaderValue::from_static("2"));
        }
        response
    }
}

impl From<JsonRejection> for Error {
    fn from(rejection: JsonRejection) -> Self {
        match rejection {
            JsonRejection::MissingJsonContentType(_) => Self::NotJson,
            JsonRejection::BytesRejection(rejection) => rejection.into(),
            other => Self::bad_request(
                format!("the body is not what this address takes: {}", innermost(&other)),
                "see the interface's description",
            ),
        }
    }
}

impl From<BytesRejection> for Error {
    fn from(rejection: BytesRejection) -> Self {
        if rejection.status() == StatusCode::PAYLOAD_TOO_LARGE {
            Self::TooLarge
        } else {
            Self::bad_request("the body could not be read to its end", "send the request again")
        }
    }
}

impl From<ExportError> for Error {
    fn from(error: ExportError) -> Self {
        match error {
            ExportError::Storage(error) => Self::Storage(error),
            ExportError::UnknownStudy { .. } => Self::UnknownStudy,
            other => Self::Internal(other.to_string()),
        }
    }
}

/// The deepest reason, which names field and place.
fn innermost(error: &dyn std::error::Error) -> String {
    let mut error = error;
    while let Some(source) = error.source() {
        error = source;
    }
    error.to_string()
}
