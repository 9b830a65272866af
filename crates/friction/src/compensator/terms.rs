//! What friction depends on beside the velocity, and what is fed forward beside friction.

use super::friction::Friction;
use crate::error::require;
use crate::{ParamError, Real};

/// Most waves of a kind: room for the cosines of a map of the level over the stroke (decision 0116).
pub const WAVES: usize = 12;

/// A quantity that comes in with each sample.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Channel<T> {
    /// Where the parameters of the law hold; what is taken until a number comes in.
    pub reference: T,
    /// Least and largest value that the identification saw: what comes in is held within them.
    pub range: [T; 2],
    /// An angle, rad, of which whole turns do not count: what comes in is taken in the turn nearest to the middle of the range.
    pub turns: bool,
}

/// What comes in beside the motion.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Channels<T> {
    /// Normal load, in the unit of the model.
    pub load: Channel<T>,
    /// Temperature, K.
    pub temperature: Channel<T>,
    /// Position, m (rad).
    pub position: Channel<T>,
    /// Size of the force (torque) that the transmission passes on to the load, N (N m).
    pub transmitted: Channel<T>,
}

/// A wave along the position, `sine sin(rate x) + cosine cos(rate x)`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Wave<T> {
    /// 2 pi over the pitch, >= 0, rad/m (1 for a turn of a rotary axis); 0: no wave.
    pub rate: T,
    /// The identification saw a whole pitch: the wave goes on beyond the range of the position.
    pub whole: bool,
    /// Amplitude of the sine.
    pub sine: T,
    /// Amplitude of the cosine.
    pub cosine: T,
}

/// Friction that changes with more than the velocity (decision 0013): the level is that of the law times
/// `1 + sum slope (x - reference) + sum wave(x)`, and never below 0. Static friction and the stiffness of bristles change with it,
/// micro-damping and the length of presliding stay. For each direction: forward, back.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Levels<T> {
    /// Part of the level per unit of the load.
    pub load: [T; 2],
    /// Part of the level per K.
    pub temperature: [T; 2],
    /// Part of the level per m (rad).
    pub position: [T; 2],
    /// Part of the level per N (N m) that is transmitted.
    pub transmitted: [T; 2],
    /// What is added to that for each N (N m) while the load drives the axis.
    pub driven: [T; 2],
    /// Waves of the level along the position, their amplitudes parts of it.
    pub waves: [[Wave<T>; WAVES]; 2],
    /// Viscous friction per K, N s/m (N m s/rad) per K; sigma2 is never below 0.
    pub viscous: [T; 2],
    /// Quadratic viscous friction, the factor of v |v|, N s^2/m^2 (N m s^2/rad^2), of either sign: viscous friction per speed up to
    /// `top_speed`, and what it is there beyond; never below 0 with sigma2.
    pub quadratic: [T; 2],
    /// Largest speed that the identification saw, >= 0, m/s (rad/s).
    pub top_speed: T,
}

/// What load, temperature and position make of friction, for each direction: forward, back.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Changes<T> {
    /// Factor on the level, >= 0.
    pub level: [T; 2],
    /// Added to sigma2 at standstill, N s/m (N m s/rad).
    viscous: [T; 2],
    /// And per speed, up to the top speed.
    quadratic: [T; 2],
    top_speed: T,
    /// Of the law: with what is added it is not below 0.
    sigma2: [T; 2],
}

impl<T: Real> Changes<T> {
    /// Nothing is changed.
    pub fn none() -> Self {
        Changes {
            level: [T::ONE; 2],
            viscous: [T::ZERO; 2],
            quadratic: [T::ZERO; 2],
            top_speed: T::ZERO,
            sigma2: [T::ZERO; 2],
        }
    }

    /// What is added to the viscous friction of the law at the velocity `v`, m/s (rad/s), as a coefficient, N s/m (N m s/rad), and
    /// how much the force that it makes grows with the velocity.
    #[inline]
    pub fn viscous(&self, v: T) -> (T, T) {
        let side = usize::from(v < T::ZERO);
        let speed = v.abs();
        let added = thicker(
            self.viscous[side],
            self.quadratic[side],
            speed.min(self.top_speed),
        );
        let least = -self.sigma2[side];
        match (added < least, speed < self.top_speed) {
            (true, _) => (least, least),
            (false, true) => (added, added + self.quadratic[side] * speed),
            (false, false) => (added, added),
        }
    }
}

