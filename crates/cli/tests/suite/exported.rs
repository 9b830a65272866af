//! `simulate --exported-c`: the C of an export, compiled and run in a study.

use std::path::Path;
use std::process::{Command, Stdio};

const STUDY: &str = r#"
[axis]
model        = "model.toml"
mass         = "5 kg"
rate         = "2 kHz"
delay        = "500 us"
encoder      = "50 nm"
peak_force   = "200 N"

[[path]]
kind      = "sine"
amplitude = "2 mm"
frequency = "1 Hz"
cycles    = 3

[[controller]]
kind      = "cascade"
bandwidth = "40 Hz"
"#;

fn run(folder: &Path, arguments: &[&str]) -> (i32, String, String) {
    let output = Command::new(env!("CARGO_BIN_EXE_stiction"))
        .args(arguments)
        .current_dir(folder)
        .stdin(Stdio::null())
        .output()
        .unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    (
        output.status.code().unwrap_or(-1),
        text(output.stdout),
        crate::said(output.stderr),
    )
}

/// A folder with a study, the model of an example and its exported C.
fn desk(model: &str, more: &[&str]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("study.toml"), STUDY).unwrap();
    std::fs::write(folder.path().join("model.toml"), model).unwrap();
    let export = "export model.toml --target c --cycle-time 5e-4 --out c";
    let arguments: Vec<&str> = export.split(' ').chain(more.iter().copied()).collect();
    let (code, _, err) = run(folder.path(), &arguments);
    assert_eq!((code, err.as_str()), (0, ""));
    folder
}

fn lugre() -> String {
    let examples = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/export/model.toml");
    std::fs::read_to_string(examples).unwrap()
}

fn study(folder: &Path) -> serde_json::Value {
    let text = std::fs::read_to_string(folder.join("out/study.json")).unwrap();
    serde_json::from_str(&text).unwrap()
}

const SIMULATE: [&str; 6] = [
    "simulate",
    "study.toml",
    "--exported-c",
    "c",
    "--out",
    "out",
];

/// The C as it was exported gives the force of the compensator in Rust, and reduces the error as it does; with other settings and
/// with levels that follow the machine too.
#[test]
fn exported_c_stands_beside_rust() {
    let more: [&[&str]; 3] = [
        &[],
        &["--gain", "1", "--window", "0", "--ramp", "0.2"],
        &["--adapt", "--limit", "20"],
    ];
    for more in more {
        let folder = desk(&lugre(), more);
        let (code, out, err) = run(folder.path(), &SIMULATE);
        assert_eq!((code, err.as_str()), (0, ""), "{out}");
        assert!(out.contains("exported C in c, compiled and run"), "{out}");
        let study = study(folder.path());
        let exported = &study["exported_c"];
        assert_eq!(exported["same_model"], true);
        let row = &exported["runs"][0];
        assert_eq!(row["differs"], false);
        assert!(row["force_difference"].as_f64().unwrap() < 1e-11, "{row}");
        // An encoder step is where both runs may part.
        assert!(row["position_difference"].as_f64().unwrap() < 1e-6, "{row}");
        let peak = &row["metrics"][1];
        for key in ["rust_reduction_percent", "c_reduction_percent"] {
            assert!(peak[key].as_f64().unwrap() > 50.0, "{peak}");
        }
        let courses = std::fs::read_to_string(folder.path().join("out/trajectories.csv")).unwrap();
        for name in ["\"in Rust\"", "\"exported C\""] {
            assert!(courses.contains(name), "no course {name}");
        }
        let report = std::fs::read_to_string(folder.path().join("out/report.html")).unwrap();
        assert!(report.contains("The exported C"));
    }
}

/// C of which a number was changed gives another force; that is said, with exit code 1.
#[test]
fn another_force_is_said() {
    let folder = desk(&lugre(), &[]);
    let file = folder.path().join("c/x_axis_friction.c");
    let code = std::fs::read_to_string(&file).unwrap();
    let other = code.replace("params->pos.coulomb = 12.0", "params->pos.coulomb = 13.0");
    assert_ne!(code, other);
    std::fs::write(&file, other).unwrap();
    let (code, out, err) = run(folder.path(), &SIMULATE);
    assert_eq!((code, err.as_str()), (1, ""), "{out}");
    assert!(
        out.contains("warning [exported-differs] the C in c gives another force"),
        "{out}"
    );
    assert!(out.contains("NOT THE SAME"), "{out}");
    assert!(out.contains("the code was changed"), "{out}");
    // A gain of .75 on one newton more, and on what the steeper bristles make of a reversal.
    let row = &study(folder.path())["exported_c"]["runs"][0];
    let apart = row["force_difference"].as_f64().unwrap();
    assert!((0.74..1.5).contains(&apart), "{apart}");
}

