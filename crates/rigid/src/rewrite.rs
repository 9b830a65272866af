//! Inertias and joint friction rewritten in the text of a URDF, with every other byte kept.

mod edits;

use crate::Error;
use crate::urdf::{Document, Element, Inertial, Lines, scan};
use edits::{Edits, Part};
use std::collections::HashSet;

/// A new `<inertial>` of a link. Directions of its frame other than the link's are not kept: its `rpy` is written as 0.
#[derive(Clone, Debug, PartialEq)]
pub struct NewInertial<'a> {
    /// Name of the link.
    pub link: &'a str,
    /// Mass, centre and inertia, in the directions of the link's frame.
    pub inertial: Inertial,
}

/// A new `<dynamics>` of a joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NewDynamics<'a> {
    /// Name of the joint.
    pub joint: &'a str,
    /// Viscous friction, N m s/rad or N s/m.
    pub damping: f64,
    /// Coulomb friction, N m or N.
    pub friction: f64,
}

/// Writes inertias and joint friction into a URDF.
///
/// Values of attributes that are there are replaced between their quotes; what is missing is inserted with the indentation and
/// line ends of its neighbours. Numbers are the shortest that read back the same. Comments and everything else stay as they
/// are.
///
/// # Errors
/// As [`Document::parse`], if a link or joint does not exist, or a value is not finite or the rpy of an inertia is not 0.
pub fn rewrite(
    text: &str,
    inertials: &[NewInertial],
    dynamics: &[NewDynamics],
) -> Result<String, Error> {
    Document::parse(text)?;
    let lines = Lines::of(text);
    let xml = scan(text, &lines)?;
    let robot = Element::root(&xml, &lines);
    let find = |tag: &str, name: &str| {
        let mut elements = robot.children().filter(|element| element.name() == tag);
        elements.find(|element| element.attribute("name") == Some(name))
    };
    let mut edits = Edits::new(text);
    let (mut links, mut joints) = (HashSet::new(), HashSet::new());
    for new in inertials {
        check_inertial(&new.inertial)?;
        let fault = |reason| Error::Link {
            name: new.link.to_string(),
            reason,
        };
        let link = find("link", new.link).ok_or_else(|| fault("no such link; correct the name"))?;
        if !links.insert(new.link) {
            return Err(fault("two inertias are given for it; give one"));
        }
        let i = &new.inertial;
        let [xx, xy, yy, xz, yz, zz] = i.inertia.map(number);
        let centre = i.origin.xyz.map(number).join(" ");
        let parts = [
            Part::new("origin", &[("xyz", centre), ("rpy", "0 0 0".into())]),
            Part::new("mass", &[("value", number(i.mass))]),
            Part::new(
                "inertia",
                &[
                    ("ixx", xx),
                    ("ixy", xy),
                    ("ixz", xz),
                    ("iyy", yy),
                    ("iyz", yz),
                    ("izz", zz),
                ],
            ),
        ];
        match link.child("inertial") {
            Some(inertial) => parts.iter().for_each(|part| edits.set(&inertial, part)),
            None => edits.insert_around(&link, "inertial", &parts),
        }
    }
    for new in dynamics {
        finite("damping", new.damping)?;
        finite("friction", new.friction)?;
        let fault = |reason| Error::Joint {
            name: new.joint.to_string(),
            reason,
        };
        let joint =
            find("joint", new.joint).ok_or_else(|| fault("no such joint; correct the name"))?;
        if !joints.insert(new.joint) {
            return Err(fault("friction is given for it twice; give it once"));
        }
        let values = [
            ("damping", number(new.damping)),
            ("friction", number(new.friction)),
        ];
        edits.set(&joint, &Part::new("dynamics", &values));
    }
    Ok(edits.done())
}

/// Shortest text that reads back as the number.
fn number(x: f64) -> String {
    // Without the sign of a zero.
    format!("{:?}", x + 0.0)
}

fn finite(what: &'static str, found: f64) -> Result<(), Error> {
    let allowed = "finite";
    if found.is_finite() {
        return Ok(());
    }
    Err(Error::Value {
        what,
        found,
        allowed,
    })
}

fn check_inertial(inertial: &Inertial) -> Result<(), Error> {
    finite("mass", inertial.mass)?;
    let mut rest = inertial.origin.xyz.iter().chain(&inertial.inertia);
    rest.try_for_each(|x| finite("centre or inertia", *x))?;
    let turned = inertial.origin.rpy.iter().find(|x| **x != 0.0);
    match turned {
        None => Ok(()),
        Some(found) => Err(Error::Value {
            what: "rpy of an inertia",
            found: *found,
            allowed: "0: turn it into the directions of the link",
        }),
    }
}
