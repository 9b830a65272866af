//! What compensation takes off the error, method by method and with wrong parameters, as Markdown tables:
//!
//! ```text
//! cargo run --release -p stiction-servo --example compensation
//! ```
//!
//! Linear motor stage of the bench set (4.6 kg, Fs 18 N, Fc 12 N), cascade, one sample of delay, 1 kHz current loop, 50 nm.

use stiction_friction::compensator::{
    Compensator, DisturbanceObserver, Friction, Settings, Source,
};
use stiction_friction::{CoulombViscous, LuGre, ParamError};
use stiction_servo::axis::AxisSettings;
use stiction_servo::cross_coupling::CrossCoupling;
use stiction_servo::feedforward::Feedforward;
use stiction_servo::integrator::Quick;
use stiction_servo::known::{self, KnownAxis};
use stiction_servo::metrics::Tracking;
use stiction_servo::motion::{Limits, Sine};
use stiction_servo::plane::{Along, Circle};
use stiction_servo::run::run_with;
use stiction_servo::two_axes::TwoAxes;

const LIMIT: f64 = 200.0;

/// A motion and the loop that follows it.
#[derive(Clone, Copy)]
struct Case {
    amplitude: f64,
    frequency: f64,
    rate: f64,
    bandwidth: f64,
}

impl Case {
    fn axis(&self) -> Result<AxisSettings, ParamError> {
        motor()?.simulated(self.rate, self.bandwidth)
    }

    /// The last two of four cycles.
    fn tracking(&self, feedforward: Feedforward) -> Result<Tracking, ParamError> {
        let axis = AxisSettings {
            feedforward,
            ..self.axis()?
        };
        let all = run_with(
            &axis,
            &Sine::new(self.amplitude, self.frequency, 4.0)?,
            Quick::new(1)?,
        )?;
        Ok(Tracking::of(&all[all.len() / 2..]))
    }

    fn bare(
        &self,
        friction: Friction<f64>,
        source: Source<f64>,
    ) -> Result<Feedforward, ParamError> {
        let settings = Settings::bare(1.0 / self.rate, LIMIT);
        self.compensated(friction, source, settings)
    }

    fn compensated(
        &self,
        friction: Friction<f64>,
        source: Source<f64>,
        settings: Settings<f64>,
    ) -> Result<Feedforward, ParamError> {
        let preview = match source {
            Source::Reference => self.axis()?.drive.preview(1.0 / self.rate),
            _ => 0.0,
        };
        let compensator = Compensator::new(friction, source, settings)?;
        Ok(Feedforward::compensator(compensator, preview))
    }
}

fn motor() -> Result<KnownAxis, ParamError> {
    known::find("motor").ok_or(ParamError::new("axis", 0.0, "a known one"))
}

fn main() -> Result<(), ParamError> {
    methods()?;
    wrong_parameters()?;
    small_motion()?;
    circle()
}

/// Reduction of the largest error by each method.
fn methods() -> Result<(), ParamError> {
    println!(
        "| sine, 4 kHz, 60 Hz | none | Coulomb | Stribeck | DOB | LuGre, measured | LuGre, reference | with DOB |"
    );
    println!("|---|---|---|---|---|---|---|---|");
    let law = motor()?.capped_law();
    for (amplitude, frequency) in [(5e-3, 0.5), (1e-3, 0.2), (2e-5, 1.0)] {
        let case = Case {
            amplitude,
            frequency,
            rate: 4000.0,
            bandwidth: 60.0,
        };
        let observer = DisturbanceObserver::new(4.6, 60.0, 1.0 / case.rate, LIMIT)?;
        let plain = CoulombViscous::symmetric(12.0, 30.0, 0.0)?;
        let reference = case.bare(Friction::LuGre(law), Source::Reference)?;
        let both = Feedforward {
            observer: Some(observer),
            ..reference.clone()
        };
        let none = case.tracking(Feedforward::default())?.peak;
        print!(
            "| {} mm, {frequency} Hz | {:.1} um |",
            1e3 * amplitude,
            1e6 * none
        );
        for feedforward in [
            case.bare(Friction::Coulomb(plain), Source::Reference)?,
            case.bare(Friction::Stribeck(*law.curve()), Source::Reference)?,
            Feedforward::observer(observer),
            case.bare(Friction::LuGre(law), Source::Measured)?,
            reference,
            both,
        ] {
            let peak = case.tracking(feedforward)?.peak;
            print!(" {:.1} % |", 100.0 * (1.0 - peak / none));
        }
        println!();
    }
    println!();
    Ok(())
}

