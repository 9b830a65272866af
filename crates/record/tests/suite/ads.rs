//! Recordings of a PLC.

use super::{read, recorded, same};
use stiction_record::{End, Error, Fault, Recorded};
use stiction_testkit::devices::{Plc, Script, Variable};

const VARIABLES: [Variable; 4] = [
    Variable::Lreal("MAIN.fActPos"),
    Variable::Real("MAIN.fActVelo"),
    Variable::Dint("MAIN.nTorque[1,2]"),
    Variable::Bool("MAIN.bEnabled"),
];

fn words(plc: &Plc, symbols: &[&str]) -> Vec<String> {
    let url = format!("ads://5.12.34.56.1.1:851@{}/{}", plc.at(), symbols[0]);
    let rest = symbols[1..].iter().map(|symbol| symbol.to_string());
    std::iter::once(url).chain(rest).collect()
}

const SYMBOLS: [&str; 4] = [
    "MAIN.fActPos=mm",
    "MAIN.fActVelo=mm/s",
    "MAIN.nTorque[1,2]",
    "MAIN.bEnabled",
];

fn run(script: Script, out: &str) -> (Recorded, Plc, tempfile::TempDir) {
    let dir = tempfile::tempdir().unwrap();
    let plc = Plc::start(&VARIABLES, 1000.0, script);
    let done = recorded(&words(&plc, &SYMBOLS), 1000.0, 2.0, &dir.path().join(out)).unwrap();
    assert_eq!(plc.refused(), [""; 0]);
    (done, plc, dir)
}

fn assert_holds(done: &Recorded, plc: &Plc, samples: &[usize]) {
    let columns = read(done.path.as_ref().unwrap());
    assert_eq!(columns.len(), 5);
    for (at, (name, _, values)) in columns.iter().enumerate() {
        assert_eq!(values.len(), samples.len(), "{name}");
        for (read, sample) in values.iter().zip(samples) {
            let sent = match at {
                0 => plc.time(*sample),
                _ => plc.value(*sample, at - 1),
            };
            assert!(same(*read, sent), "{name}: {read} is not {sent}");
        }
    }
}

#[test]
fn a_log_holds_what_the_plc_sent() {
    for out in ["log.csv", "log.parquet"] {
        let script = Script {
            samples: 5000,
            ..Script::default()
        };
        let (done, plc, _dir) = run(script, out);
        assert_holds(&done, &plc, &(0..=2000).collect::<Vec<_>>());
        assert!(matches!(done.end, End::Complete), "{:?}", done.end);
        assert_eq!((done.lost, done.gaps, done.reconnects), (0, 0, 0));
        assert_eq!((done.repeated, done.incomplete), (0, 0));
        let columns = read(&done.path.unwrap());
        let named = |at: usize| (columns[at].0.as_str(), columns[at].1.as_deref());
        assert_eq!(named(0), ("time", Some("s")));
        assert_eq!(named(1), ("MAIN.fActPos", Some("mm")));
        assert_eq!(named(2), ("MAIN.fActVelo", Some("mm/s")));
        assert_eq!(named(3), ("MAIN.nTorque[1][2]", None));
        assert_eq!(named(4), ("MAIN.bEnabled", None));
    }
}

#[test]
fn lost_samples_and_connections_are_gaps() {
    let script = Script {
        samples: 5000,
        lost: (200..210).chain(900..950).collect(),
        cuts: [900].into(),
        ..Script::default()
    };
    let (done, plc, _dir) = run(script.clone(), "log.csv");
    let rest: Vec<usize> = (0..=2000).filter(|k| !script.lost.contains(k)).collect();
    assert_holds(&done, &plc, &rest);
    assert_eq!((done.lost, done.gaps, done.reconnects), (60, 2, 1));
}

/// The PLC has sent all, so it reads what is asked of it at the end.
#[test]
fn the_end_of_a_recording_writes_nothing_either() {
    let dir = tempfile::tempdir().unwrap();
    let script = Script {
        samples: 700,
        ..Script::default()
    };
    let plc = Plc::start(&VARIABLES, 1000.0, script);
    let done = recorded(
        &words(&plc, &SYMBOLS),
        1000.0,
        0.699,
        &dir.path().join("log.csv"),
    );
    let done = done.unwrap();
    assert_holds(&done, &plc, &(0..700).collect::<Vec<_>>());
    assert_eq!(plc.refused(), [""; 0]);
    assert_eq!(plc.forgotten(), VARIABLES.len());
}

#[test]
fn a_plc_that_sends_nothing_is_left_as_it_was() {
    let dir = tempfile::tempdir().unwrap();
    let plc = Plc::start(&VARIABLES, 1000.0, Script::default());
    let out = dir.path().join("log.csv");
    let e = recorded(&words(&plc, &SYMBOLS), 1000.0, 1.0, &out).unwrap_err();
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
    assert_eq!(plc.refused(), [""; 0]);
    assert_eq!(plc.forgotten(), VARIABLES.len());
}

#[test]
fn a_symbol_that_is_none_is_refused_by_name() {
    let dir = tempfile::tempdir().unwrap();
    let variables = [Variable::Lreal("MAIN.x"), Variable::Text("MAIN.s")];
    let plc = Plc::start(&variables, 1000.0, Script::default());
    for symbol in ["MAIN.y", "MAIN.s"] {
        let words = words(&plc, &["MAIN.x", symbol]);
        let e = recorded(&words, 1000.0, 1.0, &dir.path().join("log.csv")).unwrap_err();
        let Error::Device { fault, reason, .. } = &e else {
            panic!("{e}");
        };
        assert_eq!(*fault, Fault::Refused);
        assert!(reason.contains(symbol), "{reason}");
    }
    assert_eq!(std::fs::read_dir(dir.path()).unwrap().count(), 0);
    assert_eq!(plc.refused(), [""; 0]);
}
