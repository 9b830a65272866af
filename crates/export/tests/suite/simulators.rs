//! What simulators take: ranges and draws, and the files of Newton, Isaac Lab and BAM, each read by code that is not ours.

use crate::common::compiled::write;
use crate::common::{laws, model, side};
use crate::mujoco::python;
use std::path::Path;
use stiction_export::{Domain, Draws, Error, Model, Number, Scale, Target, Width, advice, export};
use stiction_friction::compensator::{Channel, Channels, Friction, Levels, Terms};
use stiction_friction::{CoulombViscous, Shape, Stribeck};

fn number(name: &str, nominal: f64, half: [f64; 2], scale: Scale) -> Number {
    Number {
        name: name.into(),
        unit: "N m".into(),
        nominal,
        half: half.map(Some),
        scale,
        is_determined: true,
    }
}

/// A joint with numbers of every scale, of which the first two and the next two go together, and one that is not varied.
fn domain() -> Domain {
    let cos = 0.6_f64;
    let mut open = number("sigma0", 1e5, [0.0; 2], Scale::Log);
    open.half = [None; 2];
    Domain {
        numbers: vec![
            number("armature", 0.2, [0.05, 0.1], Scale::Log),
            number("frictionloss", 12.0, [1.0, 3.0], Scale::NotNegative),
            number("damping", 0.5, [0.2, 0.6], Scale::NotNegative),
            number("static_friction", 12.5, [1.0, 3.0], Scale::Log),
            number("offset", -0.1, [0.2, 0.4], Scale::Any),
            open,
        ],
        root: vec![
            vec![1.0, 0.0, 0.0, 0.0],
            vec![cos, (1.0 - cos * cos).sqrt(), 0.0, 0.0],
            vec![0.0, -cos, (1.0 - cos * cos).sqrt(), 0.0],
            vec![0.0, 0.0, 0.0, 1.0],
            vec![0.0, 0.0, 0.0, 1.0],
            vec![1.0, 0.0, 0.0, 0.0],
        ],
    }
}

fn drawn(count: usize, seed: u64, width: Width) -> Model {
    Model {
        rotary: true,
        force_unit: "N m".into(),
        domain: domain(),
        draws: Some(Draws { count, seed, width }),
        ..model(laws().remove(0).1)
    }
}

fn exported(model: &Model, target: Target) -> tempfile::TempDir {
    let dir = tempfile::tempdir().unwrap();
    write(&export(model, target).unwrap(), dir.path());
    dir
}

fn said(script: &str, dir: &Path) -> Vec<f64> {
    std::fs::write(dir.join("read.py"), script).unwrap();
    let said = python("read.py", &[], dir);
    let numbers = said.split_whitespace();
    numbers.map(|n| n.parse().unwrap()).collect()
}

/// Statistics by NumPy: the share of draws within each stated range, on the log scale the spread about the nominal value, and
/// correlations.
const STATISTICS: &str = r#"
import json, numpy
document = json.load(open("x_axis_domain.json"))
assert document["schema"] == "stiction.domain/1"
(joint,) = document["joints"]
draws = document["draws"]["joints"][joint["name"]]
width = document["draws"]["width"]
numbers = joint["numbers"]
assert numbers["sigma0"]["transfer"] is None and "sigma0" not in draws
arrays = {name: numpy.array(values) for name, values in draws.items()}
assert all(len(own) == document["draws"]["count"] for own in arrays.values())
assert (arrays["static_friction"] >= arrays["frictionloss"]).all()
assert min(arrays["frictionloss"].min(), arrays["damping"].min(), arrays["armature"].min()) >= 0
for name in ["armature", "frictionloss", "damping", "offset"]:
    low, high = numbers[name][width]
    print(numpy.mean((arrays[name] >= low) & (arrays[name] <= high)), numpy.median(arrays[name]) / numbers[name]["nominal"])
print(numpy.corrcoef(numpy.log(arrays["armature"]), arrays["frictionloss"])[0, 1])
print(numpy.corrcoef(arrays["frictionloss"], arrays["damping"])[0, 1])
print(numpy.corrcoef(arrays["armature"], arrays["offset"])[0, 1])
"#;

