//! Logs that are dropped on the page.

use crate::client::open;
use std::io::Write;
use std::net::TcpStream;

fn names(served: &crate::client::Served) -> Vec<String> {
    let entries = std::fs::read_dir(served.path()).unwrap().flatten();
    entries
        .map(|entry| entry.file_name().into_string().unwrap())
        .collect()
}

#[test]
fn a_whole_upload_has_its_name_and_its_bytes() {
    let served = open();
    let bytes: Vec<u8> = (0..3_000_000_u32).map(|k| (k % 251) as u8).collect();
    let up = |path: &str, bytes: &[u8]| served.send("POST", path, &served.own(), bytes).status;
    assert_eq!(up("/api/upload?name=run%201.csv", &bytes), 200);
    assert_eq!(
        std::fs::read(served.path().join("run 1.csv")).unwrap(),
        bytes
    );
    // It is replaced only if that is asked for.
    assert_eq!(up("/api/upload?name=run%201.csv", b"x"), 409);
    assert_eq!(up("/api/upload?name=run%201.csv&replace=true", b"x"), 200);
    assert_eq!(
        std::fs::read(served.path().join("run 1.csv")).unwrap(),
        b"x"
    );
    assert_eq!(names(&served), ["run 1.csv"]);
}

#[test]
fn nothing_is_left_of_what_breaks_off() {
    let served = open();
    let head = |length: &str| {
        format!(
            "POST /api/upload?name=a.csv HTTP/1.1\r\nconnection: close\r\nhost: 127.0.0.1:{}\r\n{}\r\n{length}\r\n\r\n",
            served.port,
            served.own().join("\r\n")
        )
    };
    for sent in [0, 1, 100_000] {
        let mut stream = TcpStream::connect(("127.0.0.1", served.port)).unwrap();
        stream
            .write_all(head("content-length: 1000000").as_bytes())
            .unwrap();
        stream.write_all(&vec![0; sent]).unwrap();
        drop(stream);
    }
    // Uploads that broke off count among those at the same time until the server has seen their end.
    let answered = |request: &str| {
        for _ in 0..200 {
            let status = served.raw(request.as_bytes(), true).map(|a| a.status);
            if status != Some(503) {
                return status;
            }
            std::thread::sleep(std::time::Duration::from_millis(50));
        }
        None
    };
    let huge = answered(&head("content-length: 99999999999999"));
    assert_eq!(huge, Some(413));
    let chunked = format!("{}0\r\n\r\n", head("transfer-encoding: chunked"));
    assert_eq!(answered(&chunked), Some(400));
    for _ in 0..200 {
        if names(&served).is_empty() {
            return;
        }
        std::thread::sleep(std::time::Duration::from_millis(50));
    }
    panic!("{:?}", names(&served));
}

#[test]
fn names_that_lead_out_are_refused() {
    let served = open();
    let outside = tempfile::tempdir().unwrap();
    #[cfg(unix)]
    std::os::unix::fs::symlink(outside.path(), served.path().join("link")).unwrap();
    for name in [
        "..%2Fx.csv",
        "%2Ftmp%2Fx.csv",
        "link%2Fx.csv",
        "C%3A%5Cx.csv",
        "..%5Cx.csv",
        "a%00.csv",
        "NUL",
        ".hidden",
        "",
    ] {
        for (method, path) in [
            ("POST", format!("/api/upload?name={name}")),
            ("GET", format!("/api/log?name={name}")),
            ("GET", format!("/api/text?name={name}")),
            ("GET", format!("/api/table?name={name}")),
        ] {
            let answer = served.send(method, &path, &served.own(), b"x");
            assert_eq!(answer.status, 403, "{path}: {}", answer.text());
        }
    }
    assert_eq!(std::fs::read_dir(outside.path()).unwrap().count(), 0);
}
