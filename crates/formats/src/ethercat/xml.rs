//! Process data by the description of a network (ENI, ETG.2100) or of a device (ESI, ETG.2000).
//!
//! An ENI says where every number of every slave is in the image of the process, and which bytes of it each cyclic datagram carries.
//! An ESI knows one drive: where it is alone in the network the lengths of the datagrams fit, else nothing is offered.

use std::collections::BTreeSet;

use roxmltree::{Document, Node};

use super::map::{Address, Direction, Type};
use super::object::{named, object};
use super::offer::{MOST_OFFERED, Offer};
use super::seen::Seen;

/// Longest tag of a description, bytes; theirs have some hundred.
const LONGEST_TAG: usize = 1 << 15;

/// A number of a process data object, without a place.
struct Part {
    index: u16,
    name: String,
    bits: usize,
    kind: Option<Type>,
}

/// The map that a description gives; nothing where it is none, or fits nothing of the capture.
pub(super) fn offers(text: &str, seen: &Seen) -> Vec<Offer> {
    // Attributes of one tag are compared with each other.
    let is_long = |tag: &str| tag.find('>').unwrap_or(tag.len()) > LONGEST_TAG;
    if text.split('<').any(is_long) {
        return Vec::new();
    }
    let Ok(document) = Document::parse(text) else {
        return Vec::new();
    };
    let root = document.root_element();
    let mut offers = match root.tag_name().name() {
        "EtherCATConfig" => network(root),
        "EtherCATInfo" => device(root, seen),
        _ => Vec::new(),
    };
    offers.truncate(MOST_OFFERED);
    offers
}

fn child<'a>(node: Node<'a, 'a>, name: &str) -> Option<Node<'a, 'a>> {
    children(node, name).next()
}

fn children<'a>(node: Node<'a, 'a>, name: &str) -> impl Iterator<Item = Node<'a, 'a>> {
    node.children()
        .filter(move |node| node.tag_name().name() == name)
}

/// The text of a child.
fn word<'a>(node: Node<'a, 'a>, name: &str) -> Option<&'a str> {
    Some(child(node, name)?.text()?.trim())
}

/// A whole number as it is written there: `26`, `#x1a00`, `0x1a00`.
fn whole(text: &str) -> Option<usize> {
    let hexadecimal = text.strip_prefix("#x").or(text.strip_prefix("0x"));
    match hexadecimal {
        Some(digits) => usize::from_str_radix(digits, 16).ok(),
        None => text.parse().ok(),
    }
}

fn number(node: Node<'_, '_>, name: &str) -> Option<usize> {
    let child = node
        .children()
        .find(|node| node.tag_name().name() == name)?;
    whole(child.text()?.trim())
}

/// The numbers of the process data objects that a slave or device sends (`TxPdo`) or gets (`RxPdo`) where nobody chose others.
fn parts<'a>(of: Node<'a, 'a>, pdo: &str) -> Vec<Part> {
    let chosen = children(of, pdo).filter(|pdo| pdo.has_attribute("Sm"));
    let entries = chosen.flat_map(|pdo| children(pdo, "Entry"));
    let part = |entry: Node<'a, 'a>| {
        let kind = word(entry, "DataType").and_then(kind);
        Some(Part {
            index: u16::try_from(number(entry, "Index").unwrap_or(0)).ok()?,
            name: word(entry, "Name").unwrap_or_default().to_owned(),
            bits: number(entry, "BitLen").filter(|bits| *bits <= 1 << 16)?,
            kind,
        })
    };
    entries.filter_map(part).collect()
}

fn kind(word: &str) -> Option<Type> {
    let mut all = Type::ALL.into_iter();
    all.find(|(.., words)| words.contains(&word))
        .map(|(kind, ..)| kind)
}

/// Numbers one behind the other from a bit of an image on, each with its bit, those that a column can be.
fn placed(parts: Vec<Part>, from: usize) -> impl Iterator<Item = (usize, Part)> {
    let mut at = from;
    let each = parts.into_iter().map(move |part| {
        let own = at;
        at = at.saturating_add(part.bits);
        (own, part)
    });
    each.filter(|(_, part)| {
        let fits = |kind: Type| kind.bits() == part.bits;
        part.index != 0
            && part
                .kind
                .or(object(part.index).map(|o| o.kind))
                .is_some_and(fits)
    })
}

