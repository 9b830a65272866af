//! Requests that nobody should make: no panic, nothing outside the folder, no memory left behind.
//!
//! They are alone in their process, whose memory is counted.

#[path = "../suite/client.rs"]
mod client;

use client::{Served, json, open};

#[global_allocator]
static MEMORY: peak_alloc::PeakAlloc = peak_alloc::PeakAlloc;

/// Numbers that look random, the same every time.
struct Dice(u64);

impl Dice {
    fn below(&mut self, n: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 % n as u64) as usize
    }

    fn of<'a>(&mut self, all: &[&'a str]) -> &'a str {
        all[self.below(all.len())]
    }
}

const METHODS: &[&str] = &[
    "GET", "POST", "PUT", "DELETE", "HEAD", "OPTIONS", "TRACE", "PATCH", "X", "",
];
const PATHS: &[&str] = &[
    "/",
    "/api/log",
    "/api/tiles",
    "/api/map",
    "/api/table",
    "/api/text",
    "/api/upload",
    "/api/jobs",
    "/api/jobs/1/stop",
    "/api/jobs/x/stop",
    "/api/correct",
    "/api/mark",
    "/api/ticket",
    "/api/study",
    "/api/command",
    "/api/session",
    "/open/x/y",
    "/../../etc/passwd",
    "//",
    "/%00",
    "/%2e%2e/%2e%2e/x",
    "*",
    "",
];
const NAMES: &[&str] = &[
    "log.csv",
    "..%2F..%2Fetc%2Fpasswd",
    "%2Fetc%2Fpasswd",
    "out%2Fsecret.csv",
    "axis.toml",
    "%FF%FE",
    "a%00b",
    "con",
    "C%3A%5C",
    "broken.mat",
];
const QUERIES: &[&str] = &[
    "&axis=axis.toml",
    "&channels=force,position&from=0&to=1e9&pixels=1000",
    "&channels=force&from=NaN&to=-inf&pixels=0",
    "&from=1e308&to=-1e308&pixels=18446744073709551615&channels=",
    "&table=true&run=99999999999&from=0&to=1&channels=x",
    "&replace=true",
    "",
];
const BODIES: &[&str] = &[
    "",
    "{",
    "[]",
    "{\"token\":\"x\"}",
    "{\"kind\":\"identify\",\"logs\":[\"../x\"],\"out\":\"..\"}",
    "{\"kind\":\"identify\",\"logs\":[],\"axis\":\"out/axis.toml\",\"out\":\"out/r\"}",
    "{\"kind\":\"check\",\"log\":\"out/secret.csv\"}",
    "{\"kind\":\"check\",\"log\":\"log.csv\",\"after\":\"out/secret.csv\"}",
    "{\"kind\":\"drift\",\"table\":\"out/results.parquet\"}",
    "{\"kind\":\"drift\",\"table\":\"log.csv\",\"limits\":[\">\"],\"names\":true}",
    "{\"kind\":\"simulate\",\"study\":\"log.csv\",\"out\":\"/tmp/x\"}",
    "{\"kind\":\"export\",\"model\":\"log.csv\",\"target\":\"c\",\"cycle_time\":-1,\"out\":\"out/x\"}",
    "{\"log\":\"log.csv\",\"axis\":\"out/axis.toml\",\"role\":\"force\",\"column\":1}",
    "{\"log\":\"log.csv\",\"axis\":\"axis.toml\",\"role\":\"force\",\"column\":18446744073709551615,\"unit\":\"\\u0000\\\"]\\n[x]\"}",
    "{\"log\":\"log.csv\",\"axis\":\"../a.toml\",\"as\":\"fit\",\"from\":-1e300,\"to\":1e300,\"seconds\":1e300}",
    "{\"log\":\"log.csv\",\"axis\":\"axis.toml\",\"as\":\"crop\",\"from\":0,\"to\":0.5,\"seconds\":1}",
    "{\"name\":\"out/x.toml\",\"text\":\"kind = 1\",\"before\":\"\"}",
    "{\"name\":\"study.toml\",\"text\":\"[axis]\\nmodel = \\\"../../x\\\"\",\"before\":\"\"}",
    "{\"name\":\"out\",\"how\":\"zip\"}",
    "{\"name\":\"log.csv\",\"how\":\"save\"}",
    "\u{0}\u{1}\u{2}",
];

