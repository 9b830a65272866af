//! Which columns are recognised, what is assumed, and what is refused with the choices.

use crate::mapping_common::{axis, codes, column, message, table, told};
use stiction_formats::text::{TextOptions, read};
use stiction_formats::{Kind, Table, Unit, Value};
use stiction_log::{Channel, Elsewhere, Joined, Log, Mapping, Motion, Offset, Role, Selector};

/// A table with these headers; samples that move, each column its own.
fn headed(headers: &[&str]) -> Table {
    let columns = headers.iter().enumerate().map(|(k, header)| {
        let value = |i: usize| {
            let t = i as f64 / 500.0;
            if k == 0 {
                t
            } else {
                (3.0 * t + k as f64).sin() * (1.0 + k as f64)
            }
        };
        column(header, (0..1000).map(value).collect())
    });
    table(columns.collect())
}

fn picked(headers: &[&str]) -> String {
    match Mapping::detect(&headed(headers)) {
        Err(error) => format!("{:?}: {error}", error.kind),
        Ok(detected) => {
            let notes = detected
                .findings
                .iter()
                .map(|f| format!("{}: {}", f.code(), f));
            detected
                .phrases
                .into_iter()
                .chain(notes)
                .collect::<Vec<_>>()
                .join("\n")
        }
    }
}

/// What is said of each row of headers, one block a row.
fn pick_each(rows: &[&[&str]]) -> String {
    let blocks: Vec<_> = rows
        .iter()
        .map(|row| format!("{}\n{}", row.join(" | "), picked(row)))
        .collect();
    blocks.join("\n\n")
}

#[test]
fn what_is_recognised() {
    insta::assert_snapshot!(pick_each(&[
        &["Time [s]", "Position [mm]", "Friction [uN]", "Normal [uN]"],
        &["t", "q", "dq", "tau"],
        &[
            "time [ms]",
            "act_pos [deg]",
            "act_vel [rpm]",
            "current [Arms]"
        ],
        &[
            "Time [s]",
            "MAIN.fSetPos [mm]",
            "MAIN.fActPos [mm]",
            "MAIN.fActVelo [mm/s]",
            "MAIN.fActTorque [Nm]",
            "MAIN.fPosError [mm]",
            "MotorTemp [degC]",
        ],
        &[
            "time",
            "position",
            "velocity",
            "torque_feedback",
            "command",
            "position_cmd",
            "velocity_cmd",
            "acceleration_cmd",
            "state",
            "mos_temperature",
        ],
        &["t [s]", "Axis 1 [mm]", "Load cell [kN]"],
        &["t [s]", "position [m]", "desired_force [N]"],
        &["t [s]", "position [m]", "noise [V/s]"],
        &["t [s]", "angle [rad]", "pwm duty [%]"],
        &["rec.t", "rec.q", "rec.tau", "rec.q_ref"],
        &["t_s", "joint.position", "joint.effort"],
        &["t [s]", "orientation.x", "orientation.w", "force [N]"],
        &[
            "header.stamp [s]",
            "elbow.position [rad]",
            "elbow.effort [N m]",
            "elbow.velocity [rad/s]",
            "wrist.effort [N m]"
        ],
    ]));
}

/// German controllers put names together: `Soll` is asked for, `Ist` is measured, `Schleppfehler` is neither.
/// A typing error that makes a length of a torque.
#[test]
fn a_torque_in_nanometres_leads_to_newton_metres() {
    let said = picked(&["t [s]", "q [rad]", "tau [nm]"]);
    assert!(said.contains("nm are nanometres"), "{said}");
    let line = r#"force = { column = "tau", unit = "N m" }"#;
    assert!(said.contains(line), "{said}");
    assert!(!picked(&["t [s]", "q [rad]", "gap [nm]"]).contains("nanometres"));
}

#[test]
fn german_names_are_taken_apart() {
    insta::assert_snapshot!(pick_each(&[
        &[
            "Zeit [ms]",
            "Istposition [mm]",
            "Motorstrom [A]",
            "Sollposition [mm]",
            "Sollgeschwindigkeit [mm/s]",
            "Istgeschwindigkeit [mm/s]",
            "Schleppfehler [mm]",
        ],
        &[
            "Zeit [s]",
            "Lagesollwert [deg]",
            "Lageistwert [deg]",
            "Drehzahlistwert [rpm]",
            "Drehmomentsollwert [Nm]",
            "Drehmomentistwert [Nm]",
        ],
        &[
            "Zeit [s]",
            "Winkel Soll [deg]",
            "Winkel Ist [deg]",
            "Drehmoment [Nm]"
        ],
    ]));
}

