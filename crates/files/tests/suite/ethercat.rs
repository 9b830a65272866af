//! `[ethercat]` of an axis file: the map of a capture, what it takes from the objects of a drive, and what is refused.

use stiction_files::Axis;
use stiction_formats::ethercat::{Address, Direction, Entry, ProcessData, Type};

fn entry(
    name: &str,
    unit: Option<&str>,
    address: Option<Address>,
    byte: usize,
    kind: Type,
) -> Entry {
    Entry {
        name: name.to_owned(),
        unit: unit.map(str::to_owned),
        address,
        byte,
        bit: 0,
        kind,
        direction: Direction::In,
    }
}

#[test]
fn entries_take_what_their_object_says() {
    let text = r#"
[ethercat]
address = 0x10000
map = [
  { object = 0x6064, byte = 2 },
  { object = 0x6877, name = "second torque", byte = 16, station = 1001, address = 0x1100 },
  { object = 0x607a, type = "i16", byte = 0, address = 0x20000 },
  { object = 0x2001, type = "f32", byte = 4 },
  { name = "brake", type = "bool", byte = 8, bit = 5, direction = "out" },
]
"#;
    let usual = Some(Address::Logical(0x10000));
    let station = Some(Address::Physical {
        station: 1001,
        offset: 0x1100,
    });
    let entries = vec![
        entry("Position actual value", Some("counts"), usual, 2, Type::I32),
        entry("second torque", Some("0.1%"), station, 16, Type::I16),
        Entry {
            direction: Direction::Out,
            ..entry(
                "Target position",
                Some("counts"),
                Some(Address::Logical(0x20000)),
                0,
                Type::I16,
            )
        },
        entry("2001h", None, usual, 4, Type::F32),
        Entry {
            bit: 5,
            direction: Direction::Out,
            ..entry("brake", None, usual, 8, Type::Bool)
        },
    ];
    assert_eq!(Axis::parse(text).unwrap().ethercat, ProcessData { entries });
    assert_eq!(Axis::parse("").unwrap().ethercat, ProcessData::default());
}

#[test]
fn what_no_map_has_is_refused_with_its_place() {
    let mut said = Vec::new();
    for map in [
        "",
        "{ object = 0x6064 }",
        "{ object = 0x2001, byte = 2 }",
        "{ byte = 2, type = \"i32\" }",
        "{ object = 0x6064, byte = 2, type = \"int\" }",
        "{ object = 0x6064, byte = 2047 }",
        "{ object = 0x6064, byte = 2, bit = 8 }",
        "{ object = 0x6064, byte = 2, station = 1001 }",
        "{ object = 0x6064, byte = 2, station = 1001, address = 0x10000 }",
        "{ object = 0x6064, byte = 2, direction = \"up\" }",
        "{ object = 0x6064, bytes = 2 }",
        "{ object = 0x6064, byte = 2 }, { object = 0x6064, byte = 6 }",
    ] {
        let error = Axis::parse(&format!("[ethercat]\nmap = [{map}]\n")).unwrap_err();
        said.push(format!("{map}\n  {error}"));
    }
    insta::assert_snapshot!(said.join("\n"));
}
