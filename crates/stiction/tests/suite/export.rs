//! `stiction export` from a model file: what is written, what is refused, what is said.

use std::path::{Path, PathBuf};
use stiction_workflows::Error;
use stiction_workflows::export::{ExportOptions, Exported, Feedforward, Target, export_file};

const LUGRE: [(&str, f64, &str); 6] = [
    ("sigma0", 1.2e5, "N/m"),
    ("sigma1", 300.0, "N s/m"),
    ("coulomb", 20.0, "N"),
    ("static", 30.0, "N"),
    ("stribeck_velocity", 5e-3, "m/s"),
    ("sigma2", 60.0, "N s/m"),
];

/// The text of a model file.
fn text(law: &str, parameters: &[(&str, f64, &str)]) -> String {
    let asymmetric = parameters.iter().any(|(name, ..)| name.ends_with("_pos"));
    let mut out = format!(
        "schema = \"stiction.model/1\"\nname = \"X axis */ (left)\"\nkind = \"linear\"\nlaw = \"{law}\"\nasymmetric = {asymmetric}\n\
         force_unit = \"N\"\ntrustworthy = true\n\n[source]\nversion = \"0.1.0\"\nmethod = \"separable\"\nseed = 0\n\n\
         [[source.inputs]]\npath = \"log.csv\"\nsha256 = \"{}\"\n",
        "ab".repeat(32)
    );
    for (name, value, unit) in parameters {
        out += &format!(
            "\n[[parameter]]\nname = \"{name}\"\nsymbol = \"{name}\"\nvalue = {value:?}\nunit = \"{unit}\"\n\
             ci95 = [{:?}, {:?}]\nidentifiable = true\norigin = \"identified\"\n",
            value - 0.1 * value.abs(),
            value + 0.1 * value.abs()
        );
    }
    out + "\n[covariance]\nnames = []\nmatrix = []\n"
}

/// The same axis with a gap and cogging of 24 mm.
fn with_gap_and_cogging() -> String {
    let waves = [("cogging1_sin", 1.5, "N"), ("cogging1_cos", -0.5, "N")];
    let all: Vec<_> = LUGRE.into_iter().chain(waves).collect();
    text("lugre", &all).replace(
        "\n[covariance]",
        "\n[range]\nposition = [0.0, 0.4]\n\n[pitch]\ncogging = [0.024]\n\n[backlash]\nwidth = 2e-5\nci95 = [1.8e-5, 2.2e-5]\n\n[covariance]",
    )
}

struct Bench(tempfile::TempDir);

impl Bench {
    fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn options(&self, model: &str) -> ExportOptions {
        std::fs::write(self.path("model.toml"), model).unwrap();
        ExportOptions::new(Target::C, 1e-3)
    }

    /// Exports the model that was written last.
    fn export_to(&self, folder: &str, options: &ExportOptions) -> Result<Exported, Error> {
        let exported = export_file(self.path("model.toml"), options)?;
        exported.write(self.path(folder), false)?;
        Ok(exported)
    }

    fn export(&self, model: &str) -> Result<Exported, Error> {
        self.export_to("out", &self.options(model))
    }
}

fn contents(dir: &Path) -> Vec<(String, Vec<u8>)> {
    let mut found = Vec::new();
    for path in std::fs::read_dir(dir).unwrap().map(|e| e.unwrap().path()) {
        if path.is_dir() {
            found.extend(contents(&path));
        } else {
            found.push((
                path.to_string_lossy().into_owned(),
                std::fs::read(&path).unwrap(),
            ));
        }
    }
    found.sort();
    found
}

#[test]
fn the_same_model_gives_the_same_bytes() {
    let plain = text("lugre", &LUGRE);
    for target in Target::ALL {
        let model = match target.is_map() {
            true => with_gap_and_cogging(),
            false => plain.clone(),
        };
        let (a, b) = (Bench::new(), Bench::new());
        for bench in [&a, &b] {
            let mut options = bench.options(&model);
            options.target = target;
            options.rated_force = (target == Target::Tf5200).then_some(221.0);
            let exported = bench.export_to("out", &options).unwrap();
            // 20 N + 60 N s/m v is 60 N at 0.67 m/s, and 80 N at 1 m/s, where the table ends.
            let (codes, limit): (&[&str], f64) = match target {
                Target::Mujoco | Target::Modelica | Target::DomainJson => (&[], 60.0),
                Target::Tf5200 => (&[], 80.0),
                Target::Backlash => (&[], 60.0),
                // Of a linear axis there is no map over a turn.
                Target::CoggingMap => (&["export-simplified"], 60.0),
                target if target == Target::DriveTable || target.is_simulated() => {
                    (&["export-simplified"], 60.0)
                }
                _ => (&["export-limit"], 60.0),
            };
            let found: Vec<_> = exported.warnings.iter().map(|w| w.code.as_str()).collect();
            assert!(
                exported.trustworthy && found == codes,
                "{:?}",
                exported.warnings
            );
            assert_eq!(exported.limit, limit);
        }
        let bytes = |bench: &Bench| -> Vec<Vec<u8>> {
            let files = contents(&bench.path("out"));
            files.into_iter().map(|(_, bytes)| bytes).collect()
        };
        assert_eq!(bytes(&a), bytes(&b));
        if matches!(target, Target::Fmu | Target::Bam | Target::DomainJson) {
            continue; // Archives, and documents that have no comments; what is in them is looked at in the crate.
        }
        let head = String::from_utf8(contents(&a.path("out"))[0].1.clone()).unwrap();
        assert!(
            head.contains(&"ab".repeat(32)) && head.contains("X axis _/ (left)"),
            "{head}"
        );
        assert!(
            head.contains("sigma0 = 1.200000e5 N/m, 1.0800e5 to 1.3200e5"),
            "{head}"
        );
    }
}

