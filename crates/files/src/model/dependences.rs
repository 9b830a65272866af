//! What friction depends on beside the velocity: from a model to what a compensator and a simulated axis take.

use super::ModelFile;
use std::f64::consts::{PI, TAU};
use stiction_friction::compensator::{Channel, Channels, Levels, WAVES, Wave};
use stiction_parameters::{Name, Quantity, Side, Wave as Part};

/// What friction of a model depends on, as far as the model says over which range.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Dependences {
    /// What it depends on, where it changes with that.
    pub channels: Channels<f64>,
    /// How; `None` where friction depends on the velocity alone.
    pub levels: Option<Levels<f64>>,
    /// The parameters that are in the levels.
    pub taken: Vec<String>,
    /// The lines that would bring in what is left at its reference, such as `[range] temperature = [290.0, 310.0]`.
    pub lacking: Vec<&'static str>,
}

impl Dependences {
    /// The same at the reference of what is transmitted: a simulated axis has no weight.
    #[must_use]
    pub fn without_transmitted(mut self) -> Self {
        let levels = self.levels.map(|levels| Levels {
            transmitted: [0.0; 2],
            driven: [0.0; 2],
            ..levels
        });
        self.levels = levels.filter(|levels| *levels != Levels::default());
        self.channels.transmitted = Channel::default();
        self.lacking.retain(|line| !line.contains("transmitted"));
        self.taken.retain(|name| {
            let name = name.parse::<Name>().map(|name| name.quantity);
            !matches!(
                name,
                Ok(Quantity::CoulombTransmitted | Quantity::CoulombDriven)
            )
        });
        self
    }
}

impl ModelFile {
    /// What friction depends on beside the velocity, for the Coulomb levels forward and back, N (N m), of which levels are parts.
    /// Parameters that the log leaves open are left out.
    pub fn dependences(&self, coulomb: [f64; 2]) -> Dependences {
        let mut found = Dependences::default();
        let mut levels = Levels::default();
        let place = self.place();
        let load = self.channel(self.range.load, "load_reference");
        let temperature = self.channel(self.range.temperature, "temperature_reference");
        let transmitted = self.channel(self.range.transmitted, "transmitted_reference");
        let stroke = self.value("position_stroke").filter(|stroke| *stroke > 0.0);
        let length = stroke.unwrap_or(1.0);
        let mut any = false;
        for p in &self.parameter {
            let Ok(name) = p.name.parse::<Name>() else {
                continue;
            };
            if name.quantity == Quantity::QuadraticViscous && !self.leaves_open(name) {
                match self.top_speed() {
                    Some(top) => {
                        levels.top_speed = top;
                        for &side in sides(name.side) {
                            levels.quadratic[side] = p.value;
                        }
                        any = true;
                        found.taken.push(p.name.clone());
                    }
                    None if found.lacking.contains(&TOP_SPEED) => {}
                    None => found.lacking.push(TOP_SPEED),
                }
                continue;
            }
            let (channel, line) = match name.quantity {
                Quantity::CoulombLoad => (load, "[range] load = [LEAST, LARGEST]"),
                Quantity::CoulombTemperature | Quantity::Sigma2Temperature => {
                    (temperature, "[range] temperature = [LEAST, LARGEST] in K")
                }
                Quantity::CoulombPosition => (place, "[range] position = [LEAST, LARGEST]"),
                Quantity::CoulombTransmitted | Quantity::CoulombDriven => {
                    (transmitted, "[range] transmitted = [LEAST, LARGEST]")
                }
                Quantity::CoulombPitch(k, _) if pitch(&self.pitch.coulomb, k).is_none() => {
                    (None, "[pitch] coulomb = [PITCH]")
                }
                Quantity::CoulombMap(_) if stroke.is_none() => {
                    (None, "a [[parameter]] position_stroke")
                }
                Quantity::CoulombPitch(..) | Quantity::CoulombMap(_) => {
                    (place, "[range] position = [LEAST, LARGEST]")
                }
                _ => continue,
            };
            if self.leaves_open(name) {
                continue;
            }
            let Some(channel) = channel else {
                if !found.lacking.contains(&line) {
                    found.lacking.push(line);
                }
                continue;
            };
            let sides = sides(name.side);
            let viscous = name.quantity == Quantity::Sigma2Temperature;
            if !viscous && sides.iter().any(|&side| coulomb[side] <= 0.0) {
                continue;
            }
            // The cosines stand behind the waves of the pitches.
            let slot = |k: u32| self.pitch.coulomb.len() + k as usize - 2;
            if let Quantity::CoulombMap(k) = name.quantity
                && k > 1
                && slot(k) >= WAVES
            {
                continue;
            }
            for &side in sides {
                let part = p.value / coulomb[side];
                match name.quantity {
                    Quantity::CoulombLoad => levels.load[side] = part,
                    Quantity::CoulombTemperature => levels.temperature[side] = part,
                    Quantity::CoulombPosition => levels.position[side] += part,
                    Quantity::CoulombTransmitted => levels.transmitted[side] = part,
                    Quantity::CoulombDriven => levels.driven[side] = part,
                    Quantity::Sigma2Temperature => levels.viscous[side] = p.value,
                    Quantity::CoulombPitch(k, wave_part) => {
                        let at = &mut levels.waves[side][k as usize - 1];
                        if at.rate == 0.0 {
                            let pitch = pitch(&self.pitch.coulomb, k).unwrap_or(1.0);
                            *at = wave(pitch, channel.range);
                        }
                        put(at, wave_part, part);
                    }
                    Quantity::CoulombMap(1) => levels.position[side] += 2.0 * part / length,
                    Quantity::CoulombMap(k) => {
                        let start = channel.reference - 0.5 * length;
                        levels.waves[side][slot(k)] = over_the_stroke(k - 1, start, length, part);
                    }
                    _ => {}
                }
            }
            let c = &mut found.channels;
            match name.quantity {
                Quantity::CoulombLoad => c.load = channel,
                Quantity::CoulombTransmitted | Quantity::CoulombDriven => c.transmitted = channel,
                Quantity::CoulombTemperature | Quantity::Sigma2Temperature => {
                    c.temperature = channel;
                }
                _ => c.position = channel,
            }
            any = true;
            found.taken.push(p.name.clone());
        }
        // Waves of which one was left out move up.
        for waves in &mut levels.waves {
            *waves = together(*waves);
        }
        found.levels = any.then_some(levels);
        found
    }