/// A unit at the end of a name counts as one in brackets, where it is none of a motor, a phase or a load.
#[test]
fn units_at_the_end_of_names_are_read() {
    insta::assert_snapshot!(pick_each(&[
        &["T_us", "J3_q_act_deg", "J3_q_cmd_deg", "J3_M_mot_Nm"],
        &["Zeit_ms", "AchseY.Istpos", "AchseY.Sollpos", "Motorstrom_A"],
        &["t_s", "pos_mm", "force_N"],
        &["t_s", "position_m", "i_mA"],
        // No units: a motor beside a load, a measured angle, an axis.
        &["t", "pos_m", "pos_l", "tau"],
        &["t", "q_m", "tau_m"],
        &["t", "x_A", "F_A"],
        // Marked as units, whatever they are.
        &["time, s", "position, mm", "force, N"],
        &["Zeit / ms", "Weg / mm", "Strom / mA"],
        &["t in s", "x in mm", "speed in mm/s", "F in kN"],
        &["t", "pos, left", "force / axis"],
        // Quantities over their units, where all strokes are so: not in paths, nor in one name alone.
        &["Zeit/s", "Weg/mm", "v/(mm/s)", "Kraft/N"],
        &["t/s", "s/mm", "F/N"],
        &["t/s", "arm/position", "arm/force"],
        &["t", "position", "motor/A"],
    ]));
    let line = |headers: &[&str], column: &str, role: &str| {
        let mapping = Mapping {
            time: Some(Channel::named(column)),
            ..Mapping::default()
        };
        let found = mapping.complete(&headed(headers)).unwrap();
        let told = found
            .columns
            .into_iter()
            .find(|c| c.role.is_some_and(|r| r.to_string() == role));
        told.unwrap().reason
    };
    assert_eq!(
        line(&["Zeit_ms", "pos_mm", "F_N"], "Zeit_ms", "time"),
        "named in the axis file; its unit from the ending of its name"
    );
}

#[test]
fn what_is_refused_with_the_choices() {
    insta::assert_snapshot!(pick_each(&[
        &["t [s]", "x [m]", "current [A]", "torque [N m]"],
        &["t [s]", "position [m]", "force"],
        &["t [s]", "position [counts]", "force [N]"],
        &["t", "position", "velocity", "current"],
        &["", "", "", ""],
        &[
            "t [s]",
            "motor_position [rad]",
            "load_position [rad]",
            "torque [Nm]"
        ],
        &["t [s]", "position [parsec]", "force [N]"],
        &[
            "time of fActPos [ms]",
            "fActPos [mm]",
            "time of fActTorque [ms]",
            "fActTorque [Nm]",
        ],
        &["t [s]", "force [N]"],
        &["t [s]", "force [N]", "way"],
        &["t [s]", "position [%]", "force [N]"],
        &["position [m]", "force [N]"],
        &[],
    ]));
}

/// A lone `X` names the position of any axis, but beside a `Y` one axis of two.
#[test]
fn motion_and_force_are_of_one_axis() {
    insta::assert_snapshot!(pick_each(&[
        &[
            "t [s]",
            "X act [mm]",
            "X current [A]",
            "Y act [mm]",
            "Y current [A]"
        ],
        &["t [s]", "X [mm]", "IX [A]", "Y [mm]", "IY [A]"],
        &[
            "t [s]",
            "X cmd [mm]",
            "X act [mm]",
            "X current [A]",
            "Y cmd [mm]",
            "Y act [mm]",
            "Y current [A]"
        ],
        &["t [s]", "X act [mm]", "Y current [A]"],
        &["t [s]", "Y act [mm]", "Y current [A]"],
        &[
            "t [s]",
            "Axis 1 pos [mm]",
            "Axis 1 current [A]",
            "Axis 2 pos [mm]",
            "Axis 2 current [A]"
        ],
        &["t [s]", "x [mm]", "y [N]"],
        &["x", "v", "t"],
    ]));
}

#[test]
fn the_motion_is_that_of_the_axis_whose_force_is_named() {
    let names = [
        "t [s]",
        "X act [mm]",
        "X current [A]",
        "Y act [mm]",
        "Y current [A]",
    ];
    for (force, position) in [("X current", "X act"), ("Y current", "Y act")] {
        let mapping = Mapping {
            force: Some(Channel::named(force)),
            ..Mapping::default()
        };
        let found = mapping.complete(&headed(&names)).unwrap().mapping;
        assert_eq!(
            found.position.unwrap().column,
            Selector::Name(position.into())
        );
        let mapping = Mapping {
            position: Some(Channel::named(position)),
            ..Mapping::default()
        };
        let found = mapping.complete(&headed(&names)).unwrap().mapping;
        assert_eq!(found.force.unwrap().column, Selector::Name(force.into()));
    }
    let short = ["t [s]", "X [mm]", "IX [A]", "Y [mm]", "IY [A]"];
    let mapping = Mapping {
        force: Some(Channel::named("IY")),
        ..Mapping::default()
    };
    let found = mapping.complete(&headed(&short)).unwrap().mapping;
    assert_eq!(found.position.unwrap().column, Selector::Name("Y".into()));
    let alone = ["t [s]", "X act [mm]", "Y current [A]"];
    let mapping = Mapping {
        force: Some(Channel::named("Y current")),
        ..Mapping::default()
    };
    let error = mapping.complete(&headed(&alone)).unwrap_err();
    assert_eq!(error.kind, Kind::Ambiguous);
    assert_eq!(Mapping::clear_columns(&headed(&names)).position, None);
}

