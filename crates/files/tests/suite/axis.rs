//! The axis file: every refusal names file, line, key, what was found and what is allowed; nothing
//! that can be typed makes it fall over; what `check --init` writes can always be read again.

use proptest::prelude::*;
use std::fmt::Write;
use stiction_files::axis::{Found, ListedLog, Use, template};
use stiction_files::{Axis, Error};
use stiction_formats::{Column, Table, Unit, Value};
use stiction_identify::{Cutoff, Hold, Source};
use stiction_log::{Channel, Log, Mapping, Motion, Offset, Parts, Role, Selector, Sign, Wrap};
use stiction_search::Method;
use stiction_search::genetic::{self, Annealing, Crossover, Rates, Ratio, Selection};

/// Every key once.
const WHOLE: &str = r#"name = "X axis"
kind = "rotary"
rate = "2 kHz"
mass = "3 kg cm2"

[columns]
time = "t [ms]"
position = { column = 2, unit = "deg" }
velocity = 3
force = { column = "Iq", unit = "A", scale = "0.5 N m/A", invert = true }
reference = { column = "set", unit = "rev", scale = 2.5 }
temperature = "temp"
load = 9
enable = { column = "mode", equals = 8 }

[log]
crop = ["500 ms", "1 min"]
rests = "cut"
wrap = "360 deg"
force_limit = "4 N m"
resolution = "0.1 mrad"

[text]
separator = "semicolon"
decimal = "comma"
header = true
preamble = 3

[conditioning]
source = "velocity"
source_cutoff = "off"
common_cutoff = "50 Hz"
decimate = 4
min_speed = "60 rpm"

[terms]
offset = true
gravity = true
cogging = ["90 deg", "15 deg"]
stribeck_exponent = 1.5
gms_elements = 4

[report]
low_speed = "1 rad/s"

[controller]
kind = "p-pi"
position_gain = "40 1/s"
speed_gain = "0.6 N m s/rad"
integral_gain = "20 A/rad"
velocity_feedforward = 0.5
mass_feedforward = "2 kg cm2"
force_limit = "8 A"
rate = "8 kHz"

[simulation]
force = "centred"
segment = "500 ms"
"#;

fn parse(text: &str) -> Result<Axis, Error> {
    Axis::parse(text)
}

/// A column that the log may lack is left out by a word; the columns that it needs are not.
#[test]
fn none_leaves_out_a_column_that_would_be_found() {
    let text = "[columns]\nreference = \"none\"\nforce = \"none\"\n";
    let mapping = Axis::parse(text).unwrap().mapping;
    assert_eq!(mapping.absent, [Role::Reference]);
    assert_eq!(mapping.reference, None);
    assert_eq!(mapping.force, Some(Channel::named("none")));
}

#[test]
fn every_key_is_understood() {
    use std::f64::consts::PI;
    let axis = parse(WHOLE).unwrap();
    let near = |x: f64, y: f64| (x - y).abs() <= 1e-12 * y.abs();
    assert_eq!(axis.name.as_deref(), Some("X axis"));
    assert_eq!(axis.mapping.motion, Some(Motion::Rotary));
    assert_eq!(axis.mapping.rate_hz, Some(2000.0));
    assert_eq!(axis.mapping.crop, Some((0.5, 60.0)));
    assert_eq!(axis.mapping.rests, Some(stiction_log::Rests::Cut));
    let Some(Wrap::Travel(travel)) = axis.mapping.wrap else {
        panic!("{:?}", axis.mapping.wrap)
    };
    assert!(near(travel, 2.0 * PI));
    let counts = parse("[log]\nwrap = \"65536 counts\"\n").unwrap();
    assert_eq!(counts.mapping.wrap, Some(Wrap::Counts(65536.0)));
    assert!(near(axis.mapping.resolution.unwrap(), 1e-4));
    assert!(near(axis.mapping.force_limit.unwrap(), 4.0));
    let force = axis.mapping.force.as_ref().unwrap();
    assert_eq!(force.column, Selector::Name("Iq".into()));
    assert!(force.invert);
    assert_eq!(
        axis.mapping.velocity.as_ref().unwrap().column,
        Selector::Index(3)
    );
    let enable = axis.mapping.enable.as_ref().unwrap();
    assert_eq!(enable.column, Selector::Name("mode".into()));
    assert_eq!(enable.equals, Some(8.0));
    assert_eq!(axis.text.header, Some(true));
    assert_eq!(axis.text.preamble, Some(3));
    assert_eq!(axis.conditioning.source, Some(Source::Velocity));
    assert_eq!(axis.conditioning.source_cutoff, Cutoff::Off);
    assert_eq!(axis.conditioning.common_cutoff, Cutoff::Hz(50.0));
    assert_eq!(axis.conditioning.decimate, Some(4));
    assert!(near(axis.conditioning.min_speed, 2.0 * PI));
    assert!(axis.terms.gravity);
    assert!(near(axis.terms.cogging[1], PI / 12.0));
    assert_eq!(axis.stribeck_exponent, Some(1.5));
    assert_eq!(axis.gms_elements, Some(4));
    assert_eq!(axis.low_speed, Some(1.0));
    assert_eq!(axis.hold, Hold::Centred);
    assert_eq!(axis.segment, Some(0.5));
}

