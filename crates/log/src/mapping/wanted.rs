//! Which columns of a table may be taken, before their samples are known.
//!
//! It names too many rather than too few: what is chosen among several columns may depend on their samples.

use super::channel::{Role, Selector, Sign};
use super::convert::of_role;
use super::{Mapping, bases, choose, endings, names};
use crate::{Table, Unit};

/// What a mapping may take.
pub(super) fn by_mapping(mapping: &Mapping, heads: &Table) -> Vec<bool> {
    let given = |role: Role| mapping.channel(role).is_some();
    let motion = given(Role::Position) || given(Role::Velocity);
    let is_open = |role: &Role| match role {
        Role::Position | Role::Velocity => !motion,
        Role::External => false,
        role => !given(*role) && !mapping.absent.contains(role),
    };
    let open: Vec<Role> = Role::ALL.into_iter().filter(is_open).collect();
    let named = Role::ALL.into_iter().filter_map(|r| mapping.channel(r));
    let mut selectors: Vec<&Selector> = named.map(|channel| &channel.column).collect();
    selectors.extend(mapping.enable.as_ref().map(|enable| &enable.column));
    if let Some(Sign::Column(column)) = mapping.force.as_ref().and_then(|f| f.sign.as_ref()) {
        selectors.push(column);
    }
    let mut out = wanted(heads, &selectors, &open);
    // Time stamps of others than the rows of the log, which nothing else would show.
    if given(Role::Time) {
        let stamps = (0..out.len()).map(|index| bases::is_time(heads, index));
        out.iter_mut()
            .zip(stamps)
            .for_each(|(out, own)| *out |= own);
    }
    if !given(Role::Time) && mapping.rate_hz.is_none() {
        let stamps = (0..out.len()).map(|index| may_run_on(heads, index));
        out.iter_mut()
            .zip(stamps)
            .for_each(|(out, own)| *out |= own);
    }
    if mapping.enable.is_none() {
        // Its numbers tell whether rows are to be left out.
        let status = heads
            .columns
            .iter()
            .map(|column| names::says_status_word(&column.name));
        out.iter_mut()
            .zip(status)
            .for_each(|(out, own)| *out |= own);
    }
    if !motion {
        // Where nothing tells the columns apart, what they count is said.
        let nameless = heads.columns.iter().map(|column| column.name.is_empty());
        out.iter_mut()
            .zip(nameless)
            .for_each(|(out, own)| *out |= own);
    }
    out
}

/// The columns that any of these selectors may mean, and those that could be one of these roles.
pub(crate) fn wanted(heads: &Table, selectors: &[&Selector], open: &[Role]) -> Vec<bool> {
    let one = |index: usize| {
        selectors
            .iter()
            .any(|selector| means(heads, selector, index))
            || open.iter().any(|role| may_be(heads, index, *role))
    };
    (0..heads.columns.len()).map(one).collect()
}

/// Whether a column could be the time, of which its numbers tell where no name or unit of any does.
pub(super) fn may_run_on(heads: &Table, index: usize) -> bool {
    let told = |index| may_be(heads, index, Role::Time);
    told(index) || endings::hint(heads, index).is_none() && !(0..heads.columns.len()).any(told)
}

/// Whether a selector may mean a column: any of the ways in which names are compared, even where another one comes first.
fn means(heads: &Table, selector: &Selector, index: usize) -> bool {
    let column = &heads.columns[index];
    match selector {
        Selector::Index(number) => *number == heads.number(index),
        Selector::Name(name) => {
            let (name, own) = (name.trim(), &column.name);
            let with_unit = |unit: &String| format!("{own} [{unit}]") == name;
            own == name
                || own.to_lowercase() == name.to_lowercase()
                || column.unit.as_ref().is_some_and(with_unit)
                || heads.is_also(index, name)
        }
    }
}

/// Whether a column could be of a role by its name and unit.
fn may_be(heads: &Table, index: usize, role: Role) -> bool {
    let column = &heads.columns[index];
    let unit = column.unit.as_ref().and_then(|unit| Unit::parse(unit).ok());
    let unit = unit.or_else(|| endings::unit(heads, index));
    let dimension = unit.map(|unit| of_role(&unit, role).dimension());
    if dimension.is_some_and(|dimension| !choose::allows(role, dimension)) {
        return false;
    }
    let hint = endings::hint(heads, index);
    let of_axis = names::hint_of_axis(endings::stem(heads, index));
    let by_unit = dimension.is_some() && !choose::is_told_by_name(role);
    hint.is_none_or(|hint| hint.role == role)
        && (hint.is_some() || by_unit || of_axis.is_some_and(|hint| hint.role == role))
}
