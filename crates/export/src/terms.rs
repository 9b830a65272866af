//! What friction depends on and what is fed forward beside it, as values and statements for a template.

use crate::Model;
use crate::number::Literal;
use crate::template::Fill;
use std::f64::consts::TAU;
use stiction_friction::Real;
use stiction_friction::compensator::{
    Channel, Channels, Input, Levels, Terms, WAVES, Wave, Weight,
};

/// What comes in beside velocity, error and enable.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Extra {
    Acceleration,
    Position,
    Load,
    Temperature,
    Transmitted,
}

impl Extra {
    const ALL: [Extra; 5] = [
        Extra::Acceleration,
        Extra::Position,
        Extra::Load,
        Extra::Temperature,
        Extra::Transmitted,
    ];

    /// Those that the terms look at, in the order of every target.
    pub(crate) fn of<T: Real>(terms: &Terms<T>) -> Vec<Self> {
        let used = |extra: &Extra| extra.is_used(terms);
        Self::ALL.into_iter().filter(used).collect()
    }

    fn is_used<T: Real>(self, terms: &Terms<T>) -> bool {
        let levels = terms.levels.unwrap_or_default();
        let some = |slopes: [T; 2]| slopes.iter().any(|x| *x != T::ZERO);
        let waves = |waves: &[Wave<T>; WAVES]| waves[0].rate > T::ZERO;
        let turns = terms.weight.is_some_and(|w| w.wave.rate > T::ZERO);
        match self {
            Extra::Acceleration => terms.mass > T::ZERO,
            Extra::Position => {
                some(levels.position) || waves(&levels.waves[0]) || turns || waves(&terms.cogging)
            }
            Extra::Load => some(levels.load),
            Extra::Temperature => some(levels.temperature) || some(levels.viscous),
            Extra::Transmitted => some(levels.transmitted) || some(levels.driven),
        }
    }

    /// Its name in code.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Extra::Acceleration => "reference_acceleration",
            Extra::Position => "position",
            Extra::Load => "load",
            Extra::Temperature => "temperature",
            Extra::Transmitted => "transmitted",
        }
    }

    /// Puts a value in its place, and gives it back.
    pub(crate) fn put<T: Real>(self, input: &mut Input<T>, value: T) -> T {
        *match self {
            Extra::Acceleration => &mut input.reference_acceleration,
            Extra::Position => &mut input.position,
            Extra::Load => &mut input.load,
            Extra::Temperature => &mut input.temperature,
            Extra::Transmitted => &mut input.transmitted,
        } = value;
        value
    }

    /// Its channel; an acceleration has none.
    pub(crate) fn channel<T: Real>(self, channels: &Channels<T>) -> Option<Channel<T>> {
        match self {
            Extra::Acceleration => None,
            Extra::Position => Some(channels.position),
            Extra::Load => Some(channels.load),
            Extra::Temperature => Some(channels.temperature),
            Extra::Transmitted => Some(channels.transmitted),
        }
    }
}

/// Whether there are any.
pub(crate) fn has<T: Real>(terms: &Terms<T>) -> bool {
    *terms != Terms::default()
}

/// The parts beside friction that are fed forward.
pub(crate) fn parts<T: Real>(terms: &Terms<T>) -> Vec<&'static str> {
    let all = [
        ("mass", terms.mass > T::ZERO),
        ("gravity", terms.weight.is_some()),
        ("cogging", terms.cogging[0].rate > T::ZERO),
    ];
    let there = all.into_iter().filter(|(_, there)| *there);
    there.map(|(name, _)| name).collect()
}

