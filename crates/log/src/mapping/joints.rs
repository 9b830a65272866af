//! Columns of the joints of a robot: by the names of the joints, or by numbers in the names of the columns.

use super::channel::{Channel, Motion, Role, Selector};
use super::convert::of_role;
use super::names::{self, Hint};
use super::{choose, describe, endings};
use crate::{Dimension, Error, Kind, Table, Unit};
use std::collections::BTreeMap;

/// Roles that are looked for.
const ROLES: [Role; 4] = [Role::Position, Role::Velocity, Role::Force, Role::Reference];
/// Largest number in the name of a column that is one of a joint.
const MOST_JOINTS: usize = 1000;

/// The columns of a joint.
pub type JointColumns = Vec<(Role, Channel)>;

/// A number or a name that tells which joint a column belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Tag {
    Name(usize),
    Number(usize),
}

/// Columns whose names differ in the joint only: `q1` to `q6`, or `joint_states.elbow.position` and its like.
struct Family {
    hint: Hint,
    /// Column by joint.
    columns: BTreeMap<Tag, usize>,
}

/// Finds position, velocity, force and reference of each joint of a robot, whose names are in the order of its joints.
///
/// A column belongs to a joint whose name is a part of its own. Where no column has the name of a joint, columns that are numbered
/// without a gap from 0 or 1 belong to the joints in their order, or to those whose names end in the numbers. A commanded force is
/// taken only where no measured one is found. Joints without a column have an empty list.
///
/// # Errors
/// [`Kind::Ambiguous`] where several measured families of columns could be one role.
pub fn joints(table: &Table, joints: &[&str]) -> Result<Vec<JointColumns>, Error> {
    let families = families(table, joints);
    let named = families
        .iter()
        .any(|family| family.columns.keys().any(|tag| matches!(tag, Tag::Name(_))));
    let mut out = vec![JointColumns::new(); joints.len()];
    for role in ROLES {
        let of_role = families.iter().filter(|family| {
            let is_named = family.columns.keys().all(|tag| matches!(tag, Tag::Name(_)));
            // Three wrists by number are not three of eight joints.
            let enough = is_named || 2 * family.columns.len() > joints.len();
            family.hint.role == role && is_named == named && enough
        });
        let mut found: Vec<&Family> = of_role.collect();
        let best = found.iter().map(|family| preference(&family.hint)).min();
        found.retain(|family| Some(preference(&family.hint)) == best);
        if let [one, other, ..] = found[..] {
            return Err(ambiguous(table, role, [one, other]));
        }
        for (tag, column) in found.iter().flat_map(|family| &family.columns) {
            let joint = match tag {
                Tag::Name(joint) => Some(*joint),
                Tag::Number(number) => numbered(joints, *number, found[0]),
            };
            if let Some(own) = joint.and_then(|joint| out.get_mut(joint)) {
                own.push((role, channel(table, *column)));
            }
        }
    }
    Ok(out)
}

/// Gives columns of joints the units of a robot's middleware where not one of them has a unit: rad, or m where the joint slides, and
/// per second of them; N m or N of what is no current by its name, whose gain nobody assumes. Whether it did.
pub fn assume_units(table: &Table, joints: &mut [JointColumns], motions: &[Motion]) -> bool {
    let mut all = joints.iter().flatten();
    if all.any(|(_, channel)| channel.unit.is_some()) || joints.iter().all(Vec::is_empty) {
        return false;
    }
    for (own, motion) in joints.iter_mut().zip(motions) {
        for (role, channel) in own {
            let name = match &channel.column {
                Selector::Index(number) => table.index(*number),
                Selector::Name(_) => None,
            };
            let name = name.map_or("", |column| table.columns[column].name.as_str());
            let dimension = match role {
                Role::Velocity => motion.velocity(),
                Role::Force if names::says_current(name) => Dimension::CURRENT,
                Role::Force => motion.force(),
                _ => motion.position(),
            };
            channel.unit = Some(Unit::si(dimension));
        }
    }
    true
}

/// Measured columns come before others, and a weak hint after any other.
fn preference(hint: &Hint) -> (bool, bool, bool) {
    (
        hint.commanded && hint.role != Role::Reference,
        !hint.measured,
        hint.weak,
    )
}

