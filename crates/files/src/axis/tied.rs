//! Values whose unit fits one kind of axis only: checked when the log says which it is.

use stiction_log::{Dimension, Log, Motion};

/// A value of the file with its place, text and dimension.
#[derive(Clone, Debug)]
pub(super) struct Tied {
    /// Line and key, as errors begin.
    pub place: String,
    /// The value as typed.
    pub text: String,
    pub dimension: Dimension,
}

impl Tied {
    /// What is allowed instead, if this does not fit the log.
    pub fn misfit(&self, log: &Log) -> Option<String> {
        let forces = [
            Dimension::FORCE,
            Dimension::TORQUE,
            Dimension::CURRENT,
            Dimension::VOLTAGE,
        ];
        let inertia = [Dimension::MASS, Dimension::INERTIA];
        if forces.contains(&self.dimension) {
            let fits = self.dimension.si_text() == log.force_unit;
            return (!fits).then(|| format!("the force of this log is in {}", log.force_unit));
        }
        let (motion, mass) = match log.motion {
            Motion::Linear => (
                [Dimension::LENGTH, Dimension::LINEAR_VELOCITY],
                Dimension::MASS,
            ),
            Motion::Rotary => (
                [Dimension::ANGLE, Dimension::ANGULAR_VELOCITY],
                Dimension::INERTIA,
            ),
        };
        if inertia.contains(&self.dimension) {
            if log.force_unit != log.motion.force().si_text() {
                return Some(format!(
                    "a known mass needs the force in {}, this log has it in {}: give the force a scale",
                    log.motion.force().si_text(),
                    log.force_unit
                ));
            }
            let fits = self.dimension == mass;
            return (!fits).then(|| format!("a {} axis takes {}", log.motion, mass.si_text()));
        }
        let fits = motion.contains(&self.dimension);
        (!fits).then(|| {
            format!(
                "a {} axis takes {} or {}",
                log.motion,
                motion[0].si_text(),
                motion[1].si_text()
            )
        })
    }
}
