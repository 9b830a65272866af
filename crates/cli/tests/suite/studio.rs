//! `stiction studio`: how it starts a browser.

use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::os::unix::fs::PermissionsExt;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// Ends the server with the test.
struct Ends(Child);

impl Drop for Ends {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// Waits for a file that another process renames into place.
fn text(file: &Path) -> String {
    let began = Instant::now();
    while !file.exists() {
        assert!(began.elapsed() < Duration::from_secs(60), "{file:?}");
        std::thread::sleep(Duration::from_millis(20));
    }
    std::fs::read_to_string(file).unwrap()
}

/// The status of an exchange of a token.
fn exchanged(place: &str, token: &str) -> String {
    let body = format!("{{\"token\":\"{token}\"}}");
    let mut stream = TcpStream::connect(place).unwrap();
    let length = body.len();
    let request = format!(
        "POST /api/session HTTP/1.1\r\nconnection: close\r\nhost: {place}\r\norigin: http://{place}\r\n\
         content-type: application/json\r\ncontent-length: {length}\r\n\r\n{body}"
    );
    stream.write_all(request.as_bytes()).unwrap();
    let mut answer = String::new();
    stream.read_to_string(&mut answer).unwrap();
    answer.split(' ').nth(1).unwrap().into()
}

/// Every user of a machine can list the arguments of its processes.
#[test]
fn no_argument_of_the_browser_opens_the_page() {
    let dir = tempfile::tempdir().unwrap();
    let (bin, space, seen) = (
        dir.path().join("bin"),
        dir.path().join("space"),
        dir.path().join("seen"),
    );
    std::fs::create_dir(&bin).unwrap();
    std::fs::create_dir(&space).unwrap();
    let script = "#!/bin/sh\n\
        printf '%s\\n' \"$@\" > \"$SEEN.part\"\n\
        cp \"$1\" \"$SEEN.file\"\n\
        mv \"$SEEN.part\" \"$SEEN\"\n";
    for name in ["xdg-open", "open"] {
        std::fs::write(bin.join(name), script).unwrap();
        std::fs::set_permissions(bin.join(name), PermissionsExt::from_mode(0o755)).unwrap();
    }
    let path = std::env::var("PATH").unwrap_or_default();
    let server = Command::new(env!("CARGO_BIN_EXE_stiction"))
        .args(["studio", "--json"])
        .arg(&space)
        .env("PATH", format!("{}:{path}", bin.display()))
        .env("SEEN", &seen)
        .stdout(Stdio::piped())
        .spawn();
    let mut server = Ends(server.unwrap());
    let mut said = String::new();
    let mut lines = BufReader::new(server.0.stdout.take().unwrap());
    while !said.trim_end().ends_with('}') {
        assert_ne!(lines.read_line(&mut said).unwrap(), 0, "{said}");
    }
    let said: serde_json::Value = serde_json::from_str(&said).unwrap();
    let printed = said["address"].as_str().unwrap();
    let (place, printed) = printed.split_once("/#token=").unwrap();
    let place = place.strip_prefix("http://").unwrap();
    let arguments = text(&seen);
    assert!(
        !arguments.contains("token") && !arguments.contains(printed),
        "{arguments}"
    );
    // It is the path of a file that opens the page, once.
    let file = text(&dir.path().join("seen.file"));
    let (_, rest) = file.split_once(&format!("{place}/#token=")).unwrap();
    let (token, _) = rest.split_once('"').unwrap();
    assert!(!arguments.contains(token), "{arguments}");
    assert_eq!(exchanged(place, token), "200");
    assert_eq!(exchanged(place, token), "403");
    assert!(!Path::new(arguments.trim()).exists(), "{arguments}");
    // So does the address that was printed.
    assert_eq!(exchanged(place, printed), "200");
    assert_eq!(exchanged(place, printed), "403");
    assert_eq!(std::fs::read_dir(&space).unwrap().count(), 0);
}
