//! Values whose unit fits one kind of axis only: checked when the log says which it is.

use stiction_formats::Dimension;
use stiction_log::Motion;

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
    /// What is allowed instead, if this does not fit an axis of that kind, in a `source` that has the force in that unit.
    pub fn misfit(&self, motion: Motion, force_unit: &str, source: &str) -> Option<String> {
        let forces = [
            Dimension::FORCE,
            Dimension::TORQUE,
            Dimension::CURRENT,
            Dimension::VOLTAGE,
        ];
        let inertia = [Dimension::MASS, Dimension::INERTIA];
        if forces.contains(&self.dimension) {
            let fits = self.dimension.si_text() == force_unit;
            return (!fits).then(|| format!("the force of this {source} is in {force_unit}"));
        }
        let (lengths, mass) = match motion {
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
            let force = motion.force().si_text();
            if force_unit != force {
                return Some(format!(
                    "a known mass needs the force in {force}, this {source} has it in {force_unit}: give the force a scale"
                ));
            }
            let fits = self.dimension == mass;
            return (!fits).then(|| format!("a {motion} axis takes {}", mass.si_text()));
        }
        let fits = lengths.contains(&self.dimension);
        (!fits).then(|| {
            format!(
                "a {motion} axis takes {} or {}",
                lengths[0].si_text(),
                lengths[1].si_text()
            )
        })
    }
}
