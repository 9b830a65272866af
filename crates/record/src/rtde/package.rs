//! What a robot sends.

use crate::source::Sample;

/// A package that arrived.
#[derive(Debug)]
pub(super) enum Package<'a> {
    /// Whether the version is accepted.
    Version(bool),
    /// Number of the recipe, and the kinds of its outputs separated by commas.
    Outputs(u8, String),
    /// Whether the outputs will be sent.
    Start(bool),
    /// Number of the recipe, and the outputs.
    Data(u8, &'a [u8]),
    /// A message for people, and what else is of no use here.
    Other,
}

/// Length of the package that these bytes begin with.
pub(super) fn frame_length(bytes: &[u8]) -> Result<Option<usize>, &'static str> {
    let Some((length, _)) = bytes.split_first_chunk() else {
        return Ok(None);
    };
    match usize::from(u16::from_be_bytes(*length)) {
        0..3 => Err("sends no RTDE packages; is this port 30004 of a robot?"),
        length => Ok(Some(length)),
    }
}

impl<'a> Package<'a> {
    /// Reads a whole package.
    pub fn read(frame: &'a [u8]) -> Result<Self, &'static str> {
        const SHORT: &str = "sends an RTDE package that is too short";
        let (kind, content) = frame
            .get(2..)
            .and_then(|rest| rest.split_first())
            .ok_or(SHORT)?;
        let first = content.split_first().ok_or(SHORT);
        Ok(match kind {
            b'V' => Package::Version(*first?.0 == 1),
            b'O' => {
                let (recipe, kinds) = first?;
                Package::Outputs(*recipe, String::from_utf8_lossy(kinds).into_owned())
            }
            b'S' => Package::Start(*first?.0 == 1),
            b'U' => {
                let (recipe, data) = first?;
                Package::Data(*recipe, data)
            }
            _ => Package::Other,
        })
    }
}

/// The time stamp and this many values; `None` where the data are not that.
pub(super) fn sample(data: &[u8], values: usize) -> Option<Sample> {
    let (numbers, rest) = data.as_chunks();
    let mut numbers = numbers.iter().map(|number| f64::from_be_bytes(*number));
    let time = numbers.next().filter(|time| time.is_finite())?;
    let read: Vec<f64> = numbers.collect();
    (read.len() == values && rest.is_empty()).then_some(Sample { time, values: read })
}
