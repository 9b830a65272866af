//! `setpoints.csv`: a planned motion at the rate of the log.

use stiction_files::symbols;
use stiction_workflows::plan::Planned;

/// Time, position, velocity and acceleration, one row a sample, from rest to rest.
pub(crate) fn setpoints_csv(planned: &Planned) -> String {
    let motion = planned.given.motion;
    let (length, speed) = (symbols::length_unit(motion), symbols::speed_unit(motion));
    let mut out = format!("t [s],x [{length}],v [{speed}],a [{speed}2]\n");
    let rate = planned.file.rig.rate;
    let mut buffer = zmij::Buffer::new();
    for k in 0..=last(planned.motion.duration() * rate) {
        let t = k as f64 / rate;
        let at = planned.motion.at(t);
        let row = [t, at.position, at.velocity, at.acceleration];
        for (i, x) in row.into_iter().enumerate() {
            if i > 0 {
                out.push(',');
            }
            out.push_str(buffer.format(x));
        }
        out.push('\n');
    }
    out
}

/// The first sample at or after the end, at which the motion is at rest.
fn last(samples: f64) -> u64 {
    let whole = samples as u64;
    whole + u64::from(samples > whole as f64)
}
