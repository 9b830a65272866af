//! The text that the receiving engineer reads, of a small model.

use crate::common;
use crate::common::{laws, model};
use stiction_export::{Advice, Model, Target, advice, export};
use stiction_friction::compensator::{Channel, Friction, Levels, Weight};
use stiction_friction::{Damping, Direction, LuGre, Shape, Stribeck};

/// The friction of the bench stage.
fn small() -> Model {
    model(laws().remove(0).1)
}

#[test]
fn texts() {
    for (target, wanted) in [
        (
            Target::C,
            vec!["x_axis_friction.h", "x_axis_friction_f32.c"],
        ),
        (
            Target::Cpp,
            vec![
                "src/x_axis_friction.hpp",
                "library.properties",
                "library.json",
            ],
        ),
        (
            Target::Ros2,
            vec![
                "include/x_axis_friction_ros2.hpp",
                "config/x_axis_friction.yaml",
            ],
        ),
        (Target::St, vec!["FB_x_axis_Friction_R.st"]),
        (Target::TcPou, vec!["FB_x_axis_Friction.TcPOU"]),
        (Target::Rust, vec!["Cargo.toml", "src/lib.rs"]),
        (Target::Mujoco, vec!["x_axis_friction.xml"]),
        (Target::Urdf, vec!["x_axis_friction.urdf"]),
        (Target::Sdf, vec!["x_axis_friction.sdf"]),
        (Target::IsaacLab, vec!["x_axis_friction.py"]),
        (Target::Newton, vec!["x_axis_newton.py"]),
        (Target::Bam, vec!["x_axis_bam.json"]),
        (Target::DomainJson, vec!["x_axis_domain.json"]),
        (Target::Hal, vec!["x_axis_friction.comp"]),
        (Target::Modelica, vec!["x_axis_friction.mo"]),
        (Target::Fmu, vec!["modelDescription.xml"]),
        (
            Target::Matlab,
            vec![
                "x_axis_step.m",
                "x_axis_friction_block.m",
                "x_axis_friction_sfun.c",
            ],
        ),
    ] {
        let files = export(&small(), target).unwrap();
        // Of the FMUs the first, FMI 2.0.
        let archive = files.iter().find(|f| f.path.ends_with(".fmu"));
        let inside = archive.map(common::parts).unwrap_or_default();
        for file in files.into_iter().chain(inside) {
            if wanted.contains(&file.path.as_str()) {
                let text = String::from_utf8(file.bytes).unwrap();
                insta::assert_snapshot!(file.path.replace('/', "_"), text);
            }
        }
    }
}

/// The model, with what a map of it shows.
fn wanted(model: &Model, target: Target) -> Model {
    match target.is_map() {
        true => common::terms::with_cogging_and_gap(model.clone()),
        false => model.clone(),
    }
}

/// Whether a file is one of the law itself, the same for every model.
fn is_the_law(path: &str) -> bool {
    path.starts_with("stiction-friction/")
}

/// Every file of every target: ASCII, and at its head the parameters with intervals, the hashes and the notes.
#[test]
fn every_file_says_where_it_came_from() {
    let mut model = small();
    model.title = "größe */ *) --> ]]> @name@ %if".into();
    model.notes = vec!["the data do not determine sigma1".into()];
    for target in Target::ALL {
        let files = export(&wanted(&model, target), target).unwrap();
        let (archives, mut files): (Vec<_>, Vec<_>) =
            files.into_iter().partition(|f| f.path.ends_with(".fmu"));
        files.extend(archives.iter().flat_map(common::parts));
        for file in files {
            let text = String::from_utf8(file.bytes).unwrap();
            assert!(text.is_ascii(), "{}", file.path);
            // These have the sum of the model, and the source beside them its head; the law of the Rust crate is that of every axis.
            let without = file.path.ends_with("Description.xml") || file.path.ends_with(".json");
            if without || is_the_law(&file.path) {
                continue;
            }
            for part in [
                "sigma0 = 1.200000e5 N/m, 1.1000e5 to 1.3000e5",
                "NOT determined",
                "NOTE: the data",
                "sha256 0000",
                "sha256 1111",
            ] {
                assert!(text.contains(part), "{}: {part}", file.path);
            }
        }
    }
}

fn codes(model: &Model) -> Vec<&'static str> {
    advice(model, Target::C)
        .iter()
        .map(|a: &Advice| a.code.as_str())
        .collect()
}

