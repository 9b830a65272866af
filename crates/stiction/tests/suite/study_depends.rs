//! Friction of a study that depends on load, temperature and position.

use crate::study::{CASCADE, Desk, WHOLE, row, together};
use stiction_files::study::result::StudyFile;

/// 12 N of Coulomb friction: a third more at the end of the stroke, 2 % less a kelvin, and in proportion to the load.
const MODEL: &str = r#"
law = "lugre"
parameter = [
    { name = "sigma0", value = 2e6, unit = "N/m" },
    { name = "sigma1", value = 1500, unit = "N*s/m" },
    { name = "sigma2", value = 30, unit = "N*s/m" },
    { name = "coulomb", value = 12, unit = "N" },
    { name = "static", value = 18, unit = "N" },
    { name = "stribeck_velocity", value = 0.003, unit = "m/s" },
    { name = "coulomb_position", value = 20, unit = "N/m" },
    { name = "position_reference", value = 0.3, unit = "m" },
    { name = "coulomb_temperature", value = -0.24, unit = "N/K" },
    { name = "temperature_reference", value = 300, unit = "K" },
    { name = "coulomb_load", value = 0.12, unit = "N/N" },
    { name = "load_reference", value = 100, unit = "N" },
    { name = "mass", value = 4.6, unit = "kg" },
]
"#;

const RANGE: &str = r#"
[range]
position = [0.1, 0.5]
temperature = [290.0, 320.0]
load = [50.0, 200.0]
"#;

const AXIS: &str = r#"
[axis]
model        = "model.toml"
rate         = "4 kHz"
current_loop = "1 kHz"
peak_force   = "1248 N"
"#;

/// To one end of the stroke and back, slowly.
const FAR: &str = r#"
[[path]]
kind      = "sine"
amplitude = "150 mm"
frequency = "0.2 Hz"
cycles    = 2
"#;

const UNTOLD: &str = r#"
[[compensator]]
name     = "untold"
kind     = "lugre"
gain     = 1.0
watchdog = false
ramp     = "0 s"
inputs   = false
"#;

fn desk() -> Desk {
    let desk = Desk::new();
    desk.write("model.toml", &format!("{MODEL}{RANGE}"));
    desk
}

fn error(file: &StudyFile, compensator: &str) -> f64 {
    let row = row(file, compensator, "exact");
    row.metric("rms_error").unwrap().mean
}

/// A compensator that is told what friction depends on leaves little; one that is not leaves what it does not know.
#[test]
fn what_a_sensor_is_worth() {
    let axis = AXIS.replace(
        "rate ",
        "load = \"150 N\"\ntemperature = \"37 degC\"\nrate ",
    );
    let file = desk().run(&together(&[&axis, FAR, CASCADE, WHOLE, UNTOLD]));
    assert!(file.warnings.is_empty(), "{:?}", file.warnings);
    let [none, told, untold] = ["none", "whole", "untold"].map(|name| error(&file, name));
    assert!(
        told < 0.1 * none && told < 0.3 * untold,
        "{none} {told} {untold}"
    );
    let entry = &file.axis;
    assert_eq!(entry.load, Some(150.0));
    assert!((entry.temperature.unwrap() - 310.15).abs() < 1e-9);
    assert_eq!(entry.position, Some(0.3));
}

