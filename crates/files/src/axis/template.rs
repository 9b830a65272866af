//! `check --init`: an axis file to fill in, with what was detected already in it.

use std::fmt::Write;
use stiction_formats::{Dimension, Table};
use stiction_log::{Channel, Mapping, Motion, OwnStamps, Role, Selector, Sign};

/// Words of the examples, for one kind of axis.
struct Words {
    length: &'static str,
    mass: &'static str,
    scale: &'static str,
    count: &'static str,
    travel: &'static str,
    limit: &'static str,
    speed_gain: &'static str,
}

const LINEAR: Words = Words {
    length: "mm",
    mass: "4.6 kg",
    scale: "96 N/A",
    count: "50 nm",
    travel: "24 mm",
    limit: "100 N",
    speed_gain: "2500 N s/m",
};
const ROTARY: Words = Words {
    length: "deg",
    mass: "2e-4 kg m^2",
    scale: "0.65 N*m/A",
    count: "0.001 deg",
    travel: "360 deg",
    limit: "10 N*m",
    speed_gain: "0.5 N m s/rad",
};

/// What was found in a log beside its columns.
#[derive(Clone, Debug, Default)]
pub struct Found {
    /// Columns whose unit was assumed.
    pub assumed: Vec<Role>,
    /// One encoder step with its unit: `5e-8 m`.
    pub resolution: Option<String>,
    /// Travel after which the position seems to start again, with its unit.
    pub wrap: Option<String>,
    /// Columns that have time stamps of their own.
    pub own_stamps: Vec<OwnStamps>,
    /// The column of time stamps that are not read since their clock is coarser than the sampling.
    pub coarse: Option<Channel>,
    /// Whether the force brakes as it stands, so that its sign is turned.
    pub brakes: bool,
    /// The line that leaves out the rows in which the axis was not enabled, where a column says so by its name.
    pub enable: Option<String>,
    /// What the numbers of each column look like; may be empty.
    pub columns: Vec<String>,
}

/// What may stand there of a column that says where the axis is enabled.
const ENABLE: &str = "# enable = \"NAME\"    # rows where it is 0 are left out; of a mode: { column = \"NAME\", equals = 8 }, of a status word with mask = 0x6f, equals = 0x27";

