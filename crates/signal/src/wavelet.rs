//! Signal and noise told apart by scale: an undecimated wavelet transform with thresholds.
//!
//! Each scale is the difference of two smoothings with the cubic B-spline (the à trous algorithm: Holschneider et al. 1989,
//! doi 10.1007/978-3-642-97177-8_28; with this spline: Starck and Murtagh 2006, doi 10.1007/978-3-540-33025-7). Unlike bands
//! of a low-pass filter a scale has no ripple, so that a jump of the signal stays where it is.

/// Weights of the cubic B-spline.
const SPLINE: [f64; 3] = [6.0 / 16.0, 4.0 / 16.0, 1.0 / 16.0];
/// Scales that noise is looked for in; what is coarser is taken as signal.
const SCALES: u32 = 7;
/// Times that the residual is searched for signal.
const PASSES: usize = 4;
/// Median of the absolute value of a standard normal number.
const MEDIAN_NORMAL: f64 = 0.674_489_750_196_081_7;

/// The finest scale of a channel: what is left of it beside its smoothing over five samples. White noise keeps .72 of its
/// deviation, a signal that is smooth between samples nothing.
pub fn finest_scale(x: &[f64]) -> Vec<f64> {
    let smooth = smoothed(x, 1);
    x.iter().zip(&smooth).map(|(x, s)| x - s).collect()
}

/// A channel without its white noise.
///
/// Of each scale only what exceeds `deviations` standard deviations of the noise there, and its neighbours within the width of
/// the scale, are kept (hard thresholds: Donoho and Johnstone 1994, doi 10.1093/biomet/81.3.425); the deviation is that of the
/// finest scale, from its median. What the residual has at these places is added until it has nothing left.
pub fn without_noise(x: &[f64], deviations: f64) -> Vec<f64> {
    let gains = gains();
    let mut sizes: Vec<f64> = finest_scale(x).iter().map(|w| w.abs()).collect();
    if sizes.is_empty() {
        return Vec::new();
    }
    let middle = sizes.len() / 2;
    let median = *sizes.select_nth_unstable_by(middle, f64::total_cmp).1;
    let noise = median / (MEDIAN_NORMAL * gains[0]);
    let mut kept: Vec<Vec<bool>> = Vec::new();
    let mut out = vec![0.0; x.len()];
    for pass in 0..PASSES {
        let mut fine: Vec<f64> = x.iter().zip(&out).map(|(x, y)| x - y).collect();
        for scale in 0..SCALES {
            let width = 1_usize << scale;
            let coarse = smoothed(&fine, width);
            let detail = fine.iter().zip(&coarse).map(|(f, c)| f - c);
            let detail: Vec<f64> = detail.collect();
            if pass == 0 {
                let least = deviations * noise * gains[scale as usize];
                kept.push(near(detail.iter().map(|d| d.abs() > least), width));
            }
            let parts = out.iter_mut().zip(&detail).zip(&kept[scale as usize]);
            for ((y, d), kept) in parts {
                *y += if *kept { *d } else { 0.0 };
            }
            fine = coarse;
        }
        out.iter_mut().zip(&fine).for_each(|(y, c)| *y += c);
    }
    out
}

/// Places within a distance of one that is marked.
fn near(marked: impl Iterator<Item = bool>, distance: usize) -> Vec<bool> {
    let marked: Vec<bool> = marked.collect();
    let mut out = vec![false; marked.len()];
    let mut filled = 0;
    for i in (0..marked.len()).filter(|&i| marked[i]) {
        let end = (i + distance + 1).min(marked.len());
        let begin = i.saturating_sub(distance).max(filled);
        out[begin.min(end)..end].fill(true);
        filled = end;
    }
    out
}

