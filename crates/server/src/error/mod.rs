//! The one error of the HTTP interface. Its rows, with their codes and words, are in `table`; here is
//! how other errors become one of them, and how it is answered.

mod table;

use std::sync::Arc;

use axum::Json;
use axum::extract::rejection::{BytesRejection, JsonRejection};
use axum::http::{StatusCode, header};
use axum::response::{IntoResponse, Response};
use mimique_locale::Language;
use mimique_session::wire::Refusal;
use mimique_storage::StorageError;
pub(crate) use table::Error;
use table::Words;

use crate::export::error::ExportError;
use crate::state::start_error::AppError;

impl Error {
    /// A failure of the server's own; the detail goes to the log alone.
    pub fn internal(detail: impl ToString) -> Self {
        Self::Internal { detail: detail.to_string() }
    }

    /// The words as a sentence, for a page.
    pub fn sentence(&self, language: Language) -> String {
        let Words { message, remedy } = self.words(language);
        let text = match language {
            Language::English => format!("{message}; {remedy}."),
            Language::French => format!("{message} ; {remedy}."),
        };
        let mut letters = text.chars();
        letters
            .next()
            .map(|first| first.to_uppercase().chain(letters).collect())
            .unwrap_or_default()
    }

    /// What programs get: English words, which nothing may read but people.
    fn refusal(&self) -> Refusal {
        let Words { message, remedy } = self.words(Language::English);
        let sequences = match self {
            Self::EventConflict { sequences, .. } | Self::MissingEvents { sequences, .. } => {
                sequences.clone()
            }
            _ => Vec::new(),
        };
        Refusal { code: self.code().to_owned(), message, remedy, sequences }
    }
}

/// The JSON form; the error itself goes along, for a page in the reader's language.
impl IntoResponse for Error {
    fn into_response(self) -> Response {
        let status = self.status();
        if let Self::Internal { detail } = &self {
            tracing::error!("{status}: {detail}");
        } else if status.is_server_error() {
            tracing::error!("{status}: {}", self.code());
        }
        let mut response = (status, Json(self.refusal())).into_response();
        let headers = response.headers_mut();
        headers.insert(header::CACHE_CONTROL, header::HeaderValue::from_static("no-store"));
        if matches!(status, StatusCode::SERVICE_UNAVAILABLE | StatusCode::TOO_MANY_REQUESTS) {
            headers.insert(header::RETRY_AFTER, header::HeaderValue::from_static("2"));
        }
        response.extensions_mut().insert(Arc::new(self));
        response
    }
}

impl From<StorageError> for Error {
    fn from(error: StorageError) -> Self {
        match error {
            StorageError::UnknownSession => Self::UnknownSession,
            StorageError::Withdrawn => Self::Withdrawn,
            StorageError::MissingEvents { missing } => Self::MissingEvents {
                count: missing.len(),
                first: missing.first().copied().unwrap_or(0),
                sequences: missing,
            },
            StorageError::AlreadyTookPart => Self::AlreadyTookPart,
            StorageError::StudyFull => Self::StudyFull,
            StorageError::SessionFull => Self::SessionFull,
            StorageError::WrongWithdrawalCode => Self::WrongWithdrawalCode,
            StorageError::UnknownWithdrawalCode => Self::UnknownWithdrawalCode,
            StorageError::Unavailable | StorageError::Stopping => Self::Unavailable,
            other => Self::internal(other),
        }
    }
}

impl From<JsonRejection> for Error {
    fn from(rejection: JsonRejection) -> Self {
        match rejection {
            JsonRejection::MissingJsonContentType(_) => Self::NotJson,
            JsonRejection::BytesRejection(rejection) => rejection.into(),
            other => Self::UnreadableBody { problem: innermost(&other) },
        }
    }
}

impl From<BytesRejection> for Error {
    fn from(rejection: BytesRejection) -> Self {
        if rejection.status() == StatusCode::PAYLOAD_TOO_LARGE {
            Self::TooLarge
        } else {
            Self::BrokenBody
        }
    }
}

impl From<AppError> for Error {
    fn from(error: AppError) -> Self {
        match error {
            AppError::Storage(error) => error.into(),
            other => Self::internal(other),
        }
    }
}

impl From<ExportError> for Error {
    fn from(error: ExportError) -> Self {
        match error {
            ExportError::Storage(error) => error.into(),
            ExportError::UnknownStudy { .. } => Self::UnknownStudy,
            other => Self::internal(other),
        }
    }
}

/// A file of the data folder that cannot be read or written.
impl From<std::io::Error> for Error {
    fn from(error: std::io::Error) -> Self {
        Self::internal(format!("a file of the data folder: {error}"))
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
