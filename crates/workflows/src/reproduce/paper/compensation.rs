//! What compensates friction in the experiments: nothing, less than the law, and the law.

use crate::study::without_stribeck;
use stiction_friction::compensator::{Compensator, Friction, Settings, Source};
use stiction_friction::{CoulombViscous, LuGre, ParamError};
use stiction_servo::axis::AxisSettings;
use stiction_servo::feedforward::Feedforward;
use stiction_servo::law::AxisLaw;

/// Part of the force that is applied where the measured velocity drives the law, dimensionless: below 1, since this
/// compensation is a positive feedback of friction.
const MEASURED_GAIN: f64 = 0.9;

/// What compensates friction, driven by the reference velocity where nothing else is said.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Compensation {
    /// There is none.
    Nothing,
    /// Coulomb and viscous friction.
    Coulomb,
    /// The steady curve.
    Stribeck,
    /// LuGre without the Stribeck effect.
    Simplified,
    /// LuGre, driven by the reference velocity: a feedforward.
    Reference,
    /// LuGre, driven by the measured velocity, as the paper draws it.
    Measured,
    /// The steady curve, driven by the measured velocity: at standstill only.
    StribeckMeasured,
}

impl Compensation {
    /// All that are compared in motion, none first.
    pub const ALL: [Compensation; 6] = [
        Compensation::Nothing,
        Compensation::Coulomb,
        Compensation::Stribeck,
        Compensation::Simplified,
        Compensation::Reference,
        Compensation::Measured,
    ];

    /// Name for tables.
    pub fn name(self) -> &'static str {
        match self {
            Compensation::Nothing => "none",
            Compensation::Coulomb => "Coulomb",
            Compensation::Stribeck => "Stribeck",
            Compensation::Simplified => "simplified",
            Compensation::Reference => "LuGre, reference velocity",
            Compensation::Measured => "LuGre, measured velocity",
            Compensation::StribeckMeasured => "Stribeck, measured velocity",
        }
    }

    /// Whether it is that of the paper or what that is compared with in its pictures.
    pub fn is_drawn(self) -> bool {
        matches!(
            self,
            Compensation::Nothing | Compensation::Reference | Compensation::Measured
        )
    }

    /// An axis with that compensation by an identified law.
    pub(super) fn compensate(
        self,
        settings: AxisSettings,
        law: &LuGre<f64>,
    ) -> Result<AxisSettings, ParamError> {
        let curve = law.curve();
        let friction = match self {
            Compensation::Nothing => return Ok(settings),
            Compensation::Coulomb => {
                let sides = [curve.positive(), curve.negative()];
                let levels = sides.map(|s| s.coulomb);
                let viscous = sides.map(|s| s.viscous);
                Friction::Coulomb(CoulombViscous::new(levels, viscous, curve.offset())?)
            }
            Compensation::Stribeck | Compensation::StribeckMeasured => Friction::Stribeck(*curve),
            Compensation::Simplified => without_stribeck(&AxisLaw::LuGre(*law))?.friction(),
            Compensation::Reference | Compensation::Measured => Friction::LuGre(*law),
        };
        let period = 1.0 / settings.rate;
        let whole = Settings::bare(period, settings.drive.peak_force());
        let (source, limits, preview) = match self {
            Compensation::Measured | Compensation::StribeckMeasured => {
                let gain = MEASURED_GAIN;
                (Source::Measured, Settings { gain, ..whole }, 0.0)
            }
            _ => (Source::Reference, whole, settings.drive.preview(period)),
        };
        Ok(AxisSettings {
            feedforward: Feedforward::compensator(
                Compensator::new(friction, source, limits)?,
                preview,
            ),
            ..settings
        })
    }
}