/// Viscous friction beside sigma2 at a speed within what the identification saw.
#[inline]
fn thicker<T: Real>(viscous: T, quadratic: T, speed: T) -> T {
    viscous + quadratic * speed
}

/// A weight: what holds the axis where it stands.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Weight<T> {
    /// Constant force, N (N m). The law beside it has no offset.
    pub constant: T,
    /// What changes with the angle of a rotary axis, amplitudes in N m.
    pub wave: Wave<T>,
}

/// What a compensator knows beside the law.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Terms<T> {
    /// What comes in, as far as anything below depends on it.
    pub channels: Channels<T>,
    /// What friction depends on.
    pub levels: Option<Levels<T>>,
    /// Mass that is fed forward with the acceleration of the reference, >= 0, kg (kg m^2); 0: none.
    pub mass: T,
    /// The weight that is fed forward.
    pub weight: Option<Weight<T>>,
    /// Cogging that is fed forward, amplitudes in N (N m).
    pub cogging: [Wave<T>; WAVES],
}

/// What the channels are away from their references.
#[derive(Clone, Copy, Debug)]
pub(super) struct Away<T> {
    pub load: T,
    pub temperature: T,
    pub position: T,
    pub transmitted: T,
    /// What is transmitted where the load drives the axis, else 0: for friction against motion forward and back.
    pub driven: [T; 2],
}

/// A position as it came in last, in its turn where whole turns do not count, and within the range of the identification, m (rad).
#[derive(Clone, Copy, Debug)]
pub(super) struct Place<T> {
    pub came: T,
    pub within: T,
}

/// Turns away from the middle of a range up to which an angle is taken back; what is farther away is held at the end.
const MOST_TURNS: f64 = 1e6;

impl<T: Real> Channel<T> {
    /// Middle of the range.
    pub fn middle(&self) -> T {
        let [low, high] = self.range;
        low + T::from_f64(0.5) * (high - low)
    }

    /// An angle of which whole turns do not count, in the turn nearest to the middle of the range; anything else as it is.
    #[inline]
    pub(super) fn turned(&self, x: T) -> T {
        if !self.turns {
            return x;
        }
        let turn = T::from_f64(core::f64::consts::TAU);
        let turns = (x - self.middle()) / turn;
        match turns.abs() <= T::from_f64(MOST_TURNS) {
            true => x - turn * nearest(turns),
            false => x,
        }
    }

    #[inline]
    pub(super) fn within(&self, x: T) -> T {
        x.max(self.range[0]).min(self.range[1])
    }

    fn validate(&self, name: &'static str) -> Result<(), ParamError> {
        let [low, high] = self.range;
        let known = low.is_finite() && high.is_finite();
        let inside = known && low <= self.reference && self.reference <= high;
        require(inside, name, self.reference, "finite, within its range")
    }

    /// How far a value within the range is from the reference.
    #[inline]
    fn away(&self, x: T) -> T {
        self.within(x) - self.reference
    }

    /// Farthest way from the reference.
    fn reach(&self) -> T {
        let [low, high] = self.range;
        (high - self.reference).max(self.reference - low)
    }
}

/// The nearest whole number, between two the upper one.
#[inline]
fn nearest<T: Real>(x: T) -> T {
    let below = x.floor();
    match x - below >= T::from_f64(0.5) {
        true => below + T::ONE,
        false => below,
    }
}

impl<T: Real> Channels<T> {
    /// Where the axis is.
    #[inline]
    pub(super) fn place(&self, came: T) -> Place<T> {
        Place {
            came,
            within: self.position.within(came),
        }
    }

    /// How far load, temperature, position and what is transmitted are from their references.
    #[inline]
    pub(super) fn away(&self, seen: [T; 4]) -> Away<T> {
        let [load, temperature, position, transmitted] = seen;
        let size = self.transmitted.within(transmitted.abs());
        // Against friction it is what moves the axis.
        let driven = match transmitted < T::ZERO {
            true => [size, T::ZERO],
            false => [T::ZERO, size],
        };
        Away {
            load: self.load.away(load),
            temperature: self.temperature.away(temperature),
            position: self.position.away(position),
            transmitted: size - self.transmitted.reference,
            driven,
        }
    }
}