#[test]
fn a_folder_that_holds_something_is_left_alone() {
    let bench = Bench::new();
    std::fs::create_dir(bench.path("out")).unwrap();
    std::fs::write(bench.path("out/mine.txt"), "mine").unwrap();
    let before = contents(&bench.path("out"));
    let error = bench.export(&text("lugre", &LUGRE)).unwrap_err();
    assert_eq!(error.code().as_str(), "output");
    assert_eq!(contents(&bench.path("out")), before);
    std::fs::remove_file(bench.path("out/mine.txt")).unwrap();
    assert_eq!(
        bench.export(&text("lugre", &LUGRE)).unwrap().written.len(),
        contents(&bench.path("out")).len()
    );
}

/// A free folder is used as it is: as a link, with its rights, as the one the user is in.
#[cfg(unix)]
#[test]
fn an_empty_folder_stays_the_same_folder() {
    use std::os::unix::fs::MetadataExt;
    let model = text("lugre", &LUGRE);
    let bench = Bench::new();
    let (real, link) = (bench.path("real"), bench.path("link"));
    std::fs::create_dir(&real).unwrap();
    let before = real.metadata().unwrap().ino();
    std::os::unix::fs::symlink(&real, &link).unwrap();
    for out in [link.clone(), real.join("."), real.clone()] {
        bench.options(&model);
        let exported = bench.export_to(out.to_str().unwrap(), &ExportOptions::new(Target::C, 1e-3));
        let exported = exported.unwrap();
        assert_eq!(contents(&real).len(), exported.written.len(), "{out:?}");
        assert_eq!(std::fs::read_dir(&real).unwrap().count(), 6, "{out:?}");
        assert_eq!(real.metadata().unwrap().ino(), before, "{out:?}");
        assert!(link.is_symlink());
        for (path, _) in contents(&real) {
            std::fs::remove_file(path).unwrap();
        }
    }
}

/// The limit is said where the log was fast enough to reach it with the whole friction: 20 N + 60 N s/m v is 60 N at
/// 0.667 m/s; at the gain that is written at 1 m/s.
#[test]
fn the_limit_is_said_where_the_log_reached_it() {
    for (top, says) in [
        ("0.66", None),
        (
            "0.7",
            Some("at 0.6667 m/s with a gain of 1, at 1 m/s with 0.75, and the log goes to 0.7 m/s"),
        ),
        ("0.0", Some("source.top_speed: 0; above 0")),
        ("inf", Some("source.top_speed: inf; above 0")),
    ] {
        let top = format!("seed = 0\ntop_speed = {top}\n");
        let bench = Bench::new();
        let said = match bench.export(&text("lugre", &LUGRE).replace("seed = 0\n", &top)) {
            Ok(exported) => {
                let limits = exported
                    .warnings
                    .into_iter()
                    .filter(|w| w.code.as_str() == "export-limit");
                limits.map(|w| w.message).collect()
            }
            Err(e) => e.to_string(),
        };
        match says {
            Some(text) => assert!(said.contains(text), "{said}"),
            None => assert_eq!(said, "", "{top}"),
        }
    }
}

/// What is refused, with its code and the place; nothing is left behind.
#[test]
fn bad_models_are_refused() {
    let missing = &LUGRE[1..];
    let with = |name: &'static str, value: f64| {
        let unit = LUGRE.iter().find(|p| p.0 == name).map_or("N", |p| p.2);
        let mut p: Vec<_> = LUGRE.into_iter().filter(|p| p.0 != name).collect();
        p.push((name, value, unit));
        p
    };
    let no_viscous: Vec<_> = LUGRE.into_iter().filter(|p| p.0 != "sigma2").collect();
    let cases: [(&str, String, &str, &str); 9] = [
        ("missing", text("lugre", missing), "bad-config", "no sigma0"),
        (
            "law",
            text("elasto-plastic", &LUGRE),
            "bad-config",
            "no breakaway_ratio",
        ),
        (
            "static",
            text("lugre", &with("static", 10.0)),
            "bad-config",
            "static = 10",
        ),
        (
            "zero",
            text("lugre", &with("sigma0", 0.0)),
            "bad-config",
            "sigma0 = 0",
        ),
        (
            "single",
            text("lugre", &with("sigma0", 1e40)),
            "not-exported",
            "value: sigma0 = 1e40; allowed: from 1e-15 to 1e15 (as float)",
        ),
        (
            "single, small",
            text("lugre", &with("sigma0", 1e-40)),
            "not-exported",
            "value: sigma0 = 1e-40; allowed",
        ),
        (
            "no sigma2",
            text("lugre", &no_viscous),
            "bad-config",
            "no sigma2",
        ),
        (
            "side",
            text("lugre", &with("stribeck_exponent_pos", 1.0)),
            "bad-config",
            "stribeck_exponent_pos",
        ),
        ("not ours", "x = 1".into(), "bad-config", "model.toml"),
    ];
    for (name, model, code, says) in cases {
        let bench = Bench::new();
        let error = bench.export(&model).unwrap_err();
        assert_eq!(error.code().as_str(), code, "{name}: {error}");
        assert!(error.to_string().contains(says), "{name}: {error}");
        assert_eq!(contents(bench.0.path()).len(), 1, "{name}");
    }
    for (name, cycle_time, limit, says) in [
        (Some("../x"), 1e-3, None, "name \"../x\""),
        (Some("a__b"), 1e-3, None, "underscores"),
        (None, 250.0, None, "cycle time 250 s"),
        (None, f64::NAN, None, "cycle time NaN"),
        (None, 1e-3, Some(-1.0), "limit = -1"),
        (None, 1e-3, Some(f64::INFINITY), "limit = inf"),
        (
            None,
            1e-3,
            Some(1e-40),
            "limit = 1e-40; allowed: from 1e-30 to 1e30 (as float)",
        ),
        (
            None,
            1e-3,
            Some(1e-300),
            "limit = 1e-300; allowed: from 1e-30 to 1e30 (as float)",
        ),
    ] {
        let bench = Bench::new();
        let mut options = bench.options(&text("lugre", &LUGRE));
        options.name = name.map(str::to_string);
        options.cycle_time = cycle_time;
        options.limit = limit;
        let error = bench.export_to("out", &options).unwrap_err();
        assert_eq!(error.code().as_str(), "not-exported", "{error}");
        assert!(error.to_string().contains(says), "{error}");
        assert_eq!(contents(bench.0.path()).len(), 1);
    }
}