#[test]
fn logs_are_listed_with_their_parts() {
    let text = r#"
[columns]
force = "F"

[[log]]
file = "a.csv"
crop = ["1 s", "1 min"]
fit = ["1 s", "20 s"]
validate = [["20 s", "25 s"], ["30 s", "60 s"]]
resolution = "2 um"

[[log]]
file = "b.csv"
validate = ["500 ms", "2 s"]
resolution = "1 um"

[[log]]
file = "/there/c.csv"
validate = "all"

[[log]]
file = "d.csv"
"#;
    let axis = parse(text).unwrap();
    let [a, b, c, d] = axis.logs.as_slice() else {
        panic!("{:?}", axis.logs);
    };
    let parts = |log: &ListedLog, part| log.mapping(part).map(|mapping| mapping.parts);
    assert_eq!(
        parts(a, Use::Fitted),
        Some(Some(Parts::inside(vec![(1.0, 20.0)])))
    );
    let held_out = vec![(20.0, 25.0), (30.0, 60.0)];
    assert_eq!(
        parts(a, Use::Validated),
        Some(Some(Parts::inside(held_out)))
    );
    assert_eq!(a.words(Use::Validated).unwrap(), "20 to 25 s, 30 to 60 s");
    let mapping = a.mapping(Use::Fitted).unwrap();
    assert_eq!(mapping.crop, Some((1.0, 60.0)));
    assert_eq!(
        mapping.force.unwrap().column,
        Selector::Name("F".into()),
        "what holds for every log"
    );
    assert_eq!(
        parts(b, Use::Fitted),
        Some(Some(Parts::outside(vec![(0.5, 2.0)])))
    );
    assert_eq!(b.words(Use::Fitted).unwrap(), "all but 0.5 to 2 s");
    assert_eq!(
        (parts(c, Use::Fitted), parts(c, Use::Validated)),
        (None, Some(None))
    );
    assert_eq!(c.file, std::path::Path::new("/there/c.csv"));
    assert_eq!(
        (parts(d, Use::Fitted), parts(d, Use::Validated)),
        (Some(None), None)
    );
    assert!(a.has_parts() && b.has_parts() && c.has_parts() && !d.has_parts());
    assert_eq!(a.written("log.parts", Use::Fitted), "log[1].fit");
    assert_eq!(b.written("log.parts", Use::Fitted), "log[2].validate");
    assert_eq!(b.written("log.crop", Use::Fitted), "log[2].crop");
    // The finest of all steps.
    assert_eq!(axis.conditioning.resolution, Some(1e-6));
}

/// A log whose force is `unit`, after the scale of the axis file.
fn log(axis: &Axis, names: [&str; 3]) -> Log {
    let column = |name: &str, values: fn(usize) -> f64| Column {
        name: name.into(),
        unit: None,
        values: (0..100).map(values).collect(),
        ..Column::default()
    };
    let table = Table {
        columns: vec![
            column(names[0], |i| i as f64 * 1e-3),
            column(names[1], |i| (i as f64 * 0.1).sin()),
            column(names[2], |i| (i as f64 * 0.1).cos()),
        ],
        ..Table::default()
    };
    Log::from_table(&table, &axis.mapping).unwrap()
}

