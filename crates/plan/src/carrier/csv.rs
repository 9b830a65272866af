//! `setpoints.csv`.

use super::{Carried, Carrier, Job};

/// Time, position, velocity and acceleration, one row a sample, from rest to rest.
pub(super) fn carry(job: &Job) -> Carried {
    let length = job.length();
    let mut text = format!("t [s],x [{length}],v [{length}/s],a [{length}/s2]\n");
    let mut buffer = zmij::Buffer::new();
    for (t, at) in job.samples() {
        let row = [t, at.position, at.velocity, at.acceleration];
        for (i, x) in row.into_iter().enumerate() {
            if i > 0 {
                text.push(',');
            }
            text.push_str(buffer.format(x));
        }
        text.push('\n');
    }
    Carried {
        carrier: Carrier::Csv,
        text,
        note: String::new(),
    }
}