#[test]
fn draws_have_the_ranges_and_correlations_of_the_document() {
    let dir = exported(&drawn(20_000, 5, Width::Repeatability), Target::DomainJson);
    let found = said(STATISTICS, dir.path());
    for k in 0..4 {
        // 95 % of a normal cut at three deviations, and 2.2 deviations above 0 at most for the damping.
        let [inside, middle] = [found[2 * k], found[2 * k + 1]];
        assert!((inside - 0.9527).abs() < 0.006, "{found:?}");
        let most = if k == 3 { 0.02 } else { 0.01 };
        assert!((middle - 1.0).abs() < most, "{found:?}");
    }
    // That of frictionloss and damping is -.8 times .6.
    for (found, due) in found[8..].iter().zip([0.6, -0.48, 0.0]) {
        assert!((found - due).abs() < 0.02, "{found} {due}");
    }
    // The damping of another motion may be nothing, 1.63 deviations away: the median of what is left of the normal above it.
    let wide = exported(&drawn(20_000, 5, Width::Transfer), Target::DomainJson);
    let found = said(STATISTICS, wide.path());
    assert!((found[5] - 1.039).abs() < 0.01, "{found:?}");
}

#[test]
fn the_same_seed_gives_the_same_bytes_and_more_draws_begin_with_the_same() {
    let text = |count, seed, target| {
        let files = export(&drawn(count, seed, Width::Transfer), target).unwrap();
        let found = files.into_iter().find(|f| f.path == "x_axis_domain.json");
        String::from_utf8(found.unwrap().bytes).unwrap()
    };
    let one = text(50, 1, Target::DomainJson);
    for target in [
        Target::IsaacLab,
        Target::Newton,
        Target::Bam,
        Target::Mujoco,
    ] {
        assert_eq!(one, text(50, 1, target));
    }
    let first = |text: &str| -> String {
        let at = text.split("\"draws\"").nth(1).unwrap();
        at.split("\"armature\": [").nth(1).unwrap()[..100].into()
    };
    assert_ne!(first(&one), first(&text(50, 2, Target::DomainJson)));
    assert_eq!(first(&one), first(&text(80, 1, Target::DomainJson)));
    let mut nominal = drawn(1, 1, Width::Transfer);
    nominal.draws = None;
    let files = export(&nominal, Target::DomainJson).unwrap();
    let document = String::from_utf8(files[0].bytes.clone()).unwrap();
    assert!(!document.contains("\"draws\""));
    assert!(document.contains("\"repeatability\": [11.0, 13.0], \"transfer\": [9.0, 15.0]"));
    assert_eq!(export(&nominal, Target::IsaacLab).unwrap().len(), 1);
}

/// The script on a model of MuJoCo, on lists as a builder of Newton has them, and what it hands to Isaac Lab.
const APPLIED: &str = r#"
import re, types, mujoco
import x_axis_domain as own
domain = own.load()
third = own.numbers(domain, 2)["x_axis_joint"]
try:
    own.mujoco(mujoco.MjModel.from_xml_path("x_axis_friction.xml"), domain, 2)
    raise SystemExit("bristles were doubled")
except ValueError as e:
    assert "bristles={'x_axis_joint': 'x_axis_friction'}" in str(e), e
model = mujoco.MjModel.from_xml_string(
    "<mujoco><worldbody><body><joint name='x_axis_joint' type='slide'/><geom size='1'/></body></worldbody></mujoco>")
own.mujoco(model, domain, 2)
print(model.dof_armature[0] - third["armature"], model.dof_frictionloss[0] - third["frictionloss"], model.dof_damping[0] - third["damping"])
builder = types.SimpleNamespace(joint_label=["a/base", "a/x_axis_joint", "b/base", "b/x_axis_joint"], joint_qd_start=[0, 0, 1, 1],
                                joint_armature=[0.0, 0.0], joint_friction=[0.0, 0.0], joint_damping=[0.0, 0.0])
