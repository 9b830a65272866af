//! What the page asks of the engine.

use crate::client::{Answer, Served, open};
use std::time::{Duration, Instant};
use stiction_files::batch::{LogRow, ParameterRow, Results};

/// A log of an axis that moves to and fro, with Coulomb and viscous friction.
fn log(served: &Served, name: &str) {
    let mut text = String::from("time [s],x [mm],F [N]\n");
    for k in 0..8000 {
        let t = 1e-3 * f64::from(k);
        let (x, v) = (0.05 * (6.0 * t).sin(), 0.3 * (6.0 * t).cos());
        let force = 20.0 * v.signum() + 60.0 * v - 9.0 * 36.0 * x;
        text.push_str(&format!("{t},{},{force}\n", 1e3 * x));
    }
    std::fs::write(served.path().join(name), text).unwrap();
}

/// Waits for work to end, and gives it.
pub fn ended(served: &Served, id: u64) -> serde_json::Value {
    let began = Instant::now();
    loop {
        let all = served.ask("GET", "/api/jobs", "").json();
        let job = all
            .as_array()
            .unwrap()
            .iter()
            .find(|job| job["id"] == id)
            .unwrap()
            .clone();
        if job["state"] == "done" || job["state"] == "failed" {
            return job;
        }
        assert!(began.elapsed() < Duration::from_secs(300), "{job}");
        std::thread::sleep(Duration::from_millis(50));
    }
}

#[test]
fn a_log_is_described_corrected_and_drawn() {
    let served = open();
    log(&served, "run.csv");
    let about = served.ask("GET", "/api/log?name=run.csv", "").json();
    assert_eq!(about["samples"], 8000);
    assert_eq!(about["motion"], "linear");
    let channels: Vec<&str> = about["channels"]
        .as_array()
        .unwrap()
        .iter()
        .map(|c| c["name"].as_str().unwrap())
        .collect();
    assert_eq!(channels, ["position", "velocity", "force"]);
    assert_eq!(about["channels"][1]["unit"], "mm/s");
    // The unit is another one than the file says.
    let asked = "{\"log\":\"run.csv\",\"axis\":\"axis.toml\",\"role\":\"position\",\"column\":2,\"name\":\"x [mm]\",\"unit\":\"cm\"}";
    let changes = served.ask("POST", "/api/correct", asked);
    assert_eq!(changes.status, 200, "{}", changes.text());
    let axis = std::fs::read_to_string(served.path().join("axis.toml")).unwrap();
    assert!(
        axis.contains("position = { column = \"x [mm]\", unit = \"cm\" }"),
        "{axis}"
    );
    let asked = "{\"log\":\"run.csv\",\"axis\":\"axis.toml\",\"role\":\"position\",\"column\":2,\"unit\":\"furlong\"}";
    let refused = served.ask("POST", "/api/correct", asked);
    assert_eq!(refused.status, 422, "{}", refused.text());
    assert!(refused.text().contains("furlong"), "{}", refused.text());
    assert_eq!(
        std::fs::read_to_string(served.path().join("axis.toml")).unwrap(),
        axis
    );
    // A stretch that is marked does not hide the rest from the page.
    let asked = "{\"log\":\"run.csv\",\"axis\":\"axis.toml\",\"as\":\"crop\",\"from\":1.0,\"to\":6.0,\"seconds\":7.999}";
    assert_eq!(served.ask("POST", "/api/mark", asked).status, 200);
    let about = served
        .ask("GET", "/api/log?name=run.csv&axis=axis.toml", "")
        .json();
    assert_eq!(about["samples"], 8000);
    assert_eq!(about["marks"]["crop"], serde_json::json!([1.0, 6.0]));
    let tiles = served.ask(
        "GET",
        "/api/tiles?name=run.csv&axis=axis.toml&channels=position&from=0&to=8&pixels=500",
        "",
    );
    let number = |at: usize| f64::from_le_bytes(tiles.body[at..at + 8].try_into().unwrap());
    let count = u32::from_le_bytes(tiles.body[..4].try_into().unwrap()) as usize;
    assert_eq!(tiles.body.len(), 16 + 8 * 3 * count);
    let highest = (0..count)
        .map(|k| number(16 + 8 * (2 * count + k)))
        .fold(0.0, f64::max);
    // It is drawn in mm, whatever the file has.
    assert!((highest - 500.0).abs() < 1.0, "{highest}");
    let map = served.ask("GET", "/api/map?name=run.csv&from=1&to=2", "");
    assert_eq!(
        u32::from_le_bytes(map.body[..4].try_into().unwrap()),
        1001,
        "{}",
        map.body.len()
    );
}

