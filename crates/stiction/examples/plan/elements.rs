//! Axes with Maxwell-slip elements.

use super::{Found, likely, log, one, plan, say, text};
use stiction_files::Axis;
use stiction_parameters::LawKind;
use stiction_plan::{Aim, Candidate, Elements, Entry, Expected, HandMade, Subject, hand_made};
use stiction_workflows::plan::{Known, PlanOptions, Planned};

/// An axis: its name, its law, elements and what stands behind them.
type Slipping = (&'static str, LawKind, [[f64; 2]; 3], &'static [f64]);

/// A simulated axis: name, law, stiffness and yield deflection of each element, and what stands behind them in the order of the parameters:
/// sigma2, for `gms` Fc, vs and attraction, the mass.
const AXES: [Slipping; 2] = [
    (
        "slide, maxwell-slip",
        LawKind::MaxwellSlip,
        [[6e5, 1.5e-5], [1.5e5, 6e-5], [3e4, 3e-4]],
        &[60.0, 10.0],
    ),
    (
        "slide, gms",
        LawKind::Gms,
        [[6e5, 1.5e-5], [1.5e5, 6e-5], [3e4, 3e-4]],
        &[60.0, 20.0, 5e-3, 300.0, 10.0],
    ),
];

/// The slide with as many elements.
const FILE: &str = "rate = \"2 kHz\"\n[limits]\nstroke = [\"-100 mm\", \"100 mm\"]\nspeed = \"0.2 m/s\"\nacceleration = \"6 m/s2\"\n\
                    jerk = \"1500 m/s3\"\nrated_force = \"150 N\"\npeak_force = \"200 N\"\nmass = \"10 kg\"\nforce_noise = \"1 N\"\n\
                    [log]\nresolution = \"50 nm\"\n[controller]\nbandwidth = \"60 Hz\"\n[terms]\ngms_elements = 3\n";

/// A table of them: a probe by the nameplate, a plan for what that says of the elements, and so many logs of it.
pub fn elements(logs: u64) {
    println!(
        "| axis | motion | s | logs | median | largest | coverage | flagged | rms/predicted | s to 1 % |\n|---|---|---|---|---|---|---|---|---|---|"
    );
    for (name, kind, elements, rest) in AXES {
        let folder = std::env::temp_dir().join(format!("stiction-elements-{}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("a folder");
        let file = folder.join("axis.toml");
        std::fs::write(&file, FILE).expect("a file");
        let axis = Axis::read(&file).expect("an axis");
        let subject = Subject {
            elements: Some(Elements {
                count: elements.len(),
                falls: kind == LawKind::Gms,
                delayed: true,
            }),
            ..Subject::default()
        };
        let each = |i: usize| elements.iter().map(move |element| element[i]);
        let values: Vec<f64> = each(0).chain(each(1)).chain(rest.iter().copied()).collect();
        let truth = Candidate::of(&subject, &values).expect("values of the law");
        truth.validate().expect("an axis");
        let probe = plan(
            &file,
            PlanOptions {
                probe: true,
                ..PlanOptions::default()
            },
        );
        let first = log(&probe.motion, &truth, &probe, &axis, 500);
        let csv = folder.join("probe.csv");
        std::fs::write(&csv, text(&first)).expect("a file");
        let options = PlanOptions {
            law: Some(kind),
            known: Some(Known::Log(csv)),
            ..PlanOptions::default()
        };
        let mut planned = plan(&file, options);
        for (start, atom) in planned.motion.timed() {
            eprintln!("{start:.2} s: {atom:?}");
        }
        // Each log is identified alone, so the probe counts for nothing.
        let plate = planned.given.nameplate;
        planned.given.aim = Aim::new(plate.rig.force_noise);
        for kind in HandMade::ALL {
            let hand = hand_made(kind, &plate.limits, &plate.rig, 9.0).expect("limits");
            let Some(hand) = hand else { continue };
            let worst = 100.0 * likely(&hand, &truth, &planned);
            eprintln!(
                "{}: {worst:.2} % predicted of the worst parameter",
                kind.name()
            );
        }
        let motion = planned.motion.clone();
        let mut found = Found::default();
        for seed in 0..logs {
            one(&motion, &truth, &planned, &axis, (seed, None), &mut found);
        }
        each_parameter(&found, &truth, &planned);
        say(name, "probe, then plan", motion.duration(), &mut found);
        std::fs::remove_dir_all(&folder).expect("the folder that was made");
    }
}

/// To the other output: the error of each parameter beside what is predicted on the true axis, in percent.
fn each_parameter(found: &Found, truth: &Candidate, planned: &Planned) {
    let plate = &planned.given.nameplate;
    let entry =
        Entry::of(&planned.motion, truth, (&plate.limits, &plate.rig), 1 << 25).expect("an axis");
    let expected = Expected::of(&[entry], &planned.given.aim);
    let all = truth.subject.names().into_iter().zip(&found.squares);
    for ((name, squares), predicted) in all.zip(&expected.axes[0]) {
        let mean = squares.iter().sum::<f64>() / squares.len().max(1) as f64;
        eprintln!(
            "{name} {:.3} of {:.3} in {} logs",
            mean.sqrt(),
            100.0 * predicted,
            squares.len()
        );
    }
}
