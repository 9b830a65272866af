//! `batch` as a user meets it: the numbers of `identify`, failures as rows, and work that goes on after any end.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};
use stiction_codes::Code;
use stiction_files::batch::{LogRow, read_results};
use stiction_files::result::ResultFile;
use tempfile::TempDir;

/// A log of an axis of 9 kg with that Coulomb and 60 N s/m of viscous friction, with some noise.
fn log(coulomb: f64, samples: u32) -> String {
    let mut out = String::from("Time [s],Position [mm],Force [N]\n");
    let mut noise = 1_u32;
    for k in 0..samples {
        noise = noise.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        let t = 1e-3 * f64::from(k);
        let (sine, cosine) = (libm::sin(6.0 * t), libm::cos(6.0 * t));
        let (x, v) = (0.05 * sine, 0.3 * cosine);
        let force =
            coulomb * libm::tanh(v / 0.002) + 60.0 * v - 9.0 * 36.0 * x + 1e-10 * f64::from(noise);
        let _ = writeln!(out, "{t:.3},{:.6},{force:.4}", 1e3 * x);
    }
    out
}

struct Bench(TempDir);

impl Bench {
    /// Logs that are good, and with `bad` ones that are not.
    fn new(good: u32, bad: bool) -> Self {
        let bench = Bench(tempfile::tempdir().unwrap());
        fs::create_dir(bench.path("logs")).unwrap();
        for k in 0..good {
            let text = log(20.0 + f64::from(k), 3000);
            fs::write(bench.path(&format!("logs/run{k}.csv")), text).unwrap();
        }
        if bad {
            fs::write(bench.path("logs/empty.csv"), "").unwrap();
            fs::write(bench.path("logs/foreign.txt"), "see the other folder\n").unwrap();
            fs::write(bench.path("logs/cut.parquet"), b"PAR1\x00\x00\x00PAR1").unwrap();
            #[cfg(unix)]
            std::os::unix::fs::symlink("nowhere", bench.path("logs/vanished.csv")).unwrap();
        }
        bench
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_stiction"));
        command
            .args(arguments)
            .current_dir(self.0.path())
            .stdin(Stdio::null());
        command
    }

    fn run(&self, arguments: &[&str]) -> (i32, String, String) {
        crate::split(self.command(arguments).output().unwrap())
    }

    fn rows(&self, out: &str) -> Vec<LogRow> {
        rows(&self.path(out).join("results.parquet"))
    }
}

fn rows(path: &Path) -> Vec<LogRow> {
    let mut rows = Vec::new();
    read_results(path, |row| {
        rows.push(row);
        Ok(())
    })
    .unwrap();
    rows
}

const BATCH: [&str; 5] = ["batch", "logs", "--law", "coulomb-viscous", "--out"];

