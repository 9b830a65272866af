//! A joint whose encoder wraps: what `check` says of its logs, before and after, and what `export` says of its position.

use std::f64::consts::TAU;
use std::fmt::Write;
use std::path::Path;
use std::process::Command;

fn run(dir: &Path, command: &str) -> (i32, String, String) {
    let output = Command::new(env!("CARGO_BIN_EXE_stiction"))
        .args(command.split_whitespace())
        .current_dir(dir)
        .output()
        .unwrap();
    crate::split(output)
}

/// Which of the two columns wrap.
#[derive(Clone, Copy)]
enum Wraps {
    Both,
    Position,
    Neither,
}

/// Six seconds of a joint of 0.4 kg m^2 with 4 N m of friction and a weight, about an angle of 6.3 rad, with a following error of
/// some size, rad, that comes up at each turn of the reference.
fn log(path: &Path, wraps: Wraps, error: f64) {
    let mut text = String::from("Time [s],Reference [rad],Position [rad],Torque [N m]\n");
    for i in 0..6000 {
        let t = f64::from(i) * 1e-3;
        let phase = TAU * 0.5 * t;
        let (stroke, since) = (t.floor(), t.fract());
        let sign = if stroke % 2.0 == 0.0 { -1.0 } else { 1.0 };
        let reference = 6.3 + 1.1 * phase.cos();
        let position = reference - sign * error * (since / 0.03) * (1.0 - since / 0.03).exp();
        let v = -1.1 * 0.5 * TAU * phase.sin();
        let a = -(0.5 * TAU).powi(2) * (reference - 6.3);
        let noise = 0.05 * ((1e4 * t).sin() + (2.3e4 * t).sin());
        let torque = 4.0 * f64::tanh(v / 1e-3) + 1.5 * v + 0.4 * a + 7.0 * reference.sin() + noise;
        let (mut x, mut r) = (position, reference);
        if matches!(wraps, Wraps::Both | Wraps::Position) {
            x = x.rem_euclid(TAU);
        }
        if matches!(wraps, Wraps::Both) {
            r = r.rem_euclid(TAU);
        }
        let _ = writeln!(text, "{t:.4},{r:.7},{x:.7},{torque:.4}");
    }
    std::fs::write(path, text).unwrap();
}

fn first(text: &str) -> &str {
    text.split("\n\n").next().unwrap_or_default()
}

const GRAVITY: &str = "kind = \"rotary\"\n[terms]\ngravity = true\n";
const WRAP: &str = "kind = \"rotary\"\n[log]\nwrap = \"360 deg\"\n[terms]\ngravity = true\n";

#[test]
fn wrapped_logs_are_compared() {
    let dir = tempfile::tempdir().unwrap();
    let dir = dir.path();
    std::fs::write(dir.join("axis.toml"), GRAVITY).unwrap();
    std::fs::write(dir.join("wrap.toml"), WRAP).unwrap();
    for (name, wraps) in [
        ("whole", Wraps::Neither),
        ("both", Wraps::Both),
        ("position", Wraps::Position),
    ] {
        log(&dir.join(format!("{name}-before.csv")), wraps, 1e-3);
        log(&dir.join(format!("{name}-after.csv")), wraps, 2e-4);
    }
    let table = |name: &str, axis: &str| {
        let asked = format!("check {name}-before.csv {name}-after.csv --axis {axis}");
        let (code, out, err) = run(dir, &asked);
        assert!(err.is_empty(), "{err}");
        (code, out.replace(&format!("{name}-"), ""))
    };
    // With its wrap each is what it would be without.
    let (code, due) = table("whole", "axis.toml");
    assert_eq!(code, 0, "{due}");
    assert!(due.starts_with("following error of after.csv"), "{due}");
    assert!(first(&due).contains("worse at no reversal"), "{due}");
    for name in ["both", "position"] {
        let (code, said) = table(name, "wrap.toml");
        assert_eq!(code, 0, "{said}");
        assert_eq!(first(&said), first(&due));
    }
    // Without it: why nothing is compared, and that the jumps are no sign of the force.
    let (_, said) = table("both", "axis.toml");
    let why = "the following error of before.csv is not compared: its reference jumps; where it wraps as the position does, give \
               that travel under [log] in the axis file: wrap = \"360 deg\"";
    assert!(said.starts_with(why), "{said}");
    assert!(said.contains("[position-jump]"), "{said}");
    assert!(!said.contains("force-sign"), "{said}");
    // Scripts are told where it got worse.
    let (code, out, _) = run(
        dir,
        "check whole-after.csv whole-before.csv --axis axis.toml",
    );
    assert_eq!(code, 1, "{out}");
    assert!(
        first(&out).contains("worse at 5 of 5 reversals, most at "),
        "{out}"
    );
    assert!(
        first(&out)
            .trim_end()
            .ends_with("exit code 1, since that is half of them or more"),
        "{out}"
    );
    let (code, out, _) = run(
        dir,
        "check whole-after.csv whole-before.csv --axis axis.toml --json",
    );
    let json: serde_json::Value = serde_json::from_str(&out).unwrap();
    assert_eq!((code, &json["tracking"][0]["worse"]), (1, &true.into()));
}

