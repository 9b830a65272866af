//! Numbers written for people to read: the one place where stiction turns a computed number into characters.
//!
//! | where | function |
//! |---|---|
//! | messages and terminal text (ASCII) | [`short`], [`four_digits`], [`full`], [`shortest`], [`counted`], [`r_squared`] |
//! | units, everywhere but in files | [`unit()`] |
//! | reports (typeset: `×10⁶`, a true minus sign) | [`sig`], [`count`], [`concise`], [`plus_minus`], [`interval`], [`si`], [`quantity`] |
//! | every percentage of something that was measured or fitted | [`Percent`] |
//! | sizes in bytes | [`bytes()`], [`bytes_option`], [`parse_bytes`] |
//!
//! ```
//! use stiction_number::{Percent, short, sig};
//! assert_eq!(short(7_410_000.0), "7.41e6");
//! assert_eq!(sig(7_410_000.0, 3), "7.41×10⁶");
//! assert_eq!(Percent::deviation(4.217).decimals(2), "4.22 %");
//! // Nobody can use a deviation of 10^24 %.
//! assert_eq!(Percent::deviation(2.97e24).decimals(2), "not bounded");
//! ```

mod bytes;
mod message;
mod percent;
mod typeset;

pub use bytes::{bytes, bytes_option, parse_bytes};
pub use message::{counted, four_digits, full, r_squared, short, shortest, unit};
pub use percent::{LARGEST_PERCENT, Percent};
pub use typeset::{
    concise, count, exponent, interval, plain, plus_minus, prefixed, quantity, si, sig,
    superscript, ten, times_ten,
};
