//! Genes of known parameters, and boxes about them.

use super::options::Cost;
use crate::error::Error;
use crate::wording::Setting;
use std::f64::consts::LN_10;
use stiction_search::Bounds;

/// By how many decades the middle of a box is away from the truth, gene by gene in turn, so that no search profits from
/// starting in the middle; less in boxes of less than a decade.
const BOX_OFFSETS: [f64; 6] = [0.31, -0.27, 0.23, -0.35, 0.29, -0.33];

/// Values that stand in for parameters that are zero, since zero has no logarithm: so small that no record shows
/// them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Floor {
    /// Of sigma1 and sigma2, N s/m.
    damping: f64,
    /// Of the excess of static over Coulomb friction, N.
    excess: f64,
}

impl Floor {
    /// For parameters that are known to be above zero.
    pub const NONE: Self = Self {
        damping: 0.0,
        excess: 0.0,
    };

    /// A hundred-thousandth of the Coulomb friction (N), at the top speed (m/s).
    pub fn new(coulomb: f64, top_speed: f64) -> Self {
        let excess = 1e-5 * coulomb;
        Self {
            damping: excess / top_speed,
            excess,
        }
    }
}

/// Logarithms of the genes of known parameters.
pub(super) fn genome(truth: &[(String, f64)], cost: Cost, floor: Floor) -> Vec<f64> {
    let value = |name: &str| {
        truth
            .iter()
            .find(|(n, _)| n == name)
            .map_or(f64::NAN, |x| x.1)
    };
    match cost {
        Cost::Curve => truth
            .chunks(4)
            .flat_map(|side| {
                let [s2, fc, fs, vs] = [0, 1, 2, 3].map(|i: usize| side[i].1);
                let excess = (fs - fc).max(floor.excess);
                [s2.max(floor.damping), fc, excess, vs]
            })
            .map(libm::log)
            .collect(),
        Cost::Dynamic => ["sigma0", "sigma1"]
            .map(|name| libm::log(value(name)))
            .into(),
        _ => {
            let (fc, fs, vs) = (
                value("coulomb"),
                value("static"),
                value("stribeck_velocity"),
            );
            let damping = |name: &str| value(name).max(floor.damping);
            let excess = (fs - fc).max(floor.excess);
            let six = [
                value("sigma0"),
                damping("sigma1"),
                damping("sigma2"),
                fc,
                excess,
                vs,
            ];
            match cost {
                Cost::Separable => [six[0] / fc, six[4] / fc, vs].map(libm::log).into(),
                _ => six.map(libm::log).into(),
            }
        }
    }
}

/// A box of decades to each side of a point that lies off the given one by `BOX_OFFSETS`.
pub(super) fn about(middle: &[f64], decades: f64) -> Result<Bounds, Error> {
    if !(decades > 0.0 && decades <= 6.0) {
        return Err(Error::usage(
            Setting::Decades.is(decades),
            "decades to each side, above 0 and up to 6",
        ));
    }
    let off = BOX_OFFSETS.map(|x| x * decades.min(1.0));
    let ends = |side: f64| -> Vec<f64> {
        let each = middle.iter().zip(off.iter().cycle());
        each.map(|(x, off)| x + (off + side * decades) * LN_10)
            .collect()
    };
    Bounds::new(ends(-1.0), ends(1.0))
        .map_err(|e| Error::usage(e.to_string(), "parameters above zero"))
}