own.newton(builder, domain, [4, 2])
fifth = own.numbers(domain, 4)["x_axis_joint"]
print(*(builder.joint_friction[k] - [fifth, third][k]["frictionloss"] for k in range(2)), builder.joint_armature[1] - third["armature"])
lab = own.isaaclab(domain, 2)
# Fields of ActuatorBaseCfg in Isaac Lab 3.0.0.
assert list(lab) == ["armature", "friction", "dynamic_friction", "viscous_friction"], lab
for field, number in [("friction", "static_friction"), ("dynamic_friction", "frictionloss"), ("viscous_friction", "damping")]:
    ((pattern, value),) = lab[field].items()
    assert re.fullmatch(pattern, "x_axis_joint")
    print(value - third[number])
rows = own.table(domain, ["x_axis_joint"], [4, 2])
print(rows["dynamic_friction"][0][0] - fifth["frictionloss"], rows["dynamic_friction"][1][0] - third["frictionloss"])
nominal = own.numbers(domain)["x_axis_joint"]
print(nominal["frictionloss"] - 12.0, nominal["sigma0"] - third["sigma0"])
"#;

#[test]
fn the_script_applies_a_draw_to_each_simulator() {
    let dir = exported(&drawn(10, 3, Width::Transfer), Target::Mujoco);
    let found = said(APPLIED, dir.path());
    assert_eq!(found, [0.0; 13]);
}

/// The law of bristles in MuJoCo, whose numbers are those of a model that was exported with them.
const BRISTLES: &str = r#"
import json, mujoco
import x_axis_domain as own
domain = own.load()
model = mujoco.MjModel.from_xml_path("x_axis_friction.xml")
due = [model.actuator_dynprm[0].copy(), model.actuator_biasprm[0].copy(), model.dof_damping[0]]
own.mujoco(model, domain, None, {"x_axis_joint": "x_axis_friction"})
print(abs(model.actuator_dynprm[0] - due[0]).max(), abs(model.actuator_biasprm[0] - due[1]).max(), model.dof_damping[0] - due[2])
"#;

#[test]
fn the_script_writes_the_law_where_mujoco_has_it() {
    let mut model = drawn(1, 3, Width::Transfer);
    let law = [
        ("sigma0", 2e6),
        ("sigma1", 1.5e3),
        ("coulomb", 12.0),
        ("static", 18.0),
        ("stribeck_velocity", 3e-3),
        ("sigma2", 30.0),
    ];
    model.domain.numbers.truncate(4);
    model.domain.root.truncate(4);
    for (name, value) in law {
        model
            .domain
            .numbers
            .push(number(name, value, [0.0; 2], Scale::Log));
        model.domain.root.push(vec![0.0; 4]);
    }
    let dir = exported(&model, Target::Mujoco);
    assert_eq!(said(BRISTLES, dir.path()), [0.0; 3]);
}

/// A force that is logged late is a sensor with that delay, one that is early a delay of the motor.
#[test]
fn mujoco_has_the_delay() {
    let read = r#"
import mujoco
model = mujoco.MjModel.from_xml_path("x_axis_friction.xml")
data = mujoco.MjData(model)
data.ctrl[-1] = 1.0
came = []
for k in range(20):
    mujoco.mj_step(model, data)
    came.append((data.actuator_force[-1], data.sensordata[0] if model.nsensor else 0.0))
print(model.opt.timestep, sum(force == 0 for force, _ in came), sum(seen == 0 for _, seen in came))
"#;
    for (delay, motor, sensor) in [(0.0, 0.0, 20.0), (-2.5e-3, 3.0, 20.0), (4e-3, 0.0, 4.0)] {
        let mut own = drawn(1, 0, Width::Transfer);
        own.settings.cycle_time = 1e-3;
        own.friction = {
            let Friction::LuGre(law) = own.friction else {
                unreachable!()
            };
            // Soft enough for that timestep.
            let law = law.with_damping(stiction_friction::Damping::Constant(3e3));
            Friction::LuGre(law.unwrap())
        };
        own.parameters[0].name = "delay".into();
        own.parameters[0].value = delay;
        let dir = exported(&own, Target::Mujoco);
        let found = said(read, dir.path());
        assert_eq!(found[0], 1e-3);
        assert_eq!(found[1], motor, "{delay}: {found:?}");
        // The sensor shows the motor and the friction that the bristles add.
        assert_eq!(found[2] > 0.0, sensor > 0.0, "{delay}: {found:?}");
        assert!((found[2] - sensor).abs() <= 1.0, "{delay}: {found:?}");
    }
}

