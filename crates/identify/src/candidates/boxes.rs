//! Default search range of the six parameters.

use super::problem::checked;
use crate::conditioning::record::Record;
use crate::error::Error;
use crate::law::{Law, LawKind};
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
