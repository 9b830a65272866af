//! Channels of a TwinCAT Scope export that share time stamps, once the samples are read.

use super::problem;
use crate::{Scalar, Table};
use std::collections::BTreeMap;

/// What an export says beyond the names and units of its columns.
#[derive(Default)]
pub(crate) struct Scope {
    pub groups: Vec<Group>,
    /// Sample time of each column in milliseconds, where stated.
    pub sample_times: Vec<Option<f64>>,
}

/// Channels that share their time stamps.
#[derive(Default)]
pub(crate) struct Group {
    /// The column of time stamps, where there is one.
    pub time: Option<usize>,
    pub channels: Vec<usize>,
}

impl Scope {
    /// Trims groups that ran out, joins equal time columns, and states the sample time.
    pub(crate) fn finish(&self, table: &mut Table) {
        for group in &self.groups {
            trim(group, table);
        }
        let equals = equal_stamps(self, table);
        match &equals[..] {
            [one] if one.times.len() > 1 => {
                let joined = format!("{} equal time columns joined", one.times.len());
                table.detected.push(joined);
            }
            [] | [_] => {}
            several => {
                let said = format!("{} time columns that differ", several.len());
                table.detected.push(said);
                for stamps in several {
                    let Some(first) = stamps.channels.first() else {
                        continue;
                    };
                    let name = format!("time of {}", table.columns[*first].name);
                    let of: Vec<String> =
                        stamps.channels.iter().map(|&c| shown(table, c)).collect();
                    table
                        .detected
                        .push(format!("`{name}` applies to {}", problem::list(&of)));
                    table.columns[stamps.times[0]].name = name;
                }
            }
        }
        let times: Vec<(usize, f64)> = self
            .sample_times
            .iter()
            .enumerate()
            .filter_map(|(c, t)| t.map(|t| (c, t)))
            .collect();
        match times[..] {
            [] => {}
            [(_, ms), ..] if times.iter().all(|(_, t)| *t == ms) => {
                table.sample_time = Some(ms / 1e3)
            }
            _ => table.scalars.extend(times.iter().map(|&(c, ms)| Scalar {
                name: format!("SampleTime[ms] of {}", table.columns[c].name),
                value: ms,
            })),
        }
        let mut column = 0;
        table.columns.retain(|_| {
            column += 1;
            !equals.iter().any(|e| e.times[1..].contains(&(column - 1)))
        });
    }
}

/// Time columns with the same stamps, and the channels they hold for.
struct Stamps {
    times: Vec<usize>,
    channels: Vec<usize>,
}

fn equal_stamps(scope: &Scope, table: &Table) -> Vec<Stamps> {
    let bits = |c: usize| table.columns[c].values.iter().map(|v| v.to_bits());
    let mut found: Vec<Stamps> = Vec::new();
    // Columns are compared only where a hash (FNV-1a) of all their stamps agrees.
    let mut by_hash: BTreeMap<u64, Vec<usize>> = BTreeMap::new();
    for group in &scope.groups {
        let Some(time) = group.time else { continue };
        let hash = bits(time).fold(0xCBF2_9CE4_8422_2325_u64, |hash, bits| {
            (hash ^ bits).wrapping_mul(0x0100_0000_01B3)
        });
        let near = by_hash.entry(hash).or_default();
        match near
            .iter()
            .find(|&&n| bits(found[n].times[0]).eq(bits(time)))
        {
            Some(&same) => {
                found[same].times.push(time);
                found[same].channels.extend(&group.channels);
            }
            None => {
                near.push(found.len());
                let channels = group.channels.clone();
                found.push(Stamps {
                    times: vec![time],
                    channels,
                });
            }
        }
    }
    found
}

fn shown(table: &Table, column: usize) -> String {
    problem::show(table.columns[column].name.as_bytes())
}

/// Cuts the empty end of a group: its time column tells where it ends, or else its channels.
fn trim(group: &Group, table: &mut Table) {
    let filled = |c: usize| {
        table.columns[c]
            .values
            .iter()
            .rposition(|v| !v.is_nan())
            .map_or(0, |last| last + 1)
    };
    let end = match group.time {
        Some(time) => filled(time),
        None => group.channels.iter().map(|&c| filled(c)).max().unwrap_or(0),
    };
    for &c in group.channels.iter().chain(&group.time) {
        table.columns[c].values.truncate(end);
    }
}
