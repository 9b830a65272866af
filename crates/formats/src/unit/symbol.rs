//! The unit symbols that are known, their prefixes, and how a run of letters is taken apart.

use super::dimension::Dimension;
use std::f64::consts::PI;

/// A symbol's size: `mantissa * 10^exponent` of the SI unit of `dimension`, plus `offset`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Size {
    pub mantissa: f64,
    pub exponent: i32,
    pub offset: f64,
    pub dimension: Dimension,
    pub note: Option<&'static str>,
}

const RMS: &str =
    "taken as root-mean-square amperes; a force per ampere must be per rms ampere too";
const PEAK: &str = "taken as peak amperes; a force per ampere must be per peak ampere too";

const fn plain(mantissa: f64, exponent: i32, dimension: Dimension) -> Size {
    Size {
        mantissa,
        exponent,
        offset: 0.0,
        dimension,
        note: None,
    }
}

const fn noted(note: &'static str, dimension: Dimension) -> Size {
    Size {
        mantissa: 1.0,
        exponent: 0,
        offset: 0.0,
        dimension,
        note: Some(note),
    }
}

const CELSIUS: Size = Size {
    offset: 273.15,
    ..plain(1.0, 0, Dimension::TEMPERATURE)
};
const COUNT: Size = plain(1.0, 0, Dimension::COUNTS);
const TURN: Size = plain(2.0 * PI, 0, Dimension::ANGLE);
const RPM: Size = plain(PI / 30.0, 0, Dimension::ANGULAR_VELOCITY);
const THOUSANDTH: Size = plain(1.0, -3, Dimension::ONE);
const DEGREE: Size = plain(PI / 180.0, 0, Dimension::ANGLE);

/// Symbols, and the prefixes that each may carry.
const SYMBOLS: &[(&str, &str, Size)] = &[
    ("m", "kcmun", plain(1.0, 0, Dimension::LENGTH)),
    ("g", "kmu", plain(1.0, -3, Dimension::MASS)),
    ("s", "mun", plain(1.0, 0, Dimension::TIME)),
    ("A", "kmun", plain(1.0, 0, Dimension::CURRENT)),
    ("V", "kmun", plain(1.0, 0, Dimension::VOLTAGE)),
    ("ohm", "km", plain(1.0, 0, Dimension::RESISTANCE)),
    ("\u{3a9}", "km", plain(1.0, 0, Dimension::RESISTANCE)),
    ("\u{2126}", "km", plain(1.0, 0, Dimension::RESISTANCE)),
    ("H", "mu", plain(1.0, 0, Dimension::INDUCTANCE)),
    ("N", "Mkcmun", plain(1.0, 0, Dimension::FORCE)),
    ("K", "m", plain(1.0, 0, Dimension::TEMPERATURE)),
    ("Hz", "Mkm", plain(1.0, 0, Dimension::FREQUENCY)),
    ("rad", "mun", plain(1.0, 0, Dimension::ANGLE)),
    ("deg", "m", DEGREE),
    ("rpm", "k", RPM),
    ("Arms", "m", noted(RMS, Dimension::CURRENT)),
    ("Aeff", "m", noted(RMS, Dimension::CURRENT)),
    ("A_rms", "m", noted(RMS, Dimension::CURRENT)),
    ("Apk", "m", noted(PEAK, Dimension::CURRENT)),
    ("rms", "", noted(RMS, Dimension::ONE)),
    ("sec", "", plain(1.0, 0, Dimension::TIME)),
    ("min", "", plain(60.0, 0, Dimension::TIME)),
    ("h", "", plain(3600.0, 0, Dimension::TIME)),
    ("in", "", plain(254.0, -4, Dimension::LENGTH)),
    ("inch", "", plain(254.0, -4, Dimension::LENGTH)),
    ("ft", "", plain(3048.0, -4, Dimension::LENGTH)),
    (
        "lbf",
        "",
        plain(44_482_216_152_605.0, -13, Dimension::FORCE),
    ),
    (
        "ozf",
        "",
        plain(0.278_013_850_953_781_2, 0, Dimension::FORCE),
    ),
    ("kgf", "", plain(980_665.0, -5, Dimension::FORCE)),
    (
        "gn",
        "m",
        plain(980_665.0, -5, Dimension::LINEAR_ACCELERATION),
    ),
    ("\u{b0}", "", DEGREE),
    ("\u{ba}", "", DEGREE),
    ("arcmin", "", plain(PI / 10_800.0, 0, Dimension::ANGLE)),
    ("arcsec", "", plain(PI / 648_000.0, 0, Dimension::ANGLE)),
    ("rev", "", TURN),
    ("revs", "", TURN),
    ("turn", "", TURN),
    ("turns", "", TURN),
    ("RPM", "", RPM),
    ("rps", "", plain(2.0 * PI, 0, Dimension::ANGULAR_VELOCITY)),
    ("degC", "", CELSIUS),
    ("\u{b0}C", "", CELSIUS),
    ("\u{2103}", "", CELSIUS),
    ("%", "", plain(1.0, -2, Dimension::ONE)),
    ("\u{2030}", "", THOUSANDTH),
    ("permille", "", THOUSANDTH),
    ("promille", "", THOUSANDTH),
    ("count", "", COUNT),
    ("counts", "", COUNT),
    ("cnt", "", COUNT),
    ("cts", "", COUNT),
    ("inc", "", COUNT),
    ("incr", "", COUNT),
    ("increment", "", COUNT),
    ("increments", "", COUNT),
    ("pulse", "", COUNT),
    ("pulses", "", COUNT),
    ("tick", "", COUNT),
    ("ticks", "", COUNT),
    ("LSB", "", COUNT),
];

