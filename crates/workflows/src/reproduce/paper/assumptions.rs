//! What is assumed where the paper gives no number, each with what is known.

use super::stage::Stage;
use super::{
    corner, crawl, dynamics, load, presliding, rest, search, statics, stiffness, tracking,
};
use stiction_number::{Percent, quantity, short, unit};

/// What holds on any axis.
const ANYWHERE: [&str; 6] = [
    "The paper simulates for 3 s with ode4 in steps of 0.1 ms, along a motion that its text does not give. Sine, low speed and \
     change of load last 3 s here; all other durations are ours.",
    "Neither damper B nor spring K beside the friction, no disturbance force and, but where it is said, neither delay nor current loop.",
    "PID, fuzzy PID and cascade: velocity and acceleration fed forward; the fuzzy PID with scales from the friction and gains \
     within 30 % of those of the PID, its tables of 49 rules in the usual form; the cascade with a current loop of 1 kHz \
     below it. The paper gives neither gains nor tables.",
    "Baselines: Coulomb and viscous friction, the steady curve, and a simplified law, of the same identified law, driven by \
     the reference velocity. The paper compares with a simplified law and does not say what is left out; here it is the \
     Stribeck effect.",
    "Genetic searches: 50 individuals, 5 rounds of 100 generations (500 in one round for the others), crossover .6 to \
     .9, mutation .01 to .10, temperature 7, falling by .96 a generation. The steps are the paper's, the settings ours. \
     As measured: 2 rounds of 20 generations.",
    "Noise of half an encoder step on the position and of 1 % of the static level on the force, where a drive's record is \
     identified. The paper does not say what its identification was given.",
];

/// Every assumption about an axis.
pub(super) fn of(stage: &Stage) -> Vec<String> {
    let units = stage.units();
    let (length, speed) = (
        |x: f64| quantity(x, units.length),
        |x: f64| quantity(x, units.speed),
    );
    let mut all: Vec<String> = stage.notes.clone();
    all.extend(ANYWHERE.map(String::from));
    let [low, high] = search::search_box(stage);
    let between =
        |i: usize, typed: &str| format!("{} to {} {}", short(low[i]), short(high[i]), unit(typed));
    let boxes = format!(
        "Boxes of the searches, in logarithms: σ₀ {}, σ₁ {}, σ₂ {}, Fc {}, Fs − Fc {}, vs {}.",
        between(0, units.stiffness),
        between(1, units.damping),
        between(2, units.damping),
        between(3, units.force),
        between(4, units.force),
        between(5, units.speed),
    );
    let [slowest, fastest] = [
        statics::SPEEDS[0],
        statics::SPEEDS[statics::SPEEDS.len() - 1],
    ];
    let resolution = match stage.encoder.resolution() {
        0.0 => "exact, since no step is known".into(),
        step => format!("in steps of {}", length(step)),
    };
    let masses = load::HEAVIER.map(|part| short(part * stage.truth.mass));
    let [first, second] = stage.bandwidths();
    all.extend([
        boxes,
        format!(
            "Gains for a bandwidth of {}, and {} on the second axis of the corner{}.",
            quantity(first, "Hz"),
            quantity(second, "Hz"),
            match stage.is_own() {
                true => ": the first of several with which the axis slides evenly at low speed, or that with which it does so best",
                false => "",
            },
        ),
        format!("Positions are measured {resolution}; a velocity that is measured is the difference of two of them over 0.1 ms."),
        format!(
            "Constant velocities: {} from {} to {} in both directions, at least {} s to settle and {} s to average.",
            statics::SPEEDS.len(),
            speed(stage.speed(1e-3 * slowest)),
            speed(stage.speed(1e-3 * fastest)),
            statics::SETTLE,
            statics::SETTLE,
        ),
        format!(
            "Outliers: the force of two of these runs is taken as {} times what it is.",
            statics::OUTLIER
        ),
        format!(
            "Dynamic test: a sine of ±{} at {} Hz, three cycles, with velocity and acceleration as the simulation has them.",
            length(stage.stroke(dynamics::AMPLITUDE)),
            dynamics::FREQUENCY,
        ),
        format!(
            "Step below break-away: {} of the static level.",
            Percent::error(100.0 * presliding::HEIGHT).digits(3)
        ),
        format!(
            "Tracked sine: ±{} at {} Hz for 3 s; what comes after {} s counts.",
            length(stage.stroke(tracking::AMPLITUDE)),
            tracking::FREQUENCY,
            tracking::COUNTS_FROM,
        ),
        format!(
            "Change of load: from {} to {} and {} {} after {} s of a sine that lasts 3 s.",
            short(stage.truth.mass),
            masses[..masses.len() - 1].join(", "),
            masses[masses.len() - 1],
            unit(units.mass),
            load::CHANGE_AT,
        ),
        format!(
            "Low speed: {} for 3 s, on springs with dampers (the PID without its integral, for bandwidths of {} to {} times that \
             of the controllers), and under the controllers. The paper does not say what pulls its axis.",
            speed(stage.speed(crawl::VELOCITY)),
            crawl::SPRINGS[0],
            crawl::SPRINGS[crawl::SPRINGS.len() - 1],
        ),
        format!(
            "Standstill: {} s after a move of {}.",
            rest::DWELL,
            length(rest::DEFLECTIONS * stage.truth.law.bound()),
        ),
        format!(
            "Stiffness of the bristles: {} to {} times that of the axis.",
            stiffness::PARTS[0],
            stiffness::PARTS[stiffness::PARTS.len() - 1],
        ),
    ]);
    if stage.steps > 1 {
        all.push(format!(
            "{} steps of ode4 in each 0.1 ms instead of one, which is unstable with these bristles.",
            stage.steps
        ));
    }
    let limits = stage.limits(corner::LIMITS);
    all.push(format!(
        "Corner: {side} by {side} at {}, once with a stop and once with the start of one axis in the stop of the other, 0.2 s to \
         either side of which count; the second axis is {}, whose parameters are known to its compensation.",
        quantity(units.feed.1 * limits.velocity, units.feed.0),
        match stage.is_own() {
            true => "this axis once more",
            false => "a slide of 10 kg, σ₀ 1.2·10⁵ N/m, Fc 20 N, Fs 30 N",
        },
        side = length(stage.stroke(corner::SIDE)),
    ));
    all.extend(CORNERS.map(String::from));
    all
}

/// What is assumed of the corner on any axis.
const CORNERS: [&str; 2] = [
    "Cross coupling: a PD on the deviation from the contour above both axes (Koren 1980), tuned for the slower axis. \
         The paper names cross coupling and does not say how it is made.",
    "Feed error: the velocity of both axes along the contour less that of the reference; contour error: the deviation \
         across it. The paper defines neither of its two metrics.",
];
