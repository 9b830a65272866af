//! What may be asked of a compensator, and what is refused: settings beyond their range, and those that a target has no use for.

use super::{ExportOptions, Feedforward};
use crate::error::Error;
use crate::wording::Setting;
use stiction_export::{Model, Target};
use stiction_files::ModelFile;
use stiction_friction::compensator::{Friction, Terms};

/// Longest ramp and window, and longest time in which the slew limit lets friction at standstill through, s.
const LONGEST: f64 = 3600.0;

/// Most draws.
const MOST_DRAWS: usize = 100_000;
/// Most numbers in all draws, some 200 MB of text.
const MOST_NUMBERS: usize = 20_000_000;

/// Shortest ramp that is one, and shortest such time, s: below any cycle time.
const SHORTEST: (f64, f64) = (1e-6, 1e-9);

/// Refuses options that the target has no use for.
pub(crate) fn check(options: &ExportOptions) -> Result<(), Error> {
    if options.rated_force.is_some() && options.target != Target::Tf5200 {
        let found = format!("a rated force for the target {}", options.target.name());
        return Err(Error::usage(found, "only tf5200 takes one"));
    }
    let target = options.target.name();
    if let Some(draws) = &options.draws {
        if !options.target.takes_draws() {
            return Err(Error::usage(
                format!("draws for the target {target}"),
                "domain-json, mujoco, isaaclab, newton and bam take them",
            ));
        }
        if !(1..=MOST_DRAWS).contains(&draws.count) {
            return Err(Error::usage(
                format!("{} draws", draws.count),
                format!("from 1 to {MOST_DRAWS}"),
            ));
        }
    }
    let simulated = options.target.is_simulated();
    let map = options.target.is_map();
    let numbers = options.target == Target::DriveTable || map;
    let whole = [
        (
            "limit",
            options.limit,
            "the friction of a simulated joint is not limited",
        ),
        (
            "gain",
            options.gain,
            "the friction of a simulated joint is the whole friction",
        ),
    ];
    let mut given = whole.into_iter().filter(|(_, value, _)| value.is_some());
    if let Some((what, _, of_joint)) = given.next().filter(|_| simulated || numbers) {
        let of_drive = "it has the whole friction; write a share of the numbers into the drive, and let the drive limit its torque";
        return Err(Error::usage(
            format!("a {what} for the target {target}"),
            match simulated {
                true => of_joint,
                false if map => "it has no friction",
                false => of_drive,
            },
        ));
    }
    let safety = &options.safety;
    let given = [
        ("ramp", safety.ramp),
        ("dead zone", safety.dead_zone),
        ("slew", safety.slew),
        ("window", safety.window),
    ];
    let none = simulated || numbers || options.target == Target::Tf5200;
    if let Some((name, _)) = given.iter().find(|(_, value)| none && value.is_some()) {
        return Err(Error::usage(
            format!("a {name} for the target {target}"),
            "it has none",
        ));
    }
    let window = safety.window.filter(|window| *window != 0.0);
    let ramp = safety.ramp.filter(|ramp| *ramp != 0.0);
    for (name, value, least, allowed) in [
        (
            "window",
            window,
            options.cycle_time,
            "from the cycle time to 3600 s, or 0 for no watchdog",
        ),
        ("ramp", ramp, SHORTEST.0, "0, or from 1e-6 to 3600 s"),
    ] {
        // A block that needs longer to learn, or to come in, never compensates.
        if let Some(value) = value.filter(|value| !(*value >= least && *value <= LONGEST)) {
            let found = format!("a {name} of {} s", stiction_number::shortest(value));
            return Err(Error::usage(found, allowed));
        }
    }
    if none && options.adapt {
        return Err(Error::usage(
            format!("levels that follow the machine for the target {target}"),
            "c, cpp, ros2, st, tcpou, plcopen, rust, hal, fmu and matlab have them",
        ));
    }
    if none && options.feedforward != Feedforward::default() {
        return Err(Error::usage(
            format!("a feedforward beside friction for the target {target}"),
            "c, cpp, ros2, st, tcpou, plcopen, rust, hal, fmu and matlab have one",
        ));
    }
    Ok(())
}

/// Refuses draws of more numbers than a file should have.
pub(super) fn few_enough<'a>(
    options: &ExportOptions,
    models: impl Iterator<Item = &'a Model>,
) -> Result<(), Error> {
    let numbers: usize = models.map(|model| model.domain.numbers.len()).sum();
    match options.draws {
        Some(draws) if draws.count * numbers > MOST_NUMBERS => Err(Error::usage(
            format!("{} draws of {numbers} numbers", draws.count),
            format!("at most {} draws here", MOST_NUMBERS / numbers),
        )),
        _ => Ok(()),
    }
}

/// Refuses settings that do not go with the law: a slew limit that keeps the force from following friction, a dead zone that takes
/// all speeds of the log, and a limit below the weight.
pub(super) fn within(
    options: &ExportOptions,
    friction: &Friction<f64>,
    terms: &Terms<f64>,
    file: &ModelFile,
) -> Result<(), Error> {
    if let Some(slew) = options.safety.slew {
        let least = friction.scale() / LONGEST;
        let most = friction.scale() / SHORTEST.1;
        if !(least..=most).contains(&slew) {
            let unit = file.force_unit.replace('*', " ");
            return Err(Error::usage(
                format!("a slew of {} {unit}/s", stiction_number::shortest(slew)),
                format!(
                    "from {} {unit}/s, with which the force reaches friction at standstill within an hour, to {} {unit}/s, within a nanosecond",
                    stiction_number::four_digits(least),
                    stiction_number::four_digits(most)
                ),
            ));
        }
    }
    if let (Some(zone), Some(top)) = (options.safety.dead_zone, file.top_speed())
        && zone >= top
    {
        let speed = match file.kind.as_str() {
            "rotary" => "rad/s",
            _ => "m/s",
        };
        return Err(Error::usage(
            format!("a dead zone of {} {speed}", stiction_number::shortest(zone)),
            format!(
                "below {} {speed}, the top speed of the log: at and above it nothing would be compensated",
                stiction_number::four_digits(top)
            ),
        ));
    }
    if let Some(limit) = options.limit {
        holds(limit, terms, file)?;
    }
    Ok(())
}

/// Refuses a limit that the weight alone exceeds: an axis that is held by less falls.
fn holds(limit: f64, terms: &Terms<f64>, file: &ModelFile) -> Result<(), Error> {
    let Some(weight) = terms.weight else {
        return Ok(());
    };
    let wave = libm::hypot(weight.wave.sine, weight.wave.cosine);
    let most = weight.constant.abs() + wave;
    if limit.is_nan() || limit >= most {
        return Ok(());
    }
    let unit = file.force_unit.replace('*', " ");
    let [limit, most] = [limit, most].map(stiction_number::four_digits);
    Err(Error::usage(
        format!("a limit of {limit} {unit} below the weight that is fed forward"),
        [
            format!("above {most} {unit}, which hold the axis, with room for friction; or ").into(),
            Setting::Feedforward.into(),
            " without gravity".into(),
        ],
    ))
}