#[test]
fn columns_that_are_not_clear_are_decided_by_a_click() {
    let served = open();
    let rows: String = (0..3000)
        .map(|k| {
            let t = 1e-3 * f64::from(k);
            format!("{t},{},{}\n", (9.0 * t).sin(), (9.0 * t).cos().signum())
        })
        .collect();
    std::fs::write(served.path().join("odd.csv"), format!("a,b,c\n{rows}")).unwrap();
    let about = served.ask("GET", "/api/log?name=odd.csv", "").json();
    assert!(about["refused"].is_string(), "{about}");
    assert_eq!(about["columns"].as_array().unwrap().len(), 3);
    // Its columns are drawn before.
    let numbers = about["channels"].as_array().unwrap().iter();
    let numbers: Vec<&str> = numbers.map(|own| own["name"].as_str().unwrap()).collect();
    assert_eq!(numbers, ["1", "2", "3"]);
    assert_eq!(about["over"], "row");
    assert_eq!(about["span"], serde_json::json!([0.0, 2999.0]));
    let drawn = served.ask(
        "GET",
        "/api/tiles?name=odd.csv&channels=2&from=10&to=20&pixels=500",
        "",
    );
    let values = drawn.body[16..].chunks(8).skip(13);
    let values: Vec<f64> = values
        .map(|bytes| f64::from_le_bytes(bytes.try_into().unwrap()))
        .collect();
    let sine = (9..=21).map(|k| (9.0 * (1e-3 * f64::from(k))).sin());
    assert_eq!(values, sine.collect::<Vec<f64>>());
    for (role, column, unit) in [("time", 1, "s"), ("position", 2, "mm"), ("force", 3, "N")] {
        let asked = format!(
            "{{\"log\":\"odd.csv\",\"axis\":\"axis.toml\",\"role\":\"{role}\",\"column\":{column},\"unit\":\"{unit}\"}}"
        );
        let done = served.ask("POST", "/api/correct", &asked);
        assert_eq!(done.status, 200, "{}", done.text());
    }
    let about = served
        .ask("GET", "/api/log?name=odd.csv&axis=axis.toml", "")
        .json();
    assert!(about["refused"].is_null(), "{about}");
}

#[test]
fn a_log_of_another_machine_has_an_axis_file_of_its_own() {
    let served = open();
    let of = |log: &str| {
        served
            .ask("GET", &format!("/api/axis?log={log}"), "")
            .json()
    };
    let which =
        |axis: Option<&str>, not: Option<&str>| serde_json::json!({ "axis": axis, "not": not });
    log(&served, "run.csv");
    log(&served, "again.csv");
    let rows: String = (0..3000)
        .map(|k| {
            let t = 1e-3 * f64::from(k);
            format!("{t},{},{}\n", 50.0 * (9.0 * t).sin(), (9.0 * t).cos())
        })
        .collect();
    let other = format!("t [s],phi [deg],torque [N*m]\n{rows}");
    std::fs::write(served.path().join("other.csv"), other).unwrap();
    assert_eq!(of("run.csv"), which(None, None));
    let correct = |log: &str, axis: &str, rest: &str| {
        let asked = format!("{{\"log\":\"{log}\",\"axis\":\"{axis}\",{rest}}}");
        served.ask("POST", "/api/correct", &asked)
    };
    let mm = "\"role\":\"position\",\"column\":2,\"name\":\"x [mm]\",\"unit\":\"cm\"";
    assert_eq!(correct("run.csv", "axis.toml", mm).status, 200);
    // A log with the same columns is taken for one of the same machine, one without them is not.
    assert_eq!(of("run.csv"), which(Some("axis.toml"), None));
    assert_eq!(of("again.csv"), which(Some("axis.toml"), None));
    assert_eq!(of("other.csv"), which(None, Some("axis.toml")));
    let first = std::fs::read_to_string(served.path().join("axis.toml")).unwrap();
    let rad = "\"role\":\"position\",\"column\":2,\"name\":\"phi [deg]\",\"unit\":\"rad\"";
    assert_eq!(correct("other.csv", "other.axis.toml", rad).status, 200);
    assert_eq!(of("other.csv"), which(Some("other.axis.toml"), None));
    // One with the same columns is parted from the others by hand.
    let begun = served.ask("POST", "/api/axis", "{\"log\":\"again.csv\"}");
    assert_eq!(begun.json(), "again.axis.toml");
    assert_eq!(of("again.csv"), which(Some("again.axis.toml"), None));
    let twice = served.ask("POST", "/api/axis", "{\"log\":\"again.csv\"}");
    assert_eq!(twice.status, 409, "{}", twice.text());
    let after = std::fs::read_to_string(served.path().join("axis.toml")).unwrap();
    assert_eq!(after, first);
    // Marks list a log, whatever the axis file is called.
    let asked = "{\"log\":\"run.csv\",\"axis\":\"a slide.toml\",\"as\":\"crop\",\"from\":1.0,\"to\":6.0,\"seconds\":7.999}";
    assert_eq!(served.ask("POST", "/api/mark", asked).status, 200);
    assert_eq!(of("run.csv"), which(Some("a slide.toml"), None));
}

