//! Every code of a warning, note or error that a user can see: one table.
//!
//! A code never changes once it was released. Each has a page `docs/codes/<code>.md`: what it means, what stiction did,
//! how to fix it, an example; a test holds that no page is missing and none is left over. Warnings and errors are made from
//! [`Code`], so that no code can be misspelt; in JSON and on the terminal a code is its text.
//!
//! ```
//! use stiction_codes::Code;
//! assert_eq!(Code::ForceSign.as_str(), "force-sign");
//! assert_eq!(Code::from_name("force-sign"), Some(Code::ForceSign));
//! assert!(Code::ALL.contains(&Code::LongSteps));
//! ```

use std::fmt;

macro_rules! codes {
    ($($name:ident = $text:literal: $meaning:literal,)*) => {
        /// The code of a warning, note or error.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[non_exhaustive]
        pub enum Code {
            $(#[doc = concat!("`", $text, "`: ", $meaning, ".")] $name,)*
        }

        impl Code {
            /// Every code.
            pub const ALL: &'static [Code] = &[$(Code::$name,)*];

            /// The code as text, the name of its page.
            pub const fn as_str(self) -> &'static str {
                match self {
                    $(Code::$name => $text,)*
                }
            }

            /// What it means, in a line.
            pub const fn meaning(self) -> &'static str {
                match self {
                    $(Code::$name => $meaning,)*
                }
            }
        }
    };
}

