//! What the gallery shows: licensed public recordings, a command for each, and what to export.

/// One entry.
pub struct Entry {
    /// Name of its picture.
    pub name: &'static str,
    pub title: &'static str,
    /// What is to be seen, in a sentence or two.
    pub note: &'static str,
    pub origin: &'static Origin,
    /// Recordings, from their folder.
    pub recordings: &'static [&'static str],
    /// The axis file from the root of the tree, which the command calls `axis.toml`.
    pub axis: Option<&'static str>,
    /// The URDF in example-robot-data.
    pub urdf: Option<&'static str>,
    pub command: &'static str,
    /// One joint of a robot, and which figure of its report, from 0.
    pub joint: Option<(&'static str, usize)>,
    /// Title of the figure of the report.
    pub figure: &'static str,
    pub export: Option<&'static str>,
}

/// Where recordings are from.
pub struct Origin {
    pub source: &'static str,
    pub licence: &'static str,
}

const TRIBOMETER: Origin = Origin {
    source: "https://github.com/jchristopherson/FrictionModels.jl",
    licence: "MIT, (c) 2021 Jason Christopherson and contributors",
};
const ROBOTS: Origin = Origin {
    source: "https://github.com/unisa-acg/inverse-dynamics-solver",
    licence: "BSD-3-Clause, (c) 2025 Automatic Control Group (UNISA)",
};
const SO101: Origin = Origin {
    source: "https://github.com/isaac-sim2real/sage",
    licence: "Apache-2.0",
};
const XL330: Origin = Origin {
    source: "https://github.com/Rhoban/bam",
    licence: "Apache-2.0; its form, the repository of the recordings is not known",
};

const VELOCITY: &str = "Friction over velocity";

const UR10: Entry = Entry {
    name: "ur10",
    title: "Universal Robots UR10, all joints",
    note: "One rosbag of an exciting trajectory and the URDF. The picture is the elbow: torque as logged and as found.",
    origin: &ROBOTS,
    recordings: &["robots/ur10_panda/ur10.db3"],
    axis: None,
    urdf: Some("ur_description/urdf/ur10_robot.urdf"),
    command: "stiction robot ur10.db3 --urdf ur10_robot.urdf --out ur10",
    joint: None,
    figure: "elbow_joint, fitted samples",
    export: Some(
        "stiction export ur10/robot.toml --target mujoco --urdf ur10_robot.urdf --out mujoco",
    ),
};
const PANDA: Entry = Entry {
    name: "panda",
    title: "Franka Emika Panda, all joints",
    note: "At 30 Hz the friction of the large joints stays open; rigid body and friction together are good enough to feed forward. The picture is joint 6.",
    recordings: &["robots/ur10_panda/panda.db3"],
    urdf: Some("panda_description/urdf/panda.urdf"),
    command: "stiction robot panda.db3 --urdf panda.urdf --out panda",
    figure: "panda_joint6, fitted samples",
    export: Some("stiction export panda/robot.toml --target urdf --urdf panda.urdf --out urdf"),
    ..UR10
};
const ROTATION: Entry = Entry {
    name: "so101-rotation",
    title: "SO-101, base rotation",
    note: "A current in eleven steps: bristles stay open, the friction over speed does not. Its signs are those of the following error, from `control.csv` beside the log.",
    origin: &SO101,
    recordings: &[
        "robots/so101/single_joint_rotation/state_motor.csv",
        "robots/so101/single_joint_rotation/control.csv",
    ],
    axis: Some("crates/workflows/library/so101-rotation/axis.toml"),
    urdf: None,
    command: "stiction identify state_motor.csv --axis axis.toml --out result",
    joint: None,
    figure: VELOCITY,
    export: Some(
        "stiction export result/model.toml --target cpp --cycle-time 0.02 --limit 0.3 --out arduino",
    ),
};

/// Every entry, in the order of the page.
pub const ENTRIES: [Entry; 10] = [
    Entry {
        name: "tribometer",
        title: "Tribometer, presliding under 5 N",
        note: "Strokes of 0.2 mm. No constant is determined by itself; the curve is, within 5 %.",
        origin: &TRIBOMETER,
        recordings: &["tribometer/presliding.tsv"],
        axis: Some("crates/workflows/library/tribometer/axis.toml"),
        command: "stiction identify presliding.tsv --axis axis.toml --out result",
        export: Some(
            "stiction export result/model.toml --target c --cycle-time 0.005 --limit 4 --out c",
        ),
        figure: "Force in time",
        ..ROTATION
    },
    UR10,
    Entry {
        name: "ur10-elbow",
        title: "UR10, elbow",
        note: "Friction that grows with the torque the gear transmits, to Structured Text.",
        joint: Some(("elbow_joint", 2)),
        figure: VELOCITY,
        export: Some(
            "stiction export ur10/joints/elbow_joint/model.toml --target st --cycle-time 0.002 --limit 24 --out st",
        ),
        ..UR10
    },
    Entry {
        name: "ur10-wrist",
        title: "UR10, last wrist joint",
        note: "The smallest joint, with the largest relative error.",
        joint: Some(("wrist_3_joint", 5)),
        figure: VELOCITY,
        export: Some(
            "stiction export ur10/joints/wrist_3_joint/model.toml --target ros2 --cycle-time 0.002 --limit 8 --out ros2",
        ),
        ..UR10
    },
    PANDA,
    Entry {
        name: "panda-joint2",
        title: "Panda, joint 2: no",
        note: "The torque is predicted to 1 %, the friction in it is not.",
        joint: Some(("panda_joint2", 1)),
        figure: VELOCITY,
        export: None,
        ..PANDA
    },
    ROTATION,
    Entry {
        name: "so101-elbow",
        title: "SO-101, elbow while two joints move: no",
        note: "The current reads zero in 16 stretches of motion, and the shoulder moves too. Signs as above.",
        recordings: &[
            "robots/so101/coupled_joints/state_motor.csv",
            "robots/so101/coupled_joints/control.csv",
        ],
        axis: Some("validation/so101_elbow.toml"),
        export: None,
        ..ROTATION
    },
    Entry {
        name: "xl330",
        title: "Dynamixel XL330 with a pendulum: weight yes, friction no",
        note: "Six seconds of a servo with a low gain: the weight is found within 6 %, the friction is not.",
        origin: &XL330,
        recordings: &["xl330/sin_sin.json", "xl330/up_and_down.json"],
        axis: Some("crates/workflows/library/xl330/axis.toml"),
        command: "stiction identify sin_sin.json up_and_down.json --axis axis.toml --law dahl --out result",
        export: Some("stiction export result/model.toml --target mujoco --out mujoco"),
        ..ROTATION
    },
    Entry {
        name: "xl330-sines",
        title: "The same servo, one log: no",
        note: "Eight reversals do not separate friction from weight; the next line says what to try.",
        origin: &XL330,
        recordings: &["xl330/sin_sin.json"],
        axis: Some("crates/workflows/library/xl330/axis.toml"),
        command: "stiction identify sin_sin.json --axis axis.toml --out result",
        export: None,
        ..ROTATION
    },
];

impl Entry {
    /// Whether the picture is of the whole log.
    pub fn is_in_time(&self) -> bool {
        self.figure != VELOCITY
    }
}
