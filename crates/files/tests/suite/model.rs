//! What is refused of the text of a model file, each with line, column and key.

use std::fmt::Write;
use stiction_files::ModelFile;
use stiction_files::model::ReadModel;

pub const GOOD: &str = r#"schema = "stiction.model/1"
name = "stage"
kind = "linear"
law = "dahl"
asymmetric = false
force_unit = "N"
trustworthy = true

[source]
version = "0"
method = "separable"
seed = 0
inputs = []

[[parameter]]
name = "sigma0"
symbol = "σ₀"
value = 2e6
unit = "N/m"
std = 1e3
ci95 = [-inf, 2.1e6]
identifiable = true
origin = "identified"

[[parameter]]
name = "coulomb"
symbol = "Fc"
value = 12
unit = "N"
identifiable = true
origin = "identified"

[covariance]
names = ["sigma0", "coulomb"]
matrix = [[1e6, 0.0], [0.0, 0.01]]
"#;

/// The rest of the first parameter.
const GIVEN: &str = "ci95 = [-inf, 2.1e6]\nidentifiable = true\norigin = \"identified\"";

fn refusal(text: &str) -> String {
    let error = ModelFile::parse(text).expect_err(text);
    assert_eq!(error.code().as_str(), "bad-config");
    error.to_string()
}

#[test]
fn a_model_is_read() {
    let model = ModelFile::parse(GOOD).unwrap();
    assert_eq!(model.parameter[1].value, 12.0);
    assert_eq!(model.parameter[0].ci95, Some([f64::NEG_INFINITY, 2.1e6]));
    let again = ModelFile::parse(&model.to_toml()).unwrap();
    assert_eq!(again, model);
}

/// Each kind of fault: of the form, of a value, of values that do not go together.
#[test]
fn faults_have_line_column_and_key() {
    let mut said = String::new();
    for (from, to) in [
        ("kind = \"linear\"", "kind = linear"),
        ("model/1", "model/2"),
        ("name = \"stage\"", "nmae = \"stage\""),
        ("law = \"dahl\"\n", ""),
        ("law = \"dahl\"", "law = \"dale\""),
        ("trustworthy = true", "trustworthy = \"yes\""),
        ("seed = 0", "seed = -1"),
        ("seed = 0", "seed = 0\ntop_speed = -2.0"),
        ("inputs = []", "inputs = [1]"),
        ("inputs = []", "inputs = []\n[range]\nload = [3.0, 1.0]"),
        ("inputs = []", "inputs = []\n[range]\nacceleration = -1"),
        ("inputs = []", "inputs = []\n[pitch]\ncogging = [0.0]"),
        ("inputs = []", "inputs = [{ path = \"a.csv\" }]"),
        ("value = 2e6", "value = \"2e6\""),
        ("value = 2e6", "value = -2e6"),
        ("value = 12\n", ""),
        ("unit = \"N/m\"", "unit = \"N\""),
        ("ci95 = [-inf, 2.1e6]", "ci95 = [2.1e6]"),
        ("ci95 = [-inf, 2.1e6]", "ci95 = [3e6, 2.1e6]"),
        ("name = \"coulomb\"\nsym", "name = \"sigma0\"\nsym"),
        ("[[1e6, 0.0], [0.0, 0.01]]", "[[1e6, 0.0]]"),
        ("[[1e6, 0.0], [0.0, 0.01]]", "[[1e6, 0.0], [\"0\", 0.01]]"),
        ("[covariance]", "[covariants]"),
        (
            GIVEN,
            "ci95 = [-inf, 2.1e6]\nidentifiable = true\norigin = \"guessed\"",
        ),
        (GIVEN, "identifiable = true\norigin = \"given\""),
        (
            GIVEN,
            "ci95 = [-inf, 2.1e6]\ninterval = \"bayes\"\nidentifiable = true\norigin = \"identified\"",
        ),
        (
            GIVEN,
            "interval = \"linear\"\nidentifiable = true\norigin = \"identified\"",
        ),
        ("ci95 = [-inf, 2.1e6]", "ci95 = [-inf, 1.9e6]"),
        ("ci95 = [-inf, 2.1e6]", "ci95 = [1999900.0, 2000100.0]"),
        ("[[1e6, 0.0], [0.0, 0.01]]", "[[0.0, 0.0], [0.0, 0.01]]"),
        ("[[1e6, 0.0], [0.0, 0.01]]", "[[1e8, 0.0], [0.0, 0.01]]"),
        ("[[1e6, 0.0], [0.0, 0.01]]", "[[1e6, 101.0], [101.0, 0.01]]"),
    ] {
        assert_eq!(GOOD.matches(from).count(), 1, "{from}");
        let message = refusal(&GOOD.replace(from, to));
        assert!(message.starts_with("model: line "), "{message}");
        assert!(message.contains("column "), "{message}");
        let _ = writeln!(said, "{message}");
    }
    insta::assert_snapshot!(said);
}

