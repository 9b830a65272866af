//! What is said to the page where something cannot be done: what was found, and what is allowed; an error of the engine with its
//! code.

use crate::given::Json;
use axum::http::StatusCode;
use axum::response::{IntoResponse, Response};

/// A request that is not answered with what it asked for.
#[derive(Debug)]
pub struct Refused {
    status: StatusCode,
    message: String,
}

impl Refused {
    /// A request that is wrong in itself.
    pub fn bad(message: impl Into<String>) -> Self {
        Self::with(StatusCode::BAD_REQUEST, message)
    }

    /// A request that may not be made.
    pub fn forbidden(message: impl Into<String>) -> Self {
        Self::with(StatusCode::FORBIDDEN, message)
    }

    /// Something that is not there.
    pub fn missing(message: impl Into<String>) -> Self {
        Self::with(StatusCode::NOT_FOUND, message)
    }

    /// Something that is there already, or has changed since it was read.
    pub fn conflict(message: impl Into<String>) -> Self {
        Self::with(StatusCode::CONFLICT, message)
    }

    /// More than is taken at once.
    pub fn busy(message: impl Into<String>) -> Self {
        Self::with(StatusCode::SERVICE_UNAVAILABLE, message)
    }

    /// More bytes than are taken.
    pub fn too_large(message: impl Into<String>) -> Self {
        Self::with(StatusCode::PAYLOAD_TOO_LARGE, message)
    }

    /// A fault of ours.
    pub fn internal(message: impl Into<String>) -> Self {
        Self::with(StatusCode::INTERNAL_SERVER_ERROR, message)
    }

    /// With a status of its own.
    pub fn with(status: StatusCode, message: impl Into<String>) -> Self {
        Self {
            status,
            message: message.into(),
        }
    }

    /// The same with another word for what it is about.
    pub fn calling(self, name: &str, instead: &str) -> Self {
        Self {
            message: self.message.replace(name, instead),
            ..self
        }
    }

    /// What is said.
    pub fn message(&self) -> &str {
        &self.message
    }
}

impl From<stiction_workflows::Error> for Refused {
    fn from(e: stiction_workflows::Error) -> Self {
        let message = format!("[{}] {e}", e.code());
        Self::with(StatusCode::UNPROCESSABLE_ENTITY, message)
    }
}

impl From<stiction_files::Error> for Refused {
    fn from(e: stiction_files::Error) -> Self {
        stiction_workflows::Error::from(e).into()
    }
}

impl From<std::io::Error> for Refused {
    fn from(e: std::io::Error) -> Self {
        Self::internal(e.to_string())
    }
}

impl From<tokio::task::JoinError> for Refused {
    fn from(_: tokio::task::JoinError) -> Self {
        Self::internal("internal error of stiction, please report it with what was asked")
    }
}

impl IntoResponse for Refused {
    fn into_response(self) -> Response {
        let body = serde_json::json!({ "error": { "message": self.message } });
        (self.status, Json(body)).into_response()
    }
}