/// What the code does not see stays at its reference: the same code but for the warning, which says where that is.
#[test]
fn friction_that_changes_is_exported_at_its_reference() {
    let plain = Bench::new();
    let code = plain.export(&text("lugre", &LUGRE)).unwrap();
    for (more, says) in [
        (
            vec![
                ("coulomb_temperature", -0.2, "N/K"),
                ("temperature_reference", 301.5, "K"),
            ],
            "coulomb_temperature = -0.2000 N/K: at 301.5 K",
        ),
        (
            vec![("coulomb_load", 0.1, "N/N"), ("load_reference", 85.0, "N")],
            "coulomb_load = 0.1000 N/N: at a load of 85.00 N",
        ),
        (
            vec![("coulomb_position", 3.0, "N/m")],
            "at the position the mean of the log",
        ),
        (
            vec![("quadratic_viscous", 1.0, "N*s^2/m^2")],
            "without the part that grows with the square",
        ),
    ] {
        let mut parameters = LUGRE.to_vec();
        parameters.extend(more);
        let bench = Bench::new();
        let exported = bench.export(&text("lugre", &parameters)).unwrap();
        let warned = exported.warnings.iter().find(|w| w.message.contains(says));
        let warned = warned.unwrap_or_else(|| panic!("{says}: {:?}", exported.warnings));
        assert_eq!(warned.code.as_str(), "export-terms");
        assert_eq!(exported.limit, code.limit);
        let head = String::from_utf8(exported.files[0].bytes.clone()).unwrap();
        let words: Vec<&str> = head.split_whitespace().filter(|w| *w != "*").collect();
        assert!(
            words
                .join(" ")
                .contains("friction depends on inputs that the code does not see")
        );
    }
}

/// Numbers of the steady friction have quadratic viscous friction in them: the least squares of v |v| from 0 to the top speed T is
/// T v - T^2/6.
#[test]
fn numbers_of_the_steady_friction_have_what_bends() {
    let damping = |more: &[(&str, f64, &str)], range: &str| {
        let mut parameters = LUGRE.to_vec();
        parameters.extend(more);
        let bench = Bench::new();
        let model =
            text("lugre", &parameters).replace("[covariance]", &format!("{range}[covariance]"));
        let mut options = bench.options(&model);
        options.target = Target::Urdf;
        let exported = bench.export_to("out", &options).unwrap();
        let text = String::from_utf8(exported.files[0].bytes.clone()).unwrap();
        let number = |key: &str| -> f64 {
            let (_, rest) = text.split_once(&format!("{key}=\"")).unwrap();
            rest.split('"').next().unwrap().parse().unwrap()
        };
        let bent = exported
            .warnings
            .iter()
            .any(|w| w.message.contains("quadratic"));
        ([number("damping"), number("friction")], bent)
    };
    let range = "[range]\nspeed = 0.3\n\n";
    let ([plain, level], said) = damping(&[], range);
    assert!(!said);
    let quadratic = ("quadratic_viscous", 40.0, "N*s^2/m^2");
    let ([bent, lower], said) = damping(&[quadratic], range);
    assert!(!said);
    assert!((bent - plain - 40.0 * 0.3).abs() < 1e-3, "{plain} {bent}");
    assert!(
        (level - lower - 40.0 * 0.09 / 6.0).abs() < 1e-3,
        "{level} {lower}"
    );
    assert!(damping(&[quadratic], "").1);
}

#[test]
fn doubts_are_said_and_written() {
    let mut stiff = LUGRE;
    stiff[0].1 = 1e8;
    stiff[1].1 = 5e3;
    let mut parameters = stiff.to_vec();
    parameters.push(("mass", 9.0, "kg"));
    let model = text("lugre", &parameters)
        .replace("trustworthy = true", "trustworthy = false")
        .replacen("identifiable = true", "identifiable = false", 1);
    let bench = Bench::new();
    let mut options = bench.options(&model);
    options.limit = Some(10.0);
    let exported = bench.export_to("out", &options).unwrap();
    let codes: Vec<_> = exported.warnings.iter().map(|w| w.code.as_str()).collect();
    let all = [
        "export-untrusted",
        "not-identifiable",
        "export-terms",
        "export-damping",
        "export-cycle-time",
        "export-limit",
    ];
    assert_eq!(codes, all);
    assert!(!exported.trustworthy);
    let said = stiction_pages::text::exported(&exported, Path::new("out"));
    assert!(
        said.contains("the log leaves sigma0 open") && said.contains("mass is not friction"),
        "{said}"
    );
    for (name, bytes) in contents(&bench.path("out")) {
        let text = String::from_utf8(bytes).unwrap();
        assert!(
            text.contains("NOTE: the identification flagged this model as not trustworthy"),
            "{name}"
        );
        assert!(text.contains("NOT determined by the data"), "{name}");
    }
}

