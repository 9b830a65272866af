//! Levels of one axis file that are too far apart to be of one unit.

use super::row::LogRow;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Ratio of the largest to the smallest level from which on one of them is probably in another unit. Friction and mass of machines
/// of one kind differ by tens at most, units by a thousand.
const APART: f64 = 100.0;
/// What is compared: what a change of machine changes little, and a wrong unit by powers of ten.
const COMPARED: [&str; 4] = ["mass", "coulomb", "coulomb_pos", "coulomb_neg"];

/// A parameter that logs with one axis file have more than a hundred times apart.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Apart {
    /// Name, such as `mass`.
    pub parameter: String,
    /// SI unit.
    pub unit: String,
    /// Axis file; none where the logs have none.
    pub axis: Option<String>,
    /// Logs that have it.
    pub logs: usize,
    /// The smallest level.
    pub least: f64,
    /// The log that has it.
    pub least_log: String,
    /// The largest level.
    pub most: f64,
    /// The log that has it.
    pub most_log: String,
}

impl Apart {
    /// How many times as large as the smallest the largest is.
    pub fn ratio(&self) -> f64 {
        self.most / self.least
    }
}

/// The smallest and the largest level of each parameter that is compared, row by row.
#[derive(Clone, Debug, Default)]
pub struct Levels {
    of: BTreeMap<(Option<String>, String, String), Apart>,
}

impl Levels {
    /// Takes what was identified of a log, where the log determines it.
    pub fn take(&mut self, row: &LogRow) {
        let compared = row.parameters.iter().filter(|p| {
            COMPARED.contains(&p.name.as_str()) && p.identifiable && p.origin == "identified"
        });
        for parameter in compared {
            let Some(level) = parameter.value.filter(|x| x.is_finite() && *x > 0.0) else {
                continue;
            };
            let place = (
                row.axis.clone(),
                parameter.name.clone(),
                parameter.unit.clone(),
            );
            let known = self.of.entry(place).or_insert_with(|| Apart {
                parameter: parameter.name.clone(),
                unit: parameter.unit.clone(),
                axis: row.axis.clone(),
                logs: 0,
                least: level,
                least_log: row.path.clone(),
                most: level,
                most_log: row.path.clone(),
            });
            known.logs += 1;
            if level < known.least {
                (known.least, known.least_log) = (level, row.path.clone());
            }
            if level > known.most {
                (known.most, known.most_log) = (level, row.path.clone());
            }
        }
    }

    /// Those that are too far apart.
    pub fn apart(&self) -> Vec<Apart> {
        let apart = self.of.values().filter(|levels| levels.ratio() > APART);
        apart.cloned().collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::batch::ParameterRow;

    fn row(path: &str, axis: Option<&str>, name: &str, value: f64) -> LogRow {
        LogRow {
            path: path.into(),
            axis: axis.map(String::from),
            parameters: vec![ParameterRow {
                name: name.into(),
                value: Some(value),
                unit: "kg".into(),
                identifiable: true,
                origin: "identified".into(),
                ..ParameterRow::default()
            }],
            ..LogRow::default()
        }
    }

    #[test]
    fn levels_of_one_axis_file_are_compared_and_no_others() {
        let apart = |rows: &[LogRow]| {
            let mut levels = Levels::default();
            rows.iter().for_each(|row| levels.take(row));
            levels.apart()
        };
        let rows = [
            row("b.csv", Some("x.toml"), "mass", 20.5),
            row("a.csv", Some("x.toml"), "mass", 0.0205),
            row("c.csv", Some("x.toml"), "mass", 20.4),
        ];
        let found = apart(&rows);
        assert_eq!(found.len(), 1);
        let names = (found[0].least_log.as_str(), found[0].most_log.as_str());
        assert_eq!((names, found[0].logs), (("a.csv", "b.csv"), 3));
        let mut unknown = rows.clone();
        unknown[1].parameters[0].identifiable = false;
        assert_eq!(apart(&unknown), []);
        let mut other = rows.clone();
        other[1].axis = Some("y.toml".into());
        assert_eq!(apart(&other), []);
        let mut near = rows;
        near[1].parameters[0].value = Some(0.21);
        assert_eq!(apart(&near), []);
    }
}
