//! Recordings of a robot.

use super::{read, recorded, same};
use std::net::TcpListener;
use stiction_record::{Device, End, Error, Fault, Options, Recorded, record};
use stiction_testkit::devices::{Robot, Script, value};

fn url(robot: &Robot) -> Vec<String> {
    vec![format!("rtde://{}", robot.at())]
}

/// A recording of 2 s at 500 Hz, the robot, and the samples that the log should have.
fn run(script: Script, out: &str) -> (Recorded, Robot, tempfile::TempDir) {
    let dir = tempfile::tempdir().unwrap();
    let robot = Robot::start(500.0, script);
    let done = recorded(&url(&robot), 500.0, 2.0, &dir.path().join(out)).unwrap();
    assert_eq!(robot.refused(), [""; 0]);
    (done, robot, dir)
}

/// Every value of the log is what the robot sent, bit for bit.
fn assert_holds(done: &Recorded, robot: &Robot, samples: &[usize]) {
    let columns = read(done.path.as_ref().unwrap());
    assert_eq!(columns.len(), 37);
    assert_eq!(done.rows, samples.len() as u64);
    for (at, (name, _, values)) in columns.iter().enumerate() {
        assert_eq!(values.len(), samples.len(), "{name}");
        for (read, sample) in values.iter().zip(samples) {
            let sent = match at {
                0 => robot.time(*sample),
                _ => value(*sample, at - 1),
            };
            assert!(same(*read, sent), "{name}: {read} is not {sent}");
        }
    }
}

#[test]
fn a_log_holds_what_the_robot_sent() {
    for out in ["log.csv", "log.parquet"] {
        let script = Script {
            samples: 3000,
            ..Script::default()
        };
        let (done, robot, dir) = run(script, out);
        let all: Vec<usize> = (0..=1000).collect();
        assert_holds(&done, &robot, &all);
        assert!(matches!(done.end, End::Complete), "{:?}", done.end);
        assert_eq!((done.lost, done.gaps, done.reconnects), (0, 0, 0));
        assert!((done.rate - 500.0).abs() < 1e-9 && (done.span - 2.0).abs() < 1e-9);
        // Nothing stands beside it.
        assert_eq!(std::fs::read_dir(dir.path()).unwrap().count(), 1);
    }
}

#[test]
fn columns_have_names_and_units() {
    let script = Script {
        samples: 3000,
        ..Script::default()
    };
    let (done, _robot, _dir) = run(script, "log.csv");
    let columns = read(&done.path.unwrap());
    let named = |at: usize| (columns[at].0.as_str(), columns[at].1.as_deref());
    assert_eq!(named(0), ("time", Some("s")));
    assert_eq!(named(1), ("actual_q1", Some("rad")));
    assert_eq!(named(12), ("actual_qd6", Some("rad/s")));
    assert_eq!(named(13), ("actual_current1", Some("A")));
    assert_eq!(named(25), ("target_moment1", Some("N m")));
    assert_eq!(named(36), ("joint_temperature6", Some("°C")));
}

#[test]
fn lost_samples_are_gaps_and_counted() {
    let script = Script {
        samples: 3000,
        lost: [100, 101, 102, 500].into(),
        ..Script::default()
    };
    let (done, robot, _dir) = run(script.clone(), "log.csv");
    let rest: Vec<usize> = (0..=1000).filter(|k| !script.lost.contains(k)).collect();
    assert_holds(&done, &robot, &rest);
    assert_eq!((done.lost, done.gaps, done.reconnects), (4, 2, 0));
    assert!(matches!(done.end, End::Complete));
}

#[test]
fn a_lost_connection_is_made_anew() {
    let script = Script {
        samples: 3000,
        lost: (300..340).collect(),
        cuts: [300, 700].into(),
        ..Script::default()
    };
    let (done, robot, _dir) = run(script.clone(), "log.csv");
    let rest: Vec<usize> = (0..=1000).filter(|k| !script.lost.contains(k)).collect();
    assert_holds(&done, &robot, &rest);
    assert_eq!((done.lost, done.gaps, done.reconnects), (40, 1, 2));
    assert!(matches!(done.end, End::Complete));
}

