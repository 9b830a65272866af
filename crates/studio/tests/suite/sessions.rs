//! Who may ask: tried as those would who may not.

use crate::client::{Served, json, open, serve};
use std::path::PathBuf;
use stiction_studio::Studio;

/// An address that any page may be after.
const ASKED: &str = "/api/workspace";

#[test]
fn the_page_is_there_and_its_policy_is_strict() {
    let served = serve();
    for (path, kind) in [
        ("/", "text/html"),
        ("/studio.js", "text/javascript"),
        ("/studio.css", "text/css"),
        ("/icon.svg", "image/svg+xml"),
    ] {
        let answer = served.send("GET", path, &[], b"");
        assert_eq!(answer.status, 200, "{path}");
        assert!(answer.head.contains(kind), "{}", answer.head);
        assert!(!answer.body.is_empty(), "{path}");
        for header in [
            "content-security-policy: default-src 'none'; script-src 'self'; style-src 'self';",
            "x-content-type-options: nosniff",
            "referrer-policy: no-referrer",
            "cross-origin-resource-policy: same-origin",
        ] {
            assert!(answer.head.contains(header), "{header}: {}", answer.head);
        }
    }
    let page = served.send("GET", "/", &[], b"").text();
    assert!(
        !page.contains("<script>") && !page.contains("style="),
        "{page}"
    );
}

#[test]
fn only_both_secrets_open_the_folder() {
    let served = open();
    assert_eq!(served.ask("GET", ASKED, "").status, 200);
    let [cookie, key, origin] = served.own().try_into().unwrap();
    for headers in [
        vec![],
        vec![cookie.clone()],
        vec![key.clone()],
        vec![cookie.clone(), "x-stiction-key: 0".into()],
        vec![format!("{cookie}0"), key.clone()],
        vec![format!("cookie: {}", served.token), key.clone()],
    ] {
        for path in [
            ASKED,
            "/api/events",
            "/api/jobs",
            "/api/text?name=axis.toml",
        ] {
            let answer = served.send("GET", path, &headers, b"");
            assert_eq!(answer.status, 403, "{path} {headers:?}");
        }
    }
    // Neither are what the browser opens by itself, without the cookie.
    std::fs::write(served.path().join("report.html"), "<p>x</p>").unwrap();
    let asked = "{\"name\":\"report.html\",\"how\":\"show\"}";
    let ticket = served.ask("POST", "/api/ticket", asked).json();
    let ticket = ticket.as_str().unwrap();
    assert_eq!(served.send("GET", ticket, &[], b"").status, 403);
    let shown = served.send("GET", ticket, &[cookie], b"");
    assert_eq!((shown.status, shown.text().as_str()), (200, "<p>x</p>"));
    assert!(shown.head.contains("sandbox"), "{}", shown.head);
    assert!(!shown.head.contains("script-src"), "{}", shown.head);
    let _ = (key, origin);
}

#[test]
fn a_wrong_token_gives_nothing() {
    let served = serve();
    for token in ["", "0", &"0".repeat(64), &served.token[..63]] {
        let answer = served.exchange(token);
        assert_eq!(answer.status, 403, "{token}");
        assert!(!answer.head.contains("set-cookie"), "{}", answer.head);
    }
}

#[test]
fn a_token_is_good_once() {
    let served = open();
    let again = served.exchange(&served.token);
    assert_eq!(again.status, 403, "{}", again.text());
    assert!(!again.head.contains("set-cookie"), "{}", again.head);
    assert!(!again.text().contains("key"), "{}", again.text());
    // The session that it was exchanged for goes on.
    assert_eq!(served.ask("GET", ASKED, "").status, 200);
}

/// A server with the file that opens it; `folder` is served.
fn forwarded(folder: tempfile::TempDir) -> (Served, PathBuf) {
    let studio = Studio::open(folder.path(), 0).unwrap();
    let (address, file) = (studio.address().unwrap(), studio.forward().unwrap());
    std::thread::spawn(move || studio.serve());
    let (place, token) = address.split_once("/#token=").unwrap();
    let served = Served {
        folder,
        port: place.rsplit_once(':').unwrap().1.parse().unwrap(),
        token: token.into(),
        session: None,
    };
    (served, file)
}

#[cfg(unix)]
#[test]
fn the_file_that_opens_the_page_is_private_and_goes_when_it_has() {
    use std::os::unix::fs::PermissionsExt;
    let (served, file) = forwarded(tempfile::tempdir().unwrap());
    let folder = file.parent().unwrap();
    let mode = |path: &std::path::Path| path.metadata().unwrap().permissions().mode() & 0o777;
    assert_eq!((mode(&file), mode(folder)), (0o600, 0o700));
    let text = std::fs::read_to_string(&file).unwrap();
    let (_, rest) = text.split_once("url=http://127.0.0.1:").unwrap();
    let (address, _) = rest.split_once('"').unwrap();
    let (port, token) = address.split_once("/#token=").unwrap();
    assert_eq!(port, served.port.to_string());
    // The printed address has another one, so that each opens the page once.
    assert!(token != served.token && !file.to_string_lossy().contains(token));
    assert_eq!(served.exchange(token).status, 200);
    assert!(!file.exists() && !folder.exists());
    assert_eq!(served.exchange(token).status, 403);
    assert_eq!(served.begin().ask("GET", ASKED, "").status, 200);
}