fn batch<'a>(out: &'a str, more: &[&'a str]) -> Vec<&'a str> {
    let mut all = BATCH.to_vec();
    all.push(out);
    all.extend(more);
    all
}

#[cfg(unix)]
#[test]
fn every_log_has_a_row_with_what_identify_finds_or_why_it_failed() {
    let bench = Bench::new(3, true);
    let (code, out, err) = bench.run(&batch("out", &["--reports", "--threads", "2"]));
    assert_eq!((code, err.as_str()), (1, ""));
    insta::assert_snapshot!(out);
    let found = bench.rows("out");
    let failed: Vec<_> = found
        .iter()
        .filter_map(|r| Some((r.path.as_str(), r.error?)))
        .collect();
    assert_eq!(
        failed,
        [
            ("logs/cut.parquet", Code::LogFormat),
            ("logs/empty.csv", Code::LogFormat),
            ("logs/foreign.txt", Code::LogFormat),
            ("logs/vanished.csv", Code::LogIo),
        ]
    );
    let good = found
        .iter()
        .find(|row| row.path == "logs/run1.csv")
        .unwrap();
    bench.run(&[
        "identify",
        "logs/run1.csv",
        "--law",
        "coulomb-viscous",
        "--out",
        "one",
    ]);
    let read =
        |path: PathBuf| -> ResultFile { serde_json::from_slice(&fs::read(path).unwrap()).unwrap() };
    let alone = read(bench.path("one/result.json"));
    assert_eq!(good.sha256.as_ref(), Some(&alone.inputs[0].sha256));
    assert_eq!(good.trustworthy, Some(alone.trust.trustworthy));
    assert_eq!(good.parameters.len(), alone.parameters.len());
    for (row, p) in good.parameters.iter().zip(&alone.parameters) {
        let [low, high] = p.ci95.unwrap_or_default();
        assert_eq!(
            (&row.name, row.value, &row.unit),
            (&p.name, Some(p.value), &p.unit)
        );
        assert_eq!((row.low, row.high, row.std), (low, high, p.std));
        assert_eq!(row.identifiable, p.identifiable);
    }
    // The report of the log is that of identify as well.
    let report = bench.path("out").join(good.report.as_ref().unwrap());
    assert_eq!(
        read(report.join("result.json")).parameters,
        alone.parameters
    );
    assert!(report.join("report.html").is_file() && report.join("model.toml").is_file());
}

#[test]
fn any_number_of_threads_gives_the_same_bytes_and_another_call_takes_what_is_there() {
    let bench = Bench::new(3, false);
    bench.run(&batch("one", &["--threads", "1"]));
    bench.run(&batch("three", &["--threads", "3"]));
    let bytes = |out: &str| fs::read(bench.path(out).join("results.parquet")).unwrap();
    assert_eq!(bytes("one"), bytes("three"));
    // A further log: those before are taken from the finished table.
    fs::write(bench.path("logs/run9.csv"), log(30.0, 3000)).unwrap();
    let (_, out, err) = bench.run(&batch("one", &["--resume"]));
    assert!(
        out.starts_with("4 logs, 3 of them taken from an earlier call\n"),
        "{out}{err}"
    );
    bench.run(&batch("four", &[]));
    assert_eq!(bytes("one"), bytes("four"));
    // Other options: nothing is taken.
    let (_, out, _) = bench.run(&batch("one", &["--resume", "--asymmetric"]));
    assert!(out.starts_with("4 logs\n"), "{out}");
    // A log that was moved is taken, one whose bytes changed is not.
    fs::rename(bench.path("logs/run0.csv"), bench.path("logs/moved.csv")).unwrap();
    fs::write(bench.path("logs/run1.csv"), log(25.0, 3000)).unwrap();
    let (_, out, _) = bench.run(&batch("four", &["--resume"]));
    assert!(out.starts_with("4 logs, 3 of them taken"), "{out}");
    let names: Vec<String> = bench.rows("four").into_iter().map(|row| row.path).collect();
    assert_eq!(
        names,
        [
            "logs/moved.csv",
            "logs/run1.csv",
            "logs/run2.csv",
            "logs/run9.csv"
        ]
    );
}

#[test]
fn a_list_says_of_which_machine_and_when_a_log_is() {
    let bench = Bench::new(2, false);
    fs::write(
        bench.path("x.toml"),
        "name = \"X axis\"\nkind = \"linear\"\n",
    )
    .unwrap();
    let list = "path,machine,time,temperature,axis\nlogs/run0.csv,A7,2026-03-01T06:30:00Z,21.5,\nlogs/run1.csv,,2026-03-02,,x.toml\n";
    fs::write(bench.path("list.csv"), list).unwrap();
    bench.run(&[
        "batch",
        "list.csv",
        "--law",
        "coulomb-viscous",
        "--out",
        "out",
    ]);
    let rows = bench.rows("out");
    let said = |row: &LogRow| {
        (
            row.machine.clone().unwrap(),
            row.time,
            row.temperature,
            row.axis.clone(),
        )
    };
    assert_eq!(
        said(&rows[0]),
        ("A7".into(), Some(1_772_346_600.0), Some(21.5), None)
    );
    assert_eq!(
        said(&rows[1]),
        (
            "X axis".into(),
            Some(1_772_409_600.0),
            None,
            Some("x.toml".into())
        )
    );
    fs::write(bench.path("list.csv"), "path,time\nlogs/run0.csv,noon\n").unwrap();
    let (code, out, err) = bench.run(&["batch", "list.csv", "--out", "out"]);
    assert_eq!((code, out.as_str()), (2, ""));
    assert_eq!(
        err,
        "stiction: [bad-config] list.csv: line 2, column time: \"noon\"; a time in ISO 8601, as 2026-03-01T06:30:00Z, or a number of seconds\n\
         stiction: correct list.csv (line 2), then\nstiction: next: stiction batch list.csv --out out\n"
    );
    for (input, said) in [
        ("nowhere", "[log-io] nowhere: cannot be read"),
        ("no*where", "[usage] no*where names no logs"),
        (
            "out",
            "[usage] out holds what an earlier command has written",
        ),
    ] {
        let (code, _, err) = bench.run(&["batch", input, "--out", "out"]);
        assert!(code == 2 && err.contains(said), "{err}");
    }
}

/// Killed at moments that are spread over the time that it takes, a batch goes on to the same bytes, and nothing is left over.
#[cfg(unix)]
#[test]
fn a_batch_that_is_killed_goes_on_to_the_same_bytes() {
    let bench = Bench::new(6, true);
    let began = Instant::now();
    bench.run(&batch("whole", &[]));
    let takes = began.elapsed();
    let mut kills = 0;
    for k in 0..10 {
        let more: &[&str] = if k == 0 { &[] } else { &["--resume"] };
        let mut child = bench.command(&batch("killed", more));
        let mut child = child
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        std::thread::sleep(takes.mul_f64(0.1 + 0.05 * f64::from(k)));
        kills += usize::from(child.try_wait().unwrap().is_none());
        child.kill().unwrap();
        child.wait().unwrap();
        let table = bench.path("killed/results.parquet");
        if table.exists() {
            assert_eq!(rows(&table).len(), 10);
        }
    }
    assert!(kills > 0);
    let (code, _, _) = bench.run(&batch("killed", &["--resume"]));
    assert_eq!(code, 1);
    let read = |out: &str, name: &str| fs::read(bench.path(out).join(name)).unwrap();
    assert!(read("killed", "results.parquet") == read("whole", "results.parquet"));
    let left: Vec<_> = fs::read_dir(bench.path("killed"))
        .unwrap()
        .map(|e| e.unwrap().file_name())
        .collect();
    assert_eq!(left.len(), 2, "{left:?}");
}

#[cfg(unix)]
#[test]
fn ctrl_c_keeps_what_is_done_and_says_how_to_go_on() {
    let bench = Bench::new(1, false);
    let large = log(20.0, 60_000);
    for k in 0..4 {
        fs::write(
            bench.path(&format!("logs/z{k}.csv")),
            large.replace("0.001,", &format!("0.00{},", k + 1)),
        )
        .unwrap();
    }
    let command = || {
        let _ = fs::remove_dir_all(bench.path("out"));
        bench.command(&["batch", "logs", "--out", "out", "--threads", "1"])
    };
    let (_, (code, out, err)) = crate::interrupted(command);
    assert_eq!(code, 130, "{out}{err}");
    assert!(out.contains("not done"), "{out}");
    assert!(err.ends_with("to go on where it was stopped:\nstiction: next: stiction batch logs --out out --threads 1 --resume\n"), "{err}");
    assert!(!bench.path("out/results.parquet").exists());
    let summary = fs::read_to_string(bench.path("out/batch.json")).unwrap();
    assert!(summary.contains("\"status\": \"interrupted\""));
}

/// A log that grows while it is read, for as long as the batch runs, is a row whatever comes of it, and no end of the batch.
#[test]
fn a_log_that_grows_is_a_row() {
    let bench = Bench::new(1, false);
    let path = bench.path("logs/grows.csv");
    fs::write(&path, log(20.0, 3000)).unwrap();
    let mut child = bench
        .command(&batch("out", &[]))
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let mut file = fs::File::options().append(true).open(&path).unwrap();
    let mut k = 3000;
    while child.try_wait().unwrap().is_none() {
        std::io::Write::write_all(
            &mut file,
            format!("{:.3},0.0,0.0\n", 1e-3 * f64::from(k)).as_bytes(),
        )
        .unwrap();
        k += 1;
        std::thread::sleep(Duration::from_micros(200));
    }
    let rows = bench.rows("out");
    assert_eq!(rows.len(), 2);
    assert!(rows[1].error.is_none() && rows[1].sha256.is_some());
    assert!(
        rows[0].error.is_none() || rows[0].sha256.is_none(),
        "{:?}",
        rows[0]
    );
}

/// A pattern that goes on looking for hours, in folders one in the other: TERM ends it at once, and nothing is written.
#[cfg(unix)]
#[test]
fn looking_for_logs_can_be_stopped() {
    let bench = Bench::new(0, false);
    let deep: PathBuf = (0..60).map(|k| format!("{k}")).collect();
    fs::create_dir_all(bench.path("deep").join(deep)).unwrap();
    let pattern = format!("deep/{}none.csv", "**/*/".repeat(12));
    let mut child = bench.command(&["batch", &pattern, "--out", "out"]);
    let mut child = child.stderr(Stdio::piped()).spawn().unwrap();
    std::thread::sleep(Duration::from_millis(500));
    assert_eq!(child.try_wait().unwrap(), None);
    let term = Command::new("kill").arg(child.id().to_string()).status();
    assert!(term.unwrap().success());
    let (code, _, said) = crate::split(child.wait_with_output().unwrap());
    assert_eq!(code, 130);
    assert!(
        said.contains("[interrupted] stopped; nothing was written"),
        "{said}"
    );
    assert!(!bench.path("out").exists());
}

/// What nobody would see of many logs stands in their rows.
#[test]
fn a_unit_that_was_assumed_stands_in_the_row() {
    let bench = Bench::new(2, false);
    let plain = log(20.0, 3000).replacen("Position [mm]", "Position", 1);
    let plain = plain
        .replacen("Time [s]", "Time", 1)
        .replacen("Force [N]", "Force", 1);
    fs::write(bench.path("logs/run0.csv"), plain).unwrap();
    bench.run(&batch("out", &[]));
    let assumed: Vec<bool> = bench
        .rows("out")
        .iter()
        .map(|row| row.warnings.contains(&Code::UnitAssumed))
        .collect();
    assert_eq!(assumed, [true, false]);
}

/// Logs of several kinds in one folder: which is not trusted, which is a copy, and how each gets an axis file of its own.
#[test]
fn a_folder_of_several_kinds_leads_to_a_list() {
    let bench = Bench::new(2, false);
    fs::copy(bench.path("logs/run1.csv"), bench.path("logs/copy.csv")).unwrap();
    let two = log(20.0, 3000).replacen("Force [N]", "Iq [A]", 1);
    fs::write(
        bench.path("logs/drive.csv"),
        two.replacen("Position [mm]", "Soll", 1),
    )
    .unwrap();
    // A force that has nothing to do with the motion.
    let mut noise = 1_u32;
    let mut stirred = String::from("Time [s],Position [mm],Force [N]\n");
    for line in log(20.0, 3000).lines().skip(1) {
        noise = noise.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        let (motion, _) = line.rsplit_once(',').unwrap();
        let _ = writeln!(stirred, "{motion},{:.3}", f64::from(noise) / 1e8 - 20.0);
    }
    fs::write(bench.path("logs/stirred.csv"), stirred).unwrap();
    let (code, out, err) = bench.run(&batch("out", &["--threads", "1"]));
    assert_eq!((code, err.as_str()), (1, ""));
    insta::assert_snapshot!(out);
    // The list that is proposed, in the folder from which it is called.
    fs::write(bench.path("AXIS.toml"), "[columns]\nposition = { column = \"Soll\", unit = \"mm\" }\nforce = { column = \"Iq\", scale = \"2 N/A\" }\n").unwrap();
    fs::write(
        bench.path("logs.csv"),
        "path,axis\nlogs/drive.csv,AXIS.toml\n",
    )
    .unwrap();
    let proposed = out
        .lines()
        .find(|line| line.starts_with("next: ") && line.contains(" logs.csv "));
    let proposed = proposed
        .unwrap()
        .trim()
        .strip_prefix("next: stiction ")
        .unwrap();
    let (_, out, err) = bench.run(&proposed.split(' ').collect::<Vec<_>>());
    assert_eq!(err, "");
    assert!(
        out.starts_with(
            "5 logs, 4 of them taken from an earlier call, 1 of them a copy of another\n"
        ),
        "{out}"
    );
    assert!(!out.contains("failed     1"), "{out}");
}

/// A list names logs, each of which may be in another list or a folder too: what one leaves open another may say.
#[test]
fn lists_say_together_what_is_known_of_a_log() {
    let bench = Bench::new(2, false);
    fs::write(bench.path("AXIS.toml"), "name = \"A\"\n").unwrap();
    let list = "path,machine,time\nlogs/run1.csv,M1,2026-01-02\nlogs/run0.csv,M1,2026-01-01\n";
    fs::write(bench.path("list.csv"), list).unwrap();
    fs::write(
        bench.path("axes.csv"),
        "path,axis\nlogs/run0.csv,AXIS.toml\n",
    )
    .unwrap();
    let typed = [
        "batch",
        "list.csv",
        "axes.csv",
        "--law",
        "coulomb-viscous",
        "--out",
        "out",
    ];
    let (_, _, err) = bench.run(&typed);
    assert_eq!(err, "");
    let rows = bench.rows("out");
    let said: Vec<_> = rows
        .iter()
        .map(|r| {
            (
                r.path.as_str(),
                r.machine.as_deref(),
                r.time.is_some(),
                r.axis.is_some(),
            )
        })
        .collect();
    assert_eq!(
        said,
        [
            ("logs/run1.csv", Some("M1"), true, false),
            ("logs/run0.csv", Some("M1"), true, true),
        ]
    );
    // A list is no log of a list, and a table that is there stays.
    fs::write(bench.path("self.csv"), "path,machine\nself.csv,M\n").unwrap();
    let (code, _, err) = bench.run(&["batch", "self.csv", "--out", "out"]);
    assert_eq!(code, 2);
    assert!(
        err.contains("self.csv lists self.csv, which is a list itself"),
        "{err}"
    );
    assert_eq!(bench.rows("out").len(), 2);
    // Logs that a later call has not are told.
    let (_, _, err) = bench.run(&[
        "batch",
        "axes.csv",
        "--law",
        "coulomb-viscous",
        "--out",
        "out",
        "--resume",
    ]);
    assert!(
        err.contains("1 log of the table in out is none of this batch"),
        "{err}"
    );
}

/// An axis file that changes while logs are identified mixes no two of them.
#[test]
fn an_axis_file_that_changes_is_a_row() {
    let bench = Bench::new(6, false);
    let axis =
        |scale: u32| format!("[columns]\nforce = {{ column = \"Force\", scale = \"{scale}\" }}\n");
    fs::write(bench.path("axis.toml"), axis(1)).unwrap();
    let mut command = bench.command(&batch("out", &["--axis", "axis.toml", "--threads", "1"]));
    let mut running = command
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let begun = Instant::now();
    while !bench.path("out/batch.json").exists() && begun.elapsed() < Duration::from_secs(60) {
        std::thread::sleep(Duration::from_millis(1));
    }
    fs::write(bench.path("axis.toml"), axis(2)).unwrap();
    running.wait().unwrap();
    for row in bench.rows("out") {
        match row.error {
            Some(code) => assert_eq!(code, Code::LogIo, "{:?}", row.message),
            None => {
                let coulomb = row.parameters.iter().find(|p| p.name == "coulomb").unwrap();
                let own: f64 = row.path[8..9].parse().unwrap();
                let found = coulomb.value.unwrap() / (20.0 + own);
                assert!((found - 1.0).abs() < 0.1, "{}: {found}", row.path);
            }
        }
    }
}
