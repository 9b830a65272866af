//! Rows of a table in an SQLite database: its B-tree from page to page, without recursion.

use super::pages::Pages;
use super::record::varint;
use crate::Error;

/// More pages below each other than any table has.
const MAX_DEPTH: usize = 20;

/// The rows of a table, in the order of their numbers.
pub(super) struct Rows {
    levels: Vec<Level>,
    /// Buffers of pages that were left.
    spare: Vec<Vec<u8>>,
}

/// A page on the way to the row that is read.
struct Level {
    page: Vec<u8>,
    number: u32,
    /// Which of its cells is next; of a page that leads to others the last is the one to the right of all cells.
    next: usize,
    cells: usize,
    leaf: bool,
    /// Bytes of its cells so far, which do not overlap.
    taken: usize,
}

/// A row, whose record begins in the page of the table.
pub(super) struct Cell {
    /// Its number.
    pub(super) row: i64,
    /// Bytes of its record.
    pub(super) length: u64,
    /// Where in the page its record begins, and how many bytes of it stand there.
    at: usize,
    local: usize,
    /// The page with the rest, 0 where there is none.
    overflow: u32,
}

impl Rows {
    /// The rows of the table whose first page this is.
    pub(super) fn new(root: u32, pages: &mut Pages) -> Result<Self, Error> {
        let mut rows = Self {
            levels: Vec::new(),
            spare: Vec::new(),
        };
        rows.enter(root, pages)?;
        Ok(rows)
    }

    fn enter(&mut self, number: u32, pages: &mut Pages) -> Result<(), Error> {
        if self.levels.len() >= MAX_DEPTH {
            return Err(pages.bad(number, "pages nested without end"));
        }
        let mut page = self.spare.pop().unwrap_or_default();
        pages.read(number, &mut page)?;
        let start = start_of(number);
        let leaf = match page[start] {
            0x0d => true,
            0x05 => false,
            kind => return Err(pages.bad(number, format!("a page of kind {kind} in a table"))),
        };
        let cells = usize::from(u16::from_be_bytes([page[start + 3], page[start + 4]]));
        self.levels.push(Level {
            page,
            number,
            next: 0,
            cells,
            leaf,
            taken: 0,
        });
        Ok(())
    }

    /// The next row; `None` after the last.
    pub(super) fn next(&mut self, pages: &mut Pages) -> Result<Option<Cell>, Error> {
        while let Some(level) = self.levels.last_mut() {
            let index = level.next;
            level.next += 1;
            if level.leaf && index < level.cells {
                let cell = level.cell(index, pages.usable);
                let damaged = "a row that lies outside of its page";
                return Ok(Some(cell.ok_or_else(|| pages.bad(level.number, damaged))?));
            }
            if level.leaf || index > level.cells {
                let left = self.levels.pop();
                self.spare.extend(left.map(|level| level.page));
                continue;
            }
            let child = level.child(index);
            let child = child.ok_or_else(|| pages.bad(level.number, "a damaged page"))?;
            self.enter(child, pages)?;
        }
        Ok(None)
    }

    /// The page of the row that was read last.
    pub(super) fn page(&self) -> u32 {
        self.levels.last().map_or(0, |level| level.number)
    }

    /// The bytes of a record that stand in the page of its row.
    pub(super) fn local(&self, cell: &Cell) -> &[u8] {
        let page = self.levels.last().map_or(&[][..], |level| &level.page);
        page.get(cell.at..cell.at + cell.local).unwrap_or(&[])
    }

    /// Copies a whole record.
    pub(super) fn whole(
        &self,
        cell: &Cell,
        pages: &mut Pages,
        into: &mut Vec<u8>,
    ) -> Result<(), Error> {
        into.clear();
        into.extend_from_slice(self.local(cell));
        let (mut next, mut page) = (cell.overflow, Vec::new());
        while (into.len() as u64) < cell.length {
            pages.read(next, &mut page)?;
            let left = cell.length - into.len() as u64;
            let here = left.min(pages.usable as u64 - 4) as usize;
            into.extend_from_slice(&page[4..][..here]);
            next = u32::from_be_bytes([page[0], page[1], page[2], page[3]]);
        }
        Ok(())
    }
}

/// Where the header of a page begins: the first one has that of the file before it.
fn start_of(page: u32) -> usize {
    if page == 1 { 100 } else { 0 }
}

impl Level {
    /// Where a cell begins, and its bytes.
    fn bytes(&self, index: usize) -> Option<(usize, &[u8])> {
        let head = start_of(self.number) + if self.leaf { 8 } else { 12 };
        let at = self.page.get(head + 2 * index..)?.first_chunk()?;
        let at = usize::from(u16::from_be_bytes(*at));
        Some((at, self.page.get(at..)?))
    }

    /// The page below to which a cell leads, or what is right of all cells.
    fn child(&self, index: usize) -> Option<u32> {
        let bytes = match index < self.cells {
            true => self.bytes(index)?.1,
            false => self.page.get(start_of(self.number) + 8..)?,
        };
        bytes.first_chunk().map(|bytes| u32::from_be_bytes(*bytes))
    }

    fn cell(&mut self, index: usize, usable: usize) -> Option<Cell> {
        let (begin, mut rest) = self.bytes(index)?;
        let all = rest.len();
        let length = varint(&mut rest)?;
        let row = varint(&mut rest)? as i64;
        let at = begin + all - rest.len();
        let most = usable - 35;
        let local = if length <= most as u64 {
            length as usize
        } else {
            let least = (usable - 12) * 32 / 255 - 23;
            let spread = (length - least as u64) % (usable as u64 - 4);
            match least + spread as usize {
                local if local <= most => local,
                _ => least,
            }
        };
        let after = rest.get(local..)?;
        let overflow = match length > local as u64 {
            true => u32::from_be_bytes(*after.first_chunk()?),
            false => 0,
        };
        self.taken += at + local - begin;
        (self.taken <= usable && at + local <= usable).then_some(Cell {
            row,
            length,
            at,
            local,
            overflow,
        })
    }
}
