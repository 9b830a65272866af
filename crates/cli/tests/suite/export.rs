//! `stiction export` as a user types it: the commands of `examples/export`, a machine without a compiler, a full disk.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn examples() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/export")
}

fn said(output: &Output) -> String {
    format!(
        "{}{}",
        String::from_utf8_lossy(&output.stdout),
        String::from_utf8_lossy(&output.stderr)
    )
}

/// Every command of the page, in a folder that has the examples.
#[test]
fn the_commands_of_the_examples() {
    let page = std::fs::read_to_string(examples().join("README.md")).unwrap();
    let dir = tempfile::tempdir().unwrap();
    std::fs::create_dir_all(dir.path().join("examples/export")).unwrap();
    std::fs::copy(
        examples().join("model.toml"),
        dir.path().join("examples/export/model.toml"),
    )
    .unwrap();
    let commands: Vec<&str> = page
        .lines()
        .filter_map(|l| l.strip_prefix("stiction "))
        .collect();
    assert_eq!(commands.len(), 20);
    for command in commands {
        let output = Command::new(env!("CARGO_BIN_EXE_stiction"))
            .args(command.split(' '))
            .current_dir(dir.path())
            .output()
            .unwrap();
        let text = said(&output);
        assert!(output.status.success(), "{command}: {text}");
        let out = dir.path().join(command.rsplit(' ').next().unwrap());
        assert!(std::fs::read_dir(out).unwrap().count() > 0, "{command}");
        // The page that it names is there.
        let named = text.split("operation as in ").nth(1).unwrap();
        let named = named.split(".md").next().unwrap();
        assert!(
            examples().join(format!("../../{named}.md")).is_file(),
            "{named}"
        );
    }
    let table = Command::new("python3")
        .arg("cnc/x_axis_frict_comp_selftest.py")
        .current_dir(dir.path())
        .output()
        .unwrap();
    assert!(table.status.success(), "{}", said(&table));
}

fn export(target: &str, dir: &Path) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_stiction"));
    command
        .arg("export")
        .arg(examples().join("model.toml"))
        .args(["--target", target, "--out", "out"])
        .current_dir(dir);
    command
}

/// Without gcc there are FMUs all the same, and a warning says what they are.
#[test]
fn no_compiler() {
    let dir = tempfile::tempdir().unwrap();
    let output = export("fmu", dir.path())
        .env("PATH", "/nowhere")
        .output()
        .unwrap();
    let text = said(&output);
    assert!(output.status.success(), "{text}");
    assert!(
        text.contains("warning [export-source]: no C compiler of this machine makes a binary"),
        "{text}"
    );
    let lacks = "no binary inside; with the compiler on the PATH when exporting also for x86_64-linux (x86_64-linux-gnu-gcc), ";
    assert!(text.contains(lacks), "{text}");
    let bytes = std::fs::read(dir.path().join("out/x_axis_friction_fmi2.fmu")).unwrap();
    let holds = |name: &[u8]| bytes.windows(name.len()).any(|w| w == name);
    assert!(holds(b"sources/x_axis_friction.c") && !holds(b"binaries/"));
}

/// What is said to be inside is inside: a binary for each compiler that is there.
#[test]
fn platforms_of_an_fmu() {
    let dir = tempfile::tempdir().unwrap();
    let output = export("fmu", dir.path()).output().unwrap();
    let text = said(&output);
    let bytes = std::fs::read(dir.path().join("out/x_axis_friction_fmi3.fmu")).unwrap();
    let mut stated = Vec::new();
    for (platform, gcc) in [
        ("x86_64-linux", "gcc"),
        ("aarch64-linux", "aarch64-linux-gnu-gcc"),
        ("x86_64-windows", "x86_64-w64-mingw32-gcc"),
    ] {
        let name = format!("binaries/{platform}/x_axis_friction.");
        let is_inside = bytes.windows(name.len()).any(|w| w == name.as_bytes());
        assert_eq!(
            is_inside,
            Command::new(gcc).arg("--version").output().is_ok()
        );
        stated.extend(is_inside.then_some(platform));
    }
    let stated = format!("binaries inside for {}", stated.join(", "));
    assert!(text.contains(&stated), "{text}");
}

