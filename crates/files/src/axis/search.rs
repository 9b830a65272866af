//! `[search]`: settings of the searches, and the box that they look in.

use super::gain::Gain;
use super::values::Axis;
use crate::error::Error;
use stiction_formats::{Dimension, Unit};
use stiction_log::Log;
use stiction_search::Method;

/// Keys of `[search.box]`, in the order of the six parameters of a genome: sigma0, sigma1, sigma2, Fc, Fs - Fc, vs.
pub(super) const BOX_KEYS: [&str; 6] = [
    "sigma0",
    "sigma1",
    "sigma2",
    "coulomb",
    "static_excess",
    "stribeck_velocity",
];

/// `[search]`, checked as far as that goes without a log.
#[derive(Clone, Debug, Default)]
pub(super) struct SearchValues {
    /// Methods whose settings are given.
    pub methods: Vec<Method>,
    /// Lower and upper end for each of [`BOX_KEYS`].
    pub bounds: [Option<[Gain; 2]>; 6],
}

impl Axis {
    /// A search with the settings of `[search]`, the usual ones where that is silent; `None` for a name that is none.
    pub fn search_method(&self, name: &str) -> Option<Method> {
        let given = self.search.methods.iter().find(|m| m.name() == name);
        given.cloned().or_else(|| Method::named(name))
    }

    /// Whether `[search.box]` gives a range.
    pub fn has_search_box(&self) -> bool {
        self.search.bounds.iter().any(Option::is_some)
    }

    /// Ends of the ranges of `[search.box]` in the units of a log, for sigma0, sigma1, sigma2, Fc, Fs - Fc and vs; `None`
    /// where the record is to decide.
    ///
    /// # Errors
    /// Where a unit does not fit the log.
    pub fn search_box(&self, log: &Log) -> Result<[Option<[f64; 2]>; 6], Error> {
        let force = Unit::parse(&log.force_unit).map_or(Dimension::ONE, |u| u.dimension());
        let scale = log.mapping.force.as_ref().and_then(|c| c.scale.as_ref());
        let (length, speed) = (log.motion.position(), log.motion.velocity());
        let below = [
            Some(length),
            Some(speed),
            Some(speed),
            Some(Dimension::ONE),
            Some(Dimension::ONE),
            None,
        ];
        let mut out = [None; 6];
        for ((out, ends), below) in out.iter_mut().zip(&self.search.bounds).zip(below) {
            let Some(ends) = ends else { continue };
            let mut si = [0.0; 2];
            for (si, end) in si.iter_mut().zip(ends) {
                *si = match below {
                    Some(below) => self.gain(end, scale, force, below)?,
                    None => self.speed(end, speed)?,
                };
            }
            *out = Some(si);
        }
        Ok(out)
    }

    fn speed(&self, end: &Gain, wanted: Dimension) -> Result<f64, Error> {
        if end.value.unit.dimension() == wanted {
            return Ok(end.value.si());
        }
        let allowed = format!("give it in {}", wanted.si_text());
        Err(self.misfit(&end.place, &format!("\"{}\"", end.value), allowed))
    }
}