/// A law with load and top speed as BAM gets it.
fn loaded(friction: Friction<f64>, transmitted: f64, driven: f64) -> Model {
    Model {
        rotary: true,
        force_unit: "N m".into(),
        top_speed: Some(5.0),
        terms: Terms {
            channels: Channels {
                transmitted: Channel {
                    reference: 6.0,
                    range: [0.0, 60.0],
                    turns: false,
                },
                ..Channels::default()
            },
            levels: Some(Levels {
                transmitted: [transmitted; 2],
                driven: [driven; 2],
                ..Levels::default()
            }),
            ..Terms::default()
        },
        ..model(friction)
    }
}

/// The models of `tests/bam`.
fn of_bam() -> [(&'static str, Model); 5] {
    let line = Friction::Coulomb(CoulombViscous::symmetric(8.0, 1.5, 0.0).unwrap());
    let curve = Stribeck::symmetric(Shape::Power(1.3), side(8.0, 11.0, 0.05, 1.5), 0.0).unwrap();
    let curve = Friction::Stribeck(curve);
    [
        ("m1", loaded(line, 0.0, 0.0)),
        ("m2", loaded(curve, 0.0, 0.0)),
        ("m3", loaded(line, 0.01, 0.0)),
        ("m4", loaded(curve, 0.01, 0.0)),
        ("m5", loaded(curve, 0.01, -0.0005)),
    ]
}

/// Friction of a law without its viscous part where it transmits a torque, by the compensator's own levels.
fn due(model: &Model, torque: f64, speed: f64, is_driven: bool) -> f64 {
    let curve = match &model.friction {
        Friction::Coulomb(law) => law.force(speed.max(1e-300)) - 1.5 * speed,
        law => law.curve().unwrap().force(speed.max(1e-300)) - 1.5 * speed,
    };
    let levels = model.terms.levels.unwrap();
    let away = levels.transmitted[0] * (torque - 6.0);
    let driven = if is_driven {
        levels.driven[0] * torque
    } else {
        0.0
    };
    curve * (1.0 + away + driven)
}

#[test]
fn bam_has_the_friction_of_the_law() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/bam");
    let known = std::fs::read_to_string(folder.join("friction.txt")).unwrap_or_default();
    let mut compared = 0;
    for (name, model) in of_bam() {
        let files = export(&model, Target::Bam).unwrap();
        let text = String::from_utf8(files[0].bytes.clone()).unwrap();
        let path = folder.join(format!("{name}.json"));
        if std::env::var_os("STICTION_WRITE").is_some() {
            std::fs::write(&path, &text).unwrap();
        }
        assert_eq!(text, std::fs::read_to_string(&path).unwrap(), "{name}");
        assert!(text.contains(&format!("\"model\": \"{name}\"")), "{text}");
        let mut balance = [0.0; 2];
        for row in known.lines().filter(|row| row.starts_with(name)) {
            let row: Vec<&str> = row.split(' ').collect();
            let [torque, speed, found] = [1, 2, 3].map(|i| row[i].parse::<f64>().unwrap());
            if row[4] == "balance" {
                // With friction in the balance BAM has another level without load, by the motor's share, .0256 and at rest .0353.
                let is_driven = torque < 0.0;
                let due = |torque| due(&model, torque, speed, is_driven);
                let share = 0.037 * due(torque.abs());
                assert!((found - due(torque.abs())).abs() < share, "{row:?}");
                // Sliding, it grows with the torque as the law does, by who drives.
                if speed == 5.0 && torque.abs() == 40.0 {
                    let slope = (found - balance[usize::from(is_driven)]) / 30.0;
                    let due = (due(40.0) - due(10.0)) / 30.0;
                    assert!((slope / due - 1.0).abs() < 1e-4, "{slope} {due}");
                }
                if speed == 5.0 {
                    balance[usize::from(is_driven)] = found;
                }
            } else if name != "m5" {
                let due = due(&model, torque, speed, false);
                assert!((found - due).abs() < 1e-5 * due, "{name} {row:?} {due}");
                assert_eq!(row[4], "1.5", "{name}");
            }
            compared += 1;
        }
    }
    assert_eq!(compared, 5 * 30 + 24);
}

