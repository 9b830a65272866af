//! Kinds of axes whose parameters are drawn from the ranges of real ones, every ratio as likely as another.
//!
//! Masses, speeds and encoders are those of catalogues of each kind. Identified axes lie inside: a ball screw of 95.1 kg with
//! 20.4 N, 203.5 N s/m and 7.4e6 N/m (EMPS; Janot, Gautier, Brunot 2019); joints of a UR10e with 2.0 and 12.5 N m and 3.6 and
//! 21.3 N m s/rad (Mamedov, Mikhel 2020); a servo motor of 2.0e-4 kg m^2 with .030 N m, 2.5e-4 N m s/rad and 8.4 N m/rad; a geared
//! motor DM8009 of .019 kg m^2 with .52 N m and .028 N m s/rad. Presliding lengths, Stribeck velocities and rises of rolling and sliding
//! contacts are those of Armstrong-Helouvry, Dupont, Canudas de Wit 1994 (doi 10.1016/0005-1098(94)90209-7).

use super::Machine;
use crate::random::Random;

/// Least and most.
type Range = [f64; 2];

/// A kind of axis: m, kg, N or rad, kg m^2, N m.
pub(in crate::worlds) struct Kind {
    pub name: &'static str,
    kind: &'static str,
    mass: Range,
    coulomb: Range,
    /// Travel in which the bristles reach the Coulomb level, Fc/sigma0.
    presliding: Range,
    /// Fs/Fc - 1.
    rise: Range,
    stribeck_velocity: Range,
    /// Viscous friction at top speed over Coulomb friction.
    viscous: Range,
    top_speed: Range,
    acceleration: Range,
    count: Range,
    /// Sampling rate, Hz: one of these.
    rates: [f64; 2],
    /// Bandwidth of the speed loop, Hz; at most a fortieth of the sampling rate.
    bandwidth: Range,
}

/// Damping ratio of the mass on its bristles, sigma1/(2 sqrt(sigma0 M)).
const DAMPING: Range = [0.1, 1.0];
/// Noise of the logged force over Coulomb friction.
const NOISE: Range = [0.003, 0.05];

/// Of the set `test`.
pub(in crate::worlds) const TEST: [Kind; 6] = [
    Kind {
        name: "linear motor",
        kind: "linear",
        mass: [4.0, 40.0],
        coulomb: [8.0, 60.0],
        presliding: [3e-6, 25e-6],
        rise: [0.1, 0.6],
        stribeck_velocity: [1e-3, 15e-3],
        viscous: [0.1, 1.5],
        top_speed: [0.2, 1.0],
        acceleration: [3.0, 15.0],
        count: [5e-9, 200e-9],
        rates: [2000.0, 4000.0],
        bandwidth: [20.0, 80.0],
    },
    Kind {
        name: "ball screw",
        kind: "linear",
        mass: [40.0, 400.0],
        coulomb: [20.0, 300.0],
        presliding: [2.5e-6, 20e-6],
        rise: [0.1, 0.7],
        stribeck_velocity: [1e-3, 10e-3],
        viscous: [0.2, 3.0],
        top_speed: [0.08, 0.4],
        acceleration: [0.8, 5.0],
        count: [10e-9, 500e-9],
        rates: [1000.0, 2000.0],
        bandwidth: [15.0, 50.0],
    },
    Kind {
        name: "belt axis",
        kind: "linear",
        mass: [3.0, 20.0],
        coulomb: [8.0, 50.0],
        presliding: [20e-6, 100e-6],
        rise: [0.1, 0.5],
        stribeck_velocity: [5e-3, 40e-3],
        viscous: [0.1, 1.5],
        top_speed: [0.5, 1.5],
        acceleration: [3.0, 15.0],
        count: [0.1e-6, 3e-6],
        rates: [1000.0, 2000.0],
        bandwidth: [8.0, 30.0],
    },
    Kind {
        name: "torque motor table",
        kind: "rotary",
        mass: [0.05, 2.0],
        coulomb: [1.0, 12.0],
        presliding: [5e-5, 1e-3],
        rise: [0.1, 0.6],
        stribeck_velocity: [5e-3, 0.1],
        viscous: [0.1, 1.5],
        top_speed: [1.0, 6.0],
        acceleration: [8.0, 40.0],
        count: [4e-7, 1.2e-5],
        rates: [1000.0, 4000.0],
        bandwidth: [10.0, 40.0],
    },
    Kind {
        name: "strain-wave joint",
        kind: "rotary",
        mass: [0.2, 8.0],
        coulomb: [2.0, 25.0],
        presliding: [2e-4, 2e-3],
        rise: [0.1, 0.6],
        stribeck_velocity: [0.01, 0.15],
        viscous: [0.5, 3.5],
        top_speed: [0.8, 3.0],
        acceleration: [4.0, 20.0],
        count: [1e-6, 5e-5],
        rates: [500.0, 1000.0],
        bandwidth: [5.0, 15.0],
    },
    Kind {
        name: "servo motor",
        kind: "rotary",
        mass: [5e-5, 2e-3],
        coulomb: [0.015, 0.15],
        presliding: [1e-3, 8e-3],
        rise: [0.1, 0.6],
        stribeck_velocity: [0.2, 4.0],
        viscous: [0.1, 1.5],
        top_speed: [10.0, 80.0],
        acceleration: [150.0, 1500.0],
        count: [4.8e-5, 6.3e-4],
        rates: [1000.0, 2000.0],
        bandwidth: [15.0, 50.0],
    },
];