#[test]
fn a_log_without_time_takes_a_rate() {
    let served = open();
    let rows: String = (0..3000)
        .map(|k| {
            let t = 1e-3 * f64::from(k);
            format!("{},{}\n", 50.0 * (9.0 * t).sin(), 3.0 * (9.0 * t).cos())
        })
        .collect();
    let text = format!("x [mm],F [N]\n{rows}");
    std::fs::write(served.path().join("run.csv"), text).unwrap();
    let about = served.ask("GET", "/api/log?name=run.csv", "").json();
    assert!(about["refused"].is_string(), "{about}");
    // What the columns hold tells them apart.
    let range = &about["columns"][1]["range"];
    assert_eq!(range[0].as_f64().unwrap().round(), -3.0, "{about}");
    let rate = |rate: &str| {
        let asked = format!(
            "{{\"log\":\"run.csv\",\"axis\":\"axis.toml\",\"role\":\"rate\",\"unit\":\"{rate}\"}}"
        );
        served.ask("POST", "/api/correct", &asked)
    };
    let refused = rate("often");
    assert_eq!(refused.status, 422, "{}", refused.text());
    assert!(refused.text().contains("often"), "{}", refused.text());
    assert_eq!(rate("1 kHz").status, 200);
    let about = served
        .ask("GET", "/api/log?name=run.csv&axis=axis.toml", "")
        .json();
    assert_eq!(about["rate_hz"], 1000.0, "{about}");
    assert_eq!(rate("500 Hz").status, 200);
    let axis = std::fs::read_to_string(served.path().join("axis.toml")).unwrap();
    assert!(axis.contains("rate = \"500 Hz\""), "{axis}");
}

#[test]
fn a_correction_that_spoils_a_log_is_not_written() {
    let served = open();
    log(&served, "run.csv");
    let correct = |role: &str, column: usize, rest: &str| {
        let asked = format!(
            "{{\"log\":\"run.csv\",\"axis\":\"axis.toml\",\"role\":\"{role}\",\"column\":{column},{rest}}}"
        );
        served.ask("POST", "/api/correct", &asked)
    };
    assert_eq!(correct("position", 2, "\"unit\":\"cm\"").status, 200);
    let before = std::fs::read_to_string(served.path().join("axis.toml")).unwrap();
    for (role, column, rest, said) in [
        ("position", 2, "\"unit\":\"V\"", "axis.toml"),
        ("force", 3, "\"unit\":\"A\",\"scale\":\"96\"", "96 N/A"),
        ("velocity", 9, "\"unit\":\"m/s\"", "column 9"),
    ] {
        let refused = correct(role, column, rest);
        assert!(refused.status >= 400, "{role}: {}", refused.text());
        assert!(refused.text().contains(said), "{role}: {}", refused.text());
        let now = std::fs::read_to_string(served.path().join("axis.toml")).unwrap();
        assert_eq!(now, before);
    }
    assert_eq!(
        correct("force", 3, "\"unit\":\"A\",\"scale\":\"96 N/A\"").status,
        200
    );
}

#[test]
fn units_that_a_file_lacks_are_said_one_after_the_other() {
    let served = open();
    let rows: String = (0..3000)
        .map(|k| {
            let t = 1e-3 * f64::from(k);
            format!("{t},{},{}\n", 50.0 * (9.0 * t).sin(), 3.0 * (9.0 * t).cos())
        })
        .collect();
    let text = format!("time,pos,current\n{rows}");
    std::fs::write(served.path().join("run.csv"), text).unwrap();
    let correct = |role: &str, rest: &str| {
        let asked =
            format!("{{\"log\":\"run.csv\",\"axis\":\"axis.toml\",\"role\":\"{role}\",{rest}}}");
        served.ask("POST", "/api/correct", &asked)
    };
    // In any order, the kind first as the page asks for it.
    for (role, rest) in [
        ("kind", "\"unit\":\"linear\""),
        ("position", "\"column\":2,\"unit\":\"mm\""),
        ("force", "\"column\":3,\"unit\":\"A\""),
        ("time", "\"column\":1,\"unit\":\"s\""),
    ] {
        let done = correct(role, rest);
        assert_eq!(done.status, 200, "{role}: {}", done.text());
    }
    let about = served
        .ask("GET", "/api/log?name=run.csv&axis=axis.toml", "")
        .json();
    assert!(about["refused"].is_null(), "{about}");
    assert_eq!(about["force_unit"], "A");
}

