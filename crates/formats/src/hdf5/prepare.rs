//! The bytes of an HDF5 file before the decoder has them: what it takes for granted is checked, what it cannot pass over is
//! taken out.
//!
//! Format: "HDF5 File Format Specification", version 3.0, III.B (symbol tables), VII.D (extensible arrays).

use memchr::memmem::find_iter;

/// Bytes of an entry of a symbol table, with addresses of eight bytes, and of what stands before the first.
const ENTRY: usize = 40;
const HEAD: usize = 8;

/// Refuses an index of chunks with more blocks than the file has room for: the decoder makes a list of them first.
pub(super) fn check(bytes: &[u8]) -> Result<(), String> {
    for at in find_iter(bytes, b"EAHD") {
        let Some(&[0, _, _, bits, _, least, direct, _]) = bytes[at + 4..].first_chunk() else {
            continue;
        };
        let super_blocks = u32::from(bits).saturating_sub(least.max(1).trailing_zeros()) + 1;
        // Of every two super blocks the second has twice as many blocks as those before.
        let blocks = (0..super_blocks.min(direct.into())).map(|k| 1_usize.checked_shl(k / 2));
        let blocks = blocks.map(|blocks| blocks.unwrap_or(usize::MAX));
        if blocks.fold(0, usize::saturating_add) > bytes.len() {
            return Err(format!(
                "an index of chunks at byte {at} with more blocks than the file has bytes"
            ));
        }
    }
    Ok(())
}

/// Takes soft links out of symbol tables: the decoder looks for an object where such a link has none. In groups of the
/// newer form it passes over them itself.
pub(super) fn drop_soft_links(bytes: &mut [u8]) {
    let tables: Vec<usize> = find_iter(bytes, b"SNOD\x01").collect();
    for at in tables {
        let Some(&[.., low, high]) = bytes[at..].first_chunk::<HEAD>() else {
            continue;
        };
        let count = usize::from(u16::from_le_bytes([low, high]));
        let Some(entries) = bytes[at + HEAD..].get_mut(..count * ENTRY) else {
            continue;
        };
        let is_soft = |entry: &[u8]| entry[8..16] == [0xff; 8] && entry[16..20] == [2, 0, 0, 0];
        let mut kept = 0;
        for from in 0..count {
            let entry = from * ENTRY..(from + 1) * ENTRY;
            if !is_soft(&entries[entry.clone()]) {
                entries.copy_within(entry, kept * ENTRY);
                kept += 1;
            }
        }
        bytes[at + HEAD - 2..at + HEAD].copy_from_slice(&(kept as u16).to_le_bytes());
    }
}
