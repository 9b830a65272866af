//! Text of a URDF as links and joints, each with its line.

mod element;
mod lines;
mod scan;

pub(crate) use element::Element;
pub(crate) use lines::Lines;
pub(crate) use scan::scan;

use crate::Error;
use std::collections::HashMap;

/// Longest text that is read, bytes.
pub const MOST_BYTES: usize = 16 << 20;
/// Most elements that are read.
pub const MOST_ELEMENTS: usize = 10_000;

/// Place and direction of a frame in another one.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pose {
    /// Origin, m.
    pub xyz: [f64; 3],
    /// Roll, pitch and yaw about fixed x, y and z, in that order, rad.
    pub rpy: [f64; 3],
}

/// The `<inertial>` of a link.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Inertial {
    /// Mass, kg.
    pub mass: f64,
    /// Frame at the centre of mass in the link frame.
    pub origin: Pose,
    /// Inertia about the centre of mass in that frame, kg m²: xx, xy, yy, xz, yz, zz.
    pub inertia: [f64; 6],
    /// Line of the element.
    pub line: usize,
}

/// A link.
#[derive(Clone, Debug, PartialEq)]
pub struct Link {
    /// Name.
    pub name: String,
    /// Line of the element.
    pub line: usize,
    /// Its inertia, if the file states one.
    pub inertial: Option<Inertial>,
}

/// How a joint moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Turns within limits, rad.
    Revolute,
    /// Turns without limits, rad.
    Continuous,
    /// Slides, m.
    Prismatic,
    /// Does not move.
    Fixed,
}

/// Range of a joint, as far as the file states it: rad or m, N m or N, per second.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Limit {
    /// Lowest position.
    pub lower: Option<f64>,
    /// Highest position.
    pub upper: Option<f64>,
    /// Largest torque or force.
    pub effort: Option<f64>,
    /// Largest speed.
    pub velocity: Option<f64>,
}

/// The `<mimic>` of a joint: its position is `multiplier` times that of joint `of`, plus `offset`.
#[derive(Clone, Debug, PartialEq)]
pub struct Mimic {
    /// Name of the joint that it follows.
    pub of: String,
    /// Ratio of the positions.
    pub multiplier: f64,
    /// Position where the other's is 0, rad or m.
    pub offset: f64,
}

/// A joint.
#[derive(Clone, Debug, PartialEq)]
pub struct Joint {
    /// Name.
    pub name: String,
    /// Line of the element.
    pub line: usize,
    /// How it moves.
    pub kind: Kind,
    /// Name of the link that carries it.
    pub parent: String,
    /// Name of the link that it moves; their frames are the same.
    pub child: String,
    /// Joint frame in the frame of the parent link.
    pub origin: Pose,
    /// Axis in the joint frame, of length 1.
    pub axis: [f64; 3],
    /// Range.
    pub limit: Limit,
    /// Viscous friction, N m s/rad or N s/m; 0 where none is stated.
    pub damping: f64,
    /// Coulomb friction, N m or N; 0 where none is stated.
    pub friction: f64,
    /// What it follows.
    pub mimic: Option<Mimic>,
}

/// The links and joints of a URDF, in the order of the file.
#[derive(Clone, Debug, PartialEq)]
pub struct Document {
    /// Name of the robot; empty where none is stated.
    pub name: String,
    /// Links.
    pub links: Vec<Link>,
    /// Joints.
    pub joints: Vec<Joint>,
}

impl Document {
    /// Reads a URDF.
    ///
    /// Meshes, materials, transmissions and elements of simulators are passed over. A missing `<origin>` is 0, a missing
    /// `<axis>` is x; an axis is normalised.
    ///
    /// # Errors
    /// If the text is no URDF, too long (16 MiB, 10 000 elements), or a value is not a number; with the line. Whether links
    /// and joints make a robot is asked by [`Robot::new`](crate::Robot::new).
    pub fn parse(text: &str) -> Result<Self, Error> {
        let lines = Lines::of(text);
        let xml = scan(text, &lines)?;
        let robot = Element::root(&xml, &lines);
        let mut document = Self {
            name: robot.attribute("name").unwrap_or_default().to_string(),
            links: Vec::new(),
            joints: Vec::new(),
        };
        let (mut links, mut joints) = (HashMap::new(), HashMap::new());
        for element in robot.children() {
            match element.name() {
                "link" => {
                    let link = link(&element)?;
                    unique(&mut links, "link", &link.name, link.line)?;
                    document.links.push(link);
                }
                "joint" => {
                    let joint = joint(&element)?;
                    unique(&mut joints, "joint", &joint.name, joint.line)?;
                    document.joints.push(joint);
                }
                _ => {}
            }
        }
        if document.links.is_empty() {
            return Err(robot.missing("robot", "link"));
        }
        Ok(document)
    }
}

