//! What a request gives, and what an answer carries: JSON, and what stands behind the `?` of an address. What is not as the page
//! writes it is refused as everything else is, with the place in it.

use crate::refused::Refused;
use crate::server::Shared;
use axum::body::Bytes;
use axum::extract::{FromRequest, FromRequestParts, Request};
use axum::http::StatusCode;
use axum::http::header::{CONTENT_TYPE, HeaderMap};
use axum::http::request::Parts;
use axum::response::{IntoResponse, Response};
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::sync::Arc;
use tokio::time::timeout;

const JSON: &str = "application/json";

/// JSON as the body of a request or of an answer.
#[derive(Debug)]
pub struct Json<T>(pub T);

/// What stands behind the `?`.
#[derive(Debug)]
pub struct Query<T>(pub T);

impl<T: DeserializeOwned> FromRequest<Arc<Shared>> for Json<T> {
    type Rejection = Refused;

    async fn from_request(request: Request, shared: &Arc<Shared>) -> Result<Self, Refused> {
        said_to_be_json(request.headers())?;
        let bytes = in_time(shared, Bytes::from_request(request, shared)).await?;
        let bytes = bytes.map_err(|e| Refused::with(e.status(), e.body_text()))?;
        let read = serde_json::from_slice(&bytes);
        Ok(Self(read.map_err(|e| unlike_the_page("body", &e))?))
    }
}

impl<T: DeserializeOwned, S: Send + Sync> FromRequestParts<S> for Query<T> {
    type Rejection = Refused;

    async fn from_request_parts(parts: &mut Parts, _: &S) -> Result<Self, Refused> {
        let read = serde_urlencoded::from_str(parts.uri.query().unwrap_or_default());
        Ok(Self(read.map_err(|e| unlike_the_page("address", &e))?))
    }
}

impl<T: Serialize> IntoResponse for Json<T> {
    fn into_response(self) -> Response {
        written(&self.0).map(sent).into_response()
    }
}

/// JSON as bytes.
pub fn written<T: Serialize>(what: &T) -> Result<Vec<u8>, Refused> {
    serde_json::to_vec(what).map_err(|e| Refused::internal(e.to_string()))
}

/// Bytes of JSON as an answer.
pub fn sent(bytes: Vec<u8>) -> Response {
    ([(CONTENT_TYPE, JSON)], bytes).into_response()
}

/// Waits for a body, or a piece of it, and gives up on one that does not arrive.
pub async fn in_time<T>(shared: &Shared, arrives: impl Future<Output = T>) -> Result<T, Refused> {
    let arrived = timeout(shared.patience, arrives).await;
    arrived.map_err(|_| {
        let late = "the body of the request did not arrive in time";
        Refused::with(StatusCode::REQUEST_TIMEOUT, late)
    })
}

/// A page elsewhere may send text and forms unasked; for JSON its browser has to ask first.
fn said_to_be_json(headers: &HeaderMap) -> Result<(), Refused> {
    let said = headers.get(CONTENT_TYPE);
    let said = said.and_then(|said| said.to_str().ok()).unwrap_or_default();
    let kind = said.split(';').next().unwrap_or_default().trim();
    match kind.eq_ignore_ascii_case(JSON) {
        true => Ok(()),
        false => Err(Refused::with(
            StatusCode::UNSUPPORTED_MEDIA_TYPE,
            format!("the body is said to be {said:?}; what is taken here is {JSON}"),
        )),
    }
}

fn unlike_the_page(what: &str, e: &dyn std::error::Error) -> Refused {
    Refused::bad(format!(
        "the {what} of this request is not as the page of this version writes it: {e}; reload the page"
    ))
}
