//! Contours: foot points, the estimates of the deviation, the way along them; and two axes on a circle.

use proptest::prelude::*;
use stiction_friction::LuGre;
use stiction_friction::compensator::{Compensator, Friction, Settings, Source};
use stiction_servo::axis::AxisSettings;
use stiction_servo::cross_coupling::{CouplingState, CrossCoupling};
use stiction_servo::feedforward::Feedforward;
use stiction_servo::known;
use stiction_servo::motion::Limits;
use stiction_servo::plane::{
    Along, Circle, Curve, Deviation, FigureEight, FreeForm, PlaneMotion, Polygon, foot,
};
use stiction_servo::two_axes::TwoAxes;

/// Distance to a curve by trying many of its points.
fn by_search(curve: &impl Curve, position: [f64; 2]) -> f64 {
    let n = 200_000;
    (0..=n)
        .map(|k| {
            let at = curve.place(curve.end() * f64::from(k) / f64::from(n)).point;
            (at[0] - position[0]).hypot(at[1] - position[1])
        })
        .fold(f64::INFINITY, f64::min)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    /// From a reference close by, the foot point is the nearest point of the curve.
    #[test]
    fn the_foot_point_is_nearest(p in 0.2..6.0, ex in -2e-4..2e-4, ey in -2e-4..2e-4) {
        let circle = Circle::new(0.02, 1.0).unwrap();
        let eight = FigureEight::new(0.03, 0.01, 1.0).unwrap();
        for curve in [&circle as &dyn Curve, &eight] {
            let at = curve.place(p).point;
            let position = [at[0] + ex, at[1] + ey];
            let found = foot(curve, position, p);
            let there = curve.place(found.parameter).point;
            let distance = (there[0] - position[0]).hypot(there[1] - position[1]);
            prop_assert!((distance - found.deviation.distance.abs()).abs() < 1e-12, "across the motion");
        }
        let at = eight.place(p).point;
        let position = [at[0] + ex, at[1] + ey];
        let found = foot(&eight, position, p).deviation.distance.abs();
        // The curve crosses itself: elsewhere another branch may be nearer.
        if at[0].hypot(at[1]) > 2e-3 {
            prop_assert!(found <= by_search(&eight, position) + 1e-12);
        }
    }

    /// The estimates in real time differ from the truth by the square of the error over the radius, or not at all.
    #[test]
    fn estimates_are_good_to_second_order(p in 0.2..6.0, ex in -2e-4..2e-4, ey in -2e-4..2e-4) {
        let circle = Circle::new(0.02, 1.0).unwrap();
        let at = circle.place(p).point;
        let position = [at[0] - ex, at[1] - ey];
        let (guess, truth) = (circle.deviation(p, [ex, ey]), circle.true_deviation(position, p));
        let second = (ex * ex + ey * ey) / 0.02;
        prop_assert!((guess.distance - truth.distance).abs() <= second);
        // Outside the circle the curve lies to the left of a counter-clockwise motion.
        let radius = (position[0] + 0.02).hypot(position[1]);
        prop_assert!((truth.distance - (radius - 0.02)).abs() < 1e-12);

        let corner = Polygon::corner(0.05).unwrap();
        let s = 0.01 * p;
        let (guess, at) = (corner.deviation(s, [ex, ey]), corner.place(s).point);
        let truth = corner.true_deviation([at[0] - ex, at[1] - ey], s);
        if (s - 0.05).abs() > 1e-3 {
            prop_assert!((guess.distance - truth.distance).abs() < 1e-15);
        }
    }
}

#[test]
fn references_belong_together_and_corners_are_stops() {
    let limits = Limits {
        velocity: 0.1,
        acceleration: 1.0,
        jerk: 20.0,
    };
    let turning = Limits {
        velocity: 3.0,
        acceleration: 20.0,
        jerk: 400.0,
    };
    let square = Along::new(Polygon::square(0.02).unwrap(), limits).unwrap();
    let eight = Along::new(FigureEight::new(0.03, 0.01, 1.0).unwrap(), turning).unwrap();
    let xs = |f: fn(f64) -> f64| (0..100).map(|k| 0.01 * f(0.1 * f64::from(k))).collect();
    let free = FreeForm::new(50.0, xs(libm::sin), xs(libm::cos)).unwrap();
    for motion in [&square as &dyn PlaneMotion, &eight, &free] {
        let h = 1e-5;
        for k in 1..300 {
            let t = motion.duration() * f64::from(k) / 300.0 + 5e-5;
            for i in 0..2 {
                let [a, b, c] = [t - h, t, t + h].map(|t| motion.at(t).axes[i]);
                let velocity = (c.position - a.position) / (2.0 * h);
                let acceleration = (c.velocity - a.velocity) / (2.0 * h);
                assert!((velocity - b.velocity).abs() < 1e-6, "{t}");
                assert!(
                    (acceleration - b.acceleration).abs() < 1e-2,
                    "{t}: {acceleration} {b:?}"
                );
            }
        }
        let end = motion.at(motion.duration());
        assert!(end.axes.iter().all(|r| r.velocity == 0.0));
    }
    let mut stops = 0;
    let mut moving = false;
    for k in 0..=20_000 {
        let at = square.at(square.duration() * f64::from(k) / 20_000.0).axes;
        let speed = at[0].velocity.hypot(at[1].velocity);
        stops += usize::from(moving && speed < 1e-5);
        moving = speed >= 1e-5;
        assert!(speed < 0.1 + 1e-12);
    }
    assert_eq!(stops, 4);
}

