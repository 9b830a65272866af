//! What controllers are given, read back by other programs: a compiler of Structured Text, yaml-cpp, and plain text.

use std::path::Path;
use stiction_plan::carrier::{Carrier, Job};
use stiction_plan::{Atom, Motion};
use stiction_testkit::matiec::{compile, matiec};
use stiction_testkit::programs::{have, run};

const RATE: f64 = 1000.0;
const STEP: f64 = 1e-6;

/// Sines that fade and grow, and moves that reach their speed, their acceleration, only their jerk, to either side.
fn motion() -> Motion {
    let sine = |amplitude, frequency, fade_in, fade_out| Atom::Sine {
        amplitude,
        frequency,
        duration: 0.7,
        fade_in,
        fade_out,
    };
    let there = |distance, speed| Atom::Move {
        distance,
        speed,
        acceleration: 3.0,
        jerk: 400.0,
    };
    Motion::new(vec![
        sine(2e-4, 28.0, 0.1, 0.2),
        sine(5e-3, 3.0, 0.6, 0.09),
        there(0.03, 0.1),
        there(-0.02, 0.4),
        there(-1e-4, 0.1),
        there(0.004, 0.5),
    ])
    .unwrap()
}

fn job(motion: &Motion) -> Job<'_> {
    Job {
        motion,
        identifier: "x_axis",
        rotary: false,
        rate: RATE,
        resolution: STEP,
        start: 0.25,
    }
}

fn text(carrier: Carrier) -> String {
    let motion = motion();
    carrier.carry(&job(&motion)).unwrap().text
}

/// Numbers of lines without those of the head.
fn rows(text: &str, separator: char) -> Vec<Vec<f64>> {
    let row = |line: &str| -> Option<Vec<f64>> {
        line.split(separator)
            .map(|x| x.trim().parse().ok())
            .collect()
    };
    text.lines().filter_map(row).collect()
}

/// Rows of one sample each: where they say the axis is, it is there in the motion.
#[test]
fn samples_are_those_of_the_motion() {
    let motion = motion();
    let due = |k: usize| motion.at(k as f64 / RATE);
    let count = (motion.duration() * RATE).ceil() as usize + 1;

    let csv = rows(&text(Carrier::Csv), ',');
    assert_eq!(csv.len(), count);
    for (k, row) in csv.iter().enumerate() {
        let at = due(k);
        assert_eq!(row[1..], [0.25 + at.position, at.velocity, at.acceleration]);
    }
    let cam = rows(&text(Carrier::Cam), ',');
    let csp = rows(&text(Carrier::Csp), ',');
    let lines = rows(&text(Carrier::Halstreamer), ' ');
    let feed = rows(&text(Carrier::Feed), ',');
    assert_eq!([cam.len(), csp.len(), lines.len(), feed.len()], [count; 4]);
    for k in 0..count {
        let at = due(k);
        let position = 0.25 + at.position;
        assert!((cam[k][0] - k as f64 / RATE).abs() < 1e-9);
        assert!((cam[k][1] - position).abs() < 1e-12);
        assert_eq!(csp[k][0], k as f64);
        assert!((csp[k][1] * STEP - position).abs() < 0.5001 * STEP);
        assert!((csp[k][2] * STEP - at.velocity).abs() < 0.5001 * STEP);
        assert!((1e-3 * lines[k][0] - position).abs() < 1e-12);
        assert!((1e-3 * lines[k][1] - at.velocity).abs() < 1e-12);
        let own = [position, at.velocity, at.acceleration];
        assert!(
            feed[k]
                .iter()
                .zip(own)
                .all(|(x, own)| (1e-3 * x - own).abs() < 1e-12)
        );
        let sign = if at.velocity == 0.0 {
            0.0
        } else {
            at.velocity.signum()
        };
        assert_eq!(feed[k][3], sign);
    }
}

/// Beyond 32 bits a count is refused, not cut.
#[test]
fn counts_that_no_drive_holds_are_refused() {
    let motion = motion();
    let fine = Job {
        resolution: 1e-11,
        ..job(&motion)
    };
    let said = Carrier::Csp.carry(&fine).unwrap_err().to_string();
    assert!(
        said.starts_with("csp: 0.25 m and 0 m/s in counts of 1e-11 m; allowed: -2147483647"),
        "{said}"
    );
}