#[test]
fn gains_come_in_the_unit_of_the_force_or_of_the_file() {
    let text = |gains: &str| {
        format!(
            "kind = \"rotary\"\n[columns]\ntime = {{ column = \"t\", unit = \"s\" }}\n\
             position = {{ column = \"q\", unit = \"rad\" }}\n\
             force = {{ column = \"i\", unit = \"A\", scale = \"0.5 N m/A\" }}\n\
             [controller]\nkind = \"p-pi\"\nposition_gain = \"40 1/s\"\n{gains}"
        )
    };
    let both = [
        "speed_gain = \"0.6 N m s/rad\"\nintegral_gain = \"10 N m/rad\"\n\
         mass_feedforward = \"2 kg cm2\"\nforce_limit = \"4 N m\"",
        "speed_gain = \"1.2 A s/rad\"\nintegral_gain = \"20 A/rad\"\n\
         mass_feedforward = \"0.4 mA s2/rad\"\nforce_limit = \"8 A\"",
    ];
    for gains in both {
        let axis = parse(&text(gains)).unwrap();
        let log = log(&axis, ["t", "q", "i"]);
        let c = axis.controller_for(&log).unwrap().unwrap();
        let near = |a: f64, b: f64| assert!((a / b - 1.0).abs() < 1e-12, "{a} {b} {gains}");
        near(c.position_gain, 40.0);
        near(c.speed_gain, 0.6);
        near(c.integral_gain, 10.0);
        near(c.mass_feedforward, 2e-4);
        near(c.force_limit, 4.0);
        assert_eq!(c.rate, None);
    }
    let wrong = text("speed_gain = \"0.6 N s/m\"\nintegral_gain = \"10 N m/rad\"");
    let axis = parse(&wrong).unwrap();
    let e = axis
        .controller_for(&log(&axis, ["t", "q", "i"]))
        .unwrap_err();
    insta::assert_snapshot!(
        e.to_string(),
        @r#"axis: line 9, column 14, controller.speed_gain: "0.6 N s/m"; give it in N*m*s/rad, or in A/(rad/s), the unit of the log before scaling"#
    );
    assert!(
        Axis::default()
            .controller_for(&log(&axis, ["t", "q", "i"]))
            .unwrap()
            .is_none()
    );
}

/// The examples of the documentation are axis files.
/// Settings of a search, and a name that is none.
#[test]
fn searches_have_settings() {
    let text = "[search.annealing-ga]\npopulation = 80\nelite = 8\nselection = \"roulette\"\n\
                crossover = \"heuristic\"\ncrossover_ratio = 0.3\ncrossover_rate = 0.8\n\
                mutation_rate = [0.02, 0.2]\ntemperature = 9.0\ncooling = 0.9\nshrink = \"none\"\n\
                [search.de]\nscale = [0.4, 0.9]\n";
    let axis = parse(text).unwrap();
    let expected = genetic::Settings {
        population: 80,
        elite: 8,
        selection: Selection::Roulette,
        crossover: Crossover::Heuristic,
        ratio: Ratio::Constant(0.3),
        crossover_rate: Rates::fixed(0.8),
        mutation_rate: Rates {
            low: 0.02,
            high: 0.2,
        },
        annealing: Some(Annealing {
            start: 9.0,
            factor: 0.9,
        }),
        precision: None,
        ..genetic::Settings::default()
    };
    let found = axis.search_method("annealing-ga");
    assert_eq!(found, Some(Method::AnnealingGa(expected)));
    let usual = Method::named("ga");
    assert_eq!(axis.search_method("ga"), usual);
    assert_eq!(axis.search_method("gaa"), None);
    let Some(Method::De(de)) = axis.search_method("de") else {
        panic!("de has settings");
    };
    assert_eq!(de.scale, [0.4, 0.9]);
}

#[test]
fn settings_of_searches_are_refused_at_their_keys() {
    let texts = [
        "[search]\ngaa = 1",
        "[search.ga]\npopulation = 3",
        "[search.ga]\nelite = 60",
        "[search.ga]\nselection_pressure = 1.2",
        "[search.annealing-ga]\ntemperature = 0",
        "[search.annealing-ga]\ntemperature = \"none\"\ncooling = 0.9",
        "[search.annealing-ga]\nshrink = 2",
        "[search.annealing-ga]\ncrossover_rate = [0.9, 0.6]",
        "[search.annealing-ga]\nmutation_rate = [0.9]",
        "[search.cma-es]\npopulation = 2",
        "[search.nelder-mead]\nedge = 0.7",
        "[search.nelder-mead]\nedge = 1e300",
        "[search.niched-ga]\nniches = 9223372036854775807",
        "[search.cma-es]\nrestarts = -1",
        "[search.de]\ncrossover = \"much\"",
        "[search.box]\nsigma3 = [\"1 N\", \"2 N\"]",
        "[search.box]\ncoulomb = [\"2 N\", \"1 N\"]",
        "[search.box]\ncoulomb = [\"1 N\", \"2 m\"]",
        "[search.box]\ncoulomb = \"1 N\"",
    ];
    let messages = texts.map(|text| parse(text).unwrap_err().to_string());
    insta::assert_snapshot!(messages.join("\n"));
}

