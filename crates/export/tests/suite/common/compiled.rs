//! Code of a target, compiled and run beside the compensator.

use super::terms::{extras, surround, with_terms};
use super::{GUARDED, adapting, adversarial, busy, following, guarded, laws, model, random};
use std::io::{Read, Write};
use std::path::Path;
use std::process::{Command, Stdio};
use stiction_export::{File, Model};
use stiction_friction::Real;
use stiction_friction::compensator::{
    Adaptation, Channel, Channels, Compensator, Friction, Input, Levels, Settings, Source, Terms,
    Watchdog, Wave, Weight,
};

pub use stiction_testkit::programs::{have, run};

/// Time since the sample before, s, and what comes in.
pub type Sample = (f64, Input<f64>);

pub fn write(files: &[File], dir: &Path) {
    for file in files {
        let path = dir.join(&file.path);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, &file.bytes).unwrap();
    }
}

pub fn gcc(flags: &str, rest: &[&str], dir: &Path) {
    let mut arguments: Vec<&str> = flags.split_whitespace().collect();
    arguments.extend(rest);
    run("gcc", &arguments, dir);
}

/// What a compiled program gives that reads `h, velocity, error, enable, drive force, learn, acceleration, position, load,
/// temperature, transmitted` as doubles and writes force and what is [`kept`].
pub fn drive(dir: &Path, program: &str, samples: &[Sample]) -> Vec<[f64; 2]> {
    let bytes: Vec<u8> = samples
        .iter()
        .flat_map(|(h, input)| {
            [
                *h,
                input.reference_velocity,
                input.tracking_error,
                f64::from(u8::from(input.enable)),
                input.drive_force,
                f64::from(u8::from(input.learn)),
                input.reference_acceleration,
                input.position,
                input.load,
                input.temperature,
                input.transmitted,
            ]
        })
        .flat_map(f64::to_le_bytes)
        .collect();
    let mut child = Command::new(dir.join(program))
        .current_dir(dir)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    let mut stdin = child.stdin.take().unwrap();
    let writer = std::thread::spawn(move || stdin.write_all(&bytes).unwrap());
    let mut out = Vec::new();
    child.stdout.take().unwrap().read_to_end(&mut out).unwrap();
    writer.join().unwrap();
    assert!(child.wait().unwrap().success());
    let number = |bytes: &[u8]| f64::from_le_bytes(bytes.try_into().unwrap());
    out.chunks_exact(16)
        .map(|pair| [number(&pair[..8]), number(&pair[8..])])
        .collect()
}

/// What a driver reads beside the force, in its language: the deflection of a bristle, or the energy of elements; `element` is given the number of an element, from 0.
pub fn kept(
    friction: &Friction<f64>,
    deflection: &str,
    element: impl Fn(usize) -> String,
) -> String {
    match friction {
        Friction::Gms(law) => {
            let elements = law.elements().iter().enumerate();
            let energies = elements.map(|(k, e)| {
                let force = element(k);
                format!("{force} * {force} / (2.0 * {:?})", e.stiffness)
            });
            energies.collect::<Vec<_>>().join(" + ")
        }
        law if law.bristle().is_some() => deflection.into(),
        _ => "0.0".into(),
    }
}

/// The energy that a law stores, from what was kept.
pub fn stored(friction: &Friction<f64>, kept: f64) -> f64 {
    match friction.bristle() {
        Some(law) => 0.5 * law.stiffness() * kept * kept,
        None => kept,
    }
}

/// The most that it can store.
pub fn most_stored(friction: &Friction<f64>) -> f64 {
    match friction {
        Friction::Gms(law) => {
            let each = law.elements().iter();
            let each = each.map(|e| (e.share * law.bound()).powi(2) / (2.0 * e.stiffness));
            each.sum()
        }
        law => law
            .bristle()
            .map_or(0.0, |law| stored(friction, law.bound())),
    }
}

pub fn through_rust<T: Real>(
    friction: Friction<T>,
    settings: Settings<T>,
    terms: Terms<T>,
    samples: &[Sample],
) -> Vec<f64> {
    let compensator = Compensator::new(friction, Source::Reference, settings).unwrap();
    let mut compensator = compensator.with_terms(terms).unwrap();
    let to = T::from_f64;
    samples
        .iter()
        .map(|(h, input)| {
            let input = Input {
                reference_velocity: to(input.reference_velocity),
                measured_velocity: T::ZERO,
                tracking_error: to(input.tracking_error),
                enable: input.enable,
                drive_force: to(input.drive_force),
                learn: input.learn,
                reference_acceleration: to(input.reference_acceleration),
                position: to(input.position),
                load: to(input.load),
                temperature: to(input.temperature),
                transmitted: to(input.transmitted),
            };
            compensator.step_in(to(*h), input).to_f64()
        })
        .collect()
}

