//! Axes whose parameters are known: the one library of them for tests, benches, demo and docs.

mod simulated;

pub use simulated::corners;

use stiction_friction::{Damping, Direction, LuGre, ParamError, Shape, Stribeck};

/// Whether positions are metres or radians.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// m, kg, N
    Linear,
    /// rad, kg m^2, N m
    Rotary,
}

/// An axis with its parameters and where they come from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KnownAxis {
    /// Short name, as [`find`] takes it.
    pub name: &'static str,
    /// What it is, and the publication with its DOI where there is one.
    pub source: &'static str,
    /// Linear or rotary.
    pub kind: Kind,
    /// Mass, kg (inertia, kg m^2).
    pub mass: f64,
    /// The law as published: symmetric, Gaussian, no offset, constant sigma1.
    pub law: LuGre<f64>,
}

impl KnownAxis {
    /// The law with sigma1 capped so that it cannot create energy.
    pub fn capped_law(&self) -> LuGre<f64> {
        let capped = Damping::Capped(self.law.damping().at_rest());
        // A valid sigma1 stays valid.
        self.law.with_damping(capped).unwrap_or(self.law)
    }
}

struct Entry {
    name: &'static str,
    source: &'static str,
    kind: Kind,
    mass: f64,
    /// sigma0, sigma1, sigma2, Fc, Fs, vs
    numbers: [f64; 6],
}

const TABLE: [Entry; 7] = [
    Entry {
        name: "C95",
        source: "block of the experiments in Canudas de Wit, Olsson, Astrom, Lischinsky 1995, doi 10.1109/9.376053",
        kind: Kind::Linear,
        mass: 1.0,
        numbers: [1e5, 316.227_766_016_837_94, 0.4, 1.0, 1.5, 1e-3],
    },
    Entry {
        name: "V5",
        source: "DC servo of Olsson, Astrom, Canudas de Wit, Gafvert, Lischinsky 1998, doi 10.1016/S0947-3580(98)70113-X",
        kind: Kind::Rotary,
        mass: 0.0023,
        numbers: [260.0, 0.6, 0.0176, 0.28, 0.33, 0.01],
    },
    Entry {
        name: "V6",
        source: "direct-drive torque motor of Wang, Lin, Wang 2016, doi 10.1155/2016/6929457",
        kind: Kind::Rotary,
        mass: 0.045,
        numbers: [2750.0, 45.2, 1.819, 6.975, 8.558, 0.0611],
    },
    Entry {
        name: "V10",
        source: "start-stop example of Astrom, Canudas de Wit 2008, doi 10.1109/MCS.2008.929425",
        kind: Kind::Linear,
        mass: 1.0,
        numbers: [3.9e4, 395.0, 0.0, 2.94, 5.88, 0.01],
    },
    Entry {
        name: "V16",
        source: "simulated axis with a wide Stribeck range; no publication",
        kind: Kind::Linear,
        mass: 5.0,
        numbers: [1.333e5, 600.0, 35.0, 5.0, 20.0, 0.07],
    },
    Entry {
        name: "machine",
        source: "bench set of this project: a machine-tool slide; no publication",
        kind: Kind::Linear,
        mass: 10.0,
        numbers: [1.2e5, 600.0, 60.0, 20.0, 30.0, 5e-3],
    },
    Entry {
        name: "motor",
        source: "bench set of this project: a linear motor stage; no publication",
        kind: Kind::Linear,
        mass: 4.6,
        numbers: [2e6, 1.5e3, 30.0, 12.0, 18.0, 3e-3],
    },
];

impl Entry {
    fn axis(&self) -> Result<KnownAxis, ParamError> {
        let [s0, s1, s2, fc, fs, vs] = self.numbers;
        let both = Direction {
            coulomb: fc,
            static_friction: fs,
            stribeck_velocity: vs,
            viscous: s2,
        };
        let curve = Stribeck::symmetric(Shape::Gaussian, both, 0.0)?;
        let law = LuGre::new(s0, Damping::Constant(s1), curve)?;
        Ok(KnownAxis {
            name: self.name,
            source: self.source,
            kind: self.kind,
            mass: self.mass,
            law,
        })
    }
}

/// All known axes, in the order of the table.
pub fn all() -> impl Iterator<Item = KnownAxis> {
    // The table holds valid parameters, as its test shows.
    TABLE.iter().filter_map(|entry| entry.axis().ok())
}

/// The known axis of this name, upper or lower case: `C95`, `V5`, `V6`, `V10`, `V16`, `machine`, `motor`.
pub fn find(name: &str) -> Option<KnownAxis> {
    all().find(|axis| axis.name.eq_ignore_ascii_case(name))
}

#[cfg(test)]
mod tests {
    #[test]
    fn every_entry_is_valid_and_found_by_its_name() {
        assert_eq!(super::all().count(), super::TABLE.len());
        for axis in super::all() {
            assert_eq!(super::find(&axis.name.to_uppercase()), Some(axis));
            assert!(axis.mass > 0.0);
            assert_eq!(axis.capped_law().curve(), axis.law.curve());
            assert_ne!(axis.capped_law(), axis.law);
        }
        assert_eq!(super::find("nothing"), None);
    }
}
