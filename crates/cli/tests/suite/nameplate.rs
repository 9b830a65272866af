//! The page from the nameplate to the compensator: every command of it, as written, from an empty folder; and plans that the axis
//! of the demo cannot follow.

use crate::page::{Page, run};

const PAGE: Page = Page(include_str!("../../../../docs/from-nameplate.md"));

#[test]
#[ignore = "soak: every command of a page with three plans"]
fn every_command_of_the_page() {
    let dir = tempfile::tempdir().unwrap();
    std::fs::write(dir.path().join("axis.toml"), &PAGE.blocks("toml")[0]).unwrap();
    let commands = PAGE.commands();
    assert_eq!(commands.len(), 7);
    for command in commands {
        let (code, out, err) = run(dir.path(), &command);
        assert_eq!(code, 0, "{command}\n{out}\n{err}");
    }
    // What the page says of the result.
    let text = std::fs::read_to_string(dir.path().join("result/result.json")).unwrap();
    let result: serde_json::Value = serde_json::from_str(&text).unwrap();
    for (name, truth) in [
        ("sigma0", 1.2e5),
        ("sigma1", 600.0),
        ("sigma2", 60.0),
        ("coulomb", 20.0),
        ("static", 30.0),
        ("stribeck_velocity", 5e-3),
        ("mass", 10.0),
    ] {
        let parameters = result["parameters"].as_array().unwrap();
        let found = parameters.iter().find(|p| p["name"] == name).unwrap();
        let ends: Vec<f64> = (0..2).map(|k| found["ci95"][k].as_f64().unwrap()).collect();
        assert!((ends[0]..=ends[1]).contains(&truth), "{name}: {ends:?}");
        let value = found["value"].as_f64().unwrap();
        assert!((value / truth - 1.0).abs() < 0.01, "{name}: {value}");
    }
    assert!(dir.path().join("x_axis").read_dir().unwrap().count() > 2);
}

#[test]
fn a_plan_that_the_axis_of_the_demo_cannot_follow_is_refused() {
    let dir = tempfile::tempdir().unwrap();
    let at = dir.path();
    let axis = "kind = \"rotary\"\nrate = \"500 Hz\"\n[limits]\nstroke = [\"-1 rad\", \"1 rad\"]\nspeed = \"2 rad/s\"\n\
                acceleration = \"20 rad/s2\"\nrated_force = \"4 N m\"\nmass = \"0.05 kg m2\"\n[controller]\nbandwidth = \"20 Hz\"\n";
    std::fs::write(at.join("axis.toml"), axis).unwrap();
    let (code, out, err) = run(at, "plan axis.toml --stage probe --out probe");
    assert_eq!(code, 0, "{out}{err}");
    let refused = |line: &str| {
        let (code, out, err) = run(at, line);
        assert_eq!((code, out.as_str()), (2, ""), "{err}");
        err
    };
    let said = [
        refused("demo --plan probe/plan.toml --out run"),
        refused("demo --plan none.toml --out run"),
    ];
    insta::assert_snapshot!(said.concat());
    assert!(!at.join("run").exists());
}
