//! The procedures from the command line: the logs of the demo, and the commands it names.

use crate::page::run;

/// Every command that the demo names does what it says, in the order named.
#[test]
#[ignore = "soak: every command of a page"]
fn the_commands_of_the_demo() {
    let dir = tempfile::tempdir().unwrap();
    let (code, out, err) = run(dir.path(), "demo --procedures --out demo");
    assert_eq!((code, err.as_str()), (0, ""));
    let commands: Vec<&str> = out
        .lines()
        .filter_map(|line| line.trim().strip_prefix("stiction "))
        .collect();
    assert_eq!(commands.len(), 4, "{out}");
    let sections = [
        "static_map",
        "static_then_dynamic",
        "presliding_step",
        "break_away",
    ];
    for (command, section) in commands.iter().zip(sections) {
        let (code, out, err) = run(dir.path(), &format!("{command} --json"));
        assert_eq!((code, err.as_str()), (0, ""), "{command}: {out}");
        let result: serde_json::Value = serde_json::from_str(&out).unwrap();
        assert!(!result[section].is_null(), "{command}: no {section}");
        assert_eq!(result["trust"]["trustworthy"], true);
    }
    // What was not used is not there.
    let (_, plain, _) = run(
        dir.path(),
        "identify demo/motion.csv --law coulomb-viscous --out x --json",
    );
    assert!(
        sections
            .iter()
            .all(|s| !plain.contains(&format!("\"{s}\":")))
    );
    // For people: tables with both methods, and a usage error that says what fits.
    let (code, out, _) = run(
        dir.path(),
        "identify demo/step_1.csv --method presliding-step --static demo/speeds.csv --out y",
    );
    assert!(
        out.contains("simulated (used)") && out.contains("inverted, demo/step_1.csv"),
        "{out}"
    );
    assert_eq!(code, 0, "{out}");
    let (code, _, err) = run(
        dir.path(),
        "identify demo/speeds.csv --method static --static demo/motion.csv --out z",
    );
    assert_eq!(code, 2);
    assert!(err.contains("[usage]"), "{err}");
}
