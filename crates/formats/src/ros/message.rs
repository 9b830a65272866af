//! The numbers of one message, put where its definition says.

use super::cdr::Cdr;
use super::definition::{Count, Definitions, Field, Kind};
use crate::binary::{Class, Collector, Tree};
use crate::text::Moment;
use crate::{Error, Limits};

/// More elements of a list than that are no signals.
const MAX_LIST: usize = 1024;

/// Why a message cannot be read.
pub(crate) enum Trouble {
    /// It ends too early, or has what its definition does not know.
    Short,
    Error(Error),
}

impl From<Error> for Trouble {
    fn from(error: Error) -> Self {
        Trouble::Error(error)
    }
}

/// Reads a message whose fields belong at this place of the tree.
pub(super) fn read(
    definitions: &Definitions,
    cdr: &mut Cdr<'_>,
    node: usize,
    tree: &mut Tree,
) -> Result<(), Trouble> {
    Message { definitions, tree }.fields(0, cdr, node)
}

impl Definitions {
    /// Whether a message has this layout, to its end.
    pub(crate) fn fits(&self, message: &[u8], limits: Limits) -> bool {
        let mut tree = Tree::new(Collector::new(limits));
        tree.at.push(0);
        let Some(mut cdr) = Cdr::new(message) else {
            return false;
        };
        let element = tree.child(0, None);
        let read = element
            .map_err(Trouble::Error)
            .and_then(|element| read(self, &mut cdr, element, &mut tree));
        match read {
            // Encoders pad what they write to a multiple of their largest number.
            Ok(()) => cdr.left() < 8,
            Err(Trouble::Short) => false,
            // A limit, which is told where the message is read.
            Err(Trouble::Error(_)) => true,
        }
    }
}

struct Message<'m> {
    definitions: &'m Definitions,
    tree: &'m mut Tree,
}

impl Message<'_> {
    fn fields(&mut self, definition: usize, cdr: &mut Cdr<'_>, node: usize) -> Result<(), Trouble> {
        // Names of joints or motors, which stand before the lists of what each of them does.
        let mut names: Vec<&[u8]> = Vec::new();
        for field in &self.definitions.all[definition] {
            match (field.kind, field.count) {
                (Kind::Text, Count::Said) if is_names(&field.name) => {
                    let count = counted(cdr, 5)?;
                    names.clear();
                    for _ in 0..count {
                        names.push(cdr.text(1).ok_or(Trouble::Short)?);
                    }
                }
                (Kind::Byte, Count::One) if field.name.is_empty() => {
                    cdr.number(Class::Unsigned, 1).ok_or(Trouble::Short)?;
                }
                (_, Count::One) => {
                    let child = self.tree.child(node, Some(field.name.as_bytes()))?;
                    self.one(field.kind, cdr, child)?;
                }
                (_, Count::Fixed(count)) => self.list(field, count as usize, cdr, node, &[])?,
                (_, Count::Said) => {
                    let count = counted(cdr, 1)?;
                    self.list(field, count, cdr, node, &names)?;
                }
            }
        }
        Ok(())
    }

    fn list(
        &mut self,
        field: &Field,
        count: usize,
        cdr: &mut Cdr<'_>,
        node: usize,
        names: &[&[u8]],
    ) -> Result<(), Trouble> {
        let key = Some(field.name.as_bytes());
        if field.kind == Kind::Byte {
            let child = self.tree.child(node, key)?;
            self.tree.refuse(child, "raw bytes".to_owned());
            return (0..count).try_for_each(|_| {
                cdr.number(Class::Unsigned, 1)
                    .map(drop)
                    .ok_or(Trouble::Short)
            });
        }
        if !names.is_empty() && names.len() == count && !matches!(field.kind, Kind::Message(_)) {
            for name in names {
                let joint = self.tree.child(node, Some(name))?;
                let child = self.tree.child(joint, key)?;
                self.one(field.kind, cdr, child)?;
            }
            return Ok(());
        }
        if !names.is_empty() && count == 0 {
            return Ok(());
        }
        let child = self.tree.child(node, key)?;
        if count > 0 {
            let element = self.tree.child(child, None)?;
            if count > MAX_LIST {
                self.tree
                    .refuse(element, format!("lists of {count} elements"));
            }
            self.tree.at.push(0);
            for index in 0..count {
                self.tree.index(index as u64);
                self.one(field.kind, cdr, element)?;
            }
            self.tree.at.pop();
        }
        Ok(self.tree.end_list(child, count as u64)?)
    }

    fn one(&mut self, kind: Kind, cdr: &mut Cdr<'_>, node: usize) -> Result<(), Trouble> {
        let mut number = |class, width| -> Result<(), Trouble> {
            let (value, rounded) = cdr.number(class, width).ok_or(Trouble::Short)?;
            Ok(self.tree.number(node, value, rounded)?)
        };
        match kind {
            Kind::Truth => number(Class::Bool, 1),
            Kind::Byte => number(Class::Unsigned, 1),
            Kind::Signed(width) => number(Class::Signed, width),
            Kind::Unsigned(width) => number(Class::Unsigned, width),
            Kind::Float(width) => number(Class::Float, width),
            Kind::Text | Kind::WideText => {
                let text = cdr
                    .text(if kind == Kind::Text { 1 } else { 2 })
                    .ok_or(Trouble::Short)?;
                self.tree
                    .refuse(node, format!("text such as {}", shown(text)));
                Ok(())
            }
            Kind::Time => {
                let ns = cdr.nanoseconds().ok_or(Trouble::Short)?;
                Ok(self.tree.moment(node, moment(ns))?)
            }
            Kind::Duration => {
                let ns = cdr.nanoseconds().ok_or(Trouble::Short)?;
                Ok(self.tree.number(node, ns as f64 / 1e9, false)?)
            }
            Kind::Message(definition) => self.fields(definition, cdr, node),
        }
    }
}

/// A time stamp as this many nanoseconds since 1970.
pub(super) fn moment(ns: i64) -> Moment {
    Moment {
        ns,
        dated: true,
        fraction: true,
    }
}

/// A number of elements of at least so many bytes each: no more than the message can hold.
fn counted(cdr: &mut Cdr<'_>, bytes: usize) -> Result<usize, Trouble> {
    let count = cdr.count().filter(|&count| count <= cdr.left() / bytes);
    count.ok_or(Trouble::Short)
}

fn is_names(name: &str) -> bool {
    matches!(name, "name" | "names" | "joint_names")
}

fn shown(text: &[u8]) -> String {
    String::from_utf8_lossy(text).chars().take(20).collect()
}
