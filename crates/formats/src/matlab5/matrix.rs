//! Variables of a MATLAB v5 file: arrays of numbers, structs and cells of them.

use super::element::{MATRIX, Stream, Tag, number};
use crate::Error;
use crate::binary::{ByteOrder, Class, Collector, Layout, Number, Order, Values};

/// Deepest nesting of structs and cells.
const MAX_DEPTH: usize = 16;

/// Longest name of a variable, or list of field names, in bytes.
const MAX_NAMES: u64 = 1 << 20;

/// How a variable is called: by its own name, or by its place in the one around it.
#[derive(Clone, Copy)]
enum Called<'a> {
    OwnName,
    Path(&'a str),
}

/// Reads the variable whose tag was just read, adds what it holds, and tells whether that took all
/// of its bytes; a variable that is left out is not read on, however much it would unpack to.
pub(super) fn variable(
    stream: &mut Stream<'_>,
    tag: Tag,
    collector: &mut Collector,
) -> Result<bool, Error> {
    let mut part = stream.part(tag.size)?;
    matrix(&mut part, Called::OwnName, 0, collector)?;
    Ok(part.left() == 0)
}

/// Reads the content of one matrix element.
fn matrix(
    stream: &mut Stream<'_>,
    called: Called<'_>,
    depth: usize,
    collector: &mut Collector,
) -> Result<(), Error> {
    collector.entry().map_err(|e| e.at_byte(stream.at()))?;
    if depth > MAX_DEPTH {
        return Err(stream.bad(format!(
            "structs and cells are nested deeper than {MAX_DEPTH}"
        )));
    }
    if let (Called::Path(path), 0) = (called, stream.left()) {
        // An empty array in a cell or field may be written as an element without content.
        collector.skip(path, "empty");
        return Ok(());
    }
    let head = Head::read(stream, called)?;
    let name = head.name.as_str();
    content(stream, &head, depth, collector).map_err(|error| match error.place.column {
        None => error.in_column(name),
        Some(_) => error,
    })
}

fn content(
    stream: &mut Stream<'_>,
    head: &Head,
    depth: usize,
    collector: &mut Collector,
) -> Result<(), Error> {
    let name = head.name.as_str();
    if name.is_empty() {
        // MATLAB keeps the content of objects in a variable without a name.
        collector.skip("", "contents of objects");
        return Ok(());
    }
    let mut skip = |why: &str| collector.skip(name, why);
    match head.class {
        1 => cell(stream, head, depth, collector)?,
        2 => structure(stream, head, depth, collector)?,
        3 => skip("object of a class; save it as a struct"),
        4 => skip("text"),
        5 => skip("sparse matrix; save it as a full one"),
        6..=15 if head.complex => skip("complex numbers; save real(x) and imag(x)"),
        6..=15 => numeric(stream, head, collector)?,
        16 => skip("function handle"),
        17 => skip("object (timeseries, table ...); save its arrays"),
        class => return Err(stream.bad(format!("a variable of unknown class {class}"))),
    }
    Ok(())
}

/// What precedes the content of a matrix element.
struct Head {
    class: u8,
    complex: bool,
    logical: bool,
    dims: Vec<u64>,
    name: String,
}

impl Head {
    fn read(stream: &mut Stream<'_>, called: Called<'_>) -> Result<Self, Error> {
        let (kind, bytes) = stream.small_element(8)?;
        let (6, &[a, b, c, d, ..]) = (kind, &bytes[..]) else {
            return Err(stream.bad("a variable without array flags"));
        };
        let flags = match stream.order() {
            ByteOrder::Little => u32::from_le_bytes([a, b, c, d]),
            ByteOrder::Big => u32::from_be_bytes([a, b, c, d]),
        };
        let class = flags as u8;
        let mut head = Self {
            class,
            complex: flags & 0x800 != 0,
            logical: flags & 0x200 != 0,
            dims: Vec::new(),
            name: String::new(),
        };
        // An opaque object has no dimensions; its name follows at once.
        if class != 17 {
            head.dims = dimensions(stream)?;
        }
        let (_, bytes) = stream.small_element(MAX_NAMES)?;
        head.name = match called {
            Called::OwnName => text(&bytes),
            Called::Path(path) => path.to_owned(),
        };
        Ok(head)
    }