#[test]
fn documented_examples_are_accepted() {
    let file = stiction_testkit::workspace().join("docs/axis.md");
    let text = std::fs::read_to_string(&file).unwrap();
    let mut seen = 0;
    for block in text.split("```toml\n").skip(1) {
        let example = block.split("```").next().unwrap();
        parse(example).unwrap_or_else(|e| panic!("{e}\n{example}"));
        seen += 1;
    }
    assert!(seen > 0, "no example in {}", file.display());
}

/// Lists within lists, in the second line.
const DEEP: &str = "# [\"\nname = [[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[";

#[test]
fn refusals() {
    let deep_tables = format!("kind = \"linear\"\nx{} = 1", ".a".repeat(200));
    let cases: &[(&str, &str)] = &[
        ("unknown key", "nmae = \"X\""),
        ("unknown table", "[colums]\ntime = 1"),
        ("unknown key in a table", "[log]\n\nwarp = \"360 deg\""),
        (
            "unknown key of a column",
            "[columns]\nforce = { column = 1, units = \"N\" }",
        ),
        ("number for a value with unit", "rate = 1000"),
        ("text for a switch", "[terms]\ngravity = \"yes\""),
        ("text for a number", "[terms]\nstribeck_exponent = \"2\""),
        ("float for a column", "[columns]\nforce = 1.5"),
        ("list for a column", "[columns]\nforce = [1, 2]"),
        (
            "table without column",
            "[columns]\nforce = { unit = \"N\" }",
        ),
        ("log as a number", "log = 3"),
        ("a log without a file", "[[log]]\ncrop = [\"1 s\", \"2 s\"]"),
        (
            "a log twice",
            "[[log]]\nfile = \"a\"\n[[log]]\nfile = \"a\"",
        ),
        (
            "fit beyond crop",
            "[[log]]\nfile = \"a\"\ncrop = [\"1 s\", \"9 s\"]\nfit = [[\"1 s\", \"2 s\"], [\"8 s\", \"10 s\"]]",
        ),
        (
            "fit and validate the same",
            "[[log]]\nfile = \"a\"\nfit = [\"1 s\", \"9 s\"]\nvalidate = [\"8 s\", \"10 s\"]",
        ),
        (
            "fit and validate all",
            "[[log]]\nfile = \"a\"\nfit = [\"1 s\", \"9 s\"]\nvalidate = \"all\"",
        ),
        (
            "validate in words",
            "[[log]]\nfile = \"a\"\nvalidate = \"rest\"",
        ),
        (
            "validate without unit",
            "[[log]]\nfile = \"a\"\nvalidate = [1, 2]",
        ),
        ("fit of every log", "[log]\nfit = [\"1 s\", \"2 s\"]"),
        (
            "an offset without a file",
            "[columns]\nforce = { column = 1, offset = \"12 ms\" }",
        ),
        (
            "an offset without a unit",
            "[columns]\nforce = { file = \"a\", column = 1, offset = 12 }",
        ),
        (
            "an offset in a word",
            "[columns]\nforce = { file = \"a\", column = 1, offset = \"estimated\" }",
        ),
        (
            "the time of another file",
            "[columns]\ntime = { file = \"a\", column = 1 }",
        ),
        ("enable as a flag", "[columns]\nenable = true"),
        (
            "enable as a quantity",
            "[columns]\nenable = { column = 3, unit = \"N\" }",
        ),
        (
            "enable equal to a word",
            "[columns]\nenable = { column = 3, equals = \"CSP\" }",
        ),
        ("column 0", "[columns]\ntime = 1\nforce = 0"),
        ("column -1", "[columns]\nforce = { column = -1 }"),
        ("unit of another dimension", "[log]\nwrap = \"360 N\""),
        (
            "unknown unit",
            "[columns]\nforce = { column = 4, unit = \"Newtn\" }",
        ),
        (
            "ambiguous unit",
            "[columns]\nforce = { column = 4, unit = \"N/m s\" }",
        ),
        ("no unit", "[conditioning]\nsource_cutoff = \"100\""),
        (
            "scale 0",
            "[columns]\nforce = { column = 4, unit = \"A\", scale = 0.0 }",
        ),
        (
            "scale nan",
            "[columns]\nforce = { column = 4, unit = \"A\", scale = nan }",
        ),
        (
            "scale without number",
            "[columns]\nforce = { column = 4, unit = \"A\", scale = \"N/A\" }",
        ),
        ("decimal comma", "mass = \"4,6 kg\""),
        ("negative rate", "rate = \"-1 kHz\""),
        ("negative mass", "mass = \"-4 kg\""),
        ("huge mass", "mass = \"1e400 kg\""),
        ("mass of another kind", "mass = \"4 N\""),
        ("kind", "kind = \"Linear\""),
        ("crop of one time", "[log]\ncrop = [\"1 s\"]"),
        ("crop turned round", "[log]\ncrop = [\"20 s\", \"1 s\"]"),
        ("crop in numbers", "[log]\ncrop = [1, 20]"),
        ("rests of another word", "[log]\nrests = \"drop\""),
        ("crop in mm", "[log]\ncrop = [\"1 mm\", \"20 s\"]"),
        ("wrap 0", "[log]\nwrap = \"0 deg\""),
        ("separator", "[text]\nseparator = \"::\""),
        ("decimal", "[text]\ndecimal = \"dot\""),
        ("preamble -1", "[text]\npreamble = -1"),
        ("source", "[conditioning]\nsource = \"both\""),
        ("cut-off", "[conditioning]\ncommon_cutoff = \"on\""),
        ("decimate 0", "[conditioning]\ndecimate = 0"),
        (
            "decimate huge",
            "[conditioning]\ndecimate = 9223372036854775807",
        ),
        ("min speed in mm", "[conditioning]\nmin_speed = \"1 mm\""),
        (
            "five pitches",
            "[terms]\ncogging = [\"1 mm\", \"2 mm\", \"3 mm\", \"4 mm\", \"5 mm\"]",
        ),
        ("pitch twice", "[terms]\ncogging = [\"24 mm\", \"2.4 cm\"]"),
        ("pitch 0", "[terms]\ncogging = [\"0 mm\"]"),
        ("exponent 0", "[terms]\nstribeck_exponent = 0.0"),
        ("exponent nan", "[terms]\nstribeck_exponent = nan"),
        (
            "controller",
            "[controller]\nkind = \"pid\"\nposition_gain = \"1 1/s\"\nspeed_gain = \"1 N s/m\"",
        ),
        (
            "controller without its integral",
            "[controller]\nkind = \"p-pi\"\nposition_gain = \"1 1/s\"\nspeed_gain = \"1 N s/m\"",
        ),
        (
            "controller with an integral too many",
            "[controller]\nkind = \"p-p\"\nposition_gain = \"1 1/s\"\nspeed_gain = \"1 N s/m\"\n\
             integral_gain = \"1 N/m\"",
        ),
        (
            "gain 0",
            "[controller]\nkind = \"p-p\"\nposition_gain = \"1 1/s\"\nspeed_gain = \"0 N s/m\"",
        ),
        (
            "gain of another kind",
            "[controller]\nkind = \"p-p\"\nposition_gain = \"1 N\"\nspeed_gain = \"1 N s/m\"",
        ),
        ("controller without gains", "[controller]\nkind = \"p-p\""),
        (
            "feedforward 2",
            "[controller]\nkind = \"p-p\"\nposition_gain = \"1 1/s\"\nspeed_gain = \"1 N s/m\"\n\
             velocity_feedforward = 2.0",
        ),
        ("hold", "[simulation]\nforce = \"hold\""),
        ("segment", "[simulation]\nsegment = \"0 s\""),
        ("two elements", "[terms]\ngms_elements = 2"),
        ("eleven elements", "[terms]\ngms_elements = 11"),
        ("less than no elements", "[terms]\ngms_elements = -1"),
        ("elements in words", "[terms]\ngms_elements = \"auto\""),
        ("low speed", "[report]\nlow_speed = \"-1 mm/s\""),
        ("the same key twice", "name = \"a\"\n\nname = \"b\""),
        (
            "the same column under two names",
            "[columns]\nforce = 1\ntorque = 2",
        ),
        ("no TOML", "kind: linear\n"),
        ("open text", "name = \"X"),
        ("sub-table", "[columns.force]\ncolumn = 4\nunit = \"mm/\""),
        ("dotted key", "columns.force = 0"),
        (
            "scale beyond any machine",
            "[columns]\nforce = { column = 4, unit = \"V\", scale = 1e-170 }",
        ),
        (
            "scale beyond any machine with its unit",
            "[columns]\nforce = { column = 4, unit = \"V\", scale = \"-1e16 N/V\" }",
        ),
        (
            "scale 0 with its unit",
            "[columns]\nforce = { column = 4, unit = \"N\", scale = \"0 N/N\" }",
        ),
        (
            "gain beyond any machine",
            "[controller]\nkind = \"p-p\"\nposition_gain = \"1 1/s\"\nspeed_gain = \"1e-170 N s/m\"",
        ),
        ("rate beyond any log", "rate = \"1e-4 Hz\""),
        ("wrap beyond any axis", "[log]\nwrap = \"1e10 m\""),
        ("pitch beyond any axis", "[terms]\ncogging = [\"1e14 m\"]"),
        (
            "crop before the first sample",
            "[log]\ncrop = [\"-1 s\", \"20 s\"]",
        ),
        ("preamble too long", "[text]\npreamble = 1001"),
        (
            "two commas",
            "[text]\nseparator = \"comma\"\ndecimal = \",\"",
        ),
        ("cut-off 0", "[conditioning]\nsource_cutoff = \"0 Hz\""),
        ("mass in words", "mass = \"known\""),
        ("delay in words", "[terms]\ndelay = \"some\""),
        ("delay too long", "[terms]\ndelay = \"2 s\""),
        ("segment in words", "[simulation]\nsegment = \"all\""),
        ("name that steers a terminal", "name = \"X\\u001b[2J\""),
        ("table twice", "[log]\nwrap = \"1 m\"\n[ log ]"),
        ("lists too deep in each other", DEEP),
        ("tables too deep in each other", &deep_tables),
    ];
    let mut out = String::new();
    for (what, text) in cases {
        let error = parse(text).expect_err(what);
        assert_eq!(error.code().as_str(), "bad-config", "{what}");
        let message = error.to_string();
        assert!(message.starts_with("axis: "), "{message}");
        assert!(!message.contains('\n'), "{message}");
        let _ = writeln!(out, "{what}\n    {message}");
    }
    insta::assert_snapshot!(out);
}

