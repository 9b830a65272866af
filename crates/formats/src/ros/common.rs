//! Layouts of common message types, for recordings that have none: those of ROS 2 up to Humble.
//!
//! Package and type, then the fields in their order, of ROS 2 Humble; of a type that has changed the newest comes first.

use super::definition::{Definitions, short};

const COMMON: &str = include_str!("common.msg");

/// Type and fields of each layout.
fn sections() -> impl Iterator<Item = (&'static str, &'static str)> {
    let sections = COMMON.split("MSG: ").skip(1);
    sections.filter_map(|section| section.split_once('\n'))
}

/// The layouts that a type has had; none where it is not known.
pub(crate) fn layouts(name: &str) -> Vec<Definitions> {
    let wanted = short(name);
    let own = sections().filter(|(name, _)| *name == wanted);
    let all = |(name, fields): (&str, &str)| {
        let mut text = fields.to_owned();
        for (name, fields) in sections() {
            text.extend(["===\nMSG: ", name, "\n", fields]);
        }
        Definitions::new(name, &text).ok()
    };
    own.filter_map(all).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_layout_is_whole() {
        for (name, _) in sections() {
            let same = sections().filter(|(other, _)| *other == name).count();
            assert_eq!(layouts(&name.replace('/', "/msg/")).len(), same, "{name}");
        }
        assert!(layouts("sensor_msgs/msg/Image").is_empty());
    }
}