/// What is found by its name stays where another column is named, unless the mapping says that there is none.
#[test]
fn naming_one_column_drops_no_other() {
    let table = headed(&[
        "t [s]",
        "position [mm]",
        "position reference [mm]",
        "acceleration [m/s^2]",
        "temperature [degC]",
        "force [N]",
    ]);
    let detected = Mapping::detect(&table).unwrap().mapping;
    let given = Mapping {
        force: Some(Channel::named("force").scale(Value::parse("2 N/N").unwrap())),
        ..Mapping::default()
    };
    let found = given.complete(&table).unwrap().mapping;
    for role in Role::OPTIONAL {
        assert_eq!(found.channel(role), detected.channel(role), "{role}");
    }
    assert!(found.reference.is_some() && found.acceleration.is_some());
    assert!(given.wanted(&table).iter().all(|wanted| *wanted));
    let given = Mapping {
        absent: vec![Role::Reference, Role::Temperature],
        ..given
    };
    let found = given.complete(&table).unwrap();
    let there = Role::OPTIONAL.map(|role| found.mapping.channel(role).is_some());
    assert_eq!(there, [true, false, false, false]);
    let why = &found.columns[2].reason;
    assert!(why.contains("reference = \"none\""), "{why}");
}

/// A reference is read as the position that is named, and neither is taken of another axis or behind a gear.
#[test]
fn what_is_found_beside_a_named_motion_is_read_as_that_is() {
    let table = headed(&[
        "t [s]",
        "pos [rad]",
        "pos ref [rad]",
        "acc [rad/s^2]",
        "torque [N m]",
    ]);
    let position = Channel::named("pos").inverted();
    let with = |position: Channel| {
        let given = Mapping {
            position: Some(position),
            ..Mapping::default()
        };
        given.complete(&table).unwrap().mapping
    };
    let turned = with(position.clone());
    assert!(turned.reference.unwrap().invert && turned.acceleration.unwrap().invert);
    let geared = with(position.scale(Value::parse("0.01").unwrap()));
    let reference = geared.reference.unwrap();
    assert_eq!(reference.scale, geared.position.unwrap().scale);
    assert_eq!(geared.acceleration, None);

    let two = headed(&[
        "t [s]",
        "X act [mm]",
        "X current [A]",
        "Y act [mm]",
        "Y current [A]",
        "Y ref [mm]",
    ]);
    for (force, is_found) in [("X current", false), ("Y current", true)] {
        let given = Mapping {
            force: Some(Channel::named(force)),
            ..Mapping::default()
        };
        let found = given.complete(&two).unwrap().mapping;
        assert_eq!(found.reference.is_some(), is_found, "{force}");
    }
    // One that does not fit is left out, and refuses nothing.
    let degrees = headed(&["t [s]", "x [mm]", "ref position [deg]", "force [N]"]);
    let given = Mapping {
        force: Some(Channel::named("force")),
        ..Mapping::default()
    };
    assert_eq!(given.complete(&degrees).unwrap().mapping.reference, None);
}

#[test]
fn a_time_without_unit_is_seconds_only_where_that_is_plausible() {
    let milli: Vec<f64> = (0..1000).map(f64::from).collect();
    let mut table = headed(&["t", "x [m]", "F [N]"]);
    table.columns[0].values.clone_from(&milli);
    let error = Mapping::detect(&table).unwrap_err();
    insta::assert_snapshot!(error.to_string());
    let mapping = Mapping {
        time: Some(Channel::named("t").unit(Unit::parse("ms").unwrap())),
        ..Mapping::default()
    };
    let log = Log::from_table(&table, &mapping).unwrap();
    assert_eq!(log.rate_hz, 1000.0);
    assert_eq!(log.time[999], 0.999);
}

/// A text whose rows hold two bases: nothing in the samples shows that the rows have nothing to do with each other.
#[test]
fn columns_behind_other_time_stamps_are_not_mixed() {
    let table = |own: f64, rows: usize| {
        let mut table = headed(&["t1 [ms]", "position [deg]", "t2 [ms]", "torque [N m]"]);
        table.columns[0].values = (0..1000).map(f64::from).collect();
        let stamp = |i: usize| match i < rows {
            true => 7.0 + own * i as f64,
            false => f64::NAN,
        };
        table.columns[2].values = (0..1000).map(stamp).collect();
        table
    };
    let given = Mapping {
        time: Some(Channel::named("t1")),
        ..Mapping::default()
    };
    for (table, mapping) in [
        (table(2.0, 500), &given),
        (table(2.0, 1000), &given),
        // The time of the log is that which the position stands behind.
        (table(2.0, 500), &Mapping::default()),
    ] {
        let error = Log::from_table(&table, mapping).unwrap_err();
        insta::allow_duplicates! { insta::assert_snapshot!(error.to_string()) };
    }
    // Two clocks of the same rows, which is which has to be said and no more.
    assert!(Log::from_table(&table(1.0001, 1000), &given).is_ok());
    assert!(Log::from_table(&table(1.0001, 1000), &Mapping::default()).is_err());
    // Joined by their stamps, or by those of the log, they are what the axis file says.
    for stamps in ["t1", "t2"] {
        let table = table(2.0, 500);
        let mapping = Mapping {
            force: Some(Channel::named("torque")),
            ..given.clone()
        };
        let mut joined = Joined::new(table.clone(), &mapping);
        let from = Elsewhere {
            role: Role::Force,
            time: Some(Channel::named(stamps)),
            offset: Offset::Given(0.0),
        };
        joined.join("the log itself", &table, &from).unwrap();
        Log::from_joined(&joined).unwrap();
    }
}