/// A time with a unit is told what is meant.
#[test]
fn a_cycle_time_has_a_unit_or_is_in_seconds() {
    let dir = tempfile::tempdir().unwrap();
    let output = export("c", dir.path())
        .args(["--cycle-time", "1rev"])
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(2), "{}", said(&output));
    let allowed = "in seconds or with its unit (us, ms, s, min, h), such as 0.001 or 1ms";
    assert!(said(&output).contains(allowed), "{}", said(&output));
    let output = export("c", dir.path())
        .args(["--cycle-time", "250us"])
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    let out = String::from_utf8(output.stdout).unwrap();
    assert!(out.contains("for a cycle of 0.00025 s"), "{out}");
}

/// No room for the files: nothing has the name of the folder, and nothing is left beside it.
#[test]
#[cfg(unix)]
fn a_full_disk_leaves_nothing() {
    let dir = tempfile::tempdir().unwrap();
    let command = export("c", dir.path());
    // A file may have two blocks of 512 bytes; a longer one is an error as a full disk is.
    let output = Command::new("sh")
        .args(["-c", "ulimit -f 2; trap \"\" XFSZ; exec \"$@\"", "sh"])
        .arg(command.get_program())
        .args(command.get_args())
        .current_dir(dir.path())
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(2), "{}", said(&output));
    assert!(said(&output).contains("out: "), "{}", said(&output));
    assert_eq!(std::fs::read_dir(dir.path()).unwrap().count(), 0);
}

/// As every other command with --out: a folder that holds something is left alone, unless --force.
#[test]
fn force_replaces_an_export() {
    let dir = tempfile::tempdir().unwrap();
    assert!(export("c", dir.path()).output().unwrap().status.success());
    std::fs::write(dir.path().join("out/notes.txt"), "mine").unwrap();
    let name = std::fs::read_dir(dir.path().join("out"))
        .unwrap()
        .map(|e| e.unwrap().path())
        .find(|p| p.extension().is_some_and(|e| e == "h"))
        .unwrap();
    std::fs::write(&name, "old").unwrap();
    let output = export("c", dir.path()).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(said(&output).contains("--force"), "{}", said(&output));
    let output = export("c", dir.path()).arg("--force").output().unwrap();
    assert!(output.status.success(), "{}", said(&output));
    assert_ne!(std::fs::read_to_string(&name).unwrap(), "old");
    let kept = std::fs::read_to_string(dir.path().join("out/notes.txt"));
    assert_eq!(kept.unwrap(), "mine");
}

/// A limit that lets the axis fall, and settings with which a block never compensates, are refused as they were typed, whatever the
/// target.
#[test]
fn settings_that_make_no_compensator_are_refused() {
    let dir = tempfile::tempdir().unwrap();
    let model = std::fs::read_to_string(examples().join("model.toml")).unwrap();
    let offset = "[[parameter]]\nname = \"offset\"\nvalue = -50\nunit = \"N\"\n";
    let head = model.find("[[parameter]]").unwrap();
    let hanging = format!("{}{offset}\n{}", &model[..head], &model[head..]);
    std::fs::write(dir.path().join("hanging.toml"), hanging).unwrap();
    for (typed, says) in [
        (
            "--feedforward friction,gravity --limit 40",
            "a limit of 40.00 N below the weight that is fed forward; above 50.00 N",
        ),
        ("--slew 1e-300", "a slew of 1e-300 N/s; from 0.005000 N/s"),
        ("--slew 1e300", "a slew of 1e300 N/s; from 0.005000 N/s"),
        (
            "--window 1e-300",
            "a window of 1e-300 s; from the cycle time",
        ),
        (
            "--ramp 1e300",
            "a ramp of 1e300 s; 0, or from 1e-6 to 3600 s",
        ),
        (
            "--ramp 1e-300",
            "a ramp of 1e-300 s; 0, or from 1e-6 to 3600 s",
        ),
    ] {
        for target in ["c", "st", "rust", "hal"] {
            let output = Command::new(env!("CARGO_BIN_EXE_stiction"))
                .args(["export", "hanging.toml", "--out", "out", "--target", target])
                .args(typed.split(' '))
                .current_dir(dir.path())
                .output()
                .unwrap();
            let text = said(&output);
            assert_eq!(output.status.code(), Some(2), "{text}");
            assert!(text.contains(says), "{text}");
        }
    }
}

