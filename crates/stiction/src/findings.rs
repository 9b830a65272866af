//! What a result says, wherever it is kept.

use crate::Notice;
use stiction_files::result::{FrictionAtEntry, ResultFile};

/// Friction in steady sliding at one velocity, in the unit of the log's force.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Friction {
    /// The force, with the sign of the velocity, and with the constant force where both directions are known.
    pub force: f64,
    /// Half width of its 95 % interval for the same test again, now.
    pub at_once: f64,
    /// The same for another day.
    pub repeat: f64,
    /// The same for another motion.
    pub transfer: f64,
}

impl Friction {
    pub(crate) fn of(at: FrictionAtEntry) -> Self {
        Self {
            force: at.force,
            at_once: at.at_once,
            repeat: at.repeat,
            transfer: at.transfer,
        }
    }
}

pub(crate) fn warnings(result: &ResultFile) -> impl Iterator<Item = Notice> {
    result.warnings.iter().map(Notice::of)
}

/// What [`Fit`](crate::Fit) and [`SavedFit`](crate::SavedFit) say alike, of the result that `$result` gives.
macro_rules! findings {
    ($kind:ty, $result:expr) => {
        impl $kind {
            fn found(&self) -> &stiction_files::result::ResultFile {
                let result: fn(&$kind) -> &stiction_files::result::ResultFile = $result;
                result(self)
            }

            /// The parameters, in the order of tables.
            pub fn parameters(&self) -> impl Iterator<Item = crate::Parameter<'_>> {
                let entries = self.found().parameters.iter();
                entries.filter_map(crate::Parameter::of)
            }

            /// A parameter: of both directions by its [`Quantity`](crate::Quantity), of one as `(Quantity::Coulomb, Side::Positive)`,
            /// and by a name that a user typed as `"coulomb_pos".parse::<Name>()?`.
            pub fn parameter(&self, name: impl Into<crate::Name>) -> Option<crate::Parameter<'_>> {
                let name = name.into();
                self.parameters().find(|own| own.name() == name)
            }

            /// Covariance of two identified parameters from day to day, in the product of their units; `None` where one of them was not
            /// identified.
            pub fn covariance(
                &self,
                one: impl Into<crate::Name>,
                other: impl Into<crate::Name>,
            ) -> Option<f64> {
                let entry = &self.found().covariance;
                let place = |name: String| entry.names.iter().position(|own| *own == name);
                let row = place(one.into().to_string())?;
                let column = place(other.into().to_string())?;
                entry.matrix.get(row)?.get(column).copied()
            }

            /// Friction in steady sliding at a velocity, m/s (rad/s), whatever the law: with the sign of the velocity, and with the half
            /// widths of its 95 % interval.
            ///
            /// It is linear between the speeds of the result's `friction_curve`, of the direction of the velocity; `None` outside the
            /// speeds of the logs, for a direction that they do not have, and where the axis does not slide.
            pub fn friction(&self, velocity: f64) -> Option<crate::Friction> {
                let curve = self.found().friction_curve.as_ref()?;
                curve.at_velocity(velocity).map(crate::Friction::of)
            }

            /// Least and largest speed at which [`friction`](Self::friction) is known, m/s (rad/s).
            pub fn friction_speeds(&self) -> Option<(f64, f64)> {
                let speed = &self.found().friction_curve.as_ref()?.speed;
                Some((*speed.first()?, *speed.last()?))
            }

            /// The unit of the force.
            pub fn force_unit(&self) -> &str {
                &self.found().axis.force_unit
            }

            /// The family of the law: the one that was asked for, or that the data chose.
            pub fn law_kind(&self) -> crate::LawKind {
                self.found()
                    .law
                    .parse()
                    .expect("a law that was fitted, or looked at when it was read")
            }

            /// Whether each direction has parameters of its own.
            pub fn is_asymmetric(&self) -> bool {
                self.found().asymmetric
            }

            /// Whether the result may be used; if not, [`reasons`](Self::reasons) says why.
            pub fn is_trustworthy(&self) -> bool {
                self.found().trust.trustworthy
            }

            /// Why the result may not be used; empty if it may.
            pub fn reasons(&self) -> &[String] {
                &self.found().trust.reasons
            }

            /// What the law leaves of friction, rms, percent, on samples that were not fitted where there are any; `None` where the
            /// method does not predict the force of a record.
            pub fn friction_left_percent(&self) -> Option<f64> {
                let seen = self.found().trust.compensation.as_ref();
                seen.map(|seen| seen.friction_left_percent)
            }

            /// How the search ended.
            pub fn status(&self) -> crate::Status {
                self.found().search.status
            }

            /// What to know although the identification went on.
            pub fn warnings(&self) -> impl Iterator<Item = crate::Notice> {
                crate::findings::warnings(self.found())
            }

            /// How well the law fits the samples that it was fitted to.
            pub fn quality(&self) -> crate::Quality {
                crate::Quality::of(&self.found().fit)
            }

            /// Everything that was found, as `result.json` has it (docs/result.md); its keys are only ever extended.
            pub fn result(&self) -> serde_json::Value {
                serde_json::to_value(self.found()).expect("plain data")
            }
        }
    };
}

pub(crate) use findings;
