//! A robot as a tree of bodies, each moved by one joint.

mod tree;

use crate::Error;
use crate::inertia::{self, Parameters};
use crate::space::Frame;
use crate::urdf::{Document, Inertial, Kind, Limit};

/// Most moving joints.
pub const MOST_JOINTS: usize = 128;

/// Gravity that a robot starts with, m/s² in the frame of the root link.
pub const GRAVITY: [f64; 3] = [0.0, 0.0, -9.81];

/// A joint that follows another one: its position is `multiplier` times that of joint `of`, plus `offset`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Follows {
    /// Index of the joint that it follows, which follows none.
    pub of: usize,
    /// Ratio of the positions.
    pub multiplier: f64,
    /// Position where the other's is 0, rad or m.
    pub offset: f64,
}

/// A moving joint; joint i moves body i.
#[derive(Clone, Debug, PartialEq)]
pub struct Joint {
    /// Name in the URDF.
    pub name: String,
    /// Line of the element there.
    pub line: usize,
    /// How it moves; not [`Kind::Fixed`].
    pub kind: Kind,
    /// The body that carries it; `None` for the base.
    pub parent: Option<usize>,
    /// Its frame at position 0 in the frame of that body.
    pub frame: Frame,
    /// Axis in its frame, of length 1.
    pub axis: [f64; 3],
    /// Range.
    pub limit: Limit,
    /// Viscous friction of the URDF, N m s/rad or N s/m.
    pub damping: f64,
    /// Coulomb friction of the URDF, N m or N.
    pub friction: f64,
    /// What it follows.
    pub mimic: Option<Follows>,
}

/// The links that one joint moves together. Its frame is that of the joint and moves with it.
#[derive(Clone, Debug, PartialEq)]
pub struct Body {
    /// Index of the link whose inertia stands for the body's: the one that the joint moves, or the heaviest link fixed to it
    /// if that has no mass.
    pub carrier: usize,
    /// Parameters of the carrier in the body's frame.
    pub own: Parameters,
    /// Sum of the parameters of all other links of the body and of loads, in the body's frame.
    pub attached: Parameters,
    /// One more than the last body that this one carries; these follow it without a gap.
    pub end: usize,
}

/// A link and where it is.
#[derive(Clone, Debug, PartialEq)]
pub struct PlacedLink {
    /// Name in the URDF.
    pub name: String,
    /// Line of the element there.
    pub line: usize,
    /// Its body; `None` for the base.
    pub body: Option<usize>,
    /// Its frame in that of the body, or of the root link.
    pub frame: Frame,
}

/// What is doubtful about the inertias and joints of a URDF.
#[derive(Clone, Debug, PartialEq)]
pub enum Finding {
    /// A joint moves links that have no mass together.
    NoInertia {
        /// Name of the link that the joint moves.
        link: String,
        /// Its line.
        line: usize,
    },
    /// No body can have this inertia: it is not positive, or a principal moment is larger than the sum of the others.
    NotPhysical {
        /// Name of the link.
        link: String,
        /// Line of its `<inertial>`.
        line: usize,
        /// Principal moments about the centre of mass, smallest first, kg m².
        principal: [f64; 3],
    },
    /// A joint mimics one that does not move or exist; it counts as independent.
    NoLeader {
        /// Name of the joint.
        joint: String,
        /// Its line.
        line: usize,
        /// Name of the joint that it mimics.
        of: String,
    },
}

/// A robot on a fixed base.
///
/// Joints are in depth-first order: a joint stands before those that it carries, and the joints on one link are in the order
/// of the file. Links of fixed joints are part of the body, or base, that they are fixed to.
#[derive(Clone, Debug, PartialEq)]
pub struct Robot {
    pub(crate) joints: Vec<Joint>,
    pub(crate) bodies: Vec<Body>,
    pub(crate) turns: Vec<tree::Turn>,
    links: Vec<PlacedLink>,
    findings: Vec<Finding>,
    pub(crate) gravity: [f64; 3],
}

impl Robot {
    /// The robot of a URDF.
    ///
    /// # Errors
    /// If its links and joints are no tree, a joint mimics one that it cannot follow, or no joint moves, or more than
    /// [`MOST_JOINTS`].
    pub fn new(document: &Document) -> Result<Self, Error> {
        tree::build(document)
    }

    /// Number of moving joints.
    pub fn len(&self) -> usize {
        self.joints.len()
    }

    /// Never: a robot has a joint.
    pub fn is_empty(&self) -> bool {
        self.joints.is_empty()
    }

    /// Moving joints.
    pub fn joints(&self) -> &[Joint] {
        &self.joints
    }

    /// Bodies; body i is moved by joint i.
    pub fn bodies(&self) -> &[Body] {
        &self.bodies
    }

    /// Links, in the order of the file.
    pub fn links(&self) -> &[PlacedLink] {
        &self.links
    }

    /// What is doubtful about the inertias and joints in the file.
    pub fn findings(&self) -> &[Finding] {
        &self.findings
    }

