//! A motion in the forms in which controllers take it.

mod cam;
mod csp;
mod csv;
mod feed;
mod gcode;
mod halstreamer;
mod piecewise;
mod ros2;
mod st;

use crate::atom::Instant;
use crate::motion::Motion;
use std::fmt;
use stiction_number::short;

/// A form in which a controller takes a motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Carrier {
    /// Rows of time, position, velocity and acceleration at the rate of the log.
    Csv,
    /// A function block of IEC 61131-3 that computes the pieces in the cycle of a PLC.
    St,
    /// A cam over time: what a slave follows behind a master that moves 1 unit a second.
    Cam,
    /// Target positions of CiA 402, cyclic synchronous position mode, in counts of the encoder.
    Csp,
    /// Inputs of `MC_ExtSetPointGenFeed` of TwinCAT for each cycle.
    Feed,
    /// `JointTrajectory` of ROS 2.
    Ros2,
    /// Lines for `halstreamer` of LinuxCNC.
    Halstreamer,
    /// Moves of G-code between the reversals of the motion.
    Gcode,
}

/// What is to be written.
#[derive(Clone, Copy, Debug)]
pub struct Job<'a> {
    /// The motion.
    pub motion: &'a Motion,
    /// Name of the axis in code: letters, digits and underscores, a letter first.
    pub identifier: &'a str,
    /// Whether the axis is rotary.
    pub rotary: bool,
    /// Rows a second where a form has one row for each sample, > 0, Hz.
    pub rate: f64,
    /// One encoder step, > 0, m (rad).
    pub resolution: f64,
    /// Where the axis stands when it starts, m (rad).
    pub start: f64,
}

/// A file, and what its reader has to know before it is used.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Carried {
    /// The form.
    pub carrier: Carrier,
    /// Its text.
    pub text: String,
    /// What it does to the motion, and where it goes: one sentence, in ASCII.
    pub note: String,
}

/// Numbers that a form cannot hold.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CarrierError {
    /// What was found.
    pub found: String,
    /// What is allowed.
    pub allowed: String,
}

impl fmt::Display for CarrierError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}; allowed: {}", self.found, self.allowed)
    }
}

impl std::error::Error for CarrierError {}

impl Carrier {
    /// All forms.
    pub const ALL: [Carrier; 8] = [
        Carrier::Csv,
        Carrier::St,
        Carrier::Cam,
        Carrier::Csp,
        Carrier::Feed,
        Carrier::Ros2,
        Carrier::Halstreamer,
        Carrier::Gcode,
    ];

    /// The name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Carrier::Csv => "csv",
            Carrier::St => "st",
            Carrier::Cam => "cam",
            Carrier::Csp => "csp",
            Carrier::Feed => "feed",
            Carrier::Ros2 => "ros2",
            Carrier::Halstreamer => "halstreamer",
            Carrier::Gcode => "gcode",
        }
    }

    /// The name of its file.
    pub fn file(self) -> &'static str {
        match self {
            Carrier::Csv => "setpoints.csv",
            Carrier::St => "motion.st",
            Carrier::Cam => "setpoints.cam.csv",
            Carrier::Csp => "setpoints.csp.csv",
            Carrier::Feed => "setpoints.feed.csv",
            Carrier::Ros2 => "setpoints.ros2.yaml",
            Carrier::Halstreamer => "setpoints.halstreamer",
            Carrier::Gcode => "setpoints.ngc",
        }
    }

    /// The file for a controller. Its size is in proportion to the duration times the rate, of `St` and `Gcode` to the number of
    /// pieces and reversals.
    ///
    /// # Errors
    /// Where the form cannot hold the numbers.
    ///
    /// ```
    /// use stiction_plan::{Atom, Motion};
    /// use stiction_plan::carrier::{Carrier, Job};
    /// let there = Atom::Move { distance: 0.01, speed: 0.1, acceleration: 2.0, jerk: 400.0 };
    /// let motion = Motion::new(vec![there]).unwrap();
    /// let job = Job { motion: &motion, identifier: "x", rotary: false, rate: 1e3, resolution: 1e-6, start: 0.0 };
    /// let csp = Carrier::Csp.carry(&job).unwrap();
    /// assert_eq!(csp.carrier.file(), "setpoints.csp.csv");
    /// assert!(csp.text.lines().any(|row| row.ends_with(",10000,0")));
    /// ```
    pub fn carry(self, job: &Job) -> Result<Carried, CarrierError> {
        match self {
            Carrier::Csv => Ok(csv::carry(job)),
            Carrier::St => Ok(st::carry(job)),
            Carrier::Cam => Ok(cam::carry(job)),
            Carrier::Csp => csp::carry(job),
            Carrier::Feed => Ok(feed::carry(job)),
            Carrier::Ros2 => Ok(ros2::carry(job)),
            Carrier::Halstreamer => Ok(halstreamer::carry(job)),
            Carrier::Gcode => Ok(gcode::carry(job)),
        }
    }
}

impl Job<'_> {
    /// m or rad.
    fn length(&self) -> &'static str {
        if self.rotary { "rad" } else { "m" }
    }

    /// What machine tools count in: mm or degrees, and how many of them are a metre or a radian.
    fn machine(&self) -> (&'static str, f64) {
        match self.rotary {
            false => ("mm", 1e3),
            true => ("deg", 180.0 / std::f64::consts::PI),
        }
    }

    /// Time and reference of every sample, the last at or after the end, where the axis is at rest.
    fn samples(&self) -> impl Iterator<Item = (f64, Instant)> + '_ {
        let samples = self.motion.duration() * self.rate;
        let whole = samples as u64;
        let last = whole + u64::from(samples > whole as f64);
        (0..=last).map(|k| {
            let t = k as f64 / self.rate;
            (t, self.at(t))
        })
    }

    /// Where positions count from, for a form that holds them as they are commanded.
    fn counts_from(&self) -> String {
        let (start, length) = (short(self.start), self.length());
        format!("positions count from {start} {length}, where the axis has to stand")
    }

    /// The same for a form that is commonly run from wherever the axis stands, by adding `what`: not where it has been added here.
    fn adding(&self, what: &str) -> String {
        match self.start == 0.0 {
            true => format!("positions count from where the axis stands: add {what}"),
            false => format!("{}: add nothing to them", self.counts_from()),
        }
    }

    /// The reference where the axis stands.
    fn at(&self, t: f64) -> Instant {
        let mut at = self.motion.at(t);
        at.position += self.start;
        at
    }
}
