//! The law and its settings as values for a template; the same keys in every target.

use crate::template::Fill;
use stiction_friction::compensator::{Adaptation, Friction, Settings};
use stiction_friction::{Direction, Element, Real, Shape};

/// Settings of the compensator, each written by `text`; a window of 0 is no watchdog.
pub(crate) fn settings<T: Real>(fill: &mut Fill, settings: &Settings<T>, text: fn(T) -> String) {
    let watchdog = settings.watchdog.map(|w| (w.window, w.ratio));
    let (window, ratio) = watchdog.unwrap_or((T::ZERO, T::ONE));
    fill.set("cycle_time", text(settings.cycle_time))
        .set("gain", text(settings.gain))
        .set("dead_zone", text(settings.dead_zone))
        .set("limit", text(settings.limit))
        .set("slew", text(settings.slew))
        .set("ramp", text(settings.ramp))
        .set("window", text(window))
        .set("ratio", text(ratio))
        .flag("adapt", settings.adaptation.is_some());
    if let Some(Adaptation {
        memory,
        range,
        mass,
    }) = settings.adaptation
    {
        fill.set("memory", text(memory))
            .set("range", text(range))
            .set("mass", text(mass));
    }
}

/// The law's numbers, each written by `text`, and flags that say which law and shape it is.
pub(crate) fn fill<T: Real>(fill: &mut Fill, friction: &Friction<T>, text: fn(T) -> String) {
    let curve = friction.curve();
    let elements = elements(friction);
    let attraction = match friction {
        Friction::Gms(law) => Some(law.attraction()),
        _ => None,
    };
    let finite = attraction.is_some_and(|c| c.is_finite());
    let bristle = friction.bristle();
    fill.flag("bristle", bristle.is_some())
        .flag("elastic", matches!(friction, Friction::ElastoPlastic(_)))
        .flag("elements", !elements.is_empty())
        .flag("attraction", finite)
        .flag("stores", bristle.is_some() || !elements.is_empty())
        .flag("decays", bristle.is_some() || finite)
        .flag("curve", curve.is_some())
        .set("count", elements.len().to_string())
        .set("sliding", text(friction.sliding()));
    if let Some(law) = bristle {
        fill.set("sigma0", text(law.stiffness()))
            .set("sigma1", text(law.damping().at_rest()));
    }
    if let Friction::ElastoPlastic(law) = friction {
        fill.set("breakaway", text(law.breakaway()));
    }
    if let Some(attraction) = attraction.filter(|_| finite) {
        fill.set("attraction", text(attraction));
    }
    let flat = |coulomb, viscous| Direction {
        coulomb,
        static_friction: coulomb,
        stribeck_velocity: T::ONE,
        viscous,
    };
    let (pos, neg, offset) = match (curve, friction) {
        (Some(curve), _) => (*curve.positive(), *curve.negative(), curve.offset()),
        (None, Friction::Coulomb(law)) => {
            let (coulomb, viscous) = (law.coulomb(), law.viscous());
            (
                flat(coulomb[0], viscous[0]),
                flat(coulomb[1], viscous[1]),
                law.offset(),
            )
        }
        (None, _) => unreachable!("every other law has a curve"),
    };
    let shape = curve.map(|curve| curve.shape());
    let power = match shape {
        Some(Shape::Power(delta)) => Some(delta),
        _ => None,
    };
    fill.set("offset", text(offset))
        .flag("power", power.is_some())
        .flag("gaussian", shape == Some(Shape::Gaussian))
        .flag("exponential", shape == Some(Shape::Exponential))
        .flag("lorentzian", shape == Some(Shape::Lorentzian))
        .set("exponent", power.map_or(String::new(), text));
    let keys = [
        ["pos_coulomb", "pos_static", "pos_velocity", "pos_viscous"],
        ["neg_coulomb", "neg_static", "neg_velocity", "neg_viscous"],
    ];
    for (keys, side) in keys.into_iter().zip([pos, neg]) {
        fill.set(keys[0], text(side.coulomb))
            .set(keys[1], text(side.static_friction))
            .set(keys[2], text(side.stribeck_velocity))
            .set(keys[3], text(side.viscous));
    }
}

/// The Maxwell-slip elements of a law that has them.
pub(crate) fn elements<T: Real>(friction: &Friction<T>) -> &[Element<T>] {
    match friction {
        Friction::Gms(law) => law.elements(),
        _ => &[],
    }
}

/// A line for each element; `line` is given the number of the element, from 0.
pub(crate) fn element_lines<T: Real>(
    friction: &Friction<T>,
    line: impl Fn(usize, &Element<T>) -> String,
) -> String {
    let lines = elements(friction).iter().enumerate();
    let lines: Vec<String> = lines.map(|(k, element)| line(k, element)).collect();
    lines.join("\n")
}
