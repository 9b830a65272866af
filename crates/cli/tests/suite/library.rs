//! `library`: its machines against the recordings they came from, as a user lists and exports them, and in docs/library.md.

mod rebuild;

use rebuild::{Inputs, rebuild};
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::process::Command;
use stiction_files::ModelFile;
use stiction_testkit::{recordings, workspace};
use stiction_workflows::library::{Library, Machine, MachineKind, SCHEMA};

/// The machines that are identified in seconds.
const CHEAP: [&str; 3] = ["tribometer", "so101-rotation", "xl330"];
/// Most bytes of the library.
const MOST: usize = 300_000;

fn folder() -> PathBuf {
    workspace().join("crates/workflows/library")
}

fn stiction(folder: &Path, line: &str) -> (i32, String, String) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_stiction"));
    let words = line.split_whitespace().skip(1);
    crate::split(command.args(words).current_dir(folder).output().unwrap())
}

/// The command behind `next:`.
fn next(said: &str) -> &str {
    let mut lines = said.lines();
    lines
        .find_map(|line| line.trim_start_matches("stiction: ").strip_prefix("next: "))
        .unwrap_or_else(|| panic!("{said}"))
}

fn near(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-6 * a.abs().max(b.abs())
}

#[test]
fn entries_are_what_their_commands_find() {
    let Some(data) = recordings() else { return };
    let library = Library::new();
    let inputs = Inputs {
        program: Path::new(env!("CARGO_BIN_EXE_stiction")),
        library: &folder(),
        data: &data,
        urdfs: None,
    };
    for name in CHEAP {
        let machine = library.machine(name).unwrap();
        let fresh = rebuild(machine, &inputs).unwrap();
        let sums: Vec<&String> = machine.recordings.iter().map(|own| &own.sha256).collect();
        assert_eq!(sums, fresh.sums.iter().collect::<Vec<_>>(), "{name}");
        let (kept, found) = (&machine.found, &fresh.found);
        let again = format!(
            "{name}: {kept:?}, now {found:?}; after an intended change run cargo xtask library"
        );
        assert_eq!(kept.law, found.law, "{again}");
        assert_eq!(kept.usable, found.usable, "{again}");
        assert_eq!(kept.reasons, found.reasons, "{again}");
        let [kept, now] = [kept, found].map(|own| own.held_out_error_percent);
        assert!(near(kept, now), "{again}");
        let work = tempfile::tempdir().unwrap();
        for (path, text) in &fresh.files {
            std::fs::write(work.path().join(path), text).unwrap();
        }
        let [kept, now] = [&folder().join(name), work.path()]
            .map(|own| ModelFile::read(own.join("model.toml")).unwrap().parameter);
        assert_eq!(kept.len(), now.len(), "{again}");
        for (kept, now) in kept.iter().zip(&now) {
            assert_eq!(
                (&kept.name, kept.identifiable),
                (&now.name, now.identifiable),
                "{again}"
            );
            let numbers = [(Some(kept.value), Some(now.value)), (kept.std, now.std)];
            for pair in numbers {
                let is_near = match pair {
                    (Some(a), Some(b)) => near(a, b),
                    (a, b) => a == b,
                };
                assert!(is_near, "{name}: {kept:?}, now {now:?}");
            }
        }
    }
}

#[test]
fn the_index_describes_the_files() {
    let library = Library::new();
    assert_eq!(library.schema, SCHEMA);
    assert!(library.machines.is_sorted_by(|a, b| a.name < b.name));
    let mut bytes = 0;
    for machine in &library.machines {
        let files = machine.files();
        bytes += files.iter().map(|(_, text)| text.len()).sum::<usize>();
        let own = folder().join(&machine.name);
        let is_axis = machine.kind != MachineKind::Robot;
        assert_eq!(own.join("axis.toml").is_file(), is_axis, "{}", machine.name);
        assert_eq!(machine.urdf.is_some(), !is_axis, "{}", machine.name);
        for (path, text) in &files {
            // No absolute path; a topic such as /joint_states is none.
            let mut words = text.split(|c: char| c.is_whitespace() || "\"'`()".contains(c));
            let absolute = |word: &str| word.starts_with('/') && word[1..].contains('/');
            assert_eq!(words.find(|word| absolute(word)), None, "{path}");
            if path.ends_with("model.toml") {
                let model = ModelFile::read(own.join(path)).unwrap();
                assert_eq!(model.source.version, machine.found.version);
                assert!(!model.source.inputs.is_empty());
                let sums = model.source.inputs.iter().map(|input| &input.sha256);
                let known = |sum: &String| machine.recordings.iter().any(|own| own.sha256 == *sum);
                assert!(sums.into_iter().all(known), "{}/{path}", machine.name);
                let of_axis = is_axis.then_some(&machine.found.law);
                let joints = machine.found.joints.iter();
                let of_joint = joints
                    .filter(|joint| path.contains(&format!("/{}/", joint.name)))
                    .map(|joint| &joint.law);
                let law: Vec<_> = of_axis.into_iter().chain(of_joint).collect();
                assert_eq!(law.len(), 1, "{path}");
                assert!(law[0].starts_with(&model.law), "{path}: {law:?}");
            }
        }
    }
    assert!(bytes < MOST, "{bytes} bytes");
}

