//! A generalised Maxwell-slip axis in the form of its authors, integrated by brute force.
//!
//! Al-Bender, Lampaert and Swevers 2005, doi 10.1109/TAC.2005.858676: an element sticks,
//! `F_i' = k_i v`, until it reaches its share `alpha_i s(v)` of the Stribeck curve, then slips,
//! `F_i' = sgn(v) C (alpha_i - F_i / s(v))`, until the velocity changes its sign. `s` has the sign of
//! `v`.

/// A law in their parameters, N, m, s.
#[derive(Clone, Debug)]
pub struct Maxwell {
    /// Stiffness and share of each element; the shares add up to one.
    pub elements: Vec<(f64, f64)>,
    /// Coulomb and static level, by direction.
    pub coulomb: [f64; 2],
    pub fixed: [f64; 2],
    pub velocity: [f64; 2],
    pub exponent: f64,
    /// Attraction, N/s.
    pub attraction: f64,
    pub viscous: f64,
}

/// Four elements of a presliding axis of 30 N that yield between 2 and 40 um.
pub fn four() -> Maxwell {
    let yields = [2e-6, 6e-6, 15e-6, 40e-6];
    let shares = [0.2, 0.3, 0.3, 0.2];
    let fixed = 30.0;
    Maxwell {
        elements: (0..4)
            .map(|i| (shares[i] * fixed / yields[i], shares[i]))
            .collect(),
        coulomb: [20.0; 2],
        fixed: [fixed; 2],
        velocity: [2e-3; 2],
        exponent: 2.0,
        attraction: 3000.0,
        viscous: 200.0,
    }
}

impl Maxwell {
    /// Stribeck curve without its sign.
    pub fn level(&self, v: f64) -> f64 {
        let side = usize::from(v < 0.0);
        let fall = (-(v.abs() / self.velocity[side]).powf(self.exponent)).exp();
        self.coulomb[side] + (self.fixed[side] - self.coulomb[side]) * fall
    }

    /// Deflection at which an element yields at rest, m.
    pub fn yields(&self, i: usize) -> f64 {
        let (k, share) = self.elements[i];
        share * self.fixed[0] / k
    }

    /// Total stiffness, N/m.
    pub fn stiffness(&self) -> f64 {
        self.elements.iter().map(|(k, _)| k).sum()
    }

    /// Force at a deflection from rest without history.
    pub fn virgin(&self, x: f64) -> f64 {
        self.elements
            .iter()
            .map(|&(k, share)| (k * x).min(share * self.fixed[0]))
            .sum()
    }

    /// Velocity and force at `n` samples, with `fine` midpoint steps of the equations a sample.
    pub fn along(
        &self,
        n: usize,
        step: f64,
        fine: usize,
        velocity: impl Fn(f64) -> f64,
    ) -> (Vec<f64>, Vec<f64>) {
        let h = step / fine as f64;
        let mut force = vec![0.0; self.elements.len()];
        let mut slips = vec![false; self.elements.len()];
        let mut direction = 0.0;
        let (mut vs, mut us) = (Vec::with_capacity(n), Vec::with_capacity(n));
        for i in 0..n {
            let at = i as f64 * step;
            if i > 0 {
                for k in 0..fine {
                    let v = velocity(at - step + (k as f64 + 0.5) * h);
                    let sign = if v < 0.0 { -1.0 } else { 1.0 };
                    if sign != direction {
                        slips.fill(false);
                        direction = sign;
                    }
                    let s = self.level(v);
                    for (i, &(stiffness, share)) in self.elements.iter().enumerate() {
                        if !slips[i] && sign * (force[i] + stiffness * v * h) >= share * s {
                            slips[i] = true;
                            force[i] = sign * share * s;
                        } else if slips[i] {
                            let slope = |f: f64| sign * self.attraction * (share - sign * f / s);
                            let middle = force[i] + 0.5 * h * slope(force[i]);
                            force[i] += h * slope(middle);
                        } else {
                            force[i] += stiffness * v * h;
                        }
                    }
                }
            }
            let v = velocity(at);
            vs.push(v);
            us.push(force.iter().sum::<f64>() + self.viscous * v);
        }
        (vs, us)
    }
}

/// A motion that slides, turns around and makes small loops inside large ones, m/s.
pub fn motion(t: f64) -> f64 {
    use std::f64::consts::TAU;
    8e-3 * (TAU * 0.4 * t).sin() + 1.5e-3 * (TAU * 3.1 * t).sin() + 4e-4 * (TAU * 17.3 * t).sin()
}
