//! What the motion of a log can show of each parameter, from plain facts: never more than they give.
//!
//! A motion that lacks something cannot show a parameter; one that has it all may still not, because the parameter is
//! small or the noise large, which only a fit tells.

use super::motion::Motion;
use serde::Serialize;
use stiction_files::symbols;
use stiction_identify::Mass;
use stiction_log::{Log, Motion as Kind};
use stiction_number::{Percent, counted, four_digits as short};
use stiction_policy::{encoder, motion};

/// What the motion can show of one thing.
#[derive(Clone, Debug, Serialize)]
pub struct Shows {
    /// Name of the parameter, as in results: `coulomb`; or `asymmetry`, `gravity`.
    pub name: String,
    /// In words: `Coulomb level`.
    pub meaning: String,
    /// `possible`, `doubtful` or `no`; it is never certain without a fit.
    pub shown: String,
    /// The facts.
    pub because: String,
    /// The motion to record where something is missing; empty where nothing is.
    pub record: String,
}

impl Shows {
    /// Takes back a doubt about what a fit to the log determines.
    pub(super) fn told_by_fit(&mut self, is_determined: bool) {
        if is_determined && self.shown == "doubtful" {
            self.shown = "possible".into();
            self.record.clear();
        }
    }
}

/// What a log can show, parameter by parameter.
pub(super) fn shows(log: &Log, motion: &Motion, mass: Mass) -> Vec<Shows> {
    let speed = |v: f64| format!("{} {}", short(v), symbols::speed_unit(log.motion));
    let percent = |part: f64| Percent::error(100.0 * part).short();
    let m = motion;
    let least_way = m.forward.min(m.back);
    let ways = format!(
        "{} of the samples move forward, {} back",
        percent(m.forward),
        percent(m.back)
    );
    let mut out = Vec::new();
    let mut say = |name: &str, meaning: &str, shown: &str, because: String, record: &str| {
        out.push(Shows {
            name: name.into(),
            meaning: meaning.into(),
            shown: shown.into(),
            because,
            record: if shown == "possible" {
                String::new()
            } else {
                record.into()
            },
        });
    };
    let both = if least_way >= motion::MIN_SHARE_EACH_WAY {
        "possible"
    } else if least_way > 0.0 {
        "doubtful"
    } else {
        "no"
    };
    say(
        "coulomb",
        "Coulomb level",
        both,
        ways.clone(),
        "motion that slides, both ways: in one direction friction cannot be told from a constant force",
    );
    let ratio = m.middle_speed / m.slow_speed.max(f64::MIN_POSITIVE);
    let slides = m.slow_speed > 0.0 && m.forward + m.back >= motion::MIN_SHARE_EACH_WAY;
    let wide = slides
        && (ratio >= motion::MIN_SPEED_RATIO
            || m.top_speed >= 2.0 * motion::MIN_SPEED_RATIO * m.slow_speed);
    let range = format!(
        "speeds from {} to {}",
        speed(m.slow_speed),
        speed(m.top_speed)
    );
    say(
        "sigma2",
        "viscous friction",
        if wide { "possible" } else { "no" },
        range.clone(),
        "motion at speeds of a tenth of the top speed up to the top speed",
    );
    let [_, tenth, hundredth] = m.decades_one_way;
    let slow = tenth >= motion::MIN_SHARE_SLOW && hundredth >= motion::MIN_SHARE_SLOWER;
    let found = format!(
        "{} of the samples at a tenth to a hundredth of the top speed, {} below, speeds told to {}",
        percent(m.decades[1]),
        percent(m.decades[2]),
        speed(3.0 * m.speed_error)
    );
    let stribeck = match (slow, tenth >= motion::MIN_SHARE_SLOWER) {
        _ if least_way <= 0.0 => "no",
        (true, _) => "possible",
        (false, true) => "doubtful",
        (false, false) => "no",
    };
    let slower = format!(
        "constant speeds both ways down to {} and slower, where friction rises towards break-away",
        speed(0.01 * m.top_speed)
    );
    say(
        "static",
        "rise at low speed: Fs, vs",
        stribeck,
        found,
        &slower,
    );
    let turned = match m.samples_at_reversal {
        _ if m.reversals == 0 => "the axis never turns back".into(),
        Some(samples) => format!(
            "{}; at slow ones the force takes {} to turn round",
            counted(m.reversals, "reversal"),
            counted(samples as usize, "sample")
        ),
        None => format!(
            "{}, at which the force does not turn round",
            counted(m.reversals, "reversal")
        ),
    };
    let resolved = |needed: f64| match m.samples_at_reversal {
        None => "no",
        Some(_) if m.reversals < motion::MIN_REVERSALS => "doubtful",
        Some(samples) if samples >= needed => "possible",
        Some(samples) if samples >= 2.0 => "doubtful",
        Some(_) => "no",
    };
    let slow_turns = "slow reversals: a sine or triangle of long period, so that the axis creeps through each turn; a finer \
                      encoder or a higher rate";
    say(
        "sigma0",
        "presliding stiffness",
        resolved(motion::MIN_STIFFNESS_SAMPLES),
        turned.clone(),
        slow_turns,
    );
    say(
        "sigma1",
        "micro-damping",
        resolved(motion::MIN_DAMPING_SAMPLES),
        format!("{turned}, at {} Hz", short(m.rate_hz)),
        "slow reversals at the full rate of the drive; force steps at rest (method presliding-step) show it best",
    );
    if mass == Mass::Fitted {
        let accelerates = match m.acceleration_over_error {
            a if a >= motion::MIN_ACCELERATION && wide => "possible",
            a if a >= 1.0 => "doubtful",
            _ => "no",
        };
        say(
            "mass",
            match log.motion {
                Kind::Linear => "moving mass",
                Kind::Rotary => "inertia",
            },
            accelerates,
            match m.acceleration_over_error {
                a if a.is_finite() => format!("accelerations are {} times their error", short(a)),
                _ => "accelerations without error".into(),
            },
            "stronger acceleration both ways; or give the mass in the axis file",
        );
    }
    let balance = least_way / m.forward.max(m.back).max(f64::MIN_POSITIVE);
    say(
        "asymmetry",
        "asymmetry, or a constant force",
        match balance {
            b if b >= motion::MIN_DIRECTION_BALANCE => "possible",
            b if b > 0.0 => "doubtful",
            _ => "no",
        },
        ways,
        "as much motion one way as the other, at the same speeds",
    );
    if m.still >= encoder::MIN_REST_SHARE {
        say(
            "rests",
            "the cost of rests",
            "doubtful",
            format!(
                "the axis stands still in {} of the samples; on simulated axes that dwell between moves, intervals of σ₀, σ₁ and vs \
                 are 3 to 18 times as wide as on a log of the same length that never rests",
                percent(m.still)
            ),
            "the same stroke without dwells: sines from slow to fast one after the other, some so slow that the axis creeps \
             through its turns",
        );
    }
    if log.motion == Kind::Rotary {
        let wide = m.range >= motion::MIN_GRAVITY_ANGLE;
        say(
            "gravity",
            "gravity",
            if wide && log.position.is_some() {
                "possible"
            } else {
                "no"
            },
            format!(
                "the axis covers {} rad; asked for by gravity = true under [terms]",
                short(m.range)
            ),
            "motion over a quarter turn or more, with its position; over less, gravity looks like a constant force",
        );
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_fit_determines_is_doubted_no_more() {
        let said = |shown: &str, is_determined| {
            let mut shows = Shows {
                name: "mass".into(),
                meaning: "moving mass".into(),
                shown: shown.into(),
                because: String::new(),
                record: "faster reversals".into(),
            };
            shows.told_by_fit(is_determined);
            (shows.shown, shows.record.is_empty())
        };
        assert_eq!(said("doubtful", true), ("possible".into(), true));
        assert_eq!(said("doubtful", false), ("doubtful".into(), false));
        // What the motion cannot show stays so: a fit of a law is no proof of it.
        assert_eq!(said("no", true), ("no".into(), false));
    }
}