/// A law is refused by the name that it has in the file.
#[test]
fn a_law_that_a_target_has_not_is_named() {
    let dir = tempfile::tempdir().unwrap();
    let model = "law = \"dahl\"\nparameter = [\n\
                 { name = \"sigma0\", value = 2e6, unit = \"N/m\" },\n\
                 { name = \"sigma2\", value = 30, unit = \"N*s/m\" },\n\
                 { name = \"coulomb_pos\", value = 12, unit = \"N\" },\n\
                 { name = \"coulomb_neg\", value = 13, unit = \"N\" },\n]\n";
    std::fs::write(dir.path().join("dahl.toml"), model).unwrap();
    let output = Command::new(env!("CARGO_BIN_EXE_stiction"))
        .args(["export", "dahl.toml", "--out", "out", "--target", "mujoco"])
        .current_dir(dir.path())
        .output()
        .unwrap();
    let text = said(&output);
    assert_eq!(output.status.code(), Some(2), "{text}");
    assert!(text.contains("the law dahl, asymmetric"), "{text}");
}

/// What the model has not is refused with the whole line that works, and that line works.
#[test]
fn what_is_not_fed_forward_is_refused_with_the_line_that_works() {
    let dir = tempfile::tempdir().unwrap();
    let refused = export("c", dir.path())
        .args([
            "--cycle-time",
            "0.0005",
            "--feedforward",
            "friction,mass,cogging",
        ])
        .output()
        .unwrap();
    let text = said(&refused);
    assert_eq!(refused.status.code(), Some(2), "{text}");
    let line = text.split("what works: stiction ").nth(1).unwrap().trim();
    assert!(
        line.ends_with("--cycle-time 0.0005 --feedforward friction"),
        "{line}"
    );
    let works = Command::new(env!("CARGO_BIN_EXE_stiction"))
        .args(line.split(' '))
        .current_dir(dir.path())
        .output()
        .unwrap();
    assert!(works.status.success(), "{}", said(&works));
}

/// Exported into its own folder again it replaces its own files and keeps others; what somebody wrote or changed is not replaced.
#[test]
fn an_export_replaces_its_own_files_and_only_these() {
    for (target, name) in [
        ("c", "x_axis_friction.h"),
        ("cpp", "examples/Axis/Axis.ino"),
        ("matlab", "x_axis_params.m"),
        ("rust", "src/lib.rs"),
        ("fmu", "x_axis_friction_fmi2.fmu"),
    ] {
        let dir = tempfile::tempdir().unwrap();
        let out = dir.path().join("out");
        let run = |more: &[&str]| {
            let output = export(target, dir.path()).args(more).output().unwrap();
            (output.status.code(), said(&output))
        };
        assert_eq!(run(&[]).0, Some(0), "{target}");
        std::fs::write(out.join("main.c"), "int x;\n").unwrap();
        let file = out.join(name);
        let before = std::fs::read(&file).unwrap();
        let (code, text) = run(&["--gain", "0.5", "--cycle-time", "2ms"]);
        assert_eq!(code, Some(0), "{target}: {text}");
        assert_ne!(std::fs::read(&file).unwrap(), before, "{target}");
        let kept = std::fs::read_to_string(out.join("main.c")).unwrap();
        assert_eq!(kept, "int x;\n");
        // One that was changed since, and one that is another's.
        let changed = [&std::fs::read(&file).unwrap()[..], b"\n"].concat();
        std::thread::sleep(std::time::Duration::from_millis(50));
        for text in [&changed[..], b"mine"] {
            std::fs::write(&file, text).unwrap();
            let (code, err) = run(&[]);
            assert_eq!(code, Some(2), "{target}: {err}");
            assert!(err.contains(name) && err.contains("--out out-2"), "{err}");
            assert_eq!(std::fs::read(&file).unwrap(), text);
        }
        assert_eq!(run(&["--force"]).0, Some(0));
        assert_ne!(std::fs::read(&file).unwrap(), b"mine");
        let entries = std::fs::read_dir(&out).unwrap();
        let mut names = entries.map(|e| e.unwrap().file_name().into_string().unwrap());
        assert!(!names.any(|name| name.starts_with(".stiction")), "{target}");
    }
}
