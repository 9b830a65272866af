//! Between the controller's command and the force on the axis: amplifier, current loop, motor.

mod back_emf;

use back_emf::BackEmf;
use stiction_friction::ParamError;

/// Longest delay, in control periods.
const MAX_DELAY_PERIODS: usize = 32;

/// Commands that are kept: at least two more than the longest delay, and a power of two, so that an index is a mask.
const KEPT_COMMANDS: usize = (MAX_DELAY_PERIODS + 2).next_power_of_two();

/// Most substeps of a control period: a few numbers are kept for each.
const MAX_SUBSTEPS: u32 = 100_000;

/// Difference from a whole number of control periods below which a delay is taken as whole: rounding.
const DELAY_ROUNDING: f64 = 1e-9;

/// Settings of a drive, immutable while it runs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drive {
    /// Kf, > 0, N/A (N m/A).
    pub force_constant: f64,
    /// Ka, amperes per volt of command, > 0, A/V; of an amplifier that gives a voltage one over the resistance of the motor.
    pub amplifier_gain: f64,
    /// Largest current either way, > 0, A; infinite: none.
    pub peak_current: f64,
    /// Rated (continuous rms) current, > 0, A; infinite: none. Where the rms over the thermal time exceeds it, the current is
    /// limited to it.
    pub rated_current: f64,
    /// Time constant of that average, > 0, s.
    pub thermal_time: f64,
    /// Time constant of the current loop, >= 0, s: 159e-6 for 1 kHz; of an amplifier that gives a voltage inductance over
    /// resistance.
    pub current_lag: f64,
    /// Voltage that motion takes from that of the amplifier, >= 0, V s/m (V s/rad); 0 for an amplifier that controls the
    /// current.
    pub back_emf: f64,
    /// Transport delay from the controller to the amplifier, s: 0 to 32 control periods, not necessarily a whole number.
    pub delay: f64,
}

impl Drive {
    /// A drive that gives the commanded force at once and without limit.
    pub fn ideal() -> Self {
        Drive {
            force_constant: 1.0,
            amplifier_gain: 1.0,
            peak_current: f64::INFINITY,
            rated_current: f64::INFINITY,
            thermal_time: 1.0,
            current_lag: 0.0,
            back_emf: 0.0,
            delay: 0.0,
        }
    }

    /// The linear motor of Zhang et al. 2025 (doi 10.1371/journal.pone.0322844): 96 N/A, 13 A peak (1248 N), 2.3 A rated
    /// (221 N), 1.8 A/V if 10 V is 18 A; with a current loop of 1 kHz. The thermal time is an assumption.
    pub fn linear_motor(delay: f64) -> Self {
        Drive {
            force_constant: 96.0,
            amplifier_gain: 1.8,
            peak_current: 13.0,
            rated_current: 221.0 / 96.0,
            thermal_time: 10.0,
            current_lag: 1.0 / (2.0 * std::f64::consts::PI * 1000.0),
            back_emf: 0.0,
            delay,
        }
    }

    /// Force per volt of command, Kf Ka, N/V (N m/V).
    pub fn gain(&self) -> f64 {
        self.force_constant * self.amplifier_gain
    }

    /// A motor on an amplifier that gives a voltage: the command in volts is `force R/Kf`, the current follows
    /// `L i' + R i = u - k v`. Without limits and delay.
    ///
    /// `force_constant` Kf > 0 in N/A (N m/A), `back_emf` k >= 0 in V s/m (V s/rad), `resistance` R > 0 in ohm, `inductance`
    /// L >= 0 in H.
    pub fn voltage(force_constant: f64, back_emf: f64, resistance: f64, inductance: f64) -> Self {
        Drive {
            force_constant,
            amplifier_gain: 1.0 / resistance,
            current_lag: inductance / resistance,
            back_emf,
            ..Drive::ideal()
        }
    }

    /// The largest force that can be commanded, N (N m).
    pub fn peak_force(&self) -> f64 {
        self.force_constant * self.peak_current
    }

    /// How far a compensation on the reference velocity has to look ahead at a control period of `period` seconds, in
    /// samples: delay and current loop. The half sample by which a held force is late on average is not included: a law
    /// that is stepped with the velocity at the end of a sample is half a sample early by itself.
    pub fn preview(&self, period: f64) -> f64 {
        (self.delay + self.current_lag) / period
    }