codes! {
    // What was found in a recording.
    Gap = "gap": "samples are missing between two time stamps",
    DuplicateTime = "duplicate-time": "several samples carry the same time stamp",
    TimeMissing = "time-missing": "a row has no time stamp",
    TimeWrap = "time-wrap": "the time counter overflowed and restarted",
    Jitter = "jitter": "samples are not equally spaced",
    MissingCells = "missing-cells": "cells are empty or not numbers",
    ZeroFilled = "zero-filled": "missing samples were written as 0",
    SensorDropout = "sensor-dropout": "a temperature or a load holds numbers that no sensor measured",
    ShortColumn = "short-column": "a column ends before the others",
    UnitAssumed = "unit-assumed": "a unit is given nowhere and was assumed",
    UnlikelySize = "unlikely-size": "a rate, travel, speed or force is one that no machine has: a unit is probably wrong",
    UnitOverride = "unit-override": "the axis file gives another unit than the recording",
    UnitConvention = "unit-convention": "the unit is in use with more than one meaning",
    RateOverride = "rate-override": "the axis file gives another rate than the time stamps of the recording",
    UnsignedCounts = "unsigned-counts": "numbers below zero were written without their sign",
    ForceUnit = "force-unit": "the unit of the force does not fit a linear or rotary axis as stated",
    ForceNotCalibrated = "force-not-calibrated": "the force is a current, a voltage or a fraction of a rated value, not in N or N·m",
    NoForce = "no-force": "no column is a force, torque or current",
    ForceSign = "force-sign": "the sign of the force is inverted, or only its magnitude was logged",
    Saturation = "saturation": "the force saturates at a limit",
    CoarseForce = "coarse-force": "the force comes in coarse steps",
    ForceDead = "force-dead": "the force is zero while the axis moves",
    ForceSpike = "force-spike": "single samples of the force are far beyond all others",
    PositionWrap = "position-wrap": "the position wrapped round and was unwrapped",
    PositionJump = "position-jump": "the position jumps further than any motion could take it",
    StuckEncoder = "stuck-encoder": "the position is frozen while another signal shows motion",
    HeldPosition = "held-position": "the position is renewed less often than it is logged",
    Quantisation = "quantisation": "the position is quantised",
    CoarsePosition = "coarse-position": "the whole travel is only a few encoder steps",
    VelocityMismatch = "velocity-mismatch": "the velocity is not the derivative of the position",
    AccelerationMismatch = "acceleration-mismatch": "the acceleration is not that of the position",
    NoMotion = "no-motion": "the axis does not move",
    NoiseOnly = "noise-only": "motion cannot be distinguished from noise",
    OneDirection = "one-direction": "the axis moves in one direction only",
    ConstantVelocity = "constant-velocity": "the axis moves at one speed only",
    Joined = "joined": "a column comes from another file, joined by its time stamps",
    OffsetEstimated = "offset-estimated": "the offset between the clocks of two files was estimated from what they share",
    EnableIgnored = "enable-ignored": "a column says where the axis is enabled, and is not used",
    NotEnabled = "not-enabled": "rows in which the axis was not enabled, or in another mode, are left out",
    RestAtEnd = "rest-at-end": "the axis stands still at the start or the end of the record",
    RestBetween = "rest-between": "the axis stands still between two motions",
    ConstantColumn = "constant-column": "a column never changes",
    FewSamples = "few-samples": "the record is short",

    // Why a recording was refused.
    LogIo = "log-io": "a recording cannot be opened or read",
    LogFormat = "log-format": "a file does not follow the format it claims",
    LogLimit = "log-limit": "a file asks for more than is allowed",
    LogAmbiguous = "log-ambiguous": "a recording can be read in more than one way",
    LogMissing = "log-missing": "something that is needed is missing in the recording",
    LogUnit = "log-unit": "a unit is unknown or does not fit",
    LogTime = "log-time": "the time stamps cannot be repaired",
    LogValue = "log-value": "a number is outside the allowed range",

    // What came up after the recording was read.
    NotPlanned = "not-planned": "something that the axis file asks for is not in the plan of a motion",
    PlanDiffers = "plan-differs": "a log shows another motion than its plan, or not all of it",
    NotIdentifiable = "not-identifiable": "the data do not determine a parameter",
    NotConverged = "not-converged": "the search ended without converging",
    Interrupted = "interrupted": "the search was stopped; the result is the best found so far",
    PoorFit = "poor-fit": "the law explains too little of the force",
    RicherLawHoldsBetter = "richer-law-holds-better": "a law with more parameters predicts unseen samples much better",
    FrictionDrift = "friction-drift": "the level of friction changes during the log",
    PositionDependence = "position-dependence": "the level of friction changes along the stroke",
    LoadDependence = "load-dependence": "the level of friction changes with the load",
    TemperatureDependence = "temperature-dependence": "the level of friction changes with the temperature",
    PositionRipple = "position-ripple": "a force repeats with the position",
    SpringForce = "spring-force": "a force grows with the position, as that of a spring does",
    Resonance = "resonance": "motor and load vibrate against each other on a spring",
    Backlash = "backlash": "a gap lies between motor and load",
    ClocksApart = "clocks-apart": "force and motion were stamped by two clocks that run apart",
    UnmodelledDynamics = "unmodelled-dynamics": "between force and motion are dynamics that the law does not have",
    LawShape = "law-shape": "friction or inertia has another shape than the law",
    CorrelatedResidual = "correlated-residual": "the residual of a simulated open loop has too few independent samples",
    ForceLate = "force-late": "the force was logged much later than the motion it belongs to",
    ForceNotGiven = "force-not-given": "the drive gave less than the force that was logged",
    ForceFiltered = "force-filtered": "the force was logged behind a low-pass or as a mean over rows",
    MotionLate = "motion-late": "the motion was logged much later than the force it belongs to",
    MassDisagrees = "mass-disagrees": "the log shows another mass than the axis file states",
    DelayDisagrees = "delay-disagrees": "the log shows another delay of the force than the axis file states",
    ExponentDisagrees = "exponent-disagrees": "the log shows another Stribeck exponent than the axis file states",
    LogsDisagree = "logs-disagree": "logs that are fitted together have a parameter differently",
    DelayOutOfRange = "delay-out-of-range": "the fitted delay between force and motion is implausibly long",
    StaticLawAtRest = "static-law-at-rest": "a static law is fitted to an axis at rest or in presliding",
    SimplerLawHoldsBetter = "simpler-law-holds-better": "a law with fewer parameters predicts unseen samples better",
    OutsideBox = "outside-box": "a parameter lies outside the range that the axis file gives a search",
    TooFewSamples = "too-few-samples": "too few usable samples are left after conditioning",
    BadSetting = "bad-setting": "a setting of the conditioning is out of range for this log",
    TooFewSpeeds = "too-few-speeds": "too few constant-velocity stretches for a static map",
    AtForceLimit = "at-force-limit": "a simulated command is at its limit",
    UnsteadyCommand = "unsteady-command": "a simulated command changes wildly from sample to sample",
    FewSpeeds = "few-speeds": "a static map rests on too few speeds",
    LargeShift = "large-shift": "encoder, filters and noise bias a parameter strongly",
    UnsteadyStretches = "unsteady-stretches": "stretches of nearly constant velocity were left out",
    OutlyingPoints = "outlying-points": "points of the static map lie far from its curve",
    NoStep = "no-step": "the force does not step as the procedure requires",
    NoOvershoot = "no-overshoot": "a step response without overshoot cannot be inverted",
    StaticsAssumed = "statics-assumed": "the steady curve is not known and was simplified",
    NoBreakAway = "no-break-away": "the force does not ramp up to break-away",
    NotSimulated = "not-simulated": "a log cannot be simulated: position, reference or mass is missing, or the controller given is not stable",
    BadRecord = "bad-record": "the channels of a log do not fit together",
    BadConfig = "bad-config": "an axis, study or model file was refused",
    BadUrdf = "bad-urdf": "a URDF was refused",
    UrdfInertia = "urdf-inertia": "inertias of a URDF are missing, impossible or not those of the robot",
    JointNotFitted = "joint-not-fitted": "a joint of a robot is not logged, stands still or has no torque",
    TooLarge = "too-large": "a study or a comparison would simulate more than is allowed at once",
    BadCheckpoint = "bad-checkpoint": "a checkpoint is damaged or belongs to another search",
    Usage = "usage": "the command as typed cannot be carried out",
    Internal = "internal": "stiction failed by a fault of its own",
    Device = "device": "a device cannot be reached or recorded from",
    Output = "output": "the output folder or file cannot be used",
    ModelInDoubt = "model-in-doubt": "the model of a study, or what a plan is made from, is not trustworthy",
    NotInStudy = "not-in-study": "the model has terms that a study does not simulate",
    BackEmf = "back-emf": "the voltage that a motor makes brakes the axis more than its friction grows with speed",
    LateEvent = "late-event": "an event of a study comes after the end of a motion",
    LoadNotLearnt = "load-not-learnt": "a load estimate of a study had too little acceleration to learn from",
    NotRun = "not-run": "a combination of a study could not be run",
    NotPromised = "not-promised": "axes drawn for the promise of a study give no figures",
    NotExported = "not-exported": "the target cannot express the model",
    ExportUntrusted = "export-untrusted": "the identification found that the law should not be used to compensate",
    ExportDamping = "export-damping": "micro-damping is limited so that the compensator releases no energy",
    ExportAdaptation = "export-adaptation": "levels that follow the machine take other forces for friction",
    ExportCycleTime = "export-cycle-time": "the cycle time is too long to resolve a reversal",
    ExportRate = "export-rate": "the code is for another cycle time than that of the log",
    ExportLimit = "export-limit": "the force limit is below the friction to compensate, or reached at speed",
    ExportName = "export-name": "the names in the code do not hold the whole name of the axis",
    ExportRatedForce = "export-rated-force": "the friction table exceeds the rated force",
    ExportSimplified = "export-simplified": "the joint of a simulation has Coulomb and viscous friction only",
    ExportSupported = "export-supported": "parameters that the log leaves open make no more force than it supports",
    ExportTerms = "export-terms": "terms other than friction are not in the compensator",
    ExportWrap = "export-wrap": "the position of the log wraps, and friction or a force depends on it without that period",
    ExportSource = "export-source": "FMUs were written without a binary",
    ExportedDiffers = "exported-differs": "exported C gives another force than the compensator of its model",
    LongSteps = "long-steps": "the bristles are too stiff for the steps of the simulation",
}

impl Code {
    /// The code of this text.
    pub fn from_name(text: &str) -> Option<Code> {
        Code::ALL.iter().copied().find(|code| code.as_str() == text)
    }
}

impl fmt::Display for Code {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.as_str())
    }
}

impl serde::Serialize for Code {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.as_str())
    }
}

impl<'de> serde::Deserialize<'de> for Code {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let text = <std::borrow::Cow<'de, str>>::deserialize(deserializer)?;
        Code::from_name(&text).ok_or_else(|| {
            serde::de::Error::custom(format!("{text:?} is not a code of this version"))
        })
    }
}