/// A chain of the joints and links that a robot file names, which stands for the URDF of the machine.
fn urdf(robot: &str) -> String {
    let value = |key: &str| -> Vec<&str> {
        let lines = robot.lines();
        let of = lines.filter_map(|line| line.strip_prefix(key)?.strip_prefix(" = "));
        of.map(|text| text.trim_matches('"')).collect()
    };
    let mut out = String::from("<robot name=\"chain\"><link name=\"base\"/>");
    let mut parent = "base";
    for (joint, link) in value("joint").into_iter().zip(value("link")) {
        let _ = write!(
            out,
            "<link name=\"{link}\"><inertial><mass value=\"1\"/><inertia ixx=\"1\" ixy=\"0\" ixz=\"0\" iyy=\"1\" iyz=\"0\" izz=\"1\"/>\
             </inertial></link><joint name=\"{joint}\" type=\"revolute\"><parent link=\"{parent}\"/><child link=\"{link}\"/>\
             <axis xyz=\"0 1 0\"/><limit lower=\"-3\" upper=\"3\" effort=\"100\" velocity=\"5\"/></joint>"
        );
        parent = link;
    }
    out.push_str("</robot>\n");
    out
}

#[test]
fn every_machine_is_exported_as_it_says() {
    let library = Library::new();
    let work = tempfile::tempdir().unwrap();
    let work = work.path();
    let (code, listed, _) = stiction(work, "stiction library");
    assert_eq!(code, 0);
    for machine in &library.machines {
        let Machine { name, found, .. } = machine;
        assert!(listed.contains(&format!("\n{name} ")), "{listed}");
        let (code, shown, _) = stiction(work, &format!("stiction library {name}"));
        assert!(code == 0 && shown.contains(&machine.source), "{shown}");
        let (code, written, _) = stiction(work, next(&shown));
        assert_eq!(code, 0, "{written}");
        if let Some(file) = &machine.urdf {
            let robot = std::fs::read_to_string(work.join(name).join("robot.toml")).unwrap();
            let file = Path::new(file).file_name().unwrap();
            std::fs::write(work.join(file), urdf(&robot)).unwrap();
        }
        let (code, exported, errors) = stiction(work, next(&written));
        let joints = found.joints.iter().all(|joint| joint.usable);
        let verdict = i32::from(!(found.usable && joints));
        assert_eq!(code, verdict, "{exported}{errors}");
        assert!(exported.contains("docs/deploy/mujoco.md"), "{exported}");
    }
    // The same files once more are no loss; files that were edited are.
    let again = "stiction library tribometer --out tribometer";
    assert_eq!(stiction(work, again).0, 0);
    std::fs::write(work.join("tribometer/axis.toml"), "kind = \"rotary\"\n").unwrap();
    let (code, _, errors) = stiction(work, again);
    assert!(
        code == 2 && errors.contains("axis.toml") && errors.contains("--force"),
        "{errors}"
    );
    assert_eq!(stiction(work, &format!("{again} --force")).0, 0);
}

#[test]
fn a_wrong_name_leads_to_the_right_one() {
    let work = tempfile::tempdir().unwrap();
    let (code, _, errors) = stiction(work.path(), "stiction library xl30 --out x");
    assert_eq!(code, 2);
    assert!(errors.contains("'xl330'"), "{errors}");
    assert!(!work.path().join("x").exists());
    assert_eq!(stiction(work.path(), next(&errors)).0, 0, "{errors}");
    let (_, json, _) = stiction(work.path(), "stiction library --json");
    let read: Library = serde_json::from_str(&json).unwrap();
    assert_eq!(read.machines.len(), Library::new().machines.len());
}

#[test]
fn the_page_has_the_rows_of_the_index() {
    let page = std::fs::read_to_string(workspace().join("docs/library.md")).unwrap();
    let rows: Vec<String> = page
        .lines()
        .filter(|line| line.starts_with("| `"))
        .map(str::to_string)
        .collect();
    let row = |own: &Machine| {
        let found = &own.found;
        let joints = found.joints.iter();
        let alone = joints.clone().filter(|joint| joint.usable).count();
        let verdict = match (found.usable, alone == found.joints.len()) {
            (true, true) => "yes".to_string(),
            (true, false) => format!("yes; friction alone {alone} of {} joints", joints.len()),
            (false, _) => "no".into(),
        };
        let (name, title, kind) = (&own.name, &own.title, own.kind.name());
        let (law, error) = (&found.law, found.held_out_error_percent);
        let licence = own.licence.split(',').next().unwrap();
        format!("| `{name}` | {title} | {kind} | {law} | {error:.1} % | {verdict} | {licence} |")
    };
    let expected: Vec<String> = Library::new().machines.iter().map(row).collect();
    assert_eq!(rows, expected);
}
