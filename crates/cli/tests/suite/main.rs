//! The integration tests of `stiction-cli` in one program, which is linked once: a new file is a module here.

mod batch;
mod cli;
mod drift;
mod export;
mod exported;
mod faults;
mod gallery;
#[cfg(target_os = "linux")]
mod killed;
mod leads;
mod level_map;
mod library;
#[cfg(unix)]
mod linuxcnc;
mod nameplate;
#[cfg(target_os = "linux")]
mod onward;
mod page;
mod paper;
#[cfg(unix)]
mod pasted;
mod plan;
mod procedures;
mod record;
#[cfg(unix)]
mod replayed;
mod resumed;
mod robot;
mod rows;
mod searches;
#[cfg(all(unix, feature = "studio"))]
mod studio;
mod study;
mod wrapped;

/// What a command said on standard error, without the lines that tell how far long work is: how many there are depends on the
/// machine.
fn said(stderr: Vec<u8>) -> String {
    let is_progress = |line: &&str| {
        let rest = line.strip_prefix("stiction: ").unwrap_or_default();
        let time = rest.split_once(" s: ").map(|(time, _)| time);
        time.is_some_and(|time| time.parse::<u64>().is_ok())
    };
    let text = String::from_utf8(stderr).unwrap();
    let lines = text.split_inclusive('\n');
    lines.filter(|line| !is_progress(line)).collect()
}

/// Exit code, standard output and standard error of a command, which did not panic.
fn split(output: std::process::Output) -> (i32, String, String) {
    let out = String::from_utf8(output.stdout).unwrap();
    let err = said(output.stderr);
    assert!(!err.contains("panicked"), "{err}");
    (output.status.code().unwrap_or(-1), out, err)
}

/// Runs a command and interrupts it, later where it was still reading its log; since when, and how it ended.
#[cfg(unix)]
fn interrupted(
    command: impl Fn() -> std::process::Command,
) -> (std::time::Instant, (i32, String, String)) {
    for wait in [700, 1400, 2800, 5600, 11_200] {
        let mut child = command()
            .stdout(std::process::Stdio::piped())
            .stderr(std::process::Stdio::piped())
            .spawn()
            .unwrap();
        std::thread::sleep(std::time::Duration::from_millis(wait));
        assert!(
            child.try_wait().unwrap().is_none(),
            "too short to interrupt"
        );
        let clock = std::time::Instant::now();
        interrupt(&child);
        let ended = split(child.wait_with_output().unwrap());
        if !ended.2.contains("nothing was written") {
            return (clock, ended);
        }
    }
    panic!("the log is read for too long");
}

/// Ctrl-C for a command.
#[cfg(unix)]
fn interrupt(child: &std::process::Child) {
    let kill = std::process::Command::new("kill")
        .args(["-INT", &child.id().to_string()])
        .status()
        .unwrap();
    assert!(kill.success());
}
