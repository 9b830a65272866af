//! The friction curve as the result states it.

use stiction_files::result::{
    BandEntry, FrictionAtEntry, FrictionCurveEntry, FrictionLineEntry, ValueEntry,
};
use stiction_files::symbols;
use stiction_identify::{FrictionCurve, Level};
use stiction_log::Motion;
use stiction_parameters::Quantity;

/// The entry of a curve.
pub(super) fn entry(curve: &FrictionCurve, motion: Motion, unit: &str) -> FrictionCurveEntry {
    let direction = |forward: bool| {
        let mut all = curve.directions.iter();
        all.find(|own| own.forward == forward)
            .and_then(|own| band(&own.level))
    };
    let at = |level: &Level| FrictionAtEntry {
        speed: level.speed,
        force: level.force,
        at_once: level.half.at_once,
        repeat: level.half.repeat,
        transfer: level.half.transfer,
    };
    let value = |level: &Level| ValueEntry {
        value: level.force,
        at_once: level.half.at_once,
        repeat: level.half.repeat,
        transfer: level.half.transfer,
    };
    let line = curve.line.as_ref();
    FrictionCurveEntry {
        line: line.map(|[coulomb, viscous]| FrictionLineEntry {
            coulomb: value(coulomb),
            viscous: value(viscous),
            correlation: curve.correlation.map(|(of_both, _)| of_both),
            correlation_with_mass: curve.correlation.and_then(|(_, with_mass)| with_mass),
            viscous_unit: symbols::unit(Quantity::Sigma2.dimension(), motion, unit, ""),
        }),
        speed_unit: symbols::speed_unit(motion).into(),
        unit: unit.into(),
        at: curve.at.iter().map(at).collect(),
        speed: curve.speed.clone(),
        both: band(&curve.both),
        constant: band(&curve.constant),
        forward: direction(true),
        back: direction(false),
    }
}

fn band(levels: &[Level]) -> Option<BandEntry> {
    let of = |value: fn(&Level) -> f64| levels.iter().map(value).collect();
    (!levels.is_empty()).then(|| BandEntry {
        force: of(|level| level.force),
        at_once: of(|level| level.half.at_once),
        repeat: of(|level| level.half.repeat),
        transfer: of(|level| level.half.transfer),
    })
}