/// Begins work, and gives what became of it.
fn done(served: &Served, asked: &serde_json::Value) -> serde_json::Value {
    let id = served.ask("POST", "/api/jobs", &asked.to_string()).json();
    let job = ended(served, id.as_u64().unwrap());
    assert_eq!(job["state"], "done", "{job}");
    job
}

#[test]
fn a_check_is_rows_and_lines() {
    let served = open();
    log(&served, "run.csv");
    // In one direction, too short for a fit.
    let rows: String = (0..200)
        .map(|k| format!("{},{},5\n", 1e-3 * f64::from(k), 0.1 * f64::from(k)))
        .collect();
    let text = format!("time [s],x [mm],F [N]\n{rows}");
    std::fs::write(served.path().join("short.csv"), text).unwrap();
    let check = |log: &str| {
        let asked = serde_json::json!({"kind": "check", "log": log, "axis": null});
        done(&served, &asked)["json"]["logs"][0].clone()
    };
    let row = |log: &serde_json::Value, name: &str| {
        let rows = log["rows"].as_array().unwrap();
        rows.iter().find(|row| row["name"] == name).unwrap().clone()
    };
    let fitted = check("run.csv");
    let coulomb = row(&fitted, "coulomb");
    assert_eq!(coulomb["verdict"], "determined");
    assert!((coulomb["value"].as_f64().unwrap() - 20.0).abs() < 0.2);
    let command = fitted["command"].as_str().unwrap();
    assert!(command.starts_with("stiction identify "), "{command}");
    let short = check("short.csv");
    assert!(short["refused"].is_string(), "{short}");
    let level = row(&short, "Coulomb level");
    assert_ne!(level["verdict"], "possible", "{level}");
    let remark = level["remark"].as_str().unwrap();
    assert!(remark.starts_with("record motion that slides"), "{remark}");
}

/// A log with a reference that the position follows with an error of so many um after each reversal.
fn followed(served: &Served, name: &str, error: f64) {
    let mut text = String::from("time [s],reference [mm],position [mm],force [N]\n");
    for k in 0..8000 {
        let t = 1e-3 * f64::from(k);
        let (r, v) = (50.0 * (6.0 * t).sin(), 0.3 * (6.0 * t).cos());
        let since = (6.0 * t / std::f64::consts::PI + 0.5).fract() * std::f64::consts::PI / 6.0;
        let late = 1e-3 * error * (-since / 0.02).exp() * v.signum();
        let force = 20.0 * v.signum() + 60.0 * v - 9.0 * 0.036 * r;
        text.push_str(&format!("{t},{r},{},{force}\n", r - late));
    }
    std::fs::write(served.path().join(name), text).unwrap();
}

#[test]
fn two_logs_are_compared() {
    let served = open();
    followed(&served, "before.csv", 80.0);
    followed(&served, "after.csv", 20.0);
    let asked = |log: &str, after: &str| serde_json::json!({"kind": "check", "log": log, "after": after, "axis": null});
    let line = served.ask(
        "POST",
        "/api/command",
        &asked("before.csv", "after.csv").to_string(),
    );
    assert_eq!(line.json(), "stiction check before.csv after.csv");
    let job = done(&served, &asked("before.csv", "after.csv"));
    assert_eq!(job["about"], "before.csv, after.csv");
    let change = &job["json"]["change"];
    assert_eq!(change["good"], true, "{change}");
    let largest = &change["rows"][0];
    let of = |key: &str| largest[key].as_f64().unwrap();
    assert!((of("before") - 80e-6).abs() < 8e-6, "{largest}");
    assert!((of("change_percent") + 75.0).abs() < 1.0, "{largest}");
    let peaks = change["peaks"].as_array().unwrap();
    let count = |k: usize| peaks[k].as_array().unwrap().len();
    assert!(count(0) > 10 && count(0) == count(1), "{change}");
    // The other way round it is worse; a log without a reference is not compared.
    let change = done(&served, &asked("after.csv", "before.csv"))["json"]["change"].clone();
    assert_eq!(change["good"], false, "{change}");
    assert!(change["verdict"].as_str().unwrap().starts_with("Worse at "));
    log(&served, "plain.csv");
    let job = done(&served, &asked("before.csv", "plain.csv"));
    assert!(job["json"]["change"].is_null());
    let why = &job["json"]["logs"][1]["not_tracked"];
    assert_eq!(why, "it has no reference position");
}

