//! A plan for an axis whose parameters are known before it is run: what can be had at best.

use std::path::Path;
use stiction_workflows::plan::{Known, PlanOptions};

/// Names and units of the values, in their order.
const PARAMETERS: [(&str, &str); 7] = [
    ("sigma0", "N/m"),
    ("sigma1", "N·s/m"),
    ("sigma2", "N·s/m"),
    ("coulomb", "N"),
    ("static", "N"),
    ("stribeck_velocity", "m/s"),
    ("mass", "kg"),
];
/// Deviation of each, in parts of it.
const DEVIATION: f64 = 1e-3;

/// Options of a plan with a model of these values, which is written into a folder.
pub fn options(folder: &Path, values: [f64; 7]) -> PlanOptions {
    let mut text = String::from(
        "schema = \"stiction.model/1\"\nkind = \"linear\"\nlaw = \"lugre\"\nforce_unit = \"N\"\ntrustworthy = true\n",
    );
    for ((name, unit), value) in PARAMETERS.iter().zip(values) {
        let std = DEVIATION * value;
        let [low, high] = [value - 1.96 * std, value + 1.96 * std];
        text += &format!(
            "\n[[parameter]]\nname = \"{name}\"\nvalue = {value:?}\nunit = \"{unit}\"\nstd = {std:?}\nci95 = [{low:?}, {high:?}]\n\
             identifiable = true\norigin = \"identified\"\n"
        );
    }
    let file = folder.join("known.toml");
    std::fs::write(&file, text).expect("a file");
    PlanOptions {
        known: Some(Known::Model(file)),
        ..PlanOptions::default()
    }
}
