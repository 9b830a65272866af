//! A served folder, and requests to it made byte by byte: no library that would mend what is wrong with them.

use std::io::{Read, Write};
use std::net::{Shutdown, TcpStream};
use std::path::Path;
use std::time::Duration;
use stiction_studio::Studio;

/// A folder that is served.
pub struct Served {
    pub folder: tempfile::TempDir,
    pub port: u16,
    pub token: String,
    /// Cookie and key, once there is a session.
    pub session: Option<(String, String)>,
}

/// An answer.
#[derive(Debug)]
pub struct Answer {
    pub status: u16,
    pub head: String,
    pub body: Vec<u8>,
}

impl Answer {
    pub fn text(&self) -> String {
        String::from_utf8_lossy(&self.body).into_owned()
    }

    pub fn json(&self) -> serde_json::Value {
        serde_json::from_slice(&self.body).unwrap_or_else(|e| panic!("{e}: {}", self.text()))
    }
}

/// Serves an empty folder.
pub fn serve() -> Served {
    serve_with(|studio| studio)
}

/// The same with other settings.
pub fn serve_with(set: impl FnOnce(Studio) -> Studio) -> Served {
    let folder = tempfile::tempdir().unwrap();
    let studio = set(Studio::open(folder.path(), 0).unwrap());
    let address = studio.address().unwrap();
    std::thread::spawn(move || studio.serve());
    let (place, token) = address.split_once("/#token=").unwrap();
    let port = place.rsplit_once(':').unwrap().1.parse().unwrap();
    Served {
        folder,
        port,
        token: token.into(),
        session: None,
    }
}

/// The same with a session.
pub fn open() -> Served {
    serve().begin()
}

pub fn json() -> String {
    "content-type: application/json".into()
}

impl Served {
    pub fn path(&self) -> &Path {
        self.folder.path()
    }

    /// Exchanges a token.
    pub fn exchange(&self, token: &str) -> Answer {
        let body = format!("{{\"token\":\"{token}\"}}");
        let headers = [json(), self.origin()];
        self.send("POST", "/api/session", &headers, body.as_bytes())
    }

    /// With a session.
    pub fn begin(mut self) -> Self {
        let answer = self.exchange(&self.token);
        assert_eq!(answer.status, 200, "{}", answer.text());
        let cookie = answer
            .head
            .lines()
            .find_map(|line| line.strip_prefix("set-cookie: "));
        let cookie = cookie.unwrap();
        assert!(cookie.contains("HttpOnly; SameSite=Strict"), "{cookie}");
        let key = answer.json()["key"].as_str().unwrap().to_string();
        self.session = Some((cookie.split(';').next().unwrap().into(), key));
        self
    }

    pub fn origin(&self) -> String {
        format!("origin: http://127.0.0.1:{}", self.port)
    }

    /// Headers of the session.
    pub fn own(&self) -> Vec<String> {
        let (cookie, key) = self.session.as_ref().unwrap();
        vec![
            format!("cookie: {cookie}"),
            format!("x-stiction-key: {key}"),
            self.origin(),
        ]
    }

    /// A request of the page.
    pub fn ask(&self, method: &str, path: &str, body: &str) -> Answer {
        let mut headers = self.own();
        headers.push(json());
        self.send(method, path, &headers, body.as_bytes())
    }

    /// A request with these headers beside host and length.
    pub fn send(&self, method: &str, path: &str, headers: &[String], body: &[u8]) -> Answer {
        let mut head = format!("{method} {path} HTTP/1.1\r\nconnection: close\r\n");
        if !headers.iter().any(|header| header.starts_with("host:")) {
            head.push_str(&format!("host: 127.0.0.1:{}\r\n", self.port));
        }
        for header in headers {
            head.push_str(&format!("{header}\r\n"));
        }
        head.push_str(&format!("content-length: {}\r\n\r\n", body.len()));
        self.raw(&[head.as_bytes(), body].concat(), true)
            .expect("an answer")
    }

    /// Any bytes, which may be less than a whole request; `None` where the server answers nothing.
    pub fn raw(&self, bytes: &[u8], whole: bool) -> Option<Answer> {
        let mut stream = TcpStream::connect(("127.0.0.1", self.port)).unwrap();
        stream
            .set_read_timeout(Some(Duration::from_secs(60)))
            .unwrap();
        // The server may close before it has read all.
        let _ = stream.write_all(bytes);
        if !whole {
            let _ = stream.shutdown(Shutdown::Write);
        }
        let mut all = Vec::new();
        let _ = stream.read_to_end(&mut all);
        let end = all.windows(4).position(|part| part == b"\r\n\r\n")?;
        let head = String::from_utf8_lossy(&all[..end]).into_owned();
        let status = head.split(' ').nth(1)?.parse().ok()?;
        let body = all[end + 4..].to_vec();
        let chunked = head.contains("transfer-encoding: chunked");
        Some(Answer {
            status,
            body: if chunked { unchunked(&body) } else { body },
            head,
        })
    }
}

fn unchunked(mut body: &[u8]) -> Vec<u8> {
    let mut out = Vec::new();
    while let Some(end) = body.windows(2).position(|part| part == b"\r\n") {
        let length = usize::from_str_radix(std::str::from_utf8(&body[..end]).unwrap(), 16).unwrap();
        if length == 0 || body.len() < end + 2 + length {
            break;
        }
        out.extend(&body[end + 2..end + 2 + length]);
        body = &body[(end + 4 + length).min(body.len())..];
    }
    out
}
