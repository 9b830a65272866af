//! G-code: straight moves between the reversals of the motion.

use super::{Carried, Carrier, Job};
use std::fmt::Write;

/// A reversal is sought between samples this far apart, s: a hundredth of the period of the fastest sine.
const STEP: f64 = 2.5e-4;

/// One `G1` for each stroke from reversal to reversal, in the time that it takes in the motion.
pub(super) fn carry(job: &Job) -> Carried {
    let (unit, of) = job.machine();
    let letter = if job.rotary { 'A' } else { 'X' };
    let mut text = format!(
        "(Planned by stiction: strokes between the reversals of the motion, {unit})\n\
         (Acceleration and jerk are those of the control: the expected intervals do not hold)\n\
         G21 G90 G94 G61\nG1 {letter}{:.6} F600.\n",
        of * job.start
    );
    let mut strokes = 0;
    let mut before = [0.0, job.start];
    for [t, position] in reversals(job) {
        let length = of * (position - before[1]);
        // What the six decimals of a control do not show is no move.
        if length.abs() >= 1e-6 {
            let feed = 60.0 * length.abs() / (t - before[0]);
            let _ = writeln!(text, "G1 {letter}{:.6} F{feed:.4}", of * position);
            strokes += 1;
            before = [t, position];
        }
    }
    text.push_str("M2\n");
    Carried {
        carrier: Carrier::Gcode,
        text,
        note: format!(
            "{strokes} strokes of constant feed between the reversals of the motion, in {unit}: acceleration and jerk are those of \
             the control, sines become strokes, and what the table above expects does not hold; look at the log with stiction check; {}",
            job.counts_from()
        ),
    }
}

/// Times and positions at which the motion turns back, and the end.
fn reversals(job: &Job) -> Vec<[f64; 2]> {
    let mut found = Vec::new();
    let end = job.motion.duration();
    let count = libm::ceil(end / STEP) as usize;
    let (mut sense, mut extreme) = (0.0_f64, [0.0, job.start]);
    for k in 1..=count {
        let t = (k as f64 * STEP).min(end);
        let at = job.at(t);
        let moved = at.position - extreme[1];
        if sense == 0.0 || moved * sense > 0.0 {
            if moved != 0.0 {
                sense = moved.signum();
                extreme = [t, at.position];
            }
        } else if moved * sense < 0.0 {
            found.push(extreme);
            sense = -sense;
            extreme = [t, at.position];
        }
    }
    found.push([end, job.start]);
    found
}
