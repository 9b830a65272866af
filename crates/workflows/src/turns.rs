//! Where an axis turns back.

use stiction_log::Log;
use stiction_signal::{Travel, noise_deviation};

/// The path of an axis, m or rad from anywhere, and the samples at which it turns back by more than encoder steps and
/// noise explain; `None` for a log with neither position nor velocity.
pub(crate) fn turns(log: &Log) -> Option<(Vec<f64>, Vec<usize>)> {
    let (x, shortest) = path(log)?;
    let turns = turned(&x, shortest);
    Some((x, turns))
}

/// The position, or the integral of the velocity, and the shortest movement that is one.
fn path(log: &Log) -> Option<(Vec<f64>, f64)> {
    if let Some(x) = &log.position {
        let noise = noise_deviation(log.segments.iter().filter_map(|s| x.get(s.clone())));
        return Some((
            x.clone(),
            Travel::shortest_movement(log.quantum.unwrap_or(0.0), noise),
        ));
    }
    let velocity = log.velocity.as_ref()?;
    let mut x = 0.0;
    let mut path = vec![0.0];
    for (t, v) in log.time.windows(2).zip(velocity.windows(2)) {
        x += 0.5 * (v[0] + v[1]) * (t[1] - t[0]);
        path.push(x);
    }
    let noise = noise_deviation(std::iter::once(&velocity[..]));
    let seconds = log.time[velocity.len() - 1] - log.time[0];
    Some((
        path,
        Travel::shortest_integrated(noise, seconds, velocity.len()),
    ))
}

/// The samples at which a position turns back by more than the shortest movement.
pub(crate) fn turned(x: &[f64], shortest: f64) -> Vec<usize> {
    let mut out = Vec::new();
    let (mut low, mut high) = (0, 0);
    let mut rises = None;
    for (i, &now) in x.iter().enumerate() {
        // The last sample at an extreme is where the axis sets out again.
        if now >= x[high] {
            high = i;
        }
        if now <= x[low] {
            low = i;
        }
        match rises {
            Some(true) if x[high] - now > shortest => {
                out.push(high);
                (low, rises) = (i, Some(false));
            }
            Some(false) if now - x[low] > shortest => {
                out.push(low);
                (high, rises) = (i, Some(true));
            }
            None if x[high] - x[low] > shortest => rises = Some(high > low),
            _ => {}
        }
    }
    out
}