#[test]
fn advice_is_given_where_it_applies() {
    // 12 N + 30 N s/m v is 60 N at 1.6 m/s, and three quarters of it at 2.27 m/s.
    let mut small = small();
    assert_eq!(codes(&small), ["export-limit"]);
    assert!(
        advice(&small, Target::C)[0]
            .message
            .contains("reaches at 1.6 m/s with a gain of 1, at 2.267 m/s with 0.75")
    );
    // Between the share of the gain and the whole, the offset counted: 18 N at rest, of which 13.5 N.
    for (limit, says) in [
        (18.01, "which the friction reaches at 0.200"),
        (17.0, "enough for a gain of 0.75 up to 0.35"),
        (
            13.4,
            "below the share 0.75 of the friction at standstill of 18 N",
        ),
    ] {
        small.settings.limit = limit;
        let said = advice(&small, Target::C).remove(0).message;
        assert!(said.contains(says), "{said}");
    }
    let said = |limit, target, offset| {
        let side = Direction {
            coulomb: 1.1,
            static_friction: 1.6,
            stribeck_velocity: 0.05,
            viscous: 0.06,
        };
        let curve = Stribeck::symmetric(Shape::Gaussian, side, offset).unwrap();
        let mut model = model(Friction::Stribeck(curve));
        model.settings.limit = limit;
        model.rated_force = Some(6.0);
        advice(&model, target).remove(0).message
    };
    assert!(
        said(1.21, Target::C, 0.1)
            .contains("below the share 0.75 of the friction at standstill of 1.7 N")
    );
    assert!(said(1.3, Target::Tf5200, 0.0).contains("below the friction at standstill of 1.6 N"));
    assert!(said(1.6, Target::C, 0.0).contains(
        "not above the friction at standstill of 1.6 N: enough for a gain of 0.75 up to 17.22 m/s"
    ));
    small.settings.limit = 1e6;
    assert_eq!(codes(&small), [""; 0]);
    let Friction::LuGre(law) = small.friction else {
        unreachable!("the small model has bristles")
    };
    let change = |stiffness: f64, damping| {
        let law = LuGre::new(stiffness, damping, *law.curve()).unwrap();
        Model {
            friction: Friction::LuGre(law),
            ..small.clone()
        }
    };
    // Olsson's condition for v to infinity: sigma1 <= sigma2 Fc/(Fs - Fc) = 60 N s/m; nearer to rest more is allowed.
    assert_eq!(
        codes(&change(2e6, Damping::Constant(1e3))),
        ["export-damping"]
    );
    assert_eq!(codes(&change(2e6, Damping::Constant(59.0))), [""; 0]);
    // At 30 mm/s the level is Fc: (30 + 18 18/12/v)/(18/12 - 1) = 1860 N s/m, and 2000 N s/m at 27.8 mm/s.
    for (sigma1, top, says) in [
        (1859.0, 0.03, ""),
        (2e3, 0.0278, ""),
        (
            2e3,
            0.03,
            "is passive up to 0.02784 m/s only; the code has at most 1860 N s/m at 0.03 m/s (the largest speed of the log): nothing to do",
        ),
    ] {
        let mut model = change(2e6, Damping::Constant(sigma1));
        model.top_speed = Some(top);
        let found = advice(&model, Target::C);
        assert_eq!(found.len(), usize::from(!says.is_empty()), "{found:?}");
        assert!(found.iter().all(|a| a.message.contains(says)), "{found:?}");
    }
    // 18 N / 1e12 N/m and 3 mm/s: 6 ns; 18 N / 1.52e6 N/m: 3.95 ms.
    for (stiffness, cycle, says) in [
        (1e12, 1e-3, "no allowed cycle (1e-6 s or more) resolves it"),
        (1.52e6, 4e-3, "ask for a cycle below 3.9e-3 s"),
        (2e6, 4e-3, "ask for a cycle below 3.0e-3 s"),
    ] {
        let mut model = change(stiffness, Damping::Capped(0.0));
        model.settings.cycle_time = cycle;
        let said = advice(&model, Target::C).remove(0).message;
        assert!(said.contains(says), "{said}");
    }
    // 18 N / 1e7 N/m = 1.8 um, and 3 um at 3 mm/s for 1 ms.
    assert_eq!(
        codes(&change(1e7, Damping::Capped(0.0))),
        ["export-cycle-time"]
    );
    let mut limited = small.clone();
    limited.settings.limit = 13.4;
    assert_eq!(codes(&limited), ["export-limit"]);
    // A law whose level is the same at every speed has no Stribeck velocity to speak of.
    let flat = Direction {
        coulomb: 12.0,
        static_friction: 12.0,
        stribeck_velocity: 1.0,
        viscous: 0.0,
    };
    let flat = Stribeck::symmetric(Shape::Gaussian, flat, 0.0).unwrap();
    let dahl = LuGre::new(2e6, Damping::Capped(0.0), flat).unwrap();
    assert_eq!(
        codes(&Model {
            friction: Friction::LuGre(dahl),
            ..small.clone()
        }),
        [""; 0]
    );
    let long = Model {
        identifier: "gantry_axis_number_1_left_side".into(),
        ..small.clone()
    };
    assert_eq!(codes(&long), [""; 0]);
    assert_eq!(advice(&long, Target::Hal)[0].code.as_str(), "export-name");
    assert_eq!(advice(&small, Target::Hal), []);
    insta::assert_snapshot!(
        "advice",
        [Target::C, Target::Mujoco, Target::Tf5200]
            .into_iter()
            .flat_map(|target| advice(&change(1e7, Damping::Constant(1e4)), target))
            .map(|a| format!("{}: {}\n", a.code, a.message))
            .collect::<String>()
    );
}