/// Recorded set points that start softly: with the time as parameter the curve hardly moves at first, and a tracking error
/// is a long way in time. The deviation is still the part across.
#[test]
fn foot_points_where_the_reference_hardly_moves() {
    let soft = |k: i32| {
        let a = 2.0 * std::f64::consts::PI * f64::from(k) / 2000.0;
        libm::sincos(a - libm::sin(a))
    };
    let xs = (0..=2000).map(|k| 0.01 * soft(k).1).collect();
    let ys = (0..=2000).map(|k| 0.01 * soft(k).0).collect();
    let turn = FreeForm::new(1000.0, xs, ys).unwrap();
    for k in 1..400 {
        let t = 2.5e-3 * f64::from(k);
        let at = turn.at(t).axes.map(|r| r.position);
        // 1 um outside of the circle about (-10 mm, 0), and an error of 5 um behind or ahead along it.
        let angle = libm::atan2(at[1], at[0] + 0.01);
        for along in [-5e-6, 5e-6] {
            let (s, c) = libm::sincos(angle + along / 0.01);
            let position = [0.010_001 * c - 0.01, 0.010_001 * s];
            let found = turn.true_deviation(position, t).distance;
            if angle + along / 0.01 > 0.0 {
                assert!((found - 1e-6).abs() < 5e-9, "{t} {along}: {found}");
            } else {
                // Behind the start the nearest point is the start itself.
                assert!(found.abs() < 5.1e-6, "{t} {along}: {found}");
            }
        }
    }
}

#[test]
fn contours_that_cannot_be_are_named() {
    assert_eq!(Polygon::new(&[]).unwrap_err().name, "points");
    assert_eq!(Polygon::new(&[[0.0, 0.0]]).unwrap_err().name, "edge");
    assert_eq!(Circle::new(0.0, 1.0).unwrap_err().name, "radius");
    assert_eq!(FigureEight::new(1.0, 1.0, 0.0).unwrap_err().name, "turns");
    let uneven = FreeForm::new(1.0, vec![0.0; 3], vec![0.0; 4]);
    assert_eq!(uneven.unwrap_err().name, "set_points");
    assert_eq!(
        CrossCoupling::tuned(45.0, 0.0).unwrap_err().name,
        "coupling_limit"
    );
}

/// The output is shared by the direction cosines, limited, and the integral stands at the limit.
#[test]
fn coupling_shares_and_limits() {
    let coupling = CrossCoupling {
        proportional: 10.0,
        integral: 100.0,
        derivative: 0.0,
        limit: 2e-3,
    };
    let mut state = CouplingState::default();
    let deviation = Deviation {
        distance: 1e-4,
        left: [0.6, 0.8],
    };
    let mut last = [0.0; 2];
    for _ in 0..10_000 {
        last = coupling.correction(&mut state, 1e-3, deviation);
    }
    assert!((last[0] - 0.6 * 2e-3).abs() < 1e-12 && (last[1] - 0.8 * 2e-3).abs() < 1e-12);
    let back = Deviation {
        distance: -1e-4,
        ..deviation
    };
    for _ in 0..101 {
        last = coupling.correction(&mut state, 1e-3, back);
    }
    // The integral stood at 1 mm/s: a hundred samples of -10 um/s take it away.
    assert!((last[0] / 0.6 + 1e-3).abs() < 3e-5, "{last:?}");
}

/// Largest contour error, m, in the second turn of a circle of 10 mm at half a turn a second: a linear motor stage with a
/// speed loop of 60 Hz and a heavier slide with one of 45 Hz.
fn contour_peak(
    coupling: Option<CrossCoupling>,
    model: impl Fn(&LuGre<f64>) -> Option<LuGre<f64>>,
) -> f64 {
    let turning = Limits {
        velocity: std::f64::consts::PI,
        acceleration: 30.0,
        jerk: 600.0,
    };
    let circle = Along::new(Circle::new(10e-3, 2.0).unwrap(), turning).unwrap();
    let axes = [("motor", 60.0), ("machine", 45.0)].map(|(name, bandwidth)| {
        let axis = known::find(name).unwrap();
        let none = axis.simulated(4000.0, bandwidth).unwrap();
        let Some(law) = model(&axis.capped_law()) else {
            return none;
        };
        let settings = Settings::bare(250e-6, 200.0);
        let compensator = Compensator::new(Friction::LuGre(law), Source::Reference, settings);
        let preview = none.drive.preview(250e-6);
        AxisSettings {
            feedforward: Feedforward::compensator(compensator.unwrap(), preview),
            ..none
        }
    });
    let all = TwoAxes { axes, coupling }.run(&circle).unwrap();
    all[all.len() / 2..]
        .iter()
        .fold(0.0, |m, s| m.max(s.deviation.abs()))
}

#[test]
fn circle_with_cross_coupling_and_compensation() {
    let coupling = Some(CrossCoupling::tuned(45.0, 0.1).unwrap());
    let exact = |law: &LuGre<f64>| Some(*law);
    let none = contour_peak(None, |_| None);
    let coupled = contour_peak(coupling, |_| None);
    let compensated = contour_peak(None, exact);
    let both = contour_peak(coupling, exact);
    let worst = |coupling| {
        (0..64)
            .map(|k| contour_peak(coupling, |law| known::corners(law, 0.15).nth(k)))
            .fold(0.0, f64::max)
    };
    let (wrong, wrong_both) = (worst(None), worst(coupling));
    println!(
        "contour peak {:.2} um; coupling {:.2}; LuGre {:.2}; both {:.2}; LuGre +-15 % {:.2}; both {:.2} ({:.2} %)",
        1e6 * none,
        1e6 * coupled,
        1e6 * compensated,
        1e6 * both,
        1e6 * wrong,
        1e6 * wrong_both,
        100.0 * (1.0 - wrong_both / none)
    );
    assert!(coupled < 0.1 * none && compensated < 0.01 * none && both < compensated);
    assert!(wrong_both <= 0.02 * none, "{wrong_both} of {none}");
}