/// Viscous friction that bends is on the axis, and in every compensator of it: without it a third of the friction at speed would
/// be left.
#[test]
fn viscous_friction_bends() {
    let desk = Desk::new();
    let plain = MODEL
        .lines()
        .filter(|l| !l.contains("coulomb_") && !l.contains("_reference"))
        .collect::<Vec<_>>()
        .join("\n");
    let bent = plain.replace(
        "    { name = \"mass\"",
        "    { name = \"quadratic_viscous\", value = 60, unit = \"N*s^2/m^2\" },\n    { name = \"mass\"",
    );
    assert_ne!(plain, bent);
    desk.write("model.toml", &format!("{bent}\n[range]\nspeed = 0.5\n"));
    let fast = FAR.replace("0.2 Hz", "0.5 Hz");
    let file = desk.run(&together(&[AXIS, &fast, CASCADE, WHOLE]));
    assert!(file.warnings.is_empty(), "{:?}", file.warnings);
    let [none, whole] = ["none", "whole"].map(|name| error(&file, name));
    assert!(whole < 0.1 * none, "{none} {whole}");
    // Without the range it is left out, which is said.
    desk.write("model.toml", &bent);
    let file = desk.run(&together(&[AXIS, &fast, CASCADE, WHOLE]));
    let said = &file.warnings[0].message;
    assert!(
        said.contains("quadratic_viscous") && said.contains("[range] speed"),
        "{said}"
    );
    let less = error(&file, "none");
    assert!(less < 0.95 * none, "{none} {less}");
}

/// At its references, in the middle of its stroke, the axis is the one without any of it; a load makes it another.
#[test]
fn at_its_references_the_level_is_that_of_the_law() {
    let desk = desk();
    let plain = MODEL
        .lines()
        .filter(|l| !l.contains("coulomb_") && !l.contains("_reference"));
    desk.write("plain.toml", &plain.collect::<Vec<_>>().join("\n"));
    let there = FAR.replace("150 mm", "0.1 mm").replace("0.2 Hz", "4 Hz");
    let run = |axis: &str| {
        let file = desk.run(&together(&[axis, &there, CASCADE]));
        assert!(file.warnings.is_empty(), "{:?}", file.warnings);
        error(&file, "none")
    };
    let plain = run(&AXIS.replace("model.toml", "plain.toml"));
    let own = run(AXIS);
    assert!((own / plain - 1.0).abs() < 1e-3, "{own} {plain}");
    let laden = run(&AXIS.replace("rate ", "load = \"200 N\"\nrate "));
    // Twice the level: the error at reversals is a little more than twice as large.
    assert!((1.7..2.6).contains(&(laden / plain)), "{}", laden / plain);
}

/// Two axes along a circle, one of which depends on its position.
#[test]
fn a_contour_has_it_too() {
    let second =
        "\n[second_axis]\nknown = \"motor\"\ncurrent_loop = \"1 kHz\"\npeak_force = \"1248 N\"\n";
    let circle = "\n[[contour]]\nkind = \"circle\"\nradius = \"100 mm\"\nvelocity = \"100 mm/s\"\n";
    let file = desk().run(&together(&[AXIS, second, circle, CASCADE, WHOLE, UNTOLD]));
    let deviation = |name: &str| {
        let row = row(&file, name, "exact");
        row.metric("contour_rms").unwrap().mean
    };
    let [none, told, untold] = ["none", "whole", "untold"].map(deviation);
    assert!(told < untold && untold < none, "{none} {told} {untold}");
}

#[test]
fn what_is_refused() {
    let desk = desk();
    let mut out = String::new();
    for (axis, compensator) in [
        ("load = \"20 N\"", WHOLE),
        ("load = 150", WHOLE),
        ("temperature = \"80 degC\"", WHOLE),
        ("temperature = \"80 mm\"", WHOLE),
    ] {
        let axis = AXIS.replace("rate ", &format!("{axis}\nrate "));
        out += &desk.refusal(&together(&[&axis, FAR, CASCADE, compensator]));
        out.push('\n');
    }
    let known = AXIS.replace("model        = \"model.toml\"", "known = \"motor\"");
    out += &desk.refusal(&together(&[&known, FAR, CASCADE, UNTOLD]));
    out.push('\n');
    let known = known.replace("rate ", "load = \"150 N\"\nrate ");
    out += &desk.refusal(&together(&[&known, FAR, CASCADE]));
    out.push('\n');
    desk.write("model.toml", MODEL);
    let file = desk.run(&together(&[AXIS, FAR, CASCADE]));
    out += &file.warnings[0].message;
    insta::assert_snapshot!(out);
}
