//! Universal Robots over RTDE (Real-Time Data Exchange), protocol version 2: outputs only.
//!
//! Source: "Real-Time Data Exchange (RTDE) Guide", Universal Robots. Numbers are big-endian; a package is its length in two
//! bytes, its kind in one, and its content.

mod package;
mod request;

use crate::error::{Error, Fault};
use crate::link::{Link, shown};
use crate::source::{Column, Sample, Source};
use package::{Package, frame_length, sample};
use request::Request;
use std::time::Duration;

/// Port of RTDE.
pub(crate) const PORT: u16 = 30004;
/// Rate without another wish, Hz: every controller has it.
pub(crate) const RATE: f64 = 125.0;
/// Highest rate, Hz: that of an e-Series controller.
pub(crate) const MAX_RATE: f64 = 500.0;
/// Joints of a robot.
const JOINTS: usize = 6;

/// An output of six joints.
struct Output {
    /// Name in the protocol.
    name: &'static str,
    /// Name of its columns before the number of the joint, 1 to 6.
    column: &'static str,
    unit: &'static str,
}

/// What is asked for beside the time stamp.
const OUTPUTS: [Output; 6] = [
    output("actual_q", "actual_q", "rad"),
    output("actual_qd", "actual_qd", "rad/s"),
    output("actual_current", "actual_current", "A"),
    output("target_q", "target_q", "rad"),
    output("target_moment", "target_moment", "N m"),
    output("joint_temperatures", "joint_temperature", "°C"),
];

const fn output(name: &'static str, column: &'static str, unit: &'static str) -> Output {
    Output { name, column, unit }
}

/// A robot.
pub(crate) struct Rtde {
    host: String,
    port: u16,
    address: String,
    rate: f64,
    columns: Vec<Column>,
    link: Option<Link>,
    recipe: u8,
}

impl Rtde {
    pub fn new(host: String, port: u16, rate: f64) -> Self {
        let of_output = |output: &Output| {
            let column = |joint| Column {
                name: format!("{}{joint}", output.column),
                unit: Some(output.unit.into()),
            };
            (1..=JOINTS).map(column).collect::<Vec<_>>()
        };
        Self {
            address: shown(&host, port),
            host,
            port,
            rate,
            columns: OUTPUTS.iter().flat_map(of_output).collect(),
            link: None,
            recipe: 0,
        }
    }

    /// Agrees on version, outputs and start.
    fn set_up(&self, link: &mut Link) -> Result<u8, Error> {
        let refused = |link: &Link, what: String| Err(link.fault(Fault::Refused, what));
        link.send(&Request::Version.bytes())?;
        let version = link.answer(|link, frame| {
            Ok(match package(link, frame)? {
                Package::Version(accepted) => Some(accepted),
                _ => None,
            })
        })?;
        if !version {
            let what = "has no RTDE protocol version 2; PolyScope 3.4 or later is needed";
            return refused(link, what.into());
        }
        let names: Vec<&str> = OUTPUTS.iter().map(|output| output.name).collect();
        link.send(&Request::Outputs(self.rate, &names).bytes())?;
        let (recipe, kinds) = link.answer(|link, frame| {
            Ok(match package(link, frame)? {
                Package::Outputs(recipe, kinds) => Some((recipe, kinds)),
                _ => None,
            })
        })?;
        let wanted = std::iter::once("DOUBLE").chain(OUTPUTS.iter().map(|_| "VECTOR6D"));
        if recipe == 0 || !kinds.split(',').eq(wanted) {
            let of_name = std::iter::once("timestamp").chain(names);
            let missing = of_name.zip(kinds.split(','));
            let missing: Vec<&str> = missing
                .filter(|(_, kind)| *kind == "NOT_FOUND")
                .map(|(name, _)| name)
                .collect();
            let what = match missing.is_empty() {
                true => format!("refuses the outputs at {} Hz", self.rate),
                false => format!("has no output {}", missing.join(", ")),
            };
            return refused(link, what);
        }
        link.send(&Request::Start.bytes())?;
        let started = link.answer(|link, frame| {
            Ok(match package(link, frame)? {
                Package::Start(accepted) => Some(accepted),
                _ => None,
            })
        })?;
        match started {
            true => Ok(recipe),
            false => refused(
                link,
                format!(
                    "refuses to send at {} Hz; --rate 125 is what every controller has",
                    self.rate
                ),
            ),
        }
    }
}

fn package<'a>(link: &Link, frame: &'a [u8]) -> Result<Package<'a>, Error> {
    let read = Package::read(frame);
    read.map_err(|what| link.fault(Fault::Malformed, what))
}

impl Source for Rtde {
    fn address(&self) -> &str {
        &self.address
    }

    fn columns(&self) -> &[Column] {
        &self.columns
    }

    fn rate(&self) -> f64 {
        self.rate
    }

    fn connect(&mut self) -> Result<(), Error> {
        self.link = None;
        let mut link = Link::connect(&self.host, self.port, frame_length)?;
        self.recipe = self.set_up(&mut link)?;
        self.link = Some(link);
        Ok(())
    }

    fn next(&mut self, wait: Duration, samples: &mut Vec<Sample>) -> Result<(), Error> {
        let Some(link) = &mut self.link else {
            return Err(Error::device(&self.address, Fault::Closed, "not connected"));
        };
        let mut wait = wait;
        while let Some(frame) = link.frame(wait)? {
            if let Package::Data(recipe, data) = package(link, &frame)? {
                let read = sample(data, self.columns.len());
                let read = read.filter(|_| recipe == self.recipe);
                let what = "sends other data than what was agreed on";
                samples.push(read.ok_or_else(|| link.fault(Fault::Malformed, what))?);
                if samples.len() >= crate::source::MANY {
                    break;
                }
            }
            // What is there already, and no more.
            wait = Duration::ZERO;
        }
        Ok(())
    }

    fn incomplete(&self) -> u64 {
        0
    }

    fn close(&mut self) {
        if let Some(mut link) = self.link.take() {
            // The connection ends anyway.
            let _ = link.send(&Request::Pause.bytes());
        }
    }
}
