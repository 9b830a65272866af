//! The measured recordings, how each is identified, and the limits that its result has to keep.

/// One identification of a recording.
#[derive(Clone, Copy, Debug)]
pub struct Case {
    /// Name of the recording.
    pub name: &'static str,
    /// Axis file in `validation/`.
    pub axis: &'static str,
    /// Logs to fit, below the folder of recordings.
    pub logs: &'static [&'static str],
    /// Logs to validate on.
    pub validate: &'static [&'static str],
    /// Part of the samples to fit; the rest is for validation.
    pub split: Option<f64>,
    /// Method, as typed on the command line.
    pub method: &'static str,
    /// Law.
    pub law: &'static str,
    /// Whether each direction has parameters of its own.
    pub asymmetric: bool,
    /// Limits that the result has to keep.
    pub limits: &'static [Limit],
}

/// A recording as a new user brings it: columns and units in the axis file, no option.
#[derive(Clone, Copy, Debug)]
pub struct DefaultRun {
    /// Name of the recording.
    pub name: &'static str,
    /// Log, below the folder of recordings.
    pub log: &'static str,
    /// Axis file, below the same folder.
    pub axis: &'static str,
}

/// Every recording whose default run has to end in code.
pub const DEFAULT_RUNS: [DefaultRun; 7] = [
    default_run("EMPS", "emps/DATA_EMPS.mat", "axes/emps.toml"),
    default_run(
        "UR10e joint 1",
        "ur10e/joint_1.csv",
        "axes/ur10e_joint_1.toml",
    ),
    default_run(
        "UR10e joint 4",
        "ur10e/joint_4.csv",
        "axes/ur10e_joint_4.toml",
    ),
    default_run(
        "Tribometer",
        "tribometer/presliding.tsv",
        "axes/tribometer.toml",
    ),
    default_run("Servo, sliding", "servo/sliding_1.txt", "axes/servo.toml"),
    default_run("Damiao motor 1", "damiao/motor_1.npz", "axes/damiao.toml"),
    default_run(
        "Robot joint",
        "robot_joint/slow.csv",
        "axes/robot_joint.toml",
    ),
];

const fn default_run(name: &'static str, log: &'static str, axis: &'static str) -> DefaultRun {
    DefaultRun { name, log, axis }
}

/// A number that must not be exceeded.
#[derive(Clone, Copy, Debug)]
pub struct Limit {
    /// Which number.
    pub metric: Metric,
    /// Largest value that is allowed.
    pub most: f64,
}