/// What only a log shows to be wrong is said at the key of the axis file.
#[test]
fn a_log_is_refused_at_the_key() {
    let table = Table {
        columns: ["t", "q", "F"]
            .map(|name| Column {
                name: name.into(),
                unit: None,
                values: (0..100).map(|i| f64::from(i) * 1e-3).collect(),
                ..Column::default()
            })
            .to_vec(),
        ..Table::default()
    };
    let columns = |force: &str, more: &str| {
        format!(
            "kind = \"linear\"\n[columns]\ntime = {{ column = \"t\", unit = \"s\" }}\n\
             position = {{ column = \"q\", unit = \"m\" }}\n{force}\n{more}"
        )
    };
    let force = "force = { column = \"F\", unit = \"N\" }";
    let mut said = String::new();
    for text in [
        columns(force, "[log]\ncrop = [\"3 s\", \"4 s\"]"),
        columns("torque = \"M\"", ""),
        columns("current = { column = 9, unit = \"A\" }", ""),
        columns(
            "force = { column = \"F\", unit = \"A\", scale = \"2 m/A\" }",
            "",
        ),
        columns("force = { column = \"F\", unit = \"K\" }", ""),
        format!("rate = \"1 kHz\"\n{}", columns(force, "")),
    ] {
        let axis = parse(&text).unwrap();
        let error = Log::from_table(&table, &axis.mapping).unwrap_err();
        let error = axis.at_key(error.in_file("log.csv".as_ref()));
        let _ = writeln!(said, "{error} [{}]", error.code());
    }
    for more in [
        "[terms]\ngravity = true",
        "[log]\nresolution = \"1 um\"\n[terms]\ncogging = [\"1 mm\", \"1 nm\"]",
        "[log]\nresolution = \"1 um\"\n[terms]\ncoulomb_pitch = [\"1 nm\"]",
    ] {
        let axis = parse(&columns(force, more)).unwrap();
        let log = Log::from_table(&table, &axis.mapping).unwrap();
        let _ = writeln!(said, "{}", axis.terms_for(&log, false).unwrap_err());
    }
    insta::assert_snapshot!(said);
    // What the file does not say is not of the file.
    let crop = Mapping {
        crop: Some((3.0, 4.0)),
        ..parse(&columns(force, "")).unwrap().mapping
    };
    let error = Log::from_table(&table, &crop).unwrap_err();
    assert_eq!(Axis::default().at_key(error).code().as_str(), "log-value");
}

