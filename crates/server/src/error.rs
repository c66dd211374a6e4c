//! The one error of the HTTP interface: it owns the status codes and the words of a refusal.
//!
//! A 5xx keeps its detail in the log; neither holds answers or identifiers.

use axum::Json;
use axum::extract::rejection::{BytesRejection, JsonRejection};
use axum::http::{StatusCode, header};
use axum::response::{IntoResponse, Response};
use mimique_study::wire::Refusal;

use crate::app::AppError;
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
    #[error("too many requests from one address; wait a moment and send it again")]
    TooOften,
    #[error("the part asked for is beyond the end; ask for less")]
    NoSuchRange,
    #[error("the request took too long to arrive; send it again")]
    Timeout,
    #[error("{} events differ from what is stored under their sequence; reload the page", .0.len())]
    EventConflict(Vec<u64>),
    #[error("nobody is logged in; log in, or send a token")]
    LogInFirst,
    #[error("your role does not allow this; ask an owner of this server")]
    NotAllowed,
    #[error("the form is not from this page, or the page is too old; load the page again")]
    ForeignForm,
    #[error("address or password is wrong; type both again, or ask an owner for a new link")]
    WrongPassword,
    #[error("there were too many attempts; wait a quarter of an hour")]
    TooManyAttempts,
    #[error("this account has too many dashboards open; close one")]
    TooManyStreams,
    #[error("the name typed is not the participant’s; type {0} to delete")]
    NotConfirmed(String),
    #[error("the link was used, has expired or never was; ask for a new one")]
    DeadLink,
    #[error("{0}; choose another role or account first")]
    LastOwner(&'static str),
    #[error("{0}")]
    BadUpload(String),
    #[error("the upload is too large; 512 MiB are taken at most")]
    UploadTooLarge,
    #[error("there is no report: {0}")]
    NoReport(String),
    #[error("{message}; {remedy}")]
    CannotBegin { code: &'static str, message: String, remedy: String },
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
            Self::TooLarge | Self::UploadTooLarge => StatusCode::PAYLOAD_TOO_LARGE,
            Self::BadUpload(_) => StatusCode::UNPROCESSABLE_ENTITY,
            Self::TooOften => StatusCode::TOO_MANY_REQUESTS,
            Self::NoSuchRange => StatusCode::RANGE_NOT_SATISFIABLE,
            Self::NotJson => StatusCode::UNSUPPORTED_MEDIA_TYPE,
            Self::Timeout => StatusCode::REQUEST_TIMEOUT,
            Self::EventConflict(_) | Self::Storage(StorageError::MissingEvents { .. }) => {
                StatusCode::CONFLICT
            }
            Self::LogInFirst => StatusCode::UNAUTHORIZED,
            Self::NotAllowed
            | Self::ForeignForm
            | Self::WrongPassword
            | Self::CannotBegin { .. }
            | Self::Storage(
                StorageError::WrongWithdrawalCode
                | StorageError::AlreadyTookPart
                | StorageError::StudyFull,
            ) => StatusCode::FORBIDDEN,
            Self::NotConfirmed(_) => StatusCode::BAD_REQUEST,
            Self::TooManyAttempts | Self::TooManyStreams => StatusCode::TOO_MANY_REQUESTS,
            Self::DeadLink => StatusCode::GONE,
            Self::LastOwner(_) | Self::NoReport(_) => StatusCode::CONFLICT,
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
            Self::TooLarge | Self::UploadTooLarge => "too-large",
            Self::BadUpload(_) => "bad-upload",
            Self::Timeout => "timeout",
            Self::TooOften => "too-often",
            Self::NoSuchRange => "no-such-range",
            Self::EventConflict(_) => "event-conflict",
            Self::LogInFirst => "log-in-first",
            Self::NotAllowed => "not-allowed",
            Self::ForeignForm => "foreign-form",
            Self::WrongPassword => "wrong-password",
            Self::TooManyAttempts => "too-many-attempts",
            Self::TooManyStreams => "too-many-streams",
            Self::NotConfirmed(_) => "not-confirmed",
            Self::DeadLink => "dead-link",
            Self::LastOwner(_) => "last-owner",
            Self::NoReport(_) => "no-report",
            Self::CannotBegin { code, .. } => code,
            Self::Storage(StorageError::AlreadyTookPart) => "already-took-part",
            Self::Storage(StorageError::StudyFull) => "study-full",
            Self::Storage(StorageError::UnknownSession) => "unknown-session",
            Self::Storage(StorageError::Withdrawn) => "withdrawn",
            Self::Storage(StorageError::MissingEvents { .. }) => "missing-events",
            Self::Storage(StorageError::WrongWithdrawalCode) => "wrong-withdrawal-code",
            Self::Storage(StorageError::Unavailable | StorageError::Stopping) => "unavailable",
            Self::Storage(_) | Self::Internal(_) => "internal",
        }
    }

    /// Status and words, for a page that shows them.
    pub fn into_refusal(self) -> (StatusCode, Refusal) {
        (self.status(), self.refusal())
    }

    fn refusal(self) -> Refusal {
        let status = self.status();
        let code = self.code().to_owned();
        let text = if status.is_server_error() {
            "the server could not do it; nothing that was acknowledged is lost, try again".into()
        } else {
            self.to_string()
        };
        let (message, remedy) = match &self {
            Self::CannotBegin { message, remedy, .. } => (message.as_str(), remedy.as_str()),
            _ => text.rsplit_once("; ").unwrap_or((&text, "")),
        };
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
        if matches!(status, StatusCode::SERVICE_UNAVAILABLE | StatusCode::TOO_MANY_REQUESTS) {
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

impl From<AppError> for Error {
    fn from(error: AppError) -> Self {
        match error {
            AppError::Storage(error) => Self::Storage(error),
            other => Self::Internal(other.to_string()),
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
