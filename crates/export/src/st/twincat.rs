//! TwinCAT 3: a `.TcPOU` for each unit.

use super::unit::Unit;
use crate::File;
use crate::guid::guid;

pub(super) fn file(unit: &Unit) -> File {
    // `plain` text has no angle brackets; comparisons in the code are safe inside CDATA.
    // TwinCAT keeps persistent data without further hardware, retained data not.
    let declaration = unit
        .declaration
        .replace("\nVAR RETAIN\n", "\nVAR PERSISTENT\n");
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
        declaration, unit.body
    );
    File::text(format!("{name}.TcPOU"), text)
}
