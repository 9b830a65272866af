//! The page itself, as it was built from `web/`.

use crate::refused::Refused;
use axum::http::header::CONTENT_TYPE;
use axum::http::{HeaderValue, Uri};
use axum::response::{IntoResponse, Response};

/// Path, kind and bytes of every file of it.
const FILES: [(&str, &str, &[u8]); 5] = [
    (
        "/",
        "text/html; charset=utf-8",
        include_bytes!("../assets/index.html"),
    ),
    (
        "/studio.js",
        "text/javascript; charset=utf-8",
        include_bytes!("../assets/studio.js"),
    ),
    (
        "/studio.css",
        "text/css; charset=utf-8",
        include_bytes!("../assets/studio.css"),
    ),
    (
        "/icon.svg",
        "image/svg+xml",
        include_bytes!("../assets/icon.svg"),
    ),
    // The licence of what is in the script.
    (
        "/uplot.txt",
        "text/plain; charset=utf-8",
        include_bytes!("../assets/uplot.txt"),
    ),
];

/// A file of the page.
pub async fn asset(uri: Uri) -> Response {
    let mut files = FILES.iter();
    match files.find(|(path, ..)| *path == uri.path()) {
        Some((_, kind, bytes)) => {
            ([(CONTENT_TYPE, HeaderValue::from_static(kind))], *bytes).into_response()
        }
        None => Refused::missing("no such page").into_response(),
    }
}
