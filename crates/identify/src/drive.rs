//! What lies between the force that a controller asks for and the force that the axis feels.

/// Fewest pieces of a sample over which a lagged force is taken as its mean.
const FEWEST_PIECES: u32 = 4;

/// A force is held for a sample, waits and passes a lag of first order.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Drive {
    /// Time that it waits, samples.
    wait: f64,
    /// Time constant of the lag, samples.
    lag: f64,
}

impl Drive {
    /// Nothing.
    pub const DIRECT: Self = Self {
        wait: 0.0,
        lag: 0.0,
    };

    /// Of a force that acts `late` samples later than one that is held, `lag` of them by a lag.
    pub fn new(late: f64, lag: f64) -> Self {
        Self {
            wait: (late - lag).max(0.0),
            lag: lag.max(0.0),
        }
    }

    /// How late the force acts, samples.
    pub fn late(&self) -> f64 {
        self.wait + self.lag
    }

    /// Steps of the plant in a piece of a sample, where a whole sample takes so many.
    pub fn substeps(&self, of_sample: u32) -> u32 {
        if self.lag > 0.0 { 1 } else { of_sample }
    }

    /// Gives every piece of the sample after the last command, as part of the sample and force; a sample takes so many steps.
    /// `behind` is the force behind the lag at its beginning, and at its end afterwards.
    pub fn sample(
        &self,
        commands: &[f64],
        steps: u32,
        behind: &mut f64,
        mut each: impl FnMut(f64, f64),
    ) {
        let whole = libm::floor(self.wait);
        let part = self.wait - whole;
        let last = commands.len().saturating_sub(1);
        // The first command has always been there.
        let ago = |samples: f64| commands[last.saturating_sub(samples as usize)];
        for (part, force) in [(part, ago(whole + 1.0)), (1.0 - part, ago(whole))] {
            if part <= 0.0 {
                continue;
            }
            if self.lag == 0.0 {
                each(part, force);
                continue;
            }
            let pieces = libm::ceil(part * f64::from(steps.max(FEWEST_PIECES)));
            let time = part / pieces / self.lag;
            let left = libm::exp(-time);
            let mean = -libm::expm1(-time) / time;
            for _ in 0..pieces as u32 {
                let apart = *behind - force;
                each(part / pieces, force + apart * mean);
                *behind = force + apart * left;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mean(drive: Drive, commands: &[f64], behind: &mut f64) -> f64 {
        let (mut sum, mut time) = (0.0, 0.0);
        drive.sample(commands, 3, behind, |part, force| {
            sum += part * force;
            time += part;
        });
        assert!((time - 1.0).abs() < 1e-12);
        sum
    }

    #[test]
    fn a_step_arrives_late_and_lagged() {
        let commands = [0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0];
        for (whole, lag) in [(0.0, 0.0), (0.3, 0.0), (1.0, 0.0), (0.4, 0.4), (1.7, 0.5)] {
            let drive = Drive::new(whole, lag);
            let mut behind = 0.0;
            for k in 0..commands.len() {
                let found = mean(drive, &commands[..=k], &mut behind);
                // The integral of the response to a step at 3 that waits, over the sample.
                let integral = |t: f64| {
                    let t = (t - 3.0 - (whole - lag)).max(0.0);
                    let short = if lag > 0.0 {
                        -lag * libm::expm1(-t / lag)
                    } else {
                        0.0
                    };
                    t - short
                };
                let k = k as f64;
                let want = integral(k + 1.0) - integral(k);
                assert!(
                    (found - want).abs() < 1e-12,
                    "{whole} {lag} at {k}: {found} {want}"
                );
            }
        }
    }
}
