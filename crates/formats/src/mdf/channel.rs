//! What the block of a channel says of it.

use super::bits::Bits;
use super::conversion::Conversion;
use super::source::{Block, Source, bad};
use crate::Error;

/// A channel of a group.
#[derive(Debug)]
pub(super) struct Channel {
    pub(super) name: String,
    pub(super) unit: Option<String>,
    /// Whether the others of its group are measured at what it holds.
    pub(super) master: bool,
    /// Whether it is seconds that nobody wrote a unit to.
    pub(super) seconds: bool,
    /// What is read of it, or why it is left out.
    pub(super) content: Result<Content, String>,
}

/// What is read of a channel.
#[derive(Clone, Copy, Debug)]
pub(super) struct Content {
    pub(super) numbers: Numbers,
    pub(super) conversion: Conversion,
    /// The bit that says that a value is none, in the bytes of a record for that.
    pub(super) invalid: Option<u32>,
}

/// Where the numbers of a channel come from.
#[derive(Clone, Copy, Debug)]
pub(super) enum Numbers {
    /// The records.
    Stored(Bits),
    /// The count of the records, from 0.
    Counted,
}

impl Channel {
    /// Of its block, in a group whose records have so many bytes of values, and so many that say which are none.
    pub(super) fn new(
        source: &mut Source,
        block: &Block,
        (data, invalid): (u64, u64),
    ) -> Result<Self, Error> {
        source.collector.hold(3 * size_of::<Self>() as u64)?;
        let name = source.text(block.link(2))?.unwrap_or_default();
        let conversion = match block.link(4) {
            0 => None,
            at => Some(source.block(at)?),
        };
        let master = matches!(block.byte(0), 2 | 3);
        let unit = match source.text(block.link(6))? {
            None => source.text(conversion.as_ref().map_or(0, |block| block.link(1)))?,
            unit => unit,
        };
        let (unit, seconds) = match (block.byte(1), unit) {
            (1, None) if master => (Some("s".to_owned()), true),
            (2, None) if master => (Some("rad".to_owned()), false),
            (3, None) if master => (Some("m".to_owned()), false),
            (_, unit) => (unit, false),
        };
        let content = match content(source, block, conversion.as_ref())? {
            Ok(mut content) => {
                // Where records have no such bytes, every value is one, whatever is said of its bit.
                content.invalid = content.invalid.filter(|_| invalid > 0);
                within(block, &content, data, invalid)?;
                Ok(content)
            }
            Err(why) => Err(why),
        };
        Ok(Self {
            name,
            unit,
            master,
            seconds,
            content,
        })
    }
}

/// What is read of it, or why it is left out.
fn content(
    source: &mut Source,
    block: &Block,
    conversion: Option<&Block>,
) -> Result<Result<Content, String>, Error> {
    if block.link(1) != 0 {
        let parts = source.block(block.link(1))?;
        let what = match &parts.mark {
            b"CA" => "an array",
            _ => "a structure",
        };
        return Ok(Err(what.to_owned()));
    }
    let stored = || Bits::new(block.byte(2), block.word(4), block.byte(3), block.word(8));
    let numbers = match block.byte(0) {
        0 | 2 => stored().map(Numbers::Stored),
        3 | 6 => Ok(Numbers::Counted),
        1 | 5 | 7 => Err("values of different lengths, such as text".to_owned()),
        4 => Err("places in an attachment".to_owned()),
        other => Err(format!("a channel of the unknown kind {other}")),
    };
    let flags = block.word(12);
    let numbers = match numbers {
        Ok(_) if flags & 1 != 0 => return Ok(Err("every value is marked as invalid".to_owned())),
        Ok(numbers) => numbers,
        Err(why) => return Ok(Err(why)),
    };
    let conversion = match conversion.map(Conversion::new).transpose()? {
        None => Conversion::None,
        Some(Ok(conversion)) => conversion,
        Some(Err(why)) => return Ok(Err(why.to_owned())),
    };
    Ok(Ok(Content {
        numbers,
        conversion,
        invalid: (flags & 2 != 0).then(|| block.word(16)),
    }))
}

/// Refuses what is read beyond the end of a record.
fn within(block: &Block, content: &Content, data: u64, invalid: u64) -> Result<(), Error> {
    if let Numbers::Stored(bits) = content.numbers
        && bits.end() > data
    {
        let end = bits.end();
        let found = format!("a channel up to byte {end} of records of {data} bytes");
        return Err(bad(block.at, found));
    }
    match content.invalid {
        Some(bit) if u64::from(bit / 8) >= invalid => {
            let found = format!(
                "a channel whose invalid values bit {bit} marks, where records have {invalid} bytes of such bits"
            );
            Err(bad(block.at, found))
        }
        _ => Ok(()),
    }
}
