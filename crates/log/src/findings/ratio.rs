//! What the ratio of two signals that ought to show the same motion says.

use stiction_number::short;
use stiction_policy::signal;

/// Sums of squares and products of what the position shows, and of what the other signal does.
pub(super) struct Sums {
    pub position: f64,
    pub other: f64,
    pub both: f64,
}

/// What is said of a pair that does not agree.
pub(super) struct Words {
    /// Of signals that are hardly correlated: "velocity is not the derivative of the position".
    pub apart: &'static str,
    /// Samples over which they were compared.
    pub samples: usize,
    /// Before and after the ratio: "the derivative of the position", "the velocity".
    pub ratio_of: [&'static str; 2],
    /// Ratios that have a usual cause.
    pub causes: &'static [(f64, &'static str)],
}

/// What is wrong with the pair, in words; `None` where both show the same.
pub(super) fn fault(sums: &Sums, words: &Words) -> Option<String> {
    let correlation = sums.both / (sums.position * sums.other).sqrt();
    let ratio = (sums.position / sums.other).sqrt().copysign(correlation);
    if correlation.abs() < signal::MIN_CORRELATION {
        return Some(format!(
            "{}: over {} samples their correlation is {}",
            words.apart,
            words.samples,
            short(correlation)
        ));
    }
    if (ratio - 1.0).abs() <= signal::MAX_RATIO_ERROR {
        return None;
    }
    let near =
        |(value, _): &&(f64, &str)| (ratio.abs() / value - 1.0).abs() < signal::MAX_RATIO_ERROR;
    let cause = words.causes.iter().find(near).map(|(_, cause)| *cause);
    let inverted = (ratio < 0.0).then_some("one of them has the wrong sign");
    let why: Vec<&str> = [cause, inverted].into_iter().flatten().collect();
    let why = match why.is_empty() {
        true => "a unit, a gear or a lead between them".to_string(),
        false => why.join("; "),
    };
    let [of, over] = words.ratio_of;
    Some(format!("{of} is {} times {over}: {why}?", short(ratio)))
}