/// Models of a law with terms, and samples for them: hostile ones, and those that a watchdog and levels that follow learn from.
pub fn surrounded(friction: Friction<f64>, seed: usize) -> Vec<(Model, Vec<Sample>)> {
    let random = &mut random(200 + seed as u64);
    let hostile = adversarial(20_000, true, random);
    let kind = GUARDED.get(seed).filter(|(_, trip)| trip.is_none());
    let guarded = kind.map(|kind| guarded(friction, busy(), *kind, random));
    let followed = following(friction, busy(), random);
    let unguarded = Settings {
        watchdog: None,
        limit: 60.0,
        ..busy()
    };
    let runs = [
        (unguarded, hostile, 0),
        (adapting(unguarded), followed, 1 + seed),
    ];
    let guarded = guarded.map(|samples| (busy(), samples, 0));
    runs.into_iter()
        .chain(guarded)
        .map(|(settings, mut samples, kind)| {
            surround(&mut samples, true, random);
            let mut model = with_terms(friction, kind);
            model.settings = settings;
            (model, samples)
        })
        .collect()
}

/// A million samples of every kind over all laws, through code in double precision and through the compensator: within 4
/// units in the last place of the larger of force and static friction, or 1e-12 of the force, with factors that follow of the
/// larger of both; what is stored within its bound. `prepare` takes out of the samples what the target has no form for;
/// `through` gives force and [`kept`].
pub fn agree(
    target: &str,
    prepare: impl Fn(&mut [Sample]),
    through: impl Fn(&Model, &[Sample]) -> Vec<[f64; 2]>,
) {
    agree_over(target, laws(), usize::MAX, prepare, through);
}

