//! How motion and torque are filtered.

use super::load::Loaded;
use stiction_files::robot::result::FilterEntry;
use stiction_identify::{Conditioning, Cutoff, Source};
use stiction_policy::robot;
use stiction_signal::Sos;

/// Order of all low-passes.
const ORDER: usize = 4;

/// Samples of a fit for each period of a cut-off far below the sample rate. Source: with 4, laws have too few samples to be
/// compared on held-out blocks of half a minute; the fit counts how far they are correlated.
const SAMPLES_PER_CUTOFF: f64 = 8.0;

/// The filters of one identification.
#[derive(Clone, Debug)]
pub(super) struct Filters {
    /// Cut-offs.
    pub entry: FilterEntry,
    /// The low-pass that the torques passed before they were logged.
    pub channel: Option<Sos>,
    rate: f64,
}

impl Filters {
    /// Those of logs whose torques are as they were measured.
    pub fn of(loaded: &Loaded) -> Self {
        let logs = loaded.joints.iter().flat_map(|joint| &joint.fitted);
        let rate = logs
            .map(|source| source.log.rate_hz)
            .fold(f64::INFINITY, f64::min);
        let common = robot::COMMON_CUTOFF.min(robot::MAX_COMMON_CUTOFF * rate);
        Self {
            entry: FilterEntry {
                source_cutoff_hz: robot::SOURCE_CUTOFF * rate,
                common_cutoff_hz: common,
                torque_cutoff_hz: None,
            },
            channel: None,
            rate,
        }
    }

    /// The same with a low-pass, Hz, that the torques passed before they were logged.
    pub fn behind(mut self, torque_cutoff: Option<f64>) -> Self {
        self.entry.torque_cutoff_hz = torque_cutoff;
        self.channel =
            torque_cutoff.and_then(|hertz| Sos::butterworth_low_pass(ORDER, hertz, self.rate).ok());
        self
    }

    /// How the records of the rigid body are conditioned.
    pub fn of_rigid_body(&self) -> Conditioning {
        self.of_joint(&Conditioning {
            source: Some(Source::Position),
            source_cutoff: Cutoff::Hz(self.entry.source_cutoff_hz),
            common_cutoff: Cutoff::Hz(self.entry.common_cutoff_hz),
            ..Conditioning::default()
        })
    }

    /// How the log of one joint is conditioned for its friction: as the rigid body, which its force depends on, but for faster logs,
    /// whose reversals show more. Behind a low-pass, the columns have to pass it too.
    pub fn of_joint(&self, stated: &Conditioning) -> Conditioning {
        match self.entry.torque_cutoff_hz {
            Some(hertz) => Conditioning {
                source_cutoff: Cutoff::Hz(self.entry.source_cutoff_hz),
                common_cutoff: Cutoff::Hz(hertz),
                force_is_filtered: true,
                decimate: Some(((self.rate / (SAMPLES_PER_CUTOFF * hertz)) as usize).max(1)),
                ..*stated
            },
            None => Conditioning {
                source_cutoff: Cutoff::Hz(self.entry.source_cutoff_hz),
                common_cutoff: Cutoff::Hz(self.entry.common_cutoff_hz.max(self.rate / 20.0)),
                ..*stated
            },
        }
    }
}