#[test]
fn equal_columns_are_one_column() {
    // The same channel in three charts comes three times.
    let mut table = headed(&["t [s]", "x [m]", "x [m]", "F [N]"]);
    table.columns[2].values = table.columns[1].values.clone();
    let detected = Mapping::detect(&table).unwrap();
    assert_eq!(
        detected.mapping.position.unwrap().column,
        Selector::Index(2)
    );
}

#[test]
fn a_column_has_one_role() {
    let table = headed(&["t [s]", "x [m]", "F [N]"]);
    let mapping = Mapping {
        position: Some(Channel::index(3)),
        force: Some(Channel::named("F")),
        ..Mapping::default()
    };
    insta::assert_snapshot!(Log::from_table(&table, &mapping).unwrap_err().to_string());
}

#[test]
fn selectors_by_name_number_and_header() {
    let table = headed(&["t [s]", "Pos A [mm]", "F [N]", "F [kN]"]);
    let log = |column: Selector| {
        let position = Channel {
            column,
            ..Channel::index(1)
        };
        let force = Some(Channel::index(3));
        let mapping = Mapping {
            position: Some(position),
            force,
            ..Mapping::default()
        };
        match Log::from_table(&table, &mapping) {
            Ok(log) => Ok(log.position.unwrap()[10]),
            Err(error) => Err(error.to_string()),
        }
    };
    let expected = table.columns[1].values[10] / 1000.0;
    for name in ["Pos A", "Pos A [mm]", "pos a", " Pos A "] {
        assert_eq!(log(Selector::Name(name.into())).unwrap(), expected);
    }
    assert_eq!(log(Selector::Index(2)).unwrap(), expected);
    let mut lines = Vec::new();
    for name in ["Pos B", "zzz"] {
        lines.push(log(Selector::Name(name.into())).unwrap_err());
    }
    for number in [0, 5] {
        lines.push(log(Selector::Index(number)).unwrap_err());
    }
    let mapping = Mapping {
        force: Some(Channel::named("F")),
        ..Mapping::default()
    };
    lines.push(Log::from_table(&table, &mapping).unwrap_err().to_string());
    insta::assert_snapshot!(lines.join("\n"));
}

#[test]
fn a_column_keeps_its_number_where_another_has_no_numbers() {
    // The same recorder twice: in the second log the temperature was not connected.
    let rows = |temperature: &str| {
        let row = |k: usize| {
            let x = (0.01 * k as f64).sin();
            format!("{}.000,{temperature},jog,{x:.6},{:.6}\n", k, 3.0 * x)
        };
        (0..200).map(row).collect::<String>()
    };
    let mapping = Mapping {
        time: Some(Channel::index(1).unit(Unit::parse("ms").unwrap())),
        position: Some(Channel::index(4).unit(Unit::parse("mm").unwrap())),
        force: Some(Channel::index(5).unit(Unit::parse("N").unwrap())),
        ..Mapping::default()
    };
    let log = |temperature: &str, mapping: &Mapping| {
        let table = read(rows(temperature).as_bytes(), &TextOptions::default()).unwrap();
        Log::from_table(&table, mapping).map_err(|e| e.to_string())
    };
    let (connected, not) = (log("21.5", &mapping).unwrap(), log("", &mapping).unwrap());
    assert_eq!(connected.position, not.position);
    assert_eq!(connected.force, not.force);
    let wrong = Mapping {
        force: Some(Channel::index(2)),
        ..mapping
    };
    insta::assert_snapshot!(log("", &wrong).unwrap_err());
}

#[test]
fn scale_sign_and_unit_give_si() {
    let table = headed(&["t [s]", "x [mm]", "u"]);
    let channel = Channel::named("u")
        .unit(Unit::parse("mV").unwrap())
        .scale(Value::parse("2 N/V").unwrap())
        .inverted();
    let mapping = Mapping {
        force: Some(channel),
        ..Mapping::default()
    };
    let log = Log::from_table(&table, &mapping).unwrap();
    assert_eq!(log.motion, Motion::Linear);
    assert_eq!(log.force_unit, "N");
    for (si, raw) in log
        .force
        .as_ref()
        .unwrap()
        .iter()
        .zip(&table.columns[2].values)
    {
        assert!((si + 2.0 * raw / 1000.0).abs() < 1e-15);
    }
    // The same with the position in counts, and the count implied by the scale.
    let mut table = table;
    table.columns[1].unit = None;
    let mapping = Mapping {
        position: Some(Channel::named("x").scale(Value::parse("3 um/count").unwrap())),
        ..mapping
    };
    let log = Log::from_table(&table, &mapping).unwrap();
    let (si, raw) = (log.position.unwrap()[7], table.columns[1].values[7]);
    assert!((si - 3e-6 * raw).abs() < 1e-20);
}