    /// Refuses settings out of range for a control period of `period` seconds.
    pub fn validate(&self, period: f64) -> Result<(), ParamError> {
        ParamError::positive("force_constant", self.force_constant)?;
        ParamError::positive("amplifier_gain", self.amplifier_gain)?;
        for (name, current) in [
            ("peak_current", self.peak_current),
            ("rated_current", self.rated_current),
        ] {
            if current.is_nan() || current <= 0.0 {
                return Err(ParamError::new(name, current, "> 0, or infinite"));
            }
        }
        ParamError::positive("thermal_time", self.thermal_time)?;
        ParamError::not_negative("current_lag", self.current_lag)?;
        ParamError::not_negative("back_emf", self.back_emf)?;
        ParamError::not_negative("delay", self.delay)?;
        if self.delay > MAX_DELAY_PERIODS as f64 * period {
            let allowed = "at most 32 control periods";
            return Err(ParamError::new("delay", self.delay, allowed));
        }
        Ok(())
    }
}

/// A running drive at a fixed control period, whose force is computed for equal substeps of it.
#[derive(Clone, Debug, PartialEq)]
pub struct RunningDrive {
    drive: Drive,
    /// Volts of command for a force, V/N.
    per_force: f64,
    /// The last commands, A, the newest at `newest`, both counted modulo the length.
    commands: [f64; KEPT_COMMANDS],
    newest: usize,
    /// A
    current: f64,
    /// Mean square of the current over the thermal time, A^2, and how much of it a period replaces.
    heat: f64,
    warming: f64,
    stretches: Vec<Stretch>,
    back_emf: Option<BackEmf>,
    /// Force, N (N m), and current over the stretch to come, if they have been asked for.
    known: Option<(f64, f64)>,
}

/// What a substep has in common in every period.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Stretch {
    /// Fraction of a period.
    length: f64,
    begins: Following,
    /// After a new command has taken effect within the substep.
    ends: Option<Following>,
}

/// The current loop after one command.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Following {
    /// Age of the command, in periods.
    late: usize,
    /// Fraction of a period.
    length: f64,
    /// Remaining fraction of the distance to the command at the end, and on average.
    left: f64,
    mean: f64,
}

impl RunningDrive {
    /// At rest, for a control period in s with `substeps` substeps, 1 to 100 000.
    pub fn new(drive: Drive, period: f64, substeps: u32) -> Result<Self, ParamError> {
        ParamError::positive("period", period)?;
        drive.validate(period)?;
        if !(1..=MAX_SUBSTEPS).contains(&substeps) {
            let found = f64::from(substeps);
            return Err(ParamError::new("substeps", found, "1 to 100 000"));
        }
        let each = 1.0 / f64::from(substeps);
        let stretches = (0..substeps).map(|i| {
            let begin = f64::from(i) * each;
            drive.stretch(period, begin, begin + each)
        });
        Ok(RunningDrive {
            drive,
            per_force: 1.0 / drive.gain(),
            commands: [0.0; KEPT_COMMANDS],
            newest: 0,
            current: 0.0,
            heat: 0.0,
            warming: -libm::expm1(-period / drive.thermal_time),
            stretches: stretches.collect(),
            back_emf: BackEmf::new(&drive, period * each),
            known: None,
        })
    }

    /// The settings.
    pub fn drive(&self) -> &Drive {
        &self.drive
    }

    /// Takes the force that the controller commands, N (N m), at the beginning of a period; limited to the peak.
    #[inline]
    pub fn command(&mut self, force: f64) {
        let volts = force * self.per_force;
        let current = self.drive.amplifier_gain * volts;
        self.newest = (self.newest + 1) % KEPT_COMMANDS;
        self.commands[self.newest] =
            current.clamp(-self.drive.peak_current, self.drive.peak_current);
        let hot = self.heat > self.drive.rated_current * self.drive.rated_current;
        if hot {
            let rated = self.drive.rated_current;
            self.commands[self.newest] = self.commands[self.newest].clamp(-rated, rated);
        }
        let current = self.current + self.back_emf.map_or(0.0, |emf| emf.current());
        self.heat += self.warming * (current * current - self.heat);
    }