impl<T: Real> Wave<T> {
    /// Its value at a place.
    #[inline]
    pub(super) fn at(&self, place: Place<T>) -> T {
        if self.rate == T::ZERO {
            return T::ZERO;
        }
        let x = match self.whole {
            true => place.came,
            false => place.within,
        };
        let angle = self.rate * x;
        self.sine * angle.sin() + self.cosine * angle.cos()
    }

    /// Its largest value, or more.
    fn size(&self) -> T {
        self.sine.abs() + self.cosine.abs()
    }

    fn validate(&self, name: &'static str) -> Result<(), ParamError> {
        ParamError::not_negative(name, self.rate)?;
        ParamError::finite(name, self.sine)?;
        ParamError::finite(name, self.cosine)
    }
}

/// The sum of waves at a place.
#[inline]
pub(super) fn sum<T: Real>(waves: &[Wave<T>; WAVES], place: Place<T>) -> T {
    waves.iter().fold(T::ZERO, |sum, wave| sum + wave.at(place))
}

impl<T: Real> Levels<T> {
    /// The factor on the level in a direction, from what the channels are away from their references.
    #[inline]
    pub(super) fn factor(&self, side: usize, away: &Away<T>, place: Place<T>) -> T {
        let mut factor = T::ONE;
        factor = factor + self.load[side] * away.load;
        factor = factor + self.temperature[side] * away.temperature;
        factor = factor + self.position[side] * away.position;
        factor = factor + self.transmitted[side] * away.transmitted;
        factor = factor + self.driven[side] * away.driven[side];
        for wave in &self.waves[side] {
            factor = factor + wave.at(place);
        }
        factor.max(T::ZERO)
    }

    /// What viscous friction of `sigma2` in a direction, N s/m (N m s/rad), gains with what the channels are away, at a speed,
    /// m/s (rad/s).
    #[inline]
    pub(super) fn thicker(&self, side: usize, away: &Away<T>, sigma2: [T; 2], speed: T) -> T {
        let viscous = self.viscous[side] * away.temperature;
        let speed = speed.min(self.top_speed);
        thicker(viscous, self.quadratic[side], speed).max(-sigma2[side])
    }

    /// Quadratic viscous friction at a velocity, m/s (rad/s), with that of the law, N s/m (N m s/rad), and load, temperature and
    /// position at their references: what it adds to the force, N (N m).
    pub fn quadratic_force(&self, sigma2: [T; 2], v: T) -> T {
        let side = usize::from(v < T::ZERO);
        let speed = v.abs().min(self.top_speed);
        thicker(T::ZERO, self.quadratic[side], speed).max(-sigma2[side]) * v
    }

    /// What friction is where load, temperature and position are `seen` and what is transmitted is as at the reference, with viscous friction `sigma2` forward and back,
    /// N s/m (N m s/rad).
    pub fn changes(&self, channels: &Channels<T>, seen: [T; 3], sigma2: [T; 2]) -> Changes<T> {
        let [load, temperature, position] = seen;
        let position = channels.position.turned(position);
        let away = Away {
            driven: [T::ZERO; 2],
            ..channels.away([load, temperature, position, channels.transmitted.reference])
        };
        let place = channels.place(position);
        Changes {
            level: [0, 1].map(|side| self.factor(side, &away, place)),
            viscous: self.viscous.map(|slope| slope * away.temperature),
            quadratic: self.quadratic,
            top_speed: self.top_speed,
            sigma2,
        }
    }

    fn validate(&self) -> Result<(), ParamError> {
        for (name, slopes) in [
            ("load_level", self.load),
            ("temperature_level", self.temperature),
            ("position_level", self.position),
            ("transmitted_level", self.transmitted),
            ("driven_level", self.driven),
            ("temperature_viscous", self.viscous),
            ("quadratic_viscous", self.quadratic),
        ] {
            ParamError::finite(name, slopes[0])?;
            ParamError::finite(name, slopes[1])?;
        }
        ParamError::not_negative("top_speed", self.top_speed)?;
        let mut waves = self.waves.iter().flatten();
        waves.try_for_each(|wave| wave.validate("position_level_wave"))
    }