    /// Number of elements of a struct or cell array.
    fn elements(&self) -> u64 {
        self.dims.iter().copied().fold(1, u64::saturating_mul)
    }
}

fn dimensions(stream: &mut Stream<'_>) -> Result<Vec<u64>, Error> {
    let (kind, bytes) = stream.small_element(256)?;
    let number = number(kind, stream.order());
    let Some(number) = number.filter(|n| n.width() == 4 && bytes.len() >= 8) else {
        return Err(stream.bad("a variable without dimensions"));
    };
    let mut dims = Values::default();
    number.decode(&bytes, &mut dims);
    if dims.samples.iter().any(|&n| n < 0.0) {
        return Err(stream.bad("a negative dimension"));
    }
    Ok(dims.samples.iter().map(|&n| n as u64).collect())
}

fn text(bytes: &[u8]) -> String {
    let end = bytes.iter().position(|&b| b == 0).unwrap_or(bytes.len());
    String::from_utf8_lossy(&bytes[..end]).into_owned()
}

fn numeric(stream: &mut Stream<'_>, head: &Head, collector: &mut Collector) -> Result<(), Error> {
    if let Layout::Skip(why) = Layout::of(&head.dims) {
        collector.skip(&head.name, &why);
        return Ok(());
    }
    let at = stream.at();
    let count = collector
        .reserve(&head.name, &head.dims)
        .map_err(|e| e.at_byte(at))?;
    let tag = stream.tag()?;
    let Some(mut number) = number(tag.kind, stream.order()) else {
        return Err(stream.bad(format!("numbers of unknown type {}", tag.kind)));
    };
    if head.logical && number.width() == 1 {
        number = Number::new(Class::Bool, 1, stream.order()).unwrap_or(number);
    }
    if count.checked_mul(number.width() as u64) != Some(tag.size) {
        return Err(stream.bad(format!(
            "{} bytes of data for {count} numbers of {} bytes",
            tag.size,
            number.width()
        )));
    }
    stream.element(tag, |part| {
        let layout = (&head.dims[..], Order::Column);
        collector
            .numbers(&head.name, None, layout, number, part)
            .map_err(|error| part.io(error))
    })
}

/// `name{1}`, `name{2}` ...
fn cell(
    stream: &mut Stream<'_>,
    head: &Head,
    depth: usize,
    collector: &mut Collector,
) -> Result<(), Error> {
    for index in 1..=head.elements() {
        let path = format!("{}{{{index}}}", head.name);
        member(stream, &path, depth, collector)?;
    }
    Ok(())
}

/// `name.field`, or `name(1).field`, `name(2).field` ... of a struct array.
fn structure(
    stream: &mut Stream<'_>,
    head: &Head,
    depth: usize,
    collector: &mut Collector,
) -> Result<(), Error> {
    let (kind, bytes) = stream.small_element(8)?;
    let mut length = Values::default();
    if let Some(number) = number(kind, stream.order()).filter(|n| n.width() == bytes.len()) {
        number.decode(&bytes, &mut length);
    }
    let length = match length.samples[..] {
        [length] if (1.0..=4096.0).contains(&length) => length as usize,
        _ => return Err(stream.bad("a struct without the length of its field names")),
    };
    let (_, bytes) = stream.small_element(MAX_NAMES)?;
    let fields: Vec<String> = bytes.chunks_exact(length).map(text).collect();
    let elements = head.elements();
    if fields.is_empty() || elements == 0 {
        collector.skip(&head.name, "empty struct");
        return Ok(());
    }
    for index in 1..=elements {
        for field in &fields {
            let path = match elements {
                1 => format!("{}.{field}", head.name),
                _ => format!("{}({index}).{field}", head.name),
            };
            member(stream, &path, depth, collector)?;
        }
    }
    Ok(())
}

fn member(
    stream: &mut Stream<'_>,
    path: &str,
    depth: usize,
    collector: &mut Collector,
) -> Result<(), Error> {
    let tag = stream.tag()?;
    if tag.kind != MATRIX {
        return Err(stream
            .bad(format!(
                "an element of type {} in a struct or cell",
                tag.kind
            ))
            .in_column(path));
    }
    stream.element(tag, |part| {
        matrix(part, Called::Path(path), depth + 1, collector)
    })
}
