//! The Structured Text: parsed by two parsers, its test program run, and executed beside the compensator.

use crate::common;
use crate::common::compiled::{Sample, most_stored, single, stored, surrounded};
use crate::common::reserved::is_reserved;
use crate::common::terms::{extras, surround, with_terms};
use crate::common::{
    GUARDED, adapting, adversarial, all_laws, busy, following, guarded, laws, model, models, random,
};
use std::collections::HashSet;
use std::path::PathBuf;
use std::process::Command;
use stiction_export::{File, Model, Target, export};
use stiction_friction::compensator::{
    Adaptation, Compensator, Friction, Input, Settings, Source, Terms,
};
use stiction_friction::{CoulombViscous, Damping, Direction, LuGre, Shape, Stribeck};
use stiction_testkit::st::{Instance, Library};

fn text(files: &[File], name: &str) -> String {
    let file = files
        .iter()
        .find(|f| f.path == name)
        .unwrap_or_else(|| panic!("no {name}"));
    String::from_utf8(file.bytes.clone()).unwrap()
}

fn library(model: &Model) -> Library {
    let mut library = Library::default();
    for file in export(model, Target::St).unwrap() {
        let text = String::from_utf8(file.bytes).unwrap();
        library
            .add(&text)
            .unwrap_or_else(|e| panic!("{}: {e}", file.path));
    }
    library
}

#[test]
fn the_test_program_passes() {
    for (name, model) in models() {
        let library = library(&model);
        for program in ["PRG_x_axis_FrictionTest", "PRG_x_axis_FrictionTest_R"] {
            let mut program = library.instance(program);
            let (done, passed, worst) = (
                program.slot("done"),
                program.slot("passed"),
                program.slot("worst"),
            );
            for _ in 0..184 {
                program.call();
            }
            assert_eq!(program.get(done), 1.0, "{name}");
            assert_eq!(program.get(passed), 1.0, "{name}: {}", program.get(worst));
        }
    }
}

/// Every combination of the largest and smallest parameters that are exported: the block takes them, its test passes,
/// and at no speed and cycle time that it takes does an operation overflow (the interpreter stops there).
#[test]
fn what_is_exported_is_valid() {
    let corners = |k: u32, near: f64| {
        let end = |bit: u32, most: f64| [near * 1e-9, most / near][(k >> bit & 1) as usize];
        let side = Direction {
            coulomb: end(0, 1e9),
            static_friction: end(0, 1e9).max(end(1, 1e9)),
            stribeck_velocity: end(2, 1e9),
            viscous: end(3, 1e9),
        };
        let curve = Stribeck::symmetric(Shape::Gaussian, side, 0.0).unwrap();
        let law = LuGre::new(end(4, 1e15), Damping::Capped(end(5, 1e15)), curve).unwrap();
        model(Friction::LuGre(law))
    };
    for k in 0..128 {
        let mut model = corners(k, 1.0);
        model.settings.limit = 1e15;
        if k >= 64 {
            model.settings = adapting(model.settings);
            let mass = [1e-9, 1e9, 0.0][k as usize % 3];
            model.settings.adaptation = Some(Adaptation {
                mass,
                ..Adaptation::default()
            });
        }
        let library = library(&model);
        for (suffix, huge) in [("", 1e15), ("_R", 1e12)] {
            let mut program = library.instance(&format!("PRG_x_axis_FrictionTest{suffix}"));
            (0..184).for_each(|_| program.call());
            let of = |name: &str| program.get(program.slot(name));
            assert_eq!(of("passed"), 1.0, "{k}{suffix}: {}", of("worst"));
            let mut block = library.instance(&format!("FB_x_axis_Friction{suffix}"));
            let [velocity, time, window, enable] = [
                "reference_velocity",
                "cycle_time",
                "watchdog_window",
                "enable",
            ]
            .map(|name| block.slot(name));
            block.set(window, 0.0);
            block.set(enable, 1.0);
            for h in [1e-3, 1.001e-7, 10.0] {
                block.set(time, h);
                for (i, v) in [huge, 1.0, -1e-24, -huge, 1e-9, -1e3, 0.0, 1e-24, huge]
                    .into_iter()
                    .flat_map(|v| [v; 4])
                    .enumerate()
                {
                    block.set(velocity, 0.999 * v);
                    if k >= 64 {
                        let force = [huge, -1.0, 1e8, -1e-20, -huge][i % 5];
                        let [drive, learn] = ["drive_force", "learn"].map(|name| block.slot(name));
                        block.set(drive, force);
                        block.set(learn, 1.0);
                    }
                    block.call();
                    assert_eq!(block.get(block.slot("valid")), 1.0, "{k}{suffix} {v} {h}");
                }
            }
        }
    }
    let beyond = |model: &Model| export(model, Target::St).unwrap_err().to_string();
    assert_eq!(
        beyond(&corners(0, 0.999)),
        "sigma0 = 9.99e-10; allowed: from 1e-9 to 1e15 (as REAL)"
    );
    let mut viscous = laws().pop().map(|(_, law)| model(law)).unwrap();
    let law = CoulombViscous::new([20.0, 14.0], [2e9, 85.0], -3.0).unwrap();
    viscous.friction = Friction::Coulomb(law);
    assert_eq!(
        beyond(&viscous),
        "sigma2_pos = 2e9; allowed: from 0 to 1e9 (as REAL)"
    );
    let mut limit = model(laws().remove(0).1);
    limit.settings.limit = 1.1e15;
    assert_eq!(
        beyond(&limit),
        "limit = 1.1e15; allowed: from 1e-15 to 1e15 (as REAL)"
    );
}

