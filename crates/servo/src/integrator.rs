//! How a plant is advanced in time: MID (the default), RODAS3 (the reference), ode4 (what the literature used).
//!
//! | | order | step | stiff bristles | laws |
//! |---|---|---|---|---|
//! | [`Mid`] | 2 | fixed | A-stable | any |
//! | [`Quick`] | 2, the same motion | fixed | A-stable | LuGre |
//! | [`Rodas3`] | 3 | adaptive | L-stable | LuGre |
//! | [`Ode4`] | 4 | fixed | unstable above a step that [`Ode4::check`] gives | LuGre |

mod advance;
mod flow;
mod mid;
mod ode4;
mod quick;
mod rodas3;

pub use advance::Integrator;
pub use mid::Mid;
pub use ode4::{Ode4, Unstable};
pub use quick::Quick;
pub use rodas3::{Rodas3, Work};

use crate::plant::{Load, Motion, Plant};
use stiction_friction::LuGre;

/// A choice made at run time.
// An axis holds one, and its own state is larger.
#[allow(clippy::large_enum_variant)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Choice {
    /// See [`Mid`].
    Mid(Mid),
    /// See [`Quick`].
    Quick(Quick),
    /// See [`Rodas3`].
    Rodas3(Rodas3),
    /// See [`Ode4`].
    Ode4(Ode4),
}

impl Integrator<LuGre<f64>> for Choice {
    fn advance(&mut self, plant: &Plant, from: Motion, span: f64, load: Load, rate: f64) -> Motion {
        match self {
            Choice::Mid(mid) => mid.advance(plant, from, span, load, rate),
            Choice::Quick(quick) => quick.advance(plant, from, span, load, rate),
            Choice::Rodas3(rodas3) => rodas3.advance(plant, from, span, load, rate),
            Choice::Ode4(ode4) => ode4.advance(plant, from, span, load, rate),
        }
    }

    fn expect(&mut self, next: f64) {
        if let Choice::Quick(quick) = self {
            Integrator::<LuGre<f64>>::expect(quick, next);
        }
    }

    fn forget(&mut self) {
        if let Choice::Quick(quick) = self {
            Integrator::<LuGre<f64>>::forget(quick);
        }
    }
}