/// The terms in another number type.
pub(crate) fn cast<T: Real>(terms: &Terms<f64>) -> Terms<T> {
    let to = T::from_f64;
    let both = |x: [f64; 2]| x.map(to);
    let channel = |c: &Channel<f64>| Channel {
        reference: to(c.reference),
        range: both(c.range),
        turns: c.turns,
    };
    let wave = |w: Wave<f64>| Wave {
        rate: to(w.rate),
        whole: w.whole,
        sine: to(w.sine),
        cosine: to(w.cosine),
    };
    Terms {
        channels: Channels {
            load: channel(&terms.channels.load),
            temperature: channel(&terms.channels.temperature),
            position: channel(&terms.channels.position),
            transmitted: channel(&terms.channels.transmitted),
        },
        levels: terms.levels.map(|l| Levels {
            load: both(l.load),
            temperature: both(l.temperature),
            position: both(l.position),
            transmitted: both(l.transmitted),
            driven: both(l.driven),
            waves: l.waves.map(|waves| waves.map(wave)),
            viscous: both(l.viscous),
            quadratic: both(l.quadratic),
            top_speed: to(l.top_speed),
        }),
        mass: to(terms.mass),
        weight: terms.weight.map(|w| Weight {
            constant: to(w.constant),
            wave: wave(w.wave),
        }),
        cogging: terms.cogging.map(wave),
    }
}

/// Every number, with a name for a message.
pub(crate) fn numbers(terms: &Terms<f64>) -> Vec<(&'static str, f64)> {
    let levels = terms.levels.unwrap_or_default();
    let weight = terms.weight.unwrap_or_default();
    let c = &terms.channels;
    let mut all = vec![("offset", weight.constant)];
    for (name, channel) in [
        ("load_reference", c.load),
        ("temperature_reference", c.temperature),
        ("position_reference", c.position),
        ("transmitted_reference", c.transmitted),
    ] {
        let [low, high] = channel.range;
        all.extend([channel.reference, low, high].map(|x| (name, x)));
    }
    all.extend(slopes(terms));
    all.push(("top_speed", levels.top_speed));
    let along = levels.waves.iter().flatten().map(|w| ("coulomb_pitch", w));
    let cogging = terms.cogging.iter().map(|w| ("cogging", w));
    for (name, w) in along.chain(cogging).chain([("gravity", &weight.wave)]) {
        all.extend([w.rate, w.sine, w.cosine].map(|x| (name, x)));
    }
    all
}

/// The numbers of which one that is not 0 makes an input count, or a part of the code, with a name for a message.
pub(crate) fn slopes(terms: &Terms<f64>) -> Vec<(&'static str, f64)> {
    let levels = terms.levels.unwrap_or_default();
    let mut all = vec![("mass", terms.mass)];
    for (name, slopes) in [
        ("coulomb_load / coulomb", levels.load),
        ("coulomb_temperature / coulomb", levels.temperature),
        ("coulomb_position / coulomb", levels.position),
        ("coulomb_transmitted / coulomb", levels.transmitted),
        ("coulomb_driven / coulomb", levels.driven),
        ("sigma2_temperature", levels.viscous),
        ("quadratic_viscous", levels.quadratic),
    ] {
        all.extend(slopes.map(|x| (name, x)));
    }
    all
}