#[test]
fn a_robot_that_is_gone_leaves_its_log() {
    let script = Script {
        samples: 400,
        gone: true,
        ..Script::default()
    };
    let (done, robot, _dir) = run(script, "log.csv");
    assert_holds(&done, &robot, &(0..400).collect::<Vec<_>>());
    let End::Failed(Error::Device { fault, .. }) = done.end else {
        panic!("{:?}", done.end);
    };
    assert_eq!(fault, Fault::Unreachable);
}

#[test]
fn what_was_recorded_is_kept_on_a_stop() {
    let dir = tempfile::tempdir().unwrap();
    let robot = Robot::start(
        500.0,
        Script {
            samples: 700,
            ..Script::default()
        },
    );
    let mut source = Device::parse(&url(&robot))
        .unwrap()
        .source(Some(500.0))
        .unwrap();
    let out = dir.path().join("log.csv");
    let mut went = |part: f64| part < 0.1;
    let options = Options {
        time: 10.0,
        ..Options::default()
    };
    let done = record(&mut *source, &out, &options, &mut went).unwrap();
    assert!(matches!(done.end, End::Stopped));
    let rows: Vec<usize> = (0..done.rows as usize).collect();
    assert!(rows.len() > 500);
    assert_holds(&done, &robot, &rows);
}

#[test]
fn another_rate_than_the_robot_has_is_refused() {
    let dir = tempfile::tempdir().unwrap();
    let robot = Robot::start(125.0, Script::default());
    // Its recipe has the number 0, which none is.
    let e = recorded(&url(&robot), 500.0, 1.0, &dir.path().join("log.csv")).unwrap_err();
    assert!(
        matches!(
            e,
            Error::Device {
                fault: Fault::Refused,
                ..
            }
        ),
        "{e}"
    );
    assert_eq!(std::fs::read_dir(dir.path()).unwrap().count(), 0);
}

#[test]
fn nobody_there_is_an_error_and_no_file() {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().join("log.csv");
    let closed = TcpListener::bind("127.0.0.1:0")
        .unwrap()
        .local_addr()
        .unwrap();
    let e = recorded(&[format!("rtde://{closed}")], 500.0, 1.0, &out).unwrap_err();
    assert!(
        matches!(
            e,
            Error::Device {
                fault: Fault::Unreachable,
                ..
            }
        ),
        "{e}"
    );
    // One that takes the connection and says nothing.
    let mute = TcpListener::bind("127.0.0.1:0").unwrap();
    let at = mute.local_addr().unwrap();
    let e = recorded(&[format!("rtde://{at}")], 500.0, 1.0, &out).unwrap_err();
    assert!(
        matches!(
            e,
            Error::Device {
                fault: Fault::Silent,
                ..
            }
        ),
        "{e}"
    );
    assert_eq!(std::fs::read_dir(dir.path()).unwrap().count(), 0);
}

#[test]
fn a_file_that_exists_is_kept() {
    let dir = tempfile::tempdir().unwrap();
    let robot = Robot::start(500.0, Script::default());
    for (there, out) in [
        ("log.csv", "log.csv"),
        ("log.csv.part", "log.csv"),
        ("log.csv.part", "log.parquet"),
    ] {
        let path = dir.path().join(there);
        std::fs::write(&path, "mine").unwrap();
        let e = recorded(&url(&robot), 500.0, 1.0, &dir.path().join(out)).unwrap_err();
        assert!(
            matches!(&e, Error::File { path: named, .. } if *named == path),
            "{e}"
        );
        assert_eq!(std::fs::read_to_string(&path).unwrap(), "mine");
        std::fs::remove_file(&path).unwrap();
    }
    let e = recorded(&url(&robot), 500.0, 1.0, &dir.path().join("log.txt")).unwrap_err();
    assert!(matches!(e, Error::Usage { .. }), "{e}");
}