/// A model in amperes stays one: its limit, what is said, what a table is in; MuJoCo, which takes newtons, refuses it.
#[test]
fn a_current_stays_one() {
    let model = text("lugre", &LUGRE)
        .replace("force_unit = \"N\"", "force_unit = \"A\"")
        .replace("\"N/m\"", "\"A/m\"")
        .replace("\"N s/m\"", "\"A*s/m\"")
        .replace("unit = \"N\"", "unit = \"A\"");
    let bench = Bench::new();
    let exported = bench.export(&model).unwrap();
    let said = stiction_pages::text::exported(&exported, Path::new("out"));
    assert!(said.contains("force at most 60.00 A"), "{said}");
    assert!(said.contains("limited to 60 A, which"), "{said}");
    for (name, bytes) in contents(&bench.path("out")) {
        let text = String::from_utf8(bytes).unwrap();
        assert!(
            text.contains("The force is in A, the unit of the log"),
            "{name}"
        );
        assert!(text.contains("  sigma1 = 3.000000e2 A s/m, 2.7"), "{name}");
        assert!(
            text.contains("NOTE: the force is limited to 60 A"),
            "{name}"
        );
    }
    let bench = Bench::new();
    let mut options = bench.options(&model);
    options.target = Target::Tf5200;
    options.rated_force = Some(200.0);
    bench.export_to("out", &options).unwrap();
    let (_, bytes) = contents(&bench.path("out")).swap_remove(0);
    let table = String::from_utf8(bytes).unwrap();
    assert!(table.contains("rated force of 200.0 A"), "{table}");
    options.target = Target::Mujoco;
    options.rated_force = None;
    let error = bench.export_to("other", &options).unwrap_err();
    assert!(
        error
            .to_string()
            .contains("needs forces in N, but those of the model are in A"),
        "{error}"
    );
}

/// Two axes have two names, and where a name is not the whole one it is said, on the terminal and in the files.
#[test]
fn names_are_not_lost_without_a_word() {
    let named = |title: &str| {
        let bench = Bench::new();
        let model = text("lugre", &LUGRE).replace("X axis */ (left)", title);
        let exported = bench.export(&model).unwrap();
        let said = exported
            .warnings
            .iter()
            .any(|w| w.code.as_str() == "export-name");
        let text = String::from_utf8(contents(&bench.path("out")).swap_remove(0).1).unwrap();
        assert_eq!(
            text.contains("NOTE: the names in the code begin with"),
            said,
            "{title}"
        );
        (exported.name, said)
    };
    assert_eq!(
        named("gantry axis number 1 left side"),
        ("gantry_axis_number_1_left_side".into(), false)
    );
    assert_eq!(named("\u{8f74}"), ("axis".into(), true));
    let (left, right) = (
        named("the gantry of the long machine, left side"),
        named("the gantry of the long machine, right side"),
    );
    assert!(left.1 && right.1 && left.0 != right.0, "{left:?} {right:?}");
}

/// Every law that a model file can carry and the compensator has.
#[test]
fn every_law() {
    let dahl = [
        ("sigma0", 1e5, "N/m"),
        ("coulomb", 20.0, "N"),
        ("sigma2", 60.0, "N s/m"),
    ];
    let lopsided = [
        ("coulomb_pos", 20.0, "N"),
        ("coulomb_neg", 14.0, "N"),
        ("sigma2_pos", 60.0, "N s/m"),
        ("sigma2_neg", 85.0, "N s/m"),
        ("offset", -3.0, "N"),
    ];
    let mut power = LUGRE.to_vec();
    power.push(("stribeck_exponent", 1.3, "1"));
    for (law, parameters, holds) in [
        ("dahl", &dahl[..], "params->sigma1 = 0.0;"),
        (
            "coulomb-viscous",
            &lopsided[..],
            "params->neg.coulomb = 14.0;",
        ),
        (
            "stribeck",
            &LUGRE[2..],
            "params->pos.stribeck_velocity = 0.005;",
        ),
        ("lugre", &power[..], "params->exponent = 1.3;"),
    ] {
        let bench = Bench::new();
        bench.export(&text(law, parameters)).unwrap();
        let source = std::fs::read_to_string(bench.path("out/X_axis_left_friction.c")).unwrap();
        assert!(source.contains(holds), "{law}");
    }
}

