//! Pieces of a motion in a log: all there, cut short, left out, after a pause, at another pace, held by friction, another motion.

use stiction_plan::{Atom, How, Motion, recognise};

fn sine(amplitude: f64, frequency: f64, duration: f64) -> Atom {
    Atom::Sine {
        amplitude,
        frequency,
        duration,
        fade_in: 0.2,
        fade_out: 0.2,
    }
}

fn there(distance: f64, speed: f64) -> Atom {
    Atom::Move {
        distance,
        speed,
        acceleration: 4.0,
        jerk: 800.0,
    }
}

/// Some of them small enough to be held by friction.
fn atoms() -> Vec<Atom> {
    vec![
        sine(3e-6, 12.0, 0.8),
        there(1e-3, 0.01),
        sine(5e-4, 7.0, 1.0),
        there(0.02, 0.1),
        sine(4e-6, 20.0, 0.6),
        sine(0.02, 1.5, 1.5),
        there(-0.06, 0.2),
    ]
}

/// A log at 1 kHz of pieces with pauses before them, s, from 0.3 m and at a time of its own; what moves less than `held` does not move.
fn log(parts: &[(f64, Atom)], pace: f64, held: f64) -> (Vec<f64>, Vec<f64>) {
    let mut positions = Vec::new();
    for (pause, atom) in parts {
        positions.resize(positions.len() + (1e3 * pause) as usize, 0.3);
        let size = atom.extremes().position.map(f64::abs);
        let moves = size[0].max(size[1]) > held;
        for k in 0..(1e3 * atom.duration() / pace) as usize {
            let t = pace * (k as f64 - 8.0) * 1e-3;
            positions.push(
                0.3 + if moves {
                    0.97 * atom.at(t).position
                } else {
                    0.0
                },
            );
        }
    }
    positions.resize(positions.len() + 700, 0.3);
    let time = (0..positions.len()).map(|k| 5.0 + 1e-3 * k as f64);
    (time.collect(), positions)
}

fn hows(motion: &Motion, log: &(Vec<f64>, Vec<f64>)) -> Vec<How> {
    let found = recognise(motion, &log.0, &log.1).unwrap();
    assert_eq!(found.pace, 1.0);
    found.pieces.iter().map(|piece| piece.how).collect()
}

#[test]
fn all_pieces_are_found_where_they_are() {
    let motion = Motion::new(atoms()).unwrap();
    let mut parts: Vec<_> = atoms().into_iter().map(|atom| (0.0, atom)).collect();
    parts[0].0 = 1.3;
    let found = recognise(
        &motion,
        &log(&parts, 1.0, 1e-5).0,
        &log(&parts, 1.0, 1e-5).1,
    )
    .unwrap();
    for (ran, (from, atom)) in found.pieces.iter().zip(motion.timed()) {
        assert_eq!(ran.how, How::Whole);
        let [low, high] = atom.extremes().position;
        let is_held = high.max(-low) < 1e-5;
        assert!(
            (ran.start.unwrap() - (5.0 + 1.3 + 0.008 + from)).abs() < 0.02,
            "{from} {ran:?}"
        );
        let due = if is_held { 0.0 } else { 0.97 };
        assert!((ran.followed - due).abs() < 0.02, "{ran:?}");
    }
}

#[test]
fn what_is_not_there_is_said() {
    use How::{CutShort, Missing, Whole};
    let motion = Motion::new(atoms()).unwrap();
    // Stopped in the middle of the last piece but one.
    let parts: Vec<_> = atoms().into_iter().map(|atom| (0.0, atom)).collect();
    let (mut time, mut position) = log(&parts, 1.0, 0.0);
    let end = (1e3 * motion.timed().nth(5).unwrap().0) as usize + 700;
    time.truncate(end);
    position.truncate(end);
    assert_eq!(
        hows(&motion, &(time, position)),
        [Whole, Whole, Whole, Whole, Whole, CutShort, Missing]
    );
    // Stopped before a piece to which what the axis makes of a smaller one is more alike than it is to its own.
    let (small, large) = (sine(5e-4, 7.0, 1.0), sine(5e-3, 7.2, 1.0));
    let alike = Motion::new(vec![there(0.02, 0.1), small, large]).unwrap();
    let ran = [there(0.02, 0.1), sine(5e-4, 7.2, 1.0)];
    let ran: Vec<_> = ran.into_iter().map(|atom| (0.0, atom)).collect();
    assert_eq!(hows(&alike, &log(&ran, 1.0, 0.0)), [Whole, Whole, Missing]);
    // A piece left out, one that moves and one that friction holds.
    for (left_out, held) in [(2, 0.0), (3, 1e-5), (4, 1e-5)] {
        let mut parts = parts.clone();
        parts.remove(left_out);
        let mut due = [Whole; 7];
        due[left_out] = Missing;
        assert_eq!(hows(&motion, &log(&parts, 1.0, held)), due, "{left_out}");
    }
    // A pause of two seconds in the middle.
    let mut paused = parts.clone();
    paused[3].0 = 2.0;
    assert_eq!(hows(&motion, &log(&paused, 1.0, 1e-5)), [Whole; 7]);
}

#[test]
fn another_pace_and_another_motion_are_told_apart() {
    let motion = Motion::new(atoms()).unwrap();
    let parts: Vec<_> = atoms().into_iter().map(|atom| (0.0, atom)).collect();
    for pace in [0.3, 0.5, 0.9, 1.03, 1.1] {
        let (time, position) = log(&parts, pace, 1e-5);
        let found = recognise(&motion, &time, &position).unwrap();
        assert!((found.pace / pace - 1.0).abs() < 0.03, "{found:?}");
        assert!(found.pieces.is_empty());
    }
    let other = log(&[(0.5, sine(0.02, 1.0, 9.0))], 1.0, 0.0);
    assert_eq!(recognise(&motion, &other.0, &other.1), None);
    let still = log(&[(9.0, there(1e-6, 0.01))], 1.0, 1.0);
    assert_eq!(recognise(&motion, &still.0, &still.1), None);
    assert_eq!(recognise(&motion, &[], &[]), None);
    assert_eq!(recognise(&motion, &[0.0], &[0.0]), None);
}

/// A small sine of which friction and a slow loop leave a third, flattened and late, has run; where the axis rests instead it has not.
#[test]
fn what_the_axis_hardly_follows_has_run() {
    let motion = Motion::new(atoms()).unwrap();
    let parts: Vec<_> = atoms().into_iter().map(|atom| (0.0, atom)).collect();
    let (time, mut positions) = log(&parts, 1.0, 1e-5);
    let (from, atom) = motion.timed().nth(2).unwrap();
    let stretch = (1e3 * from) as usize..(1e3 * (from + atom.duration())) as usize;
    let mut resting = positions.clone();
    for k in stretch {
        let late = atom.at(k as f64 * 1e-3 - from - 0.04).position;
        positions[k] = 0.3 + 2e-4 * (late.abs() / 5e-4).powi(2) * late.signum();
        resting[k] = 0.3;
    }
    let how = |positions: Vec<f64>| hows(&motion, &(time.clone(), positions))[2];
    assert_eq!(how(positions), How::Whole);
    assert_eq!(how(resting), How::Missing);
}
