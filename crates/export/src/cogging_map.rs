//! Cogging as maps of the force along the position: one as CSV, and over a turn of the motor those that motor drivers hold.
//!
//! ODrive, firmware 0.5 (`controller.cpp`, MIT): `anticogging.cogging_map`, 3600 torques in N m as float; entry i acts from i to i+1
//! parts of a turn. moteus (`bldc_servo_structs.h`, Apache-2.0): `motor.cogging_dq_comp`, 1024 int8 that count in `cogging_dq_scale`
//! amperes of Q current, with lines between them.

use crate::map::Map;
use crate::number::short;
use crate::template::Fill;
use crate::{Advice, Error, File, Model, header};
use std::f64::consts::TAU;
use stiction_codes::Code;
use stiction_friction::compensator::Wave;

const CSV: &str = include_str!("../templates/cogging_map/map.csv.in");
const MOTEUS: &str = include_str!("../templates/cogging_map/moteus.cfg.in");

/// Places over the shortest wave, and fewest and most places of the table.
const OVER_A_WAVE: f64 = 64.0;
const PLACES: (f64, f64) = (512.0, 65_536.0);
/// Entries of ODrive and moteus over a turn.
const ODRIVE: usize = 3600;
const MOTEUS_ENTRIES: usize = 1024;
/// Largest part of a wave by which waves miss a whole number of a period: a pitch that was typed with a few digits.
const MISFIT: f64 = 0.01;
/// Largest error of a driver's map that nothing is said of, as a part of the waves: int8 rounds by 0.4 % alone.
const COARSE: f64 = 0.02;
/// Places between two entries at which a driver's map is compared with the law.
const BETWEEN: usize = 8;

pub(crate) fn files(model: &Model) -> Result<Vec<File>, Error> {
    let waves = waves(model)?;
    let force = |x: f64| [force(&waves, model, x)];
    let shortest = waves
        .iter()
        .map(|w| TAU / w.rate)
        .fold(f64::INFINITY, f64::min);
    let period = period(model, &waves);
    let length = match (period, range(model)) {
        (Some(period), _) => period,
        (None, [low, high]) => high - low,
    };
    let places = (OVER_A_WAVE * length / shortest).ceil().max(PLACES.0);
    if places > PLACES.1 {
        return Err(Error::Missing {
            target: "cogging-map",
            reason: "the stroke has more than a thousand waves: export the cogging as code instead, with --feedforward friction,cogging",
        });
    }
    let map = match (period, range(model)) {
        (Some(period), _) => Map::around(0.0, period, places as usize, force),
        (None, [low, high]) => Map::along(low, high, places as usize + 1, force),
    };
    let words = match period {
        Some(period) => format!(
            "It repeats every {} {}.",
            short(period),
            model.length_unit()
        ),
        None => "It ends where the log ended.".into(),
    };
    let name = &model.identifier;
    let mut fill = Fill::default();
    fill.set("header", header::table_comment(model, "# "))
        .set("name", name.clone())
        .set("x_unit", model.length_unit())
        .set("f_unit", model.force_unit())
        .set("repeats", words)
        .set("rows", map.lines(","));
    let mut files = vec![File::text(
        format!("{name}_cogging_map.csv"),
        fill.render(CSV),
    )];
    match driver(model, &waves) {
        Ok(Driver::Odrive) => files.push(odrive(model, &force)),
        Ok(Driver::Moteus) => {
            let (scale, counts) = moteus(&force);
            let lines = counts.iter().enumerate();
            let lines: Vec<String> = lines
                .map(|(i, count)| format!("motor.cogging_dq_comp.{i} {count}"))
                .collect();
            fill.set("scale", format!("{scale:?}"))
                .set("entries", lines.join("\n"));
            let text = fill.render(MOTEUS);
            files.push(File::text(format!("{name}_moteus.cfg"), text));
        }
        Err(_) => {}
    }
    Ok(files)
}

/// How a driver's map differs from the waves, or why there is none.
pub(crate) fn simplified(model: &Model) -> Option<Advice> {
    let waves = waves(model).ok()?;
    let force = |x: f64| [force(&waves, model, x)];
    let message = match driver(model, &waves) {
        Ok(driver) => {
            let (name, off) = match driver {
                Driver::Odrive => (
                    "ODrive",
                    worst(&force, ODRIVE, &|i, _| f64::from(entry(&force, i))),
                ),
                Driver::Moteus => {
                    let (scale, counts) = moteus(&force);
                    let at = |i: usize| f64::from(counts[i % counts.len()]) * f64::from(scale);
                    let line = |i: usize, part: f64| at(i) + part * (at(i + 1) - at(i));
                    ("moteus", worst(&force, MOTEUS_ENTRIES, &line))
                }
            };
            let most = amplitude(&waves);
            (off > COARSE * most).then(|| {
                format!(
                    "the map of {name} has too few entries for these waves: it is off by up to {} {} of {}",
                    short(off),
                    model.force_unit(),
                    short(most)
                )
            })?
        }
        Err(reason) => format!("no map for ODrive or moteus: {reason}"),
    };
    Some(Advice {
        code: Code::ExportSimplified,
        message,
    })
}