/// C that gives no number, or more than its limit, ends the comparison: it is no compensator.
#[test]
fn a_force_that_no_compensator_gives_is_refused() {
    for (force, found) in [
        ("0.0 / 0.0", "a force of NaN"),
        ("1e300", "a force of 1.000e300"),
    ] {
        let folder = desk(&lugre(), &[]);
        let file = folder.path().join("c/x_axis_friction.c");
        let code = std::fs::read_to_string(&file).unwrap();
        let own = "_step_in(params, state, params->cycle_time, input);";
        let at = code.rfind(own).unwrap() + own.len();
        let start = code[..at].rfind("return ").unwrap();
        let other = format!("{}return {force};{}", &code[..start], &code[at..]);
        std::fs::write(&file, other).unwrap();
        let (code, out, err) = run(folder.path(), &SIMULATE);
        assert_eq!(code, 2, "{out}{err}");
        assert!(
            err.contains(found) && err.contains("beyond its limit of"),
            "{err}"
        );
    }
}

/// C of another model: its law is not that of the study.
#[test]
fn another_model_is_said() {
    let folder = desk(&lugre(), &[]);
    let model = lugre().replace("value = 12.0", "value = 11.9");
    assert_ne!(model, lugre());
    std::fs::write(folder.path().join("model.toml"), model).unwrap();
    let (code, out, _) = run(folder.path(), &SIMULATE);
    assert_eq!(code, 1, "{out}");
    assert!(out.contains("it has another law"), "{out}");
    let next = "stiction export model.toml --target c --cycle-time 0.0005 --out c-new";
    assert!(out.contains(next), "{out}");
    assert_eq!(study(folder.path())["exported_c"]["same_model"], false);
}

/// What cannot be run is refused before anything is simulated, with what would do.
#[test]
fn what_cannot_be_run_is_refused() {
    let folder = desk(&lugre(), &[]);
    let at = folder.path();
    std::fs::create_dir(at.join("empty")).unwrap();
    let export = "stiction export model.toml --target c --cycle-time 0.0005 --out empty-new";
    let simulate = |dir: &str| {
        let arguments = [
            "simulate",
            "study.toml",
            "--exported-c",
            dir,
            "--out",
            "out",
        ];
        let (code, _, err) = run(at, &arguments);
        assert_eq!(code, 2, "{err}");
        assert!(!at.join("out").exists());
        err
    };
    let err = simulate("empty");
    assert!(err.contains("no header NAME_friction.h"), "{err}");
    assert!(err.contains(export), "{err}");

    // Broken C: the compiler's words.
    let file = at.join("c/x_axis_friction.c");
    let whole = std::fs::read_to_string(&file).unwrap();
    std::fs::write(&file, whole.replace("params->gain", "params->gone")).unwrap();
    let err = simulate("c");
    assert!(err.contains("gcc does not compile it"), "{err}");
    let next = "stiction export model.toml --target c --cycle-time 0.0005 --out c-new";
    assert!(err.contains(next), "{err}");

    // C that never answers.
    let endless = "static void __attribute__((constructor)) endless(void) { for (;;) { } }";
    std::fs::write(&file, format!("{whole}\n{endless}\n")).unwrap();
    let err = simulate("c");
    assert!(
        err.contains("gives no answer within 10 s: it was ended"),
        "{err}"
    );

    // C that prints where its settings are expected.
    let prints = "#include <stdio.h>\nstatic void __attribute__((constructor)) prints(void) { for (int k = 0; k < 9; k++) \
                  { printf(\"compensator \"); } }";
    std::fs::write(&file, format!("{whole}\n{prints}\n")).unwrap();
    let err = simulate("c");
    assert!(
        err.contains("does not begin with its settings") && err.contains(next),
        "{err}"
    );

    // A ramp of which nobody sees the end.
    let slow = whole.replace("params->ramp = 0.05;", "params->ramp = 1e9;");
    assert_ne!(slow, whole);
    std::fs::write(&file, slow).unwrap();
    let err = simulate("c");
    assert!(
        err.contains("--exported-c c: a ramp of 1e9 s; 0, or from 1e-6 to 3600 s")
            && err.contains(next),
        "{err}"
    );
    std::fs::write(&file, whole).unwrap();

    let slower = STUDY.replace("2 kHz", "1 kHz");
    std::fs::write(at.join("study.toml"), slower).unwrap();
    let err = simulate("c");
    assert!(
        err.contains("C for a cycle time of 0.0005 s in a study of 1000 Hz"),
        "{err}"
    );
    assert!(err.contains("--cycle-time 0.001"), "{err}");

    let known = STUDY.replace("model        = \"model.toml\"", "known = \"motor\"");
    std::fs::write(at.join("study.toml"), known).unwrap();
    let err = simulate("c");
    assert!(
        err.contains("a study whose axis has no model file"),
        "{err}"
    );

    // A study file is no way to start a compiler.
    std::fs::write(
        at.join("study.toml"),
        format!("exported_c = \"c\"\n{STUDY}"),
    )
    .unwrap();
    let (code, _, err) = run(at, &["simulate", "study.toml", "--out", "out"]);
    assert_eq!(code, 2);
    assert!(err.contains("exported_c"), "{err}");
}

