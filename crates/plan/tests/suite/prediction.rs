//! What is predicted, held against fits of simulated logs.

use stiction_identify::{
    Conditioning, Law, LawKind, Samples, Settings, Silent, Terms, condition, identify,
};
use stiction_plan::{
    Aim, Alone, Atom, Candidate, Entry, Expected, HandMade, Limits, Loop, Motion, NAMES, Nameplate,
    Rig, Table, dictionary, hand_made, run, select,
};
use stiction_servo::noise::Noise;

/// The slide of the figures: known axis `machine`.
const LIMITS: Limits = Limits {
    stroke: [-0.1, 0.1],
    end_zone: 0.05,
    speed: 0.2,
    acceleration: 6.0,
    jerk: 1500.0,
    rated_force: 150.0,
    peak_force: 200.0,
};
const RIG: Rig = Rig {
    rate: 2000.0,
    encoder_step: 50e-9,
    force_noise: 1.0,
    loop_: Loop::Tuned(60.0),
};

fn machine() -> Candidate {
    Candidate::from_values([1.2e5, 600.0, 60.0, 20.0, 30.0, 5e-3, 10.0])
}

/// Root mean square errors of the parameters, relative, over logs with other noise; the fit has the default cut-offs.
fn realised(motion: &Motion, axis: &Candidate, logs: u64) -> [f64; 7] {
    let mut squares = [0.0; 7];
    for seed in 0..logs {
        let mut noise = Noise::new(100 + seed);
        let phase = noise.uniform();
        let run = run(motion, axis, &RIG, LIMITS.peak_force, phase).unwrap();
        let samples = Samples {
            time: (0..run.force.len()).map(|k| k as f64 / RIG.rate).collect(),
            position: Some(run.reading),
            force: run
                .force
                .iter()
                .map(|f| f + RIG.force_noise * noise.normal())
                .collect(),
            ..Samples::default()
        };
        let record = condition(&[samples], &Conditioning::default()).unwrap();
        let terms = Terms {
            offset: true,
            ..Terms::default()
        };
        let law = Law::new(LawKind::LuGre);
        let estimate =
            identify(&record, law, &terms, 0.0, &Settings::default(), &mut Silent).unwrap();
        for (i, (name, truth)) in NAMES.iter().zip(axis.values()).enumerate() {
            let error = libm::log(estimate.value(name).unwrap() / truth);
            squares[i] += error * error / logs as f64;
        }
    }
    squares.map(f64::sqrt)
}

/// The errors that fits of simulated logs make are those that are predicted, within what filters that are not tuned leave.
#[test]
fn predicted_deviations_are_those_of_fits() {
    let axis = machine();
    let motion = hand_made(HandMade::ThreeSines, &LIMITS, &RIG, 6.0)
        .unwrap()
        .unwrap();
    let entry = Entry::of(&motion, &axis, (&LIMITS, &RIG), 3).unwrap();
    let predicted = Expected::of(&[entry], &Aim::new(RIG.force_noise)).axes[0];
    let found = realised(&motion, &axis, 12);
    for ((name, found), predicted) in NAMES.iter().zip(found).zip(predicted) {
        let ratio = found / predicted;
        assert!(
            (0.4..2.5).contains(&ratio),
            "{name}: {found} of {predicted}"
        );
    }
}

fn plate() -> Nameplate {
    Nameplate {
        mass: 10.0,
        mass_factor: 2.0,
        limits: LIMITS,
        rig: RIG,
    }
}

fn table(atoms: Vec<Atom>, axes: &[Candidate]) -> Table {
    let mut number = 0;
    let entries = atoms.iter().map(|atom| {
        let each = axes.iter().map(|axis| {
            number += 1;
            Entry::of(atom, axis, (&LIMITS, &RIG), number).unwrap()
        });
        each.collect()
    });
    Table {
        entries: entries.collect(),
        atoms,
    }
}

/// On axes that it was not made for, the chosen motion is better than those that need no design; the sums over its pieces say
/// what the whole does.
#[test]
fn a_chosen_motion_is_better_than_hand_made_ones() {
    let atoms: Vec<Atom> = dictionary(&LIMITS, &RIG).into_iter().step_by(2).collect();
    let axes = plate().draw(10, 1);
    let table = table(atoms, &axes).safe(&LIMITS);
    let mut rounds = 0;
    let choice = select(&table, &Aim::new(RIG.force_noise), 6.0, &Alone, &mut |_| {
        rounds += 1;
        true
    });
    assert!(rounds > 3 && !choice.interrupted);
    let pieces: Vec<Atom> = choice.pieces.iter().map(|p| table.atoms[*p]).collect();
    let motion = Motion::new(pieces).unwrap();
    assert!(motion.duration() <= 6.0 + 1e-9 && motion.holds(&LIMITS));
    let judged = |motion: &Motion, axes: &[Candidate]| {
        let entries = axes.iter().enumerate();
        let entries: Vec<Entry> = entries
            .map(|(i, axis)| Entry::of(motion, axis, (&LIMITS, &RIG), 5000 + i as u32).unwrap())
            .collect();
        Expected::of(&entries, &Aim::new(RIG.force_noise))
    };
    // The pieces are simulated one by one, from rest each, with the encoder elsewhere in its step: the sums promise more than the
    // whole holds, which is why the whole is simulated.
    let off = judged(&motion, &axes).score - choice.score;
    assert!((0.0..0.6).contains(&off), "{off}");
    let fresh = plate().draw(12, 77);
    let designed = judged(&motion, &fresh);
    for kind in HandMade::ALL {
        let made = hand_made(kind, &LIMITS, &RIG, 6.0).unwrap().unwrap();
        let other = judged(&made, &fresh);
        assert!(
            designed.score < other.score,
            "{kind:?}: {} {}",
            designed.score,
            other.score
        );
    }
}

#[test]
fn a_choice_that_is_stopped_keeps_what_it_has() {
    let atoms: Vec<Atom> = dictionary(&LIMITS, &RIG).into_iter().step_by(6).collect();
    let table = table(atoms, &plate().draw(3, 1));
    let choice = select(&table, &Aim::new(RIG.force_noise), 4.0, &Alone, &mut |_| {
        false
    });
    assert!(choice.interrupted && !choice.pieces.is_empty());
}