/// The model of a joint that wrapped keeps that; where a term has no period of a turn the export says what may be fed.
#[test]
fn an_export_says_what_may_be_fed() {
    let dir = tempfile::tempdir().unwrap();
    let dir = dir.path();
    std::fs::write(dir.join("wrap.toml"), WRAP).unwrap();
    log(&dir.join("joint.csv"), Wraps::Both, 1e-3);
    let identify = "identify joint.csv --axis wrap.toml --law coulomb-viscous --out joint";
    let (code, out, err) = run(dir, identify);
    assert!(code < 2, "{out}{err}");
    let model = std::fs::read_to_string(dir.join("joint/model.toml")).unwrap();
    assert!(model.contains("wrap = 6.283185307179586\n"), "{model}");
    let fed = "--target c --feedforward friction,gravity";
    let (_, out, err) = run(dir, &format!("export joint/model.toml {fed} --out c"));
    assert!(!format!("{out}{err}").contains("export-wrap"), "{out}{err}");
    let head = std::fs::read_to_string(dir.join("c/joint_friction.h")).unwrap();
    assert!(head.contains("; whole turns do not count."), "{head}");
    // A wave of 50 degrees has 7.2 pitches in a turn; and whoever moved over more than a turn needs the turns counted.
    let wide = model.replace("[range]\n", "[pitch]\ncogging = [0.87266]\n\n[range]\n");
    let at = wide.find("position = [").unwrap();
    let end = at + wide[at..].find('\n').unwrap();
    let wide = format!("{}position = [0.0, 15.0]{}", &wide[..at], &wide[end..]);
    let wave = "[[parameter]]\nname = \"cogging1_sin\"\nsymbol = \"\"\nvalue = 0.5\nunit = \"N*m\"\nidentifiable = true\norigin = \
                \"identified\"\n\n[[parameter]]\nname = \"cogging1_cos\"\nsymbol = \"\"\nvalue = 0.1\nunit = \"N*m\"\nidentifiable = \
                true\norigin = \"identified\"\n\n[[parameter]]";
    std::fs::write(
        dir.join("wide.toml"),
        wide.replacen("[[parameter]]", wave, 1),
    )
    .unwrap();
    let (_, out, err) = run(dir, &format!("export wide.toml {fed},cogging --out wide"));
    let said = format!("{out}{err}");
    assert!(
        said.contains(
            "the position of the log wraps after 6.283 rad, and cogging1_sin, cogging1_cos depend on it without that period. Feed \
             an unwrapped position, 0 to 15 rad as identified"
        ),
        "{said}"
    );
    let (_, out, err) = run(dir, &format!("export wide.toml {fed} --out weight"));
    assert!(!format!("{out}{err}").contains("export-wrap"), "{out}{err}");
}