/// A table of two machines with a log a day, the Stribeck velocity of one of which steps from 5 to 6 mm/s on day 30.
fn table(served: &Served) {
    let folder = served.path().join("batch");
    std::fs::create_dir(&folder).unwrap();
    let mut out = Results::begin(&folder.join("results.parquet")).unwrap();
    for (machine, day) in [0, 1]
        .into_iter()
        .flat_map(|m| (0..50).map(move |d| (m, d)))
    {
        let noise = 1.0 + 0.01 * (f64::from(7 * day + 3 * machine) * 1.7).sin();
        let value = noise
            * if machine == 0 && day >= 30 {
                6e-3
            } else {
                5e-3
            };
        let parameter = ParameterRow {
            name: "stribeck_velocity".into(),
            value: Some(value),
            unit: "m/s".into(),
            std: Some(2e-5),
            low: Some(value - 4e-5),
            high: Some(value + 4e-5),
            identifiable: true,
            origin: "identified".into(),
        };
        let row = LogRow {
            path: format!("m{machine}-{day}.csv"),
            machine: Some(format!("M{machine}")),
            time: Some(1_772_323_200.0 + 86_400.0 * f64::from(day)),
            law: Some("lugre".into()),
            key: format!("{machine} {day}"),
            parameters: vec![parameter],
            ..LogRow::default()
        };
        out.add(&row).unwrap();
    }
    out.end().unwrap();
}

#[test]
fn a_table_is_followed_over_time() {
    let served = open();
    table(&served);
    let files = served.ask("GET", "/api/workspace", "").json()["files"].clone();
    let kind = |name: &str| {
        let files = files.as_array().unwrap();
        files.iter().find(|own| own["name"] == name).unwrap()["kind"].clone()
    };
    assert_eq!(kind("batch/results.parquet"), "table");
    let asked = serde_json::json!({"kind": "drift", "table": "batch/results.parquet", "limits": ["stribeck_velocity > 2"], "names": false});
    let line = served
        .ask("POST", "/api/command", &asked.to_string())
        .json();
    assert_eq!(
        line,
        "stiction drift batch/results.parquet --limit 'stribeck_velocity > 2'"
    );
    let job = done(&served, &asked);
    assert_eq!(job["verdict"], "not-trustworthy");
    let found = &job["json"];
    assert_eq!(found["verdict"], "1 of 2 machines changed");
    let alarm = &found["alarms"][0];
    assert_eq!(
        (&alarm["machine"], &alarm["kind"]),
        (&"M0".into(), &"step".into())
    );
    assert_eq!(found["times"][0][0], "2026-03-31 00:00");
    // Of the machine that changed first, in the unit that is shown.
    let course = &found["courses"][0];
    assert_eq!(
        (&course["machine"], &course["unit"]),
        (&"M0".into(), &"mm/s".into())
    );
    let numbers = |own: &serde_json::Value| {
        let own = own.as_array().unwrap().iter();
        own.map(|one| one.as_f64().unwrap()).collect::<Vec<f64>>()
    };
    assert_eq!(numbers(&course["x"])[49], 49.0);
    let levels = numbers(&course["levels"]["y"]);
    let wanted = [5.0, 5.0, 6.0, 6.0];
    assert!(
        levels.len() == 4 && levels.iter().zip(wanted).all(|(a, b)| (a - b).abs() < 0.2),
        "{levels:?}"
    );
    let refused = serde_json::json!({"kind": "drift", "table": "batch/results.parquet", "limits": ["mass > 2"]});
    let id = served.ask("POST", "/api/jobs", &refused.to_string()).json();
    let job = ended(&served, id.as_u64().unwrap());
    assert!(
        job["text"]
            .as_str()
            .unwrap()
            .contains("no log determines mass"),
        "{job}"
    );
}

#[test]
fn of_changes_at_once_none_is_lost() {
    let served = open();
    log(&served, "run.csv");
    let first = "{\"log\":\"run.csv\",\"axis\":\"axis.toml\",\"role\":\"position\",\"column\":2,\"unit\":\"cm\"}";
    assert_eq!(served.ask("POST", "/api/correct", first).status, 200);
    for k in 0..10 {
        let unit = ["N", "kN"][k % 2];
        let to = 5.0 + 0.1 * k as f64;
        let unit = format!(
            "{{\"log\":\"run.csv\",\"axis\":\"axis.toml\",\"role\":\"force\",\"column\":3,\"unit\":\"{unit}\"}}"
        );
        let crop = format!(
            "{{\"log\":\"run.csv\",\"axis\":\"axis.toml\",\"as\":\"crop\",\"from\":1.0,\"to\":{to},\"seconds\":7.999}}"
        );
        std::thread::scope(|scope| {
            let ask = |path: &'static str, body: String| {
                let served = &served;
                scope.spawn(move || served.ask("POST", path, &body).status)
            };
            let both = [ask("/api/correct", unit), ask("/api/mark", crop)];
            assert_eq!(both.map(|one| one.join().unwrap()), [200, 200]);
        });
        let axis = std::fs::read_to_string(served.path().join("axis.toml")).unwrap();
        let force = format!("unit = \"{}\"", ["N", "kN"][k % 2]);
        assert!(
            axis.contains(&force) && axis.contains(&format!("{to} s")),
            "{axis}"
        );
    }
}