/// A parameter that hangs on another has no variance of its own; one that the data do not determine has none at all.
#[test]
fn a_covariance_may_be_singular() {
    let tied = GOOD.replace("[[1e6, 0.0], [0.0, 0.01]]", "[[1e6, 100.0], [100.0, 0.01]]");
    ModelFile::parse(&tied).unwrap();
    let unknown = GOOD.replace("[[1e6, 0.0], [0.0, 0.01]]", "[[1e6, 0.0], [0.0, 0.0]]");
    assert!(refusal(&unknown).contains("covariance.matrix[2][2]"));
    let last = unknown.rfind("identifiable = true").unwrap();
    let unknown = format!(
        "{}identifiable = false{}",
        &unknown[..last],
        &unknown[last + 19..]
    );
    ModelFile::parse(&unknown).unwrap();
    // Neither two that hang on one another and differ in a third, nor one that varies with nothing.
    let three = "[[1.0, 1.0, 0.0], [1.0, 1.0, 0.9], [0.0, 0.9, 1.0]]";
    let text = GOOD.replace("[[1e6, 0.0], [0.0, 0.01]]", three).replace(
        "names = [\"sigma0\", \"coulomb\"]",
        "names = [\"sigma0\", \"coulomb\", \"offset\"]",
    );
    let text = text.replace("std = 1e3\n", "").replace(
        "[covariance]",
        "[[parameter]]\nname = \"offset\"\nsymbol = \"F0\"\nvalue = 0\nunit = \"N\"\nidentifiable = true\n\
         origin = \"identified\"\n\n[covariance]",
    );
    assert!(
        refusal(&text).contains("no covariance, seen at"),
        "{}",
        refusal(&text)
    );
}

/// What is found wrong later, by whoever uses the model, has its place, too.
#[test]
fn places_are_known_after_reading() {
    let read = ReadModel::parse(GOOD).unwrap();
    let said = |e: stiction_files::Error| e.to_string();
    assert_eq!(
        said(read.refuse("law", "\"dahl\"", "lugre")),
        "model: line 4, column 7, law: \"dahl\"; lugre"
    );
    assert_eq!(
        said(read.refuse_parameter("coulomb", "coulomb = 12", "less")),
        "model: line 28, column 9, parameter[2].value: coulomb = 12; less"
    );
    assert_eq!(
        said(read.refuse_parameter("static", "no static", "one")),
        "model: line 15, column 1, parameter: no static; one"
    );
}

/// Law, parameters and units: nothing else has to be written.
const BY_HAND: &str = r#"law = "lugre"

[[parameter]]
name = "sigma0"
value = 260.0
unit = "N*m/rad"

[[parameter]]
name = "sigma1"
value = 0.6
unit = "N*m*s/rad"

[[parameter]]
name = "sigma2"
value = 0.0176
unit = "N*m*s/rad"

[[parameter]]
name = "coulomb"
value = 0.28
unit = "N*m"

[[parameter]]
name = "static"
value = 0.33
unit = "N*m"

[[parameter]]
name = "stribeck_velocity"
value = 0.01
unit = "rad/s"

[[parameter]]
name = "mass"
value = 0.0023
unit = "kg*m^2"
"#;