/// The words of every refusal and warning, as they are read; what is refused leaves nothing behind.
#[test]
fn what_is_said() {
    let with = |changes: &[(&'static str, f64)]| {
        let mut p = LUGRE.to_vec();
        for (name, value) in changes {
            match p.iter_mut().find(|p| p.0 == *name) {
                Some(p) => p.1 = *value,
                None => p.push((name, *value, "N")),
            }
        }
        text("lugre", &p)
    };
    let good = with(&[]);
    let loose = good.replacen("identifiable = true", "identifiable = false", 1);
    let heavy = text("lugre", &[&LUGRE[..], &[("mass", 4.6, "kg")]].concat());
    let moved = good.replace("[source]\n", "[source]\ntop_speed = 0.2\n");
    let untrusted = good.replace("trustworthy = true", "trustworthy = false");
    type Change = fn(&mut ExportOptions);
    let cases: Vec<(&str, &str, Change)> = vec![
        ("not identifiable", &loose, |_| {}),
        ("not trusted", &untrusted, |_| {}),
        ("another name", &good, |o| o.name = Some("2nd axis".into())),
        ("a key word of C with an ending", &good, |o| {
            o.name = Some("int".into())
        }),
        ("a path for a name", &good, |o| {
            o.name = Some("../../etc/x".into())
        }),
        ("a reserved name", &good, |o| o.name = Some("_x__y".into())),
        ("a long name", &good, |o| o.name = Some("x".repeat(40))),
        ("a cycle time in microseconds", &good, |o| {
            o.cycle_time = 250.0
        }),
        ("no cycle time", &good, |o| o.cycle_time = 0.0),
        ("no force", &good, |o| o.limit = Some(0.0)),
        ("less than the friction", &good, |o| o.limit = Some(10.0)),
        ("a table without the motor", &good, |o| {
            o.target = Target::Tf5200
        }),
        ("a table of a motor without force", &good, |o| {
            (o.target, o.rated_force) = (Target::Tf5200, Some(0.0));
        }),
        ("a motor for code", &good, |o| o.rated_force = Some(221.0)),
        ("a motor far too large", &good, |o| {
            (o.target, o.rated_force) = (Target::Tf5200, Some(1e6));
        }),
        ("a motor far too small", &good, |o| {
            (o.target, o.rated_force) = (Target::Tf5200, Some(0.5));
        }),
        ("a motor too small", &good, |o| {
            (o.target, o.rated_force) = (Target::Tf5200, Some(20.0));
        }),
        ("a watchdog without time", &good, |o| {
            o.safety.window = Some(-1.0);
        }),
        ("levels that follow in a table", &good, |o| {
            (o.target, o.rated_force, o.adapt) = (Target::Tf5200, Some(221.0), true);
        }),
        ("levels that follow", &heavy, |o| o.adapt = true),
        ("levels that follow without a mass", &good, |o| {
            o.adapt = true
        }),
        ("standstill at every speed", &moved, |o| {
            o.safety.dead_zone = Some(0.5);
        }),
        ("numbers of drives with a gain", &good, |o| {
            (o.target, o.gain) = (Target::DriveTable, Some(0.5));
        }),
        ("numbers of drives with a watchdog", &good, |o| {
            (o.target, o.safety.window) = (Target::DriveTable, Some(2.0));
        }),
        ("a limit in MuJoCo", &good, |o| {
            (o.target, o.limit) = (Target::Mujoco, Some(40.0));
        }),
        ("a table with a limit", &good, |o| {
            (o.target, o.rated_force, o.limit) = (Target::Tf5200, Some(221.0), Some(40.0));
        }),
    ];
    let beyond = with(&[("sigma0", 1e40), ("sigma1", 0.0)]);
    let tiny = with(&[("coulomb", 1e-50), ("static", 1e-50)]);
    let stiff = with(&[("sigma0", 1e8), ("sigma1", 0.0)]);
    let active = with(&[("sigma1", 5e3)]);
    let asymmetric = text(
        "lugre",
        &[
            &LUGRE[..2],
            &LUGRE[3..],
            &[("coulomb_pos", 20.0, "N"), ("coulomb_neg", 14.0, "N")],
        ]
        .concat(),
    );
    let more: Vec<(&str, &str, Change)> = vec![
        ("beyond REAL", &beyond, |o| o.target = Target::St),
        ("nothing in REAL", &tiny, |o| o.target = Target::St),
        ("too stiff for the cycle", &stiff, |_| {}),
        ("is passive up to", &active, |_| {}),
        ("asymmetric in MuJoCo", &asymmetric, |o| {
            o.target = Target::Mujoco
        }),
        ("no law of ours", "law = 3", |_| {}),
        ("nothing", "", |_| {}),
    ];
    let mut said = String::new();
    for (name, model, change) in cases.into_iter().chain(more) {
        let bench = Bench::new();
        let mut options = bench.options(model);
        change(&mut options);
        said += &format!("{name}\n");
        match bench.export_to("out", &options) {
            Ok(exported) => {
                assert!(bench.path("out").is_dir(), "{name}");
                let none = exported.warnings.is_empty();
                said += if none { "  written\n" } else { "" };
                for w in exported.warnings {
                    said += &format!("  warning [{}]: {}\n", w.code, w.message);
                }
            }
            Err(e) => {
                assert_eq!(contents(bench.0.path()).len(), 1, "{name}");
                let place = bench.0.path().display().to_string();
                said += &format!(
                    "  {} [{}]\n",
                    e.to_string().replace(&place, "DIR"),
                    e.code()
                );
            }
        }
    }
    // Where to write.
    let bench = Bench::new();
    let options = bench.options(&good);
    std::fs::create_dir(bench.path("full")).unwrap();
    std::fs::write(bench.path("full/mine.txt"), "mine").unwrap();
    let before = contents(bench.0.path());
    for (name, out) in [
        ("a folder that holds something", "full"),
        ("a file", "full/mine.txt"),
        ("below a file", "full/mine.txt/out"),
        ("the model itself", "model.toml"),
    ] {
        let error = bench.export_to(out, &options).unwrap_err();
        let place = bench.0.path().display().to_string();
        let error = error.to_string().replace(&place, "DIR");
        said += &format!("{name}\n  {error}\n");
        assert_eq!(contents(bench.0.path()), before, "{name}");
    }
    insta::assert_snapshot!(said);
}

/// Slew limit and dead zone follow from the law, and what is asked for takes their place; a target without them refuses.
#[test]
fn settings_follow_from_the_law_or_are_given() {
    let bench = Bench::new();
    let static_law: Vec<_> = LUGRE
        .into_iter()
        .filter(|(name, ..)| !name.starts_with("sigma") || *name == "sigma2")
        .collect();
    let mut options = bench.options(&text("stribeck", &static_law));
    let has = |folder: &str, line: &str| {
        let path = bench.path(folder);
        let (_, bytes) = contents(&path)
            .into_iter()
            .find(|(name, _)| name.ends_with("friction.c"))
            .unwrap();
        let text = String::from_utf8(bytes).unwrap();
        assert!(text.contains(line), "{line}");
    };
    bench.export_to("usual", &options).unwrap();
    // 2 x 30 N in 2 ms; a hundredth of 5 mm/s.
    has("usual", "params->slew = 30000.0;");
    has("usual", "params->dead_zone = 5e-5;");
    has("usual", "params->watchdog_window = 2.0;");
    options.gain = Some(0.4);
    options.safety.ramp = Some(0.2);
    options.safety.dead_zone = Some(0.0);
    options.safety.slew = Some(500.0);
    options.safety.window = Some(0.0);
    bench.export_to("given", &options).unwrap();
    for line in [
        "params->gain = 0.4;",
        "params->ramp = 0.2;",
        "params->dead_zone = 0.0;",
        "params->slew = 500.0;",
        "params->watchdog_window = 0.0;",
    ] {
        has("given", line);
    }
    options.gain = Some(1.5);
    let error = bench.export_to("none", &options).unwrap_err().to_string();
    assert!(error.contains("gain = 1.5"), "{error}");
    options.gain = None;
    options.target = Target::Mujoco;
    let error = bench.export_to("none", &options).unwrap_err().to_string();
    assert!(error.contains("a ramp for the target mujoco"), "{error}");
}

/// A model without a name is that of its log, so that two axes have two names in one program.
#[test]
fn an_export_without_a_name_is_called_after_its_log() {
    let model = text("lugre", &LUGRE).replace("name = \"X axis */ (left)\"\n", "");
    let bench = Bench::new();
    for (path, name) in [
        ("logs/lin 2.csv", "lin_2"),
        ("J3.axis.parquet", "J3_axis"),
        ("4711.csv", "axis_4711"),
    ] {
        let exported = bench.export_to(name, &bench.options(&model.replace("log.csv", path)));
        let exported = exported.unwrap();
        assert_eq!(
            (exported.name.as_str(), exported.named_after_log),
            (name, true)
        );
        let said = stiction_pages::text::exported(&exported, &bench.path(name));
        assert!(
            said.contains(&format!(
                "compensator `{name}`, named after its log (--name gives another), for a cycle"
            )),
            "{said}"
        );
    }
    let named = bench.export_to("named", &bench.options(&text("lugre", &LUGRE)));
    assert!(!named.unwrap().named_after_log);
}

/// Where friction is known better than the default gain needs, the step after it is named; not where the log leaves more open, or
/// where a gain was asked for.
#[test]
fn the_whole_force_is_named_where_it_is_warranted() {
    let known = |percent: f64, level: f64| {
        let mut out = text("lugre", &LUGRE);
        for (_, value, _) in LUGRE {
            let [low, high] = [-1.0, 1.0].map(|sign| value + sign * 0.1 * value);
            let [less, more] = [-1.0, 1.0].map(|sign| value * (1.0 + sign * 0.01 * percent));
            out = out.replace(
                &format!("ci95 = [{low:?}, {high:?}]"),
                &format!("ci95 = [{less:?}, {more:?}]"),
            );
        }
        out + &format!(
            "\n[remaining]\nshapes = []\nlevel = {level:?}\nplace = 0.1\nplace_length = 0.01\nwandering = 0.1\nmemory = 1.0\n"
        )
    };
    let bench = Bench::new();
    let said = |model: &str, change: &dyn Fn(&mut ExportOptions)| {
        let mut options = bench.options(model);
        change(&mut options);
        let exported = export_file(bench.path("model.toml"), &options).unwrap();
        stiction_pages::text::exported(&exported, &bench.path("out"))
    };
    let line = "a gain of 0.75 leaves 25 % of the friction, and the levels of friction are known within 0.80 %: where it runs well, \
                export again with --gain 1, or --adapt where friction changes\n";
    let well = known(0.8, 0.005);
    let out = said(&well, &|_| {});
    assert!(out.contains(line), "{out}");
    type Change<'a> = &'a dyn Fn(&mut ExportOptions);
    let silent: [(&str, Change<'_>); 5] = [
        (&known(8.0, 0.005), &|_| {}),
        (&known(0.8, 0.2), &|_| {}),
        (&text("lugre", &LUGRE), &|_| {}),
        (&well, &|o| o.gain = Some(0.5)),
        (&well, &|o| o.adapt = true),
    ];
    for (model, change) in silent {
        let out = said(model, change);
        assert!(!out.contains("export again"), "{out}");
    }
}

/// What levels would take for friction has its remedy in the message.
#[test]
fn what_is_taken_for_friction_has_a_remedy() {
    let model = text("lugre", &beside()) + SEEN;
    let bench = Bench::new();
    let mut options = bench.options(&model);
    options.adapt = true;
    let exported = bench.export_to("adapt", &options).unwrap();
    let warned = exported
        .warnings
        .iter()
        .find(|w| w.code.as_str() == "export-adaptation");
    assert_eq!(
        warned.unwrap().message,
        "levels that follow the force of the drive mistake these for friction: cogging. To prevent this: export with --feedforward \
         friction,cogging, and the block subtracts it, or subtract it from drive_force; or let them learn only where it is small"
    );
}

/// The check lists look for a peak where `stiction check` does.
#[test]
fn check_lists_have_the_same_peak() {
    let pages = std::fs::read_dir("../../docs/deploy").unwrap();
    let mut lists = 0;
    for page in pages.map(|page| page.unwrap().path()) {
        let Ok(text) = std::fs::read_to_string(&page) else {
            continue;
        };
        assert!(!text.contains("within 20 ms"), "{}", page.display());
        lists += text.matches("20 ms before").count();
        assert_eq!(
            text.matches("20 ms before").count(),
            text.matches("to 150 ms after").count(),
            "{}",
            page.display()
        );
    }
    assert!(lists >= 8, "{lists}");
}

/// LuGre with all that friction may depend on, and mass, weight and cogging beside it.
fn beside() -> Vec<(&'static str, f64, &'static str)> {
    let more = [
        ("mass", 4.0, "kg"),
        ("offset", 6.0, "N"),
        ("cogging1_sin", 1.5, "N"),
        ("cogging1_cos", -0.5, "N"),
        ("coulomb_temperature", -0.4, "N/K"),
        ("coulomb_position", 8.0, "N/m"),
        ("coulomb_load", 0.05, "1"),
        ("sigma2_temperature", -0.5, "N s/(m K)"),
        ("temperature_reference", 300.0, "K"),
        ("position_reference", 0.1, "m"),
        ("load_reference", 100.0, "N"),
    ];
    LUGRE.into_iter().chain(more).collect()
}

const SEEN: &str = "\n[range]\nposition = [0.0, 0.2]\ntemperature = [290.0, 310.0]\nload = [80.0, 150.0]\nacceleration = 5.0\n\n\
     [pitch]\ncogging = [0.024]\n";

fn file(files: &[stiction_workflows::export::File], name: &str) -> String {
    let found = files.iter().find(|f| f.path.ends_with(name)).unwrap();
    String::from_utf8(found.bytes.clone()).unwrap()
}

/// What friction depends on is an input of the code with its unit and range, where the model says over which range; else the
/// code has it at its reference, and the message has the lines to write.
#[test]
fn what_friction_depends_on_is_an_input() {
    let bench = Bench::new();
    let model = text("lugre", &beside());
    let with = bench.export(&(model.clone() + SEEN)).unwrap();
    let head = file(&with.files, "friction.h");
    for line in [
        "position: that of the reference in m, 0 to 0.2000.",
        "load: in N, 80.00 to 150.0.",
        "temperature: in K (degrees Celsius + 273.15), 290.0 to 310.0.",
        "    double temperature;        /* K, 290.0 to 310.0 */",
        "    double load;               /* N, 80.0 to 150.0 */",
    ] {
        assert!(head.contains(line), "{line}: {head}");
    }
    let source = file(&with.files, "friction.c");
    assert!(
        source.contains("factor += (forward ? (-0.02) : (-0.02)) * temperature;"),
        "{source}"
    );
    assert!(source.contains("factor += (forward ? 0.4 : 0.4) * (x - 0.1);"));
    let said = |exported: &Exported| -> String {
        let each = exported.warnings.iter().map(|w| w.message.clone());
        each.collect::<Vec<_>>().join("\n")
    };
    assert!(!said(&with).contains("does not see"), "{}", said(&with));
    // A tenth of 20 N at 10 K, 4 % at 0.1 m and 12.5 % at 50 N more than at the reference.
    let most = 1.0 + 0.2 + 0.04 + 0.125;
    assert!(
        (with.limit - 2.0 * (30.0 * most + 6.0)).abs() < 1e-9,
        "{}",
        with.limit
    );

    let bench = Bench::new();
    let without = bench.export(&model).unwrap();
    assert!(!file(&without.files, "friction.h").contains("double temperature"));
    assert_eq!(without.limit, 72.0);
    let said = said(&without);
    for line in [
        "coulomb_temperature = -0.4000 N/K: at 300.0 K",
        "[range] temperature = [LEAST, LARGEST] in K",
        "[range] position = [LEAST, LARGEST]",
        "[range] load = [LEAST, LARGEST]",
    ] {
        assert!(said.contains(line), "{line}: {said}");
    }
}

/// What is asked for beside friction is in the code, with room in its limit; what the model has not is refused, with what it has.
#[test]
fn what_is_fed_forward_is_asked_for() {
    let fed = |names: &str| Feedforward::from_names(names.split(',')).unwrap();
    let bench = Bench::new();
    let mut options = bench.options(&(text("lugre", &beside()) + SEEN));
    options.feedforward = fed("friction,mass,gravity,cogging");
    let exported = bench.export_to("all", &options).unwrap();
    let head = file(&exported.files, "friction.h");
    for line in [
        "reference_acceleration: that of the reference in m/s^2",
        "It is the sum of friction, mass, gravity, cogging",
        "    double part_gravity;",
    ] {
        assert!(head.contains(line), "{line}: {head}");
    }
    // Once for each: 4 kg at 5 m/s^2, and 1.5 N and 0.5 N of cogging.
    let of_law = 2.0 * (30.0 * 1.365 + 6.0);
    assert!(
        (exported.limit - (of_law + 20.0 + 2.0)).abs() < 1e-9,
        "{}",
        exported.limit
    );
    let left = exported.warnings.iter().map(|w| w.code.as_str());
    assert!(!left.collect::<Vec<_>>().contains(&"export-terms"));

    let refusal = |model: &str, names: &str| {
        let bench = Bench::new();
        let mut options = bench.options(model);
        options.feedforward = fed(names);
        bench.export_to("out", &options).unwrap_err().to_string()
    };
    let plain = text("lugre", &LUGRE);
    assert_eq!(
        refusal(&plain, "friction,mass"),
        "the model has no mass that the log determines; it can feed forward: friction"
    );
    assert_eq!(
        refusal(&plain, "friction,gravity"),
        "the model has no constant force, which on a linear axis is its weight; it can feed forward: friction"
    );
    let unseen = text("lugre", &beside());
    assert_eq!(
        refusal(&unseen, "friction,gravity,cogging"),
        "the model has no pitch of its cogging: add [pitch] cogging = [PITCH] in m; it can feed forward: friction, gravity"
    );
    assert_eq!(
        refusal(&unseen, "friction,mass"),
        "a mass of 4.000 fed forward without a limit; a limit, or the largest acceleration of the log in the model: [range] \
         acceleration = LARGEST"
    );
    assert!(Feedforward::from_names(["mass"]).is_err());
    assert!(Feedforward::from_names(["friction", "weight"]).is_err());
    options.target = Target::Tf5200;
    options.rated_force = Some(200.0);
    let error = bench.export_to("table", &options).unwrap_err().to_string();
    assert!(
        error.contains("a feedforward beside friction for the target tf5200"),
        "{error}"
    );
}

/// However a model writes the unit of its torque, a simulated joint takes it.
#[test]
fn a_torque_is_a_torque_for_every_target() {
    for unit in ["N*m", "N m", "Nm", "N·m"] {
        let joint = [
            ("sigma0", 1.2e5, "N m/rad"),
            ("sigma1", 300.0, "N m s/rad"),
            ("coulomb", 20.0, "N m"),
            ("static", 30.0, "N m"),
            ("stribeck_velocity", 5e-3, "rad/s"),
            ("sigma2", 60.0, "N m s/rad"),
        ];
        let model = text("lugre", &joint)
            .replace("kind = \"linear\"", "kind = \"rotary\"")
            .replace("force_unit = \"N\"", &format!("force_unit = \"{unit}\""));
        for target in [Target::Mujoco, Target::Urdf, Target::C] {
            let bench = Bench::new();
            let mut options = bench.options(&model);
            options.target = target;
            let exported = bench.export_to("out", &options).unwrap();
            assert_eq!(exported.force_unit, "N m", "{unit}");
        }
    }
}

/// Code for a call at another rate than that of the log says so, but for a simulated joint, whose steps are no calls.
#[test]
fn another_cycle_than_that_of_the_log_is_said() {
    let model = text("lugre", &LUGRE);
    let at = |rate: &str| model.replace("seed = 0\n", &format!("seed = 0\nrate_hz = {rate}\n"));
    let warned = |model: &str, target: Target, cycle: f64| {
        let bench = Bench::new();
        let mut options = bench.options(model);
        (options.target, options.cycle_time) = (target, cycle);
        let exported = bench.export_to("out", &options).unwrap();
        let mut codes = exported.warnings.iter().map(|w| w.code.as_str());
        codes.any(|code| code == "export-rate")
    };
    for (rate, cycle, differs) in [
        ("500.0", 1e-3, true),
        ("500.0", 2e-3, false),
        ("999.7", 1e-3, false),
        ("4000.2", 250e-6, false),
        ("2.0", 0.1, false),
    ] {
        assert_eq!(
            warned(&at(rate), Target::C, cycle),
            differs,
            "{rate} {cycle}"
        );
        assert!(!warned(&at(rate), Target::Mujoco, cycle));
    }
    assert!(!warned(&model, Target::C, 1e-3));
}

/// The numbers in a row that follows a text.
fn numbers_after(text: &str, mark: &str) -> Vec<f64> {
    let row = text.split(mark).nth(1).unwrap().lines().next().unwrap();
    let parts = row.split([',', ' ']).filter(|part| !part.is_empty());
    parts.map(|part| part.parse().unwrap()).collect()
}

/// Cogging and gap of a model file reach their maps, whatever is fed forward, and the gap the head of every file.
#[test]
fn what_stands_beside_friction_reaches_its_map() {
    let model = with_gap_and_cogging();
    let bench = Bench::new();
    let export = |target, folder: &'static str| {
        let mut options = bench.options(&model);
        options.target = target;
        let exported = bench.export_to(folder, &options).unwrap();
        let name = exported.name;
        let path = bench.path(folder);
        move |end: &str| std::fs::read_to_string(path.join(format!("{name}_{end}"))).unwrap()
    };
    let table = export(Target::CoggingMap, "cogging")("cogging_map.csv");
    // A quarter of the pitch is a row: the sine alone.
    let quarter = numbers_after(&table, "\n0.006,");
    assert!((quarter[0] - 1.5).abs() < 1e-12, "{quarter:?}");
    let read = export(Target::Backlash, "gap");
    assert_eq!(numbers_after(&read("linuxcnc.ini"), "\nBACKLASH ="), [0.02]);
    assert_eq!(
        numbers_after(&read("linuxcnc_comp.txt"), "400.0"),
        [0.01, -0.01]
    );
    let joint = export(Target::Mujoco, "joint")("friction.xml");
    for text in [&table, &joint] {
        let says = "backlash = 2.000000e-5 m, 1.8000e-5 to 2.2000e-5";
        assert!(text.contains(says), "{text}");
    }
    assert!(joint.contains("range=\"-1e-5 1e-5\""), "{joint}");
}

#[test]
fn a_map_of_what_the_model_does_not_have_is_refused() {
    let (plain, whole) = (text("lugre", &LUGRE), with_gap_and_cogging());
    let without = |line: &str| whole.replace(line, "");
    for (target, model, says) in [
        (Target::Backlash, plain.clone(), "the model has no backlash"),
        (
            Target::Backlash,
            whole.replace("[1.8e-5,", "[0.0,"),
            "reaches 0",
        ),
        (Target::CoggingMap, plain, "[terms] cogging = "),
        (
            Target::CoggingMap,
            without("cogging = [0.024]"),
            "no pitch of its cogging",
        ),
        (
            Target::CoggingMap,
            without("position = [0.0, 0.4]"),
            "[range] position",
        ),
    ] {
        let bench = Bench::new();
        let mut options = bench.options(&model);
        options.target = target;
        let error = bench.export_to("out", &options).unwrap_err();
        assert_eq!(error.code().as_str(), "not-exported");
        assert!(error.to_string().contains(says), "{error}");
        options.gain = Some(0.5);
        let error = bench.export_to("out", &options).unwrap_err().to_string();
        let says = "it has no friction";
        assert!(
            error.contains("a gain for the target") && error.contains(says),
            "{error}"
        );
    }
}
