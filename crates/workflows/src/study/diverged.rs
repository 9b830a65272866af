//! A run that left its path and went on: its numbers say nothing of an axis.

use stiction_friction::ParamError;
use stiction_number::four_digits as short;
use stiction_policy::simulation;
use stiction_say::NoRun;
use stiction_servo::axis::Sample;
use stiction_servo::controller::Controller;

/// Why a run gives no numbers.
#[derive(Clone, Copy, Debug)]
pub(super) enum Fault {
    /// Values that do not go together, or a figure that is not finite.
    Refused(ParamError),
    /// It left the path at this time, s.
    Diverged(f64),
}

impl Fault {
    /// The same for a notice.
    pub fn no_run(&self) -> NoRun {
        match self {
            Self::Refused(e) => NoRun::Refused {
                name: e.name.to_string(),
                value: e.value,
                allowed: e.allowed.to_string(),
            },
            Self::Diverged(seconds) => NoRun::Diverged { seconds: *seconds },
        }
    }
}

impl From<ParamError> for Fault {
    fn from(e: ParamError) -> Self {
        Fault::Refused(e)
    }
}

/// Refuses a run of one axis, or of two, in which an error grew beyond all measure, or to no number. It left the path where an
/// error first exceeded the length of that, the longest way that one of its axes goes.
pub(super) fn stayed<'s, const AXES: usize>(
    samples: impl Iterator<Item = [&'s Sample; AXES]> + Clone,
) -> Result<(), Fault> {
    let ways = (0..AXES).map(|axis| {
        let at = samples.clone().map(|s| s[axis].reference.position);
        at.fold([0.0_f64; 2], |[low, high], x| [low.min(x), high.max(x)])
    });
    let length = ways.fold(0.0_f64, |most, [low, high]| most.max(high - low));
    // A reference that stands still has no length to leave.
    let far = |parts: f64| {
        if length > 0.0 {
            parts * length
        } else {
            f64::MAX
        }
    };
    let within = |s: &[&Sample; AXES], most: f64| s.iter().all(|s| s.error().abs() <= most);
    if samples
        .clone()
        .all(|s| within(&s, far(simulation::DIVERGED_RUN_ERROR)))
    {
        return Ok(());
    }
    let left = samples.clone().find(|s| !within(s, far(1.0)));
    Err(Fault::Diverged(left.map_or(0.0, |s| s[0].time)))
}

/// The gains of a controller in words.
pub(super) fn gains(controller: &Controller) -> String {
    let named = match controller {
        Controller::Cascade(c) => [
            ("position_gain", c.position_gain),
            ("speed_gain", c.speed_gain),
            ("integral_gain", c.integral_gain),
        ],
        Controller::Pid(c) => pid(c),
        Controller::Fuzzy(c) => pid(&c.base),
    };
    named
        .map(|(name, gain)| format!("{name} {}", short(gain)))
        .join(", ")
}

fn pid(c: &stiction_servo::pid::Pid) -> [(&'static str, f64); 3] {
    [
        ("proportional", c.proportional),
        ("integral", c.integral),
        ("derivative", c.derivative),
    ]
}