    /// Mean force, N (N m), over the substep `i` of the present period, from 0. To be called for all of them, in order.
    ///
    /// # Panics
    /// If there is no such substep.
    #[inline]
    pub fn force(&mut self, i: usize) -> f64 {
        let known = self.known.take();
        let (force, current) = known.unwrap_or_else(|| self.after(&self.stretches[i], self.newest));
        self.current = current;
        force
    }

    /// The force, N (N m), over the substep after `i`, the last one computed, unless a later command may still change it.
    #[inline]
    pub fn next_force(&mut self, i: usize) -> Option<f64> {
        self.known = self.next(i);
        self.known.map(|(force, _)| force)
    }

    /// What the voltage of the motion does beside the commands over a substep: a damper, N s/m (N m s/rad).
    pub fn damper(&self) -> f64 {
        self.back_emf.map_or(0.0, |emf| emf.damper())
    }

    /// And the mean force, N (N m), that is left over the coming substep from those before.
    #[inline]
    pub fn induced_force(&self) -> f64 {
        self.back_emf.map_or(0.0, |emf| emf.force())
    }

    /// To be told by how much the axis moved in a substep, m (rad).
    #[inline]
    pub fn moved(&mut self, distance: f64) {
        if let Some(emf) = &mut self.back_emf {
            emf.moved(distance);
        }
    }

    /// Force and current as in [`after`](Self::after).
    #[inline]
    fn next(&self, i: usize) -> Option<(f64, f64)> {
        if let Some(stretch) = self.stretches.get(i + 1) {
            return Some(self.after(stretch, self.newest));
        }
        let stretch = &self.stretches[0];
        let latest = stretch.ends.as_ref().unwrap_or(&stretch.begins).late;
        (latest > 0).then(|| self.after(stretch, self.newest + 1))
    }

    /// Mean force, N (N m), and last current, A, over a substep from now on, where `newest` is the index of the newest command.
    #[inline]
    fn after(&self, stretch: &Stretch, newest: usize) -> (f64, f64) {
        let Stretch {
            length,
            begins,
            ends,
        } = stretch;
        let (first, current) = self.follow(begins, newest, self.current);
        let Some(ends) = ends else {
            return (self.drive.force_constant * first, current);
        };
        let (second, current) = self.follow(ends, newest, current);
        let mean = (first * begins.length + second * ends.length) / length;
        (self.drive.force_constant * mean, current)
    }

    /// Mean current and the last one, A, while the loop follows a command from `current` on.
    #[inline]
    fn follow(&self, following: &Following, newest: usize, current: f64) -> (f64, f64) {
        let wanted = self.commands[newest.wrapping_sub(following.late) % KEPT_COMMANDS];
        let off = current - wanted;
        (wanted + off * following.mean, wanted + off * following.left)
    }
}

impl Drive {
    /// The substep from `begin` to `end`, as fractions of a period of `period` seconds.
    fn stretch(&self, period: f64, begin: f64, end: f64) -> Stretch {
        let periods = self.delay / period;
        let whole = libm::floor(periods + DELAY_ROUNDING);
        let part = (periods - whole).max(0.0);
        let whole = whole as usize;
        let length = end - begin;
        if part <= begin || part >= end {
            let late = whole + usize::from(part >= end);
            return Stretch {
                length,
                begins: self.following(late, length, period),
                ends: None,
            };
        }
        Stretch {
            length,
            begins: self.following(whole + 1, part - begin, period),
            ends: Some(self.following(whole, end - part, period)),
        }
    }

    /// What remains of a distance of the current to its end after `span` seconds, and on average over them.
    fn remaining(&self, span: f64) -> (f64, f64) {
        match self.current_lag {
            0.0 => (0.0, 0.0),
            lag => {
                let x = span / lag;
                let gone = -libm::expm1(-x);
                (1.0 - gone, gone / x)
            }
        }
    }

    fn following(&self, late: usize, length: f64, period: f64) -> Following {
        let (left, mean) = self.remaining(length * period);
        Following {
            late,
            length,
            left,
            mean,
        }
    }
}