#[test]
fn only_an_axis_file_is_written_as_one() {
    let served = open();
    log(&served, "run.csv");
    std::fs::write(served.path().join("broken.toml"), b"kind = \"li\xffnear\"").unwrap();
    std::fs::write(served.path().join("notes.md"), "").unwrap();
    for axis in [
        "notes.md",
        "new.csv",
        "study.toml",
        "result.json",
        "broken.toml",
    ] {
        let before = std::fs::read(served.path().join(axis)).ok();
        for (path, rest) in [
            (
                "/api/correct",
                "\"role\":\"position\",\"column\":2,\"unit\":\"cm\"",
            ),
            (
                "/api/mark",
                "\"as\":\"crop\",\"from\":1.0,\"to\":6.0,\"seconds\":7.999",
            ),
        ] {
            let asked = format!("{{\"log\":\"run.csv\",\"axis\":\"{axis}\",{rest}}}");
            let refused = served.ask("POST", path, &asked);
            assert!(
                [400, 422].contains(&refused.status),
                "{axis}: {}",
                refused.text()
            );
            assert!(refused.text().contains(axis), "{}", refused.text());
        }
        assert_eq!(std::fs::read(served.path().join(axis)).ok(), before);
    }
}

#[test]
fn work_is_seen_stopped_and_found_again() {
    let served = open();
    log(&served, "run.csv");
    let asked = "{\"kind\":\"identify\",\"logs\":[\"run.csv\"],\"out\":\"result\"}";
    assert_eq!(
        served.ask("POST", "/api/command", asked).json(),
        "stiction identify run.csv --out result"
    );
    let id = served
        .ask("POST", "/api/jobs", asked)
        .json()
        .as_u64()
        .unwrap();
    let twice = served.ask("POST", "/api/jobs", asked);
    assert_eq!(twice.status, 409, "{}", twice.text());
    assert_eq!(ended(&served, id)["state"], "done");
    // Refused work says why, in the words of the command line.
    let asked = "{\"kind\":\"simulate\",\"study\":\"run.csv\",\"out\":\"study\"}";
    let id = served
        .ask("POST", "/api/jobs", asked)
        .json()
        .as_u64()
        .unwrap();
    let job = ended(&served, id);
    assert_eq!(job["state"], "failed", "{job}");
    assert!(job["text"].as_str().unwrap().contains("run.csv"), "{job}");
}

/// Waits until work says what it is doing, which it does until it is stopped, and stops it.
fn stopped(served: &Served, asked: &serde_json::Value) -> serde_json::Value {
    let answer = served.ask("POST", "/api/jobs", &asked.to_string());
    let id = answer.json().as_u64().unwrap();
    let began = Instant::now();
    loop {
        let all = served.ask("GET", "/api/jobs", "").json();
        let job = all.as_array().unwrap().iter().find(|job| job["id"] == id);
        let job = job.unwrap();
        assert_eq!(job["state"], "running", "{job}");
        if job["stage"].is_string() {
            break;
        }
        assert!(began.elapsed() < Duration::from_secs(300), "{job}");
        std::thread::sleep(Duration::from_millis(10));
    }
    let answer = served.ask("POST", &format!("/api/jobs/{id}/stop"), "{}");
    assert_eq!(answer.status, 200, "{}", answer.text());
    ended(served, id)
}

