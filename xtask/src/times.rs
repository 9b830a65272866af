//! Where the time of the tests goes: every step, and the slowest groups of tests.

use crate::shell;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::fs;
use std::time::Duration;

/// What nextest writes, in the target folder: the time of every test (`.config/nextest.toml`).
const JUNIT: &str = "nextest/default/junit.xml";
/// Groups that are printed.
const SLOWEST: usize = 10;
/// Characters of a step's line.
const WIDTH: usize = 96;

/// Prints the time of every step so far and the ten slowest groups of tests; `whole` is the time of all.
pub fn print(whole: Duration) {
    println!("==> times");
    for (line, time) in shell::steps() {
        let line: String = line.chars().take(WIDTH).collect();
        println!("    {:7.1} s  {line}", time.as_secs_f64());
    }
    println!("    {:7.1} s  everything", whole.as_secs_f64());
    if let Ok(text) = fs::read_to_string(shell::target().join(JUNIT)) {
        print!("{}", slowest(&text));
    }
}

/// The slowest groups of a JUnit file: a group is a module of a crate's tests, its time the sum over its tests.
fn slowest(junit: &str) -> String {
    let mut groups: BTreeMap<String, (f64, usize)> = BTreeMap::new();
    for case in junit.split("<testcase ").skip(1) {
        let value = |name: &str| -> Option<&str> {
            let (_, rest) = case.split_once(&format!("{name}=\""))?;
            Some(rest.split_once('"')?.0)
        };
        let (Some(program), Some(test), Some(time)) = (
            value("classname"),
            value("name"),
            value("time").and_then(|time| time.parse::<f64>().ok()),
        ) else {
            continue;
        };
        let module = test.split_once("::").map_or(test, |(module, _)| module);
        let group = groups.entry(format!("{program} {module}")).or_default();
        group.0 += time;
        group.1 += 1;
    }
    let mut groups: Vec<(String, (f64, usize))> = groups.into_iter().collect();
    groups.sort_by(|a, b| b.1.0.total_cmp(&a.1.0));
    let mut text = String::from("    slowest groups of tests, seconds in their processes:\n");
    for (name, (time, tests)) in groups.into_iter().take(SLOWEST) {
        let _ = writeln!(text, "    {time:7.1} s  {name} ({tests} tests)");
    }
    text
}

#[cfg(test)]
mod tests {
    use super::slowest;

    #[test]
    fn tests_of_a_module_are_one_group() {
        let junit = "<testsuite name=\"a::suite\" time=\"9\">\
            <testcase name=\"x::one\" classname=\"a::suite\" timestamp=\"t\" time=\"1.5\">\
            <testcase name=\"x::two\" classname=\"a::suite\" timestamp=\"t\" time=\"2.5\">\
            <testcase name=\"y::one\" classname=\"b\" timestamp=\"t\" time=\"5\">";
        let text = slowest(junit);
        let lines: Vec<&str> = text.lines().skip(1).map(str::trim).collect();
        assert_eq!(
            lines,
            ["5.0 s  b y (1 tests)", "4.0 s  a::suite x (2 tests)"]
        );
    }
}
