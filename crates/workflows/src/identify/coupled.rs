//! What lies between motor and load, in words and for the result.

use stiction_files::result::MisfitEntry;
use stiction_files::symbols;
use stiction_identify::{Between, Coupling, Encoder, Misfit};
use stiction_log::Log;
use stiction_number::{Percent, four_digits};

/// Cut-off below which an axis with a resonance is rigid but for a ninth, as a part of the frequency of its load.
const RIGID: f64 = 1.0 / 3.0;
/// Deviations of a 95 % interval.
const QUANTILE: f64 = 1.96;

/// Deviation of a frequency or width from which what lies between motor and load is stated as likely only.
const HARDLY_KNOWN: f64 = 0.25;

/// A cause in words, as likely only where its size is hardly known.
pub(super) fn likely(misfit: &Misfit, words: &str) -> String {
    match &misfit.coupling {
        Some(coupling) if coupling.deviation > HARDLY_KNOWN => format!("most likely {words}"),
        _ => words.into(),
    }
}

/// Writes what was found into the entry of a misfit.
pub(super) fn state(coupling: &Coupling, entry: &mut MisfitEntry) {
    match coupling.between {
        Between::Spring { frequency, encoder } => {
            entry.frequency_hz = Some(frequency);
            entry.resonance_hz = coupling.resonance();
            entry.encoder = Some(place(encoder).into());
        }
        Between::Gap { width } => entry.lost_motion = Some(width),
    }
    entry.coupling_std_percent = Some(100.0 * coupling.deviation);
    entry.load_percent = Some(100.0 * coupling.load);
}

fn place(encoder: Encoder) -> &'static str {
    match encoder {
        Encoder::Motor => "motor",
        Encoder::Load => "load",
    }
}

/// What was found, what stands all the same, and what to do; `of_force` is the relative error of the law, percent.
pub(super) fn message(coupling: &Coupling, of_force: f64, log: &Log) -> String {
    let explained = format!(
        "explains {} of what the law leaves ({} of the force)",
        Percent::error(100.0 * coupling.share).digits(2),
        Percent::error(of_force * coupling.share.sqrt()).digits(2)
    );
    let load = Percent::error(100.0 * coupling.load).digits(2);
    let about = Percent::error(100.0 * QUANTILE * coupling.deviation).digits(2);
    let stands = "Coulomb friction, viscous friction and the whole mass hold; presliding and the Stribeck curve take up part of it";
    let surely = match coupling.deviation > HARDLY_KNOWN {
        true => "most likely ",
        false => "",
    };
    let hertz = |f: f64| format!("{} Hz", four_digits(f));
    match coupling.between {
        Between::Spring { frequency, encoder } => {
            let with_motor = coupling.resonance().map_or(String::new(), |f| {
                format!(", with the motor at some {}", hertz(f))
            });
            let rigid = hertz(RIGID * frequency);
            let place = place(encoder);
            let motor = match encoder {
                Encoder::Motor => "",
                Encoder::Load => "put the encoder of the motor into the log, or ",
            };
            let to_do = format!(
                "To know these surely, and these only, set common_cutoff = \"{rigid}\" under [conditioning] in the axis file, \
                 below which the axis is rigid; for the others {motor}record with less acceleration and jerk"
            );
            format!(
                "{surely}motor and load vibrate against each other: a load of {load} of the moving mass on a spring, the encoder on \
                 the {place}, {explained}. The load alone vibrates at {} (± {about}){with_motor}. {stands}. {to_do}",
                hertz(frequency)
            )
        }
        Between::Gap { width } => format!(
            "{surely}a gap lies between motor and load: a load of {load} of the moving mass that the motor moves only after a lost \
             motion of some {} {} (± {about}) {explained}. {stands}. A load on a spring that has much of the friction itself \
             can look the same: hold the motor and push the load to and fro, a gap lets it move freely. If it does, adjust \
             or preload the drive train and record again, or use the values for motion that does not cross the gap",
            four_digits(width),
            symbols::length_unit(log.motion)
        ),
    }
}
