//! The known controller of an axis in the units of the log.

use super::gain::Gain;
use super::values::Axis;
use crate::error::Error;
use stiction_formats::{Dimension, Unit, Value};
use stiction_identify::Controller;
use stiction_log::{Log, Motion};

impl Axis {
    /// The controller in the units of a log: gains in the unit of its force after scaling.
    ///
    /// A gain in the unit that the force has in the file (volts, amperes) is converted by the scale of the force
    /// column, as the force is.
    ///
    /// # Errors
    /// Where a unit fits neither.
    pub fn controller_for(&self, log: &Log) -> Result<Option<Controller>, Error> {
        let force = Unit::parse(&log.force_unit).map_or(Dimension::ONE, |u| u.dimension());
        let channel = log.mapping.force.as_ref();
        let scale = channel.and_then(|c| c.scale.as_ref());
        self.controller_in(log.motion, force, scale)
    }

    /// The controller of an axis without a log, in N (N m); a scale of the force column converts its gains.
    ///
    /// # Errors
    /// Where a unit fits neither.
    pub fn controller_of(&self, motion: Motion) -> Result<Option<Controller>, Error> {
        let channel = self.mapping.force.as_ref();
        let scale = channel.and_then(|c| c.scale.as_ref());
        self.controller_in(motion, motion.force(), scale)
    }

    fn controller_in(
        &self,
        motion: Motion,
        force: Dimension,
        scale: Option<&Value>,
    ) -> Result<Option<Controller>, Error> {
        let Some(values) = &self.controller else {
            return Ok(None);
        };
        let convert = |gain: &Gain, below: Dimension| self.gain(gain, scale, force, below);
        let optional = |gain: &Option<Gain>, below| match gain {
            Some(gain) => convert(gain, below),
            None => Ok(0.0),
        };
        let (length, speed) = (motion.position(), motion.velocity());
        let acceleration = speed.per(Dimension::TIME).unwrap_or(speed);
        Ok(Some(Controller {
            position_gain: values.position_gain,
            speed_gain: convert(&values.speed_gain, speed)?,
            integral_gain: optional(&values.integral_gain, length)?,
            velocity_feedforward: values.velocity_feedforward,
            mass_feedforward: optional(&values.mass_feedforward, acceleration)?,
            force_limit: match &values.force_limit {
                Some(gain) => convert(gain, Dimension::ONE)?,
                None => f64::INFINITY,
            },
            rate: values.rate,
        }))
    }

    /// A gain in units of force per `below`.
    pub(super) fn gain(
        &self,
        gain: &Gain,
        scale: Option<&Value>,
        force: Dimension,
        below: Dimension,
    ) -> Result<f64, Error> {
        let Some(wanted) = force.per(below) else {
            return Ok(gain.value.si());
        };
        let found = gain.value.unit.dimension();
        // kg is N s2/m, but kg m2 is not N m s2/rad: dimensions count the radian.
        let inertia = found == Dimension::INERTIA && wanted.times(Dimension::ANGLE) == Some(found);
        if found == wanted || inertia {
            return Ok(gain.value.si());
        }
        if let Some(scale) = scale
            && scale.unit.dimension().times(found) == Some(wanted)
        {
            return Ok(scale.si().abs() * gain.value.si());
        }
        let raw = scale.and_then(|scale| wanted.per(scale.unit.dimension()));
        let other = raw.map_or(String::new(), |raw| {
            format!(
                ", or in {}, the unit of the log before scaling",
                raw.si_text()
            )
        });
        Err(self.misfit(
            &gain.place,
            &format!("\"{}\"", gain.value),
            format!("give it in {}{other}", wanted.si_text()),
        ))
    }
}
