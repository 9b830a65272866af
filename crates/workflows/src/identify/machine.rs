//! Whether an identified axis is one that can be built: a wrong unit makes one that cannot, whose law follows the log as well.
//!
//! A wrong unit of length, force or time moves each size of an axis by a power of its own. Of the columns whose unit may be wrong the
//! one is named whose next larger or smaller unit brings all sizes back to those of machines, or nearest to them.

use super::load::{Asked, Loaded};
use stiction_files::axis::entry;
use stiction_files::{Warning, symbols};
use stiction_identify::FittedLaw;
use stiction_log::{Log, Motion, Role};
use stiction_parameters::Quantity;
use stiction_say::Notice;

/// A size of an axis.
struct Size {
    name: &'static str,
    /// SI units, linear and rotary.
    units: [&'static str; 2],
    /// Powers of length (angle), force (torque) and time in it.
    powers: [i32; 3],
    /// The least and the most that machines have, linear and rotary.
    limits: [[f64; 2]; 2],
}

/// In the order of [`sizes`]; the limits are a decade or so beyond those of machines.
///
/// Masses: a probe on a chip to the largest gantry, the hand of a watch to a telescope. Friction over mass: from half of what
/// rolling bearings alone have (coefficients of 0.001 to 0.003: catalogues of SKF and THK) to a hundred times gravity. Stribeck
/// velocity, 1e-5 to 0.1 m/s, and break-away distance, 1 to 50 um: Armstrong-Helouvry, Dupont, Canudas de Wit 1994, Automatica
/// 30(7); angles at radii of a millimetre to ten metres, and of gears. Resonance of the mass on the bristles: 10 Hz to 1 kHz, as
/// of any drive train. Strokes: of a piezo stage and of a crane.
const SIZES: [Size; 6] = [
    size(
        "mass",
        ["kg", "kg m^2"],
        [-1, 1, 2],
        [1e-6, 1e6],
        [1e-12, 1e9],
    ),
    size(
        "Coulomb friction over mass",
        ["m/s^2", "rad/s^2"],
        [1, 0, -2],
        [5e-3, 1e3],
        [1e-4, 1e6],
    ),
    size(
        "Stribeck velocity",
        ["m/s", "rad/s"],
        [1, 0, -1],
        [1e-6, 1.0],
        [1e-7, 1e3],
    ),
    size(
        "break-away distance",
        ["m", "rad"],
        [1, 0, 0],
        [1e-8, 1e-2],
        [1e-9, 1.0],
    ),
    size(
        "resonance of sigma0 and mass",
        ["Hz", "Hz"],
        [0, 0, -1],
        [0.3, 3e4],
        [0.1, 3e4],
    ),
    size("stroke", ["m", "rad"], [1, 0, 0], [1e-6, 1e4], [1e-6, 1e12]),
];

const fn size(
    name: &'static str,
    units: [&'static str; 2],
    powers: [i32; 3],
    linear: [f64; 2],
    rotary: [f64; 2],
) -> Size {
    Size {
        name,
        units,
        powers,
        limits: [linear, rotary],
    }
}

/// What the next larger unit is worth: of length, force and time, and of an angle.
const LARGER: f64 = 1e3;
const LARGER_ANGLE: f64 = 180.0 / std::f64::consts::PI;

/// Names the size that no machine has, the column whose unit is probably wrong, and the line of another one; `None` where all are
/// those of machines, or the axis file states in `[limits]` what moves.
pub(super) fn unlikely(asked: Asked, loaded: &Loaded, law: &FittedLaw) -> Option<Warning> {
    let log = &loaded.sources[0].log;
    let limits = asked.axis.limits.as_ref();
    if limits.is_some_and(|limits| limits.mass.is_some()) {
        return None;
    }
    let own = usize::from(log.motion == Motion::Rotary);
    let found = sizes(log, law);
    // Decades beyond the limits where the units are so many times as large.
    let beyond = |(size, value): (&Size, &Option<f64>), units: [f64; 3]| -> f64 {
        let powers = units.iter().zip(size.powers);
        let scale: f64 = powers.map(|(unit, power)| unit.powi(power)).product();
        let [low, high] = size.limits[own];
        let factor = |value: f64| (low / (scale * value)).max(scale * value / high);
        value.map_or(0.0, |value| factor(value).max(1.0).log10())
    };
    let mut all = SIZES.iter().zip(&found);
    let (size, value) = all.find(|one| beyond(*one, [1.0; 3]) > 0.0)?;
    let moved = match log.position {
        Some(_) => Role::Position,
        None => Role::Velocity,
    };
    let angle = log.motion == Motion::Rotary;
    let columns = [moved, Role::Force, Role::Time].into_iter().enumerate();
    let others = columns.flat_map(|(i, role)| [(i, role, true), (i, role, false)]);
    let left = |&(i, _, too_small): &(usize, Role, bool)| -> f64 {
        let larger = if angle && i == 0 {
            LARGER_ANGLE
        } else {
            LARGER
        };
        let mut units = [1.0; 3];
        units[i] = if too_small { larger } else { 1.0 / larger };
        SIZES.iter().zip(&found).map(|one| beyond(one, units)).sum()
    };
    let (_, role, too_small) = others.min_by(|a, b| left(a).total_cmp(&left(b)))?;
    let column = log.columns.iter().find(|c| c.role == Some(role));
    let joined = asked.axis.joined.iter().any(|c| c.from.role == role);
    let line = log.in_another_unit(role, too_small).filter(|_| !joined);
    let notice = Notice::NoMachine {
        size: size.name,
        value: (*value)?,
        usual: size.limits[own],
        unit: size.units[own],
        role: role.name(),
        column: column.map(|c| (c.column.clone(), c.unit.clone())),
        line: line.map(|channel| entry(&channel)),
    };
    Some(notice.into())
}

/// The sizes of an axis, SI; `None` where the log does not determine them.
fn sizes(log: &Log, law: &FittedLaw) -> [Option<f64>; SIZES.len()] {
    let of = |quantity: Quantity| {
        let own = law
            .parameters
            .iter()
            .filter(|p| p.name.quantity == quantity);
        let mut known = own.filter(|p| p.identifiable && p.value > 0.0);
        known.next().map(|p| p.value)
    };
    let mass = of(Quantity::Mass);
    // A current makes no mass, but friction over mass is as that of a force.
    let in_newtons = log.force_unit == symbols::force_unit(log.motion);
    let per_mass = |value: Option<f64>| Some(value? / mass?);
    let stiffness = of(Quantity::Sigma0);
    let stroke = |x: &[f64]| {
        let high = x.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        high - x.iter().copied().fold(f64::INFINITY, f64::min)
    };
    let position = log.position.as_deref();
    [
        mass.filter(|_| in_newtons),
        per_mass(of(Quantity::Coulomb)),
        of(Quantity::StribeckVelocity),
        of(Quantity::Static)
            .zip(stiffness)
            .map(|(force, s)| force / s),
        per_mass(stiffness).map(|square| square.sqrt() / std::f64::consts::TAU),
        position.map(stroke).filter(|_| !law.stays_in_presliding()),
    ]
}
