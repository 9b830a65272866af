//! Who sends slowly holds no place.

use crate::client::{Served, json, open, serve_with};
use std::io::{Read, Write};
use std::net::TcpStream;
use std::time::{Duration, Instant};

/// Longer than a request of this test takes, and short for those who wait for it.
const PATIENCE: Duration = Duration::from_millis(500);
/// More connections than are taken at once.
const MANY: usize = 300;

fn served() -> Served {
    serve_with(|studio| studio.with_patience(PATIENCE)).begin()
}

/// A connection on which a request began and nothing follows.
fn begun(served: &Served, request: &str) -> TcpStream {
    let mut stream = TcpStream::connect(("127.0.0.1", served.port)).unwrap();
    let patient = Some(Duration::from_secs(60));
    stream.set_read_timeout(patient).unwrap();
    stream.write_all(request.as_bytes()).unwrap();
    stream
}

/// What the server says before it closes the connection.
fn rest(mut stream: TcpStream) -> String {
    let mut text = Vec::new();
    stream.read_to_end(&mut text).expect("it is closed in time");
    String::from_utf8_lossy(&text).into_owned()
}

#[test]
fn heads_that_do_not_end_are_given_up() {
    let served = served();
    let half = format!("GET / HTTP/1.1\r\nhost: 127.0.0.1:{}\r\nx: ", served.port);
    let all: Vec<TcpStream> = (0..MANY).map(|_| begun(&served, &half)).collect();
    // Who may ask is answered meanwhile.
    assert_eq!(served.ask("GET", "/api/workspace", "").status, 200);
    for stream in all {
        let said = rest(stream);
        assert!(!said.contains(" 200 "), "{said}");
    }
}

#[test]
fn bodies_that_do_not_come_are_given_up() {
    let served = served();
    let head = |path: &str| {
        format!(
            "POST {path} HTTP/1.1\r\nhost: 127.0.0.1:{}\r\n{}\r\n{}\r\ncontent-length: 1000\r\n\r\n{{",
            served.port,
            served.own().join("\r\n"),
            json()
        )
    };
    for path in ["/api/session", "/api/jobs", "/api/upload?name=a.csv"] {
        let said = rest(begun(&served, &head(path)));
        assert!(said.starts_with("HTTP/1.1 4"), "{path}: {said}");
    }
    // Nothing is left of the upload, and its place is free.
    assert_eq!(std::fs::read_dir(served.path()).unwrap().count(), 0);
    let up = |name: &str| served.send("POST", name, &served.own(), b"x").status;
    assert_eq!(up("/api/upload?name=b.csv"), 200);
}

/// With the usual patience, which is longer than anybody waits for a page.
#[test]
fn connections_without_a_session_do_not_hold_up_one_that_has() {
    let served = open();
    let (own, origin) = (served.own().join("\r\n"), served.origin());
    let host = format!("host: 127.0.0.1:{}", served.port);
    let mut kept = begun(
        &served,
        &format!("GET /api/workspace HTTP/1.1\r\n{host}\r\n{own}\r\n\r\n"),
    );
    let mut first = [0; 12];
    kept.read_exact(&mut first).unwrap();
    let halves = [
        String::new(),
        format!("GET / HTTP/1.1\r\n{host}\r\nx: "),
        // A body that nobody has to show anything for.
        format!(
            "POST /api/session HTTP/1.1\r\n{host}\r\n{origin}\r\n{}\r\ncontent-length: 100\r\n\r\n{{",
            json()
        ),
    ];
    for half in &halves {
        let all: Vec<TcpStream> = (0..385).map(|_| begun(&served, half)).collect();
        let began = Instant::now();
        for _ in 0..10 {
            assert_eq!(served.ask("GET", "/api/workspace", "").status, 200);
            assert_eq!(served.send("GET", "/", &[], b"").status, 200);
        }
        assert!(began.elapsed() < Duration::from_secs(5), "{half:?}");
        drop(all);
    }
    // A connection that was there before is open still.
    let again = format!("GET /api/jobs HTTP/1.1\r\nconnection: close\r\n{host}\r\n{own}\r\n\r\n");
    kept.write_all(again.as_bytes()).unwrap();
    assert!(rest(kept).contains("\r\n\r\n[]"));
}

/// An upload may take long, as long as something comes.
#[test]
fn a_slow_upload_that_goes_on_is_taken() {
    let served = served();
    let pieces = 8;
    let head = format!(
        "POST /api/upload?name=a.csv HTTP/1.1\r\nhost: 127.0.0.1:{}\r\nconnection: close\r\n{}\r\ncontent-length: {pieces}\r\n\r\n",
        served.port,
        served.own().join("\r\n")
    );
    let mut stream = begun(&served, &head);
    for _ in 0..pieces {
        std::thread::sleep(PATIENCE / 5);
        stream.write_all(b"x").unwrap();
    }
    let said = rest(stream);
    assert!(said.starts_with("HTTP/1.1 200"), "{said}");
}