#[test]
fn a_model_may_be_written_by_hand() {
    let model = ModelFile::parse(BY_HAND).unwrap();
    assert_eq!(
        (model.kind.as_str(), model.force_unit.as_str()),
        ("rotary", "N*m")
    );
    assert!(model.trustworthy && !model.asymmetric && model.covariance.names.is_empty());
    assert!(
        model
            .parameter
            .iter()
            .all(|p| p.origin == "given" && p.identifiable)
    );
    assert_eq!(ModelFile::parse(&model.to_toml()).unwrap(), model);
    // The units say what it is: a current that drives a linear axis, each direction for itself.
    let linear = "law = \"coulomb-viscous\"\n\
                  [[parameter]]\nname = \"coulomb_pos\"\nvalue = 1.0\nunit = \"A\"\n\
                  [[parameter]]\nname = \"coulomb_neg\"\nvalue = 1.2\nunit = \"A\"\n\
                  [[parameter]]\nname = \"sigma2\"\nvalue = 0.1\nunit = \"A*s/m\"\n";
    let model = ModelFile::parse(linear).unwrap();
    assert_eq!(
        (model.kind.as_str(), model.force_unit.as_str()),
        ("linear", "A")
    );
    assert!(model.asymmetric);
}

/// A delay beyond any drive is refused with its line.
#[test]
fn a_delay_has_limits() {
    let with = |delay: &str| {
        format!("{BY_HAND}\n[[parameter]]\nname = \"delay\"\nvalue = {delay}\nunit = \"s\"\n")
    };
    ModelFile::parse(&with("-0.002")).unwrap();
    for delay in ["1e9", "-5.0"] {
        let said = refusal(&with(delay));
        let line = with(delay)
            .lines()
            .position(|l| l.starts_with(&format!("value = {delay}")));
        let place = format!(
            "line {}, column 9, parameter[8].value: delay = ",
            line.unwrap() + 1
        );
        assert!(said.contains(&place), "{said}");
        assert!(said.contains("from -1 s to 1 s"), "{said}");
    }
}

/// All that is missing and all that is wrong of a file that is written by hand is said at once, each with its line.
#[test]
fn everything_wrong_is_said_at_once() {
    let mut said = String::new();
    for changes in [
        &[("law = \"lugre\"\n", "")] as &[(&str, &str)],
        &[
            ("law = \"lugre\"", "law = \"lugree\""),
            ("value = 260.0", "value = -260.0"),
        ],
        &[
            ("value = 260.0\n", ""),
            (
                "unit = \"N*m*s/rad\"\n\n[[parameter]]\nname = \"sigma2\"",
                "units = \"N*m*s/rad\"\n\n[[parameter]]\nname = \"sigma3\"",
            ),
            (
                "value = 0.28\nunit = \"N*m\"",
                "value = -0.28\nunit = \"N\"",
            ),
        ],
        &[
            (
                "[[parameter]]\nname = \"sigma1\"\nvalue = 0.6\nunit = \"N*m*s/rad\"\n\n",
                "",
            ),
            (
                "[[parameter]]\nname = \"static\"\nvalue = 0.33\nunit = \"N*m\"\n\n",
                "",
            ),
            ("value = 0.01\n", "value = 0\n"),
        ],
        &[
            ("unit = \"kg*m^2\"", "unit = \"kg\""),
            ("value = 0.33", "value = \"0.33 N m\""),
        ],
    ] {
        let mut text = BY_HAND.to_string();
        for (from, to) in changes {
            assert_eq!(text.matches(from).count(), 1, "{from}");
            text = text.replace(from, to);
        }
        let _ = writeln!(said, "{}\n", refusal(&text));
    }
    let _ = writeln!(said, "{}", refusal(""));
    insta::assert_snapshot!(said);
}

