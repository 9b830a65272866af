//! MAT files of version 4 (`save -v4`): full matrices of numbers.
//!
//! Format: "MAT-File Format", The MathWorks, appendix on level 4. Every variable is a header of five
//! 32-bit words, a name and the numbers, real parts first.

use std::fs::File;
use std::io::{BufReader, Read, Seek, SeekFrom};

use crate::binary::{ByteOrder, Class, Collector, Layout, Number, Order};
use crate::{Error, Kind, Limits, Table};

/// Longest name of a variable in bytes, far above the 31 characters of that version.
const MAX_NAME: u32 = 1024;

/// Reads all variables of a file of this many bytes.
pub(crate) fn read(file: File, bytes: u64, limits: Limits) -> Result<Table, Error> {
    let mut collector = Collector::new(limits);
    let mut reader = BufReader::with_capacity(1 << 16, file);
    let mut at = 0;
    while at < bytes {
        at = variable(&mut reader, at, bytes, &mut collector).map_err(|e| e.at_byte(at))?;
    }
    Ok(collector.finish())
}

fn bad(found: impl Into<String>) -> Error {
    Error::new(
        Kind::Format,
        found,
        "a MAT file of version 4 as MATLAB or scipy.io.savemat writes it",
    )
}

/// Reads the variable at this offset, and returns the offset of the next one.
fn variable(
    reader: &mut BufReader<File>,
    at: u64,
    bytes: u64,
    collector: &mut Collector,
) -> Result<u64, Error> {
    let cut = |_| bad("the file ends inside a variable");
    collector.entry()?;
    reader.seek(SeekFrom::Start(at)).map_err(cut)?;
    let mut words = [[0; 4]; 5];
    reader.read_exact(words.as_flattened_mut()).map_err(cut)?;
    // The thousands of the type tell the byte order: 0 little, 1 big.
    let order = match u32::from_le_bytes(words[0]) {
        0..1000 => ByteOrder::Little,
        _ => ByteOrder::Big,
    };
    let [kind, rows, columns, imaginary, length] = words.map(|word| match order {
        ByteOrder::Little => u32::from_le_bytes(word),
        ByteOrder::Big => u32::from_be_bytes(word),
    });
    let kind = match (order, kind) {
        (ByteOrder::Little, kind) => kind,
        (ByteOrder::Big, kind @ 1000..2000) => kind - 1000,
        (ByteOrder::Big, kind) => return Err(bad(format!("a variable of unknown type {kind}"))),
    };
    if length > MAX_NAME {
        return Err(bad(format!("a name of {length} bytes")));
    }
    let mut name = vec![0; length as usize];
    reader.read_exact(&mut name).map_err(cut)?;
    while name.last() == Some(&0) {
        name.pop();
    }
    let name = String::from_utf8_lossy(&name).into_owned();
    let (class, width) = match kind / 10 {
        0 => (Class::Float, 8),
        1 => (Class::Float, 4),
        2 => (Class::Signed, 4),
        3 => (Class::Signed, 2),
        4 => (Class::Unsigned, 2),
        5 => (Class::Unsigned, 1),
        _ => return Err(bad(format!("a variable of unknown type {kind}")).in_column(name)),
    };
    let dims = [u64::from(rows), u64::from(columns)];
    let parts = if imaginary == 0 { 1 } else { 2 };
    let size = u128::from(rows) * u128::from(columns) * width as u128 * parts;
    let content = at + 20 + u64::from(length);
    let next = u64::try_from(u128::from(content) + size)
        .ok()
        .filter(|&next| next <= bytes);
    let next = next.ok_or_else(|| bad("the file ends inside a variable").in_column(&name))?;
    match (kind % 10, imaginary, Layout::of(&dims)) {
        (1, ..) => collector.skip(&name, "text"),
        (2, ..) => collector.skip(&name, "sparse matrix; save it as a full one"),
        (0, 0, Layout::Skip(why)) => collector.skip(&name, &why),
        (0, 0, _) => {
            collector.reserve(&name, &dims)?;
            let number = Number::new(class, width, order);
            let number = number.ok_or_else(|| bad("numbers of an unknown type"))?;
            collector
                .numbers(&name, None, (&dims, Order::Column), number, reader)
                .map_err(cut)?;
        }
        (0, ..) => collector.skip(&name, "complex numbers; save real(x) and imag(x)"),
        _ => return Err(bad(format!("a variable of unknown type {kind}")).in_column(name)),
    }
    Ok(next)
}