#[test]
fn a_file_that_a_dead_server_left_goes_with_the_next_start() {
    let folder = tempfile::tempdir().unwrap();
    let left = folder.path().join(".stiction-open-aBc");
    std::fs::create_dir(&left).unwrap();
    std::fs::write(left.join("x.html"), "x").unwrap();
    let (_served, _) = forwarded(folder);
    assert!(!left.exists());
}

/// A file that opens the page is of another origin, as every file is.
#[test]
fn a_tab_may_be_sent_to_the_page_and_to_nothing_else() {
    let served = open();
    let own = served.own();
    let sent = |path: &str, to: &str| {
        let mut headers = own.clone();
        headers.pop();
        headers.extend(
            ["cross-site", to]
                .iter()
                .zip(["site", "dest"])
                .map(|(value, name)| format!("sec-fetch-{name}: {value}")),
        );
        served.send("GET", path, &headers, b"").status
    };
    assert_eq!(sent("/", "document"), 200);
    for (path, to) in [
        ("/", "iframe"),
        ("/", "empty"),
        ("/studio.js", "script"),
        (ASKED, "document"),
    ] {
        assert_eq!(sent(path, to), 403, "{path} {to}");
    }
}

#[test]
fn pages_of_other_origins_are_refused() {
    let served = open();
    let port = served.port;
    let [cookie, key, _] = served.own().try_into().unwrap();
    let with = |more: &[&str]| {
        let mut headers = vec![cookie.clone(), key.clone(), json()];
        headers.extend(more.iter().map(ToString::to_string));
        headers
    };
    let body = b"{\"name\":\"x\",\"how\":\"save\"}";
    for origin in [
        "http://evil.example".to_string(),
        format!("http://evil.example:{port}"),
        format!("https://127.0.0.1:{port}"),
        format!("http://127.0.0.1:{}", port ^ 1),
        format!("http://127.0.0.1:{port}.evil.example"),
        format!("http://localhost:{port}"),
        "null".into(),
    ] {
        let origin = format!("origin: {origin}");
        let answer = served.send("POST", "/api/ticket", &with(&[&origin]), body);
        assert_eq!(answer.status, 403, "{origin}");
        let answer = served.send("GET", ASKED, &with(&[&origin]), b"");
        assert_eq!(answer.status, 403, "{origin}");
    }
    // What changes something says where it comes from.
    assert_eq!(
        served.send("POST", "/api/ticket", &with(&[]), body).status,
        403
    );
    let own = served.origin();
    for site in ["cross-site", "same-site", "none"] {
        let site = format!("sec-fetch-site: {site}");
        let answer = served.send("GET", ASKED, &with(&[&own, &site]), b"");
        assert_eq!(answer.status, 403, "{site}");
    }
    let answer = served.send(
        "GET",
        ASKED,
        &with(&[&own, "sec-fetch-site: same-origin"]),
        b"",
    );
    assert_eq!(answer.status, 200);
    // A page cannot be asked to let another origin in.
    let answer = served.send(
        "OPTIONS",
        ASKED,
        &with(&["origin: http://evil.example"]),
        b"",
    );
    assert!(!answer.head.contains("access-control"), "{}", answer.head);
}

#[test]
fn a_name_that_was_made_to_point_here_is_refused() {
    let served = open();
    let port = served.port;
    for host in [
        "evil.example".to_string(),
        format!("evil.example:{port}"),
        "127.0.0.1".into(),
        format!("127.0.0.1:{}", port ^ 1),
        format!("127.0.0.1.evil.example:{port}"),
        format!("[::1]:{port}"),
        format!("2130706433:{port}"),
        format!("0.0.0.0:{port}"),
        String::new(),
    ] {
        let mut headers = served.own();
        headers.push(format!("host: {host}"));
        assert_eq!(
            served.send("GET", ASKED, &headers, b"").status,
            403,
            "{host}"
        );
        // Not even the page.
        let page = served.send("GET", "/", &[format!("host: {host}")], b"");
        assert_eq!(page.status, 403, "{host}");
    }
    let whole = format!(
        "GET http://evil.example/ HTTP/1.1\r\nconnection: close\r\nhost: 127.0.0.1:{port}\r\n\r\n"
    );
    assert_eq!(
        served
            .raw(whole.as_bytes(), true)
            .map(|answer| answer.status),
        Some(403)
    );
    let twice = format!(
        "GET / HTTP/1.1\r\nconnection: close\r\nhost: 127.0.0.1:{port}\r\nhost: evil.example\r\n\r\n"
    );
    assert!(
        served
            .raw(twice.as_bytes(), true)
            .is_none_or(|answer| [400, 403].contains(&answer.status))
    );
}

#[test]
fn two_servers_know_nothing_of_each_other() {
    let (one, other) = (open(), open());
    let mut headers = one.own();
    headers.pop();
    headers.push(other.origin());
    // The cookie of one goes to the other too, since both are on this machine.
    assert_eq!(other.send("GET", ASKED, &headers, b"").status, 403);
}