/// A study and a plan that take minutes are stopped: what was found stays, and is said to be a part.
#[test]
fn work_that_is_stopped_keeps_what_it_found() {
    let served = open();
    let corners = "[[parameter_error]]\nkind = \"corners\"\nby = \"10 %\"\n";
    let study = format!(
        "[axis]\nknown = \"motor\"\nrate = \"4 kHz\"\n\n{}\n[[controller]]\nkind = \"cascade\"\nbandwidth = \"30 Hz\"\n\
         force_limit = \"200 N\"\n\n[[compensator]]\nkind = \"lugre\"\n\n{corners}",
        (0..30)
            .map(|k| format!(
                "[[path]]\nname = \"{k}\"\nkind = \"sine\"\namplitude = \"1 mm\"\nfrequency = \"1 Hz\"\ncycles = 200\n"
            ))
            .collect::<String>()
    );
    std::fs::write(served.path().join("study.toml"), study).unwrap();
    let asked = serde_json::json!({ "kind": "simulate", "study": "study.toml", "out": "study" });
    let job = stopped(&served, &asked);
    assert_eq!(
        (&job["state"], &job["verdict"]),
        (&"done".into(), &"interrupted".into()),
        "{job}"
    );
    let text = std::fs::read_to_string(served.path().join("study/study.json")).unwrap();
    let found: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert_eq!(found["status"], "interrupted");
    let limits = "[limits]\nstroke = [\"-100 mm\", \"100 mm\"]\nspeed = \"0.2 m/s\"\nacceleration = \"6 m/s2\"\n\
                  rated_force = \"150 N\"\nmass = \"10 kg\"\n";
    std::fs::write(
        served.path().join("axis.toml"),
        format!("kind = \"linear\"\n\n{limits}"),
    )
    .unwrap();
    let asked =
        serde_json::json!({ "kind": "plan", "axis": "axis.toml", "time": 600.0, "out": "plan" });
    let job = stopped(&served, &asked);
    assert_eq!(
        (&job["state"], &job["verdict"]),
        (&"done".into(), &"interrupted".into()),
        "{job}"
    );
    // Either it had a motion, or it says that there was none yet.
    let there = served.path().join("plan/plan.toml").is_file();
    assert_eq!(there, job["folder"] == "plan", "{job}");
}

#[test]
fn results_models_and_studies_say_which_log_they_come_from() {
    let served = open();
    log(&served, "run.csv");
    let asked = "{\"kind\":\"identify\",\"logs\":[\"run.csv\"],\"law\":\"coulomb-viscous\",\"out\":\"sub/result\"}";
    std::fs::create_dir(served.path().join("sub")).unwrap();
    let begun = served.ask("POST", "/api/jobs", asked);
    let job = ended(&served, begun.json().as_u64().unwrap());
    assert_eq!(job["state"], "done", "{job}");
    let outside = tempfile::tempdir().unwrap();
    let model = served.path().join("sub/result/model.toml");
    std::fs::copy(&model, outside.path().join("model.toml")).unwrap();
    let write = |name: &str, text: String| std::fs::write(served.path().join(name), text).unwrap();
    write(
        "sub/study.toml",
        "[axis]\nmodel = \"result/model.toml\"\n".into(),
    );
    write(
        "known-study.toml",
        "[axis]\nknown = \"linear-motor\"\n".into(),
    );
    let path = outside.path().display();
    write(
        "outside-study.toml",
        format!("[axis]\nmodel = '{path}/model.toml'\n"),
    );
    write("broken-model.toml", "[source]\ninputs = 3\n".into());
    let of = |name: &str| {
        let all = served.ask("GET", "/api/workspace", "").json();
        let mut files = all["files"].as_array().unwrap().iter();
        files.find(|file| file["name"] == name).unwrap()["of"].clone()
    };
    let hash = || {
        let about = served.ask("GET", "/api/log?name=run.csv", "").json();
        about["sha256"].as_str().unwrap().to_string()
    };
    let before = hash();
    let own = serde_json::json!([{ "name": "run.csv", "sha256": before }]);
    for name in ["sub/result", "sub/result/model.toml", "sub/study.toml"] {
        assert_eq!(of(name), own, "{name}");
    }
    for name in [
        "run.csv",
        "sub",
        "known-study.toml",
        "outside-study.toml",
        "broken-model.toml",
    ] {
        assert_eq!(of(name), serde_json::json!([]), "{name}");
    }
    // Another recording of that name is another log.
    let text = std::fs::read_to_string(served.path().join("run.csv")).unwrap();
    write(
        "run.csv",
        text.lines()
            .take(7000)
            .fold(String::new(), |all, line| all + line + "\n"),
    );
    assert_ne!(hash(), before);
    assert_eq!(of("sub/result"), own);
}

