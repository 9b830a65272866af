//! The text that the receiving engineer reads, of a small model.

mod common;

use common::{laws, model};
use stiction_export::{Advice, Model, Target, advice, export};
use stiction_friction::compensator::Friction;
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
        (Target::St, vec!["FB_x_axis_Friction_R.st"]),
        (Target::TcPou, vec!["FB_x_axis_Friction.TcPOU"]),
        (Target::Rust, vec!["Cargo.toml", "src/lib.rs"]),
        (Target::Mujoco, vec!["x_axis_friction.xml"]),
        (Target::Hal, vec!["x_axis_friction.comp"]),
        (Target::Fmu, vec!["modelDescription.xml"]),
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

/// Every file of every target: ASCII, and at its head the parameters with intervals, the hashes and the notes.
#[test]
fn every_file_says_where_it_came_from() {
    let mut model = small();
    model.title = "größe */ *) --> ]]> @name@ %if".into();
    model.notes = vec!["the data do not determine sigma1".into()];
    for target in Target::ALL {
        let files = export(&model, target).unwrap();
        let (archives, mut files): (Vec<_>, Vec<_>) =
            files.into_iter().partition(|f| f.path.ends_with(".fmu"));
        files.extend(archives.iter().flat_map(common::parts));
        for file in files {
            let text = String::from_utf8(file.bytes).unwrap();
            assert!(text.is_ascii(), "{}", file.path);
            // These have the sum of the model, and the source beside them its head.
            if file.path.ends_with("Description.xml") {
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
        .map(|a: &Advice| a.code)
        .collect()
}

#[test]
fn advice_is_given_where_it_applies() {
    // 0.75 (12 N + 30 N s/m v) is 60 N at 2.27 m/s.
    let mut small = small();
    assert_eq!(codes(&small), ["export-limit"]);
    assert!(
        advice(&small, Target::C)[0]
            .message
            .contains("reaches at 2.267 m/s")
    );
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
    assert_eq!(advice(&long, Target::Hal)[0].code, "export-name");
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
            if target == Target::Mujoco {
                let error = export(&model, target).unwrap_err().to_string();
                assert!(
                    error.contains("takes forces in N") && error.contains(written),
                    "{error}"
                );
                continue;
            }
            let files = export(&model, target).unwrap();
            let (archives, mut files): (Vec<_>, Vec<_>) =
                files.into_iter().partition(|f| f.path.ends_with(".fmu"));
            files.extend(archives.iter().flat_map(common::parts));
            for file in files {
                let text = String::from_utf8(file.bytes).unwrap();
                let newton = text
                    .split(|c: char| !c.is_alphanumeric())
                    .any(|word| word == "N");
                assert!(!newton, "{}", file.path);
                if !file.path.ends_with("Description.xml") {
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