/// C that goes on in a second process, which holds the pipes and never answers, is ended with all that it started.
#[cfg(unix)]
#[test]
fn c_that_starts_another_program_is_ended() {
    let folder = desk(&lugre(), &[]);
    let file = folder.path().join("c/x_axis_friction.c");
    let whole = std::fs::read_to_string(&file).unwrap();
    let parted = "extern int fork(void);\nextern void _exit(int);\nextern unsigned sleep(unsigned);\n\
                  static void __attribute__((constructor)) parted(void) { if (fork() != 0) { _exit(0); } for (;;) { sleep(1u); } }";
    std::fs::write(&file, format!("{whole}\n{parted}\n")).unwrap();
    let (code, _, err) = run(folder.path(), &SIMULATE);
    assert_eq!(code, 2, "{err}");
    assert!(
        err.contains("gives no answer within 10 s: it was ended"),
        "{err}"
    );
}

/// A study with exported C that ends on the way takes what was done with the same C, and nothing of what was done with another.
#[test]
fn runs_with_exported_c_are_taken_again() {
    let folder = desk(&lugre(), &[]);
    let at = folder.path();
    let second = STUDY.replace("[[controller]]", "[[path]]\nname = \"fast\"\nkind = \"sine\"\namplitude = \"1 mm\"\nfrequency = \"3 Hz\"\ncycles = 3\n\n[[controller]]");
    std::fs::write(at.join("study.toml"), second).unwrap();
    let file = at.join("c/x_axis_friction.c");
    let whole = std::fs::read_to_string(&file).unwrap();
    // C that notes each run, and gives no number on the second path, which alone is faster than 15 mm/s.
    let notes = at.join("notes");
    let own = "_step_in(params, state, params->cycle_time, input);";
    let end = whole.rfind(own).unwrap() + own.len();
    let start = whole[..end].rfind("return ").unwrap();
    let note = |fails: bool| {
        let count = format!(
            "static int calls = 0; if (calls++ == 0) {{ FILE *notes = fopen(\"{}\", \"a\"); fputs(\"run\\n\", notes); fclose(notes); }}",
            notes.display()
        );
        let fault = match fails {
            true => "if (input->reference_velocity > 0.015) { return 0.0 / 0.0; }",
            false => "",
        };
        let text = format!("{}{count} {fault} {}", &whole[..start], &whole[start..]);
        std::fs::write(&file, format!("#include <stdio.h>\n{text}")).unwrap();
    };
    let runs = || std::fs::read_to_string(&notes).map_or(0, |text| text.lines().count());
    let resumed = [&SIMULATE[..], &["--resume"]].concat();

    note(true);
    let (code, _, err) = run(at, &SIMULATE);
    assert_eq!((code, runs()), (2, 2), "{err}");
    let (code, _, err) = run(at, &resumed);
    assert_eq!((code, runs()), (2, 3), "{err}");
    assert!(err.contains("runs are taken"), "{err}");
    // Without the fault it is other C: its runs are made, and those of the study are taken.
    note(false);
    let (code, _, err) = run(at, &resumed);
    assert_eq!((code, runs()), (0, 5), "{err}");
    let taken = study(at);
    let report = std::fs::read(at.join("out/trajectories.csv")).unwrap();
    std::fs::remove_dir_all(at.join("out")).unwrap();
    let (code, _, err) = run(at, &SIMULATE);
    assert_eq!((code, runs()), (0, 7), "{err}");
    assert_eq!(study(at)["exported_c"], taken["exported_c"]);
    assert_eq!(
        std::fs::read(at.join("out/trajectories.csv")).unwrap(),
        report
    );
}