/// A motor driver that holds a map over a turn.
#[derive(Clone, Copy)]
enum Driver {
    Odrive,
    Moteus,
}

/// The driver that counts in the unit of the model's force; why there is none.
fn driver(model: &Model, waves: &[Wave<f64>]) -> Result<Driver, &'static str> {
    if !model.rotary {
        return Err("the axis is linear, and theirs is over a turn of the motor");
    }
    if period(model, waves).is_none() {
        return Err(
            "not every wave fits a whole number of times into a turn and was seen whole: identify at the motor, over at least a pitch",
        );
    }
    match model.force_unit() {
        _ if model.in_newtons() => Ok(Driver::Odrive),
        "A" => Ok(Driver::Moteus),
        _ => Err("ODrive takes N m, moteus A"),
    }
}

fn waves(model: &Model) -> Result<Vec<Wave<f64>>, Error> {
    let waves = model.terms.cogging.into_iter();
    let waves: Vec<_> = waves.filter(|w| w.rate > 0.0).collect();
    match waves.is_empty() {
        true => Err(Error::Missing {
            target: "cogging-map",
            reason: "the model has no cogging: in the axis file, under [terms], write cogging = [PITCH] and identify again",
        }),
        false => Ok(waves),
    }
}

/// The positions that the log has seen.
fn range(model: &Model) -> [f64; 2] {
    model.terms.channels.position.range
}

/// Force of the waves at a place; what the log did not see of a wave is held, as in code.
fn force(waves: &[Wave<f64>], model: &Model, x: f64) -> f64 {
    let [low, high] = range(model);
    let at = |w: &Wave<f64>| {
        let x = if w.whole { x } else { x.clamp(low, high) };
        w.sine * libm::sin(w.rate * x) + w.cosine * libm::cos(w.rate * x)
    };
    waves.iter().map(at).sum()
}

fn amplitude(waves: &[Wave<f64>]) -> f64 {
    waves.iter().map(|w| libm::hypot(w.sine, w.cosine)).sum()
}

/// After which way all of it repeats: a turn, or the longest wave.
fn period(model: &Model, waves: &[Wave<f64>]) -> Option<f64> {
    let longest = waves.iter().map(|w| TAU / w.rate).fold(0.0, f64::max);
    let period = if model.rotary { TAU } else { longest };
    let fits = |w: &Wave<f64>| {
        let count = period * w.rate / TAU;
        w.whole && count > 0.5 && (count - libm::round(count)).abs() <= MISFIT
    };
    waves.iter().all(fits).then_some(period)
}

/// Entry i of ODrive.
fn entry(force: &dyn Fn(f64) -> [f64; 1], i: usize) -> f32 {
    force(TAU * i as f64 / ODRIVE as f64)[0] as f32
}

fn odrive(model: &Model, force: &dyn Fn(f64) -> [f64; 1]) -> File {
    let entries: Vec<String> = (0..ODRIVE)
        .map(|i| format!("{:?}", entry(force, i)))
        .collect();
    let text = format!(
        "{{\n  \"axis\": \"{}\",\n  \"model_sha256\": \"{}\",\n  \"unit\": \"N m\",\n  \"entries_per_turn\": {ODRIVE},\n  \"cogging_map\": [\n    {}\n  ]\n}}\n",
        model.identifier,
        header::plain(&model.provenance.model_sha256),
        entries.join(",\n    ")
    );
    File::text(format!("{}_odrive.json", model.identifier), text)
}

/// Scale, A, and entries of moteus.
fn moteus(force: &dyn Fn(f64) -> [f64; 1]) -> (f32, Vec<i8>) {
    let map = Map::around(0.0, TAU, MOTEUS_ENTRIES, force);
    let most = map
        .values
        .iter()
        .fold(0.0, |most: f64, [f]| most.max(f.abs()));
    let scale = (most / f64::from(i8::MAX)) as f32;
    let counts = map.values.iter().map(|[f]| match scale > 0.0 {
        true => libm::round(f / f64::from(scale)).clamp(-127.0, 127.0) as i8,
        false => 0,
    });
    (scale, counts.collect())
}

/// Largest difference of a map over a turn from the waves: of entry and the part of the way to the next one.
fn worst(force: &dyn Fn(f64) -> [f64; 1], entries: usize, at: &dyn Fn(usize, f64) -> f64) -> f64 {
    let places =
        (0..entries).flat_map(|i| (0..BETWEEN).map(move |k| (i, k as f64 / BETWEEN as f64)));
    let off = places.map(|(i, part)| {
        let x = TAU * (i as f64 + part) / entries as f64;
        (at(i, part) - force(x)[0]).abs()
    });
    off.fold(0.0, f64::max)
}