/// With a weight beside friction, and friction that changes, the limit is that of all of it: 50 N + 12 N + 30 N s/m v.
#[test]
fn a_limit_is_held_against_the_sum() {
    let mut model = small();
    model.friction = model.friction.without_offset().unwrap();
    model.terms.weight = Some(Weight {
        constant: -50.0,
        ..Weight::default()
    });
    model.terms.mass = 4.6;
    let said = |model: &Model| match advice(model, Target::C).as_slice() {
        [one] => one.message.clone(),
        other => format!("{other:?}"),
    };
    model.settings.limit = 70.0;
    let text = said(&model);
    let at = "friction and weight, where most of it adds up, goes beyond at 0.2667 m/s with a gain of 1, at 0.4889 m/s with a \
              gain of 0.75";
    assert!(
        text.contains(at) && text.contains("What the mass needs"),
        "{text}"
    );
    // Half as much friction again at 290 K.
    model.terms.channels.temperature = Channel {
        reference: 300.0,
        range: [290.0, 304.0],
        turns: false,
    };
    model.terms.levels = Some(Levels {
        temperature: [-0.05, -0.05],
        ..Levels::default()
    });
    let text = said(&model);
    assert!(
        text.contains("at standstill with a gain of 1 (77 N)"),
        "{text}"
    );
    model.settings.limit = 80.0;
    assert!(
        said(&model).contains("goes beyond at 0.4 m/s with a gain of 1"),
        "{}",
        said(&model)
    );
    model.top_speed = Some(0.39);
    assert_eq!(said(&model), "[]");
}

/// A model whose force is a current says so wherever a force is named, and no target calls it N; one that takes forces
/// only refuses it.
#[test]
fn a_current_is_no_force() {
    for (unit, written) in [("A", "in A"), ("1", "in p.u.")] {
        let mut model = small();
        model.force_unit = unit.into();
        for p in &mut model.parameters {
            p.unit = p.unit.replace('N', unit);
        }
        for target in Target::ALL {
            if target.is_simulated() {
                let error = export(&model, target).unwrap_err().to_string();
                assert!(
                    error.contains("needs forces in N") && error.contains(written),
                    "{error}"
                );
                continue;
            }
            if target == Target::DriveTable && unit == "1" {
                // No drive counts in it.
                assert!(export(&model, target).is_err());
                continue;
            }
            let files = export(&wanted(&model, target), target).unwrap();
            let (archives, mut files): (Vec<_>, Vec<_>) =
                files.into_iter().partition(|f| f.path.ends_with(".fmu"));
            files.extend(archives.iter().flat_map(common::parts));
            for file in files.into_iter().filter(|file| !is_the_law(&file.path)) {
                let text = String::from_utf8(file.bytes).unwrap();
                let newton = text
                    .split(|c: char| !c.is_alphanumeric())
                    .any(|word| word == "N");
                assert!(!newton, "{}", file.path);
                assert!(
                    !text.contains("p.u..s") && !text.contains("e5 1/m"),
                    "{}",
                    file.path
                );
                if !file.path.ends_with("Description.xml") && !file.path.ends_with(".json") {
                    assert!(
                        text.contains(&format!("The force is {written}")),
                        "{}",
                        file.path
                    );
                }
            }
        }
    }
}
