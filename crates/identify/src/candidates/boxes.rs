//! Default search range of the six parameters.

use super::problem::checked;
use crate::conditioning::record::Record;
use crate::error::Error;
use crate::law::{Law, LawKind};
use crate::procedure::LEAST_VELOCITY_SHARE;
use crate::separable::search_box::SearchBox;
use libm::log;
use stiction_search::Bounds;

/// A box from the record alone, in the order of the genome. Presliding length and Stribeck velocity
/// have the range of the separable method; with `F` the largest measured force and `V` the top speed,
/// Fc lies from 1e-2 to 1 F, Fs - Fc from 1e-3 to 3 F, sigma2 from 1e-4 to 1 F/V, sigma1 from 1e-3 to
/// 100 F/V.
pub fn six_parameters(record: &Record) -> Result<Bounds, Error> {
    let inner = SearchBox::from_record(record, &Law::new(LawKind::LuGre))?;
    let force = record.gather(|s| &s.force);
    let most = force.iter().fold(0.0_f64, |m, u| m.max(u.abs()));
    if !(most > 0.0 && most.is_finite()) {
        return Err(Error::NoForce { value: most });
    }
    let (f, per_speed) = (log(most), log(most / record.top_speed()));
    let decade = std::f64::consts::LN_10;
    let bounds = Bounds::new(
        vec![
            inner.low(0) + f - 2.0 * decade,
            per_speed - 3.0 * decade,
            per_speed - 4.0 * decade,
            f - 2.0 * decade,
            f - 3.0 * decade,
            inner.low(2),
        ],
        vec![
            inner.high(0) + f,
            per_speed + 2.0 * decade,
            per_speed,
            f,
            f + log(3.0),
            inner.high(2),
        ],
    );
    let bounds = bounds.map_err(|_| Error::NoForce { value: most })?;
    checked(bounds, 6)
}

/// A box for the steady curve through points of speed and force, in the order of [`Curve`](super::Curve): with `F` the
/// largest force and `V` the top speed, sigma2 lies from 1e-4 to 1 F/V, Fc from 1e-2 to 1 F, Fs - Fc from 1e-3 to 3 F, vs
/// from a fifth of the slowest speed to V. Once for both directions, or once for each.
///
/// # Errors
/// Without a speed or a force that is not zero.
pub fn curve(speed: &[f64], force: &[f64], asymmetric: bool) -> Result<Bounds, Error> {
    let most = force.iter().fold(0.0_f64, |m, f| m.max(f.abs()));
    let speeds = speed.iter().map(|v| v.abs()).filter(|v| *v > 0.0);
    let (slowest, top) = speeds.fold((f64::INFINITY, 0.0_f64), |(a, b), v| (a.min(v), b.max(v)));
    if !(most > 0.0 && most.is_finite() && top.is_finite() && slowest <= top) {
        return Err(Error::NoForce { value: most });
    }
    let (f, per_speed) = (log(most), log(most / top));
    let decade = std::f64::consts::LN_10;
    let low = [
        per_speed - 4.0 * decade,
        f - 2.0 * decade,
        f - 3.0 * decade,
        log(LEAST_VELOCITY_SHARE * slowest),
    ];
    let high = [per_speed, f, f + log(3.0), log(top)];
    let sides = if asymmetric { 2 } else { 1 };
    let bounds = Bounds::new(low.repeat(sides), high.repeat(sides));
    let bounds = bounds.map_err(|_| Error::NoForce { value: most })?;
    let dimensions = bounds.dimensions();
    checked(bounds, dimensions)
}