/// A table with one row and these names and units.
fn table(names: &[(String, Option<String>)]) -> Table {
    Table {
        columns: names
            .iter()
            .map(|(name, unit)| Column {
                name: name.clone(),
                unit: unit.clone(),
                values: vec![0.0],
                ..Column::default()
            })
            .collect(),
        ..Table::default()
    }
}

/// Names as files may hold them: anything, and what would break out of a text or a comment.
fn name() -> impl Strategy<Value = String> {
    prop_oneof![
        any::<String>(),
        "[\"'\\\\\\]\\[={}#,\n\r\t\u{0}\u{b}\u{7f}\u{85}\u{2028}\u{feff} a]{0,12}",
        Just("\"\"\"\n".to_string()),
        Just("'''".to_string()),
        Just("a\"\nkind = \"rotary\"\n".to_string()),
        Just("\u{0}".to_string()),
        Just(String::new()),
    ]
}

/// Fragments that a confused person or a fuzzer may put together.
fn toml_like() -> impl Strategy<Value = String> {
    let piece = prop_oneof![
        prop::sample::select(WHOLE.lines().collect::<Vec<_>>()).prop_map(str::to_string),
        prop::sample::select(vec![
            "=",
            "[",
            "]",
            "{",
            "}",
            "[[",
            "]]",
            "\"",
            "'",
            "\"\"\"",
            ".",
            ",",
            "\n",
            "#",
            "\\u0000",
            "1e999",
            "-0",
            "nan",
            "inf",
            "0x",
            "1979-05-27T07:32:00Z",
            "columns",
            "force",
            "\u{feff}",
            "column",
            "N/A",
            "1 N m/",
            "µm",
            "m^99999999999",
            "((((",
            "kg^-2147483648",
        ])
        .prop_map(str::to_string),
        any::<String>(),
    ];
    prop::collection::vec(piece, 0..20).prop_map(|pieces| pieces.join(" "))
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn arbitrary_text_is_read_or_refused(text in toml_like()) {
        if let Err(e) = parse(&text) {
            prop_assert!(e.to_string().starts_with("axis: "));
        }
    }

    #[test]
    fn a_changed_axis_file_is_read_or_refused(
        edits in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>(), 0u8..3), 1..6)
    ) {
        let mut bytes = WHOLE.as_bytes().to_vec();
        for (at, byte, how) in edits {
            let at = at.index(bytes.len());
            match how {
                0 => bytes[at] = byte,
                1 => { bytes.remove(at); }
                _ => bytes.insert(at, byte),
            }
        }
        let text = String::from_utf8_lossy(&bytes);
        if let Err(e) = parse(&text) {
            prop_assert!(e.to_string().starts_with("axis: "));
        }
    }

    /// Values of every key replaced by text of any kind.
    #[test]
    fn any_value_is_read_or_refused(line in 0usize..64, value in any::<String>()) {
        let lines: Vec<&str> = WHOLE.lines().collect();
        let mut text = String::new();
        for (i, old) in lines.iter().enumerate() {
            match old.split_once(" = ") {
                Some((key, _)) if i == line % lines.len() => {
                    let quoted = toml::Value::String(value.clone());
                    let _ = writeln!(text, "{key} = {quoted}");
                }
                _ => { let _ = writeln!(text, "{old}"); }
            }
        }
        let _ = parse(&text);
    }

    #[test]
    fn a_template_is_an_axis_file(
        names in prop::collection::vec((name(), prop::option::of(name())), 0..6),
        position in name(),
        force in name(),
    ) {
        let table = table(&names);
        let clear = Mapping::clear_columns(&table);
        parse(&template(&table, Err((&clear, "two columns\nfit")), &Found::default())).unwrap();
        let mut mapping = Mapping::detect(&table).map(|d| d.mapping).unwrap_or_default();
        parse(&template(&table, Ok(&mapping), &Found::default())).unwrap();
        mapping.motion = Some(Motion::Rotary);
        mapping.position = Some(Channel {
            unit: Some(Unit::parse("deg").unwrap()),
            ..Channel::named(position.clone())
        });
        mapping.force = Some(Channel {
            scale: Some(Value::parse("35.15 N m/A").unwrap()),
            unit: Some(Unit::parse("A").unwrap()),
            invert: true,
            sign: Some(Sign::Column(Selector::Name(position.clone()))),
            ..Channel::named(force.clone())
        });
        let found = Found {
            assumed: vec![Role::Force],
            resolution: Some("5e-8 rad".into()),
            wrap: Some("25 rad".into()),
            own_stamps: Vec::new(),
            coarse: None,
            enable: None,
            brakes: true,
            columns: names.iter().map(|(name, _)| name.clone()).collect(),
        };
        let text = template(&table, Ok(&mapping), &found);
        let axis = parse(&text).unwrap();
        // What was filled in comes back, and nothing else got in.
        prop_assert_eq!(axis.mapping.motion, Some(Motion::Rotary));
        prop_assert_eq!(axis.mapping.resolution, Some(5e-8));
        for role in [Role::Position, Role::Force] {
            prop_assert_eq!(axis.mapping.channel(role), mapping.channel(role));
        }
        prop_assert_eq!(axis.name, None);
    }
}