/// Of a rotary axis, degrees where machines count in them.
#[test]
fn a_rotary_axis_is_told_in_its_units() {
    let motion = motion();
    let turned = Job {
        rotary: true,
        ..job(&motion)
    };
    let text = |carrier: Carrier| carrier.carry(&turned).unwrap().text;
    let lines = rows(&text(Carrier::Halstreamer), ' ');
    assert!((lines[0][0] - 0.25_f64.to_degrees()).abs() < 1e-9);
    assert!(text(Carrier::Csv).starts_with("t [s],x [rad],v [rad/s],a [rad/s2]\n"));
    assert!(text(Carrier::Gcode).contains("G1 A14.323945 F600."));
    assert!(text(Carrier::St).contains("(* where the axis stands at the start, rad *)"));
}

/// Strokes of G-code end where the motion turns back, and take as long.
#[test]
fn strokes_end_where_the_motion_turns_back() {
    let motion = motion();
    let text = text(Carrier::Gcode);
    assert!(text.contains("\nG21 G90 G94 G61\nG1 X250.000000 F600.\n") && text.ends_with("M2\n"));
    let (mut time, mut at, mut turns) = (0.0, 250.0, 0);
    for line in text.lines().filter(|line| line.starts_with("G1")).skip(1) {
        let mut words = line.split(' ').skip(1);
        let mut number = || words.next().unwrap()[1..].parse::<f64>().unwrap();
        let (to, feed): (f64, f64) = (number(), number());
        time += 60.0 * (to - at).abs() / feed;
        // There the motion has (nearly) come to rest, and is where the stroke ends.
        let due = motion.at(time);
        assert!((1e3 * (0.25 + due.position) - to).abs() < 2e-4, "{line}");
        assert!(due.velocity.abs() < 0.02, "{line}: {due:?}");
        at = to;
        turns += 1;
    }
    // A sine of 28 Hz over .7 s turns back 39 times, one of 3 Hz four, each of four moves once.
    assert!(
        (at - 250.0).abs() < 1e-6 && (45..=54).contains(&turns),
        "{turns}"
    );
    assert!((time - motion.duration()).abs() < 1e-3, "{time}");
}

/// What a joint trajectory controller follows: quintics between the points, by yaml-cpp from the file.
const FOLLOW: &str = r#"
#include <cmath>
#include <cstdio>
#include <yaml-cpp/yaml.h>
int main(int, char **argv)
{
    const YAML::Node file = YAML::LoadFile(argv[1]);
    if (file["joint_names"].size() != 1 || file["joint_names"][0].as<std::string>() != "x_axis") { return 1; }
    const YAML::Node points = file["points"];
    double before = -1.0;
    for (size_t k = 0; k + 1 < points.size(); k++) {
        double p[2], v[2], a[2], t[2];
        for (size_t i = 0; i < 2; i++) {
            const YAML::Node at = points[k + i];
            p[i] = at["positions"][0].as<double>();
            v[i] = at["velocities"][0].as<double>();
            a[i] = at["accelerations"][0].as<double>();
            t[i] = at["time_from_start"]["sec"].as<int>() + 1e-9 * at["time_from_start"]["nanosec"].as<unsigned>();
        }
        if (!(t[0] > before)) { return 2; }
        before = t[0];
        const double h = t[1] - t[0], d = p[1] - p[0];
        // Coefficients as in quintic spline interpolation: c0 + c1 t + .. + c5 t^5.
        const double c2 = 0.5 * a[0];
        const double c3 = (20 * d - (8 * v[1] + 12 * v[0]) * h - (3 * a[0] - a[1]) * h * h) / (2 * h * h * h);
        const double c4 = (-30 * d + (14 * v[1] + 16 * v[0]) * h + (3 * a[0] - 2 * a[1]) * h * h) / (2 * pow(h, 4));
        const double c5 = (12 * d - 6 * (v[1] + v[0]) * h + (a[1] - a[0]) * h * h) / (2 * pow(h, 5));
        for (int i = 0; i < 20; i++) {
            const double s = h * i / 20;
            printf("%.17g %.17g\n", t[0] + s, p[0] + s * (v[0] + s * (c2 + s * (c3 + s * (c4 + s * c5)))));
        }
    }
    return 0;
}
"#;