    /// The largest factor within the ranges, or more.
    pub fn largest(&self, channels: &Channels<T>) -> T {
        let of = |side: usize| {
            let waves = self.waves[side].iter();
            waves.fold(T::ONE, |sum, wave| sum + wave.size())
                + self.load[side].abs() * channels.load.reach()
                + self.temperature[side].abs() * channels.temperature.reach()
                + self.position[side].abs() * channels.position.reach()
                + self.transmitted[side].abs() * channels.transmitted.reach()
                + self.driven[side].abs() * channels.transmitted.range[1].abs()
        };
        of(0).max(of(1))
    }

    /// Whether the level itself changes, not only viscous friction.
    fn moves_the_level(&self) -> bool {
        let slopes = [
            self.load,
            self.temperature,
            self.position,
            self.transmitted,
            self.driven,
        ];
        let mut waves = self.waves.iter().flatten();
        slopes.iter().flatten().any(|slope| *slope != T::ZERO)
            || waves.any(|wave| wave.rate != T::ZERO)
    }
}

impl<T: Real> Terms<T> {
    pub(super) fn validate(&self, friction: &Friction<T>) -> Result<(), ParamError> {
        self.channels.load.validate("load_reference")?;
        self.channels
            .temperature
            .validate("temperature_reference")?;
        self.channels.position.validate("position_reference")?;
        self.channels
            .transmitted
            .validate("transmitted_reference")?;
        let least = self.channels.transmitted.range[0];
        ParamError::not_negative("transmitted", least)?;
        if let Some(levels) = &self.levels {
            levels.validate()?;
            let [forward, back] = friction.coulomb();
            let least = forward.min(back);
            let has = least > T::ZERO || !levels.moves_the_level();
            require(has, "coulomb", least, "> 0 for a level that changes")?;
        }
        ParamError::not_negative("mass", self.mass)?;
        if let Some(weight) = &self.weight {
            ParamError::finite("weight", weight.constant)?;
            weight.wave.validate("gravity")?;
            let none = friction.offset() == T::ZERO;
            let allowed = "0 beside a weight, which has it";
            require(none, "offset", friction.offset(), allowed)?;
        }
        let mut waves = self.cogging.iter();
        waves.try_for_each(|wave| wave.validate("cogging"))
    }

    /// Whether anything is fed forward beside friction.
    #[inline]
    pub(super) fn feeds(&self) -> bool {
        self.mass > T::ZERO || self.weight.is_some() || self.cogging[0].rate > T::ZERO
    }

    /// Largest force beside friction and inertia, or more, N (N m).
    pub fn largest_beside(&self) -> T {
        let weight = self.weight.unwrap_or_default();
        let cogging = self.cogging.iter();
        cogging.fold(weight.constant.abs() + weight.wave.size(), |sum, wave| {
            sum + wave.size()
        })
    }

    /// Every number, for the key of a memory.
    pub(super) fn numbers(&self, take: &mut dyn FnMut(T)) {
        let levels = self.levels.unwrap_or_default();
        let weight = self.weight.unwrap_or_default();
        let waves = levels.waves.iter().flatten();
        for wave in waves.chain(&self.cogging).chain([&weight.wave]) {
            [wave.rate, wave.sine, wave.cosine]
                .into_iter()
                .for_each(&mut *take);
        }
        let slopes = [
            levels.load,
            levels.temperature,
            levels.position,
            levels.viscous,
            levels.transmitted,
            levels.driven,
            levels.quadratic,
        ];
        slopes.into_iter().flatten().for_each(&mut *take);
        take(levels.top_speed);
        let c = &self.channels;
        for channel in [c.load, c.temperature, c.position, c.transmitted] {
            let Channel {
                reference,
                range,
                turns,
            } = channel;
            [reference, range[0], range[1]]
                .into_iter()
                .for_each(&mut *take);
            if turns {
                take(T::ONE);
            }
        }
        [weight.constant, self.mass]
            .into_iter()
            .for_each(&mut *take);
    }
}