/// Longest name of a link or a joint, bytes: files and folders are named by it.
const LONGEST_NAME: usize = 200;

/// An error if the name is taken, or none of a file.
fn unique(
    taken: &mut HashMap<String, usize>,
    what: &'static str,
    name: &str,
    line: usize,
) -> Result<(), Error> {
    if name.len() > LONGEST_NAME || name.chars().any(char::is_control) {
        return Err(Error::Number {
            line,
            attribute: "name",
            found: name.escape_debug().take(LONGEST_NAME).collect(),
            allowed: "a name on one line of at most 200 bytes",
        });
    }
    match taken.insert(name.to_string(), line) {
        None => Ok(()),
        Some(first) => Err(Error::Duplicate {
            line,
            what,
            name: name.to_string(),
            first,
        }),
    }
}

fn link(element: &Element) -> Result<Link, Error> {
    let inertial = match element.child("inertial") {
        None => None,
        Some(inertial) => Some(read_inertial(&inertial)?),
    };
    Ok(Link {
        name: element.needed("link", "name")?.to_string(),
        line: element.line(),
        inertial,
    })
}

fn read_inertial(element: &Element) -> Result<Inertial, Error> {
    let mass = element.needed_child("inertial", "mass")?;
    let inertia = element.needed_child("inertial", "inertia")?;
    let names = ["ixx", "ixy", "iyy", "ixz", "iyz", "izz"];
    let mut moments = [0.0; 6];
    for (moment, name) in moments.iter_mut().zip(names) {
        inertia.needed("inertia", name)?;
        *moment = inertia.size(name, 0.0)?;
    }
    mass.needed("mass", "value")?;
    let value = mass.size("value", 0.0)?;
    if value < 0.0 {
        return Err(mass.refused("value", "0 or more"));
    }
    Ok(Inertial {
        mass: value,
        origin: pose(element)?,
        inertia: moments,
        line: element.line(),
    })
}

/// The `<origin>` in an element.
fn pose(element: &Element) -> Result<Pose, Error> {
    let Some(origin) = element.child("origin") else {
        return Ok(Pose::default());
    };
    Ok(Pose {
        xyz: origin.vector("xyz")?.unwrap_or_default(),
        rpy: origin.vector("rpy")?.unwrap_or_default(),
    })
}

fn joint(element: &Element) -> Result<Joint, Error> {
    let name = element.needed("joint", "name")?.to_string();
    let line = element.line();
    let kind = match element.needed("joint", "type")? {
        "revolute" => Kind::Revolute,
        "continuous" => Kind::Continuous,
        "prismatic" => Kind::Prismatic,
        "fixed" => Kind::Fixed,
        other => {
            let (joint, found) = (name, other.to_string());
            return Err(match other {
                "floating" | "planar" => Error::FreeBase { line, joint, found },
                _ => Error::JointType { line, joint, found },
            });
        }
    };
    let end = |tag| {
        let end = element.needed_child("joint", tag)?;
        Ok::<_, Error>(end.needed(tag, "link")?.to_string())
    };
    let mut joint = Joint {
        line,
        kind,
        parent: end("parent")?,
        child: end("child")?,
        origin: pose(element)?,
        axis: [1.0, 0.0, 0.0],
        limit: Limit::default(),
        damping: 0.0,
        friction: 0.0,
        mimic: None,
        name,
    };
    if kind == Kind::Fixed {
        return Ok(joint);
    }
    if let Some(axis) = element.child("axis") {
        let vector = axis.vector("xyz")?.unwrap_or(joint.axis);
        joint.axis = normalised(vector).ok_or_else(|| Error::Axis {
            line: axis.line(),
            joint: joint.name.clone(),
        })?;
    }
    if let Some(limit) = element.child("limit") {
        joint.limit = Limit {
            lower: limit.number("lower")?,
            upper: limit.number("upper")?,
            effort: limit.number("effort")?,
            velocity: limit.number("velocity")?,
        };
    }
    if let Some(dynamics) = element.child("dynamics") {
        joint.damping = dynamics.number("damping")?.unwrap_or(0.0);
        joint.friction = dynamics.number("friction")?.unwrap_or(0.0);
    }
    if let Some(mimic) = element.child("mimic") {
        joint.mimic = Some(Mimic {
            of: mimic.needed("mimic", "joint")?.to_string(),
            multiplier: mimic.size("multiplier", 1.0)?,
            offset: mimic.size("offset", 0.0)?,
        });
    }
    Ok(joint)
}

/// The vector at length 1, unless it has none.
fn normalised(v: [f64; 3]) -> Option<[f64; 3]> {
    let most = v.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    // Scaled first: the square of a small number is 0.
    let scaled = v.map(|x| x / most);
    let length = libm::sqrt(scaled.iter().map(|x| x * x).sum());
    (most > 0.0).then(|| scaled.map(|x| x / length))
}
