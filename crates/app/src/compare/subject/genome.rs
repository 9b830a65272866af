//! Genes of known parameters, and boxes about them.

use super::super::Cost;
use crate::error::Error;
use std::f64::consts::LN_10;
use stiction_search::Bounds;

/// Decades by which the middle of a box is off the truth, in turn; less in boxes of less than a decade.
const OFF: [f64; 6] = [0.31, -0.27, 0.23, -0.35, 0.29, -0.33];

/// Logarithms of the genes of known parameters; what is zero counts as `least`.
pub(super) fn genome(truth: &[(String, f64)], cost: Cost, least: f64) -> Vec<f64> {
    let value = |name: &str| {
        truth
            .iter()
            .find(|(n, _)| n == name)
            .map_or(f64::NAN, |x| x.1)
    };
    match cost {
        Cost::Curve => truth
            .chunks(4)
            .flat_map(|side| [side[0].1, side[1].1, side[2].1 - side[1].1, side[3].1])
            .map(libm::log)
            .collect(),
        _ => {
            let (fc, fs, vs) = (
                value("coulomb"),
                value("static"),
                value("stribeck_velocity"),
            );
            let s2 = value("sigma2").max(least);
            let six = [value("sigma0"), value("sigma1"), s2, fc, fs - fc, vs];
            match cost {
                Cost::Separable => [six[0] / fc, six[4] / fc, vs].map(libm::log).into(),
                _ => six.map(libm::log).into(),
            }
        }
    }
}

/// A box of decades to each side of a point that is off the given one.
pub(super) fn about(middle: &[f64], decades: f64) -> Result<Bounds, Error> {
    if !(decades > 0.0 && decades <= 6.0) {
        return Err(Error::usage(
            format!("--box {decades}"),
            "decades to each side, above 0 and up to 6",
        ));
    }
    let off = OFF.map(|x| x * decades.min(1.0));
    let ends = |side: f64| -> Vec<f64> {
        let each = middle.iter().zip(off.iter().cycle());
        each.map(|(x, off)| x + (off + side * decades) * LN_10)
            .collect()
    };
    Bounds::new(ends(-1.0), ends(1.0))
        .map_err(|e| Error::usage(e.to_string(), "parameters above zero"))
}