/// How a language writes what the statements are made of.
pub(crate) struct Syntax<T> {
    /// A number.
    pub number: fn(T) -> String,
    /// Sine and cosine.
    pub functions: [&'static str; 2],
    /// The position as it came in last, and within its range.
    pub places: [&'static str; 2],
    /// Adds one of two expressions to the factor, the first for friction against motion forward.
    pub choose: fn(&str, &str) -> String,
}

impl<T: Literal> Syntax<T> {
    /// A number that may stand behind an operator.
    fn operand(&self, x: T) -> String {
        let text = (self.number)(x);
        if text.starts_with('-') {
            format!("({text})")
        } else {
            text
        }
    }

    fn wave(&self, wave: &Wave<T>) -> String {
        let x = self.places[usize::from(!wave.whole)];
        let [sine, cosine] = self.functions;
        let (rate, a, b) = (
            self.operand(wave.rate),
            self.operand(wave.sine),
            self.operand(wave.cosine),
        );
        format!("(({a} * {sine}({rate} * {x})) + ({b} * {cosine}({rate} * {x})))")
    }

    /// The sum of waves.
    fn sum(&self, waves: &[Wave<T>]) -> String {
        let there = waves.iter().filter(|w| w.rate > T::ZERO);
        let each: Vec<String> = there.map(|w| self.wave(w)).collect();
        each.join(" + ")
    }
}

/// Values, flags and statements.
pub(crate) fn fill<T: Literal>(fill: &mut Fill, terms: &Terms<T>, syntax: &Syntax<T>) {
    let extras = Extra::of(terms);
    let levels = terms.levels.unwrap_or_default();
    let weight = terms.weight.unwrap_or_default();
    let some = |slopes: [T; 2]| slopes.iter().any(|x| *x != T::ZERO);
    let fed = parts(terms);
    fill.flag("terms", has(terms))
        .flag("levels", terms.levels.is_some())
        .flag("fed", !fed.is_empty())
        .flag(
            "looks",
            terms.weight.is_some() || extras.iter().any(|extra| *extra != Extra::Acceleration),
        )
        .flag("by_load", some(levels.load))
        .flag("by_temperature", some(levels.temperature))
        .flag("by_position", some(levels.position))
        .flag("by_transmitted", some(levels.transmitted))
        .flag("by_driven", some(levels.driven))
        .flag("viscous_by_temperature", some(levels.viscous))
        .flag("viscous_by_speed", some(levels.quadratic))
        .flag(
            "viscous_changes",
            some(levels.viscous) || some(levels.quadratic),
        )
        .set("top_speed", (syntax.number)(levels.top_speed))
        .flag("waves", levels.waves[0][0].rate > T::ZERO)
        .flag("feeds_mass", fed.contains(&"mass"))
        .flag("feeds_gravity", fed.contains(&"gravity"))
        .flag("feeds_cogging", fed.contains(&"cogging"))
        .set("fed_mass", (syntax.number)(terms.mass))
        .set("extra_names", names(terms));
    for (flag, extra) in [
        ("acceleration_in", Extra::Acceleration),
        ("position_in", Extra::Position),
        ("load_in", Extra::Load),
        ("temperature_in", Extra::Temperature),
        ("transmitted_in", Extra::Transmitted),
    ] {
        fill.flag(flag, extras.contains(&extra));
    }
    let c = &terms.channels;
    fill.flag("turns", c.position.turns)
        .set("position_middle", (syntax.number)(c.position.middle()))
        .set("turn", (syntax.number)(T::from_f64(TAU)));
    for (keys, channel) in [
        (["load_reference", "load_low", "load_high"], c.load),
        (
            [
                "temperature_reference",
                "temperature_low",
                "temperature_high",
            ],
            c.temperature,
        ),
        (
            ["position_reference", "position_low", "position_high"],
            c.position,
        ),
        (
            [
                "transmitted_reference",
                "transmitted_low",
                "transmitted_high",
            ],
            c.transmitted,
        ),
    ] {
        let [low, high] = channel.range;
        for (key, x) in keys.into_iter().zip([channel.reference, low, high]) {
            fill.set(key, (syntax.number)(x));
        }
    }
    for (keys, slopes) in [
        (["load_pos", "load_neg"], levels.load),
        (["temperature_pos", "temperature_neg"], levels.temperature),
        (["position_pos", "position_neg"], levels.position),
        (["transmitted_pos", "transmitted_neg"], levels.transmitted),
        (["driven_pos", "driven_neg"], levels.driven),
        (
            ["viscous_temperature_pos", "viscous_temperature_neg"],
            levels.viscous,
        ),
        (["quadratic_pos", "quadratic_neg"], levels.quadratic),
    ] {
        fill.set(keys[0], syntax.operand(slopes[0]))
            .set(keys[1], syntax.operand(slopes[1]));
    }
    let [forward, back] = &levels.waves;
    let waves = forward.iter().zip(back).filter(|(w, _)| w.rate > T::ZERO);
    let waves: Vec<String> = waves
        .map(|(w, b)| (syntax.choose)(&syntax.wave(w), &syntax.wave(b)))
        .collect();
    let constant = syntax.operand(weight.constant);
    let turns = weight.wave.rate > T::ZERO;
    fill.set("level_waves", waves.join("\n"))
        .set(
            "weight_value",
            match turns {
                true => format!("{constant} + {}", syntax.wave(&weight.wave)),
                false => constant,
            },
        )
        .set("cogging_value", syntax.sum(&terms.cogging));
}

/// The names of what comes in, for the head of a list of samples, each after a comma.
pub(crate) fn names<T: Real>(terms: &Terms<T>) -> String {
    let extras = Extra::of(terms).into_iter();
    extras
        .map(|extra| format!(", {}", extra.name().replace('_', " ")))
        .collect()
}

/// What comes in and goes out beside the motion, for the head of a file.
pub(crate) fn interface(model: &Model) -> (Vec<String>, Vec<String>) {
    let terms = &model.terms;
    let number = stiction_number::four_digits;
    let ends = |extra: Extra| {
        let channel = extra.channel(&terms.channels).unwrap_or_default();
        let [low, high] = channel.range;
        format!("{} to {}", number(low), number(high))
    };
    let extras = Extra::of(terms);
    let mut inputs: Vec<String> = extras
        .iter()
        .map(|extra| match extra {
            Extra::Acceleration => format!(
                "     {}: that of the reference in {}, at the instant of its velocity.",
                extra.name(),
                model.acceleration_unit()
            ),
            Extra::Position => format!(
                "     {}: that of the reference in {}, {}{}.",
                extra.name(),
                model.length_unit(),
                ends(*extra),
                match (terms.channels.position.turns, any_whole(terms)) {
                    (true, _) => "; whole turns do not count",
                    (false, true) => ", and beyond for waves that repeat",
                    (false, false) => "",
                },
            ),
            Extra::Load => format!(
                "     {}: in {}, {}.",
                extra.name(),
                model.load_unit(),
                ends(*extra)
            ),
            Extra::Temperature => format!(
                "     {}: in K (degrees Celsius + 273.15), {}.",
                extra.name(),
                ends(*extra)
            ),
            Extra::Transmitted => format!(
                "     {}: the weight and what else the load asks of the motor beside friction and inertia, in {}, positive where the motor has to \
                 push towards positive positions; its size from {}.",
                extra.name(),
                model.force_unit(),
                ends(*extra)
            ),
        })
        .collect();
    if extras.iter().any(|extra| *extra != Extra::Acceleration) {
        inputs.push(
            "     Each is held within the range that the identification saw; one that is not finite counts as the last that was.".into(),
        );
    }
    let fed = parts(terms);
    let mut outputs = Vec::new();
    if !fed.is_empty() {
        outputs.push(format!(
            "     It is the sum of friction, {}, within limit and slew limit; the gain is that of friction.",
            fed.join(", ")
        ));
        let tail = match fed.contains(&"gravity") {
            true => " but the weight, which only enable lets go",
            false => "",
        };
        outputs.push(format!(
            "     part_friction, part_{}: its parts before the limits. The watchdog switches off all{tail}.",
            fed.join(", part_")
        ));
    }
    (inputs, outputs)
}

/// Whether some wave goes on beyond the range of the position.
fn any_whole(terms: &Terms<f64>) -> bool {
    let levels = terms.levels.unwrap_or_default();
    let weight = terms.weight.unwrap_or_default();
    let mut waves = levels.waves[0]
        .iter()
        .chain(&terms.cogging)
        .chain([&weight.wave]);
    waves.any(|w| w.rate > 0.0 && w.whole)
}
