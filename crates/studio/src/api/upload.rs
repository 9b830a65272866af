//! A log that was dropped on the page, streamed into the folder: under its name only once it is whole.

use super::App;
use crate::given::{Json, Query, in_time};
use crate::refused::Refused;
use crate::workspace::UNFINISHED;
use axum::body::Body;
use axum::extract::State;
use axum::http::HeaderMap;
use axum::http::header::CONTENT_LENGTH;
use futures_core::Stream;
use serde::Deserialize;
use std::future::poll_fn;
use std::pin::Pin;
use tokio::io::AsyncWriteExt;

/// Largest upload, bytes; what is larger is put into the folder by hand.
const LARGEST: u64 = 4 << 30;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Asked {
    name: String,
    /// Whether a file of that name is replaced.
    #[serde(default)]
    replace: bool,
}

/// Takes an upload, whose length is said beforehand.
pub async fn upload(
    State(shared): App,
    Query(asked): Query<Asked>,
    headers: HeaderMap,
    body: Body,
) -> Result<Json<u64>, Refused> {
    let _one = shared
        .uploads
        .try_acquire()
        .map_err(|_| Refused::busy("two uploads at once are enough; wait for one"))?;
    let path = shared.workspace.place(&asked.name)?;
    if path
        .parent()
        .is_some_and(|dir| !dir.as_os_str().is_empty() && !dir.is_dir())
    {
        return Err(Refused::missing("no such folder"));
    }
    let exists = || path.symlink_metadata().is_ok();
    let taken = || {
        Refused::conflict(format!(
            "{}: there is a file of this name; replace it, or give the new one another name",
            asked.name
        ))
    };
    if exists() && (!asked.replace || !path.is_file()) {
        return Err(taken());
    }
    let announced = headers
        .get(CONTENT_LENGTH)
        .and_then(|length| length.to_str().ok());
    let announced: u64 = announced
        .and_then(|length| length.parse().ok())
        .ok_or_else(|| Refused::bad("an upload says its length"))?;
    if announced > LARGEST {
        return Err(Refused::too_large(format!(
            "{announced} bytes; {LARGEST} are taken here: put the file into the folder by hand"
        )));
    }
    let file = tempfile::Builder::new()
        .prefix(UNFINISHED)
        .tempfile_in(shared.workspace.folder())?;
    let (file, unfinished) = file.into_parts();
    let mut file = tokio::fs::File::from_std(file);
    let mut body = body.into_data_stream();
    let mut taken_bytes = 0_u64;
    loop {
        let chunk = in_time(&shared, poll_fn(|cx| Pin::new(&mut body).poll_next(cx))).await?;
        let Some(chunk) = chunk else { break };
        let bytes = chunk.map_err(|_| Refused::bad("the upload broke off"))?;
        taken_bytes += bytes.len() as u64;
        if taken_bytes > announced {
            return Err(Refused::bad("more bytes than were said"));
        }
        file.write_all(&bytes).await?;
    }
    if taken_bytes != announced {
        return Err(Refused::bad(format!(
            "the upload broke off: {taken_bytes} of {announced} bytes"
        )));
    }
    file.flush().await?;
    file.sync_all().await?;
    drop(file);
    // Unlike a rename this takes the name only where it is free, if it is to be.
    let kept = match asked.replace {
        true => unfinished.persist(&path).map_err(|e| e.error),
        false => unfinished.persist_noclobber(&path).map_err(|e| e.error),
    };
    match kept {
        Ok(()) => Ok(Json(taken_bytes)),
        Err(e) if e.kind() == std::io::ErrorKind::AlreadyExists => Err(taken()),
        Err(e) => Err(e.into()),
    }
}