#[test]
fn quintics_between_points_keep_to_the_motion() {
    if !have(&["g++"]) {
        return;
    }
    let motion = motion();
    let carried = Carrier::Ros2.carry(&job(&motion)).unwrap();
    let dir = tempfile::tempdir().unwrap();
    std::fs::write(dir.path().join("motion.yaml"), carried.text).unwrap();
    std::fs::write(dir.path().join("follow.cpp"), FOLLOW).unwrap();
    run(
        "g++",
        &["-O1", "follow.cpp", "-lyaml-cpp", "-o", "follow"],
        dir.path(),
    );
    let said = run("./follow", &["motion.yaml"], dir.path());
    let found = rows(&said, ' ');
    assert!(found.len() > 1000);
    let off = |row: &Vec<f64>| (row[1] - 0.25 - motion.at(row[0]).position).abs();
    let most = found.iter().map(off).fold(0.0, f64::max);
    assert!(most <= 0.11 * STEP, "{most}: {}", carried.note);
    let last = found.last().unwrap();
    assert!(motion.duration() - last[0] < 0.05);
}

/// Steps the block from where the axis stands at a pace, and stops it where asked.
const DRIVER: &str = r#"
int main(int argc, char **argv)
{
    static FB_X_AXIS_MOTION block;
    const int stop = atoi(argv[1]);
    FB_X_AXIS_MOTION_init__(&block, 0);
    block.ACTUAL_POSITION.value = 0.25;
    block.PACE.value = atof(argv[2]);
    for (int k = 0; k < 100000; k++) {
        block.EXECUTE.value = k < stop;
        FB_X_AXIS_MOTION_body__(&block);
        /* Where the axis is later is of no account. */
        block.ACTUAL_POSITION.value = 7.0;
        printf("%d %.17g %.17g %.17g %d %d\n", k, block.POSITION.value, block.VELOCITY.value, block.ACCELERATION.value,
               block.DIRECTION.value, block.DONE.value);
        if (!block.BUSY.value) { break; }
    }
    return argc != 3;
}
"#;

/// The block on a PLC: cycle by cycle the motion, at full pace and at a slower one, and a stop on the path.
#[test]
fn the_block_gives_the_motion() {
    let Some(matiec) = matiec() else {
        return;
    };
    let motion = motion();
    let text = text(Carrier::St);
    let dir = tempfile::tempdir().unwrap();
    compile(&matiec, &[&text], DRIVER, dir.path(), "block");
    let block = |stop: &str, pace: &str| rows(&run("./block", &[stop, pace], dir.path()), ' ');
    for pace in [1.0, 0.3] {
        let found = block("100000", &pace.to_string());
        for row in &found {
            let due = motion.at(pace * row[0] / RATE);
            let near = |found: f64, due: f64, size: f64| (found - due).abs() <= 1e-9 * size;
            assert!(near(row[1], 0.25 + due.position, 1.0), "{row:?} {due:?}");
            assert!(near(row[2], pace * due.velocity, 1.0), "{row:?} {due:?}");
            // Where the jerk steps, a rounded instant is on either side of it.
            let size = 1e3 * 400.0 / RATE;
            assert!(
                near(row[3], pace * pace * due.acceleration, size),
                "{row:?} {due:?}"
            );
            assert!(row[4] == row[2].signum() || row[2] == 0.0 && row[4] == 0.0);
        }
        let (last, whole) = (found.last().unwrap(), motion.duration() * RATE / pace);
        assert_eq!(last[5], 1.0);
        assert!((last[0] - whole).abs() <= 1.0 && last[1] == 0.25 && last[2..5] == [0.0; 3]);
    }
    // In the middle of a move at 0.1 m/s: no step of the speed, at rest half a second later, on the path.
    let found = block("1700", "1");
    let last = found.last().unwrap();
    assert!(last[5] == 0.0 && last[2] == 0.0, "{last:?}");
    assert!((2150.0..=2250.0).contains(&last[0]), "{last:?}");
    for pair in found.windows(2) {
        assert!((pair[1][2] - pair[0][2]).abs() <= 0.02, "{pair:?}");
        let moved = pair[1][1] - pair[0][1];
        assert!((moved * RATE - pair[0][2]).abs() <= 0.02, "{pair:?}");
    }
    assert!(text.contains("FUNCTION_BLOCK FB_x_axis_Motion"));
    assert!(Path::new(Carrier::St.file()).extension().is_some());
}
