//! The correction of a gap, read as LinuxCNC and TwinCAT read it: a load behind the gap goes where it should.

use crate::common::compiled::write;
use crate::common::terms::with_cogging_and_gap;
use crate::common::{laws, model};
use crate::mujoco::python;
use stiction_export::{Model, Target, advice, export};

fn axis(rotary: bool) -> Model {
    let mut model = model(laws().remove(0).1);
    (model.rotary, model.force_unit) = (rotary, if rotary { "N m" } else { "N" }.into());
    with_cogging_and_gap(model)
}

/// Takes the motion to and fro through each controller, and the load behind a gap of the width along. The arguments are the width and
/// what the controller counts in a metre or radian.
const READ: &str = r##"
import configparser, csv, re, shutil, subprocess, sys
width, factor = map(float, sys.argv[1:3])

# To 0.3 of the unit, back and to again; positions with directions.
there = [0.3 * k / 500 for k in range(501)]
motion = [(x, +1) for x in there] + [(x, -1) for x in reversed(there)] + [(x, +1) for x in there]

def load(motor):
    """Lags behind the motor by half of the gap to each side."""
    at, half, out = motor[0], factor * width / 2, []
    for x in motor:
        at = min(max(at, x - half), x + half)
        out.append(at)
    return out

def apart(motor):
    """By how much the load is at other places on the way back than on the way to."""
    at = load(motor)
    n = len(there)
    return max(abs(at[2 * n + k] - at[2 * n - 1 - k]) for k in range(50, n - 50))

# Without correction the whole gap.
assert abs(apart([x for x, _ in motion]) - factor * width) < 1e-12

ini = configparser.ConfigParser()
ini.read("x_axis_linuxcnc.ini")
backlash = float(ini["JOINT_0"]["BACKLASH"])
if shutil.which("inivar"):
    said = subprocess.run(["inivar", "-var", "BACKLASH", "-sec", "JOINT_0", "-ini", "x_axis_linuxcnc.ini"], capture_output=True, text=True)
    assert float(said.stdout) == backlash, said
by_ini = [x + way * 0.5 * backlash for x, way in motion]
assert max(abs(a - x) for a, (x, way) in zip(load(by_ini)[50:], motion[50:])) < 1e-9
assert apart(by_ini) < 1e-12

# usrmotLoadComp: lines of less than 255 characters until one has no three numbers; then trims at positions that rise.
trims = []
for line in open("x_axis_linuxcnc_comp.txt"):
    assert len(line) < 255
    try:
        trims.append(tuple(map(float, line.split()[:3])))
    except ValueError:
        break
assert len(trims) == 2 and trims[0][0] < trims[1][0]
def trim(x, way):
    left = max((t for t in trims if t[0] <= x), default=trims[0])
    return left[1] if way > 0 else left[2]
assert [x + trim(x, way) for x, way in motion] == by_ini

rows = list(csv.reader(line for line in open("x_axis_backlash.csv") if not line.startswith("#")))
for place, forward, back in (map(float, row) for row in rows[1:]):
    assert abs(factor * forward - 0.5 * backlash) < 1e-15 and back == -forward

# Structured Text: comments away, then the initial values by their names.
text = re.sub(r"\(\*.*?\*\)", "", open("x_axis_twincat.st").read(), flags=re.S)
count = int(re.search(r"ARRAY\[1\.\.(\d+)\] OF ST_PositionCompensationTableElement", text)[1])
elements = [tuple(map(float, m)) for m in re.findall(r"\(Position := (\S+), Compensation := ([^\s)]+)\)", text)]
parameter = dict(re.findall(r"^\s+(\w+) := ([^,\s]+),?$", text, flags=re.M))
assert len(elements) == count == int(parameter["NoOfTableElements"])
assert float(parameter["MinPosition"]) == elements[0][0] and float(parameter["MaxPosition"]) == elements[-1][0]
assert parameter["Direction"] == "WorkDirectionNegative" and parameter["Modulo"] == "FALSE"
assert len({c for _, c in elements}) == 1
# The correction is added to the actual position, which the controller holds at its set point.
def motor(x, way): return x - (elements[0][1] if way < 0 else 0.0)
assert apart([motor(x, way) for x, way in motion]) < 1e-12
print(rows[0], repr(round(backlash, 15)))
"##;

#[test]
fn a_load_behind_the_gap_goes_where_it_should() {
    let columns =
        |unit: &str| format!("['position [{unit}]', 'forward [{unit}]', 'back [{unit}]']");
    for (rotary, factor, says) in [
        (false, "1000", format!("{} 0.02\n", columns("m"))),
        (
            true,
            "57.29577951308232",
            format!("{} 0.001145915590262\n", columns("rad")),
        ),
    ] {
        let dir = tempfile::tempdir().unwrap();
        write(
            &export(&axis(rotary), Target::Backlash).unwrap(),
            dir.path(),
        );
        std::fs::write(dir.path().join("read.py"), READ).unwrap();
        assert_eq!(python("read.py", &["2e-5", factor], dir.path()), says);
    }
}

#[test]
fn texts() {
    for file in export(&axis(false), Target::Backlash).unwrap() {
        insta::assert_snapshot!(file.path, String::from_utf8(file.bytes).unwrap());
    }
}

#[test]
fn a_gap_that_is_hardly_known_is_warned_of() {
    let mut axis = axis(false);
    assert_eq!(advice(&axis, Target::Backlash), []);
    axis.backlash.as_mut().unwrap().interval = Some([9e-6, 2.3e-5]);
    let said = advice(&axis, Target::Backlash);
    assert_eq!(said[0].code.as_str(), "backlash");
    let says = "the width of 0.00002 m is known as 0.000009 to 0.000023 m only";
    assert!(said[0].message.starts_with(says), "{said:?}");
}

#[test]
fn a_gap_of_unknown_width_is_refused() {
    let mut axis = axis(false);
    axis.backlash.as_mut().unwrap().interval = Some([-1e-6, 4e-5]);
    let unknown = export(&axis, Target::Backlash).unwrap_err().to_string();
    assert!(
        unknown.starts_with("target backlash: the interval of the backlash reaches 0: measure"),
        "{unknown}"
    );
    // Somebody measured it.
    axis.backlash.as_mut().unwrap().interval = None;
    assert_eq!(export(&axis, Target::Backlash).unwrap().len(), 4);
    axis.backlash = None;
    let none = export(&axis, Target::Backlash).unwrap_err().to_string();
    assert!(
        none.starts_with("target backlash: the model has no backlash")
            && none.contains("width = WIDTH"),
        "{none}"
    );
}
