//! A trajectory at every sample of a control rate, computed once for many runs along it.

use crate::path::Reference;
use crate::run::sample_count;
use crate::trajectory::{MAX_PREVIEW, Preview, Trajectory};
use stiction_friction::ParamError;

/// The references of a whole trajectory at a control rate, 24 bytes a sample.
#[derive(Clone, Debug, PartialEq)]
pub struct Sampled {
    rate: f64,
    count: usize,
    /// References beyond the end, as far as a preview may look ahead.
    references: Vec<Reference>,
}

impl Sampled {
    /// `trajectory` at `rate` > 0, Hz, from 0 to its end.
    pub fn new(trajectory: &(impl Trajectory + ?Sized), rate: f64) -> Result<Self, ParamError> {
        ParamError::positive("rate", rate)?;
        let count = sample_count(trajectory.duration(), rate)?;
        let instants = (0..count + MAX_PREVIEW as usize).map(|k| k as f64 / rate);
        Ok(Sampled {
            rate,
            count,
            references: instants.map(|t| trajectory.at(t)).collect(),
        })
    }

    /// Hz
    pub fn rate(&self) -> f64 {
        self.rate
    }

    /// Each reference with the velocity `preview` samples later, m/s (rad/s): what
    /// [`Lookahead`](crate::trajectory::Lookahead) gives, to the bit.
    #[inline]
    pub fn with_preview(
        &self,
        preview: f64,
    ) -> impl ExactSizeIterator<Item = (Reference, f64)> + '_ {
        let preview = Preview::new(preview);
        (0..self.count).map(move |k| {
            let known = &self.references[k..];
            (known[0], preview.velocity(known))
        })
    }
}