fn offer(part: Part, address: Address, bit: usize, direction: Direction) -> Option<Offer> {
    let known = object(part.index).filter(|known| known.kind.bits() == part.bits);
    Some(Offer {
        index: known.map_or(0, |_| part.index),
        name: known.map_or(part.name, |known| known.name.to_owned()),
        kind: part.kind.or(known.map(|known| known.kind))?,
        address,
        bit,
        direction,
    })
}

/// A cyclic datagram: its bytes of the image of inputs and of that of outputs.
struct Cyclic {
    address: Address,
    bytes: usize,
    at: [Option<usize>; 2],
}

/// The cyclic datagrams of a network.
fn cyclic<'a>(config: Node<'a, 'a>) -> Vec<Cyclic> {
    let frames = children(config, "Cyclic").flat_map(|cyclic| children(cyclic, "Frame"));
    let commands = frames.flat_map(|frame| children(frame, "Cmd"));
    let one = |command: Node<'a, 'a>| {
        let kind = number(command, "Cmd")?;
        let address = match kind {
            10..=12 => Address::Logical(u32::try_from(number(command, "Addr")?).ok()?),
            4..=6 => Address::Physical {
                station: u16::try_from(number(command, "Adp")?).ok()?,
                offset: u16::try_from(number(command, "Ado")?).ok()?,
            },
            _ => return None,
        };
        let reads = matches!(kind, 4 | 6 | 10 | 12);
        let writes = matches!(kind, 5 | 6 | 11 | 12);
        Some(Cyclic {
            address,
            bytes: number(command, "DataLength")?,
            at: [
                number(command, "InputOffs").filter(|_| reads),
                number(command, "OutputOffs").filter(|_| writes),
            ],
        })
    };
    commands.filter_map(one).collect()
}

/// The datagram that has a bit of an image, and the bit of its data.
fn carried(
    all: &[Cyclic],
    bit: usize,
    bits: usize,
    direction: Direction,
) -> Option<(Address, usize)> {
    all.iter().find_map(|cyclic| {
        let from = cyclic.at[direction as usize]?.checked_mul(8)?;
        let own = bit.checked_sub(from)?;
        let is_inside = own.checked_add(bits)? <= cyclic.bytes.checked_mul(8)?;
        is_inside.then_some((cyclic.address, own))
    })
}

/// The numbers of the drives of a network, or of all slaves where none is a drive: by the variables of its image where their names
/// are those of objects, else by the process data objects of the slaves.
fn network<'a>(root: Node<'a, 'a>) -> Vec<Offer> {
    let Some(config) = child(root, "Config") else {
        return Vec::new();
    };
    let cyclic = cyclic(config);
    let by_name = image(config, &cyclic);
    let is_drive = |(_, offer): &(String, Offer)| offer.index != 0;
    let mut all = match by_name.iter().any(is_drive) {
        true => by_name,
        false => match slaves(config, &cyclic) {
            none if none.is_empty() => by_name,
            some => some,
        },
    };
    let drives: BTreeSet<String> = (all.iter())
        .filter(|own| is_drive(own))
        .map(|(slave, _)| slave.clone())
        .collect();
    if !drives.is_empty() {
        all.retain(|(slave, _)| drives.contains(slave));
    }
    let named = all.into_iter().map(|(slave, offer)| Offer {
        name: match drives.len() > 1 {
            true => format!("{slave}.{}", offer.name),
            false => offer.name,
        },
        ..offer
    });
    named.collect()
}

/// The numbers of all slaves by their process data objects, each with the name of its slave.
fn slaves<'a>(config: Node<'a, 'a>, cyclic: &[Cyclic]) -> Vec<(String, Offer)> {
    let mut all = Vec::new();
    for slave in children(config, "Slave") {
        let name = child(slave, "Info").and_then(|info| word(info, "Name"));
        let Some(data) = child(slave, "ProcessData") else {
            continue;
        };
        for (pdo, image, direction) in [
            ("TxPdo", "Recv", Direction::In),
            ("RxPdo", "Send", Direction::Out),
        ] {
            let Some(from) = child(data, image).and_then(|image| number(image, "BitStart")) else {
                continue;
            };
            for (bit, part) in placed(parts(data, pdo), from) {
                let carried = carried(cyclic, bit, part.bits, direction);
                let own = carried.and_then(|(address, bit)| offer(part, address, bit, direction));
                all.extend(own.map(|own| (name.unwrap_or_default().to_owned(), own)));
            }
        }
    }
    all
}