#[test]
fn an_offset_is_given_or_estimated() {
    let offset = |text: &str| {
        let force = format!("force = {{ file = \"tau.csv\", column = 1{text} }}");
        parse(&format!("[columns]\n{force}\n")).unwrap().joined[0]
            .from
            .offset
    };
    assert_eq!(offset(""), Offset::Given(0.0));
    assert_eq!(offset(", offset = \"-12 ms\""), Offset::Given(-0.012));
    assert_eq!(offset(", offset = \"estimate\""), Offset::Estimated);
}

#[test]
fn a_column_of_the_log_may_have_time_stamps_of_its_own() {
    let text = "[columns]\nforce = { column = \"effort.tau\", time = \"effort.t\" }\n";
    let axis = parse(text).unwrap();
    let joined = &axis.joined[0];
    assert_eq!((&joined.file, joined.from.role), (&None, Role::Force));
    assert_eq!(joined.from.time, Some(Channel::named("effort.t")));
}

/// Of the text that was read, whatever becomes of the file afterwards.
#[test]
fn an_axis_file_has_the_hash_of_what_was_read() {
    let dir = tempfile::tempdir().unwrap();
    let file = dir.path().join("axis.toml");
    std::fs::write(&file, "kind = \"linear\"\n").unwrap();
    let axis = Axis::read(&file).unwrap();
    let before = stiction_files::sha256(&file).unwrap();
    std::fs::write(&file, "kind = \"rotary\"\n").unwrap();
    assert_eq!(axis.sha256(), Some(before.as_str()));
    assert_eq!(parse("kind = \"linear\"\n").unwrap().sha256(), None);
}

