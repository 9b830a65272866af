//! Maps of cogging, read as the drivers' own sources read them, beside the waves of the model in closed form.

use crate::common::compiled::write;
use crate::common::terms::with_cogging_and_gap;
use crate::common::{laws, model};
use crate::mujoco::python;
use stiction_export::{Model, Target, advice, export};

fn axis(rotary: bool, unit: &str) -> Model {
    let mut model = model(laws().remove(0).1);
    (model.rotary, model.force_unit) = (rotary, unit.into());
    with_cogging_and_gap(model)
}

fn paths(model: &Model) -> Vec<String> {
    let files = export(model, Target::CoggingMap).unwrap();
    files.into_iter().map(|file| file.path).collect()
}

/// What a script says of the files of an axis; its arguments are sine, cosine and waves over the period of each wave.
fn said(model: &Model, script: &str) -> String {
    let dir = tempfile::tempdir().unwrap();
    write(&export(model, Target::CoggingMap).unwrap(), dir.path());
    std::fs::write(dir.path().join("read.py"), script).unwrap();
    let arguments = ["0.031", "-0.012", "42", "-0.004", "0.007", "1"];
    python("read.py", &arguments, dir.path())
}

/// The waves in closed form; `part` is a part of the period.
const WAVES: &str = r#"
import csv, json, math, random, struct, sys
waves = [tuple(map(float, sys.argv[i:i + 3])) for i in (1, 4)]
def due(part):
    return sum(a * math.sin(2 * math.pi * k * part) + b * math.cos(2 * math.pi * k * part) for a, b, k in waves)
random.seed(7)
parts = [random.uniform(-3, 3) for _ in range(2000)]
# A line between two places of a wave is off by at most this.
def bend(places): return sum(math.hypot(a, b) * (2 * math.pi * k / places) ** 2 / 8 for a, b, k in waves)
def line(values, part):
    at = part % 1.0 * len(values)
    left = min(int(at), len(values) - 1)
    right = (left + 1) % len(values)
    return values[left] + (at - left) * (values[right] - values[left])
"#;

#[test]
fn the_table_is_the_waves() {
    let read = format!(
        "{WAVES}{}",
        r##"
with open("x_axis_cogging_map.csv", newline="") as file:
    rows = list(csv.reader(row for row in file if not row.startswith("#")))
places, values = zip(*[map(float, row) for row in rows[1:]])
period = places[1] * len(places)
assert max(abs(v - due(x / period)) for x, v in zip(places, values)) < 1e-12
assert max(abs(line(values, p) - due(p)) for p in parts) < 1.001 * bend(len(values))
print(rows[0], len(values), round(period, 9))
"##
    );
    for (rotary, unit, says) in [
        (
            true,
            "N m",
            "['position [rad]', 'force [N m]'] 2688 6.283185307\n",
        ),
        (false, "N", "['position [m]', 'force [N]'] 2688 0.024\n"),
    ] {
        assert_eq!(said(&axis(rotary, unit), &read), says);
    }
}

/// `controller.cpp` of firmware 0.5: the entry at the whole number of parts of a turn, rounded towards 0.
#[test]
fn odrive_reads_its_map() {
    let model = axis(true, "N m");
    assert_eq!(
        paths(&model),
        ["x_axis_cogging_map.csv", "x_axis_odrive.json"]
    );
    let read = r##"
map = json.load(open("x_axis_odrive.json"))
entries = map["cogging_map"]
assert len(entries) == map["entries_per_turn"] == 3600 and map["unit"] == "N m"
def look(turns): return entries[int(turns * 3600) % 3600]
off = max(abs(entries[i] - due(i / 3600)) for i in range(3600))
# An entry acts over a 3600th of a turn.
steep = sum(math.hypot(a, b) * 2 * math.pi * k for a, b, k in waves) / 3600
assert max(abs(look(p) - due(p)) for p in parts) < 1.001 * steep
print(off < 4e-9)
"##;
    assert_eq!(said(&model, &format!("{WAVES}{read}")), "True\n");
    // A wave of 42 in 3600 entries that are held moves by 7 % from one to the next.
    let advice = advice(&model, Target::CoggingMap);
    assert!(
        advice[0].message.contains("ODrive has too few entries"),
        "{advice:?}"
    );
}

