//! Code of a target, compiled and run beside the compensator.

use super::{GUARDED, adapting, adversarial, busy, following, guarded, laws, model, random};
use std::io::{Read, Write};
use std::path::Path;
use std::process::{Command, Stdio};
use stiction_export::{File, Model};
use stiction_friction::compensator::{
    Adaptation, Compensator, Friction, Input, Settings, Source, Watchdog,
};
use stiction_friction::{CoulombViscous, Real};

/// Time since the sample before, s, and what comes in.
pub type Sample = (f64, Input<f64>);

pub fn write(files: &[File], dir: &Path) {
    for file in files {
        let path = dir.join(&file.path);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, &file.bytes).unwrap();
    }
}

/// Runs a program of the set-up (`cargo xtask setup`) and gives what it printed.
pub fn run(program: &str, arguments: &[&str], dir: &Path) -> String {
    let output = Command::new(program)
        .args(arguments)
        .current_dir(dir)
        .output()
        .unwrap_or_else(|e| panic!("{program}: {e}; install with: cargo xtask setup"));
    let text = format!(
        "{}{}",
        String::from_utf8_lossy(&output.stdout),
        String::from_utf8_lossy(&output.stderr)
    );
    assert!(output.status.success(), "{program} {arguments:?}\n{text}");
    text
}

pub fn gcc(flags: &str, rest: &[&str], dir: &Path) {
    let mut arguments: Vec<&str> = flags.split_whitespace().collect();
    arguments.extend(rest);
    run("gcc", &arguments, dir);
}

/// What a compiled program gives that reads `h, velocity, error, enable, drive force, learn` as doubles and writes force and
/// deflection.
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

pub fn level(friction: &Friction<f64>) -> f64 {
    match friction {
        Friction::Coulomb(law) => law.coulomb()[0].max(law.coulomb()[1]),
        Friction::Stribeck(curve) => curve.largest_static_level(),
        Friction::LuGre(law) => law.curve().largest_static_level(),
    }
}

pub fn through_rust<T: Real>(
    friction: Friction<T>,
    settings: Settings<T>,
    samples: &[Sample],
) -> Vec<f64> {
    let mut compensator = Compensator::new(friction, Source::Reference, settings).unwrap();
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
                ..Input::default()
            };
            compensator.step_in(to(*h), input).to_f64()
        })
        .collect()
}

/// A million samples of every kind over all laws, through code in double precision and through the compensator: within 4
/// units in the last place of the larger of force and static friction, or 1e-12 of the force; deflection within its
/// bound. `prepare` takes out of the samples what the target has no form for; `through` is told whether the law has bristles.
pub fn agree(
    target: &str,
    prepare: impl Fn(&mut [Sample]),
    through: impl Fn(&Model, bool, &[Sample]) -> Vec<[f64; 2]>,
) {
    let (mut identical, mut worst) = (0_usize, 0.0_f64);
    let laws = laws();
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
        let bristles = matches!(friction, Friction::LuGre(_));
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
        for (run, (settings, mut samples)) in runs.enumerate() {
            model.settings = settings;
            prepare(&mut samples);
            let found = through(&model, bristles, &samples);
            let rust = through_rust(friction, model.settings, &samples);
            assert_eq!(found.len(), rust.len());
            for (i, ([force, z], due)) in found.into_iter().zip(rust).enumerate() {
                let off = (force - due).abs();
                let allowed = 4.0 * f64::EPSILON * due.abs().max(level(&friction));
                identical += usize::from(force == due);
                worst = worst.max(off / level(&friction));
                assert!(
                    off <= allowed.max(1e-12 * due.abs()),
                    "{name} {run} {i}: {force} {due} at {:?}",
                    samples[i]
                );
                if let Friction::LuGre(law) = friction {
                    assert!(z.abs() <= law.bound(), "{name} {i}: {z}");
                }
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
        let samples = match follows {
            true => following(friction, busy(), random),
            false => adversarial(each, true, random),
        };
        model.settings = match follows {
            true => adapting(busy()),
            false => busy(),
        };
        let found = through(&model, &samples);
        let to = |x: [f64; 2]| x.map(|x| x as f32);
        let small: Friction<f32> = match &friction {
            Friction::Coulomb(law) => Friction::Coulomb(
                CoulombViscous::new(to(law.coulomb()), to(law.viscous()), law.offset() as f32)
                    .unwrap(),
            ),
            Friction::Stribeck(curve) => Friction::Stribeck(curve.cast().unwrap()),
            Friction::LuGre(law) => Friction::LuGre(law.cast().unwrap()),
        };
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
            .zip(through_rust(small, settings, &samples))
            .enumerate()
        {
            let off = (force - due).abs() / level(&friction);
            worst = worst.max(off);
            assert!(off <= 2e-6, "{name} {i}: {force} {due} at {:?}", samples[i]);
        }
    }
    println!("{target}, single: largest deviation {worst:.2e} of Fs");
}

/// Work done on the exported law is never less than the energy that its bristles gained: gain 1 and nothing that holds
/// the force back, so that the force is the law's. `rounding` is of all work that was done either way.
pub fn passive(rounding: f64, through: impl Fn(&Model, bool, &[Sample]) -> Vec<[f64; 2]>) {
    for (name, friction) in laws() {
        let Friction::LuGre(law) = friction else {
            continue;
        };
        let mut model = model(friction);
        model.settings = Settings::bare(1e-3, 1e12);
        let mut samples = adversarial(100_000, false, &mut random(7));
        for (h, input) in &mut samples {
            (*h, input.enable) = (1e-3, true);
        }
        let (mut work, mut done) = (0.0, 0.0);
        for ((h, input), [force, z]) in samples.iter().zip(through(&model, true, &samples)) {
            // What the offset does is given back on the way back; it is no part of the law's energy.
            let power = (force - law.curve().offset()) * input.reference_velocity;
            work += power * h;
            done += power.abs() * h;
            let stored = 0.5 * law.stiffness() * z * z;
            assert!(
                work - stored >= -rounding * done.max(stored),
                "{name}: {work} {stored}"
            );
        }
    }
}