/// Of the set `report`.
pub(in crate::worlds) const REPORT: [Kind; 6] = [
    Kind {
        name: "cross-roller stage",
        kind: "linear",
        mass: [0.6, 6.0],
        coulomb: [1.0, 10.0],
        presliding: [2e-6, 20e-6],
        rise: [0.1, 0.6],
        stribeck_velocity: [0.5e-3, 8e-3],
        viscous: [0.1, 1.5],
        top_speed: [0.1, 0.5],
        acceleration: [2.0, 12.0],
        count: [2e-9, 100e-9],
        rates: [2000.0, 4000.0],
        bandwidth: [25.0, 90.0],
    },
    Kind {
        name: "lead screw",
        kind: "linear",
        mass: [5.0, 60.0],
        coulomb: [30.0, 250.0],
        presliding: [5e-6, 50e-6],
        rise: [0.2, 1.0],
        stribeck_velocity: [1e-3, 15e-3],
        viscous: [0.1, 1.0],
        top_speed: [0.03, 0.15],
        acceleration: [0.3, 2.0],
        count: [50e-9, 1e-6],
        rates: [1000.0, 2000.0],
        bandwidth: [10.0, 40.0],
    },
    Kind {
        name: "rack gantry",
        kind: "linear",
        mass: [80.0, 800.0],
        coulomb: [80.0, 800.0],
        presliding: [8e-6, 80e-6],
        rise: [0.1, 0.6],
        stribeck_velocity: [3e-3, 30e-3],
        viscous: [0.2, 2.0],
        top_speed: [0.4, 1.5],
        acceleration: [1.0, 6.0],
        count: [0.1e-6, 2e-6],
        rates: [1000.0, 2000.0],
        bandwidth: [8.0, 25.0],
    },
    Kind {
        name: "light belt axis",
        kind: "linear",
        mass: [0.5, 4.0],
        coulomb: [2.0, 12.0],
        presliding: [20e-6, 150e-6],
        rise: [0.1, 0.5],
        stribeck_velocity: [4e-3, 40e-3],
        viscous: [0.1, 1.5],
        top_speed: [0.3, 1.2],
        acceleration: [3.0, 20.0],
        count: [0.5e-6, 10e-6],
        rates: [1000.0, 2000.0],
        bandwidth: [10.0, 35.0],
    },
    Kind {
        name: "direct-drive arm",
        kind: "rotary",
        mass: [0.03, 0.6],
        coulomb: [0.4, 6.0],
        presliding: [1e-4, 2e-3],
        rise: [0.1, 0.6],
        stribeck_velocity: [5e-3, 0.15],
        viscous: [0.1, 1.5],
        top_speed: [1.5, 8.0],
        acceleration: [10.0, 60.0],
        count: [3e-6, 2.4e-5],
        rates: [1000.0, 2000.0],
        bandwidth: [10.0, 40.0],
    },
    Kind {
        name: "planetary joint",
        kind: "rotary",
        mass: [0.005, 0.1],
        coulomb: [0.15, 2.5],
        presliding: [1e-3, 1e-2],
        rise: [0.1, 0.7],
        stribeck_velocity: [0.03, 0.6],
        viscous: [0.2, 2.0],
        top_speed: [3.0, 15.0],
        acceleration: [30.0, 200.0],
        count: [4e-5, 4e-4],
        rates: [500.0, 1000.0],
        bandwidth: [8.0, 15.0],
    },
];

impl Kind {
    /// One of its axes.
    pub fn drawn(&self, random: &mut Random) -> Machine {
        let mut of = |[least, most]: Range| random.between(least, most);
        let (mass, coulomb, top_speed) = (of(self.mass), of(self.coulomb), of(self.top_speed));
        let sigma0 = coulomb / of(self.presliding);
        let rate = self.rates[usize::from(of([1.0, 4.0]) > 2.0)];
        let bandwidth = of(self.bandwidth).min(rate / 40.0);
        Machine {
            kind: self.kind,
            sigma0,
            sigma1: 2.0 * of(DAMPING) * (sigma0 * mass).sqrt(),
            sigma2: of(self.viscous) * coulomb / top_speed,
            coulomb,
            static_friction: coulomb * (1.0 + of(self.rise)),
            stribeck_velocity: of(self.stribeck_velocity),
            mass,
            top_speed,
            acceleration: of(self.acceleration),
            count: of(self.count),
            rate,
            noise: coulomb * of(NOISE),
            bandwidth,
            fast: FAST * bandwidth,
        }
    }
}

/// The fast segment of a commissioning motion, in bandwidths of the speed loop.
pub(in crate::worlds) const FAST: f64 = 0.4;
