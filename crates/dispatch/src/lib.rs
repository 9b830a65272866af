//! Instruction sets: which the processor has, and running a kernel compiled for one of them.
//!
//! The only file of the workspace with `unsafe` code: calling a function that was compiled for an
//! instruction set is unsound where the processor lacks it. An [`InstructionSet`] is only handed out
//! after the processor was asked, so holding one is the proof.
//!
//! ```
//! use stiction_dispatch::{InstructionSet, Kernel};
//!
//! struct Sum<'a>(&'a [f64]);
//!
//! impl Kernel for Sum<'_> {
//!     type Output = f64;
//!
//!     #[inline(always)]
//!     fn run(self) -> f64 {
//!         self.0.iter().sum()
//!     }
//! }
//!
//! assert_eq!(InstructionSet::best().run(Sum(&[1.0, 2.0])), 3.0);
//! ```
#![allow(unsafe_code)]

use std::fmt;

/// An instruction set that this processor has.
///
/// All give the same bits; they differ in speed alone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct InstructionSet(Set);

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Set {
    #[cfg(target_arch = "x86_64")]
    Avx512,
    #[cfg(target_arch = "x86_64")]
    Avx2,
    Baseline,
}

impl InstructionSet {
    /// The widest that the processor has.
    pub fn best() -> Self {
        #[cfg(target_arch = "x86_64")]
        if has_avx2() {
            return Self(if has_avx512() { Set::Avx512 } else { Set::Avx2 });
        }
        Self(Set::Baseline)
    }

    /// All that the processor has, the widest first; the last is the target's baseline.
    ///
    /// On x86-64 the baseline has no fused multiply-add, which is then a call: correct, and slow.
    pub fn all() -> Vec<Self> {
        let mut sets = Vec::new();
        #[cfg(target_arch = "x86_64")]
        {
            if has_avx2() && has_avx512() {
                sets.push(Self(Set::Avx512));
            }
            if has_avx2() {
                sets.push(Self(Set::Avx2));
            }
        }
        sets.push(Self(Set::Baseline));
        sets
    }

    /// `avx512`, `avx2` or `baseline`.
    pub fn name(self) -> &'static str {
        match self.0 {
            #[cfg(target_arch = "x86_64")]
            Set::Avx512 => "avx512",
            #[cfg(target_arch = "x86_64")]
            Set::Avx2 => "avx2",
            Set::Baseline => "baseline",
        }
    }

    /// Runs a kernel compiled for this instruction set.
    pub fn run<K: Kernel>(self, kernel: K) -> K::Output {
        match self.0 {
            // SAFETY: a value of this variant is made in `all` only, after the processor said that it
            // has every feature that the function was compiled with.
            #[cfg(target_arch = "x86_64")]
            Set::Avx512 => unsafe { avx512(kernel) },
            // SAFETY: as above.
            #[cfg(target_arch = "x86_64")]
            Set::Avx2 => unsafe { avx2(kernel) },
            Set::Baseline => kernel.run(),
        }
    }
}

#[cfg(target_arch = "x86_64")]
fn has_avx2() -> bool {
    is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma")
}

/// What [`avx512`] needs beyond that.
#[cfg(target_arch = "x86_64")]
fn has_avx512() -> bool {
    is_x86_feature_detected!("avx512f")
        && is_x86_feature_detected!("avx512dq")
        && is_x86_feature_detected!("avx512vl")
}

impl fmt::Display for InstructionSet {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// A computation that is compiled once for each instruction set.
pub trait Kernel {
    /// What it returns.
    type Output;

    /// Must be `#[inline(always)]`, and so must all that it calls in its loops: what is inlined is
    /// compiled with the features of the caller.
    fn run(self) -> Self::Output;
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f,avx512dq,avx512vl,avx2,fma")]
fn avx512<K: Kernel>(kernel: K) -> K::Output {
    kernel.run()
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma")]
fn avx2<K: Kernel>(kernel: K) -> K::Output {
    kernel.run()
}