/// The same over the laws that are given, with the first samples of each run.
pub fn agree_over(
    target: &str,
    laws: Vec<(&'static str, Friction<f64>)>,
    first: usize,
    prepare: impl Fn(&mut [Sample]),
    through: impl Fn(&Model, &[Sample]) -> Vec<[f64; 2]>,
) {
    let (mut identical, mut worst) = (0_usize, 0.0_f64);
    let each = 1_000_000 / laws.len() + 1;
    for (seed, (name, friction)) in laws.into_iter().enumerate() {
        let mut model = model(friction);
        model.settings = busy();
        if seed % 2 == 1 {
            model.settings.watchdog = None;
        }
        let settings = model.settings;
        let guarded = GUARDED
            .get(seed)
            .map(|kind| guarded(friction, busy(), *kind, &mut random(seed as u64)));
        let following = following(friction, busy(), &mut random(seed as u64));
        let runs = [(settings, adversarial(each, true, &mut random(seed as u64)))]
            .into_iter()
            .chain(guarded.map(|samples| (busy(), samples)))
            .chain([
                (
                    adapting(settings),
                    adversarial(each / 2, true, &mut random(100 + seed as u64)),
                ),
                (adapting(busy()), following),
            ]);
        let runs = runs.map(|(settings, samples)| {
            model.settings = settings;
            (model.clone(), samples)
        });
        for (run, (model, mut samples)) in runs.chain(surrounded(friction, seed)).enumerate() {
            samples.truncate(first);
            prepare(&mut samples);
            let friction = model.friction;
            let found = through(&model, &samples);
            let rust = through_rust(friction, model.settings, model.terms, &samples);
            assert_eq!(found.len(), rust.len());
            for (i, ([force, z], due)) in found.into_iter().zip(rust).enumerate() {
                let off = (force - due).abs();
                let size = due.abs().max(friction.scale());
                // What is found by least squares takes rounding of the exponentials up.
                let allowed = match model.settings.adaptation {
                    Some(_) => 1e-12 * size,
                    None => 4.0 * f64::EPSILON * size,
                };
                identical += usize::from(force == due);
                worst = worst.max(off / friction.scale());
                assert!(
                    off <= allowed.max(1e-12 * due.abs()),
                    "{name} {run} {i}: {force} {due} at {:?}",
                    samples[i]
                );
                let most = most_stored(&friction);
                assert!(
                    stored(&friction, z) <= most * (1.0 + 1e-12),
                    "{name} {i}: {z}"
                );
            }
        }
    }
    println!("{target}: {identical} identical, largest deviation {worst:.2e} of Fs");
}

/// The same in single precision, half of the laws with levels that follow: within 2e-6 of the static friction of the
/// compensator in that precision.
pub fn agree_single(target: &str, through: impl Fn(&Model, &[Sample]) -> Vec<[f64; 2]>) {
    let mut worst = 0.0_f64;
    let laws = laws();
    let each = 1_000_000 / laws.len() + 1;
    // Hostile samples of every law, and a motion of every one whose levels follow.
    let runs = laws
        .into_iter()
        .enumerate()
        .flat_map(|law| [(law, false), (law, true)]);
    for ((seed, (name, friction)), follows) in runs {
        let random = &mut random(100 + seed as u64);
        let mut model = model(friction);
        let mut samples = match follows {
            true => following(friction, busy(), random),
            false => adversarial(each, true, random),
        };
        if follows {
            surround(&mut samples, true, random);
            model = with_terms(friction, seed);
        }
        let friction = model.friction;
        model.settings = match follows {
            true => adapting(busy()),
            false => busy(),
        };
        let found = through(&model, &samples);
        let small = friction.cast::<f32>().unwrap();
        let s = model.settings;
        let settings = Settings {
            gain: s.gain as f32,
            dead_zone: s.dead_zone as f32,
            slew: s.slew as f32,
            ramp: s.ramp as f32,
            adaptation: s.adaptation.map(|a| Adaptation {
                memory: a.memory as f32,
                range: a.range as f32,
                mass: a.mass as f32,
            }),
            watchdog: Some(Watchdog {
                window: 0.5,
                ratio: 1.0,
            }),
            ..Settings::new(s.cycle_time as f32, s.limit as f32)
        };
        for (i, ([force, _], due)) in found
            .into_iter()
            .zip(through_rust(
                small,
                settings,
                single(&model.terms),
                &samples,
            ))
            .enumerate()
        {
            let off = (force - due).abs() / friction.scale();
            worst = worst.max(off);
            assert!(off <= 2e-6, "{name} {i}: {force} {due} at {:?}", samples[i]);
        }
    }
    println!("{target}, single: largest deviation {worst:.2e} of Fs");
}

/// Work done on the exported law is never less than the energy that its bristles gained: gain 1 and nothing that holds
/// the force back, so that the force is the law's. `rounding` is of all work that was done either way.
pub fn passive(rounding: f64, through: impl Fn(&Model, &[Sample]) -> Vec<[f64; 2]>) {
    for (name, friction) in laws() {
        if friction.presliding().is_none() {
            continue;
        }
        let mut model = model(friction);
        model.settings = Settings::bare(1e-3, 1e12);
        let mut samples = adversarial(100_000, false, &mut random(7));
        for (h, input) in &mut samples {
            (*h, input.enable) = (1e-3, true);
        }
        let (mut work, mut done): (f64, f64) = (0.0, 0.0);
        for ((h, input), [force, z]) in samples.iter().zip(through(&model, &samples)) {
            // What the offset does is given back on the way back; it is no part of the law's energy.
            let power = (force - friction.offset()) * input.reference_velocity;
            work += power * h;
            done += power.abs() * h;
            let stored = stored(&friction, z);
            assert!(
                work - stored >= -rounding * done.max(stored),
                "{name}: {work} {stored}"
            );
        }
    }
}

/// Terms in single precision.
pub fn single(terms: &Terms<f64>) -> Terms<f32> {
    let to = |x: f64| x as f32;
    let both = |x: [f64; 2]| x.map(to);
    let channel = |c: Channel<f64>| Channel {
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
            load: channel(terms.channels.load),
            temperature: channel(terms.channels.temperature),
            position: channel(terms.channels.position),
            transmitted: channel(terms.channels.transmitted),
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

/// What follows `enable` in the input of a model: the `drive` of levels that follow, and each of its [`extras`], written by its
/// place.
pub fn more_inputs(model: &Model, drive: &str, extra: impl Fn(usize) -> String) -> String {
    let drive = model.settings.adaptation.map(|_| drive.to_string());
    let extras = extras(model).into_iter().map(|(_, at)| extra(at));
    let each = drive.into_iter().chain(extras);
    each.map(|text| format!(", {text}")).collect()
}
