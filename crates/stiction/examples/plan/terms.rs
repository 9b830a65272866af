//! Axes with terms beside LuGre.

use super::{Found, one, plan, say};
use stiction_files::Axis;
use stiction_plan::{Back, Candidate, HandMade, Shape, hand_made};
use stiction_workflows::plan::PlanOptions;

/// A simulated axis.
struct Made {
    name: &'static str,
    file: &'static str,
    /// sigma0, sigma1, sigma2, Fc, Fs, vs, M.
    values: [f64; 7],
    back: Option<Back>,
    /// Sizes of the terms in the order of the axis file's parameters.
    sizes: &'static [f64],
}

const SLIDE: [f64; 7] = [1.2e5, 600.0, 60.0, 20.0, 30.0, 5e-3, 10.0];

/// The slide's axis file with a table of terms.
macro_rules! slide {
    ($terms:literal) => {
        concat!(
            "rate = \"4 kHz\"\n[limits]\nstroke = [\"-100 mm\", \"100 mm\"]\nspeed = \"0.2 m/s\"\nacceleration = \"6 m/s2\"\n\
             jerk = \"1500 m/s3\"\nrated_force = \"150 N\"\npeak_force = \"200 N\"\nmass = \"10 kg\"\nforce_noise = \"1 N\"\n\
             [log]\nresolution = \"50 nm\"\n[controller]\nbandwidth = \"60 Hz\"\n[terms]\n",
            $terms
        )
    };
}

const AXES: [Made; 6] = [
    Made {
        name: "joint under gravity",
        file: "kind = \"rotary\"\nrate = \"2 kHz\"\n[limits]\nstroke = [\"-150 deg\", \"150 deg\"]\nspeed = \"3 rad/s\"\n\
               acceleration = \"30 rad/s2\"\njerk = \"3000 rad/s3\"\nrated_force = \"30 N m\"\npeak_force = \"60 N m\"\n\
               mass = \"0.8 kg m2\"\nforce_noise = \"0.1 N m\"\n[log]\nresolution = \"5e-6 rad\"\n[controller]\nbandwidth = \"40 Hz\"\n\
               [terms]\ngravity = true\n",
        values: [5e3, 20.0, 0.8, 2.0, 3.0, 0.05, 0.8],
        back: None,
        sizes: &[7.0, 2.0],
    },
    Made {
        name: "cogging of 24 mm",
        file: slide!("cogging = [\"24 mm\"]\n"),
        values: SLIDE,
        back: None,
        sizes: &[3.0, -2.0],
    },
    Made {
        name: "quadratic viscous friction",
        file: slide!("quadratic_viscous = true\n"),
        values: SLIDE,
        back: None,
        sizes: &[150.0],
    },
    Made {
        name: "friction along the stroke",
        file: slide!("coulomb_position = true\n"),
        values: SLIDE,
        back: None,
        sizes: &[40.0],
    },
    Made {
        name: "friction with a wave of 16 mm",
        file: slide!("coulomb_pitch = [\"16 mm\"]\n"),
        values: SLIDE,
        back: None,
        sizes: &[1.5, 1.0],
    },
    Made {
        name: "another friction in each direction",
        file: slide!(""),
        values: SLIDE,
        back: Some(Back {
            sigma2: 45.0,
            coulomb: 25.0,
            static_friction: 34.0,
            stribeck_velocity: 8e-3,
        }),
        sizes: &[],
    },
];

/// A table of them: logs of each motion.
pub fn terms(logs: u64) {
    println!(
        "| axis | motion | s | logs | median | largest | coverage | flagged | rms/predicted | s to 1 % |\n|---|---|---|---|---|---|---|---|---|---|"
    );
    for made in AXES {
        let folder = std::env::temp_dir().join(format!("stiction-terms-{}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("a folder");
        let file = folder.join("axis.toml");
        std::fs::write(&file, made.file).expect("a file");
        let options = PlanOptions {
            asymmetric: made.back.is_some(),
            ..PlanOptions::default()
        };
        let planned = plan(&file, options);
        let subject = &planned.given.subject;
        let truth = Candidate {
            back: made.back,
            sizes: made.sizes.to_vec(),
            subject: subject.clone(),
            ..Candidate::from_values(made.values)
        };
        truth.validate().expect("an axis");
        assert_eq!(truth.values().len(), subject.names().len());
        let axis = Axis::read(&file).expect("an axis");
        let plate = &planned.given.nameplate;
        let mut motions = vec![("plan, nameplate", planned.motion.clone())];
        for kind in [HandMade::SixSpeeds, HandMade::Sine] {
            let hand = hand_made(kind, &plate.limits, &plate.rig, 9.0).expect("limits");
            motions.extend(hand.map(|motion| (kind.name(), motion)));
        }
        for (name, motion) in motions {
            let mut found = Found::default();
            for seed in 0..logs {
                one(&motion, &truth, &planned, &axis, (seed, None), &mut found);
            }
            say(made.name, name, motion.duration(), &mut found);
        }
        std::fs::remove_dir_all(&folder).expect("the folder that was made");
    }
}

/// The true values, of levels that change along the stroke at a position, m (rad), from where the axis stands.
pub fn values(truth: &Candidate, at: Option<f64>) -> Vec<f64> {
    let mut here = truth.clone();
    let both = truth.subject.terms.iter().zip(&truth.sizes);
    for (term, size) in both {
        let (Shape::Level(middle), Some(at)) = (term.shape, at) else {
            continue;
        };
        let more = size * (at - middle);
        let by = 1.0 + more / truth.coulomb;
        here.sigma0 *= by;
        here.static_friction *= by;
        here.coulomb *= by;
    }
    here.values()
}
