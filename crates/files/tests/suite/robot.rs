//! `robot.toml` as an identification writes it, read back.

use stiction_files::Robot;
use stiction_files::result::ValueEntry;
use stiction_files::robot::model::text;
use stiction_files::robot::result::{
    BodyEntry, Estimated, FileEntry, FilterEntry, JointColumn, JointEntry, JointFit, RobotFile,
    RobotTrust, SCHEMA,
};
use stiction_files::robot::{Coupling, IdentifiedBody, IdentifiedJoint, Tool};

/// Numbers whose text is long, small, or without a point.
const AWKWARD: [f64; 6] = [0.1 + 0.2, 5e-324, 1e15, -1e-7, 1.0 / 3.0, -0.0];

fn joint(name: &str, fitted: bool) -> JointEntry {
    let known = |value| Estimated {
        value,
        half_width: None,
        identifiable: true,
    };
    let fit = fitted.then(|| JointFit {
        folder: "joints/a b".into(),
        law: "lugre".into(),
        asymmetric: false,
        coulomb: None,
        viscous: None,
        static_friction: None,
        load: None,
        armature: known(AWKWARD[4]),
        simulators: Some([AWKWARD[0], AWKWARD[1]].map(|value| ValueEntry {
            value,
            at_once: 0.0,
            repeat: 0.0,
            transfer: 0.0,
        })),
        torque_rms: 1.0,
        fit_rms: 0.1,
        held_out_rms: 0.1,
        judged_on: "validation".into(),
        rigid_deviation: 0.0,
        trustworthy: true,
        compensates: true,
        reasons: vec![],
    });
    JointEntry {
        name: name.into(),
        kind: "rotary".into(),
        unit: "N*m".into(),
        columns: vec![JointColumn {
            role: "position".into(),
            column: "q \"1\"".into(),
            unit: "rad".into(),
            line: "position = { column = \"q \\\"1\\\"\", unit = \"rad\" }".into(),
        }],
        fit,
    }
}

fn robot() -> RobotFile {
    RobotFile {
        schema: SCHEMA.into(),
        version: "0".into(),
        seed: 0,
        name: "an \"arm\"".into(),
        urdf: FileEntry {
            path: "arm.urdf".into(),
            sha256: "0f".repeat(32),
        },
        robot: None,
        gravity: [AWKWARD[3], 0.0, -9.81],
        tool: Some(Tool {
            link: "hand".into(),
            mass: AWKWARD[0],
            center: [AWKWARD[4], AWKWARD[3], 0.0],
        }),
        couplings: vec![Coupling {
            joints: vec!["wrist".into(), "elbow.\"\u{1}\u{e4}".into()],
            matrix: vec![vec![1.0, AWKWARD[3]], vec![AWKWARD[4], 1.0]],
        }],
        time: Some(JointColumn {
            role: "time".into(),
            column: "t".into(),
            unit: "us".into(),
            line: "time = { column = \"t\", unit = \"us\" }".into(),
        }),
        inputs: vec![],
        conditioning: FilterEntry {
            source_cutoff_hz: 10.0,
            common_cutoff_hz: 5.0,
            torque_cutoff_hz: None,
        },
        trust: RobotTrust {
            trustworthy: true,
            reasons: vec![],
            next: stiction_files::result::Action::Export,
        },
        joints: vec![
            joint("wrist", true),
            joint("elbow.\"\u{1}\u{e4}", true),
            joint("a", false),
        ],
        base: vec![],
        bodies: vec![BodyEntry {
            joint: "wrist".into(),
            link: "hand".into(),
            mass: AWKWARD[0],
            center: [AWKWARD[3], AWKWARD[4], AWKWARD[5]],
            inertia: AWKWARD,
            urdf_mass: 1.0,
        }],
        warnings: vec![],
    }
}

/// Every number to its last bit, in the order of the robot.
#[test]
fn what_was_identified_is_read_back() {
    let read = Robot::parse(&text(&robot(), "../arm.urdf")).unwrap();
    let bits = |x: &[f64]| -> Vec<u64> { x.iter().map(|x| x.to_bits()).collect() };
    let found = read.identified().unwrap();
    assert_eq!(found.urdf_sha256, Some("0f".repeat(32)));
    let names: Vec<&str> = found.joints.iter().map(|j| j.name.as_str()).collect();
    assert_eq!(names, ["wrist", "elbow.\"\u{1}\u{e4}"]);
    for IdentifiedJoint {
        model,
        armature,
        simulators,
        ..
    } in &found.joints
    {
        assert_eq!(model.to_str(), Some("joints/a b/model.toml"));
        assert_eq!(bits(&[*armature]), bits(&AWKWARD[4..5]));
        assert_eq!(bits(&simulators.unwrap()), bits(&AWKWARD[..2]));
    }
    let [
        IdentifiedBody {
            joint,
            link,
            mass,
            center,
            inertia,
        },
    ] = found.bodies.as_slice()
    else {
        panic!("{found:?}")
    };
    assert_eq!([joint.as_str(), link.as_str()], ["wrist", "hand"]);
    assert_eq!(bits(&[*mass]), bits(&AWKWARD[..1]));
    assert_eq!(bits(center), bits(&AWKWARD[3..]));
    assert_eq!(bits(inertia), bits(&AWKWARD));
    assert_eq!(read.name.as_deref(), Some("an \"arm\""));
    assert_eq!(read.urdf.as_deref(), Some("../arm.urdf".as_ref()));
    assert_eq!(bits(&read.gravity.unwrap()), bits(&robot().gravity));
    assert_eq!(read.tool, robot().tool);
    assert_eq!(read.couplings, robot().couplings);
    assert!(read.axis().mapping.time.is_some());
    assert!(read.joint("a").is_some());
}

#[test]
fn a_file_that_was_typed_has_nothing_identified() {
    let read = Robot::parse("urdf = \"arm.urdf\"\n[joint.elbow]\nfit = false\n").unwrap();
    assert_eq!(read.identified(), None);
}

#[test]
fn what_no_identification_writes_is_refused() {
    let whole = text(&robot(), "arm.urdf");
    for (old, new, says) in [
        (
            "schema = \"stiction.robot/1\"",
            "schema = \"stiction.robot/2\"",
            "schema: ",
        ),
        ("model = ", "modle = ", "identified.model: is missing, but "),
        ("armature = 0.", "armature = -0.", "armature: "),
        (
            "friction = 0.30000000000000004\n",
            "",
            "friction: is missing",
        ),
        (
            "mass = 0.30000000000000004\n",
            "mass = inf\n",
            "body[1].mass: ",
        ),
        ("inertia = [", "inertia = [1.0, ", "six numbers in kg m^2"),
        ("center = [-1e-7, ", "center = [nan, ", "three numbers in m"),
        ("[[body]]\n", "[[body]]\nvolume = 1\n", "body[1].volume: "),
    ] {
        assert!(whole.contains(old), "{old}\n{whole}");
        let said = Robot::parse(&whole.replacen(old, new, 1))
            .unwrap_err()
            .to_string();
        assert!(said.contains(says), "{old}: {said}");
    }
}