/// What a law leaves is drawn from: a shape turned round or a length of nothing would draw something else in silence.
#[test]
fn what_a_law_leaves_has_limits() {
    let shape = "{ force = 1.0, short = 1e-6, long = 1e-5 }";
    let remaining = |level: &str, shapes: &str, length: &str| {
        format!(
            "{GOOD}\n[remaining]\nlevel = {level}\nshapes = [{shapes}]\nplace = 0.1\nplace_length = {length}\nwandering = \
             0.1\nmemory = 0.5\n"
        )
    };
    let good = remaining("0.05", shape, "0.01");
    ModelFile::parse(&good).unwrap();
    let turned = "{ force = 1.0, short = 1e-5, long = 1e-6 }";
    let many = [shape; 17].join(", ");
    for (text, place) in [
        (remaining("1e6", shape, "0.01"), "remaining.level"),
        (remaining("0.05", turned, "0.01"), "long"),
        (remaining("0.05", &many, "0.01"), "remaining.shapes"),
        (remaining("0.05", shape, "1e-300"), "remaining.place_length"),
    ] {
        let message = refusal(&text);
        assert!(message.contains(place), "{message}");
    }
}

/// A model of two Maxwell-slip elements by hand: 4 N at 4 um and 4 N at 10 um.
const ELEMENTS: &str = r#"law = "maxwell-slip"
parameter = [
    { name = "sigma2", value = 30, unit = "N*s/m" },
    { name = "coulomb", value = 8, unit = "N" },
    { name = "sigma0", value = 1.4e6, unit = "N/m" },
    { name = "stiffness_1", value = 1e6, unit = "N/m" },
    { name = "yield_1", value = 4e-6, unit = "m" },
    { name = "stiffness_2", value = 4e5, unit = "N/m" },
    { name = "yield_2", value = 1e-5, unit = "m" },
]
"#;

/// Terms beside a law, with the ranges that a log has seen.
const TERMS: &str = r#"law = "coulomb-viscous"
parameter = [
    { name = "coulomb_pos", value = 8, unit = "N" },
    { name = "coulomb_neg", value = 9, unit = "N" },
    { name = "sigma2", value = 30, unit = "N*s/m" },
    { name = "coulomb_load_pos", value = 0.01, unit = "N/kg" },
    { name = "coulomb_load_neg", value = 0.01, unit = "N/kg" },
    { name = "load_reference", value = 30, unit = "kg" },
    { name = "coulomb_temperature_pos", value = -0.12, unit = "N/K" },
    { name = "coulomb_temperature_neg", value = -0.12, unit = "N/K" },
    { name = "temperature_reference", value = 305, unit = "K" },
    { name = "cogging1_sin", value = 5, unit = "N" },
    { name = "cogging1_cos", value = 0, unit = "N" },
    { name = "position_reference", value = 0.2, unit = "m" },
]

[range]
load = [10, 50]
temperature = [290, 320]
position = [0, 0.4]
"#;

/// What a model has beside its law is held to its units, directions, elements and ranges as the law is.
#[test]
fn terms_and_elements_are_refused_where_they_are_wrong() {
    for good in [ELEMENTS, TERMS] {
        ModelFile::parse(good).unwrap();
    }
    // As four digits have them.
    ModelFile::parse(&ELEMENTS.replace("value = 1.4e6", "value = 1.401e6")).unwrap();
    // Identified at 77 K.
    let cold = "[source]\nversion = \"0\"\nmethod = \"separable\"\nseed = 0\ninputs = []\n[range]";
    let cold = TERMS
        .replace("[range]", cold)
        .replace("[290, 320]", "[70, 320]");
    ModelFile::parse(&cold).unwrap();
    let gravity = "    { name = \"gravity_sin\", value = 5, unit = \"N\" },\n]";
    let eleventh = "    { name = \"stiffness_11\", value = 1, unit = \"N/m\" },\n]";
    let load = "    { name = \"load_reference\", value = 30, unit = \"kg\" },\n";
    let backwards = "    { name = \"coulomb_load_neg\", value = 0.01, unit = \"N/kg\" },\n";
    let mut said = String::new();
    for (good, from, to) in [
        (
            TERMS,
            "-0.12, unit = \"N/K\" },\n    { name = \"coulomb_temperature_neg",
            "-120, unit = \"mN/K\" },\n    { name = \"coulomb_temperature_neg",
        ),
        (
            TERMS,
            "0.01, unit = \"N/kg\" },\n    { name = \"coulomb_load_neg",
            "0.01, unit = \"1\" },\n    { name = \"coulomb_load_neg",
        ),
        (TERMS, "unit = \"kg\"", "unit = \"banana\""),
        (TERMS, "5, unit = \"N\"", "5000, unit = \"mN\""),
        (TERMS, "305, unit = \"K\"", "32, unit = \"degC\""),
        (TERMS, "]\n\n[range]", &format!("{gravity}\n\n[range]")),
        (TERMS, load, ""),
        (TERMS, "[290, 320]", "[15, 45]"),
        (TERMS, "value = 0.2", "value = 0.9"),
        (TERMS, backwards, ""),
        (
            TERMS,
            "coulomb_pos\", value = 8, unit = \"N\" },\n    { name = \"coulomb_neg\", value = 9",
            "coulomb\", value = 8",
        ),
        (
            ELEMENTS,
            "    { name = \"stiffness_1\", value = 1e6, unit = \"N/m\" },\n",
            "",
        ),
        (
            ELEMENTS,
            "    { name = \"yield_2\", value = 1e-5, unit = \"m\" },\n",
            "",
        ),
        (
            ELEMENTS,
            "_2\", value = 4e5, unit = \"N/m\" },\n    { name = \"yield_2",
            "_3\", value = 4e5, unit = \"N/m\" },\n    { name = \"yield_3",
        ),
        (ELEMENTS, "]\n", &format!("{eleventh}\n")),
        (ELEMENTS, "value = 8,", "value = 20,"),
        (ELEMENTS, "value = 1.4e6", "value = 20"),
        (ELEMENTS, "value = 4e-6", "value = 0"),
        (ELEMENTS, "value = 4e-6", "value = 1e-5"),
        (ELEMENTS, "value = 4e5", "value = \"4e5\""),
    ] {
        assert_eq!(good.matches(from).count(), 1, "{from}");
        let _ = writeln!(said, "{}\n", refusal(&good.replace(from, to)));
    }
    insta::assert_snapshot!(said);
}