    /// Index of a moving joint.
    pub fn joint(&self, name: &str) -> Option<usize> {
        self.joints.iter().position(|joint| joint.name == name)
    }

    /// Gravity, m/s² in the frame of the root link.
    pub fn gravity(&self) -> [f64; 3] {
        self.gravity
    }

    /// Sets gravity, m/s² in the frame of the root link: turned where the base hangs or stands inclined.
    pub fn set_gravity(&mut self, gravity: [f64; 3]) {
        self.gravity = gravity;
    }

    /// Parameters of all bodies, ten each, with what is attached to them.
    pub fn parameters(&self) -> Vec<f64> {
        let total = |body: &Body| inertia::sum(&body.own, &body.attached);
        self.bodies.iter().flat_map(total).collect()
    }

    /// Attaches a load to a link: mass, kg; its centre, m in the frame of the link; and inertia about that centre along the
    /// directions of the link (xx, xy, yy, xz, yz, zz), kg m². It counts as attached to the link's body.
    ///
    /// # Errors
    /// If no joint moves the link or it does not exist, or a value is not finite or the mass negative.
    pub fn attach(
        &mut self,
        link: &str,
        mass: f64,
        centre: [f64; 3],
        inertia: [f64; 6],
    ) -> Result<(), Error> {
        let fault = |reason| Error::Link {
            name: link.to_string(),
            reason,
        };
        let found = self.links.iter().find(|l| l.name == link);
        let placed = found.ok_or_else(|| fault("no such link; correct the name"))?;
        let body = placed
            .body
            .ok_or_else(|| fault("it is part of the base, where a load has no effect"))?;
        let value = |what, found, allowed| Error::Value {
            what,
            found,
            allowed,
        };
        if !(mass >= 0.0 && mass.is_finite()) {
            return Err(value("mass of the load", mass, "finite, 0 or more"));
        }
        if let Some(x) = centre.iter().chain(&inertia).find(|x| !x.is_finite()) {
            return Err(value("centre or inertia of the load", *x, "finite"));
        }
        let mut load = inertia::point_mass(mass, centre);
        for (p, i) in load[4..].iter_mut().zip(inertia) {
            *p += i;
        }
        let attached = &mut self.bodies[body].attached;
        *attached = inertia::sum(attached, &inertia::moved(&load, &placed.frame));
        Ok(())
    }

    /// `<inertial>` of a body's carrier link for parameters of the whole body in its frame: without what is attached, in the
    /// frame of the link. `None` if no mass is left.
    pub fn carrier_inertial(&self, body: usize, parameters: &Parameters) -> Option<Inertial> {
        let body = self.bodies.get(body)?;
        let own = inertia::difference(parameters, &body.attached);
        let link = self.links.get(body.carrier)?;
        inertia::to_inertial(&inertia::moved(&own, &link.frame.inverse()), link.line)
    }

    /// Indices of the joints that follow none: the independent coordinates.
    pub fn independent(&self) -> Vec<usize> {
        let follows_none = |i: &usize| self.joints[*i].mimic.is_none();
        (0..self.len()).filter(follows_none).collect()
    }

    /// Positions of all joints from those of the [`independent`](Self::independent) ones.
    ///
    /// # Panics
    /// If a length is another one.
    pub fn expand(&self, independent: &[f64], all: &mut [f64]) {
        self.expand_rates(independent, all);
        for (x, joint) in all.iter_mut().zip(&self.joints) {
            *x += joint.mimic.map_or(0.0, |mimic| mimic.offset);
        }
    }

    /// Speeds or accelerations of all joints from those of the [`independent`](Self::independent) ones.
    ///
    /// # Panics
    /// If a length is another one.
    pub fn expand_rates(&self, independent: &[f64], all: &mut [f64]) {
        assert_eq!(all.len(), self.len(), "a value a joint");
        let mut given = independent.iter();
        for (x, joint) in all.iter_mut().zip(&self.joints) {
            if joint.mimic.is_none() {
                *x = *given.next().expect("a value an independent joint");
            }
        }
        assert!(given.next().is_none(), "a value an independent joint");
        for (i, joint) in self.joints.iter().enumerate() {
            if let Some(mimic) = joint.mimic {
                all[i] = mimic.multiplier * all[mimic.of];
            }
        }
    }

    /// Torques on the [`independent`](Self::independent) joints from those on all: a follower's work is done by the joint it
    /// follows.
    ///
    /// # Panics
    /// If a length is another one.
    pub fn reduce(&self, all: &[f64], independent: &mut [f64]) {
        assert_eq!(all.len(), self.len(), "a value a joint");
        let indices = self.independent();
        assert_eq!(independent.len(), indices.len(), "a value a coordinate");
        for (torque, i) in independent.iter_mut().zip(indices) {
            let followers = self.joints.iter().zip(all).filter_map(|(joint, x)| {
                let mimic = joint.mimic.filter(|mimic| mimic.of == i)?;
                Some(mimic.multiplier * x)
            });
            *torque = all[i] + followers.sum::<f64>();
        }
    }
}