#[test]
fn wrong_dimensions_are_refused() {
    let table = headed(&["t [s]", "x [mm]", "F [N]"]);
    let unit = |text| Unit::parse(text).unwrap();
    let scale = |text| Value::parse(text).unwrap();
    let base = Mapping {
        motion: Some(Motion::Linear),
        ..Mapping::default()
    };
    let wrong = [
        Mapping {
            position: Some(Channel::named("x").unit(unit("deg"))),
            ..base.clone()
        },
        Mapping {
            force: Some(Channel::named("F").scale(scale("3 N/V"))),
            ..base.clone()
        },
        Mapping {
            time: Some(Channel::named("t").unit(unit("mm"))),
            ..base.clone()
        },
        Mapping {
            velocity: Some(Channel::named("x").unit(unit("1/s"))),
            ..base.clone()
        },
        Mapping {
            force: Some(Channel::named("F").scale(scale("0"))),
            ..base.clone()
        },
        Mapping {
            motion: Some(Motion::Rotary),
            ..base.clone()
        },
        Mapping {
            crop: Some((2.0, 1.0)),
            ..base.clone()
        },
        Mapping {
            rate_hz: Some(f64::NAN),
            ..base.clone()
        },
        Mapping {
            resolution: Some(-1.0),
            ..base.clone()
        },
        Mapping {
            rate_hz: Some(1.0),
            time: Some(Channel::named("t")),
            ..base.clone()
        },
        Mapping {
            crop: Some((5.0, 6.0)),
            ..base
        },
    ];
    let lines: Vec<_> = wrong
        .iter()
        .map(|mapping| Log::from_table(&table, mapping).unwrap_err().to_string())
        .collect();
    insta::assert_snapshot!(lines.join("\n"));
}

#[test]
fn forces_that_are_none_are_said() {
    let torque = headed(&["t [s]", "x [mm]", "torque [N m]"]);
    let log = Log::from_table(&torque, &Mapping::default()).unwrap();
    let mixed = message(&log, "force-unit").to_string();
    let current = headed(&["t [s]", "x [mm]", "current [mA]"]);
    let log = Log::from_table(&current, &Mapping::default()).unwrap();
    insta::assert_snapshot!([mixed, message(&log, "force-not-calibrated")].join("\n"));
    assert_eq!(log.force_unit, "A");
    assert_eq!(log.force.unwrap()[3], current.columns[2].values[3] / 1000.0);
}

#[test]
fn a_unit_in_the_mapping_goes_before_the_file() {
    let table = headed(&["t [s]", "x [mm]", "F [N]"]);
    let position = Some(Channel::named("x").unit(Unit::parse("um").unwrap()));
    let log = Log::from_table(
        &table,
        &Mapping {
            position,
            ..Mapping::default()
        },
    )
    .unwrap();
    assert_eq!(
        log.position.as_ref().unwrap()[5],
        table.columns[1].values[5] / 1e6
    );
    insta::assert_snapshot!(message(&log, "unit-override"));
    // A unit in a name counts as one in brackets.
    let table = headed(&["t/s", "x/mm", "F/N"]);
    let position = |unit: &str| Mapping {
        position: Some(Channel::named("x/mm").unit(Unit::parse(unit).unwrap())),
        ..Mapping::default()
    };
    let log = Log::from_table(&table, &position("m")).unwrap();
    insta::assert_snapshot!(message(&log, "unit-override"), @"position: the recording gives mm, axis.toml gives m: axis.toml is used");
    let log = Log::from_table(&table, &position("mm")).unwrap();
    assert!(!codes(&log).contains(&"unit-override"));
}

#[test]
fn a_complete_mapping_changes_nothing() {
    let table = headed(&["t", "q", "dq", "tau"]);
    let once = Mapping::detect(&table).unwrap();
    let twice = once.mapping.complete(&table).unwrap();
    assert_eq!(once.mapping, twice.mapping);
    let (a, b) = (
        Log::from_table(&table, &Mapping::default()),
        Log::from_table(&table, &once.mapping),
    );
    let (a, b) = (a.unwrap(), b.unwrap());
    assert_eq!(a.position, b.position);
    assert!(codes(&a).contains(&"unit-assumed") && !codes(&b).contains(&"unit-assumed"));
}