/// A number of a result.
#[derive(Clone, Copy, Debug)]
pub enum Metric {
    /// Difference of a parameter from a reference value, percent of the reference.
    OffPercent(&'static str, f64),
    /// Relative error of the fit, percent.
    FitPercent,
    /// Residual on the last validation, in the unit of the force.
    HeldOutRms,
    /// The same over that with another axis file in `validation/`.
    HeldOutOver(&'static str),
    /// Position error of the simulation, percent of the rms position from the origin of the encoder.
    PositionPercent,
    /// Force error of the simulated controller, percent.
    ForcePercent,
    /// Largest position residual on the validations, m or rad rms.
    UnseenPosition,
    /// Residual near zero speed over that of the named static law, symmetric or asymmetric alike.
    LowSpeedOver(&'static str),
    /// The same on the held-out part.
    HeldOutLowSpeedOver(&'static str),
}

const fn most(metric: Metric, most: f64) -> Limit {
    Limit { metric, most }
}

/// Every case, in the order of the table in `docs/validation.md`.
pub const CASES: &[Case] = &[
    Case {
        name: "EMPS",
        axis: "emps.toml",
        logs: &["emps/DATA_EMPS.mat"],
        validate: &[],
        split: None,
        method: "separable",
        law: "coulomb-viscous",
        asymmetric: false,
        limits: &[
            most(Metric::OffPercent("mass", 95.1089), 0.5),
            most(Metric::OffPercent("sigma2", 203.5034), 0.5),
            most(Metric::OffPercent("coulomb", 20.3935), 0.5),
            most(Metric::OffPercent("offset", -3.1648), 2.0),
            most(Metric::FitPercent, 4.13),
        ],
    },
    Case {
        name: "EMPS",
        axis: "emps.toml",
        logs: &["emps/DATA_EMPS.mat"],
        validate: &[],
        split: None,
        method: "separable",
        law: "coulomb-viscous",
        asymmetric: true,
        limits: &[most(Metric::FitPercent, 3.20)],
    },
    Case {
        name: "EMPS",
        axis: "emps.toml",
        logs: &["emps/DATA_EMPS.mat"],
        validate: &[],
        split: None,
        method: "separable",
        law: "lugre",
        asymmetric: true,
        limits: &[
            most(Metric::FitPercent, 2.95),
            most(Metric::LowSpeedOver("coulomb-viscous"), 0.6),
        ],
    },
    Case {
        name: "Tribometer",
        axis: "tribometer.toml",
        logs: &["tribometer/presliding.tsv"],
        validate: &[],
        split: Some(0.5),
        method: "separable",
        law: "lugre",
        asymmetric: false,
        limits: &[most(Metric::HeldOutRms, 0.23)],
    },
    Case {
        name: "Tribometer",
        axis: "tribometer.toml",
        logs: &["tribometer/presliding.tsv"],
        validate: &[],
        split: Some(0.5),
        method: "separable",
        law: "elasto-plastic",
        asymmetric: false,
        limits: &[most(Metric::HeldOutRms, 0.12)],
    },
    Case {
        name: "Tribometer",
        axis: "tribometer.toml",
        logs: &["tribometer/presliding.tsv"],
        validate: &[],
        split: Some(0.5),
        method: "separable",
        law: "gms",
        asymmetric: false,
        limits: &[most(Metric::HeldOutRms, 0.12)],
    },
    Case {
        name: "Tribometer",
        axis: "tribometer.toml",
        logs: &["tribometer/presliding.tsv"],
        validate: &[],
        split: Some(0.5),
        method: "separable",
        law: "maxwell-slip",
        asymmetric: false,
        limits: &[most(Metric::HeldOutRms, 0.12)],
    },
    Case {
        name: "Servo, sliding",
        axis: "servo.toml",
        logs: &[
            "servo/sliding_1.txt",
            "servo/sliding_2.txt",
            "servo/sliding_3.txt",
            "servo/sliding_4.txt",
            "servo/sliding_5.txt",
            "servo/sliding_6.txt",
        ],
        validate: &["servo/sliding_7.txt"],
        split: None,
        method: "separable",
        law: "coulomb-viscous",
        asymmetric: false,
        limits: &[
            most(Metric::OffPercent("mass", 1.98e-4), 3.0),
            most(Metric::HeldOutRms, 0.0017),
        ],
    },
    Case {
        name: "UR10e joint 1",
        axis: "ur10e_joint_1.toml",
        logs: &["ur10e/joint_1.csv"],
        validate: &[],
        split: Some(0.5),
        method: "separable",
        law: "lugre",
        asymmetric: false,
        limits: &[most(Metric::HeldOutRms, 0.243)],
    },
    Case {
        name: "UR10e joint 4",
        axis: "ur10e_joint_4.toml",
        logs: &["ur10e/joint_4.csv"],
        validate: &[],
        split: Some(0.5),
        method: "separable",
        law: "lugre",
        asymmetric: false,
        limits: &[
            most(Metric::HeldOutRms, 0.0345),
            most(Metric::HeldOutLowSpeedOver("coulomb-viscous"), 0.55),
        ],
    },
    Case {
        name: "Damiao motor 1",
        axis: "damiao.toml",
        logs: &["damiao/motor_1.npz"],
        validate: &[],
        split: None,
        method: "separable",
        law: "coulomb-viscous",
        asymmetric: false,
        limits: &[most(Metric::OffPercent("mass", 0.0194), 10.0)],
    },
    Case {
        name: "XL330",
        axis: "xl330.toml",
        logs: &["xl330/sin_sin.json"],
        validate: &["xl330/up_and_down.json"],
        split: None,
        method: "separable",
        law: "coulomb-viscous",
        asymmetric: false,
        limits: &[
            most(Metric::HeldOutRms, 0.018),
            most(Metric::HeldOutOver("xl330_without.toml"), 0.45),
        ],
    },
    Case {
        name: "XL330",
        axis: "xl330.toml",
        logs: &["xl330/sin_sin.json"],
        validate: &["xl330/up_and_down.json"],
        split: None,
        method: "separable",
        law: "stribeck",
        asymmetric: false,
        limits: &[
            most(Metric::HeldOutRms, 0.018),
            most(Metric::HeldOutOver("xl330_without.toml"), 0.45),
        ],
    },
    Case {
        name: "XL330",
        axis: "xl330.toml",
        logs: &["xl330/sin_sin.json"],
        validate: &["xl330/up_and_down.json"],
        split: None,
        method: "separable",
        law: "lugre",
        asymmetric: false,
        limits: &[
            most(Metric::HeldOutRms, 0.016),
            most(Metric::HeldOutOver("xl330_without.toml"), 0.7),
        ],
    },
    Case {
        name: "XL330, weight as stated",
        axis: "xl330_known.toml",
        logs: &["xl330/sin_sin.json"],
        validate: &["xl330/up_and_down.json"],
        split: None,
        method: "separable",
        law: "coulomb-viscous",
        asymmetric: false,
        limits: &[
            most(Metric::HeldOutRms, 0.015),
            most(Metric::HeldOutOver("xl330_without.toml"), 0.4),
        ],
    },
    Case {
        name: "EMPS, simulated in closed loop",
        axis: "emps_closed_loop.toml",
        logs: &["emps/DATA_EMPS.mat"],
        validate: &[],
        split: None,
        method: "output-error",
        law: "coulomb-viscous",
        asymmetric: true,
        limits: &[
            most(Metric::PositionPercent, 0.00120),
            most(Metric::ForcePercent, 4.7),
        ],
    },
    Case {
        name: "EMPS, simulated in closed loop",
        axis: "emps_closed_loop.toml",
        logs: &["emps/DATA_EMPS.mat"],
        validate: &[],
        split: None,
        method: "output-error",
        law: "lugre",
        asymmetric: true,
        limits: &[
            most(Metric::PositionPercent, 0.00120),
            most(Metric::ForcePercent, 4.7),
        ],
    },
    Case {
        name: "Servo, presliding",
        axis: "servo_presliding.toml",
        logs: &[
            "servo/presliding_1.txt",
            "servo/presliding_2.txt",
            "servo/presliding_3.txt",
        ],
        validate: &["servo/presliding_4.txt", "servo/presliding_5.txt"],
        split: None,
        method: "output-error",
        law: "lugre",
        asymmetric: false,
        limits: &[most(Metric::UnseenPosition, 200e-6)],
    },
];