    /// Largest speed of the recordings, m/s (rad/s), if known.
    pub fn top_speed(&self) -> Option<f64> {
        self.source.top_speed.or(self.range.speed)
    }

    /// The positions that the log has seen. Of a rotary axis that it saw within less than a turn whole turns do not count: an encoder
    /// may begin anywhere, and wrap.
    pub fn place(&self) -> Option<Channel<f64>> {
        let place = self.channel(self.range.position, "position_reference")?;
        let [low, high] = place.range;
        Some(Channel {
            turns: self.kind == "rotary" && high - low < TAU,
            ..place
        })
    }

    /// A parameter by its name as files have it, SI.
    fn value(&self, name: &str) -> Option<f64> {
        let found = self.parameter.iter().find(|p| p.name == name);
        found.map(|p| p.value)
    }

    /// A channel with the reference of the model, within the range that the log saw.
    fn channel(&self, range: Option<[f64; 2]>, reference: &str) -> Option<Channel<f64>> {
        let [low, high] = range?;
        let middle = low + 0.5 * (high - low);
        let reference = self.value(reference).unwrap_or(middle);
        (low <= reference && reference <= high).then_some(Channel {
            reference,
            range: [low, high],
            turns: false,
        })
    }
}

/// What a model with quadratic viscous friction lacks.
const TOP_SPEED: &str = "[range] speed = LARGEST";

/// The places of a side.
fn sides(side: Side) -> &'static [usize] {
    match side {
        Side::Both => &[0, 1],
        Side::Positive => &[0],
        Side::Negative => &[1],
    }
}

/// A wave of a pitch, whole where the log saw all of it.
pub fn wave(pitch: f64, range: [f64; 2]) -> Wave<f64> {
    Wave {
        rate: TAU / pitch,
        whole: range[1] - range[0] >= pitch,
        ..Wave::default()
    }
}

/// So many half waves of a map of the level, which ends where the stroke does.
fn over_the_stroke(halves: u32, start: f64, stroke: f64, amplitude: f64) -> Wave<f64> {
    let rate = f64::from(halves) * PI / stroke;
    Wave {
        rate,
        whole: false,
        sine: amplitude * libm::sin(rate * start),
        cosine: amplitude * libm::cos(rate * start),
    }
}

/// Sets a part of a wave.
pub fn put(wave: &mut Wave<f64>, part: Part, value: f64) {
    match part {
        Part::Sine => wave.sine = value,
        Part::Cosine => wave.cosine = value,
    }
}

/// The waves that there are, first.
pub fn together(waves: [Wave<f64>; WAVES]) -> [Wave<f64>; WAVES] {
    let mut there = waves.into_iter().filter(|w| w.rate > 0.0);
    std::array::from_fn(|_| there.next().unwrap_or_default())
}

/// The k-th pitch, counted from 1, of those that a compensator has room for.
pub fn pitch(pitches: &[f64], k: u32) -> Option<f64> {
    let k = k as usize;
    (1..=WAVES)
        .contains(&k)
        .then(|| pitches.get(k - 1))
        .flatten()
        .copied()
}