#[test]
fn columns_in_play_have_one_length() {
    let mut table = headed(&["t [s]", "x [m]", "F [N]"]);
    table.columns[2].values.truncate(995);
    let log = Log::from_table(&table, &Mapping::default()).unwrap();
    assert_eq!(log.time.len(), 995);
    let cut = told(&log);
    table.columns[2].values.truncate(500);
    let error = Log::from_table(&table, &Mapping::default()).unwrap_err();
    assert_eq!(error.kind, Kind::Value);
    insta::assert_snapshot!(format!("{cut}\n\n{error}"));
}

#[test]
fn the_rate_stands_in_for_time() {
    let mut table = headed(&["", "x [m]", "F [N]"]);
    table.sample_time = Some(0.002);
    let log = Log::from_table(&table, &Mapping::default()).unwrap();
    assert_eq!(log.rate_hz, 500.0);
    let mapping = Mapping {
        rate_hz: Some(4000.0),
        crop: Some((0.05, 0.2)),
        ..Mapping::default()
    };
    let log = Log::from_table(&table, &mapping).unwrap();
    assert_eq!(
        (log.rate_hz, log.start, log.time.len()),
        (4000.0, 0.05, 601)
    );
    assert_eq!(log.position.unwrap()[0], table.columns[1].values[200]);
}

