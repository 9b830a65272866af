//! Logs of known axes in closed loop, as a drive would write them, and their identification.

use stiction_identify::{
    Conditioning, Delay, Estimate, Law, LawKind, Parameter, Samples, Settings, Silent, Terms,
    Tuned, condition, identify, low_speed_bound, tune,
};
use stiction_servo::cascade::Cascade;
use stiction_servo::closed_loop::{ClosedLoop, ForceLog, Record};
use stiction_servo::encoder::Encoder;
use stiction_servo::known::{self, KnownAxis};
use stiction_servo::path::Path;
use stiction_servo::plant::Plant;

/// A known axis by name.
pub fn axis(name: &str) -> KnownAxis {
    known::find(name).unwrap()
}

/// Three segments at 4 kHz: fast, slow, small and quick. The force is held from its sample to the next
/// and logged so, half a sample before the motion it belongs to, with the noise of a current sensor.
pub fn three_segments(name: &str, count: f64, noise: f64, seed: u64) -> Record {
    let axis = axis(name);
    ClosedLoop {
        plant: Plant::new(axis.mass, axis.law).unwrap(),
        controller: Cascade::tuned(axis.mass, 60.0, 1e3).unwrap(),
        path: Path::three_segments(0.196, 9.0).unwrap(),
        encoder: encoder(count, seed),
        rate: 4000.0,
        substeps: 10,
        force_noise: noise,
        force_log: ForceLog::Held,
        seed,
    }
    .run()
    .unwrap()
}

/// An encoder whose counts stand elsewhere for each seed.
pub fn encoder(count: f64, seed: u64) -> Encoder {
    let phase = 0.618_033_988_749_895 * seed as f64;
    Encoder::new(count)
        .unwrap()
        .with_phase(phase.fract())
        .unwrap()
}

/// The position and force of a log.
pub fn samples(log: &Record) -> Samples {
    Samples {
        time: log.time.clone(),
        position: Some(log.position.clone()),
        force: log.force.clone(),
        ..Samples::default()
    }
}

/// LuGre with mass, offset and delay unknown, cut-offs chosen by the data.
pub fn identified(log: &Record, count: f64) -> (Tuned, Estimate) {
    let samples = [samples(log)];
    let law = Law::new(LawKind::LuGre);
    let terms = Terms {
        delay: Delay::Fitted,
        ..Terms::default()
    };
    let wanted = Conditioning {
        resolution: Some(count),
        ..Conditioning::default()
    };
    let settings = Settings::default();
    let tuned = tune(&samples, &wanted, law, &terms, &settings, &mut Silent).unwrap();
    let terms = Terms {
        lag: tuned.lag,
        first_delay: tuned.first_delay,
        ..terms
    };
    let record = condition(&samples, &tuned.conditioning).unwrap();
    let bound = low_speed_bound(&record);
    let found = identify(&record, law, &terms, bound, &settings, &mut Silent).unwrap();
    (tuned, found)
}

/// What a log of this axis must give, by name.
pub fn truth(name: &str) -> [(&'static str, f64); 7] {
    let axis = axis(name);
    let side = axis.law.curve().positive();
    [
        ("sigma0", axis.law.stiffness()),
        ("sigma1", axis.law.damping().at_rest()),
        ("sigma2", side.viscous),
        ("coulomb", side.coulomb),
        ("static", side.static_friction),
        ("stribeck_velocity", side.stribeck_velocity),
        ("mass", axis.mass),
    ]
}

/// Error of a parameter in percent of its truth, and whether its interval holds the truth.
pub fn error(parameter: &Parameter, truth: f64) -> (f64, bool) {
    let covered = parameter
        .ci95
        .is_some_and(|(low, high)| low <= truth && truth <= high);
    (100.0 * (parameter.value / truth - 1.0), covered)
}