/// Spellings that errors may suggest.
pub(super) const COMMON: &str = "s, ms, us, ns, min, h, m, mm, um, nm, cm, km, in, ft, rad, mrad, urad, deg, rev, arcsec, arcmin, \
     m/s, mm/s, um/s, mm/min, m/min, rad/s, deg/s, rpm, rev/s, 1/min, U/min, N, kN, mN, uN, lbf, kgf, \
     N m, Nm, mN m, mNm, kNm, Ncm, A, mA, Arms, V, mV, kg, g, kg m2, kg*m^2, kg cm2, Hz, kHz, degC, K, \
     counts, inc, LSB, %, N/V, N/A, N*m/A, um/count, rad/count, N m s, N s/m, N m s/rad, N/m, N m/rad";

/// A turn that is one only before `/min` or `/s`: `U/min`, `r/min`.
pub(super) fn turn(run: &str) -> Option<Size> {
    matches!(run, "U" | "r").then_some(TURN)
}

/// A thousandth, as it stands in `0.1%`.
pub(super) const fn per_thousand() -> Size {
    THOUSANDTH
}

/// Revolutions a minute, for `1/min` and `min-1`.
pub(super) const fn per_minute() -> Size {
    RPM
}

/// A known symbol, with or without a prefix; the exact symbol goes before any prefix.
pub(super) fn lookup(run: &str) -> Option<Size> {
    let exact = |name: &str| SYMBOLS.iter().find(|(symbol, ..)| *symbol == name);
    if let Some((_, _, size)) = exact(run) {
        return Some(*size);
    }
    let prefix = run.chars().next()?;
    let (letter, exponent) = match prefix {
        'M' => ('M', 6),
        'k' => ('k', 3),
        'c' => ('c', -2),
        'm' => ('m', -3),
        'u' | '\u{b5}' | '\u{3bc}' => ('u', -6),
        'n' => ('n', -9),
        _ => return None,
    };
    let (_, prefixes, size) = exact(&run[prefix.len_utf8()..])?;
    prefixes.contains(letter).then_some(Size {
        exponent: size.exponent + exponent,
        ..*size
    })
}

/// `Nm`, `mNm`, `kgcm`: a force or mass symbol that runs into a length.
pub(super) fn split(run: &str) -> Option<(Size, Size)> {
    run.char_indices().skip(1).find_map(|(at, _)| {
        let (first, second) = run.split_at(at);
        let left = lookup(first)?;
        let right = lookup(second)?;
        // Grams before a metre are left out: `gm` is how some write grams.
        let heavy = left.dimension == Dimension::FORCE
            || (left.dimension == Dimension::MASS && (first != "g" || second == "cm"));
        let length = right.dimension == Dimension::LENGTH && second.ends_with('m');
        (heavy && length).then_some((left, right))
    })
}