/// The variables of the image of the process, each with the name of its slave, which stands in front of its own.
fn image<'a>(config: Node<'a, 'a>, cyclic: &[Cyclic]) -> Vec<(String, Offer)> {
    let Some(image) = child(config, "ProcessImage") else {
        return Vec::new();
    };
    let of = |name, direction| {
        let variables = child(image, name)
            .into_iter()
            .flat_map(|of| children(of, "Variable"));
        variables.filter_map(move |variable| {
            let kind = kind(word(variable, "DataType")?)?;
            let bit = number(variable, "BitOffs")?;
            let (address, bit) = carried(cyclic, bit, kind.bits(), direction)?;
            let name = word(variable, "Name")?;
            let (slave, own) = name.split_once('.').unwrap_or(("", name));
            let last = own.rsplit('.').next().unwrap_or(own);
            let known = named(last).filter(|known| known.kind.bits() == kind.bits());
            let offer = Offer {
                index: known.map_or(0, |known| known.index),
                name: known.map_or(last, |known| known.name).to_owned(),
                kind,
                address,
                bit,
                direction,
            };
            Some((slave.to_owned(), offer))
        })
    };
    let inputs = of("Inputs", Direction::In);
    inputs.chain(of("Outputs", Direction::Out)).collect()
}

/// The numbers of a drive that is alone in its network, by the lengths of the cyclic datagrams: outputs stand before inputs where
/// one datagram has both, as masters lay them out, or both in the same place.
fn device<'a>(root: Node<'a, 'a>, seen: &Seen) -> Vec<Offer> {
    let devices = child(root, "Descriptions").and_then(|all| child(all, "Devices"));
    let devices = devices.into_iter().flat_map(|all| children(all, "Device"));
    let mut found = devices.filter_map(|device| {
        let all = [parts(device, "TxPdo"), parts(device, "RxPdo")];
        let is_drive = all
            .iter()
            .flatten()
            .any(|part| object(part.index).is_some());
        let bytes = |parts: &[Part]| {
            parts
                .iter()
                .map(|part| part.bits)
                .sum::<usize>()
                .div_ceil(8)
        };
        let [inputs, outputs] = [bytes(&all[0]), bytes(&all[1])];
        let place = |direction: Direction, own: usize| {
            seen.at(None, direction)
                .into_iter()
                .chain(stations(seen, direction))
                .find_map(|key| {
                    let both = key.goes(Direction::In) && key.goes(Direction::Out);
                    let from = match both {
                        true if key.length == inputs + outputs => match direction {
                            Direction::In => outputs,
                            Direction::Out => 0,
                        },
                        true if key.length == inputs.max(outputs) => 0,
                        false if key.length == own => 0,
                        _ => return None,
                    };
                    Some((key.address()?, 8 * from))
                })
        };
        let places = [
            place(Direction::In, inputs)?,
            place(Direction::Out, outputs)?,
        ];
        is_drive.then_some((all, places))
    });
    let Some((all, places)) = found.next() else {
        return Vec::new();
    };
    let ways = [Direction::In, Direction::Out];
    let each = all.into_iter().zip(places).zip(ways);
    each.flat_map(|((parts, (address, from)), direction)| {
        placed(parts, from).filter_map(move |(bit, part)| offer(part, address, bit, direction))
    })
    .collect()
}

/// The cyclic datagrams of single slaves that carry data this way.
fn stations(seen: &Seen, direction: Direction) -> impl Iterator<Item = super::seen::Key> {
    let own = |key: &super::seen::Key| matches!(key.address(), Some(Address::Physical { .. }));
    seen.cyclic()
        .into_iter()
        .filter(move |key| key.goes(direction) && own(key))
}