/// The 5 mm sine with all six parameters wrong.
fn wrong_parameters() -> Result<(), ParamError> {
    println!(
        "| 5 mm, .5 Hz, LuGre on the reference | exact | +-10 % mean | worst | +-30 % mean | worst |"
    );
    println!("|---|---|---|---|---|---|");
    let law = motor()?.capped_law();
    for rate in [4000.0, 1000.0] {
        let case = Case {
            amplitude: 5e-3,
            frequency: 0.5,
            rate,
            bandwidth: 60.0,
        };
        let none = case.tracking(Feedforward::default())?.peak;
        let reduction = |law: LuGre<f64>| -> Result<f64, ParamError> {
            let with = case.tracking(case.bare(Friction::LuGre(law), Source::Reference)?)?;
            Ok(100.0 * (1.0 - with.peak / none))
        };
        print!("| {rate} Hz | {:.1} % |", reduction(law)?);
        for by in [0.1, 0.3] {
            let each: Vec<f64> = known::corners(&law, by)
                .map(reduction)
                .collect::<Result<_, _>>()?;
            let worst = each.iter().copied().fold(f64::MAX, f64::min);
            let mean = each.iter().sum::<f64>() / each.len() as f64;
            print!(" {mean:.1} % | {worst:.1} % |");
        }
        println!();
    }
    println!();
    Ok(())
}

/// Where a force too large is worse than none: error with over error without.
fn small_motion() -> Result<(), ParamError> {
    println!("| 20 um, 1 Hz, 1 kHz, 30 Hz, +-30 % | worst rms | worst peak |");
    println!("|---|---|---|");
    let case = Case {
        amplitude: 2e-5,
        frequency: 1.0,
        rate: 1000.0,
        bandwidth: 30.0,
    };
    let law = motor()?.capped_law();
    let sine = Sine::new(case.amplitude, case.frequency, 4.0)?;
    let whole = |feedforward| -> Result<Tracking, ParamError> {
        let axis = AxisSettings {
            feedforward,
            ..case.axis()?
        };
        Ok(Tracking::of(&run_with(&axis, &sine, Quick::new(1)?)?))
    };
    let none = whole(Feedforward::default())?;
    let safe = Settings::new(1.0 / case.rate, LIMIT);
    for (name, settings) in [
        ("default safety", safe),
        (
            "gain 1, no watchdog",
            Settings::bare(1.0 / case.rate, LIMIT),
        ),
    ] {
        let (mut rms, mut peak) = (0.0_f64, 0.0_f64);
        for wrong in known::corners(&law, 0.3) {
            let with =
                whole(case.compensated(Friction::LuGre(wrong), Source::Reference, settings)?)?;
            rms = rms.max(with.rms / none.rms);
            peak = peak.max(with.peak / none.peak);
        }
        println!("| {name} | {rms:.2} | {peak:.2} |");
    }
    println!();
    Ok(())
}

/// Circle of 10 mm at half a turn a second: the stage with 60 Hz and a slide of 10 kg with 45 Hz.
fn circle() -> Result<(), ParamError> {
    println!("| circle, contour peak | none | CCC | LuGre | both | LuGre, worst +-15 % | both |");
    println!("|---|---|---|---|---|---|---|");
    let limits = Limits {
        velocity: std::f64::consts::PI,
        acceleration: 30.0,
        jerk: 600.0,
    };
    let circle = Along::new(Circle::new(10e-3, 2.0)?, limits)?;
    let slide = known::find("machine").ok_or(ParamError::new("axis", 0.0, "a known one"))?;
    let peak = |coupled: bool, corner: Option<(usize, f64)>| -> Result<f64, ParamError> {
        let axes = [(motor()?, 60.0), (slide, 45.0)].map(|(axis, bandwidth)| {
            let mut settings = axis.simulated(4000.0, bandwidth)?;
            if let Some((corner, by)) = corner {
                let law = known::corners(&axis.capped_law(), by).nth(corner);
                let law = Friction::LuGre(law.unwrap_or(axis.capped_law()));
                let bare = Settings::bare(250e-6, LIMIT);
                let compensator = Compensator::new(law, Source::Reference, bare)?;
                let preview = settings.drive.preview(250e-6);
                settings.feedforward = Feedforward::compensator(compensator, preview);
            }
            Ok::<_, ParamError>(settings)
        });
        let [x, y] = axes;
        let coupling = CrossCoupling::tuned(45.0, 0.1)?;
        let two = TwoAxes {
            axes: [x?, y?],
            coupling: coupled.then_some(coupling),
        };
        let all = two.run_with(&circle, Quick::new(1)?)?;
        let second = &all[all.len() / 2..];
        Ok(second.iter().fold(0.0, |m, s| m.max(s.deviation.abs())))
    };
    let worst = |coupled| {
        (0..64).try_fold(0.0_f64, |m, corner| {
            Ok::<_, ParamError>(m.max(peak(coupled, Some((corner, 0.15)))?))
        })
    };
    let none = peak(false, None)?;
    print!("| um | {:.1} |", 1e6 * none);
    for value in [
        peak(true, None)?,
        peak(false, Some((0, 0.0)))?,
        peak(true, Some((0, 0.0)))?,
        worst(false)?,
        worst(true)?,
    ] {
        print!(
            " {:.2} ({:.1} %) |",
            1e6 * value,
            100.0 * (1.0 - value / none)
        );
    }
    println!();
    Ok(())
}