#[test]
fn what_a_file_names_outside_of_the_folder_is_not_read() {
    let served = open();
    log(&served, "run.csv");
    let outside = tempfile::tempdir().unwrap();
    let secret = outside.path().join("secret.csv");
    std::fs::copy(served.path().join("run.csv"), &secret).unwrap();
    let axis = format!("[[log]]\nfile = {:?}\n", secret.to_string_lossy());
    std::fs::write(served.path().join("axis.toml"), axis).unwrap();
    let answer = served.ask("GET", "/api/log?name=run.csv&axis=axis.toml", "");
    assert_eq!(answer.status, 403, "{}", answer.text());
    for asked in [
        serde_json::json!({ "kind": "identify", "logs": [], "axis": "axis.toml", "out": "result" }),
        serde_json::json!({ "kind": "identify", "logs": ["run.csv"], "method": "static-then-dynamic",
                            "statics": [secret], "out": "result" }),
    ] {
        let begun = served.ask("POST", "/api/jobs", &asked.to_string());
        let job = ended(&served, begun.json().as_u64().unwrap());
        assert_eq!(job["state"], "failed", "{job}");
        assert!(
            job["text"].as_str().unwrap().contains("the folder"),
            "{job}"
        );
        assert!(!served.path().join("result").exists());
    }
    // Neither is a model that a study names.
    let model = outside.path().join("model.toml");
    std::fs::write(&model, "secret = 777000777\n").unwrap();
    let study = format!("[axis]\nmodel = {:?}\n", model.to_string_lossy());
    let body = serde_json::json!({ "name": "study.toml", "text": &study, "before": "" });
    let answer = served.ask("PUT", "/api/text", &body.to_string());
    assert_eq!(answer.status, 403, "{}", answer.text());
    std::fs::write(served.path().join("study.toml"), &study).unwrap();
    let asked = "{\"kind\":\"simulate\",\"study\":\"study.toml\",\"out\":\"study\"}";
    let id = served
        .ask("POST", "/api/jobs", asked)
        .json()
        .as_u64()
        .unwrap();
    let job = ended(&served, id);
    assert_eq!(job["state"], "failed", "{job}");
    assert!(
        !job["text"].as_str().unwrap().contains("777000777"),
        "{job}"
    );
}

#[test]
fn text_is_written_over_what_was_seen_and_only_if_it_can_be_read() {
    let served = open();
    let put = |text: &str, before: &str| {
        let body = serde_json::json!({ "name": "axis.toml", "text": text, "before": before });
        served.ask("PUT", "/api/text", &body.to_string())
    };
    assert_eq!(put("kind = \"linear\"\n", "").status, 200);
    let refused = put("kind = \"round\"\n", "kind = \"linear\"\n");
    assert_eq!(refused.status, 422, "{}", refused.text());
    assert!(refused.text().contains("line 1"), "{}", refused.text());
    assert_eq!(put("kind = \"rotary\"\n", "something else").status, 409);
    let read = served.ask("GET", "/api/text?name=axis.toml", "").json();
    assert_eq!(read["text"], "kind = \"linear\"\n");
}

#[test]
fn a_zip_has_the_files_of_a_folder() {
    let served = open();
    std::fs::create_dir_all(served.path().join("code/src")).unwrap();
    std::fs::write(served.path().join("code/a.c"), "int a;\n").unwrap();
    std::fs::write(served.path().join("code/src/b.c"), "int b;\n").unwrap();
    let ticket = served
        .ask("POST", "/api/ticket", "{\"name\":\"code\",\"how\":\"zip\"}")
        .json();
    let ticket = ticket.as_str().unwrap();
    assert!(ticket.ends_with("/code.zip"), "{ticket}");
    let answer = served.send("GET", ticket, &served.own(), b"");
    let mut zip = zip::ZipArchive::new(std::io::Cursor::new(&answer.body)).unwrap();
    let names: Vec<String> = zip
        .file_names()
        .map(|name| name.unwrap().into_owned())
        .collect();
    assert_eq!(names, ["a.c", "src/b.c"]);
    let text = std::io::read_to_string(zip.by_name("src/b.c").unwrap()).unwrap();
    assert_eq!(text, "int b;\n");
    // The same bytes again.
    assert_eq!(
        served.send("GET", ticket, &served.own(), b"").body,
        answer.body
    );
}

#[test]
fn what_the_page_would_not_write_is_refused_in_its_words() {
    let served = open();
    let refused = |answer: Answer, status: u16, said: &str| {
        assert_eq!(answer.status, status, "{}", answer.text());
        let message = answer.json()["error"]["message"].clone();
        let message = message.as_str().unwrap();
        assert!(message.contains(said), "{message}");
    };
    refused(
        served.ask("POST", "/api/jobs", "{\"kind\":"),
        400,
        "line 1 column 8",
    );
    refused(
        served.ask("POST", "/api/axis", "{\"lug\": 1}"),
        400,
        "unknown field `lug`",
    );
    refused(
        served.ask("GET", "/api/axis?lug=1", ""),
        400,
        "unknown field `lug`",
    );
    let long = format!("{{\"log\": \"{}\"}}", "a".repeat(300 << 10));
    refused(served.ask("POST", "/api/axis", &long), 413, "limit");
    let mut headers = served.own();
    headers.push("content-type: text/plain".into());
    let unasked = served.send("POST", "/api/axis", &headers, b"{\"log\": \"a.csv\"}");
    refused(unasked, 415, "application/json");
}
