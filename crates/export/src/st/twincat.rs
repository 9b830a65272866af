//! TwinCAT 3: a `.TcPOU` for each unit.

use super::Unit;
use crate::File;
use sha2::{Digest, Sha256};

pub(super) fn file(unit: &Unit) -> File {
    // `plain` text has no angle brackets; comparisons in the code are safe inside CDATA.
    let (name, id) = (&unit.name, guid(&unit.text()));
    let text = format!(
        "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n\
         <TcPlcObject Version=\"1.1.0.1\" ProductVersion=\"3.1.4024.0\">\n\
         \x20 <POU Name=\"{name}\" Id=\"{id}\" SpecialFunc=\"None\">\n\
         \x20   <Declaration><![CDATA[{}]]></Declaration>\n\
         \x20   <Implementation>\n\
         \x20     <ST><![CDATA[{}]]></ST>\n\
         \x20   </Implementation>\n\
         \x20 </POU>\n\
         </TcPlcObject>\n",
        unit.declaration, unit.body
    );
    File::text(format!("{name}.TcPOU"), text)
}

/// From the content, so that the same model gives the same file; marked as one made from a hash (RFC 9562, version 8).
fn guid(content: &str) -> String {
    let mut bytes = Sha256::digest(content.as_bytes());
    bytes[6] = (bytes[6] & 0x0f) | 0x80;
    bytes[8] = (bytes[8] & 0x3f) | 0x80;
    let hex = |range: std::ops::Range<usize>| -> String {
        bytes[range].iter().map(|b| format!("{b:02x}")).collect()
    };
    format!(
        "{{{}-{}-{}-{}-{}}}",
        hex(0..4),
        hex(4..6),
        hex(6..8),
        hex(8..10),
        hex(10..16)
    )
}