#[test]
fn a_rate_that_beats_time_stamps_without_a_unit_is_said() {
    let read = |step: f64, hertz: f64| {
        let mut table = axis(2000).table();
        let time = (0..2000).map(|i| i as f64 * step).collect();
        table.columns[0] = column("time", time);
        let mapping = Mapping {
            rate_hz: Some(hertz),
            ..Mapping::default()
        };
        Log::from_table(&table, &mapping).unwrap()
    };
    insta::assert_snapshot!(message(&read(0.002, 1000.0), "rate-override"), @r#"rows are counted at rate = "1000 Hz" of axis.toml, and column 1 "time" is not used, which runs at 500 Hz in s. If that is right, delete the line rate and write under [columns]: time = { column = "time", unit = "s" }"#);
    insta::assert_snapshot!(message(&read(5.0, 1000.0), "rate-override"), @r#"rows are counted at rate = "1000 Hz" of axis.toml, and column 1 "time" is not used, which runs at 200 Hz in ms. If that is right, delete the line rate and write under [columns]: time = { column = "time", unit = "ms" }"#);
    insta::assert_snapshot!(read(0.002, 1000.0).columns[0].reason, @"could be the time, which the rate of the axis file is taken for");
    // Seconds, milliseconds, microseconds, and row numbers.
    for (step, hertz) in [
        (0.001, 1000.0),
        (0.001, 1005.0),
        (2.0, 500.0),
        (500.0, 2000.0),
        (1.0, 4000.0),
    ] {
        assert!(
            !codes(&read(step, hertz)).contains(&"rate-override"),
            "{step} {hertz}"
        );
    }
}

#[test]
fn a_rate_that_beats_the_sample_time_of_the_file_is_said() {
    let read = |hertz: f64| {
        let mut table = axis(2000).table();
        table.columns.remove(0);
        table.sample_time = Some(0.002);
        let mapping = Mapping {
            rate_hz: Some(hertz),
            ..Mapping::default()
        };
        Log::from_table(&table, &mapping).unwrap()
    };
    insta::assert_snapshot!(message(&read(1000.0), "rate-override"), @r#"rows are counted at rate = "1000 Hz" of axis.toml, but the file states a sample time of 0.002 s, 500 Hz. If the file is right, delete the line rate"#);
    assert!(!codes(&read(500.0)).contains(&"rate-override"));
}

#[test]
fn a_rate_that_contradicts_the_time_stamps_is_refused() {
    let stamped = |unit: &str, step: f64| {
        let axis = axis(2000);
        let time = (0..2000).map(|i| (i as f64 * step).floor()).collect();
        let mut table = axis.table();
        table.columns[0] = column(&format!("time{unit}"), time);
        table
    };
    let rate = |hertz: f64| Mapping {
        rate_hz: Some(hertz),
        ..Mapping::default()
    };
    // Stamps in whole milliseconds of samples at 4 kHz: the rate is what makes them good.
    for (table, hertz) in [
        (stamped(" [ms]", 1.0), 1000.0),
        (stamped(" [ms]", 0.25), 4000.0),
        // Nothing tells what these count.
        (stamped("", 1.0), 4000.0),
    ] {
        let log = Log::from_table(&table, &rate(hertz)).unwrap();
        assert_eq!(log.rate_hz, hertz);
    }
    for (table, hertz) in [
        (stamped(" [ms]", 1.0), 500.0),
        (stamped(" [ms]", 0.25), 4100.0),
        // The step of the clock is not that of the rows.
        (stamped(" [ms]", 0.25), 1000.0),
        (stamped(" [us]", 1.0), 1000.0),
    ] {
        let error = Log::from_table(&table, &rate(hertz)).unwrap_err();
        assert_eq!(error.kind, Kind::Ambiguous, "{error}");
    }
    let error = Log::from_table(&axis(2000).table(), &rate(500.0)).unwrap_err();
    insta::assert_snapshot!(error.to_string());
}

/// Of stamps that a coarse clock has rounded, between which rows are missing, a rate counts a stretch without gaps, and elsewhere it
/// is said that it does not count the gap.
#[test]
fn a_rate_beside_rounded_stamps_with_a_gap_counts_a_stretch() {
    let mut table = axis(8000).table();
    table.columns[0] = column(
        "time [ms]",
        (0..8000).map(|i| (i as f64 / 0.7).floor()).collect(),
    );
    for column in &mut table.columns {
        column.values.drain(2000..2200);
    }
    let read = |hertz: f64, crop: Option<(f64, f64)>| {
        let mapping = Mapping {
            rate_hz: Some(hertz),
            crop,
            ..Mapping::default()
        };
        Log::from_table(&table, &mapping)
    };
    let whole = read(700.0, None).unwrap();
    insta::assert_snapshot!(message(&whole, "rate-override"));
    let part = read(700.0, Some((5.572, 11.14))).unwrap();
    assert!(!codes(&part).contains(&"rate-override"));
    assert_eq!(part.rate_hz, 700.0);
    assert!(read(1000.0, None).is_err());
}

/// Between stamps in a written unit that a rate agrees with otherwise, rows that are missing are counted by the stamps; jitter of single
/// stamps is none.
#[test]
fn rows_that_are_missing_beside_a_rate_are_counted_by_their_stamps() {
    let read = |lost: &dyn Fn(usize) -> bool, jitter: f64| {
        let mut table = axis(8000).table();
        let time = (0..8000).map(|i| i as f64 + jitter * ((i * i % 7) as f64 / 7.0 - 0.5));
        table.columns[0] = column("time [ms]", time.collect());
        for column in &mut table.columns {
            let rows = column.values.iter().enumerate();
            column.values = rows.filter(|(i, _)| !lost(*i)).map(|(_, x)| *x).collect();
        }
        let mapping = Mapping {
            rate_hz: Some(1000.0),
            ..Mapping::default()
        };
        Log::from_table(&table, &mapping).unwrap()
    };
    let gaps = read(&|i| i % 1000 == 500 || (3000..3020).contains(&i), 0.0);
    insta::assert_snapshot!(message(&gaps, "rate-override"));
    assert!(gaps.time.last().unwrap() > &7.99);
    let whole = read(&|_| false, 0.8);
    assert!(!codes(&whole).contains(&"rate-override"));
    assert!((whole.time[4000] - 4.0).abs() < 1e-12);
    // Ten rows that were stamped together, late, are all there.
    let mut table = axis(8000).table();
    let late = |i: usize| if (3000..3010).contains(&i) { 3010 } else { i };
    table.columns[0] = column("time [ms]", (0..8000).map(|i| late(i) as f64).collect());
    let mapping = Mapping {
        rate_hz: Some(1000.0),
        ..Mapping::default()
    };
    let together = Log::from_table(&table, &mapping).unwrap();
    assert_eq!(together.time.len(), 8000);
}

/// Every column of a file, what it became and why.
#[test]
fn every_column_is_accounted_for() {
    let accounts = |headers: &[&str], mapping: &Mapping| {
        let log = mapping.complete(&headed(headers)).unwrap();
        let one = |c: &stiction_log::Understood| {
            let role = c.role.map_or("-".to_string(), |role| role.to_string());
            let assumed = c
                .assumed
                .as_ref()
                .map_or(String::new(), |a| format!("; {}", a.line));
            format!("{} | {role} | {} | {}{assumed}", c.column, c.unit, c.reason)
        };
        log.columns.iter().map(one).collect::<Vec<_>>().join("\n")
    };
    let torque = Mapping {
        position: Some(Channel::named("ActPos").scale("0.5 um/count".parse().unwrap())),
        force: Some(
            Channel::named("Iq")
                .unit(Unit::parse("A").unwrap())
                .inverted(),
        ),
        ..Mapping::default()
    };
    let found = [
        accounts(
            &[
                "t [s]",
                "ActPos [mm]",
                "SetPos [mm]",
                "FollowingError [mm]",
                "Zug [N]",
                "Flag",
            ],
            &Mapping::default(),
        ),
        accounts(
            &["time", "displacement", "displacement_filtered", "force"],
            &Mapping {
                position: Some(Channel::named("displacement")),
                ..Mapping::default()
            },
        ),
        accounts(&["t [s]", "ActPos", "Iq", "Id"], &torque),
        accounts(
            &[
                "t [s]",
                "x [m]",
                "motor force [N]",
                "disturbance [N]",
                "mode",
            ],
            &Mapping::default(),
        ),
        accounts(
            &["t [s]", "x [m]", "current 1 [A]", "current 2 [A]"],
            &Mapping {
                force: Some(Channel::named("current 1")),
                ..Mapping::default()
            },
        ),
    ];
    insta::assert_snapshot!(found.join("\n\n"));
}

#[test]
fn a_column_that_never_changes_is_no_candidate() {
    let n = 2000;
    let with = |more: Vec<(&str, f64)>| {
        let mut table = axis(n).table();
        table.columns.remove(2);
        let more = more
            .into_iter()
            .map(|(name, value)| column(name, vec![value; n]));
        table.columns.extend(more);
        table
    };
    let read = |table: &Table| Log::from_table(table, &Mapping::default()).unwrap();
    let taken = |log: &Log, role: Role| {
        let column = log.columns.iter().find(|c| c.role == Some(role));
        column.map(|c| c.column.clone())
    };
    // Of equals it is none.
    let log = read(&with(vec![("position 2 [m]", 0.3), ("force 2 [N]", 5.0)]));
    assert_eq!(taken(&log, Role::Position).unwrap(), "2 \"position [m]\"");
    assert_eq!(taken(&log, Role::Force).unwrap(), "3 \"force [N]\"");
    insta::assert_snapshot!(log.columns[4].reason, @"could be the force, but never changes");
    // By its unit alone it is nothing; by its name it may be one at rest.
    let mut table = with(vec![("supply [V]", 24.0)]);
    table.columns.remove(2);
    let log = read(&table);
    assert!(log.force.is_none());
    insta::assert_snapshot!(log.columns[2].reason, @"its name says nothing known, and it never changes");
    table.columns[2].name = "force".into();
    assert_eq!(
        taken(&read(&table), Role::Force).unwrap(),
        "3 \"force [V]\""
    );
    // An encoder that is dead does not make a position of what is commanded.
    let mut table = with(vec![("actual position [m]", 0.3)]);
    table.columns[1].name = "commanded position".into();
    let log = read(&table);
    assert_eq!(
        taken(&log, Role::Position).unwrap(),
        "4 \"actual position [m]\""
    );
}

/// Seconds that a reader has made of time stamps do not label a file; those that somebody wrote do.
#[test]
fn stamps_say_nothing_of_the_units_of_others() {
    let of = |stamps: bool| {
        let mut table = headed(&["when [s]", "position", "force"]);
        table.columns[0].stamps = stamps;
        let mapping = Mapping {
            time: Some(Channel::named("when")),
            motion: Some(Motion::Linear),
            ..Mapping::default()
        };
        Log::from_table(&table, &mapping)
    };
    assert_eq!(codes(&of(true).unwrap())[0], "unit-assumed");
    let refused = of(false).unwrap_err().to_string();
    assert!(
        refused.contains("position has no unit while other columns have one"),
        "{refused}"
    );
}

/// A column that runs on is named as the time that it may be, in a unit that fits.
#[test]
fn what_may_be_the_time_is_named() {
    let said = |name: &str, step: f64| {
        let mut table = axis(2000).table();
        table.columns[0] = column(name, (0..2000).map(|i| 1e6 + i as f64 * step).collect());
        Log::from_table(&table, &Mapping::default())
            .unwrap_err()
            .allowed
    };
    insta::assert_snapshot!(said("clock", 1e6), @r#"give one of them in axis.toml: rate = "1 kHz", or under [columns]: time = { column = "clock", unit = "ns" }"#);
    insta::assert_snapshot!(said("clock", 0.002), @r#"give one of them in axis.toml: rate = "1 kHz", or under [columns]: time = { column = "clock", unit = "s" }"#);
    // Row numbers.
    insta::assert_snapshot!(said("nr", 1.0), @r#"give one of them in axis.toml: rate = "1 kHz", or under [columns]: time = "t" (or the number of the column, counted from 1)"#);
}

#[test]
fn time_that_goes_back_or_stands_leads_on() {
    let said = |stamp: &dyn Fn(usize) -> f64| {
        let mut table = axis(2000).table();
        table.columns[0].values = (0..2000).map(stamp).collect();
        Log::from_table(&table, &Mapping::default())
            .unwrap_err()
            .allowed
    };
    // Two recordings in one file, all in the wrong order, a clock of 10 ms, and none.
    insta::assert_snapshot!(said(&|i| 0.001 * (i % 1200) as f64), @r#"increasing time stamps; if two recordings are in one file, keep the first under [log] of axis.toml: crop = ["0 s", "1.199 s"], or give the rate instead of the time column"#);
    insta::assert_snapshot!(said(&|i| -0.001 * i as f64), @r#"increasing time stamps: sort the rows by them, or give the rate instead of the time column"#);
    insta::assert_snapshot!(said(&|i| 0.01 * (i / 10) as f64), @r#"at most 5 % of the rows: the clock is coarser than the sampling; give the rate instead of the time column, on average rate = "1000 Hz" above [columns] of axis.toml"#);
    insta::assert_snapshot!(said(&|_| 5.0), @r#"time stamps that go on; give the rate instead of the time column, as in rate = "1 kHz" above [columns] of axis.toml"#);
    // The line that is named reads the first recording.
    let mut table = axis(2000).table();
    table.columns[0].values = (0..2000).map(|i| 0.001 * (i % 1200) as f64).collect();
    let mapping = Mapping {
        crop: Some((0.0, 1.199)),
        ..Mapping::default()
    };
    assert_eq!(Log::from_table(&table, &mapping).unwrap().time.len(), 1200);
}