/// Smoothed by the spline with this distance between its points; mirrored at the ends.
fn smoothed(x: &[f64], width: usize) -> Vec<f64> {
    let n = x.len();
    let mirrored = |i: isize| {
        let around = 2 * n as isize;
        let i = i.rem_euclid(around);
        x[i.min(around - 1 - i) as usize]
    };
    let of = |own: f64, near: f64, far: f64| SPLINE[0] * own + SPLINE[1] * near + SPLINE[2] * far;
    let reach = 2 * width;
    let mut out = Vec::with_capacity(n);
    let edge = |i: usize| {
        let at = |by: isize| mirrored(i as isize + by);
        let w = width as isize;
        of(x[i], at(-w) + at(w), at(-2 * w) + at(2 * w))
    };
    let inner = reach.min(n)..n.saturating_sub(reach).max(reach.min(n));
    out.extend((0..inner.start).map(edge));
    out.extend(inner.clone().map(|i| {
        of(
            x[i],
            x[i - width] + x[i + width],
            x[i - reach] + x[i + reach],
        )
    }));
    out.extend((inner.end..n).map(edge));
    out
}

/// Deviation that white noise of deviation 1 has in each scale.
fn gains() -> [f64; SCALES as usize] {
    let half = 4_usize << SCALES;
    let mut fine = vec![0.0; 2 * half];
    fine[half] = 1.0;
    std::array::from_fn(|scale| {
        let coarse = smoothed(&fine, 1 << scale);
        let energy: f64 = fine
            .iter()
            .zip(&coarse)
            .map(|(f, c)| (f - c) * (f - c))
            .sum();
        fine = coarse;
        energy.sqrt()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers between -1 and 1 without correlation, of variance 1/3.
    fn noise(n: usize) -> Vec<f64> {
        let mut state = 1_u64;
        let mut next = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
        };
        (0..n).map(|_| next()).collect()
    }

    fn rms(x: impl ExactSizeIterator<Item = f64>) -> f64 {
        let n = x.len() as f64;
        (x.map(|x| x * x).sum::<f64>() / n).sqrt()
    }

    #[test]
    fn scales_add_up_and_their_noise_is_as_stated() {
        let x = noise(100_000);
        let mut fine = x.clone();
        for (scale, gain) in gains().iter().enumerate() {
            let coarse = smoothed(&fine, 1 << scale);
            let found = rms(fine.iter().zip(&coarse).map(|(f, c)| f - c)) * 3.0_f64.sqrt();
            assert!((found / gain - 1.0).abs() < 0.05, "{scale}: {found} {gain}");
            fine = coarse;
        }
        let finest = finest_scale(&x);
        let smooth = smoothed(&x, 1);
        assert!((0..x.len()).all(|i| (finest[i] + smooth[i] - x[i]).abs() < 1e-15));
        // A straight line has no detail inside.
        let line: Vec<f64> = (0..100).map(|i| 3.0 * f64::from(i)).collect();
        assert!(finest_scale(&line)[2..98].iter().all(|d| d.abs() < 1e-12));
    }

    #[test]
    fn noise_goes_and_jumps_and_sines_stay() {
        let n = 8000;
        let signal = |i: usize| {
            let jump = if i % 1000 < 500 { 4.0 } else { -4.0 };
            jump + 10.0 * (i as f64 * 0.003).sin()
        };
        let x: Vec<f64> = noise(n)
            .iter()
            .enumerate()
            .map(|(i, e)| signal(i) + e)
            .collect();
        let clean = without_noise(&x, 4.0);
        let left = rms((0..n).map(|i| clean[i] - signal(i))) * 3.0_f64.sqrt();
        assert!(left < 0.35, "{left} of the noise is left");
        // Nothing to remove.
        let pure: Vec<f64> = (0..n).map(signal).collect();
        let same = without_noise(&pure, 4.0);
        assert!(
            (0..n).all(|i| (same[i] - pure[i]).abs() < 0.02),
            "a pure signal changes"
        );
    }

    #[test]
    fn short_channels_are_no_trouble() {
        for n in 0..40 {
            let x: Vec<f64> = (0..n).map(f64::from).collect();
            assert_eq!(without_noise(&x, 4.0).len(), n as usize);
            assert_eq!(finest_scale(&x).len(), n as usize);
        }
        let constant = without_noise(&[2.0; 7], 4.0);
        assert!(constant.iter().all(|x| (x - 2.0).abs() < 1e-12));
    }
}