/// A unit of torque is one however it is written, of the force and of the parameters.
#[test]
fn a_torque_is_written_in_any_way() {
    let rotary = GOOD
        .replace("kind = \"linear\"", "kind = \"rotary\"")
        .replace("unit = \"N/m\"", "unit = \"N m/rad\"");
    for unit in ["N*m", "N m", "Nm", "N·m"] {
        let text = rotary.replace("unit = \"N\"", &format!("unit = \"{unit}\""));
        assert_eq!(ModelFile::parse(&text).unwrap().force_unit, "N*m", "{unit}");
    }
    let wrong = rotary.replace("force_unit = \"N\"", "force_unit = \"kg m\"");
    assert!(refusal(&wrong).contains("force_unit: \"kg m\"; \"N*m\""));
}

/// A gap is kept, of a hand-written model also without an interval; a model without one reads as before.
#[test]
fn a_gap_is_read() {
    assert_eq!(ModelFile::parse(GOOD).unwrap().backlash, None);
    let with =
        |lines: &str| GOOD.replace("inputs = []", &format!("inputs = []\n[backlash]\n{lines}"));
    let model =
        ModelFile::parse(&with("width = 2e-5\nci95 = [1.8e-5, 2.2e-5]\nload = 0.3")).unwrap();
    let gap = model.backlash.unwrap();
    assert_eq!(
        (gap.width, gap.ci95, gap.load),
        (2e-5, Some([1.8e-5, 2.2e-5]), Some(0.3))
    );
    assert_eq!(ModelFile::parse(&model.to_toml()).unwrap(), model);
    let measured = ModelFile::parse(&with("width = 2e-5"))
        .unwrap()
        .backlash
        .unwrap();
    assert_eq!((measured.ci95, measured.load), (None, None));
    for (lines, place, allowed) in [
        ("width = 0.0", "backlash.width", "1e-12"),
        ("width = nan", "backlash.width", "1e-12"),
        ("ci95 = [0.0, 1.0]", "backlash", "width"),
        (
            "width = 1.0\nci95 = [2.0, 3.0]",
            "backlash.ci95",
            "around the width",
        ),
        ("width = 1.0\nload = 1.0", "backlash.load", "below 1"),
        ("width = 1.0\nplay = 1.0", "backlash.play", "play"),
    ] {
        let said = refusal(&with(lines));
        assert!(said.contains(place) && said.contains(allowed), "{said}");
    }
}