#[test]
fn bam_says_what_it_lacks() {
    let notes = |model: &Model| {
        let found = advice(model, Target::Bam);
        found.first().map(|a| a.message.clone()).unwrap_or_default()
    };
    let sided = laws().remove(7).1;
    assert!(notes(&loaded(sided, 0.0, 0.0)).contains("the directions differ"));
    let [.., (_, driven)] = of_bam();
    assert_eq!(notes(&driven), "");
    let mut more = driven.clone();
    more.terms.levels.as_mut().unwrap().driven = [0.02; 2];
    assert!(notes(&more).starts_with("BAM M4"), "{}", notes(&more));
    assert!(notes(&more).contains("the mean of both"));
    let lorentzian = Stribeck::symmetric(Shape::Lorentzian, side(8.0, 11.0, 0.05, 1.5), 0.0);
    let model = loaded(Friction::Stribeck(lorentzian.unwrap()), 0.0, 0.0);
    let refused = export(&model, Target::Bam).unwrap_err();
    assert!(matches!(refused, Error::Law { target: "bam", .. }));
    let mut amperes = driven;
    amperes.force_unit = "A".into();
    for target in [Target::Bam, Target::Newton, Target::DomainJson] {
        let refused = export(&amperes, target).unwrap_err();
        assert!(matches!(refused, Error::ForceUnit { .. }), "{target:?}");
    }
}

/// Newton of PyPI, on the processor: the numbers in its builder, in the model, and a draw for each copy.
const NEWTON: &str = r#"
import sys
try:
    import newton, warp
except ImportError:
    print("skipped")
    sys.exit()
import contextlib, io
with contextlib.redirect_stdout(io.StringIO()):
    warp.config.quiet = True
    import x_axis_newton, x_axis_domain
    arm = newton.ModelBuilder()
    link = arm.add_link(mass=1.0, inertia=warp.mat33(1, 0, 0, 0, 1, 0, 0, 0, 1))
    joint = arm.add_joint_revolute(-1, link, axis=(0, 0, 1), label="x_axis_joint")
    arm.add_articulation([joint])
    x_axis_newton.apply(arm)
    both = newton.ModelBuilder()
    for _ in range(2):
        both.add_world(arm)
    model = both.finalize(device="cpu")
    first = [float(model.joint_friction.numpy()[0]), float(model.joint_damping.numpy()[1])]
    domain = x_axis_domain.load()
    x_axis_domain.newton(model, domain, [0, 1])
    drawn = [own["x_axis_joint"]["frictionloss"] for own in (x_axis_domain.numbers(domain, k) for k in (0, 1))]
    found = model.joint_friction.numpy()
print(*first, *(float(x) / y for x, y in zip(found, drawn)))
"#;

#[test]
#[ignore = "soak: needs the package newton of PyPI beside mujoco"]
fn newton_takes_the_joints() {
    let dir = exported(&drawn(2, 3, Width::Transfer), Target::Newton);
    std::fs::write(dir.path().join("read.py"), NEWTON).unwrap();
    let said = python("read.py", &[], dir.path());
    let last = said.lines().last().unwrap();
    if last == "skipped" {
        println!("SKIPPED: no package newton in this Python");
        return;
    }
    let found: Vec<f64> = last.split(' ').map(|x| x.parse().unwrap()).collect();
    // In single precision.
    for (found, due) in found.iter().zip([12.0, 0.5, 1.0, 1.0]) {
        assert!((found / due - 1.0).abs() < 1e-6, "{said}");
    }
}