/// One of them, and whether it is whole; what cannot be is sent as it is.
fn request(served: &Served, dice: &mut Dice) -> (Vec<u8>, bool) {
    let mut path = dice.of(PATHS).to_string();
    if dice.below(2) == 0 {
        path.push_str(&format!("?name={}{}", dice.of(NAMES), dice.of(QUERIES)));
    }
    let body = match dice.below(20) {
        0 => "[".repeat(100_000),
        1 => "x".repeat(300_000),
        _ => dice.of(BODIES).into(),
    };
    let mut head = format!("{} {path} HTTP/1.{}\r\n", dice.of(METHODS), dice.below(2));
    if dice.below(10) > 0 {
        head.push_str(&format!("host: 127.0.0.1:{}\r\n", served.port));
    }
    if dice.below(4) > 0 {
        head.push_str(&format!("{}\r\n", served.own().join("\r\n")));
    }
    head.push_str(&match dice.below(8) {
        0 => format!("x: {}\r\n", "y".repeat(20_000)),
        1 => "x\u{0}y: z\r\n".into(),
        2 => "range: bytes=0-99999999999\r\n".into(),
        3 => "content-encoding: gzip\r\n".into(),
        _ => format!("{}\r\n", json()),
    });
    let ending = dice.below(10);
    head.push_str(&match ending {
        0 => "content-length: 18446744073709551616\r\n\r\n".into(),
        1 => "content-length: -1\r\n\r\n".into(),
        2 => "transfer-encoding: chunked\r\n\r\nFFFFFFFFFFFFFFFF\r\n".into(),
        3 => format!("content-length: {}\r\n\r\n", body.len() + 10),
        4 => String::new(),
        _ => format!(
            "connection: close\r\ncontent-length: {}\r\n\r\n",
            body.len()
        ),
    });
    let mut bytes = [head.as_bytes(), body.as_bytes()].concat();
    let cut = dice.below(6) == 0;
    if cut {
        bytes.truncate(dice.below(bytes.len().max(1)));
    }
    (bytes, !cut && ending > 4)
}

fn attack(requests: usize) {
    let served = open();
    let outside = tempfile::tempdir().unwrap();
    std::fs::write(
        outside.path().join("secret.csv"),
        "time,secret\n1,777000777\n",
    )
    .unwrap();
    std::fs::write(outside.path().join("axis.toml"), "kind = \"linear\"\n").unwrap();
    #[cfg(unix)]
    std::os::unix::fs::symlink(outside.path(), served.path().join("out")).unwrap();
    let rows: String = (0..2000)
        .map(|k| format!("{},{},{}\n", 1e-3 * f64::from(k), k % 7, k % 5))
        .collect();
    std::fs::write(
        served.path().join("log.csv"),
        format!("time [s],position [mm],force [N]\n{rows}"),
    )
    .unwrap();
    std::fs::write(served.path().join("broken.mat"), [0; 300]).unwrap();
    let mut dice = Dice(0x9e37_79b9_7f4a_7c15);
    let mut level = None;
    for k in 0..requests {
        let (bytes, whole) = request(&served, &mut dice);
        if let Some(answer) = served.raw(&bytes, whole) {
            assert_ne!(
                answer.status,
                500,
                "{}",
                String::from_utf8_lossy(&bytes[..bytes.len().min(600)])
            );
            assert!(
                !answer.text().contains("777000777"),
                "{}",
                String::from_utf8_lossy(&bytes)
            );
        }
        // What is kept at most is kept after the first part of them.
        if k == requests / 3 {
            level = Some(MEMORY.current_usage());
        }
    }
    let after = MEMORY.current_usage();
    assert!(
        after < level.unwrap() + (8 << 20),
        "{after} bytes after {level:?}"
    );
    let mut there: Vec<_> = std::fs::read_dir(outside.path())
        .unwrap()
        .flatten()
        .map(|e| e.file_name())
        .collect();
    there.sort();
    assert_eq!(there, ["axis.toml", "secret.csv"]);
    assert_eq!(
        std::fs::read_to_string(outside.path().join("axis.toml")).unwrap(),
        "kind = \"linear\"\n"
    );
    // It still answers who may ask.
    assert_eq!(served.ask("GET", "/api/workspace", "").status, 200);
}

#[test]
fn hostile_requests_break_nothing() {
    attack(2000);
}

#[test]
#[ignore = "soak: the same, five times as many"]
fn many_hostile_requests_break_nothing() {
    attack(10_000);
}