/// A velocity that no machine has counts as none, so that no operation of a controller overflows.
fn seen(h: f64, input: &Input<f64>, huge: f64) -> (f64, Input<f64>) {
    let none = |x: f64| if x.abs() <= huge { x } else { f64::NAN };
    let h = if (1e-7..=10.0).contains(&h) {
        h
    } else {
        f64::NAN
    };
    let input = Input {
        reference_velocity: none(input.reference_velocity),
        tracking_error: none(input.tracking_error),
        drive_force: none(input.drive_force),
        reference_acceleration: none(input.reference_acceleration),
        position: none(input.position),
        load: none(input.load),
        temperature: none(input.temperature),
        transmitted: none(input.transmitted),
        ..*input
    };
    (h, input)
}

/// A million samples of every kind over all laws, in LREAL: within 1e-12 of the larger of force and static friction.
/// Deflection within its bound.
pub fn lreal(what: &str, through: impl Fn(&Model, &[Sample]) -> Vec<[f64; 2]>) {
    lreal_over(what, laws(), through);
}

/// The same over the laws that are given.
fn lreal_over(
    what: &str,
    laws: Vec<(&'static str, Friction<f64>)>,
    through: impl Fn(&Model, &[Sample]) -> Vec<[f64; 2]>,
) {
    let mut worst = 0.0_f64;
    let each = 1_000_000 / laws.len() + 1;
    for (seed, (name, friction)) in laws.into_iter().enumerate() {
        let mut model = model(friction);
        model.settings = busy();
        if seed % 2 == 1 {
            model.settings.watchdog = None;
        }
        let mut runs = vec![(
            model.settings,
            adversarial(each, true, &mut random(seed as u64)),
        )];
        if let Some(kind) = GUARDED.get(seed) {
            let samples = guarded(friction, busy(), *kind, &mut random(seed as u64));
            runs.push((busy(), samples));
        }
        let samples = following(friction, busy(), &mut random(seed as u64));
        runs.push((adapting(busy()), samples));
        let samples = adversarial(each / 2, true, &mut random(100 + seed as u64));
        runs.push((adapting(model.settings), samples));
        let runs = runs.into_iter().map(|(settings, samples)| {
            model.settings = settings;
            (model.clone(), samples)
        });
        let runs: Vec<_> = runs.collect();
        for (model, samples) in runs.into_iter().chain(surrounded(friction, seed)) {
            let friction = model.friction;
            let compensator = Compensator::new(friction, Source::Reference, model.settings);
            let mut compensator = compensator.unwrap().with_terms(model.terms).unwrap();
            let found = through(&model, &samples);
            assert_eq!(found.len(), samples.len());
            for (i, ((h, input), [force, z])) in samples.iter().zip(found).enumerate() {
                let (h, input) = seen(*h, input, 1e15);
                let due = compensator.step_in(h, input);
                let off = (force - due).abs() / due.abs().max(friction.scale());
                worst = worst.max(off);
                assert!(off <= 1e-12, "{name} {i}: {force} {due} at {h} {input:?}");
                let most = most_stored(&friction);
                assert!(stored(&friction, z) <= most * (1.0 + 1e-12), "{name} {i}");
            }
        }
    }
    println!("{what}, LREAL: largest deviation {worst:.2e} of Fs");
}

#[test]
fn lreal_agrees() {
    lreal("interpreter", |model, samples| {
        interpreted(model, "FB_x_axis_Friction", samples)
    });
}

#[test]
#[ignore = "soak: every law with every Stribeck curve and number of elements"]
fn every_law_and_curve_agrees() {
    lreal_over("interpreter", all_laws(), |model, samples| {
        interpreted(model, "FB_x_axis_Friction", samples)
    });
}

/// Force and what is kept of a block in the interpreter.
fn interpreted(model: &Model, name: &str, samples: &[Sample]) -> Vec<[f64; 2]> {
    let mut block = library(model).instance(name);
    let inputs = [
        "cycle_time",
        "reference_velocity",
        "tracking_error",
        "enable",
    ];
    let inputs = inputs.map(|n| block.slot(n));
    let adapts = model.settings.adaptation.is_some();
    let drive = adapts.then(|| ["drive_force", "learn"].map(|n| block.slot(n)));
    let more = extras(model).into_iter();
    let more: Vec<_> = more.map(|(name, at)| (block.slot(name), at)).collect();
    let force = block.slot("force");
    let kept = Kept::of(&model.friction, &block);
    let step = |(h, input): &Sample| {
        let enable = f64::from(u8::from(input.enable));
        let values = [*h, input.reference_velocity, input.tracking_error, enable];
        for (slot, x) in inputs.into_iter().zip(values) {
            block.set(slot, x);
        }
        if let Some([force, learn]) = drive {
            block.set(force, input.drive_force);
            block.set(learn, f64::from(u8::from(input.learn)));
        }
        for &(slot, at) in &more {
            let came = [
                input.reference_acceleration,
                input.position,
                input.load,
                input.temperature,
                input.transmitted,
            ];
            block.set(slot, came[at - 6]);
        }
        block.call();
        [block.get(force), kept.value(&block)]
    };
    samples.iter().map(step).collect()
}

#[test]
fn the_text_is_passive() {
    common::compiled::passive(1e-12, |model, samples| {
        let library = library(model);
        let mut block = library.instance("FB_x_axis_Friction");
        let names = ["reference_velocity", "enable", "force"];
        let [velocity, enable, force] = names.map(|n| block.slot(n));
        let kept = Kept::of(&model.friction, &block);
        block.set(enable, 1.0);
        let step = |(_, input): &Sample| {
            block.set(velocity, input.reference_velocity);
            block.call();
            [block.get(force), kept.value(&block)]
        };
        samples.iter().map(step).collect()
    });
}

/// REAL against the compensator in single precision, on motions as they are.
pub fn real(what: &str, through: impl Fn(&Model, &[Sample]) -> Vec<[f64; 2]>) {
    let mut worst = 0.0_f64;
    for (seed, (name, friction)) in laws().into_iter().enumerate() {
        let mut model = model(friction);
        model.settings = busy();
        model.settings.watchdog = None;
        let small = Settings {
            gain: 0.9_f32,
            dead_zone: 1e-5,
            slew: 8000.0,
            ramp: 0.02,
            watchdog: None,
            ..Settings::new(1e-3, 33.0)
        };
        let law = friction.cast::<f32>().unwrap();
        let follows = Settings {
            adaptation: Some(Adaptation {
                mass: 4.6,
                ..Adaptation::default()
            }),
            ..small
        };
        let random = &mut random(50 + seed as u64);
        let plain = adversarial(150_000, true, random);
        let followed = following(friction, model.settings, random);
        for (small, mut samples) in [(small, plain), (follows, followed)] {
            let (mut law, mut terms) = (law, Terms::default());
            if small.adaptation.is_some() {
                let settings = adapting(model.settings);
                model = with_terms(friction, seed);
                // Far from 0 a short wave is not the same in two ways of rounding.
                surround(&mut samples, model.terms.channels.position.turns, random);
                model.settings = settings;
                law = model.friction.cast::<f32>().unwrap();
                terms = single(&model.terms);
            }
            let friction = model.friction;
            for (h, input) in &mut samples {
                // As the controller's REAL inputs hold it.
                for x in [
                    h,
                    &mut input.reference_velocity,
                    &mut input.tracking_error,
                    &mut input.drive_force,
                    &mut input.reference_acceleration,
                    &mut input.position,
                    &mut input.load,
                    &mut input.temperature,
                    &mut input.transmitted,
                ] {
                    *x = f64::from(*x as f32);
                }
            }
            let compensator = Compensator::new(law, Source::Reference, small).unwrap();
            let mut compensator = compensator.with_terms(terms).unwrap();
            let found = through(&model, &samples);
            assert_eq!(found.len(), samples.len());
            for (i, ((h, input), [force, _])) in samples.iter().zip(found).enumerate() {
                let (h, input) = seen(*h, input, 1e12);
                let input = Input {
                    reference_velocity: input.reference_velocity as f32,
                    measured_velocity: 0.0,
                    tracking_error: input.tracking_error as f32,
                    enable: input.enable,
                    drive_force: input.drive_force as f32,
                    learn: input.learn,
                    reference_acceleration: input.reference_acceleration as f32,
                    position: input.position as f32,
                    load: input.load as f32,
                    temperature: input.temperature as f32,
                    transmitted: input.transmitted as f32,
                };
                let due = f64::from(compensator.step_in(h as f32, input));
                let off = (force - due).abs() / friction.scale();
                worst = worst.max(off);
                assert!(off <= 2e-6, "{name} {i}: {force} {due} at {h} {input:?}");
            }
        }
    }
    println!("{what}, REAL: largest deviation {worst:.2e} of Fs");
}

#[test]
fn real_agrees() {
    real("interpreter", |model, samples| {
        interpreted(model, "FB_x_axis_Friction_R", samples)
    });
}

/// The deflection of a bristle, or the energy of elements, in the interpreter.
struct Kept {
    deflection: Option<usize>,
    /// With their stiffness.
    elements: Vec<(usize, f64)>,
}

impl Kept {
    fn of(friction: &Friction<f64>, block: &Instance) -> Self {
        let elements = match friction {
            Friction::Gms(law) => law.elements(),
            _ => &[],
        };
        let elements = elements.iter().enumerate();
        let elements =
            elements.map(|(k, e)| (block.slot(&format!("element_{}", k + 1)), e.stiffness));
        Kept {
            deflection: friction.bristle().map(|_| block.slot("deflection")),
            elements: elements.collect(),
        }
    }

    fn value(&self, block: &Instance) -> f64 {
        let energy =
            |&(slot, stiffness): &(usize, f64)| block.get(slot).powi(2) / (2.0 * stiffness);
        self.deflection
            .map_or_else(|| self.elements.iter().map(energy).sum(), |z| block.get(z))
    }
}

/// What the controller retains comes back at the first call, unless it is damaged, of another model, or reset comes first.
#[test]
fn what_is_retained_comes_back() {
    let mut model = model(laws().remove(0).1);
    model.settings = adapting(model.settings);
    let library = library(&model);
    let kept = ["key", "dry", "viscous", "square", "peak", "reason"];
    let kept = kept.map(|name| [format!("kept_{name}"), format!("copy_{name}")]);
    let kept: Vec<&String> = kept.iter().flatten().collect();
    let mut evening = library.instance("FB_x_axis_Friction");
    let slots = [
        "reference_velocity",
        "tracking_error",
        "drive_force",
        "learn",
    ];
    let [velocity, error, force, learn] = slots.map(|name| evening.slot(name));
    evening.set(evening.slot("watchdog_window"), 0.1);
    evening.set(error, 1e-6);
    for k in 0..4000 {
        let sign = if k / 100 % 2 == 0 { 1.0 } else { -1.0 };
        evening.set(velocity, sign * 0.05);
        evening.set(force, sign * (1.2 * 12.0 + 1.5));
        evening.set(learn, f64::from(u8::from(k % 100 > 5)));
        evening.call();
    }
    assert_eq!(evening.get(evening.slot("learned")), 1.0);
    let morning = |change: &dyn Fn(&str, f64) -> f64, reset: bool| {
        let mut morning = library.instance("FB_x_axis_Friction");
        for name in &kept {
            let value = evening.get(evening.slot(name));
            morning.set(morning.slot(name), change(name, value));
        }
        morning.set(morning.slot("reset"), f64::from(u8::from(reset)));
        morning.call();
        ["recalled", "learned", "level_dry", "level_viscous"]
            .map(|name| morning.get(morning.slot(name)))
    };
    let [recalled, learned, dry, _] = morning(&|_, value| value, false);
    assert_eq!([recalled, learned], [1.0, 1.0]);
    assert!((dry - 1.2).abs() < 0.02, "{dry}");
    let nothing = [0.0, 0.0, 1.0, 1.0];
    assert_eq!(morning(&|_, value| value, true), nothing);
    for damaged in &kept {
        let change = |name: &str, value: f64| if name == *damaged { value + 1.0 } else { value };
        assert_eq!(morning(&change, false), nothing, "{damaged}");
    }
    let other = |name: &str, value: f64| match name {
        "kept_key" => value + 1.0,
        "copy_key" => value - 1.0,
        _ => value,
    };
    assert_eq!(morning(&other, false), nothing);
}

/// Settings out of range, also those that are no number: not valid, no force.
#[test]
fn bad_settings_give_no_force() {
    let library = library(&model(laws().remove(0).1));
    for (setting, values) in [
        ("gain", [1.1, -0.1, f64::NAN]),
        ("largest_force", [0.0, -1.0, f64::NAN]),
        ("ramp_time", [-1.0, 1e300, f64::NAN]),
        ("sigma0", [0.0, f64::INFINITY, f64::NAN]),
        ("static_pos", [1.0, f64::INFINITY, f64::NAN]),
    ] {
        for value in values {
            let mut block = library.instance("FB_x_axis_Friction");
            let [velocity, enable, changed] =
                ["reference_velocity", "enable", setting].map(|n| block.slot(n));
            block.set(velocity, 0.1);
            block.set(enable, 1.0);
            block.set(changed, value);
            block.call();
            assert_eq!(block.get(block.slot("valid")), 0.0, "{setting} {value}");
            assert_eq!(block.get(block.slot("force")), 0.0);
        }
    }
}

/// No name that a file declares is a word of the language, of a library or of a tool, whatever the law.
#[test]
fn no_name_is_reserved() {
    for word in ["ramp", "On", "max_int", "mux_int_real", "sub_dt_dt", "P0"] {
        assert!(is_reserved(word), "{word}");
    }
    assert!(!is_reserved("limit_high") && !is_reserved("my_int"));
    for (_, model) in models() {
        for target in [Target::St, Target::TcPou, Target::PlcOpen] {
            for file in export(&model, target).unwrap() {
                let text = String::from_utf8(file.bytes).unwrap();
                let names = declared(&text, target);
                assert!(names.len() > 5, "{}", file.path);
                for name in names {
                    assert!(!is_reserved(&name), "{}: {name}", file.path);
                }
            }
        }
    }
}

/// The names of units and variables that a text declares.
fn declared(text: &str, target: Target) -> Vec<String> {
    if target == Target::PlcOpen {
        let document = roxmltree::Document::parse(text).unwrap();
        let named =
            |n: &roxmltree::Node<'_, '_>| ["pou", "variable"].contains(&n.tag_name().name());
        let names = document.descendants().filter(named);
        return names
            .map(|n| n.attribute("name").unwrap().to_string())
            .collect();
    }
    let mut names = Vec::new();
    let mut inside = false;
    for line in text.lines() {
        // TwinCAT's XML stands before the first line of a declaration.
        let line = line.rsplit("CDATA[").next().unwrap_or(line);
        if let Some(name) = ["FUNCTION_BLOCK ", "PROGRAM "]
            .iter()
            .find_map(|head| line.strip_prefix(head))
        {
            names.push(name.to_string());
        }
        inside = match line {
            "VAR" | "VAR_INPUT" | "VAR_OUTPUT" => true,
            "END_VAR" => false,
            _ => inside,
        };
        if let (true, Some((name, _))) = (inside, line.split_once(" : ")) {
            names.push(name.trim().to_string());
        }
    }
    names
}

/// Nothing stands before the first word of a unit: some parsers take no comment there.
#[test]
fn a_unit_begins_with_its_name() {
    for file in export(&model(laws().remove(0).1), Target::St).unwrap() {
        let text = String::from_utf8(file.bytes).unwrap();
        assert!(
            text.starts_with("FUNCTION_BLOCK FB_") || text.starts_with("PROGRAM PRG_"),
            "{}",
            file.path
        );
    }
}

/// A second parser, made for TwinCAT's files, takes the text and the objects.
#[test]
#[ignore = "soak: a slow parser; iecst and matiec read the same text in every run"]
fn blark_reads_it() {
    let local = stiction_testkit::workspace().join(".venv/bin/python");
    let python = std::env::var_os("STICTION_PYTHON").map_or(local, PathBuf::from);
    let dir = tempfile::tempdir().unwrap();
    let mut names = Vec::new();
    for (name, model) in models() {
        // The objects hold the text of the other target: each law is parsed in one of them.
        let target = match name {
            "power" => Target::St,
            "coulomb" if model.settings.adaptation.is_some() => Target::TcPou,
            _ => continue,
        };
        for file in export(&model, target).unwrap() {
            let name = format!("{name}_{}", file.path);
            let text = one_sample_of_each_form(std::str::from_utf8(&file.bytes).unwrap());
            std::fs::write(dir.path().join(&name), text).unwrap();
            names.push(name);
        }
    }
    let output = Command::new(&python)
        .args(["-c", BLARK])
        .args(&names)
        .current_dir(dir.path())
        .output()
        .unwrap_or_else(|e| panic!("{}: {e}; install with: cargo xtask setup", python.display()));
    let said = String::from_utf8_lossy(&output.stdout);
    let parsed = format!("{} parsed", names.len());
    assert!(
        output.status.success() && said.contains(&parsed),
        "{said}{}",
        String::from_utf8_lossy(&output.stderr)
    );
}

/// The text with one of the samples of its self-test for each way that their numbers are written, in exponents and signs.
/// To the grammar those are alike, and the parser takes a tenth of a second for each of hundreds.
fn one_sample_of_each_form(text: &str) -> String {
    let mut seen = HashSet::new();
    let mut is_new = |line: &str| {
        let Some((number, sample)) = line.trim_start().split_once(": v := ") else {
            return true;
        };
        assert!(number.parse::<u32>().is_ok(), "no sample: {line}");
        let mut form = sample.replace(|c: char| c.is_ascii_digit(), "0");
        while form.contains("00") {
            form = form.replace("00", "0");
        }
        seen.insert(form)
    };
    let lines: Vec<&str> = text.lines().filter(|line| is_new(line)).collect();
    lines.join("\n")
}

/// Parses every file named; a file in which nothing is found counts as a failure.
const BLARK: &str = r#"
import sys
from blark.parse import parse
count = 0
for name in sys.argv[1:]:
    results = list(parse(name))
    for result in results:
        if result.exception is not None:
            raise SystemExit(f"{name}: {result.exception}")
    count += bool(results)
print(count, "parsed")
"#;

/// The objects and the XML carry the text itself.
#[test]
fn wrapped_text_is_the_text() {
    let model = model(Friction::LuGre(
        common::lugre(Shape::Gaussian)
            .with_damping(Damping::Capped(0.0))
            .unwrap(),
    ));
    let plain = export(&model, Target::St).unwrap();
    let squeeze = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
    for file in export(&model, Target::TcPou).unwrap() {
        let xml = String::from_utf8(file.bytes).unwrap();
        let document = roxmltree::Document::parse(&xml).unwrap();
        let name = file.path.trim_end_matches(".TcPOU");
        let whole: String = ["Declaration", "ST"]
            .iter()
            .map(|tag| {
                document
                    .descendants()
                    .find(|n| n.has_tag_name(*tag))
                    .and_then(|n| n.text())
                    .unwrap()
            })
            .collect();
        let pou = document
            .descendants()
            .find(|n| n.has_tag_name("POU"))
            .unwrap();
        assert_eq!(pou.attribute("Name"), Some(name));
        assert_eq!(pou.attribute("Id").unwrap().len(), 38);
        // Retained data need further hardware in TwinCAT, persistent data do not.
        let retained = squeeze(&whole).replace("VAR PERSISTENT", "VAR RETAIN");
        assert!(squeeze(&text(&plain, &format!("{name}.st"))).starts_with(&retained));
    }
    let xml = text(
        &export(&model, Target::PlcOpen).unwrap(),
        "x_axis_friction.xml",
    );
    let document = roxmltree::Document::parse(&xml).unwrap();
    let pous: Vec<_> = document
        .descendants()
        .filter(|n| n.has_tag_name("pou") || n.tag_name().name() == "pou")
        .collect();
    assert_eq!(pous.len(), plain.len());
    for pou in pous {
        let name = pou.attribute("name").unwrap();
        let source = text(&plain, &format!("{name}.st"));
        let st = pou
            .descendants()
            .find(|n| n.tag_name().name() == "ST")
            .unwrap();
        let body: String = st
            .descendants()
            .filter(|n| n.is_text())
            .filter_map(|n| n.text())
            .collect();
        let body = body.trim().split_once("*)").unwrap().1;
        assert!(squeeze(&source).contains(&squeeze(body)), "{name}");
        // Every variable is declared, with the initial value of the text.
        let variables: Vec<_> = pou
            .descendants()
            .filter(|n| n.tag_name().name() == "variable")
            .collect();
        assert_eq!(
            variables.len(),
            source
                .lines()
                .filter(|l| l.starts_with("    ") && l.contains(" : "))
                .count()
        );
        for variable in variables {
            let name = variable.attribute("name").unwrap();
            let value = variable
                .descendants()
                .find(|n| n.tag_name().name() == "simpleValue");
            let value = value.map(|n| n.attribute("value").unwrap());
            let line = source
                .lines()
                .find(|l| l.trim().starts_with(&format!("{name} : ")))
                .unwrap();
            assert_eq!(value.is_some(), line.contains(":="), "{line}");
            assert!(
                value.is_none_or(|v| line.contains(&format!(":= {v};"))),
                "{line}"
            );
        }
    }
}

#[test]
fn the_example_runs() {
    let mut library = library(&model(laws().remove(0).1));
    let example = stiction_testkit::workspace().join("examples/export/st/PRG_Axis.st");
    library
        .add(&std::fs::read_to_string(example).unwrap())
        .unwrap();
    let mut program = library.instance("PRG_Axis");
    let torque = program.slot("additive_torque");
    let stopping = program.slot("stopping");
    // It learns from the first turn over five windows of two strokes.
    (0..11_000).for_each(|_| program.call());
    assert_eq!(program.get(torque), 0.0);
    (0..1000).for_each(|_| program.call());
    for sign in [1.0, -1.0] {
        (0..1000).for_each(|_| program.call());
        // A half of Fc + (Fs - Fc) exp(-(v/vs)^2) + sigma2 v, in per mille of 200 N.
        let force = 12.0 + 6.0 * (-(10.0_f64 / 3.0).powi(2)).exp() + 0.3;
        let due = sign * 0.5 * force / 200.0 * 1000.0;
        assert!((program.get(torque) - due).abs() < 1e-9);
    }
    program.set(stopping, 1.0);
    program.call();
    assert_eq!(program.get(torque), 0.0);
}