/// Text of an axis file for a table: detected columns filled in, or those that are clear and why the others could not be;
/// everything else as comments that say what may stand there.
pub fn template(
    table: &Table,
    detected: Result<&Mapping, (&Mapping, &str)>,
    found: &Found,
) -> String {
    let mut out = String::from(
        "# Axis file for stiction. Values carry their unit: \"5 mm/s\", \"35.15 N/V\". Every key is\n\
         # described in docs/axis.md; lines that start with # are off.\n\n",
    );
    if let Err((_, reason)) = detected {
        for reason in reason.lines() {
            let reason = reason.replace(char::is_control, " ");
            let _ = writeln!(out, "# To decide: {reason}");
        }
        out.push('\n');
    }
    let detected = detected.unwrap_or_else(|(clear, _)| clear);
    let kind = detected.motion;
    let words = match kind {
        Some(Motion::Rotary) => &ROTARY,
        _ => &LINEAR,
    };
    match kind {
        Some(kind) => {
            let _ = writeln!(out, "kind = \"{kind}\"");
        }
        None => out.push_str("# kind = \"linear\"    # or \"rotary\"\n"),
    }
    out.push_str("# name = \"X axis\"\n");
    let _ = writeln!(
        out,
        "# mass = \"{}\"     # known mass or inertia; \"fit\" (default) or \"none\"",
        words.mass
    );
    match (&detected.time, detected.rate_hz) {
        (None, Some(rate)) => {
            let why = match found.coarse {
                Some(_) => {
                    "from the first time stamp to the last: their clock is coarser than the sampling"
                }
                None => "as the file states it",
            };
            let _ = writeln!(out, "rate = \"{rate} Hz\"    # {why}");
        }
        (None, None) => out.push_str("# rate = \"1 kHz\"      # where there is no time column\n"),
        (Some(_), _) => {}
    }
    out.push_str("\n[columns]\n# The file has:\n");
    for (i, column) in table.columns.iter().enumerate().take(64) {
        let name = if column.name.is_empty() {
            "(no name)"
        } else {
            &column.name
        };
        let unit = column
            .unit
            .as_deref()
            .map_or(String::new(), |u| format!(" [{u}]"));
        // A name from a file must not break out of its comment, and TOML allows no control
        // characters there.
        let looks = found
            .columns
            .get(i)
            .map_or(String::new(), |looks| format!(": {looks}"));
        let line = format!("{name}{unit}{looks}").replace(char::is_control, " ");
        let _ = writeln!(out, "#   {}: {line}", table.number(i));
    }
    for role in Role::ALL {
        match detected.channel(role) {
            Some(channel) => {
                let note = match found.assumed.contains(&role) {
                    true => "    # the unit is assumed: nothing gives it",
                    false if role == Role::Force && found.brakes => {
                        "    # its sign is turned: as it stands it brakes"
                    }
                    false => "",
                };
                let mut entry = entry(channel);
                if let Some(own) = found.own_stamps.iter().find(|own| own.role == role) {
                    entry.truncate(entry.len() - " }".len());
                    let _ = write!(entry, ", time = {} }}", selector(&own.time));
                }
                let _ = writeln!(out, "{role} = {entry}{note}");
                let unit = channel.unit.as_ref().map(|u| u.dimension());
                let raw = [Dimension::CURRENT, Dimension::VOLTAGE]
                    .map(Some)
                    .contains(&unit);
                if role == Role::Force && raw && channel.scale.is_none() {
                    let _ = writeln!(
                        out,
                        "# with a force constant add, such as: scale = \"{}\"",
                        words.scale
                    );
                }
                if role == Role::Force && unit == Some(Dimension::ONE) && channel.scale.is_none() {
                    let rated = match detected.motion {
                        Some(Motion::Linear) => "250 N",
                        _ => "2.4 N m",
                    };
                    let _ = writeln!(
                        out,
                        "# of a part of the rated force or torque add that (CiA 402: object 6076h), such as: scale = \"{rated}\""
                    );
                }
                if unit == Some(Dimension::COUNTS) && channel.scale.is_none() {
                    out.push_str(
                        "# with the size of a count add, such as: scale = \"0.1 um/count\" or scale = \"0.01 deg/count\"\n",
                    );
                }
            }
            None if role == Role::Time && found.coarse.is_some() => {
                let entries = found.coarse.iter().map(entry);
                let _ = writeln!(
                    out,
                    "# time = {}    # rounded: the rate counts the rows",
                    entries.collect::<String>()
                );
            }
            None => {
                let length = words.length;
                let unit = match role {
                    Role::Time => "s".to_string(),
                    Role::Position | Role::Reference => length.to_string(),
                    Role::Velocity => format!("{length}/s"),
                    Role::Acceleration => format!("{length}/s^2"),
                    Role::Force | Role::External => format!("A\", scale = \"{}", words.scale),
                    Role::Temperature => "degC".to_string(),
                    Role::Load => "N".to_string(),
                };
                let example = format!("{{ column = \"NAME\", unit = \"{unit}\" }}");
                let _ = writeln!(out, "# {role} = {example}");
            }
        }
    }
    let _ = match &found.enable {
        Some(line) => writeln!(
            out,
            "# {line}    # not enabled in some rows: without the # those are left out"
        ),
        None => writeln!(out, "{ENABLE}"),
    };
    let Words {
        length,
        count,
        travel,
        limit,
        speed_gain,
        scale: constant,
        ..
    } = words;
    let resolution = match &found.resolution {
        Some(step) => format!("resolution = \"{step}\"    # one encoder step, found in the data"),
        None => format!("# resolution = \"{count}\"    # one encoder count"),
    };
    let wrap = match &found.wrap {
        Some(travel) => format!(
            "# wrap = \"{travel}\"         # the position jumps by about this: where it starts again, give it exactly"
        ),
        None => "# wrap = \"360 deg\"         # travel after which the position starts again"
            .to_string(),
    };
    let _ = write!(
        out,
        "\n[log]\n\
         # crop = [\"1 s\", \"20 s\"]\n\
         # rests = \"keep\"           # fit the axis at rest at start and end too\n\
         {wrap}\n\
         {resolution}\n\
         # force_limit = \"{limit}\"   # where the force saturates\n\n\
         # Where the force column is the voltage or the duty of a motor:\n\
         # [drive]\n\
         # force_constant = \"{constant}\"\n\
         # resistance = \"1.2 ohm\"\n\
         # supply = \"24 V\"           # of a duty\n\n\
         [conditioning]\n\
         # source_cutoff = \"100 Hz\" # \"auto\" (default), \"off\" or a frequency\n\
         # common_cutoff = \"50 Hz\"\n\
         # min_speed = \"1 {length}/s\"   # only faster samples count\n\n\
         [terms]\n\
         # gravity = true           # rotary axis: sin q and cos q\n\
         # delay = \"none\"            # \"fit\" (default), \"none\" or a time: force after motion\n\
         # cogging = [\"{travel}\"]    # pitch of each cogging wave\n\
         # coulomb_load = true      # friction that changes with the load column\n\
         # coulomb_transmitted = true   # friction that grows with the torque that a gear passes on\n\n\
         [report]\n\
         # low_speed = \"1 {length}/s\"   # what counts as near zero speed\n\n\
         # For the method output-error, where the control law is known; else leave it out.\n\
         # [controller]\n\
         # kind = \"p-p\"            # or \"p-pi\", with integral_gain\n\
         # position_gain = \"60 1/s\"\n\
         # speed_gain = \"{speed_gain}\"\n"
    );
    out
}

/// A column as a value of `[columns]`: `{ column = "qm", unit = "m" }`.
pub fn entry(channel: &Channel) -> String {
    let mut out = format!("{{ column = {}", selector(&channel.column));
    if let Some(unit) = &channel.unit {
        let _ = write!(
            out,
            ", unit = {}",
            toml::Value::String(unit.text().to_string())
        );
    }
    if let Some(scale) = &channel.scale {
        let _ = write!(out, ", scale = {}", toml::Value::String(scale.to_string()));
    }
    if channel.invert {
        out.push_str(", invert = true");
    }
    match &channel.sign {
        None => {}
        Some(Sign::FollowingError) => out.push_str(", sign = \"following-error\""),
        Some(Sign::Column(column)) => {
            let _ = write!(out, ", sign = {}", selector(column));
        }
    }
    out.push_str(" }");
    out
}

fn selector(selector: &Selector) -> String {
    match selector {
        Selector::Name(name) => toml::Value::String(name.clone()).to_string(),
        Selector::Index(i) => i.to_string(),
    }
}
