//! Files that a browser opens in a tab or saves.

use super::{Answer, App, Work, in_turn};
use crate::given::Json;
use crate::guard::SHOWN;
use crate::refused::Refused;
use crate::server::Shared;
use crate::tickets::{How, Opened};
use axum::body::Body;
use axum::extract::{Path, State};
use axum::http::HeaderValue;
use axum::http::header::{CONTENT_DISPOSITION, CONTENT_SECURITY_POLICY, CONTENT_TYPE};
use axum::response::IntoResponse;
use futures_core::Stream;
use std::convert::Infallible;
use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::pin::Pin;
use std::task::{Context, Poll};
use tokio::sync::mpsc;
use zip::write::SimpleFileOptions;

/// Bytes of a file that are sent at once.
const CHUNK: usize = 1 << 16;
/// Chunks that wait for the browser.
const WAITING: usize = 4;
/// Most files of a zip, and folders below each other in it.
const MOST_FILES: usize = 2000;
const DEEPEST: usize = 6;

/// The address under which a browser opens a file, or saves it or a folder.
pub async fn ticket(State(shared): App, Json(opened): Json<Opened>) -> Answer {
    let Opened { name, how } = &opened;
    let mut last = name.rsplit('/').next().unwrap_or_default().to_string();
    match how {
        How::Show if !name.ends_with(".html") => {
            return Err(Refused::bad(format!("{name}: only HTML files are shown")));
        }
        How::Show | How::Save => shared.workspace.file(name)?,
        How::Zip => {
            last.push_str(".zip");
            shared.workspace.dir(name)?
        }
    };
    let ticket = shared.tickets.give(opened)?;
    Ok(Json(format!("/open/{ticket}/{}", escaped(&last))).into_response())
}

/// What stands in an address as it is.
fn escaped(text: &str) -> String {
    let plain = |byte: u8| byte.is_ascii_alphanumeric() || b"-_.".contains(&byte);
    let one = |byte: u8| match plain(byte) {
        true => char::from(byte).to_string(),
        false => format!("%{byte:02X}"),
    };
    text.bytes().map(one).collect()
}

/// What an address stands for.
pub async fn open(State(shared): App, Path((ticket, _)): Path<(String, String)>) -> Answer {
    let opened = shared.tickets.take(&ticket);
    let opened = opened.ok_or_else(|| {
        Refused::missing("this address is of an earlier run of stiction studio, or too old")
    })?;
    let own = opened.clone();
    let work: Work<File> = Box::new(move |shared| file_of(shared, &own));
    let file = in_turn(shared, work).await?;
    let (kind, shown) = match opened.how {
        How::Show => ("text/html; charset=utf-8", "inline"),
        How::Save => ("application/octet-stream", "attachment"),
        How::Zip => ("application/zip", "attachment"),
    };
    let mut response = Body::from_stream(Sent::of(file)).into_response();
    let headers = response.headers_mut();
    headers.insert(CONTENT_TYPE, HeaderValue::from_static(kind));
    headers.insert(CONTENT_DISPOSITION, HeaderValue::from_static(shown));
    headers.insert(CONTENT_SECURITY_POLICY, HeaderValue::from_static(SHOWN));
    Ok(response)
}

fn file_of(shared: &Shared, opened: &Opened) -> Result<File, Refused> {
    let Opened { name, how } = opened;
    if *how != How::Zip {
        return Ok(File::open(shared.workspace.file(name)?)?);
    }
    let dir = shared.workspace.dir(name)?;
    let mut zip = zip::ZipWriter::new(tempfile::tempfile()?);
    let mut left = MOST_FILES;
    pack(&mut zip, &dir, "", DEEPEST, &mut left)?;
    let mut file = zip.finish().map_err(|e| Refused::internal(e.to_string()))?;
    file.seek(SeekFrom::Start(0))?;
    Ok(file)
}

/// Packs the files of a folder, sorted, all with the same date: the same files give the same bytes.
fn pack(
    zip: &mut zip::ZipWriter<File>,
    dir: &std::path::Path,
    before: &str,
    deep: usize,
    left: &mut usize,
) -> Result<(), Refused> {
    let mut entries: Vec<_> = std::fs::read_dir(dir)?.flatten().collect();
    entries.sort_by_key(std::fs::DirEntry::file_name);
    for entry in entries {
        let kind = entry.file_type()?;
        let Ok(name) = entry.file_name().into_string() else {
            continue;
        };
        let whole = format!("{before}{name}");
        if kind.is_dir() && deep > 1 {
            pack(zip, &entry.path(), &format!("{whole}/"), deep - 1, left)?;
        } else if kind.is_file() && !name.starts_with('.') {
            *left = left.checked_sub(1).ok_or_else(|| {
                Refused::too_large(format!(
                    "more than {MOST_FILES} files; copy the folder by hand"
                ))
            })?;
            let fault = |e: zip::result::ZipError| Refused::internal(e.to_string());
            zip.start_file(whole, SimpleFileOptions::default())
                .map_err(fault)?;
            std::io::copy(&mut File::open(entry.path())?, zip)?;
        }
    }
    Ok(())
}

/// A file on its way to a browser, a few chunks ahead of it.
struct Sent(mpsc::Receiver<Vec<u8>>);

impl Sent {
    fn of(mut file: File) -> Self {
        let (sender, receiver) = mpsc::channel(WAITING);
        tokio::task::spawn_blocking(move || {
            loop {
                let mut chunk = vec![0; CHUNK];
                let Ok(read) = file.read(&mut chunk) else {
                    break;
                };
                chunk.truncate(read);
                // Who has gone away wants no more of it.
                if read == 0 || sender.blocking_send(chunk).is_err() {
                    break;
                }
            }
        });
        Self(receiver)
    }
}

impl Stream for Sent {
    type Item = Result<Vec<u8>, Infallible>;

    fn poll_next(mut self: Pin<&mut Self>, cx: &mut Context<'_>) -> Poll<Option<Self::Item>> {
        self.0.poll_recv(cx).map(|chunk| chunk.map(Ok))
    }
}
