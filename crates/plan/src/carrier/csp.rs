//! Cyclic synchronous position mode of CiA 402: whole counts for each cycle.

use super::{Carried, Carrier, CarrierError, Job};
use std::fmt::Write;
use stiction_number::{full, short};

/// Target position (object 0x607A) and velocity offset (0x60B1), relative to where the drive stands.
pub(super) fn carry(job: &Job) -> Result<Carried, CarrierError> {
    let mut text =
        String::from("cycle,target position 0x607A [counts],velocity offset 0x60B1 [counts/s]\n");
    for (cycle, (_, at)) in job.samples().enumerate() {
        let [target, velocity] = [at.position, at.velocity]
            .map(|x| libm::rint(x / job.resolution))
            .map(|counts| (counts.abs() <= f64::from(i32::MAX)).then_some(counts as i32));
        let (Some(target), Some(velocity)) = (target, velocity) else {
            return Err(CarrierError {
                found: format!(
                    "csp: {} {} and {} {}/s in counts of {} {}",
                    short(at.position),
                    job.length(),
                    short(at.velocity),
                    job.length(),
                    full(job.resolution),
                    job.length()
                ),
                allowed: "-2147483647 to 2147483647 counts, as the objects 0x607A and 0x60B1 hold: the step of the encoder \
                          that the drive counts in, as [log] resolution of the axis file"
                    .into(),
            });
        };
        let _ = writeln!(text, "{cycle},{target},{velocity}");
    }
    Ok(Carried {
        carrier: Carrier::Csp,
        text,
        note: format!(
            "a row for each cycle of {} ms in whole counts of {} {}, rounded by up to half a count; {}",
            short(1e3 / job.rate),
            short(job.resolution),
            job.length(),
            job.adding("the actual position (0x6064) of the drive at its start to 0x607A")
        ),
    })
}
