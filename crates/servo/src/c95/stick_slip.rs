//! E: pulled slowly through a spring, the block sticks and slips.

use super::experiment::{Check, Curve, Experiment, TOLERANCE, block};
use crate::plant::{Load, Motion};
use stiction_friction::ParamError;

/// Stiffness of the spring, N/m.
const SPRING: f64 = 2.0;
/// Velocity of the end of the spring, m/s.
const PULL: f64 = 0.1;
/// Velocity from which on the block counts as slipping, m/s: ten Stribeck velocities.
const SLIPS: f64 = 10.0 * 1e-3;
/// Integration steps a second.
const RATE: u32 = 10_000;

/// A beginning or end of slip: instant, s; position after it, m; force of the spring before it, N.
struct Crossing {
    time: f64,
    position: f64,
    spring: f64,
}

pub(super) fn run() -> Result<Experiment, ParamError> {
    let plant = block()?;
    let h = 1.0 / f64::from(RATE);
    let spring = |t: f64, x: f64| SPRING * (PULL * t - x);
    let mut motion = Motion::default();
    let (mut begins, mut ends): (Vec<Crossing>, Vec<Crossing>) = (Vec::new(), Vec::new());
    let mut fastest = 0.0_f64;
    let mut at = Vec::new();
    let mut curves = [Curve::new("Block"), Curve::new("End of the spring")];
    for k in 0..=40 * RATE {
        let t = f64::from(k) * h;
        if k % (10 * RATE) == 0 {
            at.push(motion.position);
        }
        if k % (RATE / 50) == 0 {
            curves[0].push(t, motion.position);
            curves[1].push(t, PULL * t);
        }
        let load = Load {
            force: SPRING * PULL * (t + 0.5 * h),
            stiffness: SPRING,
        };
        let next = plant.step(motion, h, load).motion;
        let crossing = || Crossing {
            // Linear within the step.
            time: t + h * (SLIPS - motion.velocity) / (next.velocity - motion.velocity),
            position: next.position,
            spring: spring(t, motion.position),
        };
        if motion.velocity <= SLIPS && next.velocity > SLIPS {
            begins.push(crossing());
        }
        if motion.velocity >= SLIPS && next.velocity < SLIPS {
            ends.push(crossing());
        }
        fastest = fastest.max(next.velocity);
        motion = next;
    }
    let ([begin, second, ..], [end, ..]) = (&begins[..], &ends[..]) else {
        return Err(ParamError::new(
            "slips",
            begins.len() as f64,
            "two or more in 40 s",
        ));
    };
    let period = begins
        .windows(2)
        .map(|pair| pair[1].time - pair[0].time)
        .fold(second.time - begin.time, |worst, next| {
            if (next - 6.362).abs() > (worst - 6.362).abs() {
                next
            } else {
                worst
            }
        });
    let checks = [
        ("first slip", "s", begin.time, 7.458),
        ("first slip ends", "s", end.time, 10.223),
        ("slip", "s", end.time - begin.time, 2.765),
        ("period, the one farthest off", "s", period, 6.362),
        ("jump", "m", end.position - begin.position, 0.6360),
        ("largest velocity", "m/s", fastest, 0.3698),
        ("spring force at slip", "N", begin.spring, 1.491),
        ("spring force after", "N", end.spring, 0.773),
        ("x(10 s)", "m", at[1], 0.627583),
        ("x(20 s)", "m", at[2], 1.272596),
        ("x(40 s)", "m", at[4], 3.306801),
    ]
    .map(|(name, unit, found, expected)| Check::relative(name, unit, found, expected, TOLERANCE));
    Ok(Experiment {
        letter: 'E',
        title: "Stick-slip",
        checks: checks.to_vec(),
        axes: [("Time", "s"), ("Position", "m")],
        curves: curves.into(),
    })
}