/// `moteus_tool` sets what stands before a `#`; `bldc_servo.cc` draws a line between the entries.
#[test]
fn moteus_reads_its_map() {
    let model = axis(true, "A");
    assert_eq!(
        paths(&model),
        ["x_axis_cogging_map.csv", "x_axis_moteus.cfg"]
    );
    let read = r##"
config = {}
for row in open("x_axis_moteus.cfg"):
    row = row.split("#")[0].rstrip()
    if row:
        name, value = row.split()
        config[name] = value
scale = float(config.pop("motor.cogging_dq_scale"))
assert abs(struct.unpack("f", struct.pack("f", scale))[0] - scale) <= 1e-7 * scale
counts = [int(config.pop(f"motor.cogging_dq_comp.{i}")) for i in range(1024)]
assert not config and struct.pack("1024b", *counts)
assert max(map(abs, counts)) == 127
off = max(abs(line([scale * n for n in counts], p) - due(p)) for p in parts)
assert off < 0.5001 * scale + 1.001 * bend(1024), off
print("ok")
"##;
    assert_eq!(said(&model, &format!("{WAVES}{read}")), "ok\n");
    // A wave of 42 in 1024 entries with lines between is off by 1 %.
    assert_eq!(advice(&model, Target::CoggingMap), []);
}

#[test]
fn a_map_over_a_turn_is_one_of_a_motor_that_turns() {
    let only = ["x_axis_cogging_map.csv"];
    let mut beside = axis(true, "N m");
    // A pitch that fits 42.3 times.
    beside.terms.cogging[0].rate = 42.3;
    let mut short = axis(true, "A");
    short.terms.cogging[1].whole = false;
    for (model, why) in [
        (axis(false, "N"), "the axis is linear"),
        (axis(true, "1"), "ODrive takes N m, moteus A"),
        (beside, "not every wave fits a whole number of times"),
        (short, "was seen whole"),
    ] {
        assert_eq!(paths(&model), only);
        let advice = advice(&model, Target::CoggingMap);
        assert_eq!(advice[0].code.as_str(), "export-simplified");
        assert!(advice[0].message.contains(why), "{advice:?}");
    }
}

/// What the log saw of a wave is held beyond, and the table ends where the log did.
#[test]
fn a_table_ends_where_the_log_did() {
    let mut model = axis(false, "N");
    model.terms.cogging[1].whole = false;
    model.terms.channels.position.range = [-0.004, 0.013];
    model.terms.channels.position.reference = 0.002;
    let files = export(&model, Target::CoggingMap).unwrap();
    let text = String::from_utf8(files[0].bytes.clone()).unwrap();
    let rows: Vec<Vec<f64>> = (text.lines().filter(|line| !line.starts_with(['#', 'p'])))
        .map(|line| line.split(',').map(|x| x.parse().unwrap()).collect())
        .collect();
    assert_eq!((rows[0][0], rows.len()), (-0.004, 1905));
    assert!((rows.last().unwrap()[0] - 0.013).abs() < 1e-15);
    // A stroke with more waves than a table has room for.
    model.terms.channels.position.range = [0.0, 8.0];
    let refused = export(&model, Target::CoggingMap).unwrap_err().to_string();
    assert!(refused.contains("more than a thousand waves"), "{refused}");
}

#[test]
fn a_model_without_cogging_is_refused() {
    let refused = export(&model(laws().remove(0).1), Target::CoggingMap).unwrap_err();
    assert_eq!(
        refused.to_string(),
        "target cogging-map: the model has no cogging: in the axis file, under [terms], write cogging = [PITCH] and identify again"
    );
}