#[test]
fn a_servo_brings_its_motor_and_its_loop() {
    let axis = parse("servo = \"xl330\"\n").unwrap();
    let drive = axis.mapping.drive.unwrap();
    assert_eq!(axis.mapping.motion, Some(Motion::Rotary));
    assert!(axis.terms.gravity);
    assert_eq!(
        (drive.force_constant, drive.resistance, drive.supply),
        (0.3867, Some(4.017), None)
    );
    let own = drive.position_loop.unwrap();
    assert_eq!((own.kp, own.servo.kp), (None, 400.0));
    let text = "servo = \"sts3215\"\n[drive]\nkp = 16\nsupply = \"12 V\"\nduty_limit = 0.5\nforce_constant = \"1 N m/A\"\n[terms]\ngravity = false\n";
    let axis = parse(text).unwrap();
    let drive = axis.mapping.drive.unwrap();
    assert!(!axis.terms.gravity);
    assert_eq!(
        (drive.force_constant, drive.back_emf, drive.supply),
        (1.0, 1.2116, Some(12.0))
    );
    let own = drive.position_loop.unwrap();
    assert_eq!(
        (own.kp, own.error_gain, own.duty_limit),
        (Some(16.0), 0.166, 0.5)
    );
    for (text, part) in [
        ("servo = \"sg90\"\n", "xl330"),
        (
            "servo = \"xl330\"\n[drive]\nkp = \"200\"\n",
            "without quotes",
        ),
        ("servo = \"xl330\"\n[drive]\nduty_limit = 2\n", "duty_limit"),
        ("[drive]\nforce_constant = \"1 N m/A\"\nkp = 200\n", "kp"),
        (
            "[columns]\nposition = { column = 1, sign = \"following-error\" }\n",
            "magnitude",
        ),
    ] {
        let refused = parse(text).unwrap_err().to_string();
        assert!(refused.contains(part), "{text}: {refused}");
    }
}