/// The columns that differ in the joint only.
fn families(table: &Table, joints: &[&str]) -> Vec<Family> {
    let mut stems: BTreeMap<String, BTreeMap<Tag, usize>> = BTreeMap::new();
    for (column, own) in table.columns.iter().enumerate() {
        if let Some((stem, tag)) = split(&own.name, joints) {
            stems.entry(stem).or_default().entry(tag).or_insert(column);
        }
    }
    let family = |(stem, columns): (String, BTreeMap<Tag, usize>)| {
        let numbers: Vec<usize> = columns
            .keys()
            .filter_map(|tag| match tag {
                Tag::Number(number) => Some(*number),
                Tag::Name(_) => None,
            })
            .collect();
        let first = numbers.first().copied().unwrap_or(1);
        let without_gap = numbers.iter().enumerate().all(|(i, n)| *n == first + i);
        let is_list = numbers.is_empty() || (first <= 1 && without_gap && numbers.len() > 1);
        let (_, &column) = columns.first_key_value()?;
        let hint = hint(table, column, &stem)?;
        (is_list && !names::passed_over(&stem)).then_some(Family { hint, columns })
    };
    stems.into_iter().filter_map(family).collect()
}

/// The role of a family by its unit, and by its name.
fn hint(table: &Table, column: usize, stem: &str) -> Option<Hint> {
    let by_name = names::hint(stem);
    let unit = endings::unit_of(table, column);
    let allowed = |hint: &Hint| {
        let unit = unit
            .as_ref()
            .map(|unit| of_role(unit, hint.role).dimension());
        unit.is_none_or(|unit| choose::allows(hint.role, unit))
    };
    by_name.filter(allowed)
}

/// A name without what tells the joint, and that.
fn split(name: &str, joints: &[&str]) -> Option<(String, Tag)> {
    let lower = name.to_lowercase();
    let is_edge = |c: Option<char>| c.is_none_or(|c| !c.is_alphanumeric());
    let mut found: Option<(usize, usize, usize)> = None;
    for (joint, own) in joints.iter().enumerate().filter(|(_, own)| !own.is_empty()) {
        let own = own.to_lowercase();
        let at = lower.match_indices(&own).find(|(at, _)| {
            let (before, after) = (&lower[..*at], &lower[at + own.len()..]);
            is_edge(before.chars().next_back()) && is_edge(after.chars().next())
        });
        if let Some((at, _)) = at
            && found.is_none_or(|(_, len, _)| own.len() > len)
        {
            found = Some((at, own.len(), joint));
        }
    }
    if let Some((at, len, joint)) = found {
        let stem = format!("{} {}", &lower[..at], &lower[at + len..]);
        return Some((stem, Tag::Name(joint)));
    }
    let digits = |c: char| c.is_ascii_digit();
    let end = lower.trim_end_matches([')', ']', '}', ' ']);
    let start = end.trim_end_matches(digits);
    // The number is at the end, or the only one.
    let (before, number, after) = match start.len() < end.len() {
        true => (start, &end[start.len()..], ""),
        false => {
            let from = lower.find(digits)?;
            let rest = &lower[from..];
            let to = from + rest.find(|c| !digits(c)).unwrap_or(rest.len());
            (&lower[..from], &lower[from..to], &lower[to..])
        }
    };
    let number = number.parse().ok().filter(|n| *n <= MOST_JOINTS)?;
    let words = |text: &str| text.replace(['(', '[', '{', ':', ','], " ");
    let stem = format!("{} {}", words(before), words(after));
    Some((stem.trim().to_string(), Tag::Number(number)))
}

/// The joint that a number in the name of a column means.
fn numbered(joints: &[&str], number: usize, family: &Family) -> Option<usize> {
    let starts_at_one = !family.columns.contains_key(&Tag::Number(0));
    let ends_in = |name: &str| {
        let digits = name.trim_end_matches(|c: char| c.is_ascii_digit()).len();
        name[digits..].parse::<usize>().ok()
    };
    let numbers: Vec<Option<usize>> = joints.iter().map(|name| ends_in(name)).collect();
    let named = numbers.iter().filter(|n| **n == Some(number)).count() == 1;
    match starts_at_one && named {
        true => numbers.iter().position(|n| *n == Some(number)),
        false => number.checked_sub(usize::from(starts_at_one)),
    }
}

fn channel(table: &Table, column: usize) -> Channel {
    Channel {
        unit: endings::unit_of(table, column),
        ..Channel::index(table.number(column))
    }
}

fn ambiguous(table: &Table, role: Role, families: [&Family; 2]) -> Error {
    let first = |family: &Family| family.columns.values().next().copied().unwrap_or(0);
    let [one, other] = families.map(first);
    let found = format!(
        "the {role} of the joints could be {} or {}, and their like",
        describe::column(table, one),
        describe::column(table, other)
    );
    let allowed = format!(
        "name one in robot.toml under [joint.NAME] for each joint, as in: {}",
        describe::line(table, one, role)
    );
    Error::new(Kind::Ambiguous, found, allowed)
}
