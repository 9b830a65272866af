//! A torque on a linear axis, or a force on a rotary one: the line of the axis file that scales it.

use super::load::Asked;
use stiction_codes::Code;
use stiction_files::axis::entry;
use stiction_files::result::{Action, CauseEntry};
use stiction_log::{Found, Log, Motion, Offset, Role};
use stiction_number::full;

/// What the column of the force lacks, as a part of the verdict; `None` where its unit fits the axis.
pub(super) fn cause(asked: Asked, log: &Log) -> Option<CauseEntry> {
    let mixed = log.finds(|f| matches!(f, Found::ForceUnit { .. }));
    let mut channel = log.mapping.force.clone().filter(|_| mixed)?;
    let mut joined = asked.axis.joined.iter();
    let joined = joined.find(|column| column.from.role == Role::Force);
    // A column of another file goes by its place there.
    if let (Some(_), Some(typed)) = (joined, &asked.axis.mapping.force) {
        channel.column = typed.column.clone();
    }
    // What stands there gives the unit that does not fit.
    channel.scale = None;
    let unit = channel.unit.as_ref().map_or("N*m", |unit| unit.text());
    let column = entry(&channel);
    let column = column.trim_end_matches('}').trim_end();
    let (text, wanted, how) = match log.motion {
        Motion::Linear => (
            "the force is a torque on a linear axis",
            "N",
            "2 pi / lead of a screw, 1 / radius of a pinion: 628.3 N/Nm for a lead of 10 mm",
        ),
        Motion::Rotary => (
            "the torque is a force on a rotary axis",
            "Nm",
            "the radius at which it acts: 0.05 Nm/N at 50 mm",
        ),
    };
    let offset = match joined.map(|column| column.from.offset) {
        None => String::new(),
        Some(Offset::Estimated) => ", offset = \"estimate\"".into(),
        Some(Offset::Given(seconds)) => format!(", offset = \"{} s\"", full(seconds)),
    };
    let line = format!("force = {column}{offset}, scale = \"... {wanted}/{unit}\" }}   # {how}");
    Some(CauseEntry {
        code: Code::ForceUnit,
        text: text.into(),
        size: format!("its scale to {wanted} is missing, without which no study can be simulated"),
        cure: Some(Action::Line {
            table: "columns".into(),
            line: joined.map_or_else(|| line.clone(), |column| column.line(&line)),
            replaces: false,
        }),
    })
}
